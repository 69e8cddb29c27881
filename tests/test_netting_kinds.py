"""Hexagonal netting: counts, sizes, solidity and faces against plane geometry, statics by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve

import fyke
from fyke.netting.faces import faces_of
from fyke.netting.grouping import grid_of
from fyke.netting.hexagon import Hexagon
from fyke.netting.lattice import flat_strain, hanging_ratios, hung_size, lattice, taut_ratios
from fyke.netting.measures import measure_net, measure_panel, mesh_area, solidity
from fyke.netting.shapes import frustum
from fyke.netting.sheet import Netting
from fyke.results.volume import enclosed_volume
from fyke.water.laws.panels import Loland
from reference import NO_FORCES, NO_WATER, thread

SIDE, LONG = 0.03, 0.045
BOTH = pytest.mark.parametrize("turned", [False, True], ids=["T0", "T90"])


def hexagon(turned=False, long=LONG):
    return Hexagon(long / SIDE, turned)


def hung(meshes, across, *, turned=False, long=LONG, **options):
    """Return a panel hung so that every bar is just taut; across: sine of the slanted bars' angle to the long ones."""
    kind = hexagon(turned, long)
    along = (long + SIDE * np.sqrt(1.0 - across**2)) / (long + SIDE)
    ratios = (along, across) if turned else (across, along)
    size = hung_size(kind, meshes, SIDE, ratios)
    twine = options.pop("twine", thread(1e4, 1.5e-3))
    return fyke.panel(twine, mesh=kind, meshes=meshes, bar_length=SIDE, size=size, **options)


@BOTH
@pytest.mark.parametrize("meshes", [(1, 1), (2, 3), (3, 2), (5, 4)])
def test_counts_are_those_of_rows_of_hexagons(meshes, turned):
    """Rows + 1 zigzags of two bars a hexagon; long bars beside every hexagon, one more in rows that begin whole."""
    columns, rows = meshes[::-1] if turned else meshes
    grid = lattice(hexagon(turned), meshes)
    whole, aside = (rows + 1) // 2, rows // 2
    long = whole * (columns + 1) + aside * columns
    assert len(grid.knots) == (rows + 1) * (2 * columns + 1)
    assert len(grid.bars) == (rows + 1) * 2 * columns + long
    assert np.count_nonzero(hexagon(turned).long(grid.knots, grid.bars)) == long
    # Euler: knots - bars + hexagons = 1 for a net in one piece, the halves at the sides of rows aside left out.
    assert len(grid.knots) - len(grid.bars) + whole * columns + aside * (columns - 1) == 1
    assert np.bincount(grid.bars.ravel()).max() <= 3


@BOTH
@pytest.mark.parametrize("across", [0.3, 0.7, np.sqrt(0.75)])
def test_every_bar_of_a_hung_panel_is_just_as_long_as_its_twine(across, turned):
    net = hung((4, 5), across, turned=turned)
    a, b = net.bars.T
    length = np.linalg.norm(net.positions[b] - net.positions[a], axis=1)
    assert length == pytest.approx(net.rest_length, rel=1e-12)
    assert set(net.rest_length.round(12)) == {SIDE, LONG}
    panel = net.panels[0]
    assert max(flat_strain(panel.kind, panel.meshes, SIDE, panel.size)) == pytest.approx(0.0, abs=1e-12)
    along = np.ptp(net.positions, axis=0)[1 if turned else 2]
    rows = panel.meshes[0 if turned else 1]
    assert along == pytest.approx(rows * LONG + (rows + 1) * SIDE * np.sqrt(1.0 - across**2), rel=1e-12)


@BOTH
def test_ratios_are_those_that_the_panel_was_hung_at_and_taut_from_the_first(turned):
    net = hung((4, 7), 0.6, turned=turned)
    ratios = hanging_ratios(hexagon(turned), (4, 7), SIDE, net.panels[0].size)
    assert taut_ratios(hexagon(turned), ratios[0]) == pytest.approx(ratios, rel=1e-12)
    assert measure_panel(net, net.panels[0]).hanging_ratios == pytest.approx(ratios, rel=1e-14)


