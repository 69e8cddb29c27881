"""Rings and collars: tubes as bars, what the case file makes of them, what is told and drawn of them."""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.case import CaseError, parse_case
from fyke.forces.bending import Bending
from fyke.forces.evaluate import evaluate
from fyke.netting.chain import chain
from fyke.netting.lines import LinePiece, with_line
from fyke.netting.shapes import cage
from fyke.netting.sheet import Netting
from fyke.netting.together import together
from fyke.netting.tubes import Tube, ring, with_tubes
from fyke.report.figures import equilibrium_shape, tension_plan
from fyke.report.page.packing import scene
from fyke.report.page.words import ring_table
from fyke.report.parts import Bars, parts_of
from fyke.report.sections import sections
from fyke.results import by_part, ring_figures, rings_told, write_rings
from fyke.results.rings import ring_words
from fyke.solve.result import Result
from fyke.solve.stability import unstable_direction
from fyke.system.hanging import hanging

PIPE = Tube.of("HDPE", diameter=0.315, wall=0.0179)


def test_the_section_of_a_tube_is_that_of_thin_walls_in_the_limit():
    thin = Tube(1.0, 1e-5, 1000.0, 1e9)
    assert thin.wall_area == pytest.approx(np.pi * 1e-5, rel=1e-4)
    assert thin.second_moment == pytest.approx(np.pi / 8.0 * 1e-5, rel=1e-4)


@pytest.mark.parametrize("contents", ["air", "water"])
def test_a_ring_weighs_in_water_its_wall_less_what_it_displaces(contents):
    tube = Tube(0.3, 0.02, 958.0, 9e8, contents)
    net = ring(tube.twine("pipe"), diameter=12.0, knots=24, centre=(0.0, 0.0, -5.0))
    system = fyke.make_system(net, water=fyke.Water(1025.0))
    length, wall, outline = 24 * 12.0 * np.sin(np.pi / 24), np.pi / 4 * (0.3**2 - 0.26**2), np.pi / 4 * 0.3**2
    displaced = outline if contents == "air" else wall
    assert system.weight_in_water == pytest.approx(
        9.81 * length * (958.0 * wall - 1025.0 * displaced), rel=1e-12
    )
    # The water inside is carried along.
    inside = 0.0 if contents == "air" else 1025.0 * (outline - wall)
    assert system.elements.knot_mass.sum() == pytest.approx(length * (958.0 * wall + inside), rel=1e-12)


def test_a_tube_is_as_stiff_as_its_wall():
    twine = PIPE.twine("pipe")
    (row,) = twine.law.rows(twine.diameter)
    assert row[2] == pytest.approx(9e8 * np.pi / 4 * (0.315**2 - 0.2792**2), rel=1e-12)
    assert twine.bending_stiffness == pytest.approx(9e8 * np.pi / 64 * (0.315**4 - 0.2792**4), rel=1e-12)


def test_a_wall_must_leave_room():
    with pytest.raises(ValueError, match=r"wall of 0\.2 m"):
        Tube(0.3, 0.2, 958.0, 9e8)


HEAD = """schema = 1
[water]
density = 1025.0
[current]
velocity = [0.3, 0, 0]
[twine.main]
material = "PA"
diameter = "2.5 mm"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "1 m"
[tube.pipe]
material = "HDPE"
diameter = "315 mm"
wall = "17.9 mm"
[tube.ballast]
material = "steel"
diameter = "200 mm"
wall = "20 mm"
contents = "water"
"""
CAGE = """[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [36, 8]
diameter = "11 m"
height = "8 m"
"""
COLLAR = """[[gear]]
kind = "collar"
name = "collar"
tube = "pipe"
tubes = 2
along = "cage.top"
"""
RING = """[[gear]]
kind = "ring"
name = "sinker tube"
tube = "ballast"
along = "cage.bottom"
"""
FREE = """[[gear]]
kind = "ring"
name = "spare"
tube = "pipe"
diameter = "5 m"
centre = [0.0, 20.0, -1.0]
knots = 12
rigid = true
"""
WHOLE = HEAD + CAGE + COLLAR + RING + FREE
BALLAST = Tube.of("steel", diameter=0.2, wall=0.02, contents="water")
BOW = np.sin(np.pi / 36)


