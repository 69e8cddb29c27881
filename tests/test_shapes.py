"""Netting cut to shape: counts and angles of the trade, tidy edges, areas by formulas."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.case import CaseError, parse_case
from fyke.cli.check import check_case
from fyke.forces.screens import Screens
from fyke.netting.cutting import Taper, cuts_of, lost, rate_of, repeated, spread
from fyke.netting.faces import faces_of
from fyke.netting.hexagon import Hexagon
from fyke.netting.joining import stitches
from fyke.netting.measures import measure_panel
from fyke.netting.panel import panel
from fyke.netting.shapes import bag, box, cage, frustum
from fyke.netting.sheet import Netting, sheet
from fyke.netting.together import together
from fyke.results.volume import enclosed_volume
from fyke.water.laws.panels import Aarsnes

BAR = 0.05
TWINE = fyke.Twine("n", 1140.0, 2e-3, fyke.LinearLaw(1e9))
OTHER = {"bottom": "top", "top": "bottom"}


def cut_panel(taper, wide, deep, *, mesh="diamond", ratios=(0.6, 0.8), **options):
    step = 2.0 * BAR if mesh == "diamond" else BAR
    size = (wide * step * ratios[0], deep * step * ratios[1])
    return panel(TWINE, mesh=mesh, meshes=(wide, deep), bar_length=BAR, size=size, taper=taper, **options)


@pytest.mark.parametrize(
    ("taken", "deep", "rate"),
    [(20, 30, "1N4B"), (25, 25, "AB"), (40, 25, "3T10B"), (10, 25, "3N4B"), (50, 30, "1T3B")],
)
def test_rates_are_those_that_lectures_work_out(taken, deep, rate):
    """Meshes lost, meshes deep and the answer: the first of Fishing Gear Technology, the others of "Net cutting"."""
    assert rate_of(taken, deep) == rate
    assert lost(spread(taken, deep, "diamond"), "diamond") == taken
    assert lost(repeated(cuts_of(rate), deep, "diamond"), "diamond") == pytest.approx(taken, abs=1)


@pytest.mark.parametrize(
    ("rate", "over"),
    [
        ("AN", 0.0),
        ("1N1B", 1 / 3),
        ("1N2B", 1 / 2),
        ("1N4B", 2 / 3),
        ("AB", 1.0),
        ("1T2B", 2.0),
        ("1T1B", 3.0),
    ],
)
@pytest.mark.parametrize("narrow", ["bottom", "top"])
def test_a_side_leans_by_its_rate_and_hanging_ratios(rate, over, narrow):
    """tan of the angle to the height is D/d E1/E2, D meshes lost over d: the tables of the trade, and geometry."""
    deep, e1, e2 = 24, 0.6, 0.8
    cuts = repeated(cuts_of(rate), deep, "diamond")
    wide = 2 * lost(cuts, "diamond") + 3
    net = cut_panel(Taper(cuts, cuts, narrow), wide, deep, ratios=(e1, e2))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        low, high = net.positions[net.panels[0].edge(side)[[0, -1]]]
        run, rise = (high - low)[1:]
        inwards = sign * (run if narrow == "top" else -run)
        assert inwards / rise == pytest.approx(over * e1 / e2, rel=1e-12)


def drawn(count, mesh, seed):
    """Counts of some panels: meshes lost left and right, of height and left over."""
    numbers = np.random.default_rng(seed)
    for _ in range(count):
        yield (*numbers.integers(0, 13, 2), numbers.integers(2, 10), numbers.integers(mesh == "square", 4))


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("narrow", ["bottom", "top"])
def test_cut_edges_are_tidy(mesh, narrow):
    """The ends have their meshes, faces fill the outline, and only the four corners may hang on one bar."""
    for left, right, deep, rest in drawn(25, mesh, 7):
        wide = int(left + right + rest)
        if wide == 0:
            continue
        taper = Taper(spread(int(left), int(deep), mesh), spread(int(right), int(deep), mesh), narrow)
        net = cut_panel(taper, wide, int(deep), mesh=mesh)
        (where,) = net.panels
        assert len(where.edge(narrow)) == rest + 1
        assert len(where.edge(OTHER[narrow])) == wide + 1
        assert where.shape == ("triangle" if rest == 0 else "trapezoid")
        bars = np.bincount(net.bars.ravel(), minlength=net.knot_count)
        sides = [where.edge(side) for side in ("left", "right")]
        corners = np.unique([side[[0, -1]] for side in sides])
        assert np.delete(bars, corners).min() >= 2
        assert bars.min() >= 1
        on_edge = np.unique(np.concatenate([*sides, where.edge("top"), where.edge("bottom")]))
        low, high = net.positions[:, 2].min(), net.positions[:, 2].max()
        inner = np.delete(np.arange(net.knot_count), on_edge)
        assert set(bars[inner]) <= {2, 3, 4}
        assert np.all((net.positions[inner, 2] > low) & (net.positions[inner, 2] < high))
        outline = measure_panel(net, where).outline_area
        assert faces_of(net).area.sum() == pytest.approx(outline, rel=1e-12)


def test_area_and_twine_of_a_trapezoid_by_formulas():
    """AB on both sides: the area of the trapezoid, and four bars for every whole mesh, shared by two."""
    wide, deep = 20, 6
    cuts = "B" * (2 * deep)
    net = cut_panel(Taper(cuts, cuts), wide, deep)
    mesh = 2.0 * BAR * np.array([0.6, 0.8])
    area = 0.5 * (wide + wide - 2 * deep) * mesh[0] * deep * mesh[1]
    assert measure_panel(net, net.panels[0]).outline_area == pytest.approx(area, rel=1e-12)
    # Between two rows of k + 1 and k knots lie 2 k bars: rows have wide + 1 knots, then one fewer each.
    assert net.bar_count == sum(2 * k for k in range(wide - 2 * deep + 1, wide + 1))
    assert net.rest_length.sum() == pytest.approx(net.bar_count * BAR, rel=1e-12)


def test_straight_cuts_are_a_plain_panel():
    plain, cut = cut_panel(None, 5, 4), cut_panel(Taper("NNNN", "NNNN"), 5, 4)
    assert cut.labels == plain.labels
    assert np.array_equal(cut.bars, plain.bars)
    assert np.array_equal(cut.positions, plain.positions)
    assert np.array_equal(cut.fixed, plain.fixed)


@pytest.mark.parametrize("wrong", ["", "1X2B", "AT", "2T", "B2N3", "1.5N2B"])
def test_what_is_no_rate_is_told(wrong):
    with pytest.raises(ValueError, match=r"cutting rate|never comes"):
        cuts_of(wrong)


def test_cuts_that_cannot_be_are_told():
    with pytest.raises(ValueError, match="no cut B"):
        repeated(cuts_of("1N2B"), 4, "square")
    with pytest.raises(ValueError, match="one bar"):
        repeated(cuts_of("1N1T"), 4, "diamond")
    with pytest.raises(ValueError, match="of 6 columns"):
        cut_panel(Taper("B" * 8, "B" * 8), 3, 4)
    with pytest.raises(ValueError, match="2 rows, where there are 4"):
        cut_panel(Taper("BB", "BBBB"), 5, 2)  # rows are half meshes
    with pytest.raises(ValueError, match="join its sides"):
        sheet(
            Netting(TWINE, "diamond", BAR),
            (5, 2),
            lambda steps, intervals: steps,
            shape="x",
            size=(1.0, 1.0),
            closed=True,
            taper=Taper("BBBB", "BBBB"),
        )


def mirrored(net, result, across=1):
    """Return the largest distance of a knot to its mirror image in the plane of the other two axes (m)."""
    place, built = result.position[-1], net.positions.copy()
    image = built.copy()
    image[:, across] *= -1.0
    twin = [int(np.argmin(np.abs(built - one).sum(axis=1))) for one in image]
    other = place[twin].copy()
    other[:, across] *= -1.0
    return float(np.abs(other - place).max())


@pytest.mark.parametrize("narrow", ["bottom", "top"])
@pytest.mark.parametrize("rate", ["1N2B", "AB", "1T2B"])
def test_a_trapezoid_in_a_current_stays_symmetric(rate, narrow):
    cuts = repeated(cuts_of(rate), 4, "diamond")
    net = cut_panel(Taper(cuts, cuts, narrow), 2 * lost(cuts, "diamond") + 4, 4, centre=(0.0, 0.0, -1.0))
    result = fyke.solve_static(fyke.make_system(net, current=(0.5, 0.0, 0.0)), tolerance=1e-9)
    assert result.outcome.ok
    assert mirrored(net, result) < 1e-9 * np.ptp(net.positions, axis=0).max()


def made_of(mesh, **options):
    return Netting(TWINE, mesh, BAR, **options)


def open_box(mesh, *, segments=1, bottom=True):
    step = 2.0 * BAR * np.sqrt(0.5) if mesh == "diamond" else BAR
    size = (4 * step, 3 * step, 5 * step)
    return box(
        made_of(mesh, segments=segments), (4, 3, 5), size=size, top=(0.0, 0.0, -0.2), bottom=bottom
    ), size


@pytest.mark.parametrize("segments", [1, 3])
@pytest.mark.parametrize("mesh", ["diamond", "square"])
def test_a_box_closes_by_construction(mesh, segments):
    """No knot and no bar twice, four bars at every knot below the rim but the lower corners, one open rim (Euler)."""
    net, _ = open_box(mesh, segments=segments)
    assert len(np.unique(net.positions.round(9), axis=0)) == net.knot_count
    assert len({tuple(sorted(bar)) for bar in net.bars.tolist()}) == net.bar_count
    tied = np.unique(np.concatenate([panel.knots for panel in net.panels]))
    ends = np.bincount(net.bars.ravel())
    below = tied[net.positions[tied, 2] < -0.2 - 1e-9]
    lower = [net.panels[0].edge(f"corner{k}")[0] for k in (1, 2, 3, 4)]
    assert set(ends[np.setdiff1d(below, lower)]) == {4}
    assert set(ends[lower]) == {3}
    assert set(np.delete(ends, tied)) <= {2}
    faces = faces_of(net)
    # A surface with one rim: knots - edges + faces = 1. Half meshes have a side along the rim, which is no bar.
    sides = np.sort(
        np.stack([faces.corners, np.roll(faces.corners, -1, axis=1)], axis=2).reshape(-1, 2), axis=1
    )
    sides = np.unique(sides[sides[:, 0] != sides[:, 1]], axis=0)
    assert len(np.unique(faces.corners)) - len(sides) + faces.count == 1
    for panel_ in net.panels:
        knots = panel_.knots[panel_.lattice.bars]
        chain = np.column_stack([net.bars[panel_.bars[:, 0], 0], net.bars[panel_.bars[:, -1], 1]])
        back = np.column_stack([net.bars[panel_.bars[:, 0], 1], net.bars[panel_.bars[:, -1], 0]])
        same = (chain == knots).all(axis=1) | (back == knots).all(axis=1)
        assert same.all()


def test_walls_floor_and_twine_of_a_box_by_formulas():
    """A box of squares: bars of four walls and a floor counted once; volume, and areas that close."""
    net, (x, y, z) = open_box("square")
    nx, ny, nz = 4, 3, 5
    around = 2 * (nx + ny)
    bars = around * (nz + 1) + around * nz + (nx - 1) * ny + (ny - 1) * nx
    assert net.bar_count == bars
    assert net.rest_length.sum() == pytest.approx(bars * BAR, rel=1e-12)
    faces = faces_of(net)
    assert faces.area.sum() == pytest.approx(2 * (x + y) * z + x * y, rel=1e-12)
    assert faces.vector_area(net.positions).sum(axis=0) == pytest.approx([0.0, 0.0, -x * y], abs=1e-14)
    assert enclosed_volume(net, net.positions) == pytest.approx(x * y * z, rel=1e-12)


def test_corners_of_a_box_go_round_from_plus_x_minus_y():
    net, (x, y, z) = open_box("diamond")
    for k, (right, far) in enumerate([(1, -1), (1, 1), (-1, 1), (-1, -1)], 1):
        knots = net.panels[0].edge(f"corner{k}")
        assert net.positions[knots, :2] == pytest.approx(np.tile([right * x / 2, far * y / 2], (6, 1)))
        assert net.positions[knots[[0, -1]], 2] == pytest.approx([-0.2 - z, -0.2])
    with pytest.raises(ValueError, match="no corner1"):
        net.panels[1].edge("corner1")


def test_a_box_of_hexagons_has_no_bottom():
    net, _ = open_box(Hexagon(1.0), bottom=False)
    assert set(np.bincount(net.bars.ravel())[~net.fixed]) <= {2, 3}
    with pytest.raises(ValueError, match="does not match its walls"):
        open_box(Hexagon(1.0))


def symmetric():
    """Every gear that has a plane of symmetry along the current, with the largest current that keeps it one shape."""
    floor = {"bottom": (3, 0.05)}
    yield "box", open_box("diamond")[0]
    yield "box of squares", open_box("square")[0]
    for name, low in (("cylinder", 0.6), ("frustum", 0.4), ("cone", 0.0)):
        meshes, options = (12, 4), {"diameters": (low, 0.6), "height": 0.3, "centre": (0.0, 0.0, -0.2)}
        yield name, frustum(made_of("diamond"), meshes, **options)
    yield "cage", cage(made_of("diamond"), (12, 4), diameter=0.6, depth=0.3, top=(0.0, 0.0, -0.2), **floor)


@pytest.mark.parametrize(("name", "net"), [pytest.param(*one, id=one[0]) for one in symmetric()])
def test_symmetric_gear_stays_symmetric(name, net):
    """With enough weight at the knots to keep it open, every shape is its own mirror image."""
    heavy = replace(net, load=np.tile([0.0, 0.0, -0.05], (net.knot_count, 1)))
    result = fyke.solve_static(fyke.make_system(heavy, current=(0.2, 0.0, 0.0)), tolerance=1e-10)
    assert result.outcome.ok, name
    assert mirrored(net, result) < 1e-9 * np.ptp(net.positions, axis=0).max()


@pytest.mark.parametrize(("high", "low", "towards"), [(0.6, 0.6, "cylinder"), (0.6, 0.0, "cone")])
def test_a_frustum_comes_to_its_neighbours_as_its_rims_do(high, low, towards):
    """Held by both rims in a current: tensions of a frustum go to those of the limit in proportion to its diameter."""
    found = {}
    for more in (0.0, 0.02, 0.01, 0.005):
        sign = -1.0 if towards == "cylinder" else 1.0
        rims = (low + sign * more, high)
        net = frustum(
            made_of("diamond"), (12, 4), diameters=rims, height=0.36, centre=(0, 0, -0.2), fixed="edges"
        )
        result = fyke.solve_static(fyke.make_system(net, current=(0.5, 0.0, 0.0)), tolerance=1e-10)
        assert result.outcome.ok
        assert net.panels[0].shape == (towards if more == 0.0 else "frustum")
        found[more] = result.tension[-1]
    away = [np.linalg.norm(found[more] - found[0.0]) for more in (0.02, 0.01, 0.005)]
    assert away[0] > away[1] > away[2]
    assert away[2] / away[1] == pytest.approx(0.5, abs=0.05)
    assert away[2] < 0.05 * np.linalg.norm(found[0.0])


@pytest.mark.parametrize("speed", [0.3, 0.9])
def test_drag_of_a_box_of_screens_is_that_of_its_panels(speed):
    """Front and back face on, sides and bottom edge on: rho/2 u^2 (2 A C_D(0) + A_along C_D(90 deg)), as Aarsnes."""
    net, (x, y, z) = open_box("square")
    faces, load = faces_of(net), np.zeros_like(net.positions)
    screens = Screens.of(faces, Aarsnes(), 1000.0, 1e-6)
    screens.add_load(net.positions, np.tile([speed, 0.0, 0.0], (net.knot_count, 1)), load)
    solid = 2.0 * 0.002 / BAR - (0.002 / BAR) ** 2
    assert faces.solidity == pytest.approx(np.full(faces.count, solid))
    face_on = solid - 1.24 * solid**2 + 13.7 * solid**3
    drag = 0.5 * 1000.0 * speed**2 * (2.0 * y * z * face_on + 0.04 * (2.0 * x * z + x * y))
    assert load.sum(axis=0) == pytest.approx([drag, 0.0, 0.0], rel=1e-9, abs=1e-12)


HEAD = """schema = 1
[current]
velocity = [0.3, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "50 mm"
[netting.square]
twine = "main"
mesh = "square"
bar_length = "50 mm"
[netting.six]
twine = "main"
mesh = "hexagonal"
bar_length = "50 mm"
long_bar = "50 mm"
"""


def shape(kind, *lines, netting="main"):
    keys = [f'kind = "{kind}"', f'netting = "{netting}"', "centre = [0.0, 0.0, -1.0]", *lines]
    return "\n".join([HEAD, "[[gear]]", 'name = "a"', *keys, ""])


def test_a_case_cuts_as_the_same_call_does():
    text = shape("trapezoid", "meshes = [24, 10]", 'cut = ["AN", "1N2B"]', "hanging_ratio = 0.6")
    net = fyke.build_net(parse_case(text))
    taper = Taper("N" * 10, repeated("NBB", 10, "diamond"))
    by_hand = cut_panel(taper, 24, 10, name="a", centre=(0.0, 0.0, -1.0))
    assert net.labels == by_hand.labels
    assert net.positions == pytest.approx(by_hand.positions, abs=1e-15)
    assert np.array_equal(net.bars, by_hand.bars)
    (where,) = net.panels
    assert where.taper == taper
    assert len(where.edge("bottom")) == 24 - 5 + 1


def test_lower_says_which_way_it_narrows():
    for upper, lower in ((24, 14), (14, 24)):
        for cut in ("", 'cut = "1N2B"'):
            lines = (f"meshes = [{upper}, 10]", f"lower = {lower}", cut, "hanging_ratio = 0.6")
            net = fyke.build_net(parse_case(shape("trapezoid", *lines)))
            where = net.panels[0]
            assert [len(where.edge(end)) for end in ("top", "bottom")] == [upper + 1, lower + 1]


@pytest.mark.parametrize("point", ["up", "down"])
def test_a_triangle_points_where_it_is_told(point):
    net = fyke.build_net(
        parse_case(shape("triangle", "meshes = [8, 6]", f'point = "{point}"', "hanging_ratio = 0.6"))
    )
    tip = net.panels[0].edge("top" if point == "up" else "bottom")
    assert len(tip) == 1
    heights = net.positions[:, 2]
    assert heights[tip[0]] == (heights.max() if point == "up" else heights.min())


def test_a_rope_along_a_cut_side_is_as_long_as_the_side():
    """1N2B hung at 0.6, 0.8: an N is a mesh high, a B a bar long."""
    text = shape("trapezoid", "meshes = [24, 10]", 'cut = "1N2B"', "hanging_ratio = 0.6")
    rope = '[[gear]]\nkind = "rope"\nname = "r"\ntwine = "main"\nalong = "a.left"\n'
    net = fyke.build_net(parse_case(text + rope))
    assert net.rest_length[net.ropes[0].bars].sum() == pytest.approx(5 * 0.1 * 0.8 + 10 * 0.05, rel=1e-12)
    short = text + rope + "length = 0.5\n"
    with pytest.raises(CaseError, match=r"an edge of 0.9 m"):
        parse_case(short)


def test_a_saved_panel_keeps_its_cuts(tmp_path):
    case = parse_case(shape("trapezoid", "meshes = [8, 4]", 'cut = "1N2B"', "hanging_ratio = 0.6"))
    net = fyke.build_net(case)
    result = fyke.solve_static(fyke.build_system(net, case))
    fyke.save(result, tmp_path / "a.nc")
    again = fyke.load(tmp_path / "a.nc").net.panels[0]
    assert again.taper == net.panels[0].taper
    for side in ("left", "right", "top", "bottom"):
        assert np.array_equal(again.edge(side), net.panels[0].edge(side))


SIX = "hanging_ratio = [0.6, 0.6]"
SPOILT = {
    "no rate": (
        shape("trapezoid", "meshes = [24, 10]", 'cut = "1X"', "hanging_ratio = 0.6"),
        ("[[gear]] 1 cut", "1X", "1N2B or 1T1B", "left and the right"),
    ),
    "neither": (
        shape("trapezoid", "meshes = [24, 10]", "hanging_ratio = 0.6"),
        ("[[gear]] 1 lower", "neither lower nor cut in the trapezoid", "cutting rate", 'cut = "1N2B"'),
    ),
    "too many": (
        shape("trapezoid", "meshes = [9, 10]", 'cut = "1N2B"', "hanging_ratio = 0.6"),
        ("[[gear]] 1 cut", "5 and 5 meshes off its sides of 9", "one mesh or more", "fewer"),
    ),
    "counts disagree": (
        shape("trapezoid", "meshes = [24, 10]", "lower = 13", 'cut = "1N2B"', "hanging_ratio = 0.6"),
        ("[[gear]] 1 cut", "14 of 24 meshes are left", "the 13", "lower = 14"),
    ),
    "N and T": (
        shape("trapezoid", "meshes = [24, 10]", 'cut = "1N1T"', "hanging_ratio = 0.6"),
        ("[[gear]] 1 cut", "1N1T over 10", "hang on one bar", "one of N and T"),
    ),
    "bars of squares": (
        shape("trapezoid", "meshes = [24, 10]", 'cut = "1N2B"', SIX, netting="square"),
        ("[[gear]] 1 cut", "1N2B", "no cut B", "2N1T"),
    ),
    "triangle of squares": (
        shape("triangle", "meshes = [20, 10]", SIX, netting="square"),
        ("[[gear]] 1 kind", "square netting", "one knot", "lower = 1"),
    ),
    "hexagons": (
        shape("triangle", "meshes = [20, 10]", SIX, netting="six"),
        ("[[gear]] 1 kind", "hexagonal netting", "diamond or square", "panel"),
    ),
    "no size": (
        shape("triangle", "meshes = [20, 10]"),
        ("[[gear]] 1 size", "neither", "one of size", "hanging_ratio"),
    ),
    "held by nothing": (
        shape("triangle", "meshes = [20, 10]", "hanging_ratio = 0.6", 'fixed = "none"'),
        ("[[gear]] 1 fixed", "none", "corners", "edges"),
    ),
}


def box_case(*lines, netting="main"):
    keys = ['kind = "box"', f'netting = "{netting}"', "top = [0.0, 0.0, -0.2]", *lines]
    return "\n".join([HEAD, "[[gear]]", 'name = "a"', *keys, ""])


def test_a_box_of_a_case_is_that_made_by_hand():
    text = box_case("meshes = [4, 3, 5]", "hanging_ratio = 0.6")
    net = fyke.build_net(parse_case(text))
    side = 2.0 * BAR * 0.6
    by_hand = box(
        made_of("diamond"),
        (4, 3, 5),
        size=(4 * side, 3 * side, 5 * 2.0 * BAR * 0.8),
        top=(0.0, 0.0, -0.2),
        name="a",
    )
    assert net.labels == by_hand.labels
    assert net.positions == pytest.approx(by_hand.positions, abs=1e-15)
    assert np.array_equal(net.bars, by_hand.bars)


def test_ropes_and_sinkers_find_edges_and_knots_of_a_box(tmp_path):
    rigging = """[[gear]]
kind = "rope"
name = "up"
twine = "main"
along = "a.corner3"
[[gear]]
kind = "sinkers"
name = "leads"
at = ["a:0-0", "a bottom:1-1"]
weight = "0.1 N"
density = 7850
"""
    case = parse_case(box_case("meshes = [4, 3, 5]", "hanging_ratio = 0.7") + rigging)
    net = fyke.build_net(case)
    assert np.array_equal(net.ropes[0].knots, net.panels[0].edge("corner3"))
    assert [net.labels[k] for k in net.bodies[0].knots] == ["a:0-0", "a bottom:1-1"]
    result = fyke.solve_static(fyke.build_system(net, case))
    fyke.save(result, tmp_path / "a.nc")
    assert fyke.load(tmp_path / "a.nc").net.panels[0].folds == net.panels[0].folds
    for label in ("a bottom:0-0", "a bottom:8-2", "a:28-0"):
        with pytest.raises(CaseError, match="a knot of"):
            parse_case(case.text.replace("a bottom:1-1", label))


SPOILT |= {
    "box without a size": (
        box_case("meshes = [4, 3, 5]"),
        ("[[gear]] 1 size", "neither", "one of size", "[along x, along y, deep]"),
    ),
    "box too large": (
        box_case("meshes = [4, 3, 5]", "size = [0.5, 0.3, 0.4]"),
        ("[[gear]] 1 size", "walls of 1.6 m x 0.4 m", "20 %", "number of meshes"),
    ),
    "bottom too large": (
        box_case("meshes = [4, 3, 5]", "size = [0.36, 0.27, 0.1]"),
        ("[[gear]] 1 size", "a bottom of 0.36 m x 0.27 m", "20 %", "number of meshes"),
    ),
    "bottom of hexagons": (
        box_case("meshes = [4, 3, 5]", "size = [0.2, 0.15, 0.3]", netting="six"),
        ("[[gear]] 1 bottom", "hexagonal netting", "knot by knot", "bottom = false"),
    ),
    "two counts for a box": (
        box_case("meshes = [4, 3]", "size = [0.2, 0.15, 0.3]"),
        ("[[gear]] 1 meshes", "", "", ""),
    ),
    "left side of a box": (
        box_case("meshes = [4, 3, 5]", "hanging_ratio = 0.7")
        + '[[gear]]\nkind = "rope"\nname = "r"\ntwine = "main"\nalong = "a.left"\n',
        ("[[gear]] 2 along", "a.left", "corner4; it closes round", "did you mean"),
    ),
}


def four_walls(*seams):
    """Four panels and a floor, as a case; the walls' edges lie along the upright corners of a box."""
    side, deep = 4 * 0.1 * 0.7, float(4 * 0.1 * np.sqrt(0.51))
    out = [HEAD]
    for name, normal, centre in (
        ("east", (1, 0, 0), (side / 2, 0)),
        ("north", (0, 1, 0), (0, side / 2)),
        ("west", (-1, 0, 0), (-side / 2, 0)),
        ("south", (0, -1, 0), (0, -side / 2)),
    ):
        place = [*centre, -0.2 - deep / 2]
        keys = (
            f'name = "{name}"',
            f"normal = {[float(k) for k in normal]}",
            f"centre = {place}",
            'fixed = "top"',
        )
        out += [
            "[[gear]]",
            'kind = "panel"',
            'netting = "main"',
            "meshes = [4, 4]",
            "hanging_ratio = 0.7",
            *keys,
        ]
    floor = (
        'name = "floor"',
        "normal = [0.0, 0.0, -1.0]",
        f"centre = [0.0, 0.0, {-0.2 - deep}]",
        'fixed = "none"',
    )
    out += [
        "[[gear]]",
        'kind = "panel"',
        'netting = "main"',
        "meshes = [4, 4]",
        f"size = [{side}, {side}]",
        *floor,
    ]
    for k, (one, other) in enumerate(seams):
        out += ["[[gear]]", 'kind = "seam"', f'name = "s{k}"', f'join = ["{one}", "{other}"]']
    return "\n".join([*out, ""])


ALL_ROUND = (
    ("east.right", "north.left"),
    ("north.right", "west.left"),
    ("west.right", "south.left"),
    ("south.right", "east.left"),
)
# The width of a panel that lies flat runs along y; that of this one's height, normal down, along x.
BELOW = (("floor.top", "east.bottom"), ("north.bottom", "floor.right"), ("floor.bottom", "west.bottom"))


def test_panels_sewn_together_are_the_box_that_is_made_at_once():
    """The same knots and bars in another order, so that both hang alike in the same current."""
    case = parse_case(four_walls(*ALL_ROUND, *BELOW, ("south.bottom", "floor.left")))
    assert not any("seam" in one for one in case.warnings)
    sewn_up = fyke.build_net(case)
    side, deep = 4 * 0.1 * 0.7, float(4 * 0.1 * np.sqrt(0.51))
    whole = box(made_of("diamond"), (4, 4, 4), size=(side, side, deep), top=(0.0, 0.0, -0.2))
    assert (sewn_up.knot_count, sewn_up.bar_count) == (whole.knot_count, whole.bar_count)
    twin = [int(np.abs(sewn_up.positions - place).sum(axis=1).argmin()) for place in whole.positions]
    assert sorted(twin) == list(range(whole.knot_count))
    assert sewn_up.positions[twin] == pytest.approx(whole.positions, abs=1e-12)
    bars = {tuple(sorted(bar)) for bar in np.array(twin)[whole.bars].tolist()}
    assert bars == {tuple(sorted(bar)) for bar in sewn_up.bars.tolist()}
    assert np.array_equal(sewn_up.fixed[twin], whole.fixed)
    shapes = []
    for net in (whole, sewn_up):
        heavy = replace(net, load=np.tile([0.0, 0.0, -0.05], (net.knot_count, 1)), twines=whole.twines)
        system = fyke.make_system(heavy, current=(0.2, 0.0, 0.0))
        shapes.append(fyke.solve_static(system, tolerance=1e-9).position[-1])
    assert shapes[1][twin] == pytest.approx(shapes[0], abs=1e-7)


def seam_case(count, take_up, *, gap=0.0):
    lines = f"""
[[gear]]
kind = "cylinder"
name = "upper"
netting = "main"
meshes = [24, 4]
diameter = 0.3
height = 0.3
top = [0.0, 0.0, -0.2]
[[gear]]
kind = "cylinder"
name = "lower"
netting = "main"
meshes = [{count}, 4]
diameter = 0.3
height = 0.3
top = [0.0, 0.0, {-0.5 - gap}]
fixed = "none"
[[gear]]
kind = "seam"
name = "s"
join = ["upper.bottom", "lower.top"]
"""
    return HEAD + lines + (f"take_up = {take_up}\n" if take_up else "")


@pytest.mark.parametrize(
    ("count", "take_up"), [(24, None), (16, "1.5"), (16, '"3:2"'), (18, '"4:3"'), (48, "0.5")]
)
def test_a_seam_takes_meshes_up_evenly(count, take_up):
    net = fyke.build_net(parse_case(seam_case(count, take_up)))
    upper, lower = net.panels
    few, many = sorted((24, count))
    rim = upper.edge("bottom")[:-1] if count < 24 else lower.edge("top")[:-1]
    knots, times = np.unique(rim, return_counts=True)
    assert len(knots) == few
    assert times.max() - times.min() <= 1
    assert times.sum() == many
    assert set(upper.edge("bottom")) == set(lower.edge("top"))
    assert net.knot_count == 24 * 9 + count * 9 - many
    ends = np.bincount(net.bars.ravel())
    assert ends[knots].sum() == 2 * 24 + 2 * count


def test_check_tells_seams_and_cuts(tmp_path, capsys):
    file = tmp_path / "c.toml"
    wing = shape("trapezoid", "meshes = [24, 10]", 'cut = "1N2B"', "hanging_ratio = 0.6").removeprefix(HEAD)
    file.write_text(seam_case(16, "1.5") + wing)
    assert check_case(file, json=True) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["seams"] == [
        {"name": "s", "join": ["upper.bottom", "lower.top"], "knots": [24, 16], "take_up": 1.5}
    ]
    assert [one["ends"] for one in told["panels"]] == [None, None, [24, 14]]
    check_case(file, json=False)
    shown = capsys.readouterr().out
    assert "seam s" in shown
    assert "24 above, 14 below, 10 high" in shown


def test_edges_that_lie_apart_are_told_and_moved_to_the_first():
    case = parse_case(seam_case(24, None, gap=0.3))
    (told,) = [one for one in case.warnings if "seam 's'" in one]
    assert "0.3 m apart" in told
    net = fyke.build_net(case)
    assert net.positions[net.panels[1].edge("top"), 2] == pytest.approx(np.full(25, -0.5))
    assert not any("seam" in one for one in parse_case(seam_case(24, None, gap=0.05)).warnings)


def test_a_rope_along_a_gathered_edge_passes_every_knot_once():
    rope = '[[gear]]\nkind = "rope"\nname = "r"\ntwine = "main"\nalong = "upper.bottom"\n'
    net = fyke.build_net(parse_case(seam_case(16, "1.5") + rope))
    assert len(net.ropes[0].bars) == 16
    assert set(net.ropes[0].knots) == set(net.panels[1].edge("top"))


def test_a_turned_rim_is_joined_where_it_lies():
    """A cylinder that was turned by three meshes loses nothing: its seam begins three knots further on."""
    upper = frustum(made_of("diamond"), (12, 2), diameters=(0.5, 0.5), height=0.2, name="u")
    lower = frustum(
        made_of("diamond"), (12, 2), diameters=(0.5, 0.5), height=0.2, centre=(0, 0, -0.2), name="l"
    )
    turn = np.pi / 2.0
    matrix = np.array(
        [[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]]
    )
    for way in (1.0, -1.0):
        other = replace(lower, positions=lower.positions * [1.0, way, 1.0] @ matrix.T)
        net = together([upper, other])
        stays, goes = stitches(net, ("u", "bottom"), ("l", "top"))
        assert net.positions[stays] == pytest.approx(net.positions[goes], abs=1e-12)


@pytest.mark.parametrize("panels", [2, 3, 4])
@pytest.mark.parametrize("rate", ["1N2B", "1N1B", "1T2B"])
def test_a_bag_of_panels_closes(panels, rate):
    """Seams once, two bars or more at every knot, both rims with their meshes, closed faces."""
    cuts = repeated(cuts_of(rate), 6, "diamond")
    wide = 2 * lost(cuts, "diamond") + 3
    rims = (3 * panels * 0.06 / np.pi, wide * panels * 0.06 / np.pi)
    net = bag(made_of("diamond"), (wide, 6), panels=panels, cuts=cuts, diameters=rims, height=0.4)
    assert len(np.unique(net.positions.round(9), axis=0)) == net.knot_count
    assert np.bincount(net.bars.ravel()).min() >= 2
    for end, count in (("top", wide), ("bottom", 3)):
        assert len(np.unique(np.concatenate([one.edge(end) for one in net.panels]))) == panels * count
    vectors = faces_of(net).vector_area(net.positions)
    assert np.abs(vectors.sum(axis=0)[:2]).max() < 1e-2 * np.abs(vectors).sum()
    assert enclosed_volume(net, net.positions) > 0.0
    mirror = bag(made_of("diamond"), (wide, 6), panels=panels, cuts=cuts, diameters=rims[::-1], height=0.4)
    assert len(np.unique(np.concatenate([one.edge("bottom") for one in mirror.panels]))) == panels * wide


def line_case(*keys, twine='diameter = "10 mm"\nlead = "150 g/m"'):
    rope = f'[twine.line]\nmaterial = "PES"\n{twine}\n'
    panel_ = shape("panel", "meshes = [10, 4]", "hanging_ratio = 0.6", 'fixed = "top"').removeprefix(HEAD)
    foot = '[[gear]]\nkind = "rope"\nname = "foot"\ntwine = "line"\nalong = "a.bottom"\n'
    return "\n".join([HEAD + rope + panel_ + foot, *keys, ""])


@pytest.mark.parametrize(
    ("twine", "fibre"),
    [
        ('diameter = "10 mm"\nlead = "150 g/m"', (np.pi / 4 * 0.01**2 - 0.15 / 11340) * 1380),
        ('diameter = "10 mm"\nrtex = "50 g/m"\nlead = "150 g/m"', 0.05),
        ('rtex = "50 g/m"\nlead = "150 g/m"', 0.05),
    ],
)
def test_a_lead_line_weighs_its_fibre_and_its_lead(twine, fibre):
    """In water of 1000 kg/m3: m g (1 - 1000 / density) of either, on the unloaded length of the rope."""
    case, plain = (
        parse_case(line_case(twine=twine)),
        parse_case(line_case().split('[[gear]]\nkind = "rope"')[0]),
    )
    heavy, light = (fyke.build_system(fyke.build_net(one), one).weight_in_water for one in (case, plain))
    length = 10 * 0.1 * 0.6
    by_hand = 9.81 * length * (fibre * (1.0 - 1000.0 / 1380.0) + 0.15 * (1.0 - 1000.0 / 11340.0))
    assert heavy - light == pytest.approx(by_hand, rel=1e-10)
    assert not any("'line' floats" in one for one in case.warnings)
    solid = fibre / 1380.0 + 0.15 / 11340.0
    if "diameter" not in twine:
        area = np.pi / 4.0 * case.twine["line"].diameter ** 2
        assert area == pytest.approx(fibre / 1380.0 / 0.65 + 0.15 / 11340.0, rel=1e-12)
        assert area > solid


def floats(*keys):
    return "\n".join(['[[gear]]\nkind = "floats"\nname = "f"\nbuoyancy = "1 N"\ndensity = 200', *keys])


@pytest.mark.parametrize(("spacing", "count"), [(0.06, 11), (0.12, 6), (0.2, 4), (0.5, 2), (2.0, 2)])
def test_floats_along_a_line_keep_their_spacing(spacing, count):
    """An edge of 0.6 m: one at either end, and as near to the spacing as whole numbers and knots allow."""
    case = parse_case(line_case(floats('along = "a.top"', f"spacing = {spacing}")))
    net = fyke.build_net(case)
    (bodies,) = net.bodies
    assert len(bodies.knots) == count
    assert {net.panels[0].edge("top")[0], net.panels[0].edge("top")[-1]} <= set(bodies.knots.tolist())
    steps = np.linalg.norm(np.diff(net.positions[bodies.knots], axis=0), axis=1)
    assert np.ptp(steps) <= 0.06 + 1e-12


def test_sinkers_round_a_rim_keep_their_spacing():
    sinkers = (
        '[[gear]]\nkind = "sinkers"\nalong = "lower.bottom"\nspacing = 0.2\nweight = 1\ndensity = 7850\n'
    )
    net = fyke.build_net(parse_case(seam_case(24, None) + sinkers))
    assert len(net.bodies[0].knots) == round(24 * 0.3 * np.sin(np.pi / 24) / 0.2)


JOINED = four_walls(*ALL_ROUND, *BELOW)
SPOILT |= {
    "counts that do not match": (
        seam_case(20, None),
        (
            "[[gear]] 3 join",
            '24 meshes along "upper.bottom" and 20 along "lower.top"',
            "take_up",
            "take_up = 1.2",
        ),
    ),
    "take-up that does not match": (
        seam_case(16, "2.0"),
        ("[[gear]] 3 take_up", "2 with 24 meshes", "1.5, as the counts are", "32 meshes"),
    ),
    "take-up in words": (
        seam_case(16, '"half"'),
        ("[[gear]] 3 take_up", "half", "1.5 or 3:2", "take_up = 1.5"),
    ),
    "seam of an unknown part": (
        seam_case(24, None).replace("lower.top", "loer.top"),
        ("[[gear]] 3 join, value 2", '"loer.top"', '"upper", "lower"', '"lower.top"'),
    ),
    "seam of an unknown edge": (
        seam_case(24, None).replace('"lower.top"', '"lower.left"'),
        ("[[gear]] 3 join, value 2", '"lower.left"', "top or bottom", "did you mean"),
    ),
    "seam of an edge to itself": (
        JOINED.replace('"floor.bottom", "west.bottom"', '"floor.bottom", "floor.bottom"'),
        ("join", "floor.bottom", "two different edges", "name the edge"),
    ),
    "seam of a rim to a side": (
        JOINED + seam_case(24, None).removeprefix(HEAD).replace('"upper.bottom"', '"floor.left"'),
        ("join", "one closes round", "two edges that close round", "join the sides"),
    ),
    "floats too near": (
        line_case(floats('along = "a.top"', "spacing = 0.01")),
        ("[[gear]] 3 spacing", "61 of floats 'f'", "at most the 11 knots", "fewer"),
    ),
    "spacing and count": (
        line_case(floats('along = "a.top"', "spacing = 0.1", "count = 3")),
        ("[[gear]] 3 spacing", "spacing beside count", "one of the two", "leave count"),
    ),
    "spacing of labels": (
        line_case(floats('at = ["a:0-0"]', "spacing = 0.1")),
        ("[[gear]] 3 spacing", "spacing beside at", "one of the two", "leave at"),
    ),
    "more lead than rope": (
        line_case(twine='diameter = "4 mm"\nlead = "150 g/m"'),
        ("[twine.line] lead", "150 g/m of lead in a diameter of 4 mm", "above 4.104 mm", "units"),
    ),
    "seam of a side that became a ring": (
        four_walls(("floor.top", "north.bottom"), ("east.top", "east.bottom"), ("north.right", "east.left")),
        (
            "[[gear]] 8 join",
            '"north.right" and "east.left" of seam \'s2\'',
            "knots can become one",
            "joined already",
        ),
    ),
    "rope along nothing": (
        line_case().replace("hanging_ratio = 0.6", "hanging_ratio = 1e-308"),
        ("[[gear]] 2 along", "e-308 m long", "1e-06 m or more", "units"),
    ),
    "held by no seam": (
        four_walls(*ALL_ROUND),
        ("[[gear]] 5 fixed", "none", "for a static case", "nothing would hold it"),
    ),
}


@pytest.mark.parametrize("name", SPOILT)
def test_what_is_wrong_is_told_in_four_parts(name):
    text, pieces = SPOILT[name]
    with pytest.raises(CaseError) as caught:
        parse_case(text, "c.toml")
    told = [(p.where, p.found, p.allowed, p.cure) for p in caught.value.problems]
    assert any(all(a in b for a, b in zip(pieces, parts, strict=True)) for parts in told), told
    assert len(told) == 1, told
