"""Shapes of netting, bars in segments, ropes, floats and sinkers: counts by hand, closed forms, other programs."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from fyke.netting.faces import faces_of
from fyke.netting.rigging import Sphere, evenly, with_bodies, with_rope
from fyke.netting.shapes import frustum
from fyke.netting.sheet import Netting

BAR = 0.1


def netting(mesh="diamond", **options):
    twine = fyke.Twine("n", 1140.0, 2.5e-3, fyke.LinearLaw(4e8))
    return Netting(twine, mesh, BAR, **options)


@pytest.mark.parametrize(
    ("mesh", "knots", "bars"), [("diamond", 12 * 7, 4 * 12 * 3), ("square", 12 * 4, 12 * 7)]
)
def test_a_cylinder_closes_by_construction(mesh, knots, bars):
    """12 meshes round and 3 deep: rows of 12 knots, every bar once, four or three bars at every inner knot."""
    net = frustum(netting(mesh), (12, 3), diameters=(0.5, 0.5), height=0.4, centre=(0.0, 0.0, -1.0))
    assert (net.knot_count, net.bar_count) == (knots, bars)
    assert len({tuple(sorted(bar)) for bar in net.bars.tolist()}) == bars
    ends = np.bincount(net.bars.ravel())
    rows = np.round(net.positions[:, 2], 9)
    inner = (rows < rows.max()) & (rows > rows.min())
    assert set(ends[inner]) == {4}
    assert np.hypot(*net.positions[:, :2].T) == pytest.approx(np.full(knots, 0.25))
    assert np.count_nonzero(net.fixed) == 12
    (panel,) = net.panels
    assert panel.shape == "cylinder"
    assert panel.edge("top")[0] == panel.edge("top")[-1]
    assert len(np.unique(panel.edge("bottom"))) == 12


@pytest.mark.parametrize("mesh", ["diamond", "square"])
def test_faces_of_a_cylinder_cover_it(mesh):
    """The vector areas of a closed wall cancel, their sizes come to the chords of the wall."""
    n = 24
    net = frustum(netting(mesh), (n, 3), diameters=(0.9, 0.9), height=0.5)
    faces = faces_of(net)
    vectors = faces.vector_area(net.positions)
    assert np.abs(vectors.sum(axis=0)).max() < 1e-12
    columns = n * (2 if mesh == "diamond" else 1)
    chord = 0.9 * np.sin(np.pi / columns)
    assert faces.area.sum() == pytest.approx(columns * chord * 0.5, rel=2e-2)
    # They all point outwards, or all inwards.
    middle = net.positions[faces.corners].mean(axis=1)
    outwards = np.einsum("pq,pq->p", vectors[:, :2], middle[:, :2])
    assert np.all(outwards > 0.0) or np.all(outwards < 0.0)


def test_a_cone_is_gathered_in_its_tip():
    net = frustum(netting(), (10, 4), diameters=(0.0, 0.6), height=0.5)
    assert net.knot_count == 10 * 8 + 1
    tip = np.flatnonzero(np.hypot(*net.positions[:, :2].T) < 1e-12)
    assert len(tip) == 1
    assert np.count_nonzero(net.bars == tip[0]) == 20
    assert net.panels[0].shape == "cone"
    with pytest.raises(ValueError, match="only diamond netting"):
        frustum(netting("square"), (10, 4), diameters=(0.0, 0.6), height=0.5)


def test_a_frustum_that_is_nearly_a_cylinder_hangs_like_one():
    """Shapes of the same meshes differ in their rims alone."""
    found = []
    for low in (0.6, 0.6 - 1e-6):
        net = frustum(netting(), (12, 3), diameters=(low, 0.6), height=0.45, centre=(0.0, 0.0, -0.2))
        result = fyke.solve_static(fyke.make_system(net, current=(0.3, 0.0, 0.0)))
        assert result.outcome.ok
        found.append(result.position[-1])
    assert np.abs(found[0] - found[1]).max() < 1e-6


def test_a_cylinder_turned_by_a_mesh_hangs_the_same():
    """Turning the current by the angle of one mesh turns the shape."""
    net = frustum(netting(), (12, 3), diameters=(0.6, 0.6), height=0.45, centre=(0.0, 0.0, -0.2))
    shapes = []
    for k in (0, 1):
        angle = 2.0 * np.pi * k / 12
        current = (0.3 * np.cos(angle), 0.3 * np.sin(angle), 0.0)
        shapes.append(fyke.solve_static(fyke.make_system(net, current=current), tolerance=1e-10).position[-1])
    turn = np.array([[np.cos(angle), np.sin(angle), 0.0], [-np.sin(angle), np.cos(angle), 0.0], [0, 0, 1.0]])
    back = shapes[1] @ turn.T
    for place in back:
        assert np.linalg.norm(shapes[0] - place, axis=1).min() < 1e-6


def test_a_panel_cuts_its_bars_itself(nylon):
    """Counts, labels and weight of a panel with three segments; the weight is that of whole bars."""
    whole, cut = (
        fyke.panel(nylon, mesh="diamond", meshes=(3, 2), bar_length=0.03, size=(0.127, 0.085), segments=s)
        for s in (1, 3)
    )
    assert cut.bar_count == 3 * whole.bar_count
    assert cut.knot_count == whole.knot_count + 2 * whole.bar_count
    assert cut.rest_length.sum() == pytest.approx(whole.rest_length.sum(), rel=1e-12)
    assert len(set(cut.labels)) == cut.knot_count
    assert cut.labels[whole.knot_count] == "0-0>1-1.1"
    weights = [fyke.make_system(net).weight_in_water for net in (whole, cut)]
    assert weights[0] == pytest.approx(weights[1], rel=1e-12)
    assert cut.panels[0].bars.shape == (whole.bar_count, 3)


def test_a_rope_along_a_rim_bears_what_the_netting_cannot():
    """A rope round the lower rim: its bars, its length, its name in a result file."""
    net = frustum(netting(), (12, 3), diameters=(0.6, 0.6), height=0.45)
    rope = fyke.Twine("rope", 950.0, 6e-3, fyke.LinearLaw(1e9))
    roped = with_rope(net, net.panels[0].edge("bottom"), rope, name="footrope")
    assert roped.bar_count == net.bar_count + 12
    (part,) = roped.ropes
    around = 12 * 0.6 * np.sin(np.pi / 12)
    assert roped.rest_length[part.bars].sum() == pytest.approx(around, rel=1e-12)
    tight = with_rope(net, net.panels[0].edge("bottom"), rope, length=0.9 * around, name="footrope")
    assert tight.rest_length[tight.ropes[0].bars].sum() == pytest.approx(0.9 * around, rel=1e-12)
    with pytest.raises(ValueError, match="two knots"):
        with_rope(net, [3], rope, name="short")


@pytest.mark.parametrize(("count", "closed"), [(16, True), (5, False), (1, True)])
def test_bodies_are_spread_evenly(count, closed):
    edge = np.append(np.arange(64), 0) if closed else np.arange(65)
    places = evenly(edge, count, closed=closed)
    assert len(set(places.tolist())) == count
    gaps = np.diff(places)
    assert np.ptp(gaps) <= 1 if len(gaps) else True
    if not closed:
        assert (places[0], places[-1]) == (0, 64)


def test_sinkers_hang_with_their_weight():
    """16 sinkers of 5.15 N on a cage: they are in the weight, the supports and the drag of still and moving water."""
    net = frustum(netting(), (16, 3), diameters=(0.8, 0.8), height=0.45, centre=(0.0, 0.0, -0.2))
    sinker = Sphere.of_weight(5.15, density=7850.0, water=1000.0)
    knots = evenly(net.panels[0].edge("bottom"), 16, closed=True)
    heavy = with_bodies(net, sinker.at(knots, name="sinkers", kind="sinker"))
    bare, loaded = (fyke.make_system(one) for one in (net, heavy))
    assert loaded.weight_in_water - bare.weight_in_water == pytest.approx(16 * 5.15, rel=1e-9)
    result = fyke.solve_static(loaded)
    assert result.support_reaction[-1][2] == pytest.approx(-loaded.weight_in_water, rel=1e-9)
    drag = [fyke.make_system(one, current=(0.5, 0.0, 0.0)).elements.knot_drag.sum() for one in (net, heavy)]
    area = 0.47 * np.pi / 4.0 * sinker.diameter**2
    assert drag[1] - drag[0] == pytest.approx(0.5 * 1000.0 * area * 16, rel=1e-9)


def test_drag_of_bodies_does_not_follow_the_law_of_the_knots():
    """Knots under a law of Re beside a sinker of constant C_D: forces add."""
    from fyke.forces.surroundings import Surroundings
    from fyke.water.laws.knots import CliftGauvin

    net = fyke.line(netting().twine, [[0, 0, 0], [0, 0, -0.1]], 0.1, fixed=(0,), knot_diameter=[0.0, 6e-3])
    heavy = with_bodies(net, Sphere(0.1, 0.03).at([1], name="lead", kind="sinker"))
    law = fyke.Coefficients(knots=CliftGauvin())
    for speed in (0.01, 0.3, 2.0):
        drags = [
            Surroundings(fyke.make_system(one, current=(speed, 0.0, 0.0), coefficients=law))
            .at(one.positions, np.zeros((2, 3)), 0.0)[0]
            .knot_drag[1]
            for one in (net, heavy)
        ]
        own = (
            0.5 * 1000.0 * np.pi / 4.0 * (6e-3) ** 2 * float(CliftGauvin().coefficients(speed * 6e-3 / 1e-6))
        )
        assert drags[0] == pytest.approx(own, rel=1e-6)
        assert drags[1] - drags[0] == pytest.approx(0.5 * 1000.0 * 0.47 * np.pi / 4.0 * 0.03**2, rel=1e-6)


def test_a_float_rides_with_the_water_it_displaces():
    """A sphere of half the water's density on a slack string floats half under: exactly at its middle."""
    net = fyke.line(
        fyke.Twine("s", 1000.0, 1e-4, fyke.LinearLaw(1e9)), [[0, 0, -2.0], [0, 0, 0.02]], 2.5, fixed=(0,)
    )
    float_ = Sphere(0.5 * 1000.0 * np.pi / 6.0 * 0.2**3, 0.2)
    system = fyke.make_system(with_bodies(net, float_.at([1], name="float", kind="float")), surface=True)
    result = fyke.simulate(
        system, duration=30.0, stepper=fyke.Implicit(), settle=fyke.Settle(force=1e-5), every=0.5
    )
    assert result.position[-1][1, 2] == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Sphere.of_weight(5.0, density=900.0, water=1000.0), "has no weight"),
        (lambda: Sphere.of_buoyancy(5.0, density=1100.0, water=1000.0), "does not lift"),
        (lambda: evenly(np.arange(5), 9, closed=False), "9 places"),
        (lambda: frustum(netting(), (5, 2), diameters=(0.0, 0.0), height=1.0), "make no frustum"),
        (lambda: frustum(netting(), (5, 2), diameters=(1.0, 1.0), height=0.0), "no netting between"),
    ],
)
def test_what_cannot_be_made_is_told(make, words):
    with pytest.raises(ValueError, match=words):
        make()