def cage_by_hand():
    nylon = parse_case(HEAD + CAGE).twines["main"]
    return cage(Netting(nylon, "square", 1.0), (36, 8), diameter=11.0, depth=8.0, name="cage")


def test_a_case_builds_what_the_same_calls_make():
    net = fyke.build_net(parse_case(WHOLE))
    rigid = replace(PIPE, rigid=True).twine("pipe")
    spare = ring(rigid, diameter=5.0, knots=12, centre=(0.0, 20.0, -1.0), name="spare")
    made = together([cage_by_hand(), spare])
    top, bottom = (made.panels[0].edge(side) for side in ("top", "bottom"))
    made = with_tubes(made, top, PIPE.twine("pipe"), tubes=2, name="collar", kind="collar", free=True)
    made = with_tubes(made, bottom, BALLAST.twine("ballast"), name="sinker tube")
    for name in ("positions", "fixed", "bars", "rest_length", "twine_of_bar", "bar_multiple"):
        assert np.array_equal(getattr(net, name), getattr(made, name)), name
    assert (net.labels, net.twines) == (made.labels, made.twines)
    assert [(rope.kind, rope.name) for rope in net.ropes] == [
        ("ring", "spare"),
        ("collar", "collar"),
        ("ring", "sinker tube"),
    ]
    assert not net.fixed.any()
    assert net.labels[net.ropes[0].knots[3]] == "spare:3"


def test_two_tubes_side_by_side_are_two():
    one, two = (
        fyke.build_system(fyke.build_net(case), case)
        for case in (parse_case(HEAD + CAGE + COLLAR.replace("tubes = 2", f"tubes = {n}")) for n in (1, 2))
    )
    bars = one.net.ropes[0].bars
    for name in ("stiffness", "bar_added_mass", "normal_drag"):
        assert getattr(two.elements, name)[bars] == pytest.approx(
            2.0 * getattr(one.elements, name)[bars], rel=1e-12
        )
    each = 2.0 * 36 * 5.5 * BOW * 9.81 * (958.0 * PIPE.wall_area - 1025.0 * np.pi / 4 * 0.315**2)
    assert two.weight_in_water - one.weight_in_water == pytest.approx(each, rel=1e-12)
    bending = [Bending.of(system.net).stiffness for system in (one, two)]
    assert bending[1] == pytest.approx(2.0 * bending[0], rel=1e-12)


