"""Moved knots in the case file: what is read, what it moves, what is shown, and every wrong input by itself."""

import json
import math

import numpy as np
import pytest

import fyke
from fyke.case import CaseError, load_case, parse_case
from fyke.case.motion import read_motion
from fyke.cli.check import check_case, judge
from fyke.cli.export import case_of
from fyke.live.study import Study
from fyke.results import flow_direction, mean_current
from fyke.system.build import build_net, build_system

HEAD = """schema = 1
[current]
velocity = [0.0, 0.1, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "30 mm"
[[gear]]
kind = "panel"
name = "net"
netting = "main"
meshes = [4, 4]
hanging_ratio = 0.6
centre = [0.0, 0.0, -5.0]
fixed = "FIXED"
[[gear]]
kind = "panel"
name = "other"
netting = "main"
meshes = [3, 3]
hanging_ratio = 0.6
centre = [1.0, 0.0, -5.0]
fixed = "top"
"""
DYNAMIC = '[solve]\nkind = "dynamic"\nduration = 2.0\n'
TOW = "[[motion]]\nvelocity = [-0.5, 0, 0]\n"


def text_of(motion, solve=DYNAMIC, fixed="edges"):
    return HEAD.replace("FIXED", fixed) + motion + solve


def system_of(motion, **options):
    case = parse_case(text_of(motion, **options), "m.toml")
    return build_system(build_net(case), case)


def problems(motion, **options):
    """Every problem of a case, as (where, found, allowed, cure)."""
    with pytest.raises(CaseError) as caught:
        parse_case(text_of(motion, **options), "m.toml")
    return [(one.where, one.found, one.allowed, one.cure) for one in caught.value.problems]


def only(motion, **options):
    told = problems(motion, **options)
    assert len(told) == 1, told
    return told[0]


# What is read


def test_all_held_knots_by_default_and_named_ones():
    system = system_of(TOW)
    held = np.flatnonzero(system.net.fixed)
    assert np.array_equal(system.motion.knots, held)
    labels = np.array(system.net.labels)
    for of, expected in (
        ('["net.top"]', [f"net:{i}-8" for i in range(0, 9, 2)]),
        ('["net:0-0", "other:0-6"]', ["net:0-0", "other:0-6"]),
        ('["other"]', [f"other:{i}-6" for i in range(0, 7, 2)]),
        ('["other", "other.top", "net:0-0"]', ["net:0-0", *(f"other:{i}-6" for i in range(0, 7, 2))]),
    ):
        motion = system_of(TOW + f"of = {of}\n").motion
        assert sorted(labels[motion.knots]) == sorted(expected), of


def test_every_key_moves_as_it_says():
    """Two motions add up: a tow with a swing, and a turn about a point that goes along."""
    system = system_of(
        """[[motion]]
velocity = ["-1 kn", 0, 0]
amplitude = [0, 0, "20 cm"]
period = 4
phase = "30 deg"
[[motion]]
of = ["net"]
rotation = { axis = [0, 2, 0], point = [0.5, 0, -5], amplitude = "6 deg", period = "8 s", phase = "90 deg" }
"""
    )
    time = 1.7
    x, _, _ = system.motion.at(time)
    built = system.net.positions[system.motion.knots].copy()
    angle = math.radians(6.0) * (math.sin(2 * math.pi * time / 8 + math.pi / 2) - 1.0)
    own = np.array([system.net.labels[knot].startswith("net") for knot in system.motion.knots])
    away = built[own] - [0.5, 0.0, -5.0]
    built[own, 0] = 0.5 + away[:, 0] * math.cos(angle) + away[:, 2] * math.sin(angle)
    built[own, 2] = -5.0 - away[:, 0] * math.sin(angle) + away[:, 2] * math.cos(angle)
    lift = 0.2 * (math.sin(2 * math.pi * time / 4 + math.pi / 6) - 0.5)
    assert x == pytest.approx(built + np.array([-time * 1852 / 3600, 0.0, lift]), abs=1e-12)


def test_rotation_takes_the_period_and_the_middle_by_default():
    system = system_of(
        '[[motion]]\nof = ["net"]\nperiod = 3\nrotation = { axis = [0, 0, 1], amplitude = "9 deg" }\n'
    )
    x, _, _ = system.motion.at(0.75)
    assert x.mean(axis=0) == pytest.approx([0.0, 0.0, -5.0], abs=1e-12)
    turned = math.atan2(-x[-1, 0], x[-1, 1])
    assert abs(turned) == pytest.approx(math.radians(9.0), rel=1e-12)
    spun = system_of('[[motion]]\nof = ["net"]\nrotation = { axis = [0, 0, 1], rate = "3 rpm" }\n').motion.at(
        2.5
    )[0]
    assert math.atan2(-spun[-1, 0], spun[-1, 1]) == pytest.approx(math.pi / 4, rel=1e-12)


