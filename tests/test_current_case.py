"""Currents in the case file: what is read, from the file and from CSV and netCDF, and every wrong input by itself."""

import json
import math
import os

import h5netcdf
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.io import netcdf_file

from fyke.case import Case, CaseError, load_case, parse_case, recorded_case
from fyke.case.current_file import MOST_PROBLEMS, read_current
from fyke.cli.check import judge
from fyke.cli.export import case_of
from fyke.cli.report import LOST, report_result
from fyke.live.knobs import knobs_of, turned
from fyke.live.study import Study
from fyke.results import save
from fyke.solve.static import solve_static
from fyke.system.build import build_net, build_system
from fyke.water import LayerCurrent, PowerCurrent, RampedCurrent, SeriesCurrent, TableCurrent, UniformCurrent

REST = """[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "30 mm"
[[gear]]
kind = "panel"
netting = "main"
meshes = [4, 4]
hanging_ratio = 0.6
centre = [0.0, 0.0, -5.0]
fixed = "edges"
"""
DYNAMIC = '[solve]\nkind = "dynamic"\nduration = 100\n'
TABLE = 'profile = { kind = "table", depth = [0, 10], velocity = [[0.5, 0, 0], [0.3, 0.1, 0]] }'
TIDE = "time,u,v,w\n0,0.5,0,0\n3600,0.7,0.1,0\n7200,0.2,0,0.1\n"
SHEAR = "time,depth,u,v\n0,0,0.8,0\n0,4,0.4,0.2\n60,0,1.0,0\n60,4,0.6,0.6\n"


def text_of(current, rest=REST, water=""):
    return f"schema = 1\n[water]\n{water}\n[current]\n{current}\n{rest}"


def case_of_text(current, rest=REST, water=""):
    return parse_case(text_of(current, rest, water), "c.toml")


def beside(folder, current, *, name="current.csv", content="", rest=REST, water=""):
    """A case file on disk with a file beside it."""
    if content:
        (folder / name).write_text(content)
    file = folder / "case.toml"
    file.write_text(text_of(current, rest, water))
    return file


def at(case, *heights, time=0.0):
    return case.current.flow().velocity(np.array([[1.0, 2.0, z] for z in heights]), time)


def problems_of(make):
    with pytest.raises(CaseError) as caught:
        make()
    return caught.value.problems


# What is read


def test_plain_velocity_is_what_it_was():
    case = case_of_text('velocity = ["1 kn", 0.0, -0.1]')
    assert case.current.velocity == case.current.at_surface == (1852 / 3600, 0.0, -0.1)
    assert case.current.flow() == UniformCurrent((1852 / 3600, 0.0, -0.1))
    assert case.current.described == ""


@pytest.mark.parametrize(
    ("direction", "unit"),
    [
        ("0 deg", (1, 0)),
        ("90 deg", (0, 1)),
        ("180 deg", (-1, 0)),
        ("-90 deg", (0, -1)),
        ("60 deg", (0.5, math.sqrt(0.75))),
        ("1 rad", (math.cos(1.0), math.sin(1.0))),
    ],
)
def test_speed_goes_in_a_direction_from_x_to_y(direction, unit):
    case = case_of_text(f'speed = "2 m/s"\ndirection = "{direction}"')
    assert case.current.at_surface == pytest.approx((2 * unit[0], 2 * unit[1], 0.0), abs=1e-15)
    if "deg" in direction and "60" not in direction:
        assert 0.0 in case.current.at_surface[:2]  # a right angle leaves no rounding


def test_power_law_counts_from_the_sea_bed():
    case = case_of_text(
        'velocity = [0.6, 0.2, 0]\nprofile = { kind = "power", exponent = 0.5 }', water="depth = 16"
    )
    assert case.current.flow() == PowerCurrent((0.6, 0.2, 0.0), 16.0, 0.5)
    assert at(case, 0.0, -12.0) == pytest.approx(np.array([[0.6, 0.2, 0.0], [0.3, 0.1, 0.0]]))
    assert "0.5" in case.current.described and case.current.at_surface == (0.6, 0.2, 0.0)


def test_layers_and_table():
    layers = case_of_text(
        'profile = { kind = "layers", depth = [0, "4 m"], velocity = [[1, 0, 0], [0.5, 0, 0]] }'
    )
    assert isinstance(layers.current.flow(), LayerCurrent)
    assert at(layers, -3.9, -4.0, -90.0)[:, 0].tolist() == [1.0, 0.5, 0.5]
    table = case_of_text(TABLE)
    assert isinstance(table.current.flow(), TableCurrent)
    assert at(table, -5.0)[0] == pytest.approx([0.4, 0.05, 0.0])