WRONG = {
    "a tube that is not there": (
        WHOLE.replace('tube = "ballast"', 'tube = "balast"'),
        ("[[gear]] 3 tube", '"balast"', "a tube of this file", 'did you mean "ballast"?'),
    ),
    "a wall without room": (
        WHOLE.replace('wall = "17.9 mm"', 'wall = "17.9 cm"'),
        ("[tube.pipe] wall", "179 mm in a tube of 315 mm", "157.5 mm", "units"),
    ),
    "a material that is not there": (
        WHOLE.replace('"HDPE"', '"HPDE"'),
        ("[tube.pipe] material", '"HPDE"', '"HDPE" or "steel"', 'did you mean "HDPE"?'),
    ),
    "no density": (
        WHOLE.replace('material = "HDPE"', 'youngs_modulus = "1 GPa"'),
        ("[tube.pipe] density", "neither density nor material", "density", "958"),
    ),
    "an edge that is not there": (
        WHOLE.replace("cage.top", "cage.topp"),
        ("[[gear]] 2 along", "\"cage.topp\" of collar 'collar'", "top or bottom", 'did you mean "cage.top"?'),
    ),
    "a ring both along an edge and of its own": (
        WHOLE.replace("rigid = true", 'along = "cage.top"'),
        (
            "[[gear]] 4 diameter",
            "diameter and centre and knots beside along in ring 'spare'",
            "along",
            "leave out",
        ),
    ),
    "a ring of its own without all": (
        WHOLE.replace("knots = 12", ""),
        ("[[gear]] 4 diameter", "diameter and centre in ring 'spare'", "knots", "add knots = 48"),
    ),
    "a ring nowhere": (
        WHOLE.replace('along = "cage.bottom"', ""),
        (
            "[[gear]] 3 along",
            "nothing of these in ring 'sinker tube'",
            "along an edge",
            'along = "NAME.bottom"',
        ),
    ),
    "two of a name": (
        WHOLE.replace('"spare"', '"collar"'),
        ("[[gear]] 4 name", '"collar", which is also the name of [[gear]] 2', "of its own", "another name"),
    ),
    "a text for a switch": (
        WHOLE.replace("rigid = true", 'rigid = "yes"'),
        ("[[gear]] 4 rigid", '"yes"', "true or false", "without quotes"),
    ),
    "explicit steps": (
        WHOLE + '[solve]\nkind = "dynamic"\nduration = 1\nstepper = "verner"\n',
        ("[solve] stepper", '"verner" with rings or collars', "implicit", "leave it out"),
    ),
    "a cage held by nothing": (
        WHOLE.replace('height = "8 m"', 'height = "8 m"\nfixed = "none"'),
        ("[[gear]] 1 fixed", '"none"', "static", "nothing would hold it"),
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_rings_are_told_with_the_cure(name):
    text, (where, found, allowed, cure) = WRONG[name]
    with pytest.raises(CaseError) as error:
        parse_case(text)
    (problem,) = error.value.problems
    assert where in problem.where
    assert found in problem.found
    assert allowed in problem.allowed
    assert cure in problem.cure


def test_all_that_is_wrong_is_told_at_once():
    text = (
        WHOLE.replace('"17.9 mm"', '"17.9 cm"')
        .replace("cage.top", "cage.topp")
        .replace("knots = 12", "knots = 2")
    )
    with pytest.raises(CaseError) as error:
        parse_case(text)
    assert len(error.value.problems) == 3


def warned(text):
    case = parse_case(text)
    return hanging(fyke.build_system(fyke.build_net(case), case), static=True)


def test_what_hangs_on_nothing_is_warned_of_by_name():
    loose = warned(WHOLE)
    assert len(loose) == 2
    assert "cylinder 'cage', collar 'collar' and ring 'sinker tube'" in loose[0]
    assert "ring 'spare': none of its 12 knots" in loose[1]
    assert not warned(HEAD + CAGE + RING)


def test_a_collar_that_is_too_heavy_sinks_with_the_figure():
    heavy = WHOLE.replace(FREE, "").replace('wall = "20 mm"', 'wall = "60 mm"')
    (told,) = [one for one in warned(heavy) if "sinks" in one]
    around = 36 * 11.0 * BOW
    lift = 9.81 * 1025.0 * 2 * around * np.pi / 4 * 0.315**2
    wall = np.pi / 4 * (0.2**2 - 0.08**2)
    twine = (36 * 8 + 36 * 9) * np.pi / 4 * 0.0025**2  # bars of 1 m, upright and round
    weighs = 9.81 * (
        2 * around * 958.0 * PIPE.wall_area + around * (7850.0 - 1025.0) * wall + (1140.0 - 1025.0) * twine
    )
    assert f"weighs {weighs:.4g} N" in told
    assert f"lifts at most {lift:.4g} N" in told
    assert weighs > lift


def test_moorings_are_no_load_of_a_collar_and_weights_on_lines_are():
    case = parse_case(WHOLE.replace(FREE, ""))
    net = fyke.build_net(case)
    chain = fyke.Twine("chain", 7850.0, 0.2, fyke.LinearLaw(1e11))
    top = net.panels[0].edge("top")
    moored = with_line(net, (40.0, 0.0, -20.0), int(top[0]), [LinePiece(chain, 45.0, 8)], name="mooring")
    assert not hanging(fyke.build_system(moored, case), static=True)
    hung = with_line(
        net, (5.5, 0.0, -40.0), int(top[18]), [LinePiece(chain, 45.0, 8)], name="weight", held=(False, False)
    )
    assert any("sinks" in one for one in hanging(fyke.build_system(hung, case), static=False))


def frame_of(system, position):
    """A result of one frame in which the knots are at rest at some places, in balance or not."""
    frame = evaluate(system, fyke.State(0.0, position, np.zeros_like(position)))
    outcome = fyke.Outcome("converged", "", "", "", "", 0, 0, 0.0, 0.0)
    return Result.from_frames(system.net, outcome, system.weight_in_water, [frame])


def afloat(knots, *, tubes=1, height=0.0):
    net = ring(PIPE.twine("pipe"), diameter=12.0, knots=knots, tubes=tubes, centre=(0.0, 0.0, height))
    return fyke.make_system(net, water=fyke.Water(1025.0), surface=True)


def test_draught_and_buoyancy_of_a_level_ring():
    system = afloat(48, tubes=2, height=0.05)
    (told,) = ring_figures(system, frame_of(system, system.net.positions))
    assert told.draught_least == told.draught_most == pytest.approx(0.1575 - 0.05, rel=1e-12)
    assert told.freeboard_least == pytest.approx(0.1575 + 0.05, rel=1e-12)
    # The area of a circular segment of height h: R^2 acos((R - h)/R) - (R - h) sqrt(2 R h - h^2).
    radius, deep = 0.1575, 0.1575 - 0.05
    segment = radius**2 * np.arccos((radius - deep) / radius) - 0.05 * np.sqrt(2.0 * radius * deep - deep**2)
    length = 2 * 48 * 12.0 * np.sin(np.pi / 48)
    assert told.largest_buoyancy == pytest.approx(9.81 * 1025.0 * length * np.pi * radius**2, rel=1e-12)
    assert told.buoyancy == pytest.approx(9.81 * 1025.0 * length * segment, rel=1e-9)
    assert told.weight == pytest.approx(9.81 * length * PIPE.mass, rel=1e-12)


def test_a_ring_deep_down_has_no_draught():
    system = afloat(48, height=-10.0)
    (told,) = ring_figures(system, frame_of(system, system.net.positions))
    assert told.draught_least is told.freeboard_least is None
    assert told.buoyancy == pytest.approx(told.largest_buoyancy, rel=1e-12)


def test_a_ring_blown_up_bears_its_hoop_and_a_moment_of_its_change_of_curvature():
    system = afloat(96, tubes=2, height=-10.0)
    net, grown = system.net, 1.001
    (told,) = ring_figures(system, frame_of(system, net.positions * [grown, grown, 1.0]))
    stiffness = 9e8 * PIPE.wall_area
    assert told.axial_force == pytest.approx(0.001 * stiffness, rel=1e-9)
    # Angles, and so moments by the unloaded length, stay those of the ring as built.
    assert told.bending_moment == pytest.approx(0.0, abs=1e-6)
    assert told.stress == pytest.approx(0.001 * 9e8, rel=1e-6)
    assert told.utilisation == pytest.approx(0.001 * 9e8 / 26e6, rel=1e-6)
    assert told.ovality == pytest.approx(1.0, abs=1e-12)


def test_moment_of_a_ring_made_oval_converges_to_that_of_the_oval_with_second_order():
    amplitude, radius = 0.05, 6.0
    exact = (
        3.0 * amplitude / radius**2 * 9e8 * PIPE.second_moment
    )  # EI (w'' + w)/R^2 of w = a cos 2 phi, small
    errors = []
    for knots in (24, 48, 96):
        system = afloat(knots, height=-10.0)
        x = system.net.positions.copy()
        phi = np.arctan2(x[:, 1], x[:, 0])
        # Inextensible: w = a cos 2 phi outwards, v = -a/2 sin 2 phi along, to first order.
        w, v = amplitude * 1e-3 * np.cos(2 * phi), -0.5 * amplitude * 1e-3 * np.sin(2 * phi)
        x[:, 0] += w * np.cos(phi) - v * np.sin(phi)
        x[:, 1] += w * np.sin(phi) + v * np.cos(phi)
        (told,) = ring_figures(system, frame_of(system, x))
        errors.append(abs(told.bending_moment / (1e-3 * exact) - 1.0))
    assert errors[-1] < 3e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.15)


@pytest.mark.parametrize("turned", [0.0, 0.7])
def test_a_ring_that_turns_as_a_whole_bends_by_nothing(turned):
    system = afloat(36, height=-10.0)
    x = system.net.positions - [0.0, 0.0, -10.0]
    c, s = np.cos(turned), np.sin(turned)
    x = x @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]) + [3.0, 0.0, -10.0]
    (told,) = ring_figures(system, frame_of(system, x))
    assert told.bending_moment == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("knots", [36, 45])
