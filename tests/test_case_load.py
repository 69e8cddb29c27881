"""Case files that are right: what is read, filled in and warned of."""

import hashlib
import math
import re
from pathlib import Path

import pytest

import fyke
from fyke.case import json_schema, load_case, parse_case, template
from fyke.netting.elastic import LinearLaw, PowerLaw, TableLaw

PANEL = Path(__file__).parents[1] / "examples" / "panel.toml"
SMALL = """
schema = 1
[current]
velocity = ["1 kn", 0.0, 0.0]
[twine.a]
material = "PE"
diameter = "2 mm"
[netting.n]
twine = "a"
mesh = "diamond"
bar_length = "30 mm"
[[gear]]
kind = "panel"
netting = "n"
meshes = [3, 4]
hanging_ratio = "60 %"
"""


def test_example_is_read_in_si():
    case = load_case(PANEL)
    panel, netting, twine = case.gear[0], case.netting["main"], case.twines["main"]
    assert (case.current.velocity, panel.meshes, panel.size) == ((0.5, 0.0, 0.0), (8, 8), (0.3055, 0.3055))
    assert (netting.bar_length, netting.knot_diameter, twine.diameter) == (0.03, 0.0035, 0.0015)
    assert (twine.density, twine.law) == (1140.0, LinearLaw(1e9))
    assert (panel.name, panel.fixed, panel.centre) == ("", "edges", (0.0, 0.0, -0.5))
    assert case.solve.kind == "static" and case.warnings == ()


def test_text_path_and_checksum_are_those_of_the_file():
    case = load_case(PANEL)
    assert case.sha256 == hashlib.sha256(PANEL.read_bytes()).hexdigest()
    assert case.text == PANEL.read_text() and case.path == PANEL


def test_what_is_left_out_has_the_documented_defaults():
    case = parse_case(SMALL)
    assert (case.water.density, case.water.kinematic_viscosity, case.water.gravity) == (1000.0, 1e-6, 9.81)
    assert (case.drag.bars.normal, case.drag.bars.tangential, case.drag.knots.drag) == (1.2, 0.1, 1.0)
    assert (case.added_mass.bars, case.added_mass.knots) == (1.0, 0.5)
    assert (case.solve.kind, case.solve.tolerance) == ("static", 1e-8)
    assert (
        case.twines["a"].damping_time == case.twines["a"].loss_factor == 0.0
        and case.netting["n"].knot_diameter is None
    )
    # Wilson's T = d^2 C1 strain with C1 = 345.37 MPa is E pi d^2 / 4 strain with E = 439.74 MPa.
    assert case.twines["a"].density == 950.0
    assert case.twines["a"].law.youngs_modulus == pytest.approx(439.74e6, rel=1e-4)


def test_hanging_ratio_gives_the_size():
    # 3 x 4 diamonds of 30 mm bars are 180 mm x 240 mm stretched; E1 = 0.6 goes with E2 = 0.8.
    assert parse_case(SMALL).gear[0].size == pytest.approx((0.108, 0.192))
    pair = SMALL.replace('"60 %"', "[0.5, 0.25]")
    assert parse_case(pair).gear[0].size == pytest.approx((0.09, 0.06))
    square = pair.replace("diamond", "square")
    assert parse_case(square).gear[0].size == pytest.approx((0.045, 0.03))


@pytest.mark.parametrize(
    ("law", "read"),
    [
        ('{ kind = "linear", youngs_modulus = "2 GPa" }', LinearLaw(2e9)),
        ('{ kind = "power", c1 = "345.37 MPa", c2 = 1.0121 }', PowerLaw(345.37e6, 1.0121)),
        (
            '{ kind = "table", strain = [0, "5 %", 0.1], tension = [0.0, 20, "0.06 kN"] }',
            TableLaw((0.0, 0.05, 0.1), (0.0, 20.0, 60.0)),
        ),
    ],
)
def test_elastic_laws(law, read):
    case = parse_case(SMALL.replace('diameter = "2 mm"', f'diameter = "2 mm"\nlaw = {law}'))
    assert case.twines["a"].law == read


