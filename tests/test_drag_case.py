"""Laws of drag and added mass in case files: every law by its word, every wrong input told at its place."""

from __future__ import annotations

import json
import tomllib
from dataclasses import MISSING, fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fyke.case import Case, CaseError, json_schema, load_case, parse_case, recorded_case, template
from fyke.water.inertia import (
    ADDED_MASS_LAWS,
    AddedMassTable,
    ConstantAddedMass,
    LeeAddedMass,
    PotentialFlow,
)
from fyke.water.laws import LAWS, AngleTable, BarTable
from fyke.water.laws.bars import CifuentesKim, ConstantBar, Takagi
from fyke.water.laws.knots import ConstantKnot
from fyke.water.laws.panels import KristiansenFaltinsen

EXAMPLES = Path(__file__).parents[1] / "examples"
CASE = """schema = 1
[current]
velocity = [0.5, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2.8 mm"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "29 mm"
[[gear]]
kind = "panel"
netting = "main"
meshes = [8, 8]
size = [0.232, 0.232]
"""
SECOND = """[netting.wide]
twine = "main"
mesh = "square"
bar_length = "58 mm"
[[gear]]
kind = "panel"
netting = "wide"
meshes = [8, 8]
size = [0.464, 0.464]
"""
BY_SPEED = "reynolds,normal,tangential\n10,2.0,0.3\n100,1.5,0.1\n"
BY_ANGLE = "reynolds,angle,drag,lift\n10,0,0.1,0\n10,90,2,0\n100,0,0.1,0\n100,90,1.5,0\n"
FILES = {"drag.csv": BY_SPEED, "angles.csv": BY_ANGLE, "mass.csv": "angle,inertia\n0,1\n90,2.5\n"}


def drag(lines: str, **files: str) -> str:
    return f"{CASE}[drag]\n{lines}\n"


def mass(lines: str) -> str:
    return f"{CASE}[added_mass]\n{lines}\n"


def bar_law(case: Case):
    return case.drag.bar_law(solidity=case.solidity, folder=case.folder)


def loaded(text: str, folder: Path) -> Case:
    for name, content in FILES.items():
        (folder / name).write_text(content)
    file = folder / "case.toml"
    file.write_text(text)
    return load_case(file)


def law_of(case: Case, kind: str):
    return {"bars": bar_law, "knots": lambda c: c.drag.knot_law(), "panels": lambda c: c.drag.panel_law()}[
        kind
    ](case)


# Every law by its word

KEYS = {"bars": "bars = {}", "knots": "knots = {}", "panels": 'kind = "screens"\nscreens = {}'}
EVERY = [(kind, name) for kind, laws in LAWS.items() for name in laws]
OWN = {"table": "drag.csv", "angle-table": "angles.csv"}


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_every_law_can_be_written_and_is_that_law(kind, name, tmp_path):
    law = LAWS[kind][name]
    further = f', file = "{OWN[name]}"' if name in OWN else ""
    if name == "constant":
        further = ", normal = 1.2, tangential = 0.1" if kind == "bars" else ", drag = 1.0"
    text = drag(KEYS[kind].format(f'{{ law = "{name}"{further} }}'))
    made = law_of(loaded(text, tmp_path), kind)
    assert type(made) is law
    if name not in {*OWN, "cifuentes-kim"}:
        assert made == law()


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_every_parameter_of_a_law_is_a_key(kind, name, tmp_path):
    if name in OWN:
        return
    law = LAWS[kind][name]
    asked = {one.name: "sheet" if isinstance(one.default, str) else 0.37 for one in fields(law)}
    assert all(one.default is not MISSING for one in fields(law))
    keys = "".join(f", {key} = {json.dumps(value)}" for key, value in asked.items())
    text = drag(KEYS[kind].format(f'{{ law = "{name}"{keys} }}'))
    assert law_of(loaded(text, tmp_path), kind) == law(**asked)


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_the_word_alone_stands_for_a_law_that_needs_no_more(kind, name, tmp_path):
    text = drag(KEYS[kind].format(f'"{name}"'))
    if name in OWN or name == "constant":
        with pytest.raises(CaseError, match="nothing"):
            loaded(text, tmp_path)
    else:
        assert type(law_of(loaded(text, tmp_path), kind)) is LAWS[kind][name]