@pytest.mark.parametrize("kind", ["layers", "table"])
def test_profile_turned_by_a_right_angle_gives_turned_velocities(kind):
    def profile(*degrees):
        directions = ", ".join(f'"{one} deg"' for one in degrees)
        return case_of_text(
            f'profile = {{ kind = "{kind}", depth = [0, 6, 9], speed = [0.5, 0.4, 0.1], direction = [{directions}] }}'
        )

    heights = np.linspace(0.5, -12.0, 30)
    plain, turn = at(profile(0, 20, 50), *heights), at(profile(90, 110, 140), *heights)
    assert turn[:, :2] == pytest.approx(np.column_stack([-plain[:, 1], plain[:, 0]]), abs=1e-15)
    assert not turn[:, 2].any() and np.ptp(plain[:, 1]) > 0.05


def test_ramp_is_of_dynamic_cases():
    dynamic = case_of_text('velocity = [1, 0, 0]\nramp = "10 s"', REST + DYNAMIC)
    assert dynamic.current.flow() == RampedCurrent(UniformCurrent((1.0, 0.0, 0.0)), 10.0)
    assert [at(dynamic, 0.0, time=t)[0, 0] for t in (0.0, 2.5, 5.0, 10.0, 99.0)] == pytest.approx(
        [0.0, 0.103515625, 0.5, 1.0, 1.0]
    )
    assert dynamic.current.at_surface == (1.0, 0.0, 0.0)  # the arrow of a figure has no beginning
    static = case_of_text('velocity = [1, 0, 0]\nramp = "10 s"')
    assert at(static, 0.0)[0, 0] == 1.0
    assert any("ramp" in warning and "static" in warning for warning in static.warnings)


def test_what_looks_odd_is_warned_of():
    short = case_of_text('velocity = [1, 0, 0]\nramp = "200 s"', REST + DYNAMIC)
    assert any("200 s" in warning and "100 s" in warning for warning in short.warnings)
    # 4 x 4 meshes of 30 mm bars at E1 = 0.6 are 0.192 m high: the gear reaches 5.096 m.
    shallow = case_of_text(TABLE.replace("10]", "5]"))
    assert any("5 m" in warning and "5.096 m" in warning for warning in shallow.warnings)
    assert case_of_text(TABLE).warnings == ()
    layers = case_of_text(TABLE.replace("10]", "5]").replace("table", "layers"))
    assert layers.warnings == ()  # the last layer has no end


# CSV


def test_series_out_of_a_csv_file(tmp_path):
    case = load_case(beside(tmp_path, 'file = "current.csv"', content="# tide\n" + TIDE))
    assert at(case, 0.0, -50.0).tolist() == [[0.5, 0.0, 0.0]] * 2
    assert at(case, -1.0, time=900.0)[0] == pytest.approx([0.55, 0.025, 0.0])
    assert at(case, -1.0, time=5400.0)[0] == pytest.approx([0.45, 0.05, 0.05])
    assert case.current.flow().uniform and not case.current.flow().steady
    later = load_case(beside(tmp_path, 'file = "current.csv"\nat = "1.5 h"'))
    assert later.current.at_surface == pytest.approx((0.45, 0.05, 0.05))
    assert all(word in later.current.described for word in ("current.csv", "5400 s", "3 times", "7200 s"))


def test_series_by_depth_with_a_ramp_at_mid_times(tmp_path):
    solve = DYNAMIC.replace("100", "40")
    text = 'file = "current.csv"\nat = 20\nramp = "10 s"'
    case = load_case(beside(tmp_path, text, content=SHEAR, rest=REST + solve))
    # 5 s into the run it is 25 s in the file, 5/12 of the way; 1 m is a quarter of the way down; the ramp is at 1/2.
    top, bottom = np.array([0.8 + 0.2 * 5 / 12, 0.0]), np.array([0.4 + 0.2 * 5 / 12, 0.2 + 0.4 * 5 / 12])
    assert at(case, -1.0, time=5.0)[0, :2] == pytest.approx(0.5 * (0.75 * top + 0.25 * bottom))
    assert at(case, -9.0, time=12.0)[0] == pytest.approx([0.4 + 0.2 * 32 / 60, 0.2 + 0.4 * 32 / 60, 0.0])
    assert not at(case, -1.0, time=0.0).any()


def test_file_of_one_time_is_steady_at_all_times(tmp_path):
    content = "time,depth,u,v\n0,0,0.8,0\n0,4,0.4,0.2\n"
    case = load_case(beside(tmp_path, 'file = "current.csv"', content=content, rest=REST + DYNAMIC))
    assert case.current.flow().steady
    assert at(case, -2.0, time=1e6)[0] == pytest.approx([0.6, 0.1, 0.0])


