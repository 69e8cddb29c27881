"""Case files that are wrong: where, found, allowed and cure of every message."""

import pytest

from fyke.case import CaseError, load_case, parse_case

GOOD = """schema = 1
[current]
velocity = [0.5, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "30 mm"
knot_diameter = "3.5 mm"
[[gear]]
kind = "panel"
netting = "main"
meshes = [8, 8]
size = [0.3055, 0.3055]
fixed = "edges"
[drag]
bars = { law = "constant", normal = 1.2, tangential = 0.1 }
[solve]
kind = "static"
"""
BAR = 'bar_length = "30 mm"'
# Without a centre the middle of a panel lies at the surface.
BELOW = 'fixed = "edges"\ncentre = [0.0, 0.0, -1.0]'


def problems_of(text, where="c.toml"):
    with pytest.raises(CaseError) as caught:
        parse_case(text, where)
    return caught.value.problems


def test_the_case_that_the_others_spoil_is_good():
    assert parse_case(GOOD.replace('fixed = "edges"', BELOW)).warnings == ()


# old text, new text, then a piece of where, found, allowed and cure
SPOILT = {
    "key misspelled": (
        BAR,
        'bar_lenght = "30 mm"',
        ("line 10, [netting.main] bar_lenght", "unknown key", "bar_length", "did you mean 'bar_length'?"),
    ),
    "key longer than the right one": (
        "diameter =",
        "twine_diameter =",
        ("line 6, [twine.main] twine_diameter", "unknown key", "diameter", "did you mean 'diameter'?"),
    ),
    "key of another table": (
        'twine = "main"',
        'twine = "main"\nhanging_ratio = 0.5',
        ("[netting.main] hanging_ratio", "0.5", "bar_length", "belongs in [[gear]]"),
    ),
    "key misspelled inside a line": (
        "normal = 1.2",
        "normel = 1.2",
        ("line 19, [drag] bars.normel", "normel = 1.2", "tangential", "did you mean 'normal'?"),
    ),
    "dynamic key in a static case": (
        'kind = "static"',
        'kind = "static"\nduration = 2.0',
        ("line 22, [solve] duration", "2.0", "tolerance", '[solve] with kind = "dynamic"'),
    ),
    "wrong unit": (
        BAR,
        'bar_length = "30 kg"',
        ("line 10, [netting.main] bar_length", '"30 kg"', "mm, cm", "'kg' is a unit of mass"),
    ),
    "unit of another kind": (
        BAR,
        'bar_length = "30 kPa"',
        ("bar_length", '"30 kPa"', "a length above 0", "'kPa' is a unit of pressure"),
    ),
    "unit in other letters": (
        BAR,
        'bar_length = "30 MM"',
        ("bar_length", '"30 MM"', "mm", 'did you mean "30 mm"?'),
    ),
    "text without unit": (
        BAR,
        'bar_length = "30"',
        ("bar_length", '"30"', "m, mm", "without quotes, 30"),
    ),
    "negative length": (
        BAR,
        "bar_length = -0.03",
        ("line 10, [netting.main] bar_length", "-0.03", "above 0", "leave out the minus sign"),
    ),
    "zero length": (BAR, "bar_length = 0", ("bar_length", "0", "above 0", "a value above 0")),
    "length out of all proportion": (
        BAR,
        "bar_length = 3e7",
        ("bar_length", "30000000.0", "at most 10000 m", "check the unit"),
    ),
    "nan": (BAR, "bar_length = nan", ("bar_length", "nan", "a length above 0", "give a number")),
    "infinity": (BAR, "bar_length = inf", ("bar_length", "inf", "at most", "give a finite number")),
    "number with 400 digits": (
        BAR,
        "bar_length = 1" + 400 * "0",
        ("bar_length", "60 digits", "at most", "finite"),
    ),
    "boolean for a number": (
        BAR,
        "bar_length = true",
        ("bar_length", "true", "a length above 0", "true and false"),
    ),
    "list for a number": (BAR, "bar_length = [0.03]", ("bar_length", "[0.03]", "length", "without brackets")),
    "date for a number": (BAR, "bar_length = 2020-01-01", ("bar_length", "2020-01-01", "length", "30 mm")),
    "text for a plain number": (
        "normal = 1.2",
        'normal = "1.2"',
        ("[drag] bars.normal", '"1.2"', "a number from 0 to 100", "without quotes"),
    ),
    "no mesh": (
        "[8, 8]",
        "[0, 8]",
        ("line 15, [[gear]] 1 meshes, value 1", "0", "1 to 20000", "at least one"),
    ),
    "part of a mesh": ("[8, 8]", "[8, 1.5]", ("meshes, value 2", "1.5", "1 to 20000", "whole number")),
    "whole meshes with a point": ("[8, 8]", "[8, 8.0]", ("meshes, value 2", "8.0", "1 to 20000", "write 8,")),
    "boolean mesh": ("[8, 8]", "[true, 8]", ("meshes, value 1", "true", "1 to 20000", "whole number")),
    "too many meshes": ("[8, 8]", "[8, 20001]", ("meshes, value 2", "20001", "1 to 20000", "several panels")),
    "three sizes": (
        "[0.3055, 0.3055]",
        "[0.3, 0.3, 0.3]",
        ("line 16, [[gear]] 1 size", "[0.3, 0.3, 0.3]", "width and height", "size = [0.3055, 0.3055]"),
    ),
    "one number for a vector": (
        "velocity = [0.5, 0.0, 0.0]",
        "velocity = 0.5",
        ("line 3, [current] velocity", "0.5", "three components", "velocity = [0.5, 0.0, 0.0]"),
    ),
    "two components": (
        "velocity = [0.5, 0.0, 0.0]",
        "velocity = [0.5, 0.0]",
        ("[current] velocity, value 3", "[0.5, 0.0]", "three components", "velocity = [0.5, 0.0, 0.0]"),
    ),
    "no direction": (
        'fixed = "edges"',
        "normal = [0, 0, 0]",
        ("[[gear]] 1 normal", "[0, 0, 0]", "not all zero", "[1.0, 0.0, 0.0]"),
    ),
    "both size and hanging ratio": (
        'fixed = "edges"',
        "hanging_ratio = 0.5",
        ("[[gear]] 1 size", "both size and hanging_ratio", "one of", "leave out one"),
    ),
    "neither size nor hanging ratio": (
        "size = [0.3055, 0.3055]",
        "",
        ("[[gear]] 1 size", "neither", "one of size and hanging_ratio", "hanging_ratio = 0.6"),
    ),
    "hanging ratio of one": (
        "size = [0.3055, 0.3055]",
        "hanging_ratio = 1.0",
        ("line 16, [[gear]] 1 hanging_ratio", "1.0", "below 1", "less than the stretched width"),
    ),
    "hanging ratio of nothing": (
        "size = [0.3055, 0.3055]",
        'hanging_ratio = [0.5, "0 %"]',
        ("hanging_ratio", "0 %", "above 0", "above 0"),
    ),
    "twine that is not there": (
        'twine = "main"',
        'twine = "mian"',
        ("line 8, [netting.main] twine", '"mian"', 'a twine of this file: "main"', 'did you mean "main"?'),
    ),
    "netting that is not there": (
        'netting = "main"',
        'netting = "cod-end"',
        ("line 14, [[gear]] 1 netting", '"cod-end"', 'this file: "main"', "[netting.cod-end]"),
    ),
    "frame beyond the net": (
        "[0.3055, 0.3055]",
        "[0.5, 0.5]",  # hypot(0.5, 0.5) / 0.48 = 1.473
        ("line 16, [[gear]] 1 size", "47.3 %", "at most 20 %", "check the units"),
    ),
    "frame in millimetres": (
        "[0.3055, 0.3055]",
        "[305.5, 305.5]",
        ("[[gear]] 1 size", "305.5 m", "at most 20 %", "check the units of size"),
    ),
    "nothing held": (
        '"edges"',
        '"none"',
        ("line 17, [[gear]] 1 fixed", '"none"', '"edges", "top" or "corners"', "nothing would hold it"),
    ),
    "held somewhere unknown": (
        '"edges"',
        '"edge"',
        ("[[gear]] 1 fixed", '"edge"', '"corners"', 'did you mean "edges"?'),
    ),
    "hexagonal mesh without its long bars": (
        '"diamond"',
        '"hexagonal"',
        ("[netting.main] long_bar", "nothing", "four bars of bar_length", 'add long_bar = "45 mm"'),
    ),
    "long bars of diamonds": (
        '"diamond"',
        '"diamond"\nlong_bar = "45 mm"',
        ("line 10, [netting.main] long_bar", "diamond mesh", "hexagonal", "leave it out"),
    ),
    "mesh unknown": (
        '"diamond"',
        '"hexagon"',
        ("line 9, [netting.main] mesh", '"hexagon"', '"square"', 'did you mean "hexagonal"?'),
    ),
    "material unknown": (
        '"PA"',
        '"nylon"',
        ("line 5, [twine.main] material", '"nylon"', '"PES"', 'choose "PA"'),
    ),
    "material without a modulus": (
        '"PA"',
        '"PP"',
        ("[twine.main] youngs_modulus", "none is known for PP", "Pa", "youngs_modulus ="),
    ),
    "no material, no density": (
        'material = "PA"',
        "youngs_modulus = 1e9",
        ("[twine.main] density", "neither", "kg/m3", "density = 1140.0"),
    ),
    "modulus and law": (
        'material = "PA"',
        'material = "PA"\nyoungs_modulus = 1e9\nlaw = { kind = "power", c1 = 1e8, c2 = 1.0 }',
        ("line 7, [twine.main] law", "both", "one elastic law", "leave out one"),
    ),
    "law of an unknown kind": (
        'material = "PA"',
        'material = "PA"\nlaw = { kind = "linaer", youngs_modulus = 1e9 }',
        ("[twine.main] law.kind", '"linaer"', '"power"', 'did you mean "linear"?'),
    ),
    "law without kind": (
        'material = "PA"',
        'material = "PA"\nlaw = { youngs_modulus = 1e9 }',
        ("[twine.main] law", "youngs_modulus", '"table"', 'kind = "linear"'),
    ),
    "key of a law misspelled": (
        'material = "PA"',
        'material = "PA"\nlaw = { kind = "power", c1 = 1e8, c2 = 1.1, c3 = 1 }',
        ("line 6, [twine.main] law.c3", "c3 = 1", "kind, c1, c2", "leave it out"),
    ),
    "table that falls": (
        'material = "PA"',
        'material = "PA"\nlaw = { kind = "table", strain = [0, 0.1, 0.05], tension = [0, 1, 2] }',
        ("[twine.main] law.strain", "0.05", "rise", "sort"),
    ),
    "table that starts late": (
        'material = "PA"',
        'material = "PA"\nlaw = { kind = "table", strain = [0, 0.1], tension = [1, 2] }',
        ("[twine.main] law.tension", "[1, 2]", "start at 0", "start with 0.0"),
    ),
    "table of unequal columns": (
        'material = "PA"',
        'material = "PA"\nlaw = { kind = "table", strain = [0, 0.1], tension = [0, 1, 2] }',
        ("[twine.main] law", "2 strains and 3 tensions", "as many", "every strain"),
    ),
    "negative damping": (
        'material = "PA"',
        'material = "PA"\ndamping_time = "-1 ms"',
        ("[twine.main] damping_time", '"-1 ms"', "a time from 0", "minus"),
    ),
    "twine thicker than the bar is long": (
        '"1.5 mm"',
        '"3 cm"',
        ("line 10, [netting.main] bar_length", "30 mm thick", "above the diameter", "units"),
    ),
    "knots that overlap": (
        '"3.5 mm"',
        '"35 mm"',
        ("line 11, [netting.main] knot_diameter", "35 mm", "30 mm", "overlap"),
    ),
    "drag law unknown": (
        'law = "constant"',
        'law = "cylinder"',
        ("line 19, [drag] bars.law", '"cylinder"', '"constant"', "choose"),
    ),
    "solver unknown": (
        'kind = "static"',
        'kind = "dynamik"',
        ("line 21, [solve] kind", '"dynamik"', '"static" or "dynamic"', 'did you mean "dynamic"?'),
    ),
    "stepper unknown": (
        'kind = "static"',
        'kind = "dynamic"\nduration = 1\nstepper = "newmarc"',
        (
            "line 23, [solve] stepper",
            '"newmarc"',
            '"implicit" or "newmark" or "verner" or "symplectic"',
            "newmark",
        ),
    ),
    "dynamic without duration": (
        'kind = "static"',
        'kind = "dynamic"',
        ("[solve] duration", "nothing", "s, simulated time", "add duration = 2.0"),
    ),
    "more outputs than fit": (
        'kind = "static"',
        'kind = "dynamic"\nduration = 100\n[output]\nevery = "10 us"',
        ("line 24, [output] every", "1e+07 outputs", "1,000,000", "every = 0.1"),
    ),
    "outputs further apart than the run is long": (
        'kind = "static"',
        'kind = "dynamic"\nduration = 1\n[output]\nevery = "2 min"',
        ("line 24, [output] every", "120 s", "at most the duration of 1 s", "leave every out"),
    ),
    "steps longer than the run": (
        'kind = "static"',
        'kind = "dynamic"\nduration = 1\nmax_step = 10',
        ("line 23, [solve] max_step", "10 s", "at most the duration of 1 s", "leave max_step out"),
    ),
    "error control of a stepper without one": (
        'kind = "static"',
        'kind = "dynamic"\nduration = 1\nstepper = "symplectic"\nrtol = 1e-3',
        ("line 24, [solve] rtol", "no error control", "auto, implicit, newmark and verner", "leave rtol out"),
    ),
    "rest of a static case": (
        'kind = "static"',
        'kind = "static"\nsettle_force = 1e-6',
        ("line 22, [solve] settle_force", "unknown key", "the keys kind", 'with kind = "dynamic"'),
    ),
    "a run of no length": (
        'kind = "static"',
        'kind = "dynamic"\nduration = "0 s"',
        ("line 22, [solve] duration", "0 s", "above 0", "a value above 0"),
    ),
    "measurements that are not there": (
        'kind = "static"',
        'kind = "static"\n[compare]\npositions = "no.csv"',
        ("line 23, [compare] positions", "no.csv", "a CSV file", "folder of the case file"),
    ),
    "other schema": ("schema = 1", "schema = 2", ("line 1, schema", "2", '"1"', "choose")),
    "no schema": ("schema = 1", "", ("c.toml, schema", "nothing", "version", "add schema = 1")),
    "no current": (
        "[current]\nvelocity = [0.5, 0.0, 0.0]\n",
        "",
        ("c.toml, current", "nothing", "current", "[current] with velocity = [0.5, 0.0, 0.0]"),
    ),
    "twine without a name": (
        "[twine.main]",
        "[twine]",
        ("line 4, twine", "diameter", "[twine.NAME]", "[twine.main]"),
    ),
    "gear in single brackets": (
        "[[gear]]",
        "[gear]",
        ("line 12, gear", "panel", "[[gear]]", "double brackets"),
    ),
    "no gear": (
        GOOD[GOOD.index("[[gear]]") : GOOD.index("[drag]")],
        "",
        ("gear", "nothing", "panels", "[[gear]]"),
    ),
    "gear of an unknown kind": (
        '"panel"',
        '"trawl"',
        ("line 13, [[gear]] 1 kind", '"trawl"', '"panel"', "did you mean"),
    ),
    "number for a table": (
        "[current]\nvelocity = [0.5, 0.0, 0.0]\n",
        "current = 0.5\n",
        ("line 2, current", "0.5", "a table", "[current]"),
    ),
    "title of two lines": (
        "schema = 1",
        'schema = 1\ntitle = "a\\nb"',
        ("line 2, title", "a\\nb", "one line", "line breaks"),
    ),
    "title that is no text": ("schema = 1", "schema = 1\ntitle = 3", ("line 2, title", "3", "a text", '"3"')),
    "name that breaks labels": (
        "[twine.main]",
        '[twine."a:b"]',
        ("[twine.a:b]", '"a:b"', "letters, digits", "plainer"),
    ),
}


