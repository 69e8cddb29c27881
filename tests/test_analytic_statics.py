"""Statics against solutions that hold exactly for knots and bars: 1e-8, and 1e-10 for one bar."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.evaluate import evaluate
from reference import NO_FORCES, NO_WATER, grouped, table, thread

CHAINS = grouped("lumped_chain")


def starts(ends, knots):
    """Places to begin from: along the chord, where bars are slack, in heaps, and all in one place."""
    chord = np.linspace(*ends, knots)
    yield "chord", chord
    for scale, seed in ((0.5, 1), (0.5, 2), (20.0, 3)):
        heap = chord.copy()
        heap[1:-1] = np.random.default_rng(seed).normal(scale=scale, size=(knots - 2, 3))
        yield f"heap of {scale} m", heap
    gathered = chord.copy()
    gathered[1:-1] = chord[0]
    yield "one place", gathered


@pytest.mark.parametrize("case", CHAINS)
def test_chain_of_point_weights_from_any_start(case):
    rows = CHAINS[case]
    exact = np.array([[r["x_m"], 0.0, r["z_m"]] for r in rows])
    tension = np.array([r["tension_N"] for r in rows[:-1]])
    length = rows[0]["l0_m"]
    load = np.zeros_like(exact)
    load[1:-1, 2] = -rows[0]["knot_weight_N"]
    for name, points in starts(exact[[0, -1]], len(exact)):
        net = fyke.line(thread(rows[0]["k_N_per_m"] * length), points, length, load=load)
        system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
        result = fyke.solve_static(system, tolerance=1e-10)
        assert result.outcome.ok, (name, result.outcome)
        assert np.abs(result.position[-1] - exact).max() < 1e-8, name
        assert np.abs(result.tension[-1] - tension).max() < 1e-8, name


@pytest.mark.parametrize("row", table("inclined_bar"), ids=lambda r: f"{r['alpha_deg']:g} deg")
def test_drag_and_lift_of_an_inclined_bar(row):
    density, speed, diameter, length = 1025.0, 0.7, 2e-3, 0.03
    angle = np.radians(row["alpha_deg"])
    c, s = np.cos(angle), np.sin(angle)
    net = fyke.line(thread(1e3, diameter), [[0.0, 0.0, 0.0], [length * c, 0.0, length * s]], length)
    system = fyke.make_system(net, current=(speed, 0.0, 0.0), water=fyke.Water(density))
    frame = evaluate(system, system.at_rest())
    scale = 0.5 * density * speed**2 * diameter * length
    drag, lift = frame.bar_drag[0] / scale, frame.bar_lift[0] / scale
    assert drag == pytest.approx(1.2 * s**3 + 0.1 * c**3, abs=1e-10)
    assert lift == pytest.approx(1.2 * s * s * c - 0.1 * c * c * s, abs=1e-10)
    # The table has ten digits.
    assert drag == pytest.approx(row["CD"], rel=5e-10, abs=1e-10)
    assert lift == pytest.approx(row["CL"], rel=5e-10, abs=1e-10)
    # The bar rises downstream: the normal that points downstream points down.
    assert np.abs(frame.hydrodynamic_force / scale - [drag, 0.0, -lift]).max() < 1e-10


@pytest.mark.parametrize("row", table("sphere_on_string"), ids=lambda r: f"{r['speed_m_s']} m/s")
def test_sphere_on_a_string_in_a_current(row):
    """A string of stiffness k is T/k too long, so two stiffnesses give the place on one that does not stretch."""

    def hang(stiffness):
        net = fyke.line(
            thread(stiffness, diameter=1e-4),
            [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
            1.0,
            fixed=(0,),
            knot_diameter=[0.0, 0.04],
            knot_density=7850.0,
        )
        coefficients = fyke.Coefficients(
            bars=fyke.ConstantBar(0.0, 0.0),
            knots=fyke.ConstantKnot(0.47),
            added_mass_bar=0.0,
            added_mass_knot=0.0,
        )
        system = fyke.make_system(net, current=(row["speed_m_s"], 0.0, 0.0), coefficients=coefficients)
        result = fyke.solve_static(system, tolerance=1e-10)
        assert result.outcome.ok
        return result

    soft, stiff = hang(1e5), hang(2e5)
    x, _, z = 2.0 * stiff.position[-1][1] - soft.position[-1][1]
    assert x == pytest.approx(row["excursion_m"], abs=1e-8)
    assert z == pytest.approx(-row["depth_m"], abs=1e-8)
    assert stiff.tension[-1][0] == pytest.approx(row["tension_N"], abs=1e-8)
    assert stiff.weight_in_water == pytest.approx(row["weight_N"], abs=1e-8)
    assert stiff.hydrodynamic_force[-1][0] == pytest.approx(row["drag_N"], abs=1e-8)


def rows_and_columns(net):
    return np.array([[int(part) for part in label.split("-")] for label in net.labels])


@pytest.mark.parametrize("start_height", [0.5, 1.0, 1.3])
def test_square_sheet_hanging_in_still_water(start_height):
    """Weights come from densities and sizes; the side columns, which have half a bar less, get it as dead load."""
    columns, bars, bar, gravity = 3, 8, 0.03, 9.81
    diameter, knot = 3e-3, 6e-3
    volume, knot_volume = np.pi / 4.0 * diameter**2 * bar, np.pi / 6.0 * knot**3
    height = bars * bar * start_height
    net = fyke.panel(
        thread(5000.0 * bar, diameter, density=1000.0 + 0.0005 / (gravity * volume)),
        mesh="square",
        meshes=(columns, bars),
        bar_length=bar,
        size=(columns * bar, height),
        knot_diameter=knot,
        knot_density=1000.0 + 0.001 / (gravity * knot_volume),
        centre=(0.0, 0.0, -height / 2.0),
        fixed="top",
    )
    i, j = rows_and_columns(net).T
    load = np.zeros_like(net.positions)
    load[(i == 0) | (i == columns), 2] -= 0.00025
    load[j == 0, 2] -= 0.05
    net = replace(net, load=load)
    result = fyke.solve_static(fyke.make_system(net), tolerance=1e-10)
    assert result.outcome.ok
    rows = table("hanging_sheet")
    depth = np.array([0.0, *(r["z_lower_knot_m"] for r in rows)])
    assert np.abs(result.position[-1][:, 2] - depth[bars - j]).max() < 1e-8
    assert np.abs(result.position[-1][:, :2] - net.positions[:, :2]).max() < 1e-8
    a, b = net.bars.T
    upright = i[a] == i[b]
    from_top = bars - 1 - np.minimum(j[a], j[b])[upright]
    tension = np.array([r["tension_N"] for r in rows])[from_top]
    assert np.abs(result.tension[-1][upright] - tension).max() < 1e-8
    assert result.tension[-1][~upright].max() < 1e-8


@pytest.mark.parametrize("row", table("hanging_diamond"), ids=lambda r: f"E = {r['E']:g}")
def test_diamond_netting_hung_at_a_ratio(row):
    """Dead load on the side knots holds the width: the pull of two bars there, W tan(phi) / n, of one at the bottom.

    Two stiffnesses give the netting that does not stretch. The start has half the height, all bars slack.
    """
    across, down, weight = 10, 8, 0.5
    tan = row["E"] / np.sqrt(1.0 - row["E"] ** 2)

    def hang(stiffness):
        bar = 0.03
        height = row["height_m"] / 2.0
        net = fyke.panel(
            thread(stiffness * bar),
            mesh="diamond",
            meshes=(across, down),
            bar_length=bar,
            size=(row["width_m"], height),
            centre=(0.0, 0.0, -height / 2.0),
            fixed="top",
        )
        i, j = rows_and_columns(net).T
        side = np.where(i == 0, -1.0, np.where(i == 2 * across, 1.0, 0.0))
        share = np.where(side == 0.0, 1.0, 0.5)
        load = np.outer(weight / across * tan * side * np.where(j == 0, 0.5, 1.0), [0.0, 1.0, 0.0])
        load[j == 0, 2] -= (weight / across * share)[j == 0]
        system = fyke.make_system(replace(net, load=load), water=NO_WATER, coefficients=NO_FORCES)
        result = fyke.solve_static(system, tolerance=1e-10)
        assert result.outcome.ok
        return result

    soft, stiff = hang(4e5), hang(8e5)
    shape = 2.0 * stiff.position[-1] - soft.position[-1]
    i, j = rows_and_columns(stiff.net).T
    x = (i / (2 * across) - 0.5) * row["width_m"]
    z = (j / (2 * down) - 1.0) * row["height_m"]
    exact = np.outer(x, [0.0, 1.0, 0.0]) + np.outer(z, [0.0, 0.0, 1.0])
    assert np.abs(shape - exact).max() < 1e-8
    assert np.abs(2.0 * stiff.tension[-1] - soft.tension[-1] - row["tension_N"]).max() < 1e-8