def test_times_since_1970_keep_their_digits(tmp_path):
    rows = "".join(f"{1.7e9 + 0.25 * i:.2f},{0.1 * i},0\n" for i in range(5))
    series = read_current(beside(tmp_path, "", content="time,u,v\n" + rows).with_name("current.csv"))
    assert np.array_equal(np.diff(series.times), [0.25] * 4)


def test_file_that_changes_is_read_again(tmp_path):
    file = beside(tmp_path, 'file = "current.csv"', content=TIDE)
    assert load_case(file).current.at_surface == (0.5, 0.0, 0.0)
    (tmp_path / "current.csv").write_text(TIDE.replace("0,0.5,0,0", "0,0.25,0,0"))
    assert load_case(file).current.at_surface == (0.25, 0.0, 0.0)


# netCDF


def write_netcdf(file, *, changes=(), drop=()):
    """Times 10 and 40 minutes after a date, depths 0, 2 and 6 m; u packed as whole cm/s, v along depth, time, place."""
    u = np.array([[80, 40, 20], [100, 60, -20]], dtype="i2")
    v = np.array([[0.0, 0.3], [0.1, 0.2], [0.4, 0.0]])[..., None]
    variables = {
        "time": (("time",), np.array([10, 40], dtype="i4"), {"units": "minutes since 2024-05-01 00:00"}),
        "depth": (("level",), np.array([0.0, 2.0, 6.0], dtype="f4"), {"units": "m", "positive": "down"}),
        "u": (("time", "level"), u, {"units": "m s-1", "scale_factor": 0.01, "_FillValue": np.int16(-999)}),
        "v": (("level", "time", "place"), v, {"units": "m/s"}),
    }
    variables |= dict(changes)
    with h5netcdf.File(file, "w") as new:
        new.dimensions = {"time": 2, "level": 3, "place": 1, "other": 2}
        for name, (dims, values, attributes) in variables.items():
            if name not in drop:
                packed = attributes.pop("_FillValue", None)
                variable = new.create_variable(name, dims, data=np.asarray(values), fillvalue=packed)
                for key, value in attributes.items():
                    variable.attrs[key] = value


def test_netcdf_written_by_hand(tmp_path):
    write_netcdf(tmp_path / "current.nc")
    case = load_case(beside(tmp_path, 'file = "current.nc"'))
    assert at(case, 0.0, -2.0, -6.0) == pytest.approx(np.array([[0.8, 0, 0], [0.4, 0.1, 0], [0.2, 0.4, 0]]))
    # 15 of the 30 minutes later; 4 m is half way from 2 m to 6 m.
    assert at(case, -4.0, time=900.0)[0] == pytest.approx([0.25, 0.175, 0.0])
    series = read_current(tmp_path / "current.nc")
    assert series.times.tolist() == [0.0, 1800.0] and series.depths.tolist() == [0.0, 2.0, 6.0]


def test_netcdf_of_the_old_format_without_depth(tmp_path):
    with netcdf_file(tmp_path / "current.nc", "w") as new:
        new.createDimension("t", 3)
        for name, values, units in (
            ("time", [100.0, 160.0, 220.0], b"s"),
            ("u", [10.0, 20.0, 40.0], b"cm/s"),
            ("v", [0.0, 0.0, 5.0], b"cm s-1"),
            ("w", [0.0, 0.01, 0.0], b"m s-1"),
        ):
            variable = new.createVariable(name, "d", ("t",))
            variable[:] = values
            variable.units = units
    case = load_case(beside(tmp_path, 'file = "current.nc"\nat = "130 s"'))
    assert at(case, -3.0) == pytest.approx(np.array([[0.15, 0.0, 0.005]]))
    assert case.current.flow().uniform