def test_no_second_ratio_makes_turned_hexagons_taut_below_their_long_bars():
    assert taut_ratios(hexagon(turned=True), 0.9 * LONG / (LONG + SIDE)) is None


def test_regular_hexagons_have_the_area_of_regular_hexagons():
    kind = Hexagon(1.0)
    ratios = taut_ratios(kind, np.sqrt(0.75))
    assert mesh_area(kind, SIDE, ratios) == pytest.approx(1.5 * np.sqrt(3.0) * SIDE**2, rel=1e-14)
    # Three bars of width d at 120 degrees share 3 (d^2/4) cot 60 degrees at each of two knots.
    d = 2e-3
    covered = 3.0 * SIDE * d - 2.0 * 3.0 * d**2 / 4.0 / np.sqrt(3.0)
    assert solidity(kind, SIDE, ratios, d) == pytest.approx(
        covered / (1.5 * np.sqrt(3.0) * SIDE**2), rel=1e-13
    )


@BOTH
def test_sides_of_a_crushed_panel_lie_flat_and_its_long_bars_are_slack(turned):
    kind, size = hexagon(turned), (0.2, 0.05) if not turned else (0.05, 0.2)
    slanted, long = flat_strain(kind, (4, 2) if not turned else (2, 4), SIDE, size)
    assert slanted == pytest.approx(0.2 / (8 * SIDE) - 1.0, rel=1e-12)
    assert -1.0 < long < 0.0


def test_hexagons_without_long_bars_are_nearly_diamonds():
    """With long bars of no length two rows of hexagons are one of diamonds: same area, solidity, mass per area."""
    across = 0.6
    net = hung((3, 6), across, long=1e-9 * SIDE, knot_diameter=0.0, twine=thread(1e4, 1e-3))
    found = measure_panel(net, net.panels[0])
    assert found.solidity == pytest.approx(
        solidity("diamond", SIDE, (across, np.sqrt(1 - across**2)), 1e-3), rel=0.02
    )
    assert found.mesh_length == pytest.approx(2.0 * SIDE, rel=1e-8)


def covered(net, cell, pixels=500):
    """Count the pixels of a cell about the panel's middle that bars and knots cover."""
    rng = np.random.default_rng(0)
    plan, panel = net.panels[0].flat, net.panels[0]
    corners = np.stack(np.indices((pixels, pixels)), axis=-1).reshape(-1, 2)
    points = ((corners + rng.uniform(size=corners.shape)) / pixels - 0.5) * cell
    solid = np.zeros(len(points), dtype=bool)
    for a, b in panel.lattice.bars:
        along = plan[b] - plan[a]
        t = np.clip((points - plan[a]) @ along / (along @ along), 0.0, 1.0)
        solid |= np.linalg.norm(points - plan[a] - t[:, None] * along, axis=1) < net.bar_diameter[0] / 2.0
    for centre in plan:
        solid |= np.linalg.norm(points - centre, axis=1) < net.knot_diameter[0] / 2.0
    return float(solid.mean())


@BOTH
@pytest.mark.parametrize("knot_diameter", [0.0, 0.005])
@pytest.mark.parametrize("across", [0.5, np.sqrt(0.75)])
def test_solidity_is_that_of_a_pixel_count(across, knot_diameter, turned):
    """Over a width of one hexagon and a length of two rows, after which the netting repeats itself."""
    net = hung((4, 4), across, turned=turned, knot_diameter=knot_diameter, twine=thread(1e4, 3e-3))
    rise = SIDE * np.sqrt(1.0 - across**2)
    cell = np.array([2.0 * SIDE * across, 2.0 * (LONG + rise)])
    found = measure_panel(net, net.panels[0]).solidity
    assert found == pytest.approx(covered(net, cell[::-1] if turned else cell), rel=0.01)