def test_several_gears_are_numbered_unless_named():
    panel = SMALL[SMALL.index("[[gear]]") :]
    case = parse_case(SMALL + panel + panel.replace("kind", 'name = "lee"\nkind', 1))
    assert [one.name for one in case.gear] == ["1", "2", "lee"]


def test_dynamic_case():
    case = parse_case(
        SMALL.replace("velocity", "velocity", 1)
        + '[solve]\nkind = "dynamic"\nduration = "0.5 min"\nstepper = "symplectic"\nsettle_energy = "2 uJ"\n'
        + '[output]\nevery = "50 ms"\n'
    )
    assert case.solve.kind == "dynamic"
    assert (case.solve.duration, case.solve.stepper, case.solve.settle_energy) == (30.0, "symplectic", 2e-6)
    assert (case.solve.rtol, case.solve.atol, case.solve.max_step) == (None, None, None)
    assert case.output.every == 0.05


def test_measured_positions_count_from_the_case_file(tmp_path):
    (tmp_path / "measured.csv").write_text("knot,x,y,z\n")
    file = tmp_path / "case.toml"
    file.write_text(SMALL + '[compare]\npositions = "measured.csv"\n')
    assert load_case(file).positions_file == tmp_path / "measured.csv"


def test_byte_order_mark_and_windows_line_ends_are_fine(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + SMALL.replace("\n", "\r\n").encode())
    case = load_case(file)
    assert case.current.velocity[0] == pytest.approx(1852 / 3600)
    assert case.sha256 == hashlib.sha256(file.read_bytes()).hexdigest()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('bar_length = "30 mm"', 'bar_length = "30 mm"\nknot_diameter = "1 mm"', ["1 mm", "2 mm", "thinner"]),
        ('"PE"', '"PE"\ndensity = 800', ["800 kg/m3", "1000 kg/m3", "floats"]),
        ('"60 %"', "[0.8, 0.8]", ["13 %", "20 %", "stretched"]),  # sqrt(1.28) = 1.131
        ('"60 %"', "[0.8, 0.01]", ["height", "1 %", "5 %"]),
        ("[netting.n]", "[twine.spare]\nmaterial='PA'\ndiameter=0.001\n[netting.n]", ["'spare'", "not used"]),
    ],
)
def test_odd_but_allowed_is_warned_of_with_number_and_limit(old, new, words):
    warnings = parse_case(SMALL.replace(old, new)).warnings
    assert any(all(word in warning for word in words) for warning in warnings), warnings


def test_tolerance_of_a_dynamic_case_is_warned_of():
    dynamic = SMALL + '[solve]\nkind = "dynamic"\nduration = 1\n'
    assert not any("tolerance" in warning for warning in parse_case(dynamic).warnings)
    assert any("settle_force" in warning for warning in parse_case(dynamic + "tolerance = 1e-6\n").warnings)


def test_sinking_well_hung_net_has_no_warning():
    assert parse_case(SMALL.replace('"PE"', '"PES"') + "centre = [0.0, 0.0, -1.0]\n").warnings == ()


def test_case_does_not_change():
    case = parse_case(SMALL)
    with pytest.raises(ValueError, match="frozen"):
        case.title = "other"
    with pytest.raises(ValueError, match="frozen"):
        case.gear[0].meshes = (1, 1)


def test_template_is_the_example_panel_and_shows_every_key():
    case, example = parse_case(template()), load_case(PANEL)
    for table in ("water", "current", "twine", "netting", "gear", "drag", "added_mass"):
        assert getattr(case, table) == getattr(example, table)
    schema = json_schema()
    keys = {key for table in [schema, *schema["$defs"].values()] for key in table["properties"]}
    assert {key for key in keys if key not in template()} == set()


def gear_of_the_template(lines):
    """Numbers of the lines that show what gear there may be beside the panel."""
    first = lines.index(
        "# Netting round an axis, and what hangs on netting; every part has a name of its own:"
    )
    return range(first + 1, lines.index("", first))


def shapes_of_the_template(lines):
    """Numbers of the lines that show netting cut to shape, boxes and seams."""
    first = lines.index("# Netting cut to shape, cages with four walls, and seams:")
    return range(first + 1, lines.index("", first))


