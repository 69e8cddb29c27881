"""Waves in the case file: what is read, and every wrong input with its message."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fyke.case import CaseError, json_schema, parse_case
from fyke.water.waves import Spreading, airy, default_gamma, irregular, stokes2

CASE = """schema = 1
[water]
depth = 20.0
[current]
velocity = [0.5, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "30 mm"
[[gear]]
kind = "panel"
netting = "main"
meshes = [8, 8]
size = [0.3055, 0.3055]
centre = [0.0, 0.0, -1.0]
[solve]
kind = "dynamic"
duration = 20
"""
REGULAR = CASE + '[waves]\nkind = "airy"\nheight = 2.0\nperiod = "8 s"\n'
STOKES = REGULAR.replace("airy", "stokes2")
SEA = CASE + '[waves]\nkind = "jonswap"\nsignificant_height = "2 m"\npeak_period = 7\n'
POINTS = np.random.default_rng(1).uniform([-9.0, -9.0, -20.0], [9.0, 9.0, -1.0], (30, 3))


def sea_of(text):
    case = parse_case(text)
    assert case.waves is not None
    return case.waves.sea(case.water.depth, case.water.gravity)


def problems_of(text):
    with pytest.raises(CaseError) as caught:
        parse_case(text, "c.toml")
    return caught.value.problems


@pytest.mark.parametrize(
    ("text", "sea"),
    [
        (REGULAR, airy(2.0, 8.0, depth=20.0)),
        (
            REGULAR + 'direction = "30 deg"\nphase = "90 deg"\nstretching = "none"\nramp = "0.5 min"\n',
            airy(
                2.0,
                8.0,
                depth=20.0,
                direction=math.pi / 6.0,
                phase=math.pi / 2.0,
                stretching="none",
                ramp=30.0,
            ),
        ),
        (REGULAR.replace("depth = 20.0", "gravity = 1.62"), airy(2.0, 8.0, gravity=1.62)),
        (STOKES + 'direction = "-1 rad"\n', stokes2(2.0, 8.0, depth=20.0, direction=-1.0)),
        (SEA, irregular(2.0, 7.0, gamma=default_gamma(2.0, 7.0), depth=20.0)),
        (
            SEA + "gamma = 3.3\ncomponents = 50\nseed = 7\nspreading = { exponent = 4, directions = 9 }\n",
            irregular(
                2.0,
                7.0,
                gamma=3.3,
                components=50,
                seed=7,
                depth=20.0,
                spreading=Spreading(4.0, 9),
            ),
        ),
        (SEA.replace("jonswap", "pierson-moskowitz"), irregular(2.0, 7.0, gamma=1.0, depth=20.0)),
    ],
)
def test_waves_are_those_that_the_file_says(text, sea):
    found, expected = sea_of(text).motion(POINTS, 3.0), sea.motion(POINTS, 3.0)
    assert np.array_equal(found.velocity, expected.velocity)
    assert np.array_equal(found.acceleration, expected.acceleration)
    assert np.array_equal(found.elevation, expected.elevation)
    assert abs(expected.velocity).max() > 1e-3


def test_a_case_without_waves_has_none_and_probes_the_origin():
    case = parse_case(CASE)
    assert case.waves is None and case.output.probes == ((0.0, 0.0, 0.0),)
    probed = parse_case(REGULAR + '[output]\nprobes = [[0, 0, -1], ["10 cm", 0, 0]]\n')
    assert probed.output.probes == ((0.0, 0.0, -1.0), (0.1, 0.0, 0.0))
    assert probed.warnings == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (REGULAR, "airy, 2 m, 8 s, towards 0 deg"),
        (STOKES + 'direction = "45 deg"\n', "stokes2, 2 m, 8 s, towards 45 deg"),
        (SEA, "jonswap, gamma 1.06, Hs 2 m, Tp 7 s, 200 components, towards 0 deg"),
        (
            SEA.replace("jonswap", "pierson-moskowitz") + "spreading = { exponent = 4 }\n",
            "pierson-moskowitz, Hs 2 m, Tp 7 s, 200 components, towards 0 deg, cos^2s spread, s = 4",
        ),
    ],
)
def test_waves_are_described_in_one_line(text, words):
    assert parse_case(text).waves.described == words


# text, then key of the problem, and a piece of found, allowed and cure
WRONG = {
    "higher than breaking": (
        REGULAR.replace("= 2.0", "= 20.0"),
        # 0.142 L tanh kh of 8 s in 20 m: L = 88.7927 m, k = 0.0707624 (see airy_waves.csv).
        (
            "line 24, [waves] height",
            "20 m, which makes H/L = 0.225 at 8 s in 20 m",
            "at most 11.2 m",
            "lower",
        ),
    ),
    "steeper than breaking in deep water": (
        STOKES.replace("depth = 20.0", "").replace("= 2.0", "= 15.0"),
        ("[waves] height", "H/L = 0.15 at 8 s in deep water", "at most 14.18 m", "lower"),
    ),
    "significant height beyond breaking": (
        SEA.replace("depth = 20.0", "depth = 2.0"),
        ("[waves] significant_height", "2 m, which makes H/L", "at most 1.687 m", "longer"),
    ),
    "water of no depth": (
        REGULAR.replace("depth = 20.0", "depth = 5e-324"),
        ("[waves] height", "4.94066e-324 m of water", "at most 8.922e-07 m", "check the units"),
    ),
    "no gravity": (
        REGULAR.replace("depth = 20.0", "gravity = 0"),
        ("line 3, [water] gravity", "0 m/s2, with waves", "above 0", "leave out [waves]"),
    ),
    "negative depth": (
        REGULAR.replace("20.0", "-20"),
        ("line 3, [water] depth", "-20", "above 0", "leave out the minus sign"),
    ),
    "kind misspelled": (
        REGULAR.replace("airy", "ayri"),
        ("[waves] kind", '"ayri"', '"airy" or "stokes2" or "jonswap" or "pierson-moskowitz"', '"airy"'),
    ),
    "no kind": (
        REGULAR.replace('kind = "airy"\n', ""),
        ("waves", "height = 2.0", '"airy" or', 'kind = "airy"'),
    ),
    "no height": (
        REGULAR.replace("height = 2.0\n", ""),
        ("[waves] height", "nothing", "crest to trough", "add height = 2.0"),
    ),
    "negative height": (
        REGULAR.replace("= 2.0", "= -2.0"),
        ("[waves] height", "-2.0", "from 0.0001 to 100 m", "leave out the minus sign"),
    ),
    "height without its unit": (
        REGULAR.replace("= 2.0", '= "2"'),
        ("[waves] height", '"2"', "m, mm", "without quotes"),
    ),
    "period as a length": (
        REGULAR.replace("8 s", "8 m"),
        ("[waves] period", '"8 m"', "s, ms", "'m' is a unit of length"),
    ),
    "period of nothing": (
        REGULAR.replace('"8 s"', "0"),
        ("[waves] period", "0", "from 0.01", "above 0"),
    ),
    "direction without its unit": (
        REGULAR + "direction = 30\n",
        ("[waves] direction", "30", "deg, rad", '"30 deg" or "30 rad"'),
    ),
    "phase in turns": (
        REGULAR + 'phase = "1 turn"\n',
        ("[waves] phase", '"1 turn"', "deg, rad", "'turn' is no angle"),
    ),
    "stretching of another name": (
        REGULAR + 'stretching = "wheler"\n',
        ("[waves] stretching", '"wheler"', '"wheeler" or "none"', 'did you mean "wheeler"?'),
    ),
    "stretching of Stokes": (
        STOKES + 'stretching = "wheeler"\n',
        ("[waves] stretching", "unknown key", "height, period", "belongs in [waves]"),
    ),
    "ramp that goes back": (
        REGULAR + "ramp = -3\n",
        ("[waves] ramp", "-3", "a time from 0", "minus"),
    ),
    "height of an irregular sea": (
        SEA.replace("significant_height", "height"),
        ("[waves] significant_height", "nothing", "4 sqrt(m0)", "significant_height = 2.0"),
    ),
    "peak factor below 1": (
        SEA + "gamma = 0.5\n",
        ("[waves] gamma", "0.5", "from 1 to 10", "check the number"),
    ),
    "peak factor of Pierson and Moskowitz": (
        SEA.replace("jonswap", "pierson-moskowitz") + "gamma = 3.3\n",
        ("[waves] gamma", "unknown key", "seed", 'with kind = "jonswap"'),
    ),
    "no component": (SEA + "components = 0\n", ("[waves] components", "0", "from 1 to 10000", "1 or more")),
    "too many components": (
        SEA + "components = 20000\n",
        ("[waves] components", "20000", "from 1 to 10000", "10000 or less"),
    ),
    "components with a point": (
        SEA + "components = 200.0\n",
        ("[waves] components", "200.0", "whole number", "write 200"),
    ),
    "half a component": (SEA + "components = 0.5\n", ("[waves] components", "0.5", "whole number", "whole")),
    "seed of words": (SEA + 'seed = "one"\n', ("[waves] seed", '"one"', "whole number", "whole")),
    "true for a seed": (SEA + "seed = true\n", ("[waves] seed", "true", "whole number", "whole")),
    "negative seed": (SEA + "seed = -4\n", ("[waves] seed", "-4", "from 0", "0 or more")),
    "spreading of one number": (
        SEA + "spreading = 10\n",
        ("[waves] spreading", "10", "a table", "[waves.spreading]"),
    ),
    "spreading without exponent": (
        SEA + "spreading = { directions = 9 }\n",
        ("[waves] spreading.exponent", "nothing", "wind seas", "exponent = 10"),
    ),
    "spreading one way": (
        SEA + "spreading = { exponent = 10, directions = 1 }\n",
        ("[waves] spreading.directions", "1", "from 2 to 360", "2 or more"),
    ),
    "spreading of no exponent": (
        SEA + "spreading = { exponent = 0 }\n",
        ("[waves] spreading.exponent", "0", "from 0.5", "a value above 0"),
    ),
    "probe of two numbers": (
        REGULAR + "[output]\nprobes = [[0, 0]]\n",
        ("[output] probes, value 1", "[0, 0]", "points", "probes = [[0.0, 0.0, -1.0]]"),
    ),
    "probe in one bracket": (
        REGULAR + "[output]\nprobes = [0, 0, -1]\n",
        ("[output] probes, value 1", "0", "points", "probes = [[0.0, 0.0, -1.0]]"),
    ),
    "waves of a number": (
        REGULAR[: REGULAR.index("[waves]")].replace("schema = 1", "schema = 1\nwaves = 2.0"),
        ("line 2, waves", "2.0", "a table: the waves", "[waves]"),
    ),
}


@pytest.mark.parametrize(("text", "pieces"), WRONG.values(), ids=WRONG)
def test_wrong_input(text, pieces):
    problem = min(problems_of(text), key=lambda one: pieces[0] not in one.where)
    parts = (problem.where, problem.found, problem.allowed, problem.cure)
    assert all(piece in part for piece, part in zip(pieces, parts, strict=True)), problem


def test_the_height_that_is_told_is_allowed():
    text = REGULAR.replace("= 2.0", "= 20.0")
    told = problems_of(text)[0].allowed.split()[2]
    assert parse_case(text.replace("= 20.0\nperiod", f"= {told}\nperiod")).waves.height == float(told)
    assert problems_of(text.replace("= 20.0\nperiod", f"= {float(told) + 0.01}\nperiod"))


def test_all_faults_of_waves_are_told_at_once():
    text = SEA + "gamma = 0\ncomponents = 0\ndirection = 0\nramps = 1\n"
    found = {problem.where.rsplit(" ", 1)[1] for problem in problems_of(text)}
    assert found == {"gamma", "components", "direction", "ramps"}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            REGULAR.replace('kind = "dynamic"\nduration = 20', 'kind = "static"'),
            ("no part in a static case",),
        ),
        (CASE + "[output]\nprobes = [[0, 0, 0]]\n", ("probes", "without [waves]")),
        (SEA.replace("= 7", "= 5"), ("3.54", "3.6 to 5")),
        (STOKES.replace("20.0", "4.0"), ("Ursell", "limit of 26")),
        (REGULAR + 'ramp = "30 s"\n', ("ramp of the waves", "30 s", "20 s")),
    ],
)
def test_what_is_odd_is_told_with_the_number_and_the_limit(text, words):
    told = " ".join(parse_case(text).warnings)
    assert all(word in told for word in words), told


def test_schema_has_the_kinds_of_waves():
    text = str(json_schema())
    assert all(kind in text for kind in ("AirySpec", "StokesSpec", "JonswapSpec", "PiersonMoskowitzSpec"))


VALUES = [
    "-1",
    "0",
    "1e308",
    "1e-308",
    "nan",
    "inf",
    "true",
    '""',
    '"8 s"',
    '"15 deg"',
    '"1e999 m"',
    "[]",
    "{}",
]
VALUES += [
    "[[1]]",
    "9" * 400,
    '"wheeler"',
    '"jonswap"',
    "{ exponent = 1e308 }",
    "1.5",
    "3",
    '"none"',
    "0.001",
]
KEYS = ["kind", "height", "period", "direction", "phase", "stretching", "ramp", "significant_height"]
KEYS += ["peak_period", "gamma", "components", "seed", "spreading", "x"]


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.sampled_from(["airy", "stokes2", "jonswap", "pierson-moskowitz"]),
    st.dictionaries(st.sampled_from(KEYS), st.sampled_from(VALUES), max_size=6),
    st.sampled_from(["20.0", "1e-308", "1e4", "5e-324", "0.001"]),
)
def test_any_table_of_waves_is_read_or_refused(kind, keys, depth):
    first = {
        "kind": f'"{kind}"',
        "height": "0.0001",
        "period": "1",
        "significant_height": "0.001",
        "peak_period": "2",
    }
    if kind in ("airy", "stokes2"):
        first = dict(list(first.items())[:3])
    else:
        first = {key: first[key] for key in ("kind", "significant_height", "peak_period")}
    text = (
        CASE.replace("20.0", depth) + "[waves]\n" + "".join(f"{k} = {v}\n" for k, v in (first | keys).items())
    )
    try:
        case = parse_case(text)
    except CaseError as error:
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
    else:
        moved = case.waves.sea(case.water.depth, case.water.gravity).motion(POINTS, 1.0)
        assert np.isfinite(moved.velocity).all()