def test_weights_are_those_by_hand():
    """3 x 2 hexagons: 3 zigzags of 6 slanted bars, 4 + 3 long ones, 21 knots."""
    net = hung((3, 2), 0.8, knot_diameter=4e-3, twine=thread(1e4, 2e-3, density=1140.0))
    figures, panel = measure_net(net), measure_panel(net, net.panels[0])
    assert (figures.knots, figures.bars) == (21, 25)
    ball = 1140.0 * np.pi / 6.0 * 4e-3**3
    metre = 1140.0 * np.pi / 4.0 * 2e-3**2
    assert figures.mass == pytest.approx((18 * SIDE + 7 * LONG) * metre + 21 * ball, rel=1e-12)
    area = 2.0 * 0.8 * SIDE * (LONG + 0.6 * SIDE)
    assert panel.mass_per_area == pytest.approx(((2 * SIDE + LONG) * metre + 2 * ball) / area, rel=1e-12)
    assert panel.mesh_length == pytest.approx(2 * SIDE + LONG, rel=1e-15)


@BOTH
@pytest.mark.parametrize("rows", [2, 3])
def test_faces_fill_the_frame_but_for_corners_without_a_knot(rows, turned):
    """Two corners below always lack a knot, two above with an even number of rows: half a tip triangle each."""
    meshes = (rows, 3) if turned else (3, rows)
    net = hung(meshes, 0.8, turned=turned, normal=(1.0, 2.0, 0.4))
    faces = faces_of(net)
    normal = np.array([1.0, 2.0, 0.4]) / np.linalg.norm([1.0, 2.0, 0.4])
    assert faces.vector_area(net.positions) == pytest.approx(faces.area[:, None] * normal, abs=1e-16)
    halves = 2 if rows % 2 == 0 else 4
    missing = halves * 0.5 * (0.8 * SIDE) * (0.6 * SIDE)
    assert faces.area.sum() == pytest.approx(np.prod(net.panels[0].size) - missing, rel=1e-12)
    assert faces.solidity == pytest.approx(
        np.full(faces.count, measure_panel(net, net.panels[0]).solidity), rel=1e-8
    )


@BOTH
def test_every_bar_is_a_side_of_its_faces(turned):
    net = hung((4, 3), 0.7, turned=turned)
    faces = faces_of(net)
    there = faces.bars >= 0
    after = np.roll(faces.corners, -1, axis=1)
    ends = np.sort(np.stack([faces.corners[there], after[there]], axis=1), axis=1)
    assert np.array_equal(np.sort(net.bars[faces.bars[there]], axis=1), ends)
    assert set(faces.bars[there].tolist()) == set(range(net.bar_count))
    joined = {tuple(pair) for pair in np.sort(net.bars, axis=1).tolist()}
    missed = np.sort(np.stack([faces.corners[~there], after[~there]], axis=1), axis=1)
    assert not joined & {tuple(pair) for pair in missed.tolist()}


def test_a_uniform_force_survives_the_sharing_with_its_moment():
    net = hung((4, 4), 0.7, centre=(1.0, -2.0, -3.0))
    faces = faces_of(net)
    on_knots = np.zeros(net.knot_count)
    np.add.at(on_knots, faces.corners, faces.share * faces.area[:, None])
    assert on_knots.sum() == pytest.approx(faces.area.sum(), rel=1e-13)
    across = on_knots @ net.positions[:, 1] / on_knots.sum()
    assert across == pytest.approx(-2.0, rel=1e-13)


def equilibrium(columns, rows, across, along, ea):
    """Length of slanted and long bars, and their reach across, of netting spread evenly on a frame.

    A knot is at rest when the long bar bears T_l = 2 T_s cos p, p being the angle of the slanted bars to it.
    """

    def misfit(unknown):
        slanted, long = unknown
        reach = across / (2.0 * columns)
        rise = np.sqrt(slanted**2 - reach**2)
        borne = ea * (long / LONG - 1.0) - 2.0 * ea * (slanted / SIDE - 1.0) * rise / slanted
        return [borne / ea, (rows * long + (rows + 1) * rise) / along - 1.0]

    return fsolve(misfit, [SIDE * 1.02, LONG * 1.02], xtol=1e-13)


