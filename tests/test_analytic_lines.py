"""Lines cut into bars converge to the continuous line with the square of the bar length, and 50 bars give 1e-3."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from reference import NO_FORCES, NO_WATER, grouped, table, thread

# Tensile stiffness over tension that stands for "does not stretch": strain 1e-7, far below the errors of the cut.
STIFF = 1e7
NO_GRAVITY = fyke.Water(gravity=0.0)


def orders(errors):
    """Slopes between runs with twice as many bars each."""
    errors = np.array(errors)
    return np.log2(errors[:-1] / errors[1:])


def towards(a, b):
    return (b - a) / np.linalg.norm(b - a)


def catenary(row, bars):
    """Hang a line by both ends, each bar's weight half on its ends."""
    load = np.zeros((bars + 1, 3))
    load[:, 2] = -row["w_N_per_m"] * row["L_m"] / bars
    load[[0, -1]] *= 0.5
    points = np.linspace([0.0, 0.0, 0.0], [row["dx_m"], 0.0, row["dz_m"]], bars + 1)
    net = fyke.line(thread(row["EA_N"]), points, row["L_m"] / bars, load=load)
    result = fyke.solve_static(fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES), tolerance=1e-10)
    assert result.outcome.ok
    return result


POINTS = grouped("elastic_catenary_points")


