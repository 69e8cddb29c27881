"""Whole gear against numbers that fyke did not make: netting under pressure, weights by hand, symmetry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.case import parse_case
from fyke.netting.faces import faces_of
from fyke.netting.shapes import frustum
from fyke.netting.sheet import Netting
from fyke.results import by_part

# Closed forms as they were worked out apart from fyke: uniform pressure arc, pressurised net tube.
ARCS = [  # half span (m), length (m), pressure (Pa), tension per width (N/m), camber (m)
    (0.5, 1.1, 100.0, 73.43255122, 0.1965207541),
    (0.5, 1.3, 100.0, 53.21342729, 0.3500164967),
]
TUBES = [  # meshes round, bar (m), EA (N), pressure (Pa), length of a bar (m), radius (m), tension (N), axial force (N)
    (60, 0.05, 500.0, 500.0, 0.05145999096, 0.8024638068, 14.59990957, 1011.511406),
    (60, 0.05, 1e7, 500.0, 0.05, 0.7796968012, 13.78322239, 954.9296586),
]


def settled(net, load, rounds=40):
    """Solve under a load that turns with the net, made dead in turns until it no longer changes."""
    result, start = None, None
    for _ in range(rounds):
        here = net.positions if start is None else start.position
        system = fyke.make_system(replace(net, load=load(here)), current=(0.0, 0.0, 0.0))
        result = fyke.solve_static(system, start=start)
        assert result.outcome.ok, result.outcome.message
        moved = np.abs(result.position[-1] - here).max()
        start = result.state()
        if moved < 1e-9:
            return result
    raise AssertionError(f"still moves by {moved} m")


def strip(half_span, length, bars):
    """A weightless, hardly stretching strip of unit width along x, sagging to z < 0 as it is built."""
    t = np.linspace(-1.0, 1.0, bars + 1)
    positions = np.column_stack([half_span * t, np.zeros(bars + 1), -0.3 * (1.0 - t**2)])
    twine = fyke.Twine("strip", 1000.0, 1e-3, fyke.LinearLaw(1e7 / (0.25e-6 * np.pi)))
    n = bars + 1
    return fyke.Net(
        positions=positions,
        labels=tuple(map(str, range(n))),
        fixed=np.isin(np.arange(n), [0, bars]),
        bars=np.column_stack([np.arange(bars), np.arange(1, n)]),
        rest_length=np.full(bars, length / bars),
        twines=(twine,),
        twine_of_bar=np.zeros(bars, dtype=np.int64),
        knot_diameter=np.zeros(n),
        knot_density=np.zeros(n),
        load=np.zeros((n, 3)),
    )


@pytest.mark.parametrize(("half_span", "length", "pressure", "tension", "camber"), ARCS)
def test_uniform_pressure_bends_a_strip_to_a_circle(half_span, length, pressure, tension, camber):
    """Tension and camber of the arc, with an error that falls as the square of the number of bars."""
    errors = []
    for bars in (10, 20, 40):
        net = strip(half_span, length, bars)

        def push(x):
            out = np.zeros_like(x)
            chord = 0.5 * pressure * (x[1:] - x[:-1])
            normal = np.column_stack([chord[:, 2], np.zeros(len(chord)), -chord[:, 0]])
            out[1:] += normal
            out[:-1] += normal
            return out

        last = settled(net, push).frame()
        errors.append(
            (abs(last.tension.mean() / tension - 1.0), abs(-last.position[:, 2].min() / camber - 1.0))
        )
        assert np.ptp(last.tension) < 1e-5 * tension
    errors = np.array(errors)
    assert errors[-1].max() < 1e-3
    orders = np.log2(errors[:-1] / errors[1:])
    assert orders == pytest.approx(np.full((2, 2), 2.0), abs=0.15)


@pytest.mark.parametrize(("around", "bar", "ea", "pressure", "length", "radius", "tension", "axial"), TUBES)
def test_a_tube_of_netting_under_pressure_stands_at_its_angle(
    around, bar, ea, pressure, length, radius, tension, axial
):
    """tan(angle) = sqrt 2, whatever the netting; here its lower rim is held at the radius that belongs to that."""
    diameter = 2e-3
    twine = fyke.Twine("t", 1000.0, diameter, fyke.LinearLaw(ea / (0.25 * np.pi * diameter**2)))
    down = 8
    built = frustum(
        Netting(twine, "diamond", bar),
        (around, down),
        diameters=(2.0 * radius, 1.9 * radius),
        height=1.9 * down * bar * 0.5,
        fixed="none",
    )
    (panel,) = built.panels
    low, high = np.unique(panel.edge("bottom")), np.unique(panel.edge("top"))
    net = replace(built, fixed=np.isin(np.arange(built.knot_count), low))
    faces = faces_of(net)
    centre = net.positions[low].mean(axis=0)

    def push(x):
        out = np.zeros_like(x)
        for k in range(4):
            np.add.at(out, faces.corners[:, k], faces.share[:, [k]] * pressure * faces.vector_area(x))
        outwards = np.einsum("nq,nq->n", out[:, :2], (x - centre)[:, :2]).sum()
        out *= np.sign(outwards)
        r = np.hypot(*(x[high] - centre)[:, :2].T).mean()
        out[high, 2] += pressure * np.pi * r * r / around
        return out

    last = settled(net, push).frame()
    a, b = last.position[net.bars].transpose(1, 0, 2)
    angle = np.arccos(np.abs((b - a)[:, 2]) / np.linalg.norm(b - a, axis=1))
    middle = np.abs(0.5 * (a + b)[:, 2] - last.position[:, 2].mean()) < 0.25 * np.ptp(last.position[:, 2])
    assert np.tan(angle[middle]) == pytest.approx(np.full(middle.sum(), np.sqrt(2.0)), rel=2e-3)
    assert last.tension[middle].mean() == pytest.approx(tension, rel=1e-3)
    assert last.tension[middle] == pytest.approx(np.full(middle.sum(), tension), rel=3e-3)
    assert np.linalg.norm(b - a, axis=1)[middle] == pytest.approx(np.full(middle.sum(), length), rel=1e-4)
    assert -last.support_reaction[2] == pytest.approx(-axial, rel=1e-3)


CAGE = """
schema = 1
[water]
density = 1025.0
[current]
velocity = [{speed}, 0.0, 0.0]
[twine.main]
density = 1140.0
diameter = "2 mm"
youngs_modulus = "1 GPa"
[twine.rope]
density = 1380.0
diameter = "8 mm"
youngs_modulus = "2 GPa"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "80 mm"
knot_diameter = "5 mm"
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [24, 6]
diameter = "0.9 m"
height = "0.75 m"
top = [0.0, 0.0, -0.3]
bottom = {{ meshes = 5, depth = "0.2 m" }}
[[gear]]
kind = "rope"
name = "footrope"
twine = "rope"
along = "cage.bottom"
length = "2.9 m"
[[gear]]
kind = "sinkers"
name = "leads"
along = "cage.bottom"
count = {sinkers}
mass = "0.2 kg"
diameter = "40 mm"
"""


def cage(speed, sinkers=24):
    case = parse_case(CAGE.format(speed=speed, sinkers=sinkers))
    return fyke.build_system(fyke.build_net(case), case)


def test_a_submerged_cage_weighs_what_its_pieces_weigh():
    """Weight less buoyancy, counted by hand, is what the system says and what the supports bear in still water."""
    g, water = 9.81, 1025.0
    bars = 2 * 24 * (2 * 6) + 2 * 24 * (
        2 * 5
    )  # two of either direction in a mesh and row, of wall and bottom
    knots = (
        24 * (2 * 6 + 1) + 24 * (2 * 5) - 24 + 1
    )  # rows of the wall, those of the bottom below the rim, the tip
    netting = bars * (1140.0 - water) * 0.25 * np.pi * 0.002**2 * 0.08
    balls = knots * (1140.0 - water) * np.pi / 6.0 * 0.005**3
    rope = (1380.0 - water) * 0.25 * np.pi * 0.008**2 * 2.9
    leads = 24 * (0.2 - water * np.pi / 6.0 * 0.04**3)
    weight = g * (netting + balls + rope + leads)
    system = cage(0.0)
    assert (system.net.knot_count, system.net.bar_count) == (knots, bars + 24)
    assert system.weight_in_water == pytest.approx(weight, rel=1e-10)
    last = fyke.solve_static(system).frame()
    assert last.support_reaction[2] == pytest.approx(-weight, rel=1e-9)
    parts = by_part(system, fyke.solve_static(system))
    assert sum(part.weight_in_water for part in parts) == pytest.approx(weight, rel=1e-10)


def test_a_cage_in_still_water_is_the_same_from_every_side():
    """With a sinker at every mesh, all knots of a height are at one radius and one depth."""
    system = cage(0.0)
    result = fyke.solve_static(system)
    assert result.outcome.ok
    (x, y, z), net = result.position[-1].T, system.net
    around = np.hypot(x, y)
    (wall, _) = net.panels
    for row in range(2 * 6 + 1):
        knots = np.unique(wall.knots[wall.lattice.knots[:, 1] == row])
        assert len(knots) == 24
        assert np.ptp(around[knots]) < 1e-7
        assert np.ptp(z[knots]) < 1e-7


def test_a_cage_in_a_current_is_its_own_mirror_image():
    """The wall, all of it taut, is the same on both sides of the current, and no force points across."""
    system = cage(0.3)
    result = fyke.solve_static(system)
    last, net = result.frame(), system.net
    assert abs(last.support_reaction[1]) < 1e-6 * np.linalg.norm(last.support_reaction)
    built = net.positions * [1.0, -1.0, 1.0]
    mirror = np.linalg.norm(net.positions[:, None] - built[None], axis=2).argmin(axis=1)
    (wall, _) = net.panels
    knots = np.unique(wall.knots)
    apart = last.position[knots] * [1.0, -1.0, 1.0] - last.position[mirror[knots]]
    assert np.abs(apart).max() < 1e-6