def test_ovality_is_the_largest_over_the_smallest_diameter(knots):
    system = afloat(knots, height=-10.0)
    (told,) = ring_figures(system, frame_of(system, system.net.positions * [1.1, 0.9, 1.0]))
    assert told.ovality == pytest.approx(1.1 / 0.9, rel=2e-3)


@pytest.fixture(scope="module")
def moored():
    """A cage of a few wide meshes on a collar of two tubes, with a sinker tube and four moorings, in a current."""
    nylon = fyke.Twine("nylon", 1140.0, 20e-3, fyke.LinearLaw(1e9))
    net = cage(Netting(nylon, "square", 3.0), (12, 3), diameter=11.4, depth=9.0, name="cage")
    top, bottom = (net.panels[0].edge(side) for side in ("top", "bottom"))
    net = with_tubes(net, top, PIPE.twine("pipe"), tubes=2, name="collar", kind="collar", free=True)
    net = with_tubes(net, bottom, BALLAST.twine("ballast"), name="sinker tube")
    rope = fyke.Twine("mooring", 910.0, 0.04, fyke.LinearLaw(1e9))
    for k in range(4):
        knot = int(top[3 * k])
        anchor = net.positions[knot] * 8.0 + [0.0, 0.0, -20.0]
        net = with_line(net, tuple(anchor), knot, [LinePiece(rope, 46.0, 4)], name=f"mooring {k}")
    system = fyke.make_system(net, current=(0.5, 0.0, 0.0), water=fyke.Water(1025.0), surface=True)
    result = fyke.solve_static(system)
    assert result.outcome.ok
    return system, result


