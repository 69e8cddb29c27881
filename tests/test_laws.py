"""Drag laws against tables that others' arithmetic made, formulas by hand, geometry, and measured points."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fyke.water.laws import BAND, LAWS, AngleTable, BarTable, Range, joined, outside
from fyke.water.laws.bars import ChooCasarella, CifuentesKim, ConstantBar, Hoerner, White
from fyke.water.laws.joints import level, powers
from fyke.water.laws.knots import CliftGauvin, CliftGraceWeber, SchillerNaumann
from fyke.water.laws.panels import KristiansenFaltinsen

BARS, KNOTS, PANELS = LAWS["bars"], LAWS["knots"], LAWS["panels"]
MADE = {name: law() for name, law in BARS.items() if not name.endswith("table")}
SPLIT = {name: law for name, law in MADE.items() if name != "hoerner"}
SPHERES = {name: law() for name, law in KNOTS.items()}
TABLE = BarTable((9.0, 90.0, 900.0), (2.0, 1.5, 1.1), (0.3, 0.1, 0.0))


# Published numbers


def test_quasi_static_series_by_hand():
    """cos q = -cos 3q = -cos 5q, sin 2q = -sin 6q = 1, sin 4q = 0 at 45 deg; sin 2q = sin 6q, sin 4q = 1 at 22.5."""
    law = KristiansenFaltinsen("quasi-static")
    face_on = KristiansenFaltinsen().coefficients(0.0, 0.2, 800.0)[0]
    drag, lift = law.coefficients(np.array([np.pi / 4.0, np.pi / 8.0]), 0.2, 800.0)
    assert drag[0] == pytest.approx(face_on * np.sqrt(0.5) * (0.972 - 0.0129 - 0.0151), rel=1e-12)
    normal = face_on / 2.0
    scale = (normal - np.pi * normal / (8.0 + normal)) / np.sqrt(2.0)
    assert lift[0] == pytest.approx(scale * (1.2044 - 0.135), rel=1e-12)
    assert lift[1] == pytest.approx(scale * (np.sqrt(0.5) * (1.2044 + 0.135) + 0.1466), rel=1e-12)


def test_choo_and_casarellas_tangential_force_is_linear_in_the_speed_along():
    """d = 1 mm, 0.5 m/s at 45 deg: 0.0820 N/m across and 0.0162 N/m along; f_t = pi mu (...) v_t, once."""
    law = ChooCasarella()
    assert law.coefficients([50.0, 100.0, 500.0, 1000.0])[1] == pytest.approx(
        [0.632, 0.459, 0.221, 0.162], abs=5e-4
    )
    across, along = (0.5 * 1000.0 * 1e-3 * 0.25 * one for one in law.force(500.0, np.pi / 4.0))
    assert (across, along) == (pytest.approx(0.0820, abs=5e-5), pytest.approx(0.0162, abs=5e-5))
    speed_across, speed_along = 0.3, np.array([0.01, 0.02, 0.4])
    c = law.coefficients(speed_across / 1e-3, speed_along / 1e-3)[1]
    force = 0.5 * 1000.0 * 1e-3 * c * speed_along**2
    re = 300.0
    by_hand = np.pi * 1e-3 * (0.55 * re**0.5 + 0.084 * re ** (2.0 / 3.0)) * speed_along
    assert force == pytest.approx(by_hand * 1e3 * 1e-3, rel=1e-12)


def test_spheres_are_those_of_the_published_table():
    """Three digits printed for three laws, Re = 1 to 1e5, away from the joint at 1000.

    The last value of Clift and Gauvin is printed 0.468; its formula gives 0.08876 + 0.37869 = 0.46745.
    """
    re = [1.0, 10.0, 100.0, 200.0, 500.0, 3000.0, 1e4, 1e5]
    expected = {
        SchillerNaumann: [27.6, 4.15, 1.09, 0.806, 0.563, 0.44, 0.44, 0.44],
        CliftGraceWeber: [27.2, 4.26, 1.09, 0.776, 0.555, 0.400, 0.405, 0.502],
        CliftGauvin: [27.6, 4.13, 1.07, 0.791, 0.565, 0.394, 0.410, 0.467],
    }
    for law, values in expected.items():
        found = law().coefficients(re)
        assert [float(f"{one:.3g}") for one in found] == pytest.approx(values, rel=1e-9), law


def test_the_standard_curve_of_spheres_goes_on_at_its_last_pieces():
    """With 0.1 log Re - 0.49 the curve passes 4e5 at 0.07 and reaches 0.11 at 1e6; 0.19 would make 0.57 there."""
    law = CliftGraceWeber()
    assert law.coefficients([4.3e5, 9.5e5, 2e6]) == pytest.approx([0.0733, 0.1078, 0.11], abs=5e-5)


def test_balash_face_on_by_hand():
    """Sn 0.1, 0.2, 0.3 at Re' = 500: 0.146, 0.340, 0.719; a pressure has no part along the panel."""
    law = PANELS["balash"]()
    sn = np.array([0.1, 0.2, 0.3])
    assert law.coefficients(0.0, sn, 500.0 * (1.0 - sn))[0] == pytest.approx([0.146, 0.340, 0.719], abs=6e-4)
    drag, lift = law.coefficients(0.7, 0.2, 500.0)
    assert drag * np.sin(0.7) - lift * np.cos(0.7) == pytest.approx(0.0, abs=1e-15)