TWO = ("time", "level")
GRID = np.full((2, 3), 0.1)
SPOILT_NETCDF = {
    "no u": ({"drop": ("u",)}, ("", "no variable u; there are: ", "time, u, v", "rename")),
    "no time": ({"drop": ("time",)}, ("", "no variable time", "time, u, v", "rename")),
    "no units": (
        {"changes": {"u": (TWO, GRID, {})}},
        ("variable u", "no attribute units", '"m s-1"', "units"),
    ),
    "speed in knots": (
        {"changes": {"u": (TWO, GRID, {"units": "kn"})}},
        ("variable u", 'units "kn"', '"m s-1"', "its attribute units"),
    ),
    "time in months": (
        {"changes": {"time": (("time",), [0.0, 1.0], {"units": "months since 2024-01-01"})}},
        ("variable time", "months", "seconds since", "its attribute units"),
    ),
    "depth in fathoms": (
        {"changes": {"depth": (("level",), [0.0, 2.0, 6.0], {"units": "fathom"})}},
        ("variable depth", "fathom", '"m"', "its attribute units"),
    ),
    "height instead of depth": (
        {"changes": {"depth": (("level",), [0.0, 2.0, 6.0], {"units": "m", "positive": "up"})}},
        ("variable depth", 'positive = "up"', "downwards", 'positive = "down"'),
    ),
    "depths upwards": (
        {"changes": {"depth": (("level",), [0.0, -2.0, -6.0], {"units": "m"})}},
        ("variable depth, value 2", "-2", "downwards", "downwards"),
    ),
    "depths unsorted": (
        {"changes": {"depth": (("level",), [2.0, 0.0, 6.0], {"units": "m"})}},
        ("variable depth, value 2", "0 after 2", "rise", "sort"),
    ),
    "times twice": (
        {"changes": {"time": (("time",), [5.0, 5.0], {"units": "s"})}},
        ("variable time, value 2", "5 after 5", "rise", "once"),
    ),
    "several places": (
        {"changes": {"u": (("time", "level", "other"), np.full((2, 3, 2), 0.1), {"units": "m/s"})}},
        ("variable u", "other (2)", "on time, level", "choose one value of other"),
    ),
    "not by depth": (
        {"changes": {"u": (("time",), [0.1, 0.2], {"units": "m/s"})}},
        ("variable u", "on time (2)", "on time, level", "give u along level"),
    ),
    "depths on the times": (
        {"changes": {"depth": (("time",), [1.0, 2.0], {"units": "m"})}},
        ("variable depth", "on time (2)", "of its own", "one set of times and one of depths"),
    ),
    "texts": (
        {"changes": {"u": (TWO, np.full((2, 3), b"x"), {"units": "m/s"})}},
        ("variable u", "6 values", "numbers", "numbers"),
    ),
    "gap": (
        {"changes": {"u": (TWO, np.array([[0.1] * 3, [0.1, np.nan, 0.1]]), {"units": "m/s"})}},
        ("variable u, time 1800 s, depth 2 m", "no value", "-100 to 100 m/s", "fill the gap"),
    ),
    "far too fast": (
        {"changes": {"u": (TWO, np.array([[0.1] * 3, [0.1, 0.1, 9999.0]]), {"units": "m/s"})}},
        ("variable u, time 1800 s, depth 6 m", "9999", "-100 to 100 m/s", "correct"),
    ),
}


@pytest.mark.parametrize(("how", "pieces"), SPOILT_NETCDF.values(), ids=SPOILT_NETCDF)
def test_wrong_netcdf(how, pieces, tmp_path):
    write_netcdf(tmp_path / "current.nc", changes=how.get("changes", {}).items(), drop=how.get("drop", ()))
    file = beside(tmp_path, 'file = "current.nc"')
    problem = problems_of(lambda: load_case(file))[0]
    parts = (problem.where, problem.found, problem.allowed, problem.cure)
    assert all(piece in part for piece, part in zip(pieces, parts, strict=True)), problem


def test_gap_of_a_packed_netcdf_is_one(tmp_path):
    packed = np.array([[80, 40, 20], [100, -999, 20]], dtype="i2")
    attributes = {"units": "m s-1", "scale_factor": 0.01, "_FillValue": np.int16(-999)}
    write_netcdf(tmp_path / "current.nc", changes=[("u", (TWO, packed, attributes))])
    (problem,) = problems_of(lambda: read_current(tmp_path / "current.nc"))
    assert "depth 2 m" in problem.where and problem.found == "no value"


@pytest.mark.parametrize("content", [b"", b"hello", b"CDF\x01broken", b"\x89HDF\r\n\x1a\nbroken"])
def test_broken_netcdf_is_one_problem(content, tmp_path):
    (tmp_path / "current.nc").write_bytes(content)
    (problem,) = problems_of(lambda: read_current(tmp_path / "current.nc"))
    assert "cannot be read" in problem.found and "netCDF" in problem.allowed and "\n" not in problem.found


def test_netcdf_is_judged_by_the_sea_bed(tmp_path):
    write_netcdf(tmp_path / "current.nc")
    (problem,) = problems_of(lambda: read_current(tmp_path / "current.nc", 5.0))
    assert "variable depth, value 3" in problem.where and "sea bed at 5 m" in problem.allowed


# Wrong inputs

