"""A measured panel of netting, from the text of a case to the force on it: as bars, sheltered bars and screens."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
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
from fyke.water.laws import LAWS, measured
from reference import table

Array = NDArray[np.float64]
DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "validation.md").read_text(encoding="utf-8")
CASE = next(text for text in re.findall(r"^```toml\n(.*?)^```$", PAGE, re.M | re.S) if "Patursson" in text)

ANGLE, DRAG, LIFT = measured.panel().T
AS_MEASURED = ("29 mm", "986 mm", 34)  # bar, side and meshes; straight bars have a solidity of 0.184
AS_STATED = ("26.522 mm", "1007.836 mm", 38)  # bars that are of solidity 0.20
BARS = {
    "constant, 1.2 and 0.1; takagi": '{ law = "constant", normal = 1.2, tangential = 0.1 }',
    "choo-casarella": '"choo-casarella"',
    "kristiansen-faltinsen": '"kristiansen-faltinsen"',
    "ns-cheng": '"ns-cheng"',
}
# What a case says of drag and shelter, and of the netting.
MODELS = {
    **{f"bars, {name}": (f"bars = {law}", "off", AS_MEASURED) for name, law in BARS.items()},
    **{f"sheltered, {name}": (f"bars = {law}", "cheng", AS_MEASURED) for name, law in BARS.items()},
    **{
        f"screens, {name}": (f'kind = "screens"\nscreens = "{name}"', "off", AS_STATED)
        for name in ("kristiansen-faltinsen", "aarsnes", "loland", "fridman", "balash", "lee", "bi")
    },
    **{
        f"the same at 0.184, {name}": (f'kind = "screens"\nscreens = "{name}"', "off", AS_MEASURED)
        for name in ("kristiansen-faltinsen", "loland")
    },
}
CONSTANT, SHELTERED = (f"{kind}, constant, 1.2 and 0.1; takagi" for kind in ("bars", "sheltered"))
SCREENS = "screens, kristiansen-faltinsen"


def written(text: str, *changes: tuple[str, str]) -> str:
    """Return the case with words changed, each of which must be there."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text


def case_of(model: str, angle: float, *more: tuple[str, str]) -> str:
    """Return the case of the page for a model, the panel turned by an angle (rad)."""
    drag, twines, (bar, side, meshes) = MODELS[model]
    return written(
        CASE,
        ('bars = { law = "constant", normal = 1.2, tangential = 0.1 }', drag),
        ('twines = "off"', f'twines = "{twines}"'),
        ('"29 mm"', f'"{bar}"'),
        ('["986 mm", "986 mm"]', f'["{side}", "{side}"]'),
        ("[34, 34]", f"[{meshes}, {meshes}]"),
        ("[1.0, 0.0, 0.0]", f"[{np.cos(angle)}, {np.sin(angle)}, 0.0]"),
        *more,
    )


def made(text: str) -> fyke.System:
    case = fyke.parse_case(text)
    return fyke.build_system(fyke.build_net(case), case)


def at_rest(system: fyke.System) -> fyke.State:
    """As built: flat, and every knot held in its place."""
    return fyke.State(0.0, system.net.positions, np.zeros_like(system.net.positions))


def over_pressure(system: fyke.System, force: Array) -> Array:
    """C_D and C_L, (2,): a bar stands for half a mesh of netting, a screen for itself, also along the frame."""
    net, bar = system.net, system.net.rest_length[0]
    area = faces_of(net).area.sum() if system.coefficients.screens else 0.5 * net.bar_count * bar**2
    return force[:2] / (0.5 * system.water.density * 0.5**2 * area)


@cache
def flat(model: str) -> Array:
    """C_D and C_L of a model at the measured angles, (2, 6)."""
    systems = [made(case_of(model, angle)) for angle in ANGLE]
    return np.transpose([over_pressure(s, evaluate(s, at_rest(s)).hydrodynamic_force) for s in systems])


def error(found: Array, true: Array) -> Array:
    return 100.0 * (found / true - 1.0)


# Others' arithmetic


def in_four_digits(values: Array) -> list[str]:
    return [f"{value:.4g}" for value in np.where(np.abs(values) < 1e-12, 0.0, values)]


@pytest.mark.parametrize(
    ("model", "column"),
    [
        ("screens, aarsnes", "aarsnes"),
        ("screens, loland", "loland"),
        (SCREENS, "kf"),
        ("screens, fridman", "fridman"),
        (CONSTANT, "bars"),
    ],
)
def test_the_usual_models_give_what_others_worked_out(model, column):
    """To the four digits that are printed, but for two lifts of that code, which are put right by hand here."""
    rows = table("panel_models")
    drag, lift = (np.array([row[f"{column}_{what}"] for row in rows]) for what in ("drag", "lift"))
    found = flat(model)
    assert [row["angle"] for row in rows] == pytest.approx(np.degrees(ANGLE))
    assert in_four_digits(found[0]) == in_four_digits(drag)
    if column == "kf":
        # C_N45 = C_D0 / 2. All lifts of the code are 0.9314 of these.
        normal = 0.5 * drag[0]
        lift_45 = (normal - np.pi * normal / (8.0 + normal)) / np.sqrt(2.0)
        by_hand = lift_45 * (np.sin(2.0 * ANGLE) + 0.1 * np.sin(4.0 * ANGLE))
        assert lift == pytest.approx(0.9314 * by_hand, rel=3e-4)
        assert found[1] == pytest.approx(by_hand, rel=3e-4, abs=1e-12)
    elif column == "fridman":
        # The part along the panel takes from the lift and does not add to it.
        along = 0.1 * measured.PANEL_REYNOLDS**0.14 * 0.2
        by_hand = lift - 2.0 * along * np.sin(ANGLE) ** 2 * np.cos(ANGLE)
        assert found[1] == pytest.approx(by_hand, abs=6e-5)
    else:
        assert in_four_digits(found[1]) == in_four_digits(lift)