# Geometry


@given(st.floats(1e-3, 1e6), st.floats(0.0, np.pi))
def test_drag_and_lift_are_the_force_in_the_axes_of_the_flow(re, angle):
    """By vectors: bar along x, flow in the plane of x and y; the normal of the bar is y."""
    for law in MADE.values():
        normal, along = law.force(re, angle)
        force = np.array([along, normal])
        flow = np.array([np.cos(angle), np.sin(angle)])
        upwards = np.array(
            [-flow[1], flow[0]]
        )  # for a bar across this lift is along -x, towards the normal else
        drag, lift = law.drag_lift(re, angle)
        assert force @ flow == pytest.approx(float(drag), rel=1e-9, abs=1e-12)
        assert force @ upwards == pytest.approx(float(lift), rel=1e-9, abs=1e-9 * float(drag))
        assert drag >= 0.0


def test_hoerner_across_is_a_force_across_and_friction_along_the_flow():
    angle = np.linspace(0.0, np.pi, 19)
    normal, along = Hoerner().force(500.0, angle)
    assert normal == pytest.approx(1.1 * np.sin(angle) ** 2 + 0.02 * np.sin(angle), abs=1e-14)
    assert along == pytest.approx(0.02 * np.cos(angle), abs=1e-14)


def test_constant_law_is_that_of_the_inclined_bar():
    """The exact C_D and C_L that the force kernels are tested with."""
    angle = np.radians([0.0, 30.0, 60.0, 90.0])
    s, c = np.sin(angle), np.cos(angle)
    drag, lift = ConstantBar(1.2, 0.1).drag_lift(500.0, angle)
    assert drag == pytest.approx(1.2 * s**3 + 0.1 * c**3, abs=1e-14)
    assert lift == pytest.approx(1.2 * s**2 * c - 0.1 * c**2 * s, abs=1e-14)


# Smoothness

SPHERE_JOINTS = [0.01, 20.0, 260.0, 1500.0, 1.2e4, 4.4e4, 3.38e5, 4e5, 1e6, 1000.0]
JOINTS = [1.0, 30.0, 200.0, 2.33e5, 4.92e5, 10.0**1.5, 1e4, 200.0 / 0.04, *SPHERE_JOINTS]
EVERYWHERE = np.sort([*np.geomspace(1e-5, 1e8, 20011), *JOINTS, *(np.array(JOINTS) * (1.0 - 5e-7))])


def all_curves():
    yield from ((name, law.coefficients, law.derivative) for name, law in {**SPLIT, "table": TABLE}.items())
    yield from ((f"sphere {name}", law.coefficients, law.derivative) for name, law in SPHERES.items())