@pytest.mark.parametrize("name", SPOILT)
def test_message_in_four_parts(name):
    old, new, pieces = SPOILT[name]
    assert old in GOOD
    problems = problems_of(GOOD.replace(old, new, 1))
    told = [(p.where, p.found, p.allowed, p.cure) for p in problems]
    assert any(all(piece in part for piece, part in zip(pieces, parts, strict=True)) for parts in told), told


SQUARE = GOOD.replace('"diamond"', '"square"')


def test_square_mesh_needs_both_hanging_ratios():
    (problem,) = problems_of(SQUARE.replace("size = [0.3055, 0.3055]", "hanging_ratio = 0.5"))
    assert problem.cure == "write hanging_ratio = [0.5, 0.5]"


def test_square_mesh_is_judged_along_its_bars():
    # 8 bars of 30 mm are 240 mm; 0.3 m would strain the width by 25 %, the diagonal plays no part.
    hung = SQUARE.replace("[0.3055, 0.3055]", "[0.24, 0.24]").replace('fixed = "edges"', BELOW)
    assert parse_case(hung).warnings == ()
    (problem,) = problems_of(SQUARE.replace("[0.3055, 0.3055]", "[0.3, 0.1]"))
    assert "25 %" in problem.found


def test_a_free_panel_may_move():
    free = GOOD.replace('"edges"', '"none"').replace('kind = "static"', 'kind = "dynamic"\nduration = 1')
    assert parse_case(free).gear[0].fixed == "none"