# keys of [current], then a piece of where, found, allowed and cure
SPOILT = {
    "nothing": ("", ("[current] velocity", "nothing", "speed and direction, or a file", "velocity = [0.5")),
    "only a ramp": ("ramp = 3", ("[current] velocity", "nothing", "or a file", "velocity = [0.5")),
    "misspelled": (
        "velosity = [1, 0, 0]",
        ("velosity", "unknown key", "velocity", "did you mean 'velocity'?"),
    ),
    "two ways": (
        'velocity = [1, 0, 0]\nspeed = 1\ndirection = "0 deg"',
        (
            "line 6, [current] speed",
            "both velocity and speed and direction",
            "velocity, or",
            "leave out speed",
        ),
    ),
    "no direction": ("speed = 1", ("[current] direction", "speed without direction", "and", '"15 deg"')),
    "no speed": ('direction = "1 rad"', ("[current] speed", "direction without speed", "and", "speed = 0.5")),
    "bare angle": (
        "speed = 1\ndirection = 15",
        ("line 6, [current] direction", "15", "an angle", 'in quotes: "15 deg" or "15 rad"'),
    ),
    "angle in minutes": (
        'speed = 1\ndirection = "15 min"',
        ("direction", "15 min", "deg, rad", "unit of time"),
    ),
    "angle of many turns": (
        'speed = 1\ndirection = "9999 deg"',
        ("direction", "9999", "10 rad", "check the unit"),
    ),
    "negative speed": ('speed = -1\ndirection = "0 deg"', ("speed", "-1", "from 0", "minus sign")),
    "unknown profile": (
        'profile = { kind = "tabel" }',
        ("[current] profile.kind", '"tabel"', '"power" or "layers" or "table"', 'did you mean "table"?'),
    ),
    "profile without kind": (
        "profile = { exponent = 0.1 }\nvelocity = [1, 0, 0]",
        ("[current] profile", "exponent", '"power"', "say which kind"),
    ),
    "power law without velocity": (
        'profile = { kind = "power", exponent = 0.1 }',
        ("[current] velocity", "nothing", "velocity", "velocity = [0.5"),
    ),
    "exponent below 0": (
        'velocity = [1, 0, 0]\nprofile = { kind = "power", exponent = -0.1 }',
        ("profile.exponent", "-0.1", "0 to 10", "minus sign"),
    ),
    "table and velocity": (
        TABLE + "\nvelocity = [1, 0, 0]",
        ("line 6, [current] velocity", 'kind "table"', "power law", "leave velocity out"),
    ),
    "table without velocities": (
        'profile = { kind = "table", depth = [0, 1] }',
        ("profile.velocity", "nothing", "for every depth", "velocity = [["),
    ),
    "table with both": (
        TABLE.replace(" }", ", speed = [1, 1] }"),
        ("profile.velocity", "beside speed", "or speed and direction", "leave out"),
    ),
    "table without directions": (
        'profile = { kind = "table", depth = [0, 1], speed = [1, 2] }',
        ("profile.direction", "without direction", "and", '["15 deg", ...]'),
    ),
    "too few velocities": (
        TABLE.replace("[0, 10]", "[0, 5, 10]"),
        ("profile.velocity", "2 beside 3 depths", "every depth", "as many"),
    ),
    "too few directions": (
        'profile = { kind = "table", depth = [0, 1], speed = [1, 2], direction = ["1 deg"] }',
        ("profile.direction", "1 beside 2 depths", "every depth", "as many"),
    ),
    "two components": (
        TABLE.replace("[0.3, 0.1, 0]", "[0.3, 0.1]"),
        ("profile.velocity, value 2, value 3", "[0.3, 0.1]", "three components", "velocity = [["),
    ),
    "depths unsorted": (TABLE.replace("[0, 10]", "[10, 0]"), ("profile.depth", "[10, 0]", "rise", "sort")),
    "depth twice": (TABLE.replace("[0, 10]", "[1, 1]"), ("profile.depth", "[1, 1]", "rise", "once")),
    "height for a depth": (
        TABLE.replace("10]", "-10]"),
        ("profile.depth, value 2", "-10", "from 0", "leave out the minus sign"),
    ),
    "no depth": (TABLE.replace("[0, 10]", "[]"), ("profile.depth", "[]", "a list", "depth = [")),
    "nan": (TABLE.replace("0.3", "nan"), ("profile.velocity, value 2, value 1", "nan", "-100", "number")),
    "start without a file": (
        "velocity = [1, 0, 0]\nat = 3",
        ("[current] at", "3", "with a file", "leave at out"),
    ),
    "file beside velocity": (
        'file = "current.csv"\nvelocity = [1, 0, 0]',
        ("[current] velocity", "both velocity and file", "alone", "leave out velocity"),
    ),
    "file beside a profile": (
        'file = "current.csv"\n' + TABLE,
        ("[current] profile", "both profile and file", "alone", "leave out profile"),
    ),
    "no such file": (
        'file = "no.csv"',
        ("no.csv", "no such file", "CSV or netCDF", "folder of the case file"),
    ),
    "folder for a file": ('file = "."', ("", "no plain file", "CSV or netCDF", "check the name")),
    "name that no file can have": ('file = "a\\u0000b"', ("", "cannot be read", "CSV", "check the name")),
    "ramp of no time": (
        "velocity = [1, 0, 0]\nramp = 0",
        ("[current] ramp", "0", "a time above 0", "above 0"),
    ),
    "start after the file": (
        'file = "current.csv"\nat = "3 h"',
        ("[current] at", "without the times asked for", "current.csv has: 0 to 7200 s", "begin at a time"),
    ),
    "start before the file": (
        'file = "current.csv"\nat = -1',
        ("[current] at", "without the times asked for", "0 to 7200 s", "begin at a time"),
    ),
}