def test_a_moored_cage_floats_and_its_rings_are_in_balance(moored):
    system, result = moored
    collar, sinker = ring_figures(system, result)
    assert 0.0 < collar.draught_least < collar.draught_most < 0.315
    assert sinker.draught_most is None
    frame = result.frame()
    el = system.elements
    for one, rope in zip((collar, sinker), system.net.ropes, strict=False):
        held = np.sum([one.from_netting, one.from_lines, one.from_others], axis=0)
        # What is left of the balance is the water on the tubes themselves, by the laws of drag, worked out here.
        t = np.diff(frame.position[rope.knots], axis=0)
        length = np.linalg.norm(t, axis=1)
        t /= length[:, None]
        wet = one.buoyancy / one.largest_buoyancy
        across, along = np.array([0.5, 0, 0]) - 0.5 * t[:, :1] * t, 0.5 * t[:, :1] * t
        each = (
            2.0
            * (el.normal_drag[rope.bars] * length)[:, None]
            * np.linalg.norm(across, axis=1)[:, None]
            * across
        )
        each += (
            2.0
            * (el.tangential_drag[rope.bars] * length)[:, None]
            * np.linalg.norm(along, axis=1)[:, None]
            * along
        )
        own = wet * each.sum(axis=0) + [0.0, 0.0, one.buoyancy - one.weight]
        size = abs(one.from_netting[2])
        # Exact where all is under water; along the surface the wet part goes with the place.
        assert np.abs(held + own).max() < (1e-6 if one is sinker else 2e-2) * size
    # All that the sinker tube and the netting weigh hangs on the collar.
    assert -collar.from_netting[2] > sinker.weight - sinker.buoyancy