def test_a_file_is_followed(tmp_path):
    times = np.linspace(3.0, 6.0, 61)
    table = np.column_stack(
        [times, np.sin(times), np.cos(times), 0 * times, 5 * np.sin(times), 0 * times, 0 * times]
    )
    header = "time,dx,dy,dz,roll,pitch,yaw"
    np.savetxt(tmp_path / "ship.csv", table, delimiter=",", header=header, comments="")
    (tmp_path / "case.toml").write_text(
        text_of('[[motion]]\nof = ["net"]\nfile = "ship.csv"\nrotation = { point = [0, 0, -5] }\n')
    )
    case = load_case(tmp_path / "case.toml")
    motion = build_system(build_net(case), case).motion
    x, v, _ = motion.at(1.23)
    way = [np.sin(4.23) - np.sin(3.0), np.cos(4.23) - np.cos(3.0), 0.0]
    assert x.mean(axis=0) == pytest.approx(np.add([0.0, 0.0, -5.0], way), abs=1e-6)
    roll = math.radians(5.0) * (np.sin(4.23) - np.sin(3.0))
    away = motion.built - [0, 0, -5]
    assert x[:, 2] + 5 == pytest.approx(away[:, 1] * math.sin(roll) + away[:, 2] * math.cos(roll), abs=1e-6)
    assert v.mean(axis=0) == pytest.approx([np.cos(4.23), -np.sin(4.23), 0.0], abs=1e-4)
    assert read_motion(tmp_path / "ship.csv") is read_motion(tmp_path / "ship.csv")


def test_a_result_without_its_record_has_no_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.csv").write_text("time,dx,dy,dz\n0,0,0,0\n2,0,0,0.1\n")
    case = parse_case(text_of('[[motion]]\nfile = "m.csv"\n'), "m.toml")
    net = build_net(case)
    result = fyke.simulate(build_system(net, case), duration=0.02, every=0.01)
    assert result.position[-1][net.fixed] == pytest.approx(
        net.positions[net.fixed] + [0, 0, 0.001], abs=1e-12
    )
    assert case_of(result) is not None
    (tmp_path / "m.csv").unlink()
    assert case_of(result) is None


def test_a_towed_case_is_judged_and_seen_from_the_carriage(tmp_path, capsys):
    text = text_of(TOW + 'ramp = "0.5 s"\n')
    case = parse_case(text, "m.toml")
    told = judge(case)
    assert told["motion"] == [
        {"of": None, "knots": 20, "words": "velocity (-0.5, 0, 0) m/s, after a ramp of 0.5 s"}
    ]
    # Reynolds numbers by the water that comes: 0.5 m/s across, 0.1 m/s along.
    assert told["panels"][0]["reynolds_across"][1] > 0.49 * 1.5e-3 / 1e-6
    system = build_system(build_net(case), case)
    assert mean_current(system) == pytest.approx([0.5, 0.1, 0.0])
    assert flow_direction(system) == pytest.approx(np.array([5.0, 1.0, 0.0]) / math.sqrt(26.0))
    (tmp_path / "m.toml").write_text(text)
    assert check_case(tmp_path / "m.toml", json=False) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "motion all that is held (20 knots): velocity (-0.5, 0, 0) m/s, after a ramp" in shown
    # The live page shows the shape in the tow, and the drag of it.
    study = Study(text)
    still = Study(text.replace("[0.0, 0.1, 0.0]", "[0.5, 0.1, 0.0]").replace(TOW + 'ramp = "0.5 s"\n', ""))
    assert study.result.position == pytest.approx(still.result.position, abs=1e-9)
    assert study.numbers.drag == pytest.approx(still.numbers.drag, rel=1e-6)


def test_static_cases_are_those_of_the_net_as_built():
    case = parse_case(text_of("[[motion]]\namplitude = [0, 0, 1]\nperiod = 5\n", solve=""), "m.toml")
    assert "plays no part in a static case" in " ".join(case.warnings)
    assert build_system(build_net(case), case).motion is None
    with pytest.raises(ValueError, match="seen from what tows it"):
        fyke.solve_static(system_of(TOW))


# What is wrong