@pytest.mark.parametrize(("current", "pieces"), SPOILT.values(), ids=SPOILT)
def test_wrong_input(current, pieces, tmp_path):
    file = beside(tmp_path, current, content=TIDE, water="depth = 20")
    (problem,) = problems_of(lambda: load_case(file))
    parts = (problem.where, problem.found, problem.allowed, problem.cure)
    assert all(piece in part for piece, part in zip(pieces, parts, strict=True)), problem


def test_power_law_without_a_sea_bed():
    (problem,) = problems_of(
        lambda: case_of_text('speed = 1\ndirection = "0 deg"\nprofile = { kind = "power", exponent = 0.1 }')
    )
    assert "[water] depth" in problem.where and problem.found == "nothing"
    assert "sea bed" in problem.allowed and problem.cure == "add depth = 20.0 to [water]"


def test_run_beyond_the_file(tmp_path):
    rest = REST + DYNAMIC.replace("100", '"2 h"')
    file = beside(tmp_path, 'file = "current.csv"\nat = "1 h"', content=TIDE, rest=rest)
    (problem,) = problems_of(lambda: load_case(file))
    assert "[solve] duration" in problem.where and "7200 s from 3600 s on, to 10800 s" in problem.found
    assert "without the times asked for" in problem.found and "0 to 7200 s" in problem.allowed
    file = beside(tmp_path, 'file = "current.csv"', content=TIDE, rest=rest)
    assert load_case(file).current.flow().times[-1] == 7200.0  # to its very end is fine


# content of the CSV file, then a piece of where, found, allowed and cure
SPOILT_CSV = {
    "empty": ("", ("row 1", "no names of columns", "time,u,v,w or", "first row")),
    "columns": ("t,u,v\n0,1,2\n", ("row 1", "t,u,v", "time,depth,u,v,w", "name the columns")),
    "column missing": ("time,depth,u\n0,1,2\n", ("row 1", "time,depth,u", "time,u,v,w", "name the columns")),
    "semicolons": ("time;u;v\n0;1;2\n", ("row 1", "time;u;v", "time,u,v,w", "commas")),
    "no rows": ("time,u,v,w\n", ("current.csv", "no row of numbers", "one or more", "add the velocities")),
    "cell missing": ("time,u,v\n0,1,2\n9,1\n", ("row 3", "2 values", "3 values", "time,u,v")),
    "empty cell": (
        "time,u,v\n0,1,\n",
        ("row 2, column v", "an empty cell", "-100 to 100", "leave out the row"),
    ),
    "nan": ("time,u,v\n0,nan,1\n", ("row 2, column u", "'nan'", "-100 to 100", "correct")),
    "mark for a gap": ("time,u,v\n0,-9999,1\n", ("row 2, column u", "'-9999'", "-100 to 100", "correct")),
    "text": ("# x\ntime,u,v\n0,fast,1\n", ("row 3, column u", "'fast'", "-100 to 100", "correct")),
    "unsorted": (
        "time,u,v\n9,1,1\n0,1,1\n",
        ("row 3", "time 0 after time 9", "rising time", "sort the rows"),
    ),
    "twice": (
        "time,u,v\n9,1,1\n9,1,1\n",
        ("row 3", "time 9 after time 9", "rising time", "one row for each"),
    ),
    "height": ("time,depth,u,v\n0,-3,1,1\n", ("row 2, column depth", "'-3'", "downwards", "correct")),
    "gap": (
        SHEAR.replace("60,0,1.0,0\n", ""),
        ("current.csv", "no row for time 60 s at depth 0 m", "every depth at every time", "add the rows"),
    ),
    "below the bed": (
        SHEAR.replace(",4,", ",14,"),
        ("row 3, column depth", "14 m", "sea bed at 12 m", "check [water] depth"),
    ),
}