def test_defaults_and_the_constants_of_old_files_hold():
    plain = parse_case(CASE)
    assert (bar_law(plain), plain.drag.knot_law(), plain.drag.panel_law()) == (
        ConstantBar(1.2, 0.1),
        ConstantKnot(1.0),
        None,
    )
    given = parse_case(
        drag(
            'bars = { law = "constant", normal = 1.5, tangential = 0.2 }\nknots = { law = "constant", drag = 0.9 }'
        )
    )
    assert (bar_law(given), given.drag.knot_law()) == (ConstantBar(1.5, 0.2), ConstantKnot(0.9))
    assert parse_case(drag('kind = "screens"')).drag.panel_law() == KristiansenFaltinsen()
    header = parse_case(CASE + '[drag.bars]\nlaw = "takagi"\ntangential = 0.05\n')
    assert bar_law(header) == Takagi(tangential=0.05)


def test_solidity_is_that_of_the_netting_as_hung_unless_given():
    # Square netting of bars 29 mm long and 2.8 mm thick, taut: 2 d/a - (d/a)^2.
    x = 2.8 / 29.0
    case = parse_case(drag('bars = "cifuentes-kim"'))
    assert bar_law(case) == CifuentesKim(solidity=pytest.approx(2.0 * x - x**2, rel=1e-12))
    given = parse_case(drag('bars = { law = "cifuentes-kim", solidity = 0.3 }'))
    assert bar_law(given) == CifuentesKim(solidity=0.3)


def test_nettings_of_two_solidities_need_one_to_be_named():
    text = drag('bars = "cifuentes-kim"').replace("[[gear]]", SECOND + "[[gear]]")
    (problem,) = problems_of(text)
    # 2 x - x^2 with x = 2.8 / 29 and 2.8 / 58.
    assert "[drag] bars" in problem.where and "0.0942 and 0.184" in problem.found
    assert "solidity = 0.0942" in problem.cure
    parse_case(text.replace('"cifuentes-kim"', '{ law = "cifuentes-kim", solidity = 0.1 }'))
    parse_case(text.replace('"cifuentes-kim"', '"takagi"'))


def test_tables_count_from_the_folder_of_the_case(tmp_path, monkeypatch):
    (tmp_path / "a").mkdir()
    case = loaded(drag('bars = { law = "table", file = "drag.csv" }'), tmp_path / "a")
    monkeypatch.chdir(tmp_path)
    assert bar_law(case) == BarTable((10.0, 100.0), (2.0, 1.5), (0.3, 0.1))
    by_angle = loaded(drag('bars = { law = "angle-table", file = "angles.csv" }'), tmp_path / "a")
    assert bar_law(by_angle) == AngleTable(
        (10.0, 100.0), (0.0, np.pi / 2.0), ((0.1, 2.0), (0.1, 1.5)), ((0.0, 0.0), (0.0, 0.0))
    )


def test_a_result_opens_without_the_table_of_its_case():
    text = drag('bars = { law = "table", file = "gone.csv" }')
    assert recorded_case(text).drag.bars.law == "table"
    with pytest.raises(CaseError, match=r"gone\.csv"):
        parse_case(text)


@pytest.mark.parametrize(
    ("lines", "bars", "knots"),
    [
        ("", ConstantAddedMass(1.0), 0.5),
        ("bars = 1.2\nknots = 0.7", ConstantAddedMass(1.2), 0.7),
        ('bars = { law = "constant", inertia = 2.2 }', ConstantAddedMass(2.2 - 1.0), 0.5),
        ('bars = { law = "constant", coefficient = 0.9 }', ConstantAddedMass(0.9), 0.5),
        ('bars = "potential-flow"\nknots = "potential-flow"', PotentialFlow(), 0.5),
        ('bars = "lee"\nknots = { law = "constant", inertia = 1.5 }', LeeAddedMass(), 0.5),
        ('bars = { law = "lee" }', LeeAddedMass(), 0.5),
        ('bars = { law = "table", file = "mass.csv" }', AddedMassTable((0.0, np.pi / 2), (0.0, 1.5)), 0.5),
        (
            'bars = { law = "table", angle = ["0 deg", "45 deg", "90 deg"], coefficient = [0.1, 0.6, 1] }',
            AddedMassTable((0.0, np.pi / 4, np.pi / 2), (0.1, 0.6, 1.0)),
            0.5,
        ),
        (
            'bars = { law = "table", angle = ["0 rad", "1.5 rad"], inertia = [1.25, 2] }',
            AddedMassTable((0.0, 1.5), (0.25, 1.0)),
            0.5,
        ),
    ],
)
def test_added_mass(lines, bars, knots, tmp_path):
    case = loaded(mass(lines), tmp_path)
    assert case.added_mass.bar_law(folder=case.folder) == bars
    assert case.added_mass.knot_coefficient() == knots