def test_gears_share_no_name():
    panel = GOOD[GOOD.index("[[gear]]") : GOOD.index("[drag]")]
    named = panel.replace("kind", 'name = "lee"\nkind', 1)
    (problem,) = problems_of(GOOD.replace(panel, named + named))
    assert "[[gear]] 2 name" in problem.where and "[[gear]] 1" in problem.found
    # A default name counts as well: the second panel is "2" unless it says otherwise.
    (problem,) = problems_of(GOOD.replace(panel, panel.replace("kind", 'name = "2"\nkind', 1) + panel))
    assert "[[gear]] 2 name" in problem.where


def test_all_that_is_wrong_is_told_at_once_in_the_order_of_the_file():
    text = GOOD
    for old, new in (
        ("velocity", "velosity"),
        ('"PA"', '"PP"'),
        ('"1.5 mm"', '"1.5 kg"'),
        ('twine = "main"', 'twine = "other"'),
        (BAR, "bar_length = -1"),
        ("[8, 8]", "[0, 1.5]"),
        ('"edges"', '"none"'),
        ('kind = "static"', 'kind = "static"\nrtol = 1'),
    ):
        text = text.replace(old, new, 1)
    where = [p.where.split(", ", 2)[-1] for p in problems_of(text)]
    assert where == [
        "[current] velosity",
        "[twine.main] youngs_modulus",
        "[twine.main] diameter",
        "[netting.main] twine",
        "[netting.main] bar_length",
        "[[gear]] 1 meshes, value 1",
        "[[gear]] 1 meshes, value 2",
        "[[gear]] 1 fixed",
        "[solve] rtol",
    ]