@pytest.mark.parametrize(
    ("motion", "options", "words"),
    [
        ("[[motion]]\n", {}, ("[[motion]] 1 velocity", "nothing that moves", "file", "velocity = ")),
        ("[[motion]]\namplitude = [0, 0, 1]\n", {}, ("period", "without period", "s, of", 'period = "6 s"')),
        (TOW + "period = 3\n", {}, ("period", "without amplitude", "both", "amplitude = ")),
        (TOW + 'phase = "3 deg"\n', {}, ("phase", "without amplitude", "swing", "leave phase out")),
        (
            TOW + "rotation = { axis = [0, 0, 1] }\n",
            {},
            ("rotation", "neither", "file with angles", "rate = "),
        ),
        (
            TOW + 'rotation = { amplitude = "3 deg", period = 2 }\n',
            {},
            ("rotation", "nothing", "axis", "axis = "),
        ),
        (
            TOW + 'rotation = { axis = [0, 0, 1], amplitude = "3 deg" }\n',
            {},
            ("rotation", "without period", "s, of", 'period = "6 s"'),
        ),
        (
            TOW + 'rotation = { axis = [0, 0, 1], amplitude = "3 deg", period = 2, rate = "1 rpm" }\n',
            {},
            ("rotation", "both", "to and fro", "leave out"),
        ),
        (TOW + "rotation = { axis = [0, 0, 1], rate = 3 }\n", {}, ("rate", "3", "rpm", "in which unit")),
        (TOW + "ramp = 0\n", {}, ("ramp", "0", "above 0", "above 0")),
        (TOW + "speed = 2\n", {}, ("speed", "unknown key", "velocity", "current")),
        ("[motion]\nvelocity = [1, 0, 0]\n", {}, ("motion", "velocity", "[[motion]]", "double brackets")),
        (TOW + "of = []\n", {}, ("of", "[]", "list", "cage.top")),
        (TOW + 'of = ["nett.top"]\n', {}, ("of, value 1", "nett.top", '"net"', 'did you mean "net.top"')),
        (TOW + 'of = ["net:1-2"]\n', {}, ("of, value 1", "net:1-2", "label", "knots.csv")),
        (
            TOW + 'of = ["net.top", "other.bottom"]\n',
            {},
            ("of, value 2", "4 of its 4 knots are free", "held", "net.top"),
        ),
        (TOW + 'of = ["net:4-4"]\n', {}, ("of, value 1", "its knot is free", "held", "net.top")),
        (
            TOW + 'of = ["net.left"]\n',
            {"fixed": "top"},
            ("of, value 1", "4 of its 5 knots are free", "held", "net.top"),
        ),
        (TOW + 'of = ["net"]\n', {"fixed": "none"}, ("of, value 1", "41 of its 41", "held", "other.top")),
        (
            TOW,
            {"solve": DYNAMIC + 'stepper = "verner"\n'},
            ("[solve] stepper", "verner", "implicit", 'stepper = "implicit"'),
        ),
        (
            TOW,
            {"solve": DYNAMIC + "settle_energy = 1e-9\n"},
            ("settle_energy", "tow", "settle_force", "settle_force"),
        ),
        (
            "[[motion]]\namplitude = [0, 0, 1]\nperiod = 3\n",
            {"solve": DYNAMIC + "settle_force = 1e-3\n"},
            ("settle_force", "to and fro", "constant velocity", "leave settle_force out"),
        ),
        (
            TOW,
            {"solve": ""},
            ("velocity", "static case", "dynamic", "velocity = [0.5, 0.1, 0.0] in [current]"),
        ),
        (
            '[[motion]]\nrotation = { axis = [0, 0, 1], rate = "1 rpm" }\n',
            {"solve": ""},
            ("rate", "static", "dynamic", "dynamic"),
        ),
        ('[[motion]]\nfile = "none.csv"\n', {}, ("none.csv", "no such file", "CSV", "folder")),
    ],
)
def test_each_fault_is_told_once(motion, options, words):
    for said, word in zip(only(motion, **options), words, strict=True):
        assert word in said, (said, word)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("time,dx,dy\n0,0,0\n9,0,0\n", ("row 1", "time,dx,dy", "time,dx,dy,dz or", "name the columns")),
        ("time,dx,dy,dz\n0,0,0,0\n2,0,0,0\n1,0,0,0\n", ("row 4", "time 1 after time 2", "rising", "sort")),
        ("time,dx,dy,dz\n0,0,0,0\n5,x,0,0\n", ("row 3, column dx", "'x'", "m", "correct")),
        ("time,dx,dy,dz\n0,0,0,0\n", ("m.csv", "one value of time", "two or more", "add")),
        ("time,dx,dy,dz\n0,0,0,0\n1,0,0,0\n", ("[[motion]] 1 file", "lasts 1 s", "2 s", "shorten")),
    ],
)
def test_faults_of_a_file(tmp_path, table, words):
    (tmp_path / "m.csv").write_text(table)
    (tmp_path / "case.toml").write_text(text_of('[[motion]]\nfile = "m.csv"\n'))
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path / "case.toml")
    (told,) = caught.value.problems
    for said, word in zip((told.where, told.found, told.allowed, told.cure), words, strict=True):
        assert word in said, (said, word)