@pytest.mark.parametrize(("content", "pieces"), SPOILT_CSV.values(), ids=SPOILT_CSV)
def test_wrong_csv(content, pieces, tmp_path):
    file = beside(tmp_path, 'file = "current.csv"', water="depth = 12")
    (tmp_path / "current.csv").write_text(content)
    (problem,) = problems_of(lambda: load_case(file))
    parts = (problem.where, problem.found, problem.allowed, problem.cure)
    assert all(piece in part for piece, part in zip(pieces, parts, strict=True)), problem


def test_all_that_is_wrong_with_file_and_case_is_told_at_once(tmp_path):
    content = "time,depth,u,v\n0,0,nan,0\n0,4,1\n-5,0,1,200\n"
    file = beside(
        tmp_path, 'file = "current.csv"\nspeed = 3', content=content, rest=REST.replace('"PA"', '"P"')
    )
    where = [problem.where.rpartition("current.csv, ")[2] for problem in problems_of(lambda: load_case(file))]
    assert where[:3] == ["row 2, column u", "row 3", "row 4, column v"], where
    assert "[current] speed" in where[3] and "[twine.main] material" in where[4] and len(where) == 5


def test_a_file_full_of_gaps_is_told_in_short(tmp_path):
    (tmp_path / "c.csv").write_text("time,u,v\n" + "".join(f"{i},nan,0\n" for i in range(500)))
    problems = problems_of(lambda: read_current(tmp_path / "c.csv"))
    assert (
        len(problems) == MOST_PROBLEMS + 1 and problems[-1].found == f"{500 - MOST_PROBLEMS} more like these"
    )


def test_profile_and_gear_below_the_sea_bed():
    problems = problems_of(lambda: case_of_text(TABLE, water="depth = 5"))
    assert "[current] profile.depth, value 2" in problems[0].where and "bed at 5 m" in problems[0].allowed
    assert "[[gear]] 1 centre" in problems[1].where and "z = -5.096 m" in problems[1].found
    assert "z = -5 m" in problems[1].allowed and "[water] depth" in problems[1].cure
    assert len(problems) == 2
    assert case_of_text("velocity = [1, 0, 0]", water="depth = 5.0961").water.depth == 5.0961
    # Lying flat it is no deeper than its centre; square to x or to y makes no difference.
    flat = REST.replace('fixed = "edges"', 'fixed = "edges"\nnormal = [0, 0, 1]')
    assert case_of_text("velocity = [1, 0, 0]", flat, water="depth = 5.0001").warnings == ()
    with pytest.raises(CaseError, match=r"5\.096"):
        case_of_text("velocity = [1, 0, 0]", flat.replace("[0, 0, 1]", "[0, 3, 0]"), water="depth = 5")


# What others see of it


def test_check_says_the_current_in_a_line(tmp_path):
    findings = judge(load_case(beside(tmp_path, 'file = "current.csv"\nat = 30', content=SHEAR)))
    assert findings["current"] == pytest.approx([0.9, 0.0, 0.0]) and json.dumps(findings)
    assert findings["current_words"].startswith("at the surface at 30 s of current.csv: 2 times")
    assert judge(case_of_text("velocity = [1, 0, 0]"))["current_words"] == ""


def test_knobs_move_one_velocity_only(tmp_path):
    def speeds(current):
        return [knob for knob in knobs_of(case_of_text(current)) if knob.group == "Current"]

    speed, direction, _ = speeds('speed = 0.5\ndirection = "30 deg"')
    assert (speed.value, direction.value) == (0.5, pytest.approx(30.0))
    assert speeds(TABLE) == []
    case = case_of_text('speed = 0.5\ndirection = "30 deg"')
    knobs = knobs_of(case)
    values = {knob.key: knob.value for knob in knobs} | {"current.speed": 2.0}
    written = turned({"current": {"speed": 0.5, "direction": "30 deg"}}, knobs, values)
    assert written == {"current": {"velocity": pytest.approx([math.sqrt(3.0), 1.0, 0.0])}}


def test_live_page_shows_the_shape_at_full_strength():
    study = Study(text_of('velocity = [0.5, 0, 0]\nramp = "10 s"', REST + DYNAMIC))
    assert study.system.current == UniformCurrent((0.5, 0.0, 0.0))
    assert study.result.outcome.ok and study.numbers.drag > 0.1


