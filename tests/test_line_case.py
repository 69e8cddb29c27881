"""Lines, moorings, chain and the sea bed in case files: what is built, what is refused, what is told."""

from __future__ import annotations

import json

import numpy as np
import pytest

from fyke.case import CaseError, parse_case
from fyke.cli.check import judge
from fyke.results import line_figures
from fyke.solve.static import solve_static
from fyke.system.build import build_net, build_system
from fyke.system.hanging import hanging

HEAD = """schema = 1
[water]
density = 1025.0
depth = 20.0
[current]
velocity = [0.0, 0.0, 0.0]
[bed]
[twine.rope]
material = "PES"
diameter = "20 mm"
[twine.thin]
material = "PA"
diameter = "2 mm"
[chain.ground]
bar_diameter = "13 mm"
[netting.main]
twine = "thin"
mesh = "square"
bar_length = "0.5 m"
"""
CAGE = """[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [16, 4]
diameter = 2.4
height = 1.9
"""
LINE = """[[gear]]
kind = "line"
name = "warp"
from = [30.0, 0.0, -20.0]
to = "cage.top[0]"
twine = "rope"
length = "36 m"
"""
MOORINGS = """[[gear]]
kind = "moorings"
name = "moor"
around = "cage.top"
count = 4
radius = "30 m"
bearing = "45 deg"
pieces = [{ twine = "ground", length = "12 m", segments = 6 }, { twine = "rope", length = "26 m", segments = 8 }]
"""
WHOLE = HEAD + CAGE + LINE + MOORINGS
PIPE = '[tube.pipe]\nmaterial = "HDPE"\ndiameter = "110 mm"\nwall = "6.6 mm"\n'
COLLAR = '[[gear]]\nkind = "collar"\nname = "collar"\ntube = "pipe"\nalong = "cage.top"\n'


def built(text):
    case = parse_case(text)
    return case, build_net(case)


def test_a_line_and_moorings_are_made_fast_to_the_cage():
    case, net = built(WHOLE)
    lines = {rope.name: rope for rope in net.ropes}
    assert list(lines) == ["warp", "moor 1", "moor 2", "moor 3", "moor 4"]
    top = net.panels[0].edge("top")
    assert lines["warp"].knots[-1] == top[0]
    assert net.rest_length[lines["warp"].bars].sum() == pytest.approx(36.0)
    for number in range(4):
        knots = lines[f"moor {number + 1}"].knots
        angle = np.pi / 4.0 + number * np.pi / 2.0
        anchor = 30.0 * np.cos(angle), 30.0 * np.sin(angle), -20.0
        assert net.positions[knots[0]] == pytest.approx(anchor)
        assert net.positions[knots[-1]] == pytest.approx([1.2 * np.cos(angle), 1.2 * np.sin(angle), 0.0])
        assert net.fixed[knots[0]] and knots[-1] in top
        twines = [net.twines[i].name for i in net.twine_of_bar[lines[f"moor {number + 1}"].bars]]
        assert twines == ["ground"] * 6 + ["rope"] * 8
    assert case.bed is not None and build_system(net, case).bed.depth == 20.0


def test_floats_hang_in_every_mooring_and_along_a_line():
    text = WHOLE + (
        '[[gear]]\nkind = "floats"\nname = "buoys"\nat = ["moor:6", "warp:10"]\nbuoyancy = "50 N"\ndensity = 200\n'
        '[[gear]]\nkind = "sinkers"\nname = "leads"\nalong = "warp"\ncount = 3\nweight = "5 N"\ndensity = 7850\n'
    )
    _, net = built(text)
    lines = {rope.name: rope.knots for rope in net.ropes}
    assert net.bodies[0].knots.tolist() == [lines[f"moor {i}"][6] for i in (1, 2, 3, 4)] + [lines["warp"][10]]
    assert net.bodies[1].knots.tolist() == [lines["warp"][i] for i in (0, 10, 20)]


def test_lines_wait_for_the_lines_that_they_hang_on():
    """The dropper stands before the main line that it hangs on."""
    text = HEAD + (
        '[[gear]]\nkind = "line"\nname = "drop"\nfrom = "main:5"\nto = [0, 1, -8]\nfixed = "none"\n'
        'twine = "rope"\nlength = 8\nsegments = 4\n'
        '[[gear]]\nkind = "line"\nname = "main"\nfrom = [-10, 0, 0]\nto = [10, 0, 0]\n'
        'twine = "rope"\nlength = 21\nsegments = 10\n'
    )
    _, net = built(text)
    lines = {rope.name: rope.knots for rope in net.ropes}
    assert lines["drop"][0] == lines["main"][5]
    assert net.fixed.sum() == 2