def test_all_faults_at_once_and_exit_code(tmp_path, capsys):
    motion = '[[motion]]\nof = ["gone"]\namplitude = [0, 0, 1]\n' + TOW + 'of = ["net:4-4"]\n'
    file = tmp_path / "m.toml"
    file.write_text(text_of(motion, solve=DYNAMIC + 'stepper = "symplectic"\n'))
    assert check_case(file, json=True) == 2
    told = json.loads(capsys.readouterr().out)
    assert len(told["problems"]) == 4


# Names on gear of every kind


BOX = """schema = 1
[current]
velocity = [0.1, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "0.1 m"
[[gear]]
kind = "box"
name = "box"
netting = "main"
meshes = [4, 4, 3]
size = [0.4, 0.4, 0.3]
top = [0.0, 0.0, -1.0]
fixed = "edges"
"""
COLLAR = """[tube.pipe]
material = "HDPE"
diameter = "32 mm"
wall = "3 mm"
[[gear]]
kind = "collar"
name = "collar"
tube = "pipe"
along = "box.top"
"""


def test_names_of_a_box():
    for name, count in (("box.corner1", 2), ("box", 32), ("box.top", 16), ("box:0-3", 1)):
        text = BOX + TOW + f'of = ["{name}"]\n' + DYNAMIC
        if name == "box.corner1":
            with pytest.raises(CaseError, match="2 of its 4 knots are free"):
                parse_case(text)
            continue
        case = parse_case(text)
        assert len(build_system(build_net(case), case).motion.knots) == count


def test_labels_of_grouped_netting_are_the_real_ones():
    grouped = BOX.replace("meshes = [4, 4, 3]", "meshes = [8, 8, 6]").replace("0.1 m", "0.05 m")
    grouped = grouped.replace('kind = "box"', 'kind = "box"\ngroup = 2')
    case = parse_case(grouped + TOW + 'of = ["box:0-6"]\n' + DYNAMIC)
    system = build_system(build_net(case), case)
    knot = int(system.motion.knots[0])
    top = system.net.positions[system.net.fixed, 2].max()
    assert system.net.positions[knot, 2] == top and len(system.motion.knots) == 1


def test_what_a_collar_sets_free_is_told_when_it_is_built(tmp_path, capsys):
    """The net is needed to know it; the exit code is that of any wrong case."""
    file = tmp_path / "m.toml"
    file.write_text(BOX + TOW + 'of = ["box.top"]\n' + COLLAR + DYNAMIC)
    assert check_case(file, json=False) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert "[[motion]] 1" in told and "16 of its 16 knots are free" in told and "hold them" in told


LINE = """schema = 1
[water]
depth = 15.0
[current]
velocity = [0.0, 0.0, 0.0]
[bed]
[chain.main]
bar_diameter = "13 mm"
[[gear]]
kind = "line"
name = "mooring"
from = [0.0, 0.0, -15.0]
to = [38.0, 0.0, -0.2]
twine = "main"
length = "45 m"
segments = 30
"""


def test_a_fairlead_heaves():
    """The end of a mooring line goes up and down, its anchor does not; the chain follows."""
    motion = '[[motion]]\nof = ["mooring:30"]\namplitude = [0, 0, 0.5]\nperiod = 4\nramp = 2\n'
    case = parse_case(LINE + motion + '[solve]\nkind = "dynamic"\nduration = 5.0\n')
    net = build_net(case)
    system = build_system(net, case)
    assert [net.labels[knot] for knot in system.motion.knots] == ["mooring:30"]
    run = fyke.simulate(system, duration=5.0, every=0.5)
    assert run.outcome.ok
    assert run.position[-1, -1] == pytest.approx([38.0, 0.0, -0.2 + 0.5], abs=1e-12)
    assert run.position[-1, 0] == pytest.approx([0.0, 0.0, -15.0], abs=1e-12)
    assert np.ptp(run.tension[4:, -1]) > 0.05 * run.tension[0, -1]
    whole = parse_case(LINE + motion.replace("mooring:30", "mooring") + DYNAMIC)
    assert len(build_system(build_net(whole), whole).motion.knots) == 2