def test_lines_are_counted_past_lists_texts_and_comments():
    text = GOOD.replace(
        "schema = 1", 'schema = 1 # [twine.main]\ntitle = """\nfirst"""\n[water]\ndensity = 1000'
    ).replace("velocity = [0.5, 0.0, 0.0]", "velocity = [  # a comment ]\n 0.5,\n 0.0,\n 0.0,\n]")
    (problem,) = problems_of(text.replace('"1.5 mm"', "0"))
    line = text.replace('"1.5 mm"', "0").split("\n").index("diameter = 0") + 1
    assert f"line {line}," in problem.where


@pytest.mark.parametrize(
    ("line", "where", "cure"),
    [
        ("diameter = 30 mm", "line 2, column 15", "in quotes"),
        ("diameter = ", "line 2, column 12", "in quotes"),
        ("diameter 3", "line 2, column 10", "key = value"),
        ("[twine.main", "line 2, column 12", "]"),
        ('title = "a', "line 2", "quote"),
        ("meshes = [1, 2", "line 2", "]"),
        ("schema = 1", "line 2", "leave out one"),
    ],
)
def test_broken_toml_is_told_by_line_and_column(line, where, cure):
    (problem,) = problems_of(f"schema = 1\n{line}")
    assert problem.where.startswith("c.toml, ") and where in problem.where
    assert line.strip().replace('"', "") in problem.found.replace('\\"', "").replace('"', "")
    assert "TOML" in problem.allowed and cure in problem.cure