def test_a_pretension_is_the_tension_that_statics_finds():
    text = (
        (HEAD + LINE)
        .replace('to = "cage.top[0]"', "to = [0.0, 0.0, 0.0]")
        .replace("\nlength = ", "\npretension = ")
    )
    text = text.replace('"36 m"', '"2 kN"\nsegments = 80')
    case, net = built(text)
    system = build_system(net, case)
    result = solve_static(system, tolerance=1e-6)
    (line,) = line_figures(system, result)["lines"]
    half = 0.5 * 9.81 * (1380.0 - 1025.0) * np.pi / 4.0 * 0.02**2 * line["length"] / 80
    assert line["tension_to"] == pytest.approx(
        2000.0 - half * np.sin(-np.radians(line["uplift_to"])), rel=1e-5
    )


def test_figures_of_lines_are_those_of_the_forces():
    """Held ends bear what the supports feel; what lies is borne by the bed."""
    case, net = built((HEAD + LINE).replace('"cage.top[0]"', "[0.0, 0.0, -1.0]").replace('"36 m"', "48"))
    system = build_system(net, case)
    result = solve_static(system, tolerance=1e-7)
    told = line_figures(system, result)
    (line,) = told["lines"]
    reaction = result.support_reaction[-1]
    assert line["horizontal_from"] - line["horizontal_to"] == pytest.approx(-told["bed_force"][0], abs=1e-6)
    assert abs(reaction[0]) == pytest.approx(abs(told["bed_force"][0]), abs=1e-6)
    assert told["bed_force"][2] + system.elements.weight[:, 2].sum() == pytest.approx(reaction[2], abs=1e-6)
    assert 10.0 < line["on_bed"] < 30.0
    assert line["held_from"] and line["held_to"] and line["uplift_to"] < -20.0
    assert line["max_tension"] == result.tension[-1].max()


def test_lines_over_no_ground_are_warned_of():
    (said,) = (one for one in parse_case(WHOLE.replace("[bed]\n", "")).warnings if "hang through" in one)
    assert "20 m down" in said and "add [bed]" in said
    assert not any("hang through" in one for one in parse_case(WHOLE).warnings)


def test_check_tells_of_lines_and_the_bed():
    told = judge(parse_case(WHOLE))
    assert told["bed"]["depth"] == 20.0
    assert [line["name"] for line in told["lines"]] == ["warp", *(f"moor {i}" for i in (1, 2, 3, 4))]
    assert told["lines"][1]["twines"] == ["ground", "rope"]
    assert told["lines"][0]["length"] == pytest.approx(36.0)
    json.dumps(told)