@pytest.mark.parametrize("row", table("elastic_catenary"), ids=lambda r: r["case"])
def test_elastic_catenary(row):
    """End forces over the largest tension, and ten points over the length."""
    exact = np.array([[p["x_m"], 0.0, p["z_m"]] for p in POINTS[row["case"]]])
    largest = max(p["T_N"] for p in POINTS[row["case"]])
    forces, places = [], []
    for bars in (10, 20, 40):
        result = catenary(row, bars)
        x, tension = result.position[-1], result.tension[-1]
        half_bar = np.array([0.0, 0.0, 0.5 * row["w_N_per_m"] * row["L_m"] / bars])
        at_a = tension[0] * towards(x[0], x[1]) - half_bar
        at_b = tension[-1] * towards(x[-2], x[-1]) + half_bar
        wrong = [at_a - [row["H_N"], 0.0, row["VA_N"]], at_b - [row["H_N"], 0.0, row["VB_N"]]]
        forces.append(np.abs(wrong).max() / largest)
        places.append(np.abs(x[:: bars // 10] - exact).max() / row["L_m"])
    # The stiffest line, 6e11 N/m a bar, is known to 0.1 N in 9e4 N for the rounding of its coordinates.
    assert orders(forces) == pytest.approx(2.0, abs=0.05)
    assert orders(places) == pytest.approx(2.0, abs=0.05)
    assert forces[-1] < 2e-4 and places[-1] < 2e-4


def crossflow(row, bars):
    """Stretch a string across the current from its straight, slack state.

    Returns the errors of tension, camber, drag and lateral pull, and the spread of the tension, over the exact values.
    """
    half = row["half_span_m"]
    points = np.zeros((bars + 1, 3))
    points[:, 1] = np.linspace(-half, half, bars + 1)
    net = fyke.line(thread(STIFF * row["tension_N"], row["diameter_m"]), points, row["length_m"] / bars)
    coefficients = fyke.Coefficients(
        bars=fyke.ConstantBar(row["Cn"], 0.0),
        knots=fyke.ConstantKnot(0.0),
        added_mass_bar=0.0,
        added_mass_knot=0.0,
    )
    current = (row["speed_m_s"], 0.0, 0.0)
    system = fyke.make_system(net, current=current, water=NO_GRAVITY, coefficients=coefficients)
    result = fyke.solve_static(system)
    assert result.outcome.ok
    x, tension = result.position[-1], result.tension[-1]
    pull = tension[0] * towards(x[0], x[1]) + result.water_force[-1][0]
    drag = result.support_reaction[-1][0]
    found = np.array([tension.mean(), x[:, 0].max(), drag, pull[1]])
    exact = [row[key] for key in ("tension_N", "camber_m", "drag_N", "lateral_pull_N")]
    return np.append(found / exact - 1.0, np.ptp(tension) / row["tension_N"])


@pytest.mark.parametrize(
    "row", table("string_in_crossflow"), ids=lambda r: f"{r['length_m']} m {r['speed_m_s']} m/s"
)
def test_string_across_a_current(row):
    errors = [np.linalg.norm(crossflow(row, bars)) for bars in (10, 20, 40)]
    assert orders(errors) == pytest.approx(2.0, abs=0.1)
    *values, spread = crossflow(row, 50)
    assert np.abs(values).max() < 1e-3
    assert spread < 1.2e-3


def hang(row, bars, angle=np.pi / 2.0, gathered=1.0):
    """Let a line go at an angle (rad) from the vertical, streaming downstream by default.

    gathered: the part of its length over which the line is laid out.
    """
    s = np.linspace(0.0, row["length_m"] * gathered, bars + 1)
    points = np.outer(s, [np.sin(angle), 0.0, -np.cos(angle)])
    load = np.zeros_like(points)
    load[:, 2] = -row["w_N_per_m"] * row["length_m"] / bars
    load[[0, -1]] *= 0.5
    load[-1, 2] -= row["end_weight_N"]
    net = fyke.line(
        thread(STIFF * row["top_tension_N"], row["diameter_m"]),
        points,
        row["length_m"] / bars,
        fixed=(0,),
        load=load,
    )
    coefficients = fyke.Coefficients(
        bars=fyke.ConstantBar(row["Cn"], row["Ct"]),
        knots=fyke.ConstantKnot(0.0),
        added_mass_bar=0.0,
        added_mass_knot=0.0,
    )
    current = (row["speed_m_s"], 0.0, 0.0)
    system = fyke.make_system(net, current=current, water=NO_GRAVITY, coefficients=coefficients)
    return fyke.solve_static(system)


def hanging_errors(row, result):
    """Excursion and depth over the length, force on the top, its size and its parts, over its size."""
    end, force = result.position[-1][-1], result.support_reaction[-1]
    where = np.array([end[0] - row["excursion_m"], -end[2] - row["depth_m"]]) / row["length_m"]
    pull = np.array([np.linalg.norm(force), force[0], -force[2]])
    exact = [row["top_tension_N"], row["drag_N"], row["vertical_N"]]
    return np.concatenate([where, (pull - exact) / row["top_tension_N"]])


HANGING = table("hanging_line")


def name_of(row):
    return f"{row['case']} {row['speed_m_s']} m/s"


def bars_of(row):
    """Fifty, twice as many where the drag bends the line within one of them: radius W over the drag per length."""
    drag = 0.5 * 1000.0 * row["Cn"] * row["diameter_m"] * row["speed_m_s"] ** 2
    return 50 if row["end_weight_N"] / drag > row["length_m"] / 50 else 100


@pytest.mark.parametrize("row", HANGING, ids=name_of)
def test_line_hanging_in_a_current(row):
    for angle in (np.pi / 2.0, np.pi / 4.0):
        result = hang(row, bars_of(row), angle)
        assert result.outcome.ok
        assert np.abs(hanging_errors(row, result)).max() < 1e-3


def test_line_let_go_straight_down():
    """The start that a user draws, however strong the current."""
    for row in HANGING:
        for bars in (5, 10, 25, 50, 100):
            assert hang(row, bars, angle=0.0).outcome.ok, (name_of(row), bars)


def test_line_let_go_gathered():
    """A hundred metres of wire laid out over one, the rest slack."""
    row = next(r for r in HANGING if name_of(r) == "wire_warp 0.1 m/s")
    result = hang(row, 50, np.pi / 4.0, gathered=0.01)
    assert result.outcome.ok
    assert np.abs(hanging_errors(row, result)).max() < 1e-3


@pytest.mark.parametrize("row", [r for r in HANGING if r["speed_m_s"] in (0.5, 0.8, 1.0)], ids=name_of)
def test_order_of_a_line_hanging_in_a_current(row):
    errors = [np.linalg.norm(hanging_errors(row, hang(row, bars))) for bars in (20, 40, 80)]
    assert orders(errors) == pytest.approx(2.0, abs=0.15)


PROFILES = grouped("hanging_line_profiles")


@pytest.mark.parametrize("row", [r for r in HANGING if r["speed_m_s"] in (0.3, 1.0)], ids=name_of)
def test_shape_and_tension_along_a_hanging_line(row):
    """A hundred bars: the lower end of the lightest line turns by 42 degrees within a tenth of its length."""
    bars = 100
    result = hang(row, bars)
    points = [p for p in PROFILES[row["case"]] if p["speed_m_s"] == row["speed_m_s"]]
    assert len(points) == 11
    # A knot has the mean tension of the two bars that meet there.
    tension = 0.5 * (result.tension[-1][1:] + result.tension[-1][:-1])
    for p in points:
        knot = round(p["s_m"] / row["length_m"] * bars)
        place = result.position[-1][knot]
        assert np.abs(place - [p["x_m"], 0.0, p["z_m"]]).max() < 1e-3 * row["length_m"]
        if 0 < knot < bars:
            assert tension[knot - 1] == pytest.approx(p["tension_N"], rel=1e-3)
