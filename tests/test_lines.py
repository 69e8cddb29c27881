"""Lines free of netting: laid as they hang, made fast to nets, of several pieces, of chain."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import fyke
from fyke.netting.catenary import hanging_line
from fyke.netting.chain import chain
from fyke.netting.lines import LinePiece, weight_per_metre, with_line
from reference import grouped, table

ROPE = fyke.Twine("rope", density=950.0, diameter=0.03, law=fyke.LinearLaw(1e9))
CHAIN = chain(0.02)
POINTS = grouped("elastic_catenary_points")


def bars_of(row, count):
    """Length, weight and stiffness of the bars of a line of the table of catenaries."""
    length = np.full(count, row["L_m"] / count)
    return length, row["w_N_per_m"] * length, np.full(count, row["EA_N"])


@pytest.mark.parametrize("row", table("elastic_catenary"), ids=lambda r: r["case"])
def test_a_line_is_laid_along_the_elastic_catenary(row):
    """Ten exact points over the length; the places come nearer with the square of the bar length."""
    exact = np.array([[p["x_m"], 0.0, p["z_m"]] for p in POINTS[row["case"]]])
    wrong = []
    for count in (40, 80, 160):
        x = hanging_line(np.zeros(3), exact[-1], *bars_of(row, count))
        wrong.append(np.abs(x[:: count // 10] - exact).max() / row["L_m"])
    assert np.log2(wrong[0] / wrong[1]) == pytest.approx(2.0, abs=0.05)
    assert np.log2(wrong[1] / wrong[2]) == pytest.approx(2.0, abs=0.05)
    assert wrong[-1] < 2e-5


@pytest.mark.parametrize(
    "end", [(60.0, 30.0, 40.0), (99.0, 0.0, 5.0), (20.0, 0.0, -50.0), (0.0, 0.0, -100.0)]
)
@pytest.mark.parametrize(
    "twines", [(CHAIN, ROPE), (ROPE, CHAIN), (CHAIN, CHAIN)], ids=["rope", "chain", "one"]
)
def test_a_laid_line_is_in_equilibrium(twines, end):
    """Statics begun on the laid line moves no knot by more than rounding: its bars are these very bars."""
    pieces = [LinePiece(twines[0], 60.0, 12), LinePiece(twines[1], 40.5, 9)]
    net = with_line(None, (0.0, 0.0, -100.0), (end[0], end[1], end[2] - 100.0), pieces, name="m")
    system = fyke.make_system(net)
    result = fyke.solve_static(system, tolerance=1e-6)
    assert result.outcome.ok
    assert np.abs(result.position[-1] - net.positions).max() < 1e-4


def test_a_line_too_short_is_laid_straight_and_taut():
    x = hanging_line(np.zeros(3), np.array([3.0, 4.0, 12.0]), np.full(4, 3.0), np.zeros(4), np.full(4, 1e6))
    assert x == pytest.approx(np.outer(np.arange(5) / 4, [3.0, 4.0, 12.0]), abs=1e-9)


def test_a_line_that_is_long_lies_on_the_bed_without_stretch():
    """Chain of 120 m to a fairlead 20 m up and 105 m off: the catenary that leaves the ground level."""
    bars, w, depth = 1200, weight_per_metre(CHAIN, 1000.0, 9.81), 20.0
    length = np.full(bars, 0.1)
    begin, end = np.array([5.0, 0.0, -depth]), np.array([110.0, 0.0, 0.0])
    x = hanging_line(begin, end, length, w * length, np.full(bars, 1e12), bed=-depth)
    assert np.ptp(x[:, 1]) == 0.0 and x[:, 2].min() == -depth

    def c_of(s):  # H / w from s^2 = h^2 + 2 h c, s the length that hangs
        return (s**2 - depth**2) / (2.0 * depth)

    s = brentq(lambda s: 5.0 + 120.0 - s + c_of(s) * np.arcsinh(s / c_of(s)) - 110.0, depth + 0.1, 119.0)
    c, touch = c_of(s), 5.0 + 120.0 - s
    exact = np.where(x[:, 0] > touch, c * (np.cosh((x[:, 0] - touch) / c) - 1.0), 0.0) - depth
    assert 20.0 < s < 60.0
    assert x[:, 2] == pytest.approx(exact, abs=2e-3)
    assert np.diff(x[:400, 0]) == pytest.approx(0.1)


def test_lines_are_made_fast_to_knots_of_a_net():
    """The line has the knot itself, which keeps its place, label and hold; other knots keep their numbers."""
    twine = fyke.Twine("main", density=1140.0, diameter=2e-3, law=fyke.LinearLaw(1e9))
    net = fyke.panel(twine, mesh="square", meshes=(2, 2), bar_length=0.1, size=(0.2, 0.2), fixed="none")
    moored = with_line(net, (5.0, 0.0, -1.0), 4, [LinePiece(ROPE, 6.0, 5)], name="a")
    moored = with_line(moored, 4, (-5.0, 0.0, -1.0), [LinePiece(ROPE, 6.0, 5)], name="b")
    assert moored.labels[: net.knot_count] == net.labels
    assert moored.labels[net.knot_count :] == tuple(f"a:{i}" for i in range(5)) + tuple(
        f"b:{i}" for i in range(1, 6)
    )
    a, b = moored.ropes
    assert (a.kind, a.name, a.knots[-1], b.knots[0]) == ("line", "a", 4, 4)
    assert moored.fixed.sum() == 2 and moored.fixed[a.knots[0]] and moored.fixed[b.knots[-1]]
    assert np.array_equal(moored.positions[:9], net.positions)
    for rope in (a, b):
        ends = moored.bars[rope.bars]
        assert np.array_equal(ends, np.column_stack([rope.knots[:-1], rope.knots[1:]]))
        assert moored.rest_length[rope.bars].sum() == pytest.approx(6.0)


def test_a_free_end_hangs_below_the_other():
    """A free end of a weight is not held; statics lets the line down."""
    net = with_line(
        None, (0.0, 0.0, 0.0), (1.0, 0.0, -1.0), [LinePiece(CHAIN, 2.0, 4)], name="drop", held=(True, False)
    )
    result = fyke.solve_static(fyke.make_system(net))
    assert result.position[-1, -1] == pytest.approx([0.0, 0.0, -2.0], abs=1e-4)
    w = weight_per_metre(CHAIN, 1000.0, 9.81)
    assert result.tension[-1] == pytest.approx(w * (2.0 - 0.5 * np.arange(1, 5) + 0.25), rel=1e-6)


@pytest.mark.parametrize(
    ("begin", "end", "pieces", "said"),
    [
        ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), [], "no piece"),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), [LinePiece(ROPE, 1.0)], "ends where it begins"),
        (3, (0.0, 0.0, 0.0), [LinePiece(ROPE, 1.0)], "knot 3, which the net does not have"),
    ],
)
def test_what_is_no_line_is_refused(begin, end, pieces, said):
    with pytest.raises(ValueError, match=said):
        with_line(None, begin, end, pieces, name="m")


def test_a_piece_has_length_and_segments():
    with pytest.raises(ValueError, match="0 segments"):
        LinePiece(ROPE, 1.0, 0)


def test_chain_weighs_and_stretches_by_the_square_of_its_bar():
    """19.9 t/m and 0.854e8 kN for a bar of 1 m, the volume of a rod of 1.8 m; submerged 0.87 of dry in sea water."""
    one = chain(0.022)
    assert one.mass_per_length == pytest.approx(19.9e3 * 0.022**2, rel=1e-12)
    assert one.law.rows(one.diameter)[0, 2] == pytest.approx(0.854e11 * 0.022**2, rel=1e-12)
    assert one.diameter == pytest.approx(1.8 * 0.022)
    assert weight_per_metre(one, 1025.0, 9.81) / (9.81 * one.mass_per_length) == pytest.approx(
        0.87, abs=0.002
    )
    assert one.density == pytest.approx(7850.0, rel=0.01)  # steel
    assert chain(0.022, stud=True).mass_per_length == pytest.approx(21.9e3 * 0.022**2, rel=1e-12)
