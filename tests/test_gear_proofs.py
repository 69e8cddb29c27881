"""Whole gear against numbers that fyke did not make: weights by hand, symmetry."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from fyke.case import parse_case
from fyke.results import by_part

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