@pytest.mark.parametrize(
    ("coefficients", "derivative"), [one[1:] for one in all_curves()], ids=[o[0] for o in all_curves()]
)
def test_derivatives_are_those_of_a_complex_step(coefficients, derivative):
    step = 1e-30 * EVERYWHERE
    found = np.atleast_2d(derivative(EVERYWHERE))
    exact = np.atleast_2d(coefficients(EVERYWHERE + 1j * step)).imag / step
    size = np.abs(np.atleast_2d(coefficients(EVERYWHERE))) / EVERYWHERE
    rounding = 1e-9  # a polynomial of the seventh power loses four digits of sixteen, its derivative one more
    assert np.all(np.abs(found - exact) <= rounding * (size + np.abs(exact)))


def test_derivative_across_at_a_held_speed_along():
    law, re = ChooCasarella(), np.array([3.0, 30.0, 300.0])
    exact = law.coefficients(re + 1e-25j, 70.0)[1].imag / 1e-25
    assert law.derivative(re, 70.0)[1] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize(
    ("coefficients", "derivative"), [one[1:] for one in all_curves()], ids=[o[0] for o in all_curves()]
)
def test_no_coefficient_jumps(coefficients, derivative):
    """Two Reynolds numbers a millionth apart, on each side of every joint; a published jump is 0.002 at least."""
    near = EVERYWHERE * (1.0 + 1e-6)
    here, there = np.atleast_2d(coefficients(EVERYWHERE)), np.atleast_2d(coefficients(near))
    steepest = 10.0  # of C or 1 by ln Re; a jump by a quarter within the band has 0.29 * 1.875 / 0.0976 = 5.6
    assert np.all(np.abs(there - here) <= 1e-6 * steepest * np.maximum(np.abs(here), 1.0))


def test_force_grows_with_speed_but_where_the_page_says():
    """C Re^2 goes with the force; it falls in the drag crisis, and where a parabola of solidity nears its zero."""
    re = np.geomspace(1e-5, 1e8, 200001)
    falls = {"choo-casarella": (3.8e5, 5.1e5), "cifuentes-kim": (155.0 / 0.04, 211.0 / 0.04)}
    for law in [*SPLIT.values(), *SPHERES.values()]:
        found = law.coefficients(re)
        force = (found[0] if isinstance(found, tuple) else found) * re**2
        low, high = {**falls, "clift-grace-weber": (3.37e5, 4.1e5)}.get(law.name, (np.inf, np.inf))
        falling = re[1:][np.diff(force) <= 0.0]
        assert np.all((falling >= low) & (falling <= high)), law.name
        assert (falling.size > 0) == np.isfinite(low), law.name


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(1.0, 1e5))
def test_between_two_pieces_the_curve_stays_between_them(low, high, joint):
    curve = joined([level(low), level(high)], [joint])
    re = joint * np.geomspace(0.9, 1.1, 101)
    found = curve.value(re)
    assert np.all((found >= min(low, high) * (1 - 1e-14)) & (found <= max(low, high) * (1 + 1e-14)))
    assert np.all(found[re < joint / BAND] == low) and np.all(found[re > joint * BAND] == high)
    assert curve.value(np.array([joint]))[0] == pytest.approx((low + high) / 2.0)


@pytest.mark.parametrize("joints", [[], [2.0, 1.0], [1.0, 1.05]])
def test_pieces_without_room_for_their_joints_are_refused(joints):
    with pytest.raises(ValueError, match="joints"):
        joined([powers((1.0, 0.0))] * 3, joints)


def test_still_and_very_fast_water_have_finite_coefficients():
    re = np.array([0.0, 1e-300, 1e-6, 1e12, 1e30])
    with np.errstate(all="raise", under="ignore"):
        for law in [*MADE.values(), TABLE]:
            for angle in (0.0, 0.3, np.pi / 2.0):
                assert np.all(np.isfinite(law.drag_lift(re, angle)))
        for sphere in SPHERES.values():
            assert np.all(np.isfinite(sphere.coefficients(re))) and np.all(np.isfinite(sphere.derivative(re)))
        for panel in PANELS.values():
            assert np.all(np.isfinite(panel().coefficients(0.3, 0.2, re)))


# Measured points


# Ranges and tables


