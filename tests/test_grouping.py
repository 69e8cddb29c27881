"""Grouped meshes: totals by hand, the same forces whatever the group, and real bars' tensions.

The sags of 96 x 96 meshes, whole and grouped, were computed with another program than fyke: a CHOLMOD prototype of the
interior-point method, documented to six digits.
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fyke
from fyke.case import parse_case
from fyke.case.errors import CaseError
from fyke.case.grouping import knots_of
from fyke.forces.bed import footprint
from fyke.forces.evaluate import evaluate
from fyke.netting.joining import sewn
from fyke.netting.measures import measure_net
from fyke.netting.rigging import evenly
from fyke.netting.shapes import box, cage
from fyke.netting.sheet import Netting
from fyke.netting.together import together
from fyke.results.audit import audit
from fyke.results.derive import summary
from fyke.results.parts import by_part
from fyke.results.volume import volume_history
from fyke.solve import nested
from fyke.system.system import State
from fyke.water.laws.bars import Hoerner, Takagi
from fyke.water.laws.knots import SchillerNaumann
from fyke.water.laws.panels import KristiansenFaltinsen, Loland
from fyke.water.wakes import LolandWake

EXAMPLES = Path(__file__).parent.parent / "examples"
BAR, TWINE_DIAMETER, KNOT = 0.03, 1.5e-3, 3.5e-3
DENSITY, KNOT_DENSITY = 1140.0, 1300.0
LAWS = {
    "linear": fyke.LinearLaw(1e9),
    "power": fyke.PowerLaw(345.37e6, 1.0121),
    "quadratic": fyke.QuadraticLaw(1160.0, 37300.0),
    "table": fyke.TableLaw((0.0, 0.02, 0.05, 0.1), (0.0, 4.0, 20.0, 90.0)),
}
GROUPS = [1, 2, 4, 8]


def twine(law="linear"):
    return fyke.Twine("main", DENSITY, TWINE_DIAMETER, LAWS[law])


def panel(mesh, meshes, group, *, hung=0.9, law="linear", **options):
    bars = np.sqrt(2.0) if mesh == "diamond" else 1.0
    size = tuple(hung * count * BAR * bars for count in meshes)
    return fyke.panel(
        twine(law),
        mesh=mesh,
        meshes=meshes,
        bar_length=BAR,
        size=size,
        knot_diameter=KNOT,
        knot_density=KNOT_DENSITY,
        group=group,
        **options,
    )


def counts(mesh, meshes):
    """Knots and bars of a flat panel, by hand."""
    a, b = meshes
    return (2 * a * b + a + b + 1, 4 * a * b) if mesh == "diamond" else ((a + 1) * (b + 1), 2 * a * b + a + b)


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("group", [*GROUPS, 5, 7])
def test_knots_bars_mass_and_weight_are_those_of_the_real_net_by_hand(mesh, group):
    """24 x 16 meshes, which 5 and 7 do not divide."""
    meshes = (24, 16)
    net = panel(mesh, meshes, group)
    knots, bars = counts(mesh, meshes)
    told = measure_net(net)
    assert (told.real_knots, told.real_bars) == (knots, bars)
    assert told.twine_length == pytest.approx(bars * BAR, rel=1e-12)
    fibre, ball = np.pi / 4.0 * TWINE_DIAMETER**2 * bars * BAR, np.pi / 6.0 * KNOT**3 * knots
    assert told.mass == pytest.approx(DENSITY * fibre + KNOT_DENSITY * ball, rel=1e-12)
    system = fyke.make_system(net)
    sinking = (DENSITY - 1000.0) * fibre + (KNOT_DENSITY - 1000.0) * ball
    assert system.weight_in_water == pytest.approx(9.81 * sinking, rel=1e-12)
    assert system.elements.weight[:, 2].sum() == pytest.approx(-9.81 * sinking, rel=1e-12)
    added = 1000.0 * (fibre + 0.5 * ball)
    assert 2.0 * system.elements.bar_added_mass.sum() == pytest.approx(1000.0 * fibre, rel=1e-12)
    assert system.elements.knot_mass.sum() == pytest.approx(told.mass + added - 1000.0 * fibre, rel=1e-12)
    few = counts(mesh, net.panels[0].meshes)
    assert (net.knot_count, net.bar_count) == few
    assert group == 1 or few[0] < knots


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("group", GROUPS)
def test_drag_of_a_flat_panel_by_hand(mesh, group):
    """Face on, 1/2 rho U^2 (1.2 d l + 1.0 pi/4 d_k^2) over all bars as they are on the frame, and all knots."""
    meshes, speed = (16, 24), 0.5
    net = panel(mesh, meshes, group)
    knots, bars = counts(mesh, meshes)
    frame = evaluate(fyke.make_system(net, current=(speed, 0.0, 0.0)), fyke.make_system(net).at_rest())
    area = 1.2 * TWINE_DIAMETER * 0.9 * BAR * bars + np.pi / 4.0 * KNOT**2 * knots
    assert frame.hydrodynamic_force == pytest.approx(
        [500.0 * speed**2 * area, 0.0, 0.0], rel=1e-12, abs=1e-12
    )


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize(
    "laws",
    [
        {},
        {"bars": Takagi(), "knots": SchillerNaumann()},
        {"bars": Hoerner()},
        {"screens": Loland()},
        {"screens": KristiansenFaltinsen()},
        {"screens": Loland(), "wake": LolandWake()},
    ],
)
def test_an_inclined_panel_has_the_same_drag_and_lift_whatever_the_group(mesh, laws):
    forces = []
    for group in GROUPS:
        net = panel(mesh, (16, 24), group, normal=(1.0, 0.3, 0.5))
        system = fyke.make_system(net, current=(0.5, 0.0, 0.0), coefficients=fyke.Coefficients(**laws))
        forces.append(evaluate(system, system.at_rest()).hydrodynamic_force)
    assert np.linalg.norm(forces[0]) > 1.0
    for force in forces[1:]:
        assert force == pytest.approx(forces[0], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("law", LAWS)
def test_an_affine_stretch_gives_the_same_edge_force_and_real_tension(mesh, law):
    """Every bar of the real net has the strain of the stretch; its tension is that of its law by hand."""
    stretch = np.array([1.0, 1.0, 1.0]) * 1.03
    edge = []
    for group in GROUPS:
        net = panel(mesh, (16, 24), group, hung=1.0, law=law)
        system = fyke.make_system(net)
        frame = evaluate(system, State(0.0, net.positions * stretch, np.zeros_like(net.positions)))
        strain = 0.03
        row = LAWS[law].rows(TWINE_DIAMETER)
        row = row[np.searchsorted(row[:, 0], strain, side="right") - 1]
        above = strain - row[0]
        want = row[1] + row[2] * above + row[3] * above ** row[4]
        assert frame.tension == pytest.approx(np.full(net.bar_count, want), rel=1e-9)
        pull = (net.bar_multiple * frame.tension)[:, None] * _along(net)
        right = net.positions[:, 1] > net.positions[:, 1].max() - 1e-9
        a, b = net.bars.T
        edge.append(pull[right[b] & ~right[a]].sum(axis=0) - pull[right[a] & ~right[b]].sum(axis=0))
        # Every row of meshes has two bars at the side, at 45 degrees; every row of squares one.
        bars = 2 * 24 / np.sqrt(2.0) if mesh == "diamond" else 25
        assert edge[-1][1] == pytest.approx(bars * want, rel=1e-9)
    for force in edge[1:]:
        assert force == pytest.approx(edge[0], rel=1e-12, abs=1e-9)


def _along(net):
    a, b = net.positions[net.bars].transpose(1, 0, 2)
    return (b - a) / np.linalg.norm(b - a, axis=1)[:, None]


MESHES = Netting(twine(), "diamond", BAR, KNOT, KNOT_DENSITY)


@pytest.mark.parametrize("group", [1, 2, 4, 3])
def test_a_round_cage_has_the_knots_and_the_twine_of_the_real_one_by_hand(group):
    """48 x 12 meshes and a bottom of 8: rows of 48 knots, 24 + 1 of the wall, 15 more of the bottom, and its middle."""
    net = cage(replace(MESHES, group=group), (48, 12), diameter=0.8, depth=0.6, bottom=(8, 0.1))
    told = measure_net(net)
    knots, bars = 48 * (25 + 15) + 1, 2 * 48 * (24 + 16)
    assert (told.real_knots, told.real_bars) == (knots, bars)
    fibre, ball = np.pi / 4.0 * TWINE_DIAMETER**2 * bars * BAR, np.pi / 6.0 * KNOT**3 * knots
    assert told.mass == pytest.approx(DENSITY * fibre + KNOT_DENSITY * ball, rel=1e-12)
    wall, floor = net.panels
    assert wall.real_meshes == (48, 12) and floor.real_meshes == (48, 8)
    # Round an axis all knots of a row are alike, and those of the seam of wall and bottom stand for whole rows.
    seam = net.knot_multiple[wall.edge("bottom")]
    assert seam == pytest.approx(np.full(len(seam), wall.group[0] * 0.5 * (wall.group[1] + floor.group[1])))


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("group", [1, 2, 4])
def test_a_box_has_the_knots_and_the_twine_of_the_real_one_by_hand(mesh, group):
    """16 x 8 x 8 meshes and a bottom, which shares the knots and of squares the bars of the walls' lower edge."""
    net = box(replace(MESHES, mesh=mesh, group=group), (16, 8, 8), size=(0.5, 0.25, 0.25))
    told = measure_net(net)
    if mesh == "diamond":
        knots, bars = 48 * 17 + counts(mesh, (16, 8))[0] - 48, 2 * 48 * 16 + 4 * 16 * 8
    else:
        knots, bars = 48 * 9 + 17 * 9 - 48, 48 * (9 + 8) + counts(mesh, (16, 8))[1] - 48
    assert (told.real_knots, told.real_bars) == (knots, bars)
    assert told.twine_length == pytest.approx(bars * BAR, rel=1e-12)