def test_a_cage_encloses_its_prism_and_cone():
    """The volume of a cage as built, by its corners: prism of the rim's polygon and a pyramid below."""
    from fyke.netting.shapes import cage
    from fyke.results.volume import enclosed_volume

    n, depth, sink = 24, 0.8, 0.3
    for bottom, cone in ((None, 0.0), ((3, 0.0), 0.0), ((3, sink), sink / 3.0)):
        net = cage(netting("diamond"), (n // 2, 4), diameter=1.0, depth=depth, bottom=bottom)
        polygon = 0.5 * n * 0.25 * np.sin(2.0 * np.pi / n)
        found = enclosed_volume(net, net.positions)
        # Rims of diamond netting have every other corner of the polygon.
        assert found == pytest.approx(polygon * (depth + cone), rel=3e-2)
        moved = net.positions @ np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0] + 5.0
        assert enclosed_volume(net, moved) == pytest.approx(found, rel=1e-9)
        assert enclosed_volume(net, 2.0 * net.positions) == pytest.approx(8.0 * found, rel=1e-9)
    square = cage(netting("square"), (n, 4), diameter=1.0, depth=depth)
    assert enclosed_volume(square, square.positions) == pytest.approx(polygon * depth, rel=1e-12)


def test_a_cage_with_its_bottom_is_one_net():
    """The rim's knots are shared: no knot twice in one place, and the bottom hangs from the wall."""
    from fyke.netting.shapes import cage

    net = cage(netting(), (12, 3), diameter=0.9, depth=0.6, bottom=(3, 0.2), top=(0.0, 0.0, -0.1))
    apart = np.linalg.norm(net.positions[:, None] - net.positions[None], axis=2) + np.eye(net.knot_count)
    assert apart.min() > 1e-6
    assert [one.name for one in net.panels] == ["cage", "cage bottom"]
    wall, floor = net.panels
    assert set(wall.edge("bottom")) == set(floor.edge("top"))
    result = fyke.solve_static(fyke.make_system(net))
    assert result.outcome.ok
    assert result.support_reaction[-1][2] == pytest.approx(-result.weight_in_water, rel=1e-6)


@pytest.mark.parametrize(("many", "few", "closed"), [(12, 8, True), (9, 9, False), (13, 7, False)])
def test_a_seam_takes_up_meshes_evenly(many, few, closed):
    from fyke.netting.joining import seam

    one, other = np.arange(many + 1), 100 + np.arange(few + 1)
    if closed:
        one[-1], other[-1] = one[0], other[0]
    stays, goes = seam(one, other, closed=closed)
    longer = one if many > few else other
    assert sorted(goes.tolist()) == sorted(set(longer.tolist()))
    counts = np.unique(stays, return_counts=True)[1]
    assert np.ptp(counts) <= 1
    assert len(goes) == len(set(goes.tolist()))