def test_drag_of_a_sheared_panel_is_that_of_the_current_at_its_depth():
    """A table straight in depth pulls more than the uniform current at its middle, by the mean of its square."""
    rest = REST.replace('material = "PA"', 'density = 1140\nyoungs_modulus = "2 GPa"')

    def drag(current):
        case = case_of_text(current, rest)
        system = build_system(build_net(case), case)
        return solve_static(system).hydrodynamic_force[-1]

    # The speed is 0.4 (1 + s) with s from -0.06 to 0.06 over the height of 0.192 m: its mean square is 1 + 0.06^2 / 3.
    table = 'profile = { kind = "table", depth = [4.5, 5.5], velocity = [[0.525, 0, 0], [0.275, 0, 0]] }'
    sheared, even = drag(table), drag("velocity = [0.4, 0, 0]")
    assert sheared[0] / even[0] - 1.0 == pytest.approx(0.06**2 / 3, rel=0.05)


def test_result_whose_file_is_gone_is_shown_without_its_case(tmp_path, monkeypatch):
    file = beside(tmp_path, 'file = "current.csv"', content=TIDE)
    case = load_case(file)
    result = solve_static(build_system(build_net(case), case))
    monkeypatch.chdir(tmp_path)
    assert case_of(result).current.at_surface == (0.5, 0.0, 0.0)
    save(result, tmp_path / "result.nc")
    os.remove(tmp_path / "current.csv")
    assert case_of(result) is None
    assert report_result(tmp_path / "result.nc", tmp_path / "r.html", None, overwrite=False) == 0
    assert LOST in (tmp_path / "r.html").read_text().replace("&#39;", "'")
    with pytest.raises(CaseError, match="no such file"):
        recorded_case(result.case_text).current.flow()


def test_flow_is_of_the_right_kind_for_every_key(tmp_path):
    case = load_case(
        beside(
            tmp_path,
            'file = "current.csv"\nramp = 3',
            content=SHEAR,
            rest=REST + DYNAMIC.replace("100", "60"),
        )
    )
    flow = case.current.flow()
    assert isinstance(flow, RampedCurrent) and isinstance(flow.full, SeriesCurrent)


# Anything at all

VALUES = [
    "-1", "0", "3", "1e308", "nan", "true", '""', '"15 deg"', '"3 h"', '"table"', "[]", "[0, 5]", "[5, 0]",
    "[1, 2, 3]", "[[1, 0, 0], [0, 1, 0]]", "[[]]", '["0 deg", "9 deg"]', "{}", '"current.csv"', '"a.nc"', '"/"',
]  # fmt: skip
KEYS = ["velocity", "speed", "direction", "file", "ramp", "at", "profile", "profil"]
INNER = ["kind", "exponent", "depth", "velocity", "speed", "direction", "x"]
kinds = st.sampled_from(['"power"', '"layers"', '"table"', '"x"', "3"])
inner = st.dictionaries(st.sampled_from(INNER), st.sampled_from(VALUES), max_size=4)
profiles = st.tuples(kinds, inner).map(
    lambda one: "{ " + ", ".join(f"{k} = {v}" for k, v in ({"kind": one[0]} | one[1]).items()) + " }"
)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.dictionaries(st.sampled_from(KEYS), st.sampled_from(VALUES) | profiles, max_size=5),
    st.sampled_from(["", "depth = 20", "depth = 1", 'depth = "x"', "depth = nan"]),
    st.sampled_from(["", DYNAMIC, '[solve]\nkind = "dynamic"\nduration = "x"\n']),
)
def test_no_current_gives_a_traceback(keys, water, solve):
    text = text_of("\n".join(f"{key} = {value}" for key, value in keys.items()), REST + solve, water)
    try:
        case = parse_case(text)
    except CaseError as error:
        assert error.problems
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
    else:
        assert isinstance(case, Case)
        velocity = case.current.flow().velocity(np.array([[0.0, 0.0, -3.0]]), 1.0)
        assert np.all(np.isfinite(velocity)) and len(case.current.at_surface) == 3


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.text(max_size=80)
    | st.integers(0, 60).flatmap(
        lambda i: st.text("0159.,-nae\n", max_size=6).map(lambda t: SHEAR[:i] + t + SHEAR[i + 2 :])
    )
)
def test_no_csv_gives_a_traceback(tmp_path, content):
    file = tmp_path / "current.csv"
    file.write_text(content, encoding="utf-8", errors="replace")
    try:
        series = read_current(file)
    except CaseError as error:
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
    else:
        assert np.all(np.isfinite(series.velocities))