def test_values_outside_a_range_are_told_with_value_limit_and_how_many():
    told = outside(ChooCasarella(), reynolds=[1.0, 2e7, 3e7])
    assert told == (
        "drag law 'choo-casarella' is used outside its range at 2 of 3 bars: Re = 3e+07, above its limit of 1e+07",
    )
    assert outside(White(), reynolds=[0.5, 10.0]) == (
        "drag law 'white' is used outside its range at 1 of 2 bars: Re = 0.5, below its limit of 1",
    )
    assert outside(White(), reynolds=np.geomspace(1.0, 2e5, 9)) == ()
    assert outside(ConstantBar(), reynolds=1e30) == ()


def test_panels_are_judged_by_solidity_and_by_the_speed_between_the_twines():
    assert "solidity = 0.4, above its limit of 0.317" in outside(PANELS["loland"](), "panel", solidity=0.4)[0]
    (told,) = outside(KristiansenFaltinsen(), "panel", solidity=0.5, reynolds=6000.0)
    assert "Re/(1-Sn) = 1.2e+04, above its limit of 1e+04" in told
    assert outside(KristiansenFaltinsen(), "panel", solidity=0.2, reynolds=6000.0) == ()


def test_range_of_cifuentes_and_kim_goes_with_solidity():
    assert CifuentesKim(solidity=0.1).ranges == (Range("Re", 0.0, pytest.approx(20000.0)),)


def test_table_of_a_law_gives_the_law_back():
    re = np.geomspace(1.0, 1e4, 400)
    law = White()
    table = BarTable(tuple(re), tuple(law.coefficients(re)[0]), tuple(np.zeros(400)))
    between = np.sqrt(re[1:] * re[:-1])
    assert table.coefficients(re)[0] == pytest.approx(law.coefficients(re)[0], rel=1e-14)
    assert table.coefficients(between)[0] == pytest.approx(law.coefficients(between)[0], rel=2e-4)
    assert table.coefficients([0.0, 1e9])[0] == pytest.approx(law.coefficients([1.0, 1e4])[0], rel=1e-14)


def test_table_by_angle_is_straight_between_its_points_and_mirrors():
    table = AngleTable(
        (10.0, 1000.0),
        (0.0, np.pi / 4.0, np.pi / 2.0),
        ((0.1, 0.8, 2.0), (0.1, 0.4, 1.0)),
        ((0.0, 0.6, 0.0), (0.0, 0.3, 0.0)),
    )
    drag, lift = table.drag_lift([10.0, 100.0, 1000.0, 1e9], np.pi / 4.0)
    assert drag == pytest.approx([0.8, 0.6, 0.4, 0.4]) and lift == pytest.approx([0.6, 0.45, 0.3, 0.3])
    assert table.drag_lift(10.0, np.pi / 8.0) == (pytest.approx(0.45), pytest.approx(0.3))
    beyond = table.drag_lift(10.0, 3.0 * np.pi / 4.0)
    assert beyond == (pytest.approx(0.8), pytest.approx(-0.6))
    re = np.array([3.0, 11.0, 100.0, 2e3])
    exact = [one.imag / 1e-20 for one in table.drag_lift(re + 1e-20j, 0.5)]
    assert np.array(table.derivative(re, 0.5)) == pytest.approx(np.array(exact), rel=1e-12)


@pytest.mark.parametrize(
    ("reynolds", "normal"),
    [
        ((1.0,), (1.0,)),
        ((2.0, 1.0), (1.0, 1.0)),
        ((1.0, np.nan), (1.0, 1.0)),
        ((1.0, 2.0), (1.0, -1.0)),
        ((1.0, 2.0), (1.0,)),
    ],
)
def test_tables_that_cannot_be_used_are_refused(reynolds, normal):
    with pytest.raises(ValueError, match="must be"):
        BarTable(reynolds, normal, normal)


def test_every_law_states_what_a_reader_needs():
    for kind, laws in LAWS.items():
        for name, law in laws.items():
            assert name == law.name and law.title and law.area and law.source and law.read and law.__doc__, (
                kind
            )
    for laws in LAWS.values():
        assert all(a.name != b.name for a, b in pairwise(sorted(laws.values(), key=lambda one: one.name)))


def test_the_page_lists_every_law():
    page = (Path(__file__).parents[1] / "docs" / "laws.md").read_text(encoding="utf-8")
    told = re.findall(r"^\| `([\w-]+)` \|", page, re.MULTILINE)
    assert told == [name for laws in LAWS.values() for name in laws]