def test_every_tube_is_drawn_in_its_thickness(moored, tmp_path):
    system, result = moored
    tubes = {part.own: part for part in parts_of(system.net) if isinstance(part, Bars) and part.diameter}
    assert {name: (part.name, part.diameter) for name, part in tubes.items()} == {
        "collar": ("collar", 0.315),
        "sinker tube": ("ring", 0.2),
    }
    shape, cut, plan = equilibrium_shape(result), sections(result), tension_plan(result)
    for figure in (shape, cut, plan):
        legends = [*figure.legends, *(ax.get_legend() for ax in figure.axes if ax.get_legend())]
        names = {text.get_text() for legend in legends for text in legend.get_texts()}
        assert {"collar", "ring"} <= names
    # On the plan, which has one scale, tubes are as wide as they are: points of a line over those of a metre.
    ax = plan.axes[0]
    points = 72.0 * ax.get_window_extent().width / plan.dpi / np.ptp(ax.get_xlim())
    drawn = {c.get_label(): c.get_linewidths()[0] for c in ax.collections if c.get_gid() == "ropes"}
    assert drawn["ring"] == pytest.approx(max(0.2 * points, drawn["ring"]))
    assert drawn["collar"] >= 0.315 * points * (1.0 - 1e-9)
    assert cut.axes[0].lines[0].get_markersize() > cut.axes[0].lines[1].get_markersize()
    data = scene(result)
    assert {part["diameter"] for part in data["parts"] if part["kind"] == "bars"} == {0.0, 0.315, 0.2}


def test_tables_tell_the_rings(moored, tmp_path):
    system, result = moored
    figures = rings_told(system, result)
    write_rings(figures["rings"], tmp_path)
    with (tmp_path / "rings.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["name"] for row in rows] == ["collar", "sinker tube"]
    for row, told in zip(rows, figures["rings"], strict=True):
        assert float(row["stress"]) == told["stress"]
        assert float(row["netting_z"]) == told["from_netting"][2]
    assert rows[1]["draught_most"] == ""
    assert "ovality" in dict(ring_words(figures))["collar collar"]
    assert len(ring_table(figures)) == 2
    parts = {part.name: part for part in by_part(system, result)}
    assert parts["collar"].kind == "collar"
    assert parts["collar"].utilisation == figures["rings"][0]["utilisation"]
    assert parts["sinker tube"].slack_bars == 0


def test_chain_that_rubs_on_the_ground_is_not_taken_for_a_tube_that_buckles():
    """Friction has no potential: the symmetric part of its stiffness alone has directions that fall."""
    hoop = ring(PIPE.twine("pipe"), diameter=4.0, knots=12, centre=(50.0, 0.0, -2.0))
    held = hoop.fixed.copy()
    held[:6] = True
    heavy = chain(0.022, name="chain")
    net = with_line(
        replace(hoop, fixed=held),
        (0.0, 0.0, -10.0),
        6,
        [LinePiece(heavy, 52.0, 12)],
        name="mooring",
        bed=-10.0,
    )
    system = fyke.make_system(net, water=fyke.Water(1025.0), bed=fyke.Bed(10.0))
    result = fyke.solve_static(system)
    assert result.outcome.ok
    found = result.position[-1]
    assert unstable_direction(system, found) is None
    lies = np.flatnonzero((found[:, 2] < -10.0) & ~net.fixed)
    assert len(lies) > 3
    dragged = found.copy()
    dragged[lies, 0] -= 0.01
    assert unstable_direction(system, dragged) is None