def test_the_shapes_of_the_template_can_be_used():
    lines = template().splitlines()
    parts = shapes_of_the_template(lines)
    block = [lines[i][2:] for i in parts]
    case = parse_case("\n".join([*lines[: parts.start], *block, *lines[parts.stop :]]))
    assert [part.kind for part in case.gear] == ["panel", "trapezoid", "box", "trapezoid", "seam"]
    assert fyke.build_net(case).panels[-1].name == "square"


@pytest.mark.parametrize("left_out", [("diameter", "height"), ("hanging_ratio",)])
def test_the_gear_of_the_template_can_be_used(left_out):
    lines = template().splitlines()
    parts = gear_of_the_template(lines)
    block = [lines[i][2:] for i in parts]
    block[:10] = [line for line in block[:10] if not line.startswith(left_out)]
    case = parse_case("\n".join([*lines[: parts.start], *block, *lines[parts.stop :]]))
    kinds = ["panel", "cylinder", "rope", "collar", "ring", "ring", "sinkers", "floats"]
    assert [part.kind for part in case.gear] == kinds


def lines_of_the_template(lines):
    """Numbers of the lines that show the sea bed, chain and lines."""
    first = lines.index("# Lines free of netting, and the sea bed, which lies at the depth of [water]:")
    return range(first + 1, lines.index("", first))


@pytest.mark.parametrize(
    "left_out", [("pieces", "pretension"), ("pieces", 'length = "6.5'), ("twine", "length", "pretension")]
)
def test_the_lines_of_the_template_can_be_used(left_out):
    """On the template's panel and a cylinder, the moorings always with their length."""
    lines = template().splitlines()
    block = [lines[i][2:] for i in lines_of_the_template(lines)]
    moorings = next(i for i, line in enumerate(block) if line.startswith('kind = "moorings"'))
    block = [line for i, line in enumerate(block) if i > moorings or not line.startswith(left_out)]
    more = """
[twine.rope]
material = "PES"
diameter = "8 mm"
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [64, 18]
hanging_ratio = [0.6, 0.8]
[[gear]]
kind = "panel"
name = "left"
netting = "main"
meshes = [4, 4]
hanging_ratio = 0.6
"""
    text = template().replace("# depth = 20.0 ", "depth = 20.0 ")
    case = parse_case("\n".join([text, more, *block]))
    assert [part.kind for part in case.lines] == ["line", "moorings"]
    assert case.bed is not None and case.chain["links"].bar_diameter == 0.013


def test_the_motion_of_the_template_can_be_used(tmp_path):
    lines = template().splitlines()
    (tmp_path / "motion.csv").write_text("time,dx,dy,dz\n0,0,0,0\n2,0,0,0.1\n")
    first = lines.index("# [[motion]]")
    block = [line[2:].replace('"cage.top"', '".top"') for line in lines[first : lines.index("", first)]]
    text = "\n".join([*lines[:first], *block, *lines[lines.index("", first) :]])
    dynamic = text.replace('kind = "static"', 'kind = "dynamic"\nduration = 2.0')
    case = parse_case(dynamic, path=tmp_path / "case.toml")
    assert case.motion[0].model_fields_set == set(type(case.motion[0]).model_fields)


def beside_netting_and_twine(key, lines):
    """Change what keys of netting and twine cannot stand beside."""
    if key == "long_bar":
        return [line.replace('mesh = "diamond"', 'mesh = "hexagonal"') for line in lines]
    if key == "packing":
        return [
            line.removeprefix("# ") if "rtex =" in line else line
            for line in lines
            if 'diameter = "1.5' not in line
        ]
    return lines


