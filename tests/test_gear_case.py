"""Gear in the case file: what it builds against the same made by hand, what it refuses, what fyke check tells."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import fyke
from fyke.case import CaseError, json_schema, parse_case
from fyke.cli.check import check_case
from fyke.netting.measures import measure_net
from fyke.netting.panel import panel
from fyke.netting.rigging import Sphere, evenly, with_bodies, with_rope
from fyke.netting.shapes import cage, frustum
from fyke.netting.sheet import Netting
from fyke.netting.together import together

HEAD = """schema = 1
[current]
velocity = [0.3, 0, 0]
[twine.main]
material = "PA"
diameter = "2.5 mm"
[twine.line]
material = "PES"
diameter = "8 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "100 mm"
[netting.square]
twine = "main"
mesh = "square"
bar_length = "100 mm"
segments = 2
"""
CAGE = """[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [16, 5]
diameter = "0.65 m"
height = "0.75 m"
top = [0.0, 0.0, -0.2]
bottom = { meshes = 4, depth = "0.3 m" }
"""
ROPE = """[[gear]]
kind = "rope"
name = "footrope"
twine = "line"
along = "cage.bottom"
"""
SINKERS = """[[gear]]
kind = "sinkers"
name = "weights"
along = "cage.bottom"
count = 8
weight = "5.15 N"
density = 7850
"""
FLOATS = """[[gear]]
kind = "floats"
name = "corks"
at = ["cage:0-10", "cage:8-10"]
buoyancy = "3 N"
density = "0.2 g/cm3"
drag = 0.5
"""
WHOLE = HEAD + CAGE + ROPE + SINKERS + FLOATS
NYLON = parse_case(HEAD + CAGE).twines["main"]
LINE = parse_case(HEAD + CAGE).twines["line"]
DIAMOND = Netting(NYLON, "diamond", 0.1)
SQUARE = Netting(NYLON, "square", 0.1, segments=2)


def same(one, other):
    """Whether two values are equal bit for bit, arrays and dataclasses within them included."""
    if is_dataclass(one):
        return type(one) is type(other) and all(
            same(getattr(one, f.name), getattr(other, f.name)) for f in fields(one)
        )
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other)
    if isinstance(one, tuple):
        return len(one) == len(other) and all(same(a, b) for a, b in zip(one, other, strict=True))
    return one == other


def shape(kind, *rows, netting="main", meshes="[12, 4]"):
    return "\n".join(
        [HEAD, "[[gear]]", f'kind = "{kind}"', f'netting = "{netting}"', f"meshes = {meshes}", *rows, ""]
    )


E1E2 = [0.6, 0.8]
BUILT = {
    "cylinder": (
        shape("cylinder", 'diameter = "0.5 m"', "height = 0.6", "top = [1, 2, -3]"),
        frustum(DIAMOND, (12, 4), diameters=(0.5, 0.5), height=0.6, centre=(1.0, 2.0, -3.0)),
    ),
    "cylinder of square netting, both rims held": (
        shape("cylinder", "diameter = 0.38", "height = 0.4", 'fixed = "edges"', netting="square"),
        frustum(SQUARE, (12, 4), diameters=(0.38, 0.38), height=0.4, fixed="edges"),
    ),
    "cylinder by hanging ratios": (
        shape("cylinder", f"hanging_ratio = {E1E2}"),
        frustum(DIAMOND, (12, 4), diameters=(12 * 2 * 0.1 * 0.6 / np.pi,) * 2, height=4 * 2 * 0.1 * 0.8),
    ),
    "cone": (
        shape("cone", "diameter = 0.6", "height = 0.5"),
        frustum(DIAMOND, (12, 4), diameters=(0.0, 0.6), height=0.5),
    ),
    "frustum, wider below": (
        shape("frustum", "diameter = [0.7, 0.5]", "height = 0.5", 'name = "skirt"'),
        frustum(DIAMOND, (12, 4), diameters=(0.7, 0.5), height=0.5, name="skirt"),
    ),
    "cylinder with a flat bottom": (
        shape("cylinder", "diameter = 0.5", "height = 0.6", "bottom = { meshes = 3 }", 'name = "pot"'),
        cage(DIAMOND, (12, 4), diameter=0.5, depth=0.6, bottom=(3, 0.0), name="pot"),
    ),
    "frustum with a bottom": (
        shape("frustum", "diameter = [0.4, 0.5]", "height = 0.6", "bottom = { meshes = 3, depth = 0.1 }"),
        cage(DIAMOND, (12, 4), diameter=0.5, lower=0.4, depth=0.6, bottom=(3, 0.1), name=""),
    ),
    "panel in segments": (
        shape("panel", "size = [0.9, 0.35]", "centre = [0, 0, -1]", netting="square", meshes="[9, 4]"),
        panel(
            NYLON,
            mesh="square",
            meshes=(9, 4),
            bar_length=0.1,
            size=(0.9, 0.35),
            segments=2,
            centre=(0, 0, -1),
        ),
    ),
}


@pytest.mark.parametrize("name", BUILT)
def test_a_shape_is_what_the_same_call_makes(name):
    text, net = BUILT[name]
    assert same(fyke.build_net(parse_case(text)), net)


def test_a_whole_gear_is_what_the_same_calls_make():
    """Netting first, wherever it stands in the file; then ropes; then floats and sinkers."""
    second = (
        '[[gear]]\nkind = "panel"\nname = "wing"\nnetting = "main"\nmeshes = [3, 2]\nhanging_ratio = 0.5\n'
    )
    text = HEAD + SINKERS + ROPE + 'length = "2.1 m"\n' + CAGE + FLOATS + second
    net = together(
        [
            cage(
                DIAMOND,
                (16, 5),
                diameter=0.65,
                depth=0.75,
                bottom=(4, 0.3),
                top=(0.0, 0.0, -0.2),
                name="cage",
            ),
            panel(
                NYLON,
                mesh="diamond",
                meshes=(3, 2),
                bar_length=0.1,
                size=(3 * 0.2 * 0.5, 2 * 0.2 * 0.75**0.5),
                name="wing",
            ),
        ]
    )
    rim = net.panels[0].edge("bottom")
    net = with_rope(net, rim, LINE, length=2.1, name="footrope")
    sinker = Sphere.of_weight(5.15, density=7850.0, water=1000.0)
    net = with_bodies(net, sinker.at(evenly(rim, 8, closed=True), name="weights", kind="sinker"))
    cork = Sphere.of_buoyancy(3.0, density=200.0, water=1000.0)
    cork = Sphere(cork.mass, cork.diameter, 0.5)
    at = [net.labels.index("cage:0-10"), net.labels.index("cage:8-10")]
    net = with_bodies(net, cork.at(at, name="corks", kind="float"))
    assert same(fyke.build_net(parse_case(text)), net)


def test_weights_by_hand():
    """Bars, the rope, 8 sinkers, 2 floats: the weight of the whole, and of each in fyke check."""
    case = parse_case(WHOLE)
    net = fyke.build_net(case)
    netting = 9.81 * 140.0 * np.pi / 4.0 * 0.0025**2 * 0.1 * (4 * 16 * 5 + 4 * 16 * 4)
    chord = 0.65 * np.sin(np.pi / 16)
    rope = 9.81 * 380.0 * np.pi / 4.0 * 0.008**2 * 16 * chord
    weight = fyke.build_system(net, case).weight_in_water
    assert weight == pytest.approx(netting + rope + 8 * 5.15 - 2 * 3.0, rel=1e-10)
    mass = netting / 9.81 * 1140.0 / 140.0 + rope / 9.81 * 1380.0 / 380.0
    mass += 8 * 5.15 / 9.81 * 7850.0 / 6850.0 + 2 * 3.0 / 9.81 * 200.0 / 800.0
    assert measure_net(net).mass == pytest.approx(mass, rel=1e-10)


def test_one_at_every_knot_and_one_at_the_tip():
    every = SINKERS.replace("count = 8\n", "")
    tip = (
        SINKERS.replace("count = 8\n", "")
        .replace("weights", "lead")
        .replace("cage.bottom", "cage bottom.bottom")
    )
    bodies = fyke.build_net(parse_case(HEAD + CAGE + every + tip)).bodies
    assert [len(set(one.knots.tolist())) for one in bodies] == [16, 1]
    net = fyke.build_net(parse_case(HEAD + CAGE + tip))
    assert net.positions[net.bodies[0].knots[0]] == pytest.approx([0.0, 0.0, -1.25])


def test_mass_and_diameter_say_it_as_well():
    text = WHOLE.replace('weight = "5.15 N"\ndensity = 7850', 'mass = "601.6 g"\ndiameter = "52.7 mm"')
    (weights, _) = fyke.build_net(parse_case(text)).bodies
    assert (weights.mass, weights.diameter) == (0.6016, 0.0527)
    assert weights.drag_area == pytest.approx(0.47 * np.pi / 4 * 0.0527**2, rel=1e-14)


SPOILT = {
    "ratio over 1": (
        shape("cylinder", "hanging_ratio = [1.1, 0.4]"),
        ("hanging_ratio", "[1.1, 0.4] of the cylinder", "at most 1", "common"),
    ),
    "ratio over 1, one number": (
        shape("cone", "hanging_ratio = 1.2"),
        ("hanging_ratio", "1.2", "below 1", "less"),
    ),
    "cone that cannot close": (
        shape("cone", "hanging_ratio = [0.9, 0.3]"),
        ("hanging_ratio", "0.24 m from rim to tip", "0.6875 m", "E1 smaller"),
    ),
    "wider than its meshes": (
        shape("cylinder", "diameter = 1.5", "height = 0.5"),
        ("[[gear]] 1 diameter", "strains the bars by 106 %", "at most 20 %", "check the units"),
    ),
    "bottom too deep": (
        WHOLE.replace('"0.3 m"', '"3 m"'),
        ("[[gear]] 1 bottom", "bottom of the cylinder", "20 %", "check"),
    ),
    "two parts of one name": (
        WHOLE.replace('"weights"', '"cage"'),
        ("[[gear]] 3 name", '"cage", which is also the name of [[gear]] 1', "of its own", "another"),
    ),
    "the name of a bottom": (
        WHOLE.replace('"weights"', '"cage bottom"'),
        ("[[gear]] 3 name", "the bottom of [[gear]] 1", "of its own", "another"),
    ),
    "along an unknown part": (
        WHOLE.replace("cage.bottom", "cgae.bottom", 1),
        ("[[gear]] 2 along", "\"cgae.bottom\" of rope 'footrope'", '"cage", "cage bottom"', '"cage.bottom"'),
    ),
    "along no edge": (
        WHOLE.replace("cage.bottom", "cage", 1),
        ("[[gear]] 2 along", '"cage"', "NAME.EDGE", "did you mean"),
    ),
    "side of what closes": (
        WHOLE.replace("cage.bottom", "cage.left", 1),
        ("[[gear]] 2 along", "cage.left", "top or bottom; it closes round", "cage.bottom"),
    ),
    "edge misspelt": (
        WHOLE.replace("cage.bottom", "cage.botom", 1),
        ("[[gear]] 2 along", "cage.botom", "top or bottom", "cage.bottom"),
    ),
    "too many": (
        WHOLE.replace("count = 8", "count = 17"),
        ("[[gear]] 3 count", "17 of sinkers 'weights'", "at most the 16 knots", "fewer"),
    ),
    "sinkers that float": (
        WHOLE.replace("7850", "900"),
        ("[[gear]] 3 density", "900 kg/m3, which does not sink", "above the 1000", 'kind = "floats"'),
    ),
    "light sinkers": (
        WHOLE.replace('weight = "5.15 N"\ndensity = 7850', 'mass = "10 g"\ndiameter = "60 mm"'),
        ("[[gear]] 3 mass", "88.4194 kg/m3", "above the 1000", "units of mass, diameter"),
    ),
    "floats that sink": (
        WHOLE.replace("0.2 g/cm3", "1.2 g/cm3"),
        ("[[gear]] 4 density", "1200 kg/m3, which does not float", "below the 1000", 'kind = "sinkers"'),
    ),
    "rope too short": (
        WHOLE.replace(ROPE, ROPE + 'length = "1.5 m"\n'),
        ("[[gear]] 2 length", "1.5 m of rope 'footrope'", "at least 1.691 m", "leave length out"),
    ),
    "rope round a tip": (
        WHOLE.replace("cage.bottom", "cage bottom.bottom", 1),
        ("[[gear]] 2 along", "one knot", "several knots", "another edge"),
    ),
    "cone of square netting": (
        shape("cone", "diameter = 0.3", "height = 0.3", netting="square"),
        ("[[gear]] 1 kind", "square netting", "diamond", "[netting.square]"),
    ),
    "bottom of square netting": (
        shape("cylinder", "diameter = 0.38", "height = 0.4", "bottom = { meshes = 2 }", netting="square"),
        ("[[gear]] 1 bottom", "square netting", "diamond", "leave bottom out"),
    ),
    "cone with a lower diameter": (
        shape("cone", "diameter = [0.7, 0.5]", "height = 0.3"),
        ("[[gear]] 1 diameter", "[0.7, 0.5]", "one diameter", 'kind = "frustum"'),
    ),
    "frustum with one diameter": (
        shape("frustum", "diameter = 0.5", "height = 0.3"),
        ("[[gear]] 1 diameter", "0.5", "two diameters", "[lower, upper]"),
    ),
    "no size": (
        shape("cylinder", "diameter = 0.5"),
        ("[[gear]] 1 diameter", "diameter in the cylinder", "hanging_ratio instead", 'add height = "1.5 m"'),
    ),
    "two sizes": (
        shape("cylinder", "diameter = 0.5", "hanging_ratio = 0.5"),
        ("[[gear]] 1 diameter", "diameter and hanging_ratio", "instead of both", "leave out"),
    ),
    "one ratio for square netting": (
        shape("cylinder", "hanging_ratio = 0.5", netting="square"),
        ("[[gear]] 1 hanging_ratio", "0.5", "[E1, E2]", "[0.5, 0.5]"),
    ),
    "two meshes around": (
        shape("cylinder", "diameter = 0.1", "height = 0.3", meshes="[2, 3]"),
        ("[[gear]] 1 meshes", "2 around", "at least 3", "first"),
    ),
    "held by nothing": (
        shape("cylinder", "diameter = 0.5", "height = 0.3", 'fixed = "none"'),
        ("[[gear]] 1 fixed", '"none"', '"top" or "edges" for a static case', 'fixed = "top"'),
    ),
    "held at corners": (
        shape("cylinder", "diameter = 0.5", "height = 0.3", 'fixed = "corners"'),
        ("[[gear]] 1 fixed", '"corners"', '"top" or "edges" or "none"', "choose"),
    ),
    "a kind nearly there": (
        WHOLE.replace('kind = "rope"', 'kind = "ropes"'),
        ("[[gear]] 2 kind", '"ropes"', '"panel" or "trapezoid"', 'did you mean "rope"?'),
    ),
    "a kind to choose": (
        WHOLE.replace('kind = "rope"', 'kind = "buoy"'),
        ("[[gear]] 2 kind", '"buoy"', '"sinkers"', "choose"),
    ),
    "a key of another kind": (
        WHOLE.replace('twine = "line"', 'twine = "line"\nbuoyancy = "3 N"'),
        ("[[gear]] 2 buoyancy", "unknown key", "along", '[[gear]] with kind = "floats"'),
    ),
    "rope of unknown twine": (
        WHOLE.replace('twine = "line"', 'twine = "lime"'),
        ("[[gear]] 2 twine", '"lime"', '"line"', 'did you mean "line"?'),
    ),
    "segments": (
        WHOLE.replace("segments = 2", "segments = 51"),
        ("[netting.square] segments", "51", "a whole number from 1 to 50", "50 or less"),
    ),
    "weight and mass": (
        WHOLE.replace("density = 7850", 'mass = "1 kg"'),
        ("[[gear]] 3 weight", "weight and mass in sinkers", "or mass and diameter", "density = 7850"),
    ),
    "along and at": (
        WHOLE.replace("count = 8", 'at = ["cage:0-0"]'),
        ("[[gear]] 3 along", "both along and at", "or labels", "leave one"),
    ),
    "neither along nor at": (
        WHOLE.replace(SINKERS, SINKERS.replace('along = "cage.bottom"\ncount = 8\n', "")),
        ("[[gear]] 3 along", "neither", "labels", "NAME.bottom"),
    ),
    "count beside at": (
        WHOLE.replace('buoyancy = "3 N"', 'buoyancy = "3 N"\ncount = 2'),
        ("[[gear]] 4 count", "beside at in floats 'corks'", "along only", "leave count out"),
    ),
    "knot that is not there": (
        WHOLE.replace("cage:8-10", "cage:8-11"),
        ("[[gear]] 4 at, value 2", '"cage:8-11"', "columns 0 to 31, rows 0 to 10", "knots.csv"),
    ),
    "knot between knots": (
        WHOLE.replace("cage:8-10", "cage:8-9"),
        ("[[gear]] 4 at, value 2", '"cage:8-9"', "sum is even", "knots.csv"),
    ),
    "knot of the seam": (
        WHOLE.replace("cage:8-10", "cage bottom:0-8"),
        ("[[gear]] 4 at, value 2", '"cage bottom:0-8"', "rows 0 to 7", "knots.csv"),
    ),
    "no label": (
        WHOLE.replace("cage:8-10", "corner"),
        ("[[gear]] 4 at, value 2", '"corner"', "column-row", ":0-0"),
    ),
    "knot twice": (
        WHOLE.replace("cage:8-10", "cage:0-10"),
        ("[[gear]] 4 at, value 2", "twice", "once", "leave it out"),
    ),
    "rigging alone": (
        HEAD + ROPE,
        ("[[gear]] 1 along", '"cage.bottom"', "no netting yet", "add gear with netting"),
    ),
    "below the sea bed": (
        "schema = 1\n[water]\ndepth = 1.0\n" + WHOLE.removeprefix("schema = 1\n"),
        ("[[gear]] 1 top", "z = -1.25 m", "z = -1 m", "raise its top"),
    ),
    "weight without gravity": (
        "schema = 1\n[water]\ngravity = 0.0\n" + WHOLE.removeprefix("schema = 1\n"),
        ("[[gear]] 3 weight", "without gravity", "gravity above 0", "mass and diameter"),
    ),
    "a float as dense as the water": (
        WHOLE.replace('"0.2 g/cm3"', "999.999999999"),
        ("[[gear]] 4 buoyancy", "a sphere of", "at most 100 m", "too near"),
    ),
}


MORE = {"weight without gravity": 2}  # sinkers and floats


@pytest.mark.parametrize("name", SPOILT)
def test_what_is_wrong_is_told_in_four_parts(name):
    text, pieces = SPOILT[name]
    with pytest.raises(CaseError) as caught:
        parse_case(text, "c.toml")
    told = [(p.where, p.found, p.allowed, p.cure) for p in caught.value.problems]
    assert any(all(a in b for a, b in zip(pieces, parts, strict=True)) for parts in told), told
    assert len(told) == MORE.get(name, 1), told


def test_all_problems_of_a_file_at_once():
    text = WHOLE.replace("count = 8", "count = 80").replace("0.2 g/cm3", "2 g/cm3").replace("8-10", "8-9")
    text = text.replace('along = "cage.bottom"', 'along = "cage.right"', 1)
    with pytest.raises(CaseError) as caught:
        parse_case(text)
    assert [p.where.split(", [[gear]] ")[1] for p in caught.value.problems] == [
        "2 along",
        "3 count",
        "4 at, value 2",
        "4 density",
    ]


def test_a_free_cage_may_move_in_time():
    text = WHOLE.replace("bottom = {", 'fixed = "none"\nbottom = {')
    free = parse_case(text + '[solve]\nkind = "dynamic"\nduration = 1\n')
    assert not fyke.build_net(free).fixed.any()
    with pytest.raises(CaseError, match="nothing would hold it"):
        parse_case(text)


def test_check_tells_every_part(tmp_path, capsys):
    file = tmp_path / "cage.toml"
    file.write_text(WHOLE)
    assert check_case(file, json=True) == 0
    told = json.loads(capsys.readouterr().out)
    wall, floor = told["panels"]
    assert (wall["name"], wall["shape"], wall["meshes"], wall["rims"]) == (
        "cage",
        "cylinder",
        [16, 5],
        [0.65, 0.65],
    )
    assert wall["hanging_ratios"] == pytest.approx([np.pi * 0.65 / 3.2, 0.75 / 1.0], rel=1e-12)
    assert (floor["name"], floor["shape"], floor["rims"]) == ("cage bottom", "cone", [0.0, 0.65])
    (rope,) = told["ropes"]
    assert (rope["name"], rope["twine"], rope["along"], rope["bars"]) == (
        "footrope",
        "line",
        "cage.bottom",
        16,
    )
    assert rope["length"] == pytest.approx(16 * 0.65 * np.sin(np.pi / 16), rel=1e-12)
    assert rope["stiffness"] == pytest.approx(14 * 308e6 * 0.008**2, rel=1e-12)
    weights, corks = told["bodies"]
    assert (weights["kind"], weights["count"], corks["kind"], corks["count"]) == ("sinkers", 8, "floats", 2)
    assert weights["weight_in_water"] == pytest.approx(5.15, rel=1e-12)
    assert corks["total_weight"] == pytest.approx(-6.0, rel=1e-12)
    check_case(file, json=False)
    shown = capsys.readouterr().out
    for words in (
        "cylinder cage",
        "cone cage bottom",
        "rope footrope",
        "5.15 N (sinks) each",
        "3 N (floats) each",
    ):
        assert words in shown


def test_the_schema_knows_every_kind():
    tables = json_schema()
    kinds = set(tables["properties"]["gear"]["items"]["discriminator"]["mapping"])
    assert kinds == {
        "panel",
        "trapezoid",
        "triangle",
        "box",
        "seam",
        "cylinder",
        "cone",
        "frustum",
        "rope",
        "line",
        "moorings",
        "ring",
        "collar",
        "sinkers",
        "floats",
    }


VALUES = [
    "-1",
    "0",
    "1e308",
    "1e-308",
    "nan",
    "true",
    '""',
    '"cage.top"',
    '"."',
    "[]",
    "[1, 2]",
    "{}",
    "[{}]",
    '"main"',
]
few = settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@few
@given(st.data())
def test_values_replaced_by_anything(data):
    """A case or problems in four parts, and what loads can be built."""
    lines = WHOLE.splitlines()
    assigned = [i for i, line in enumerate(lines) if " = " in line]
    for i in data.draw(st.lists(st.sampled_from(assigned), min_size=1, max_size=3)):
        lines[i] = lines[i].split(" = ")[0] + " = " + data.draw(st.sampled_from(VALUES))
    try:
        case = parse_case("\n".join(lines))
    except CaseError as error:
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
    else:
        assert np.isfinite(fyke.build_system(fyke.build_net(case), case).weight_in_water)


@few
@given(st.lists(st.sampled_from([line for line in WHOLE.splitlines() if line]), max_size=40))
def test_lines_in_any_order(lines):
    try:
        parse_case("\n".join([HEAD, *lines]))
    except CaseError as error:
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