@BOTH
def test_netting_spread_on_a_frame_shares_its_tension_as_statics_says(turned):
    """Held where even stretching puts the knots of its frame, all others go to where even stretching puts them."""
    columns, rows, ea = 5, 4, 1e4
    kind, meshes = hexagon(turned), (rows, columns) if turned else (columns, rows)
    built = hung(meshes, 0.8, turned=turned, twine=thread(ea, 1.5e-3))
    across, along = np.array(kind.turn(built.panels[0].size)) * 1.02
    slanted, long = equilibrium(columns, rows, across, along, ea)
    reach = across / (2.0 * columns)
    rise = np.sqrt(slanted**2 - reach**2)
    i, j = lattice(kind, meshes).knots[:, ::-1].T if turned else lattice(kind, meshes).knots.T
    flat = np.column_stack([i * reach - across / 2.0, (j // 2) * long + (j - j // 2) * rise - along / 2.0])
    exact = np.column_stack([np.zeros(len(i)), flat[:, ::-1] if turned else flat])
    fixed = built.fixed
    start = np.where(fixed[:, None], exact, built.positions)
    system = fyke.make_system(replace(built, positions=start), water=NO_WATER, coefficients=NO_FORCES)
    result = fyke.solve_static(system, tolerance=1e-8)
    assert result.outcome.ok
    assert result.position[-1] == pytest.approx(exact, abs=1e-9)
    want = np.where(built.rest_length > 0.04, ea * (long / LONG - 1.0), ea * (slanted / SIDE - 1.0))
    assert result.tension[-1] == pytest.approx(want, rel=1e-6)


def test_one_mesh_hung_by_a_knot_closes_under_its_load():
    """Two strings of a slanted, a long and a slanted bar side by side, each with half of the load."""
    ea, load = 500.0, 8.0
    net = hung((1, 1), 0.8, fixed="top", twine=thread(ea, 1e-3))
    push = np.zeros((net.knot_count, 3))
    push[net.panels[0].edge("bottom"), 2] = -load
    system = fyke.make_system(replace(net, load=push), water=NO_WATER, coefficients=NO_FORCES)
    result = fyke.solve_static(system)
    assert result.outcome.ok
    assert result.tension[-1] == pytest.approx(np.full(6, load / 2.0), rel=1e-6)
    depth = np.ptp(result.position[-1][:, 2])
    assert depth == pytest.approx((2.0 * SIDE + LONG) * (1.0 + load / 2.0 / ea), rel=1e-6)


@BOTH
def test_drag_of_a_tight_panel_is_that_of_its_bars_across_the_flow(turned):
    net = hung((5, 4), 0.7, turned=turned, knot_diameter=4e-3, twine=thread(1e6, 1.5e-3))
    coefficients = fyke.Coefficients(bars=fyke.ConstantBar(1.2, 0.1), knots=fyke.ConstantKnot(1.0))
    system = fyke.make_system(
        net, current=(0.3, 0.0, 0.0), water=fyke.Water(gravity=0.0), coefficients=coefficients
    )
    result = fyke.solve_static(system)
    area = 1.2 * 1.5e-3 * net.rest_length.sum() + np.pi / 4.0 * 4e-3**2 * net.knot_count
    assert result.outcome.ok
    assert result.water_force[-1][:, 0].sum() == pytest.approx(500.0 * 0.3**2 * area, rel=2e-3)


@BOTH
def test_screens_take_hexagons_and_no_coarser_panel_is_made_of_them(turned):
    """Loland's C_D = 0.33 Sn + 6.54 Sn^2 - 4.88 Sn^3 across the flow, on the area of the faces."""
    net = hung((5, 4), 0.7, turned=turned, twine=thread(1e6, 1.5e-3))
    assert grid_of(net) is None
    system = fyke.make_system(
        net,
        current=(0.3, 0.0, 0.0),
        water=fyke.Water(gravity=0.0),
        coefficients=fyke.Coefficients(screens=Loland()),
    )
    result = fyke.solve_static(system)
    sn, area = measure_panel(net, net.panels[0]).solidity, faces_of(net).area.sum()
    drag = 0.33 * sn + 6.54 * sn**2 - 4.88 * sn**3
    assert result.outcome.ok
    assert result.hydrodynamic_force[-1, 0] == pytest.approx(500.0 * 0.3**2 * drag * area, rel=5e-3)


def test_a_saved_panel_keeps_its_hexagons(tmp_path):
    net = hung((3, 2), 0.7, turned=True)
    result = fyke.solve_static(fyke.make_system(net, current=(0.2, 0.0, 0.0)))
    fyke.save(result, tmp_path / "net.nc")
    panel = fyke.load(tmp_path / "net.nc").net.panels[0]
    assert (panel.kind, panel.bar_length) == (hexagon(turned=True), SIDE)
    assert panel.flat == pytest.approx(net.panels[0].flat, rel=1e-15)


def cylinder(around, rows, diameter=1.0):
    side = np.pi * diameter / (2.0 * around) / 0.8
    netting = Netting(thread(1e5, 1.5e-3), Hexagon(1.5), side)
    height = hung_size(Hexagon(1.5), (around, rows), side, taut_ratios(Hexagon(1.5), 0.8))[1]
    return frustum(netting, (around, rows), diameters=(diameter, diameter), height=height), side, height


@pytest.mark.parametrize("rows", [3, 4])
def test_a_cylinder_closes_and_bears_every_row_alike(rows):
    """No knot twice, three bars at every inner knot; a load below is borne by 1 / cos in the slanted bars."""
    net, _, _ = cylinder(12, rows)
    assert net.knot_count == (rows + 1) * 24
    assert net.bar_count == (rows + 1) * 24 + rows * 12
    a, b = net.bars.T
    assert len({tuple(pair) for pair in np.sort(net.bars, axis=1).tolist()}) == net.bar_count
    assert np.linalg.norm(net.positions[b] - net.positions[a], axis=1) == pytest.approx(
        net.rest_length, rel=0.02
    )
    counts = np.bincount(net.bars.ravel())
    assert (np.count_nonzero(counts == 2), np.count_nonzero(counts == 3)) == (24, net.knot_count - 24)


@pytest.mark.parametrize("rows", [3, 4])
def test_a_cylinder_of_hexagons_encloses_what_its_walls_do(rows):
    """Its section has 24 sides; towards an end, the triangles between its tips cut 12 corners off, a third each."""
    net, side, height = cylinder(12, rows)
    step, radius = np.pi / 12, 0.5
    whole = 12 * radius**2 * np.sin(step)
    corner = 0.5 * radius**2 * (2.0 * np.sin(step) - np.sin(2.0 * step))
    exact = whole * height - 2.0 * 12 * corner * (0.6 * side) / 3.0
    assert enclosed_volume(net, net.positions) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("rows", [4, 5])
def test_rims_of_a_cylinder_of_hexagons_close(rows):
    """A rim of n hexagons has n knots, none of them left out, evenly round the circle."""
    net, _, _ = cylinder(9, rows)
    for side in ("top", "bottom"):
        rim = net.panels[0].edge(side)
        assert rim[0] == rim[-1] and len(np.unique(rim)) == len(rim) - 1 == 9
        apart = np.linalg.norm(np.diff(net.positions[rim], axis=0), axis=1)
        assert apart == pytest.approx(np.sin(np.pi / 9))


def test_hexagons_that_cannot_close_are_refused():
    netting = Netting(thread(1e5), Hexagon(1.5), SIDE)
    with pytest.raises(ValueError, match="only diamond netting is gathered in a tip"):
        frustum(netting, (8, 4), diameters=(0.0, 1.0), height=1.0)
    turned = Netting(thread(1e5), Hexagon(1.5, turned=True), SIDE)
    with pytest.raises(ValueError, match="long bars along the height"):
        frustum(turned, (8, 4), diameters=(1.0, 1.0), height=1.0)


def test_bars_of_segments_keep_their_lengths():
    whole, cut = hung((3, 2), 0.7), hung((3, 2), 0.7, segments=3)
    assert cut.bar_count == 3 * whole.bar_count
    assert cut.rest_length.sum() == pytest.approx(whole.rest_length.sum(), rel=1e-13)
    panel = cut.panels[0]
    lengths = np.linalg.norm(np.diff(cut.positions[cut.bars], axis=1)[:, 0], axis=1)
    assert lengths == pytest.approx(cut.rest_length, rel=1e-12)
    assert panel.bars.shape == (whole.bar_count, 3)


CASE = """
schema = 1
[current]
velocity = [0.3, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "hexagonal"
bar_length = "30 mm"
long_bar = "45 mm"
orientation = "T0"
[[gear]]
name = "net"
kind = "panel"
netting = "main"
meshes = [6, 4]
hanging_ratio = 0.7
centre = [0.0, 0.0, -1.0]
"""
CYLINDER = CASE.replace('"panel"', '"cylinder"').replace("[6, 4]", "[24, 4]").replace("centre", "top")


def told(text):
    with pytest.raises(fyke.CaseError) as error:
        fyke.parse_case(text, "c.toml")
    return [(one.where, one.found, one.allowed, one.cure) for one in error.value.problems]


@BOTH
def test_panel_of_a_case_is_that_made_by_hand(turned):
    ratio = '[0.8, 0.7]\nfixed = "corners"' if turned else '0.7\nfixed = "corners"'
    text = CASE.replace('"T0"', '"T90"' if turned else '"T0"').replace("0.7", ratio, 1)
    case = fyke.parse_case(text)
    net = fyke.build_net(case)
    kind = hexagon(turned)
    ratios = (0.8, 0.7) if turned else (0.7, (LONG + SIDE * np.sqrt(0.51)) / (LONG + SIDE))
    size = hung_size(kind, (6, 4), SIDE, ratios)
    want = fyke.panel(
        case.twines["main"],
        mesh=kind,
        meshes=(6, 4),
        bar_length=SIDE,
        size=size,
        centre=(0.0, 0.0, -1.0),
        fixed="corners",
        name="net",
    )
    assert np.array_equal(net.bars, want.bars) and np.array_equal(net.fixed, want.fixed)
    assert net.positions == pytest.approx(want.positions, abs=1e-14)
    assert net.rest_length == pytest.approx(want.rest_length, rel=1e-15)
    assert np.count_nonzero(net.fixed) == 4
    assert fyke.solve_static(fyke.build_system(net, case)).outcome.ok


@pytest.mark.parametrize("gear", [CASE, CYLINDER], ids=["panel", "cylinder"])
def test_check_counts_edges_and_knows_knots_as_the_net_has_them(gear, capsys, tmp_path):
    from fyke.cli.check import judge

    case = fyke.parse_case(gear)
    net = fyke.build_net(case)
    netting, sheet = case.netting["main"], case.gear[0].sheets(case.netting["main"])[0]
    panel = net.panels[0]
    for side in sheet.edges:
        assert sheet.edge(side, netting.mesh)[0] == len(np.unique(panel.edge(side)))
    labels = set(net.labels)
    for i in range(sheet.last(netting.mesh)[0] + 2):
        for j in range(sheet.last(netting.mesh)[1] + 2):
            assert sheet.has(i, j, netting.mesh) == (f"net:{i}-{j}" in labels), (i, j)
    found = judge(case)["panels"][0]
    assert found["mesh"] == "hexagonal"
    assert found["strain"] == pytest.approx(0.0, abs=1e-12)


def test_hexagons_that_cannot_close_are_told_in_words():
    (where, found, allowed, cure), *more = told(
        CYLINDER.replace('"T0"', '"T90"').replace("0.7", "[0.8, 0.7]")
    )
    assert not more
    assert "[[gear]] 1 netting" in where and "long bars round the cylinder" in found
    assert "along the height" in allowed and 'orientation = "T0" in [netting.main]' in cure
    bottom = CYLINDER + 'bottom = { meshes = 4, depth = "0.2 m" }\n'
    (where, found, allowed, cure), *more = told(bottom)
    assert not more
    assert "bottom" in where and "hexagonal netting" in found and "diamond netting" in allowed


def test_one_ratio_that_leaves_turned_hexagons_slack_is_told_in_words():
    """Their long bars alone are 45 of 75 mm, 0.6."""
    ((where, found, allowed, cure),) = told(CASE.replace('"T0"', '"T90"').replace("0.7", "0.55"))
    assert "hanging_ratio" in where and "0.55" in found and "at least 0.6" in allowed and "T0" in cure