def test_corners_of_a_box_must_be_at_knots():
    with pytest.raises(ValueError, match="3 does not divide the 16 and 8"):
        box(replace(MESHES, group=3), (16, 8, 8), size=(0.5, 0.25, 0.25))


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("group", [1, 2, 4])
def test_seams_have_the_real_knots_once(mesh, group):
    """Two panels of 8 x 8 meshes side by side are one of 16 x 8, but for the bars along the seam of squares."""
    parts = [
        panel(mesh, (8, 8), group, name=name, centre=(0.0, y, 0.0)) for name, y in (("a", 0.0), ("b", 0.4))
    ]
    sides = [("a", "right"), ("b", "left")]
    net = sewn(together(parts), *sides)
    knots, bars = counts(mesh, (16, 8))
    told = measure_net(net)
    assert (told.real_knots, told.real_bars) == (knots, bars + (8 if mesh == "square" else 0))


@pytest.mark.parametrize(
    ("few", "closed", "real"), [(13, False, 49), (12, False, 46), (12, True, 48), (5, True, 15)]
)
def test_what_hangs_at_real_knots_keeps_its_number_and_its_symmetry(few, closed, real):
    knots = np.arange(few + closed)
    knots[-1] = 0 if closed else few - 1
    at = np.bincount(evenly(knots, real, closed=closed, real=real), minlength=few)
    assert at.sum() == real and at.min() >= (real // few) // 2
    assert np.array_equal(at, np.roll(at[::-1], 1) if closed else at[::-1])


def test_a_real_bar_of_a_grouped_panel_bears_what_it_bears_in_the_real_net():
    """A wall on its frame in a current: largest tension, sag and drag of 32 x 32 meshes, and of 8 x 8 for them."""
    told = []
    for group in (1, 2, 4):
        net = panel("square", (32, 32), group, hung=0.98)
        result = fyke.solve_static(fyke.make_system(net, current=(0.6, 0.0, 0.0)))
        assert result.outcome.ok
        sag = np.abs(result.position[-1][:, 0]).max()
        told.append((result.tension[-1].max(), sag, result.hydrodynamic_force[-1][0]))
    assert told[0][0] > 0.5
    assert told[1] == pytest.approx(told[0], rel=0.01)
    assert told[2] == pytest.approx(told[0], rel=0.035)
    assert told[2][1:] == pytest.approx(told[0][1:], rel=0.003)


@pytest.mark.parametrize(("mesh", "meshes"), [("diamond", (64, 48)), ("square", (90, 66))])
def test_a_grouped_panel_may_begin_on_larger_meshes_still(monkeypatch, mesh, meshes):
    net = panel(mesh, meshes, 2, hung=0.97)
    system = fyke.make_system(net, current=(0.5, 0.0, 0.1))
    plain = fyke.solve_static(system, tolerance=1e-10)
    monkeypatch.setattr(nested, "LARGE", 400)
    begun = fyke.solve_static(system, tolerance=1e-10)
    assert plain.outcome.ok and begun.outcome.ok and "begun from" in begun.outcome.message
    assert np.abs(begun.tension[-1] - plain.tension[-1]).max() < 1e-7


def test_volume_and_drag_of_a_cage_converge_as_the_group_falls():
    """48 x 24 meshes round an axis, with weights: the difference to the real net falls with the group."""
    told = []
    for group in (1, 2, 4):
        case = parse_case(CAGE.replace("group = 1", f"group = {group}"))
        system = fyke.build_system(fyke.build_net(case), case)
        result = fyke.solve_static(system, tolerance=1e-6)
        assert result.outcome.ok
        drag, _, lift = result.hydrodynamic_force[-1].tolist()
        built, frames = volume_history(result)
        told.append((drag, float(frames[-1]), built))
        # Nothing is lost between the parts and the whole, and between water, weight and supports.
        parts = by_part(system, result)
        assert sum(part.water_force[0] for part in parts) == pytest.approx(drag, rel=1e-9)
        assert sum(part.weight_in_water for part in parts) == pytest.approx(system.weight_in_water, rel=1e-9)
        assert result.support_reaction[-1] == pytest.approx(
            [drag, 0.0, lift - system.weight_in_water], abs=1e-3
        )
    drags, volumes = (np.array([one[k] for one in told]) for k in (0, 1))
    assert abs(drags[1] - drags[0]) < abs(drags[2] - drags[0]) < 0.05 * drags[0]
    assert abs(volumes[1] - volumes[0]) < abs(volumes[2] - volumes[0]) < 0.08 * volumes[0]


CAGE = """
schema = 1
[current]
velocity = [0.3, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
youngs_modulus = "1 GPa"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "30 mm"
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [48, 24]
group = 1
diameter = "0.45 m"
height = "0.71 m"
top = [0.0, 0.0, -0.5]
[[gear]]
kind = "sinkers"
along = "cage.bottom"
weight = "0.05 N"
density = 7850.0
"""


GROUPED_EXAMPLES = {
    "aarsnes_cage": 2,
    "codend": 4,
    "cone": 4,
    "cylinder": 3,
    "frustum": 4,
    "gillnet": 16,
    "leaning_panel": 4,
    "model_cage": 5,
    "panel_reynolds": 4,
    "panel_sheared": 3,
    "square_and_diamond": 4,
    "two_screens": 4,
    "wall_waves": 3,
}


@pytest.mark.parametrize("example", GROUPED_EXAMPLES)
def test_totals_of_an_example_are_the_same_whatever_the_group(example):
    """Seams, boxes, tips, ropes, floats, sinkers, screens and laws: weight, mass and drag areas of the real net."""
    file = EXAMPLES / f"{example}.toml"
    text = re.sub(r"(?m)^group = .*$", "", file.read_text())
    text = re.sub(r"\[grouping\]\nknots = .*", "", text)
    told = []
    for group in (GROUPED_EXAMPLES[example], 1 if example != "gillnet" else 8):
        case = parse_case(re.sub(r"(?m)^(mesh = .*)$", rf"\1\ngroup = {group}", text), path=file)
        net = fyke.build_net(case)
        el = fyke.build_system(net, case).elements
        told.append(
            [
                measure_net(net).real_knots,
                measure_net(net).mass,
                el.weight[:, 2].sum(),
                el.knot_mass.sum(),
                el.bar_added_mass.sum(),
                (el.normal_drag * el.rest_length).sum(),
                el.knot_drag.sum(),
                net.knot_count,
            ]
        )
    assert told[0][:-1] == pytest.approx(told[1][:-1], rel=1e-9)
    assert told[0][-1] < told[1][-1]


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.toml")), ids=lambda file: file.stem)
def test_a_budget_counts_the_knots_that_are_laid(file):
    case = fyke.load_case(file)
    for piece in case.pieces:
        netting = case.netting[piece.netting]
        made = piece.lay(netting, case.twines[netting.twine])
        assert knots_of(piece, netting, piece.group) == made.knot_count


@pytest.mark.parametrize("bottom", ["true", "false"])
@pytest.mark.parametrize(
    ("mesh", "segments"), [("diamond", 1), ("square", 1), ("square", 3), ("hexagonal", 2)]
)
def test_a_budget_counts_boxes_and_segments(mesh, segments, bottom):
    if mesh == "hexagonal":
        bottom = "false"
    old = [
        ('"square"', f'"{mesh}"'),
        ("[48, 24]", "[8, 12, 6]"),
        ('kind = "cylinder"', f'kind = "box"\nbottom = {bottom}'),
        ('diameter = "0.45 m"', "size = [0.2, 0.3, 0.15]"),
        ('height = "0.71 m"', ""),
        ("group = 1", "group = 2" if segments == 1 else ""),
    ]
    extra = f"segments = {segments}" + ('\nlong_bar = "30 mm"' if mesh == "hexagonal" else "")
    case = case_of(old=old, netting=extra)
    (piece,), netting = case.pieces, case.netting["main"]
    made = piece.lay(netting, case.twines["main"])
    assert knots_of(piece, netting, piece.group) == made.knot_count


def case_of(*, old=(), netting="", grouping=""):
    text = CAGE.replace('bar_length = "30 mm"', f'bar_length = "30 mm"\n{netting}') + grouping
    for before, after in old:
        assert before in text
        text = text.replace(before, after)
    return parse_case(text)


def test_a_group_of_the_netting_and_one_of_the_gear():
    assert [piece.group for piece in case_of(netting="group = 3").pieces] == [1]
    assert [piece.group for piece in case_of(old=[("group = 1", "")], netting="group = 3").pieces] == [3]
    net = fyke.build_net(case_of(old=[("group = 1", "group = 4")]))
    assert net.panels[0].meshes == (12, 6) and net.panels[0].real_meshes == (48, 24)
    assert len(net.bodies[0].knots) == 48
    assert net.labels[0] == "cage:0-0" and "cage:44-24" in net.labels


@pytest.mark.parametrize(
    ("budget", "group"), [(1200, 1), (1199, 2), (312, 2), (311, 3), (100, 4), (60, 6), (40, 6)]
)
def test_a_budget_of_knots_is_kept_by_the_least_group(budget, group):
    """48 x (24 + 1) knots; 24 x 13, 16 x 9, 12 x 7, 10 x 6, 8 x 5 when grouped. 5 does not divide 48, 6 does both."""
    case = case_of(old=[("group = 1", "")], grouping=f"[grouping]\nknots = {budget}\n")
    net = fyke.build_net(case)
    assert net.knot_count <= budget
    assert case.pieces[0].group == group
    assert not case.warnings


def test_counts_that_the_group_does_not_divide_are_rounded_with_a_message():
    case = case_of(old=[("group = 1", "group = 5")])
    assert any("48 x 24" in one and "10 x 5 are laid" in one for one in case.warnings)
    net = fyke.build_net(case)
    assert measure_net(net).real_knots == 48 * 25


@pytest.mark.parametrize(
    ("changes", "parts"),
    {
        "segments": ({"netting": "segments = 2\ngroup = 2"}, ("[netting.main] group", "segments", "group")),
        "hexagons": (
            {
                "netting": 'long_bar = "30 mm"\ngroup = 2',
                "old": [('"square"', '"hexagonal"'), ("group = 1", "")],
            },
            ("[netting.main] group", "hexagonal", "diamond and square"),
        ),
        "too large": (
            {"old": [("group = 1", "group = 20")]},
            ("[[gear]] 1 group", "20 for the cylinder of 48 x 24", "at most 16", "group = 16"),
        ),
        "no number": ({"old": [("group = 1", "group = 0")]}, ("group", "0", "1 to 1000")),
        "small budget": (
            {"old": [("group = 1", "")], "grouping": "[grouping]\nknots = 5\n"},
            ("[grouping] knots", "5, but the netting has", "or more"),
        ),
        "given groups": (
            {"grouping": "[grouping]\nknots = 500\n"},
            ("[grouping] knots", "500, but the netting has 1200 at least", "1200 or more"),
        ),
        "box": (
            {
                "old": [
                    ('"cylinder"', '"box"'),
                    ("[48, 24]", "[8, 12, 8]"),
                    ('diameter = "0.45 m"', "size = [0.24, 0.36, 0.24]"),
                    ('height = "0.71 m"', ""),
                    ("group = 1", "group = 3"),
                ]
            },
            ("[[gear]] 1 group", "3 for the box of 8 x 12", "divides both", "1, 2, 4", "group = "),
        ),
        "too many knots": (
            {"old": [("[48, 24]", "[20000, 2000]"), ('"0.45 m"', '"190 m"'), ('"0.71 m"', '"60 m"')]},
            ("gear", "knots", "at most 10,000,000", "[grouping]"),
        ),
    }.values(),
)
def test_what_is_wrong_with_a_group_is_told_in_four_parts(changes, parts):
    with pytest.raises(CaseError) as caught:
        case_of(**changes)
    told = [" | ".join((p.where, p.found, p.allowed, p.cure)) for p in caught.value.problems]
    assert any(all(part in one for part in parts) for one in told), told


def test_accounts_and_breaking_strength_of_a_grouped_net():
    """Forces on the knots from the tensions of real bars balance; use of strength is that of one real bar."""
    strong = [
        ("group = 1", "group = 4"),
        ('diameter = "1.5 mm"', 'diameter = "1.5 mm"\nbreaking_strength = "100 N"'),
    ]
    case = case_of(old=strong)
    system = fyke.build_system(fyke.build_net(case), case)
    result = fyke.solve_static(system)
    assert result.outcome.ok
    assert audit(system, result).unbalanced_force < 1e-6
    wall = by_part(system, result)[0]
    assert wall.utilisation == pytest.approx(result.tension[-1].max() / 100.0, rel=1e-12)
    stress = result.tension[-1].max() / (1e9 * np.pi / 4.0 * TWINE_DIAMETER**2)
    assert summary(result)["max_strain"] == pytest.approx(stress, rel=1e-6)


def test_energy_of_a_grouped_net_in_motion_is_accounted_for():
    """A taut panel bags in a current: the work of the current is in drag and in the stretch of all real bars."""
    net = panel("square", (16, 16), 4, hung=1.001)
    system = fyke.make_system(net, current=(1.5, 0.0, 0.0))
    result = fyke.simulate(system, duration=0.05, every=5e-4, stepper=fyke.Implicit(max_step=2.5e-4))
    energy = audit(system, result).energy
    assert energy.elastic > 0.05
    assert abs(energy.remainder) < 0.01 * energy.elastic


@pytest.mark.parametrize("mesh", ["diamond", "square"])
def test_what_lies_on_the_bed_has_the_area_of_the_real_netting_by_hand(mesh):
    knots, bars = counts(mesh, (16, 8))
    for group in (1, 2, 4):
        area, diameter, _ = footprint(panel(mesh, (16, 8), group))
        assert area.sum() == pytest.approx(
            TWINE_DIAMETER * BAR * bars + np.pi / 4.0 * KNOT**2 * knots, rel=1e-12
        )
        assert diameter == pytest.approx(np.full(len(diameter), KNOT))


def test_a_result_of_a_grouped_net_comes_back_from_its_file(tmp_path):
    case = case_of(old=[("group = 1", "group = 4")])
    result = fyke.solve_static(fyke.build_system(fyke.build_net(case), case))
    file = tmp_path / "grouped.nc"
    fyke.save(result, file)
    back = fyke.load(file)
    assert np.array_equal(back.net.bar_multiple, result.net.bar_multiple)
    assert np.array_equal(back.net.knot_multiple, result.net.knot_multiple)
    assert back.net.panels[0].real_meshes == (48, 24)
    figures = summary(back)
    assert (figures["real_knots"], figures["real_bars"], figures["group"]) == (1200, 48 * 49, 4.0)
    # Begun where it ended, a solve has nothing left to do.
    again = fyke.solve_static(fyke.build_system(fyke.build_net(case), case), start=back.state())
    assert again.outcome.ok and np.abs(again.tension - back.tension).max() < 1e-6
