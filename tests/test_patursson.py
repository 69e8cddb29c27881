"""The measured panel's picture, and two such panels in line; validation/patursson.toml has the measurement."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

import fyke
from fyke.forces.evaluate import evaluate
from fyke.forces.surroundings import Surroundings
from fyke.netting.faces import faces_of
from fyke.report.laws import panel_by_angle
from fyke.water.laws import LAWS
from patursson import ANGLE, CASE, CONSTANT, DRAG, LIFT, at_rest, case_of, made, written

Array = NDArray[np.float64]
DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "validation.md").read_text(encoding="utf-8")

# What a case says of drag and shelter, and of the netting.


def test_takagi_is_the_constant_law_here():
    """Its C_n is 1.2 from Re = 200 on, and twines have 361 and more across them up to 75 deg."""
    for angle in ANGLE:
        change = ('{ law = "constant", normal = 1.2, tangential = 0.1 }', '"takagi"')
        forces = [
            evaluate(s, at_rest(s)).hydrodynamic_force
            for s in (made(case_of(CONSTANT, angle)), made(case_of(CONSTANT, angle, change)))
        ]
        assert forces[1] == pytest.approx(forces[0], rel=1e-9, abs=1e-12)


# The picture


def test_the_picture_shows_what_was_given_over_what_was_measured():
    curve = np.array([np.radians([0.0, 45.0, 90.0]), [0.3, 0.2, 0.1], [0.0, 0.1, -0.01]])
    figure = panel_by_angle({"first": curve, "second": 0.5 * curve})
    assert isinstance(figure, Figure) and figure.get_figwidth() == pytest.approx(178.0 / 25.4)
    for ax, true, row in zip(figure.axes, (DRAG, LIFT), (1, 2), strict=True):
        first, second, points = ax.lines
        assert first.get_xydata() == pytest.approx(np.transpose([[0.0, 45.0, 90.0], curve[row]]))
        assert second.get_color() != first.get_color()
        assert points.get_xydata() == pytest.approx(np.transpose([np.degrees(ANGLE), true]))
        assert "(deg)" in ax.get_xlabel() and "(-)" in ax.get_ylabel()
        assert ax.get_ylim()[0] <= curve[row].min()
    assert [text.get_text() for text in figure.axes[1].get_legend().get_texts()] == [
        "first",
        "second",
        "measured, Patursson 2010",
    ]
    with pytest.raises(ValueError, match="no curve"):
        panel_by_angle({})


def test_the_picture_of_the_page_is_there():
    assert "](images/gallery/panel_by_angle.png)" in PAGE
    file = DOCS / "images" / "gallery" / "panel_by_angle.png"
    assert file.stat().st_size < 150_000
    with Image.open(file) as picture:
        assert picture.width > 1000


# Two panels, one behind the other: that screens, shelter and solver are joined as they should be


SECOND = """
[[gear]]
kind = "panel"
name = "back"
netting = "main"
meshes = [12, 12]
size = ["348 mm", "348 mm"]
centre = [2.0, 0.0, -1.0]
normal = [1.0, 0.0, 0.0]
fixed = "edges"
"""


def pair(law: str, wake: str, *, speed: float = 0.5, alone: bool = False) -> fyke.System:
    """A panel of 12 x 12 meshes as screens in front of another like it, or alone in a current of this speed (m/s)."""
    return made(
        written(
            CASE,
            (
                'bars = { law = "constant", normal = 1.2, tangential = 0.1 }',
                f'kind = "screens"\nscreens = "{law}"',
            ),
            ('twines = "off"', f"wake = {wake}"),
            ("[34, 34]", "[12, 12]"),
            ('["986 mm", "986 mm"]', '["348 mm", "348 mm"]'),
            ("[0.5, 0.0, 0.0]", f"[{speed!r}, 0.0, 0.0]"),
        )
        + ("" if alone else SECOND)
    )


def halves(values: Array) -> tuple[Array, Array]:
    front, back = np.split(values, 2)
    return front, back


def left_by_momentum(system: fyke.System) -> float:
    """sqrt(1 - C_D), C_D = 0.04 + (-0.04 + 0.33 Sn + 6.54 Sn^2 - 4.88 Sn^3) face on, by hand; Sn as hung."""
    x = 2.8 / 29.0
    sn = 2.0 * x - x**2
    assert faces_of(system.net).solidity == pytest.approx(sn, rel=1e-12)
    return float(np.sqrt(1.0 - (0.33 * sn + 6.54 * sn**2 - 4.88 * sn**3)))


def test_behind_a_flat_panel_the_force_is_r_squared_of_that_in_front():
    """Exactly so where the coefficient is constant (Aarsnes); that of Kristiansen and Faltinsen is of the speed r U."""
    for law in ("aarsnes", "kristiansen-faltinsen"):
        system = pair(law, '"momentum"')
        r = left_by_momentum(system)
        assert r < 0.9
        front, back = (one.sum(axis=0) for one in halves(evaluate(system, at_rest(system)).water_force))
        by_law = LAWS["panels"][law]()
        there, here = (by_law.coefficients(0.0, 0.18378, s * 0.5 * 2.8e-3 / 1.002e-6)[0] for s in (r, 1.0))
        rel = 1e-12 if law == "aarsnes" else 1e-7
        assert back[0] / front[0] == pytest.approx(r**2 * there / here, rel=rel)
        lone = pair(law, '"off"', speed=r * 0.5, alone=True)
        assert back == pytest.approx(evaluate(lone, at_rest(lone)).hydrodynamic_force, rel=1e-12, abs=1e-12)
    assert there > 1.005 * here  # the two laws do differ


def test_solved_behind_a_panel_that_leaves_a_given_part_is_a_panel_alone_in_that_current():
    """Shape, tension and force to the tolerance of the solver, by a law that knows the speed."""
    both = fyke.solve_static(pair("kristiansen-faltinsen", "0.8"), tolerance=1e-9)
    for which, speed in enumerate((0.5, 0.4)):
        lone = fyke.solve_static(
            pair("kristiansen-faltinsen", '"off"', speed=speed, alone=True), tolerance=1e-9
        )
        assert np.abs(lone.position[-1] - lone.net.positions).max() > 2e-3
        moved = [2.0 * which, 0.0, 0.0]
        assert halves(both.position[-1])[which] - moved == pytest.approx(lone.position[-1], abs=1e-8)
        assert halves(both.tension[-1])[which] == pytest.approx(lone.tension[-1], abs=1e-6)
        assert halves(both.water_force[-1])[which] == pytest.approx(lone.water_force[-1], abs=1e-9)
        assert halves(both.water_velocity[-1])[which] == pytest.approx(
            np.tile([speed, 0.0, 0.0], (lone.net.bar_count, 1))
        )


def test_solved_in_a_wake_by_momentum_the_factors_are_those_of_the_solved_shape():
    """The back panel alone, in the current that the pair says it has, comes to the same shape and force."""
    system = pair("kristiansen-faltinsen", '"momentum"')
    result = fyke.solve_static(system, tolerance=1e-9)
    assert result.outcome.name == "converged"
    around = Surroundings(system)
    around.renew(result.position[-1], 0.0)
    local = halves(around.velocity(result.position[-1], 0.0))[1]
    assert local[:, 0] / 0.5 == pytest.approx(left_by_momentum(system), rel=2e-3)
    assert np.ptp(local[:, 0]) > 1e-5  # stretched netting lets more through
    lone = pair("kristiansen-faltinsen", '"off"', alone=True)
    given = SimpleNamespace(velocity=lambda points, time: local.copy(), steady=True, uniform=False)
    again = fyke.solve_static(
        fyke.make_system(lone.net, current=given, water=lone.water, coefficients=lone.coefficients),
        tolerance=1e-9,
    )
    assert halves(result.position[-1])[1] - [2.0, 0.0, 0.0] == pytest.approx(again.position[-1], abs=1e-7)
    assert halves(result.water_force[-1])[1] == pytest.approx(again.water_force[-1], abs=1e-7)