def test_every_law_of_added_mass_can_be_written(tmp_path):
    further = {"constant": ", inertia = 2.0", "table": ', file = "mass.csv"'}
    for name, law in ADDED_MASS_LAWS.items():
        case = loaded(mass(f'bars = {{ law = "{name}"{further.get(name, "")} }}'), tmp_path)
        assert type(case.added_mass.bar_law(folder=case.folder)) is law


# Wrong inputs


def problems_of(text: str):
    with pytest.raises(CaseError) as caught:
        parse_case(text, "c.toml")
    return caught.value.problems


# lines of [drag], then a piece of where, found, allowed and cure
WRONG = {
    "word misspelled": ('bars = "takagy"', ("line 17, [drag] bars", '"takagy"', '"ns-cheng"', '"takagi"?')),
    "law misspelled": (
        'bars = { law = "wite" }',
        ("[drag] bars.law", '"wite"', '"constant" or "choo-casarella" or "takagi"', '"white"?'),
    ),
    "law unlike any": ('knots = "x"', ("[drag] knots", '"x"', '"clift-grace-weber"', "choose")),
    "law of a bar for knots": (
        'knots = "takagi"',
        ("[drag] knots", '"takagi"', '"schiller-naumann"', "choose"),
    ),
    "law of screens for bars": ('bars = "loland"', ("[drag] bars", '"loland"', '"wan"', "choose")),
    "number for a law": ("bars = 1.2", ("[drag] bars", "1.2", "word of a law", 'law = "choo-casarella"')),
    "list for a law": ('bars = ["wan"]', ("[drag] bars", '["wan"]', "word of a law", "fyke laws")),
    "no law": ("bars = { normal = 1.2 }", ("[drag] bars", "normal = 1.2", '"takagi"', "say which law")),
    "law that is no text": ("bars = { law = 3 }", ("[drag] bars.law", "3", '"takagi"', "choose")),
    "constant without numbers": (
        'bars = "constant"',
        ("[drag] bars.normal", "nothing", "across the bar", "add normal = 1.2"),
    ),
    "parameter of another law": (
        'bars = { law = "takagi", normal = 1.0 }',
        ("[drag] bars.normal", "unknown key", "the keys law, tangential", "choose one of these keys"),
    ),
    "parameter misspelled": (
        'knots = { law = "schiller-naumann", shap = 1.0 }',
        ("[drag] knots.shap", "unknown key", "the keys law, shape", "'shape'"),
    ),
    "negative coefficient": (
        'bars = { law = "white", tangential = -0.1 }',
        ("[drag] bars.tangential", "-0.1", "from 0 to 100", "minus"),
    ),
    "coefficient that is no number": (
        'bars = { law = "white", tangential = nan }',
        ("[drag] bars.tangential", "nan", "from 0 to 100", "not a number"),
    ),
    "nothing across": ('bars = { law = "hoerner", across = 0 }', ("bars.across", "0", "above 0", "above 0")),
    "shape of nothing": (
        'knots = { law = "clift-gauvin", shape = 0 }',
        ("knots.shape", "0", "above 0", "above 0"),
    ),
    "solidity in percent": (
        'bars = { law = "cifuentes-kim", solidity = 20 }',
        ("bars.solidity", "20", "at most 1", "check the number"),
    ),
    "series unknown": (
        'kind = "screens"\nscreens = { law = "kristiansen-faltinsen", series = "shet" }',
        ("line 18, [drag] screens.series", '"shet"', '"quasi-static"', '"sheet"?'),
    ),
    "kind unknown": ('kind = "screen"', ("[drag] kind", '"screen"', '"bars" or "screens"', '"screens"?')),
    "key unknown": ('panels = "loland"', ("[drag] panels", "unknown key", "screens", "keys")),
    "table without a file": (
        'bars = "table"',
        ("[drag] bars.file", "nothing", "reynolds,normal", "drag.csv"),
    ),
    "file that is no text": (
        'bars = { law = "table", file = 3 }',
        ("[drag] bars.file", "3", "columns reynolds,normal,tangential", "quotes"),
    ),
    "table that is not there": (
        'bars = { law = "table", file = "no.csv" }',
        ("no.csv", "No such file", "CSV", "check the name"),
    ),
    "name that cannot be": (
        'bars = { law = "table", file = "a\\u0000b" }',
        ("b", "cannot be read", "CSV", "check the name"),
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_drag_is_told_in_four_parts(name):
    lines, pieces = WRONG[name]
    told = [(p.where, p.found, p.allowed, p.cure) for p in problems_of(drag(lines))]
    assert any(all(piece in part for piece, part in zip(pieces, parts, strict=True)) for parts in told), told


WRONG_MASS = {
    "law misspelled": ('bars = "lea"', ("line 17, [added_mass] bars", '"lea"', '"potential-flow"', '"lee"?')),
    "law of bars for knots": ('knots = "lee"', ("[added_mass] knots", '"lee"', '"constant"', "choose")),
    "number in quotes": ('bars = "1.0"', ("[added_mass] bars", '"1.0"', "from 0 to 100, or a law", "quotes")),
    "switch": ("knots = true", ("[added_mass] knots", "true", "or a law: potential-flow", "switches")),
    "negative": ("bars = -1", ("[added_mass] bars", "-1", "from 0 to 100", "minus")),
    "list": ("bars = [1, 2]", ("[added_mass] bars", "[1, 2]", "or a law", "brackets")),
    "inertia below one": (
        'bars = { law = "constant", inertia = 0.5 }',
        ("bars.inertia", "0.5", "from 1 to 100", "check"),
    ),
    "both": (
        'knots = { law = "constant", inertia = 2, coefficient = 1 }',
        ("[added_mass] knots", "both", "one of coefficient", "leave out one"),
    ),
    "neither": ('bars = "constant"', ("[added_mass] bars", "neither", "C_m = 1 + C_a", "add coefficient")),
    "table of nothing": (
        'bars = "table"',
        ("[added_mass] bars", "neither", "C_m = 1 + C_a", "add coefficient"),
    ),
    "bare angles": (
        'bars = { law = "table", angle = [0, 90], coefficient = [0, 1] }',
        ("bars.angle, value 2", "90", "text with one of deg, rad", '"90 deg"'),
    ),
    "angles beyond across": (
        'bars = { law = "table", angle = ["0 deg", "100 deg"], coefficient = [0, 1] }',
        ("bars.angle, value 2", '"100 deg"', "from 0 to 1.5708 rad", "check the unit"),
    ),
    "falling angles": (
        'bars = { law = "table", angle = ["50 deg", "10 deg"], coefficient = [0, 1] }',
        ("bars.angle", '"50 deg"', "rise", "sort"),
    ),
    "one angle": (
        'bars = { law = "table", angle = ["50 deg"], coefficient = [1] }',
        ("bars.angle", '"50 deg"', "a list", '"90 deg"'),
    ),
    "fewer values": (
        'bars = { law = "table", angle = ["0 deg", "50 deg", "90 deg"], inertia = [1, 2] }',
        ("[added_mass] bars", "3 angles and 2 values", "as many", "every angle"),
    ),
    "file and numbers": (
        'bars = { law = "table", file = "mass.csv", angle = ["0 deg", "50 deg"] }',
        ("[added_mass] bars", "both file and angle", "a file, or", "leave out one"),
    ),
    "file that is not there": (
        'bars = { law = "table", file = "none.csv" }',
        ("none.csv", "No such file", "CSV", "check the name"),
    ),
}


@pytest.mark.parametrize("name", WRONG_MASS)
def test_wrong_added_mass_is_told_in_four_parts(name):
    lines, pieces = WRONG_MASS[name]
    told = [(p.where, p.found, p.allowed, p.cure) for p in problems_of(mass(lines))]
    assert any(all(piece in part for piece, part in zip(pieces, parts, strict=True)) for parts in told), told


def test_faults_of_files_are_told_with_those_of_the_case_in_the_order_of_the_file(tmp_path):
    (tmp_path / "drag.csv").write_text("reynolds,normal,tangential\n10,x,0.1\n5,1,0.1\n20,1,-1\n30,1,0\n")
    (tmp_path / "mass.csv").write_text("angle,coefficient\n0,1\n")
    lines = 'bars = { law = "table", file = "drag.csv" }\nknots = "sphere"\n[added_mass]\nknots = -1\n'
    text = drag(lines + 'bars = { law = "table", file = "mass.csv" }').replace("velocity", "velosity")
    (tmp_path / "case.toml").write_text(text)
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path / "case.toml")
    where = [one.where.removeprefix(f"{tmp_path}/") for one in caught.value.problems]
    assert where == [
        "case.toml, line 3, [current] velosity",
        "drag.csv, row 2, column normal",
        "drag.csv, row 4, column tangential",
        "case.toml, line 18, [drag] knots.law",
        "case.toml, line 20, [added_mass] knots",
        "mass.csv",
    ]


def test_the_columns_must_be_those_of_the_law(tmp_path):
    for word, name, other in (("table", "angles.csv", "angle-table"), ("angle-table", "drag.csv", "table")):
        with pytest.raises(CaseError) as caught:
            loaded(drag(f'bars = {{ law = "{word}", file = "{name}" }}'), tmp_path)
        (problem,) = caught.value.problems
        assert name in problem.where and f'law = "{word}"' in problem.allowed
        assert f'write law = "{other}"' in problem.cure


def test_screens_that_play_no_part_are_warned_of():
    assert any("plays no part" in words for words in parse_case(drag('screens = "loland"')).warnings)
    screens = parse_case(drag('kind = "screens"\nscreens = "loland"'))
    assert not any("plays no part" in words for words in screens.warnings)


# The schema for editors


def test_schema_takes_what_the_reader_takes_and_no_more():
    jsonschema = pytest.importorskip("jsonschema")
    validator = jsonschema.Draft202012Validator(json_schema())
    validator.check_schema(json_schema())
    for text in (template(), *(file.read_text() for file in sorted(EXAMPLES.glob("*.toml")))):
        validator.validate(tomllib.loads(text))
    good = [
        'bars = "takagi"',
        'bars = { law = "hoerner", across = 1.0 }',
        'kind = "screens"\nscreens = "lee"',
    ]
    good += ['bars = { law = "table", file = "x.csv" }', 'knots = { law = "constant", drag = 1 }']
    for lines in good:
        validator.validate(tomllib.loads(drag(lines)))
    for lines in (
        'bars = "lee"\nknots = 0.5',
        'bars = { law = "table", angle = ["0 deg"], inertia = [1, 2] }',
    ):
        text = mass(lines)
        valid = validator.is_valid(tomllib.loads(text))
        assert valid == ("table" not in lines)
    file = {
        "table without a file",
        "table that is not there",
        "name that cannot be",
        "coefficient that is no number",
    }
    for name, (lines, _) in WRONG.items():
        assert not validator.is_valid(tomllib.loads(drag(lines))) or name in file, name


# No text makes the reader fail with anything else

few = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
WORDS = [name for laws in LAWS.values() for name in laws] + ["lee", "potential-flow", "x", ""]
PIECES = st.sampled_from(
    [
        "1",
        "-1",
        "nan",
        "true",
        "[]",
        "[1, 2]",
        '["0 deg", "90 deg"]',
        '"1.2"',
        '"no.csv"',
        '"."',
        "{}",
        '"\\u0000"',
    ]
    + [f'"{word}"' for word in WORDS]
)
PARAMETERS = [
    "law",
    "normal",
    "tangential",
    "solidity",
    "series",
    "shape",
    "file",
    "angle",
    "coefficient",
    "inertia",
]


@few
@given(
    st.sampled_from(["drag", "added_mass"]),
    st.dictionaries(
        st.sampled_from(["bars", "knots", "screens", "kind", "x"]),
        PIECES
        | st.dictionaries(st.sampled_from(PARAMETERS), PIECES, max_size=4).map(
            lambda keys: "{ " + ", ".join(f"{key} = {value}" for key, value in keys.items()) + " }"
        ),
        max_size=3,
    ),
)
def test_any_laws(table, keys):
    text = CASE + f"[{table}]\n" + "\n".join(f"{key} = {value}" for key, value in keys.items())
    try:
        case = parse_case(text)
    except CaseError as error:
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
    else:
        assert float(case.added_mass.bar_law(folder=case.folder).coefficient(0.3)) >= 0.0
        assert float(bar_law(case).force(100.0, 1.0)[0]) >= 0.0
        assert float(case.drag.knot_law().coefficients(100.0)) >= 0.0


@few
@given(st.text(alphabet="0123456789.,-e\n#xnaif reynoldsagltimk", max_size=80))
def test_any_table(tmp_path_factory, rows):
    folder = tmp_path_factory.getbasetemp()
    for layout, keys in ((BY_SPEED, 'law = "table"'), (BY_ANGLE, 'law = "angle-table"')):
        (folder / "any.csv").write_text(layout + rows)
        (folder / "any.toml").write_text(drag(f'bars = {{ {keys}, file = "any.csv" }}'))
        try:
            law = bar_law(load_case(folder / "any.toml"))
        except CaseError as error:
            assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
        else:
            assert np.all(np.isfinite(law.force([1.0, 1e3], 0.7)))