# The measurement


def test_the_best_screens_are_within_5_percent_to_30_deg_and_10_percent_at_45():
    off = error(flat(SCREENS)[0], DRAG)
    assert np.all(np.abs(off[:4]) < [5.0, 5.0, 5.0, 10.0])
    assert off[5] < -40.0  # and no model of all sees it through


def test_bars_are_29_percent_too_high_at_60_deg_and_within_20_with_shelter():
    alone, sheltered = (error(flat(model)[0], DRAG) for model in (CONSTANT, SHELTERED))
    assert alone[4] == pytest.approx(29.0, abs=0.5)
    assert abs(sheltered[4]) < 20.0
    assert np.all(np.abs(sheltered[:5]) < 20.0)
    assert np.abs(sheltered - alone)[:2].max() < 1.0


def test_by_the_solidity_as_stated_shelter_leaves_bars_22_percent_too_high_at_60_deg():
    """More twine on the same outline, 2 d / l = 0.211 and not 0.193: 20 % is kept for bars as measured only."""
    drag = []
    for twines in ("off", "cheng"):
        netting = [('"29 mm"', '"26.522 mm"'), ('["986 mm", "986 mm"]', '["901.748 mm", "901.748 mm"]')]
        system = made(case_of(CONSTANT, ANGLE[4], ('twines = "off"', f'twines = "{twines}"'), *netting))
        drag.append(over_pressure(system, evaluate(system, at_rest(system)).hydrodynamic_force)[0])
    assert error(np.array(drag), DRAG[4]) == pytest.approx([40.9, 21.6], abs=0.1)


def test_takagi_is_the_constant_law_here():
    """Its C_n is 1.2 from Re = 200 on, and twines have 361 and more across them up to 75 deg."""
    for angle in ANGLE:
        change = ('{ law = "constant", normal = 1.2, tangential = 0.1 }', '"takagi"')
        forces = [
            evaluate(s, at_rest(s)).hydrodynamic_force
            for s in (made(case_of(CONSTANT, angle)), made(case_of(CONSTANT, angle, change)))
        ]
        assert forces[1] == pytest.approx(forces[0], rel=1e-9, abs=1e-12)


# As solved


STIFFNESSES = ('material = "PA"', 'material = "PA"\nyoungs_modulus = "40 MPa"')
BELLIED = (CONSTANT, SHELTERED, SCREENS, "screens, lee")
BELLIED_AT = (0, 3)  # which of the angles


@cache
def solved(model: str, stiffness: str) -> tuple[float, float, float]:
    """Largest sag (mm), largest change of C_D (%) and of C_L over the flat panel at 0 and 45 deg."""
    sag, found = [], []
    for which in BELLIED_AT:
        system = made(case_of(model, ANGLE[which], (STIFFNESSES[0], stiffness)))
        result = fyke.solve_static(system)
        assert result.outcome.name == "converged"
        sag.append(np.linalg.norm(result.position[-1] - system.net.positions, axis=1).max())
        found.append(over_pressure(system, result.hydrodynamic_force[-1]))
    drag, lift = np.transpose(found)
    before = flat(model)[:, BELLIED_AT]
    return (
        1e3 * max(sag),
        float(np.abs(error(drag, before[0])).max()),
        float(np.abs(lift - before[1]).max()),
    )


def test_a_solved_panel_differs_little_from_a_flat_one():
    """Nylon as of rope, and the softest netting of the literature."""
    for model in BELLIED[:3]:
        stiff, soft = (solved(model, stiffness) for stiffness in STIFFNESSES)
        assert 10.0 < stiff[0] < 20.0 and stiff[1] < 0.3 and stiff[2] < 3e-4
        assert 40.0 < soft[0] < 60.0 and stiff[1] < soft[1] < 3.0 and soft[2] < 2e-3


# The tables of the page


def rows_of(heading: str) -> dict[str, list[str]]:
    """Return the rows of the one table of the page that begins with this heading, by what they begin with."""
    (lines,) = [part for part in PAGE.split("\n\n") if part.startswith(f"| {heading} |")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines.splitlines()]
    return {row[0]: row[1:] for row in rows[2:]}


def of_drag(model: str) -> list[str]:
    drag = flat(model)[0]
    return [f"{c:.4f} ({off:+.1f})" for c, off in zip(drag, error(drag, DRAG), strict=True)]


def of_lift(model: str) -> list[str]:
    lift = flat(model)[1, 1:]
    return [f"{c:.4f} ({off:+.0f})" for c, off in zip(lift, error(lift, LIFT[1:]), strict=True)]


def of_belly(model: str) -> list[str]:
    both = [solved(model, stiffness) for stiffness in STIFFNESSES]
    return [f"{one[0]:.0f} mm, {one[1]:.1f} %, {one[2]:.4f}" for one in both]


@pytest.mark.parametrize(
    ("heading", "models", "row", "true"),
    [
        ("$C_D$", MODELS, of_drag, [f"{one:.3f}" for one in DRAG]),
        ("$C_L$", MODELS, of_lift, [f"{one:.3f}" for one in LIFT[1:]]),
        ("solved over flat", BELLIED, of_belly, None),
    ],
    ids=["drag", "lift", "belly"],
)
def test_the_tables_of_the_page_are_as_worked_out_here(
    heading, models, row: Callable[[str], list[str]], true
):
    expected = {model: row(model) for model in models}
    if true:
        expected["measured"] = true
    assert rows_of(heading) == expected


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
