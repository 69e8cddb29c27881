"""What a run tells of the water: waves, shelter, dry bars, the direction of drag, sources, and what does not fit."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.report.figures import figures_of
from fyke.report.gltf import write_gltf
from fyke.report.quantities import QUANTITIES, quantities
from fyke.results import flow_direction, mean_current, probes_of, water_figures
from fyke.water import LayerCurrent, RampedCurrent, SeriesCurrent
from fyke.water.laws import Range
from fyke.water.laws.bars import White
from fyke.water.waves import airy
from reference import panel_case

SIDE = 0.11
KNOTS = 'knot_diameter = "3.5 mm"'
DYNAMIC = "[solve]\nkind = 'dynamic'\nduration = 0.4\n[output]\nevery = 0.02\nprobes = [[0.2, 0.0, -0.5]]\n"
AIRY = "[waves]\nkind = 'airy'\nheight = 0.1\nperiod = 2.0\ndirection = '90 deg'\n"
STILL = "velocity = [0.0, 0.0, 0.0]"
TWO = """
[[gear]]
kind = "panel"
netting = "main"
meshes = [3, 3]
size = [0.11, 0.11]
centre = [0.5, 0.0, -0.5]
"""


def panel(more: str = "", *, current: str = "", place: str = "centre = [0.0, 0.0, -0.5]") -> str:
    """Case of 3 x 3 meshes on a frame of 0.11 m; place: keys of the gear; current: its key."""
    text = panel_case(3, SIDE, knots=KNOTS, more=f"{place}\n{more}")
    return text.replace("velocity = [0.5, 0.0, 0.0]", current) if current else text


def built(text: str) -> fyke.System:
    case = fyke.parse_case(text)
    return fyke.build_system(fyke.build_net(case), case)


def run(folder: Path, text: str, *options: str):
    """Run a case file in a folder; an exception that is no orderly exit fails the test."""
    (folder / "net.toml").write_text(text)
    command = ["run", str(folder / "net.toml"), "-o", str(folder / "net"), "--overwrite", *options]
    return CliRunner().invoke(app, command, catch_exceptions=False)


@pytest.fixture(scope="module")
def waved(tmp_path_factory):
    """A run in waves towards +y without a current."""
    folder = tmp_path_factory.mktemp("waves")
    done = run(folder, panel(AIRY + DYNAMIC, current=STILL))
    assert done.exit_code == 0, done.output
    return folder / "net", done.stdout


def test_a_run_in_waves_writes_their_motion_and_draws_it(waved):
    folder, shown = waved
    with (folder / "waves.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["time"]) for row in rows] == pytest.approx(0.02 * np.arange(21))
    # Deep water: u = pi H / T e^(k (z - eta)) cos(omega t) towards +y at x = 0.2, y = 0.
    omega = math.pi
    k = omega**2 / 9.81
    for row in rows:
        eta = 0.05 * math.cos(omega * float(row["time"]))
        across = 0.05 * omega * math.exp(k * (-0.5 - eta)) * math.cos(omega * float(row["time"]))
        assert float(row["elevation"]) == pytest.approx(eta, abs=1e-12)
        assert [float(row["u"]), float(row["v"])] == pytest.approx([0.0, across], abs=1e-12)
    assert (folder / "waves.png").stat().st_size > 5000 and (folder / "waves.svg").exists()
    assert "bars.csv, parts.csv, waves.csv" in shown and "airy, 0.1 m, 2 s, towards 90 deg" in shown
    assert max(map(len, shown.splitlines())) <= 80


def test_its_summary_tells_the_waves_and_drag_goes_along_them(waved):
    folder, shown = waved
    told = json.loads((folder / "summary.json").read_text())
    assert told["waves"] == {
        "kind": "airy",
        "height": 0.1,
        "period": 2.0,
        "direction": pytest.approx([0.0, 1.0, 0.0], abs=1e-15),
    }
    assert "shelter" not in told and "wet" not in told
    assert told["drag"] == pytest.approx(told["hydrodynamic_force"][1])
    words = " ".join(shown.split())
    assert "energy in current and waves" in words and "inertia of the water" in words


def test_what_energy_went_in_is_what_is_told_to_have_come_out(waved):
    energy = json.loads((waved[0] / "summary.json").read_text())["audit"]["energy"]
    given = energy["current_work"] - energy["potential"] + energy["added_mass_work"] + energy["inertia_work"]
    taken = energy["drag_dissipation"] + energy["twine_dissipation"] + energy["kinetic"] + energy["elastic"]
    assert given == pytest.approx(taken + energy["remainder"], rel=1e-9)


def test_the_report_and_the_film_of_a_run_in_waves(waved, tmp_path):
    folder, _ = waved
    told = CliRunner().invoke(app, ["report", str(folder), "--overwrite"], catch_exceptions=False)
    assert told.exit_code == 0, told.output
    page = (folder / "report.html").read_text(encoding="utf-8")
    for words in (
        'id="figure-waves"',
        "Waves</dt><dd>airy, 0.1 m, 2 s",
        "G.B. Airy",
        "Work of current and waves",
    ):
        assert words in page
    result = fyke.load(folder / "result.nc")
    assert [one.key for one in quantities(result)] == ["tension", "strain", "velocity", "angle"]
    for colour in QUANTITIES:
        assert write_gltf(result, tmp_path / f"{colour}.glb", colour=colour).stat().st_size > 1000


def test_a_later_run_without_waves_leaves_none_of_theirs(tmp_path):
    assert run(tmp_path, panel(AIRY + DYNAMIC), "--quiet").exit_code == 0
    assert (tmp_path / "net" / "waves.csv").exists() and (tmp_path / "net" / "waves.svg").exists()
    assert run(tmp_path, panel(), "--quiet").exit_code == 0
    assert not list((tmp_path / "net").glob("waves.*"))


def test_a_static_case_has_no_waves_at_all(tmp_path):
    text = panel(AIRY)
    assert built(text).waves is None and not any("waves" in one for one in built(text).sources)
    told = json.loads(run(tmp_path, text, "--json", "--no-figures").stdout)
    assert "waves" not in told and told["warnings"][0].startswith("[waves] plays no part in a static case")
    still = json.loads(run(tmp_path, panel(), "--json", "--no-figures").stdout)
    assert told["hydrodynamic_force"] == still["hydrodynamic_force"]
    assert not (tmp_path / "net" / "waves.csv").exists()


def test_check_tells_the_shelter(tmp_path):
    file = tmp_path / "net.toml"
    for wake, word in (("0.8", "0.8"), ("'cheng'", "cheng")):
        file.write_text(panel(f"[shelter]\nwake = {wake}\ntwines = 'cheng'\n"))
        told = json.loads(
            CliRunner().invoke(app, ["check", str(file), "--json"], catch_exceptions=False).stdout
        )
        assert told["shelter"] == {"wake": word, "twines": "cheng"}
        shown = CliRunner().invoke(app, ["check", str(file)], catch_exceptions=False).stdout
        assert f"wake: {word}, twines: cheng" in shown
    file.write_text(panel())
    assert "shelter" not in CliRunner().invoke(app, ["check", str(file)], catch_exceptions=False).stdout


def test_shelter_is_told_with_its_smallest_and_mean_factor(tmp_path):
    told = json.loads(run(tmp_path, panel(TWO + "[shelter]\nwake = 0.8\n"), "--json", "--no-figures").stdout)
    # The knots of the second panel have 0.8 of the current, those of the first all of it, as many as they are.
    assert told["shelter"] == {"smallest": pytest.approx(0.8), "mean": pytest.approx(0.9)}
    shown = " ".join(run(tmp_path, panel(TWO + "[shelter]\nwake = 0.8\n"), "--no-figures").stdout.split())
    assert "current left by shelter 0.9 of it in the mean, 0.8 at least" in shown
    result = fyke.load(tmp_path / "net" / "result.nc")
    speed = QUANTITIES["velocity"].values(result, 0)
    assert speed[:36] == pytest.approx(0.5) and speed[36:] == pytest.approx(0.4)


def test_dry_bars_are_counted(tmp_path):
    # The middle of the panel lies at the surface: bars of the upper half are dry, none lies level.
    system = built(panel(place="centre = [0.0, 0.0, 0.0]"))
    flat = replace(fyke.solve_static(system), position=system.net.positions[None])
    told = water_figures(system, flat)["wet"]
    z = np.sort(system.net.positions[system.net.bars][:, :, 2], axis=1)
    radius = 0.75e-3
    assert told["dry_bars"] == np.count_nonzero(z[:, 0] >= radius) > 0
    assert told["partly_dry_bars"] == np.count_nonzero((z[:, 0] < radius) & (z[:, 1] > -radius)) > 0
    endless = replace(system, surface=False)
    assert "wet" not in water_figures(endless, flat)


def test_drag_goes_along_the_mean_current_over_the_net_at_full_strength():
    net = built(panel()).net  # z from -0.555 to -0.445 m
    middle = -0.5 + 1e-9
    layers = LayerCurrent(np.array([0.0, -middle]), np.array([[0.6, 0.0, 0.0], [0.0, 0.2, 0.0]]))
    system = fyke.make_system(net, current=layers)
    above = np.count_nonzero(net.positions[:, 2] > middle)
    share = above / net.knot_count
    assert mean_current(system) == pytest.approx([0.6 * share, 0.2 * (1.0 - share), 0.0])
    direction = flow_direction(system)
    assert direction is not None
    assert direction == pytest.approx(mean_current(system) / np.linalg.norm(mean_current(system)))
    ramped = replace(system, current=RampedCurrent(layers, 10.0))
    assert flow_direction(ramped) == pytest.approx(direction)
    tide = SeriesCurrent(
        np.array([0.0, 9.0]), np.array([0.0]), np.array([[[0.1, 0.2, 0.0]], [[-3.0, 0.0, 0.0]]])
    )
    assert mean_current(replace(system, current=tide)) == pytest.approx([0.1, 0.2, 0.0])


def test_drag_has_no_direction_in_still_water_and_that_of_waves_without_a_current():
    net = built(panel()).net
    still = fyke.make_system(net)
    assert flow_direction(still) is None and not mean_current(still).any()
    sea = airy(0.1, 2.0, direction=math.radians(30.0))
    assert flow_direction(fyke.make_system(net, waves=sea)) == pytest.approx([math.sqrt(0.75), 0.5, 0.0])
    with_both = fyke.make_system(net, waves=sea, current=(0.0, -0.2, 0.0))
    assert flow_direction(with_both) == pytest.approx([0.0, -1.0, 0.0])
    # Currents that cancel out leave rounding, which is no direction.
    some = np.arange(net.knot_count - 1)[:, None]
    even = fyke.line(net.twines[0], np.where(some % 2, [0.0, 0.0, -0.4], [0.0, 0.0, -0.6]), 0.2)
    opposed = LayerCurrent(np.array([0.0, 0.5]), np.array([[0.1, 0.3, 0.0], [-0.1, -0.3, 0.0]]))
    assert flow_direction(fyke.make_system(even, current=opposed)) is None


def test_still_water_has_no_velocity_to_show():
    result = fyke.solve_static(built(panel(current=STILL)))
    assert [one.key for one in quantities(result)] == ["tension", "strain"]


def test_angle_and_velocity_are_those_of_the_water_against_the_bar():
    result = fyke.solve_static(built(panel()))
    moving = replace(result, velocity=result.velocity + np.array([0.5, 0.5, 0.0]))
    # The water passes at (0, -0.5, 0): bars of the flat panel lie at 45 deg to it.
    flat = replace(moving, position=result.net.positions[None])
    assert QUANTITIES["velocity"].values(flat, 0) == pytest.approx(0.5)
    assert QUANTITIES["angle"].values(flat, 0) == pytest.approx(45.0)
    with_it = replace(result, velocity=result.velocity + np.array([0.5, 0.0, 0.0]))
    assert QUANTITIES["velocity"].values(with_it, 0) == pytest.approx(0.0, abs=1e-15)


def test_arrows_of_current_and_waves_stand_apart():
    result = fyke.solve_static(built(panel()))
    figure = figures_of(result, current=(0.5, 0.0, 0.0), waves=(0.0, 1.0, 0.0))["initial_position"]
    assert [text.get_text() for text in figure.texts] == ["current, 0.5 m/s", "waves"]
    still = figures_of(result, current=(0.0, 0.0, 0.0))["initial_position"]
    assert not still.texts


def test_probes_need_waves_and_more_than_one_moment(waved):
    result = fyke.load(waved[0] / "result.nc")
    system = built(result.case_text)
    assert probes_of(system, result, [[0.0, 0.0, -1.0]]) is not None
    assert probes_of(replace(system, waves=None), result, [[0.0, 0.0, -1.0]]) is None


@pytest.mark.parametrize("stepper", ["verner", "symplectic"])
def test_explicit_steppers_are_refused_for_screens(stepper):
    text = panel(
        "[drag]\nkind = 'screens'\n" + DYNAMIC.replace("duration", f"stepper = '{stepper}'\nduration")
    )
    with pytest.raises(fyke.CaseError) as told:
        fyke.parse_case(text)
    (problem,) = told.value.problems
    assert "stepper" in problem.where and "implicit" in problem.cure and "newmark" in problem.allowed
    fyke.parse_case(text.replace(stepper, "newmark"))
    fyke.parse_case(text.replace("screens", "bars"))


def test_shelter_that_counts_twice_is_told():
    text = panel("[drag]\nkind = 'screens'\n[shelter]\ntwines = 'cheng'\n")
    assert "counts twice" in fyke.parse_case(text).warnings[0]
    assert fyke.parse_case(text.replace("screens", "bars")).warnings == ()
    assert fyke.parse_case(text.replace("twines = 'cheng'", "wake = 'cheng'")).warnings == ()


@pytest.mark.parametrize(("height", "above"), [(-0.056, 0), (-0.055, 0), (-0.054, 4), (0.0, 11), (1.0, 25)])
def test_knots_above_the_surface_are_counted(height, above):
    """3 x 3 diamonds, 0.11 m high: rows of 4 and 3 knots by turns, at 1/6 of the height."""
    told = fyke.parse_case(panel(place=f"centre = [0.0, 0.0, {height}]")).warnings
    assert len(told) == bool(above)
    if above:
        assert told[0].startswith(f"{above} of 25 knots of the panel begin above the surface")
        assert f"z = {height + 0.055:.4g} m" in told[0]
    tilted = panel(place="centre = [0.0, 0.0, -0.05]\nnormal = [1.0, 0.0, 1.0]")
    assert fyke.parse_case(tilted).warnings == ()  # 0.11 sin 45 / 2 = 0.0389 m above its middle


def test_sources_tell_what_acts_with_parameters_and_how_far_read():
    more = (
        "[drag]\nbars = { law = 'takagi', tangential = 0.05 }\n[shelter]\nwake = 'momentum'\ntwines = 'cheng'\n"
        "[added_mass]\nbars = 'lee'\n" + AIRY + DYNAMIC
    )
    lines = built(panel(more)).sources
    bars = next(one for one in lines if one.startswith("bar drag"))
    assert "tangential = 0.05" in bars and "Takagi" in bars and "the paper was not opened" in bars
    behind = next(one for one in lines if one.startswith("shelter behind netting"))
    assert "Loeland's screen" in behind and "derived" in behind
    assert any(one.startswith("shelter between twines") and "fyke's own step" in one for one in lines)
    assert any(one.startswith("added mass: Lee's") and "from memory" in one for one in lines)
    assert any(one.startswith("waves: airy (G.B. Airy") for one in lines)
    assert any("Wheeler" in one for one in lines) and any("Morison" in one for one in lines)
    screens = built(panel("[drag]\nkind = 'screens'\n")).sources
    assert screens[0].startswith("drag of netting as screens: Kristiansen")
    assert not any(one.startswith(("bar drag", "knot drag", "waves", "shelter")) for one in screens)


def test_a_made_up_law_tells_its_numbers():
    class Narrow(White):
        name, title, source, read = "narrow", "A narrow law", "nobody", "-"
        stated = (Range("Re", 1.0, 2.0),)

    net = built(panel()).net
    (line,) = (
        one
        for one in fyke.make_system(net, coefficients=fyke.Coefficients(bars=Narrow(0.25))).sources
        if one.startswith("bar drag")
    )
    assert line == "bar drag: A narrow law, tangential = 0.25 (nobody)"


def test_laws_of_shelter_and_added_mass_are_listed():
    told = json.loads(CliRunner().invoke(app, ["laws", "--json"], catch_exceptions=False).stdout)
    assert list(told) == ["bars", "knots", "panels", "wakes", "twines", "added_mass"]
    assert [one["name"] for one in told["wakes"]] == ["loland", "momentum", "cheng", "factor"]
    assert told["wakes"][0]["parameters"] == {"panel": "loland"}
    assert told["wakes"][0]["range"] == ["solidity 0.13 to 0.317"]
    assert [one["name"] for one in told["twines"]] == ["cheng"]
    assert [one["name"] for one in told["added_mass"]] == ["constant", "potential-flow", "lee", "table"]
    shown = CliRunner().invoke(app, ["laws"], catch_exceptions=False).stdout
    assert max(map(len, shown.splitlines())) <= 80
    for words in ("Wakes: ", "Twines: ", "Added mass: ", "[shelter] wake"):
        assert words in shown