WRONG = {
    "a part that is not there": (
        LINE.replace("cage.top[0]", "cgae.top[0]"),
        ("[[gear]] 2 to", "\"cgae.top[0]\" of line 'warp'", 'NAME one of "cage"', '"cage.top[0]"'),
    ),
    "an edge that is not there": (
        LINE.replace("cage.top[0]", "cage.left[0]"),
        ("[[gear]] 2 to", '"cage.left[0]"', "top or bottom", "did you mean"),
    ),
    "a place beyond the edge": (
        LINE.replace("cage.top[0]", "cage.top[16]"),
        ("[[gear]] 2 to", '"cage.top[16]"', "0 to 15", '"cage.top[15]"'),
    ),
    "a knot that is not there": (
        LINE.replace("cage.top[0]", "cage:0-9"),
        ("[[gear]] 2 to", '"cage:0-9"', "rows 0 to 4", "choose a knot"),
    ),
    "a place in a row that is not there": (
        LINE.replace("cage.top[0]", "warb:3"),
        ("[[gear]] 2 to", '"warb:3"', '"warp"', '"warp:3"'),
    ),
    "an end that is no place": (
        LINE.replace("[30.0, 0.0, -20.0]", "[30.0, 0.0]"),
        ("[[gear]] 2 from", "[30.0, 0.0]", "[x, y, z]", "cage.top[0]"),
    ),
    "below the bed": (
        LINE.replace("-20.0", "-21.0"),
        ("[[gear]] 2 from", "z = -21 m", "above the sea bed at z = -20 m", "depth"),
    ),
    "too short": (
        LINE.replace('"36 m"', '"20 m"'),
        ("[[gear]] 2 length", "20 m of line 'warp', whose ends are 35.", "at least 29.", "longer"),
    ),
    "chain too short": (
        LINE.replace('"rope"', '"ground"').replace('"36 m"', '"34 m"'),
        ("[[gear]] 2 length", "34 m of line 'warp'", "at least 34.72", "longer"),
    ),
    "no twine": (
        LINE.replace('twine = "rope"\n', ""),
        ("[[gear]] 2 length", "length in line 'warp'", "twine and length", "twine ="),
    ),
    "both length and pretension": (
        LINE + 'pretension = "1 kN"\n',
        (
            "[[gear]] 2 twine",
            "twine and length and pretension",
            "or pieces alone",
            "leave out length or pretension",
        ),
    ),
    "twine of pieces that is not there": (
        MOORINGS.replace('"ground"', '"grund"'),
        ("[[gear]] 2 pieces.twine, value 1", '"grund"', '"ground"', 'did you mean "ground"?'),
    ),
    "twine that is not there": (
        LINE.replace('"rope"', '"roap"'),
        ("[[gear]] 2 twine", '"roap"', '"rope"', 'did you mean "rope"?'),
    ),
    "a pretension that cannot be": (
        LINE.replace('length = "36 m"', 'pretension = "1 N"'),
        ("[[gear]] 2 pretension", "1 N of line 'warp'", "N or more at its end", "another pretension"),
    ),
    "a pretension of a line on a line": (
        LINE
        + LINE.replace('"warp"', '"more"')
        .replace('"cage.top[0]"', '"warp:5"')
        .replace("length = ", "pretension = ")
        .replace("36 m", "1 kN"),
        ("[[gear]] 3 pretension", "1000 N of line 'more'", "between places and netting", "give length"),
    ),
    "a rim that is not there": (
        MOORINGS.replace('"cage.top"', '"cage.tip"'),
        ("[[gear]] 2 around", '"cage.tip" of moorings', '"NAME.EDGE"', 'did you mean "cage.top"?'),
    ),
    "around themselves": (
        MOORINGS.replace('"cage.top"', '"moor"'),
        ("[[gear]] 2 around", '"moor" of moorings', "name of a ring or rope", "did you mean"),
    ),
    "to one of several": (
        MOORINGS + LINE.replace("cage.top[0]", "moor:2"),
        ("[[gear]] 3 to", '"moor:2" of line', '"moor 1"', "did you mean"),
    ),
    "more lines than knots": (
        MOORINGS.replace("count = 4", "count = 40"),
        ("[[gear]] 2 count", "40 lines", "at most the 16 knots", "fewer"),
    ),
    "moorings too short": (
        MOORINGS.replace('"26 m"', '"10 m"'),
        ("[[gear]] 2 pieces", "22 m of moorings 'moor'", "at least", "longer"),
    ),
    "moorings of a collar too short": (
        PIPE + COLLAR + MOORINGS.replace('"cage.top"', '"collar"').replace('"26 m"', '"10 m"'),
        ("[[gear]] 3 pieces", "22 m of moorings 'moor'", "at least", "longer"),
    ),
    "too short for a collar": (
        PIPE + COLLAR + LINE.replace("cage.top[0]", "collar:0").replace('"36 m"', '"20 m"'),
        ("[[gear]] 3 length", "20 m of line 'warp', whose ends are 35.", "at least 29.", "longer"),
    ),
    "a tube for twine": (
        PIPE + LINE.replace('"rope"', '"pipe"'),
        ("[[gear]] 2 twine", '"pipe"', '"rope"', 'kinds "ring" and "collar" alone'),
    ),
    "lines in a circle": (
        LINE.replace("[30.0, 0.0, -20.0]", '"other:3"')
        + LINE.replace('"warp"', '"other"').replace("[30.0, 0.0, -20.0]", '"warp:3"'),
        (
            "[[gear]] 2 from",
            "made fast to a line that is made fast to it",
            "laid before",
            "begin one of them",
        ),
    ),
    "held by nothing": (
        LINE.replace('"cage.top[0]"', '[0.0, 0.0, 0.0]\nfixed = "none"'),
        ("[[gear]] 2 fixed", "no end of line 'warp' is held", "static case", 'fixed = "both"'),
    ),
    "two of one name": (
        LINE.replace('"warp"', '"cage"'),
        ("[[gear]] 2 name", "also the name of [[gear]] 1", "of its own", "another name"),
    ),
    "floats beyond a line": (
        LINE + '[[gear]]\nkind = "floats"\nat = ["warp:21"]\nmass = 1\ndiameter = 0.3\n',
        ("[[gear]] 3 at, value 1", '"warp:21"', "0 to 20", '"warp:20"'),
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_message_in_four_parts(name):
    gear, (where, found, allowed, cure) = WRONG[name]
    with pytest.raises(CaseError) as error:
        parse_case(HEAD + CAGE + gear)
    problems = [(p.where, p.found, p.allowed, p.cure) for p in error.value.problems]
    assert any(
        all(part in told for part, told in zip((where, found, allowed, cure), problem, strict=True))
        for problem in problems
    ), problems


def test_faults_of_netting_that_lines_hang_on_are_told_once():
    """A bottom that cannot be gathered and a netting that is not there are no faults of the lines."""
    for old, new, where in (
        ("height = 1.9", "height = 1.9\nbottom = { meshes = 3 }", "[[gear]] 1 bottom"),
        ('netting = "main"', 'netting = "mian"', "[[gear]] 1 netting"),
    ):
        with pytest.raises(CaseError) as error:
            parse_case(WHOLE.replace(old, new))
        (problem,) = error.value.problems
        assert problem.where.endswith(where)


def test_a_frame_of_lines_may_be_held_by_lines_that_come_after_it():
    """A grid as it is drawn: its frame first, then what anchors it."""
    frame = LINE.replace('"warp"', '"frame"').replace("[30.0, 0.0, -20.0]", "[-5.0, 8.0, -3.0]")
    frame = frame.replace('"cage.top[0]"', '[5.0, 8.0, -3.0]\nfixed = "none"').replace("36 m", "10 m")
    anchors = "".join(
        LINE.replace('"warp"', f'"anchor {k}"')
        .replace("[30.0,", f"[{x},")
        .replace('"cage.top[0]"', f'"frame:{k}"')
        for k, x in ((0, -30.0), (20, 30.0))
    )
    case, net = built(HEAD + CAGE + frame + anchors)
    assert not hanging(build_system(net, case), static=True)
    ends = {rope.name: net.labels[rope.knots[-1]] for rope in net.ropes}
    assert ends["anchor 0"] == "frame:0"
    assert ends["anchor 20"] == "frame:20"


def test_a_line_that_is_too_short_for_a_knot_known_late_is_warned_of():
    ring = (
        '[[gear]]\nkind = "ring"\nname = "r"\ntube = "pipe"\ndiameter = 3\nknots = 12\ncentre = [0, 0, 0]\n'
    )
    text = HEAD + PIPE + CAGE + ring + LINE.replace("cage.top[0]", "r:0").replace("36 m", "20 m")
    case, net = built(text)
    (told,) = hanging(build_system(net, case), static=True)
    apart = np.hypot(28.5, 20.0)
    assert f"Line 'warp' of 20 m is too short as built: its ends lie {apart:.4g} m apart" in told
    assert f"a strain of {(apart / 20 - 1) * 100:.1f} %" in told


def test_every_fault_is_told_at_once():
    text = HEAD + CAGE + "".join(WRONG[name][0] for name in ("too short", "more lines than knots"))
    with pytest.raises(CaseError) as error:
        parse_case(text.replace('[netting.main]\ntwine = "thin"', '[netting.main]\ntwine = "thick"'))
    assert len(error.value.problems) >= 2


@pytest.mark.parametrize(
    ("old", "new", "where", "found"),
    [
        ("depth = 20.0\n", "", "[water] depth", "nothing"),
        ("[chain.ground]", "[chain.rope]", "[chain.rope]", "also a twine"),
        ("[bed]", "[bed]\nfriction = -1", "[bed] friction", "-1"),
        ("[bed]", "[bed]\nstifness = 1", "[bed] stifness", "unknown key"),
    ],
)
def test_faults_of_the_water_and_the_chain(old, new, where, found):
    with pytest.raises(CaseError) as error:
        parse_case((HEAD + CAGE + LINE).replace(old, new, 1))
    assert any(where in p.where and found in p.found for p in error.value.problems), error.value


def test_explicit_steppers_are_refused_with_a_bed():
    solve = '[solve]\nkind = "dynamic"\nduration = 1.0\nstepper = "verner"\n'
    with pytest.raises(CaseError, match="which explicit steps do not know"):
        parse_case(HEAD + CAGE + LINE + solve)


def test_pictures_show_the_sea_bed_that_lines_come_down_to(tmp_path):
    """Not where the bed is far below, and not without one."""
    from fyke.report.figures import equilibrium_shape
    from fyke.report.ground import bed_under

    text = (HEAD + LINE).replace('"cage.top[0]"', "[0.0, 0.0, -1.0]").replace('"36 m"', "48")
    for change, level in (
        (("", ""), -20.0),
        (("[bed]\n", ""), None),
        (("depth = 20.0", "depth = 40.0"), None),
    ):
        case, net = built(text.replace(*change, 1))
        result = solve_static(build_system(net, case), tolerance=1e-3)
        assert bed_under(result) == level
        shown = {patch.get_gid() for ax in equilibrium_shape(result).axes for patch in ax.patches}
        assert ("sea bed" in shown) == (level is not None)


def test_the_page_has_a_row_for_each_line():
    from fyke.report.page.lines import LINE_COLUMNS, line_table

    case, net = built(WHOLE)
    system = build_system(net, case)
    figures = line_figures(system, solve_static(system, tolerance=1e-3))
    table = line_table(figures)
    assert [row[0][0] for row in table] == ["warp", "moor 1", "moor 2", "moor 3", "moor 4"]
    assert all(len(row) == len(LINE_COLUMNS) for row in table)
    assert table[1][2][0].endswith(", anchor") and table[1][2][1] == figures["lines"][1]["tension_from"]
    assert line_table({}) == []
