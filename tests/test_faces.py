"""Faces: areas, vector areas, solidity and sides of the meshes against plane geometry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.netting.faces import Faces, faces_of
from fyke.netting.line import line
from fyke.netting.together import together

SIZE = {"diamond": (0.27, 0.35), "square": (0.19, 0.25)}


@pytest.fixture
def hung(nylon):
    """Return a maker of a panel that stands askew in space."""

    def make(mesh, meshes=(5, 7), **options):
        given = {
            "bar_length": 0.04,
            "size": SIZE[mesh],
            "centre": (1.0, -2.0, -3.0),
            "normal": (1.0, 2.0, 0.4),
        }
        return fyke.panel(nylon, mesh=mesh, meshes=meshes, **(given | options))

    return make


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("meshes", [(1, 1), (5, 7), (8, 3)])
def test_areas_fill_the_frame_and_point_to_the_normal(hung, mesh, meshes):
    net = hung(mesh, meshes)
    faces = faces_of(net)
    normal = np.array([1.0, 2.0, 0.4]) / np.linalg.norm([1.0, 2.0, 0.4])
    assert faces.area.sum() == pytest.approx(np.prod(SIZE[mesh]), rel=1e-13)
    assert faces.vector_area(net.positions) == pytest.approx(faces.area[:, None] * normal, abs=1e-16)


@pytest.mark.parametrize(
    ("mesh", "whole", "half"), [("diamond", 5 * 6 + 4 * 7, 2 * 5 + 2 * 7), ("square", 35, 0)]
)
def test_whole_and_half_meshes(hung, mesh, whole, half):
    """5 x 7 diamonds: two interlaced grids of whole ones, and as many halves as meshes along the four sides."""
    faces = faces_of(hung(mesh))
    assert np.count_nonzero(~faces.triangle) == whole
    assert np.count_nonzero(faces.triangle) == half
    assert faces.count == whole + half
    assert faces.share.sum(axis=1) == pytest.approx(np.ones(faces.count), rel=1e-15)
    assert np.all(faces.share[~faces.triangle] == 0.25)
    assert np.all(faces.share[faces.triangle] == [1 / 3, 1 / 3, 1 / 3, 0.0])


@pytest.mark.parametrize("mesh", ["diamond", "square"])
def test_a_uniform_force_and_its_moment_survive_the_sharing(hung, mesh):
    """Force per area on a flat panel: its shares have the same resultant, through the panel's centre."""
    net = hung(mesh)
    faces = faces_of(net)
    on_knots = np.zeros(net.knot_count)
    np.add.at(on_knots, faces.corners, faces.share * faces.area[:, None])
    centre = on_knots @ net.positions / on_knots.sum()
    assert on_knots.sum() == pytest.approx(np.prod(SIZE[mesh]), rel=1e-13)
    assert centre == pytest.approx([1.0, -2.0, -3.0], rel=1e-13)


@pytest.mark.parametrize(("mesh", "sides"), [("diamond", {2: 256}), ("square", {1: 32, 2: 112})])
def test_every_bar_is_a_side_of_its_meshes(hung, mesh, sides):
    """Diamonds have netting on both sides of every bar; squares but one mesh at a bar along the frame."""
    net = hung(mesh, (8, 8))
    faces = faces_of(net)
    there = faces.bars >= 0
    counts = np.bincount(faces.bars[there], minlength=net.bar_count)
    assert {int(k): int(np.count_nonzero(counts == k)) for k in np.unique(counts)} == sides
    after = np.roll(faces.corners, -1, axis=1)
    ends = np.sort(np.stack([faces.corners[there], after[there]], axis=1), axis=1)
    assert np.array_equal(np.sort(net.bars[faces.bars[there]], axis=1), ends)
    assert np.all(np.count_nonzero(there, axis=1) == np.where(faces.triangle, 2, 4))


def test_bars_are_found_whichever_way_and_order_they_are_written(hung):
    net = hung("diamond")
    order = np.random.default_rng(3).permutation(net.bar_count)
    where = replace(net.panels[0], bars=np.argsort(order)[net.panels[0].bars])
    turned = replace(net, bars=net.bars[order][:, ::-1].copy(), panels=(where,))
    want, got = faces_of(net).bars, faces_of(turned).bars
    assert np.array_equal(want >= 0, got >= 0)
    assert np.array_equal(order[got[got >= 0]], want[want >= 0])


def test_solidity_and_diameter_are_those_of_the_netting_knots_counted(hung):
    """Square 36 mm x 38.1 mm meshes of 1.5 mm twine with 4 mm knots, counted by hand."""
    net = hung("square", (5, 7), bar_length=0.04, size=(0.19, 0.25), knot_diameter=4e-3)
    a, b, d, k = 0.19 / 5, 0.25 / 7, 1.5e-3, 4e-3
    solid = d * (a - k) + d * (b - k) + np.pi * k**2 / 4
    faces = faces_of(net)
    assert faces.solidity == pytest.approx(np.full(35, solid / (a * b)), rel=1e-12)
    assert np.all(faces.diameter == 1.5e-3)


def test_faces_of_several_parts_lie_in_a_row(hung, nylon):
    rope = line(nylon, [[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1.0)
    thin = replace(nylon, name="thin", diameter=1e-3)
    first, second = (
        hung("square"),
        fyke.panel(thin, mesh="diamond", meshes=(3, 2), bar_length=0.05, size=(0.2, 0.15)),
    )
    both = faces_of(together([rope, first, second]))
    one, two = faces_of(first), faces_of(second)
    assert np.array_equal(both.corners, np.concatenate([one.corners + 3, two.corners + 3 + first.knot_count]))
    shifted = np.where(two.bars < 0, -1, two.bars + 2 + first.bar_count)
    assert np.array_equal(both.bars, np.concatenate([one.bars + 2, shifted]))
    assert np.array_equal(both.panel, np.repeat([0, 1], [one.count, two.count]))
    assert np.array_equal(both.diameter, np.repeat([1.5e-3, 1e-3], [one.count, two.count]))


def test_a_rope_has_no_faces(nylon):
    faces = faces_of(line(nylon, [[0, 0, 0], [1, 0, 0]], 1.0))
    assert isinstance(faces, Faces)
    assert (faces.count, faces.corners.shape, faces.vector_area(np.zeros((2, 3))).shape) == (
        0,
        (0, 4),
        (0, 3),
    )


def test_knots_that_are_not_those_of_the_meshes_are_refused(hung):
    net = hung("square")
    wrong = replace(net, panels=(replace(net.panels[0], meshes=(5, 6)),))
    with pytest.raises(ValueError, match="has 48 knots, but 5 x 6 square meshes have 42"):
        faces_of(wrong)


def test_a_twisted_quadrangle_has_the_vector_area_of_its_rim():
    """1/2 of the sum of x_k x x_k+1 round any closed rim."""
    x = np.random.default_rng(1).normal(size=(4, 3))
    one = np.arange(4)[None]
    faces = Faces(
        one, np.full((1, 4), 0.25), np.ones(1), np.ones(1), np.ones(1), np.zeros(1, dtype=np.int64), one
    )
    rim = 0.5 * np.cross(x, np.roll(x, -1, axis=0)).sum(axis=0)
    assert faces.vector_area(x)[0] == pytest.approx(rim, rel=1e-13)
