"""Cages with half as many meshes each way: nothing is lost, and the real cage ends at the same shape from there."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from fyke.case import parse_case
from fyke.netting.halving import halved
from fyke.solve import nested
from fyke.system.halved import halved_system

CAGE = """
schema = 1
[current]
velocity = [0.3, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2 mm"
[twine.rope]
material = "PES"
diameter = "10 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "80 mm"
knot_diameter = "4 mm"
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [{around}, {down}]
diameter = {diameter}
height = {height}
bottom = {{ meshes = {bottom}, depth = {deep} }}
[[gear]]
kind = "rope"
name = "foot"
twine = "rope"
along = "cage.bottom"
[[gear]]
kind = "sinkers"
name = "leads"
along = "cage.bottom"
weight = "2 N"
density = 7850.0
count = {sinkers}
{more}
"""


def system_of(around=24, down=8, bottom=6, sinkers=24, more=""):
    sizes = {"diameter": around * 0.105 / np.pi, "height": down * 0.12, "deep": 0.1 * bottom / 6}
    case = parse_case(
        CAGE.format(around=around, down=down, bottom=bottom, sinkers=sinkers, more=more, **sizes)
    )
    return fyke.build_system(fyke.build_net(case), case)


@pytest.mark.parametrize(("around", "down", "bottom"), [(24, 8, 6), (26, 9, 7), (25, 8, 7)])
def test_nothing_is_lost(around, down, bottom):
    system = system_of(around, down, bottom, sinkers=5)
    small = halved(system.net)
    assert small is not None
    coarse = halved_system(system, small)
    one, all_of = system.elements, coarse.elements
    assert coarse.net.knot_count < 0.3 * system.net.knot_count
    for name in ("weight", "knot_mass", "knot_drag"):
        whole, left = getattr(one, name).sum(axis=0), getattr(all_of, name).sum(axis=0)
        assert left == pytest.approx(whole, rel=1e-12)
    assert coarse.displaced.knot.sum() == pytest.approx(system.displaced.knot.sum(), rel=1e-12)
    if around % 2 + down % 2 + bottom % 2 == 0:
        area = (one.normal_drag * one.rest_length).sum()
        assert (all_of.normal_drag * all_of.rest_length).sum() == pytest.approx(area, rel=1e-12)
    # The rope is as long as it was, and closed.
    (rope,), (was,) = coarse.net.ropes, system.net.ropes
    assert rope.knots[0] == rope.knots[-1]
    assert coarse.net.rest_length[rope.bars].sum() == pytest.approx(
        system.net.rest_length[was.bars].sum(), rel=1e-12
    )
    # Sheets share the knots of their seam.
    wall, floor = coarse.net.panels
    assert np.array_equal(np.sort(np.unique(wall.edge("bottom"))), np.sort(np.unique(floor.edge("top"))))
    assert len(np.unique(floor.edge("bottom"))) == 1
    lattices = sum(2 * 2 * a * 2 * b // 2 for a, b in (wall.meshes, floor.meshes))
    assert coarse.net.bar_count == lattices + len(rope.bars)


@pytest.mark.parametrize("more", ["", '[drag]\nbars = "choo-casarella"\n'])
def test_a_cage_ends_at_the_same_shape_either_way(monkeypatch, more):
    system = system_of(more=more)
    plain = fyke.solve_static(system)
    monkeypatch.setattr(nested, "LARGE_ROUND", 400)
    result = fyke.solve_static(system)
    assert plain.outcome.ok and "begun from" not in plain.outcome.message
    assert result.outcome.ok and "begun from 12 x 4 and 12 x 3 larger meshes" in result.outcome.message
    assert result.support_reaction[-1] == pytest.approx(plain.support_reaction[-1], abs=1e-6)
    taut = plain.tension[-1] > 1e-3
    assert result.tension[-1][taut] == pytest.approx(plain.tension[-1][taut], rel=1e-4)
    (wall, _) = system.net.panels
    knots = np.unique(wall.knots)
    assert np.abs(result.position[-1][knots] - plain.position[-1][knots]).max() < 1e-5


def test_what_cannot_be_halved_is_left_alone():
    assert halved(system_of(22, sinkers=22).net) is None  # too few meshes would be left
    bowed = CAGE.replace('bar_length = "80 mm"', 'bar_length = "80 mm"\nsegments = 2')
    text = bowed.format(around=24, down=8, bottom=6, sinkers=24, more="", diameter=0.8, height=0.96, deep=0.1)
    assert halved(fyke.build_net(parse_case(text))) is None