def test_every_commented_line_of_the_template_can_be_used(tmp_path):
    (tmp_path / "measured.csv").write_text("knot,x,y,z\n")
    (tmp_path / "current.csv").write_text("time,u,v,w\n10800,0.5,0,0\n21600,0.6,0,0\n")
    # What else a commented line needs, and what it stands instead of.
    beside = {"speed": "direction", "direction": "speed", "at": "file"}
    lines = template().splitlines()
    waves = lines.index("# [waves]")
    own = next(i for i, line in enumerate(lines) if line.startswith("# [material.own]"))
    loads = next(i for i, line in enumerate(lines) if line.startswith("# [[load_case]]"))
    irregular, after = (
        lines.index('# For kind = "jonswap" or "pierson-moskowitz":', waves),
        lines.index("", waves),
    )
    moved = lines.index("# [[motion]]")
    parts = {*gear_of_the_template(lines), *shapes_of_the_template(lines), *lines_of_the_template(lines)}
    parts |= {*range(moved, lines.index("", moved))}
    for number, line in enumerate(lines):
        words = ("The", "A ", "For", "By")
        if not line.startswith("# ") or "=" not in line or line[2:].startswith(words) or number in parts:
            continue
        key = line[2:].split("=")[0].strip()
        shown = [line[2:] if i == number else old for i, old in enumerate(lines)]
        if key in ("law", "hanging_ratio"):
            shown = [
                old for old in shown if not old.startswith({"law": "youngs", "hanging_ratio": "size"}[key])
            ]
        shown = beside_netting_and_twine(key, shown)
        if own <= number < lines.index("", own):
            # The table begins with its name and the one key that it must have.
            shown[own : own + 2] = [old[2:] for old in lines[own : own + 2]]
        if loads <= number < lines.index("", loads):
            shown[loads] = "[[load_case]]"
        if waves < number < after:
            size = ('kind = "jonswap"', "significant_height = 1.0", 'peak_period = "6 s"')
            size = size if number > irregular else ('kind = "airy"', "height = 1.0", 'period = "6 s"')
            needed = [one for one in size if not one.startswith(f"{key} =")]
            shown = [*lines[:waves], "[waves]", *needed, line[2:], *lines[after:]]
        if lines[number - 1].startswith("# [grouping]"):
            shown[number - 1] = "[grouping]"
        elif key in ("bars", "knots"):
            (tmp_path / "drag.csv").write_text("reynolds,normal,tangential\n10,2,0.1\n1000,1,0.1\n")
            before = max(i for i, old in enumerate(lines[:number]) if old.startswith(f"{key} ="))
            shown[before] = ""
        if (
            number < waves
            and key in ("speed", "direction", "file", "at", "profile")
            and '"power"' not in line
        ):
            shown = [old for old in shown if not old.startswith("velocity")]
            needed = next((i for i, old in enumerate(shown) if old.startswith(f"# {beside.get(key)} =")), 0)
            shown[needed] = shown[needed].removeprefix("# " * bool(needed))
        for opened in ("# depth =",) * ('"power"' in line) + ("# [compare]",) * (key == "positions"):
            shown = [old.replace(opened, opened[2:]) for old in shown]
        if key in (
            "duration",
            "start",
            "stepper",
            "rtol",
            "atol",
            "max_step",
            "settle_force",
            "settle_energy",
        ):
            shown = [old.replace('kind = "static"', 'kind = "dynamic"') for old in shown]
            shown = [old.replace("# duration", "duration") for old in shown]
        file = tmp_path / "case.toml"
        file.write_text("\n".join(shown))
        assert load_case(file).text != template(), line


def test_json_schema_lets_a_length_be_a_number_or_a_text_with_unit():
    schema = json_schema()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema["required"] == ["schema", "current", "gear"]
    number, text = schema["$defs"]["NettingSpec"]["properties"]["bar_length"]["anyOf"]
    assert number["type"] == "number" and number["exclusiveMinimum"] == 0.0
    assert re.search(text["pattern"], "30 mm") and not re.search(text["pattern"], "30 kg")
    assert math.isclose(schema["$defs"]["Water"]["properties"]["density"]["default"], 1000.0)


def test_json_schema_allows_what_the_reader_allows():
    tables = json_schema()["$defs"]
    assert "kind" not in tables["StaticSolve"].get("required", [])
    assert tables["DynamicSolve"]["required"] == ["kind", "duration"]
    pair = tables["PanelSpec"]["properties"]["hanging_ratio"]["anyOf"][2]
    assert (pair["minItems"], pair["maxItems"]) == (2, 2)


def test_json_schema_describes_every_key():
    schema = json_schema()
    for table in schema["$defs"].values():
        assert table["additionalProperties"] is False
        assert all("description" in key for key in table["properties"].values()), table["title"]