@pytest.mark.parametrize("text", ["a = " + "[" * 20000, "a = " + "{b=" * 20000, "a = " + "9" * 10000])
def test_monstrous_values_are_problems_too(text):
    assert len(problems_of(text)) >= 1


def test_file_that_is_not_there_names_those_that_are(tmp_path):
    (tmp_path / "panel.toml").write_text(GOOD)
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path / "pannel.toml")
    (problem,) = caught.value.problems
    assert "pannel.toml" in problem.where and "No such file" in problem.found and "panel.toml" in problem.cure


def test_folder_is_no_case(tmp_path):
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path)
    assert caught.value.problems[0].found == "a folder"


def test_file_in_another_encoding(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b'title = "M\xf6we"')
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert caught.value.problems[0].found == "byte 0xf6 at position 10"
    assert "UTF-8" in caught.value.problems[0].cure


def test_name_that_no_file_can_have():
    with pytest.raises(CaseError):
        load_case("a\0b.toml")


def test_message_fits_a_terminal():
    with pytest.raises(CaseError) as caught:
        parse_case(GOOD.replace(BAR, 'bar_lenght = "30 kg"').replace("[8, 8]", "[0, 8]"), "a/b/c.toml")
    lines = str(caught.value).splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[0] == "a/b/c.toml, line 10, [netting.main] bar_lenght"
    labelled = [line.split()[0] for line in lines[1 : lines.index("")] if line[2] != " "]
    assert labelled == ["found", "allowed", "cure"]
