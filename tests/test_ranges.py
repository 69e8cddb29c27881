"""Values of a run outside the ranges of its laws: what is counted, and the sentence with value, limit and time."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.netting.panel import panel
from fyke.netting.together import together
from fyke.results.ranges import bar_values, knot_values, moments, out_of_range
from fyke.water.laws import Range
from fyke.water.laws.bars import ConstantBar, Hoerner, KristiansenFaltinsenBar, White
from fyke.water.laws.knots import CliftGauvin, SchillerNaumann
from fyke.water.laws.panels import KristiansenFaltinsen, Loland
from fyke.water.wakes import GivenWake, LolandWake
from fyke.water.waves import airy

NU = 1e-6
PANEL = Path(__file__).parents[1] / "examples" / "panel.toml"
TWINE = fyke.Twine("main", 1140.0, 2e-3, fyke.LinearLaw(1e9))
# One square mesh across x: two bars along y, two along z, and four knots of 4 mm.
MESH = panel(
    TWINE, mesh="square", meshes=(1, 1), bar_length=0.05, size=(0.05, 0.05), knot_diameter=4e-3, fixed="none"
)
REST = np.zeros_like(MESH.positions)
ALONG_Y = np.abs(np.diff(MESH.positions[MESH.bars], axis=1)[:, 0, 1]) > 0.0


def flow(*velocity):
    return np.tile(np.array(velocity, dtype=float), (MESH.knot_count, 1))


@dataclass(frozen=True)
class Given:
    """A current that is the same everywhere: velocity (m/s) of every second."""

    velocities: tuple[tuple[float, float, float], ...]
    steady = False
    uniform = True

    def velocity(self, points, time):
        return np.tile(np.array(self.velocities[int(time)], dtype=float), (len(points), 1))


def in_water(*velocities, net=MESH, **laws):
    """Put a net into water of these velocities, one for each second."""
    c = fyke.Coefficients(**laws)
    return fyke.make_system(net, current=Given(velocities), coefficients=c)


def judged(speeds, **laws):
    """Judge the mesh at rest in currents along x, one at a second each."""
    states = [(float(i), MESH.positions, REST) for i in range(len(speeds))]
    return out_of_range(in_water(*((speed, 0.0, 0.0) for speed in speeds), **laws), states)


def test_reynolds_number_is_that_of_the_speed_across_the_bar():
    # 0.5 m/s at 30 deg to y: 0.25 m/s across the bars along y, all of it across those along z; 2 mm, 1e-6 m2/s.
    water = flow(0.25, 0.5 * np.cos(np.pi / 6.0), 0.0)
    split = bar_values(MESH, MESH.positions, water, ConstantBar(), NU)
    assert split["Re"] == pytest.approx(np.where(ALONG_Y, 500.0, 1000.0), rel=1e-12)
    assert np.degrees(split["angle"]) == pytest.approx(np.where(ALONG_Y, 30.0, 90.0), rel=1e-12)
    # A law of the angle is made for the whole speed.
    assert bar_values(MESH, MESH.positions, water, Hoerner(), NU)["Re"] == pytest.approx(np.full(4, 1000.0))
    assert knot_values(MESH, water, NU)["Re"] == pytest.approx(np.full(4, 2000.0))


def test_nothing_depends_on_where_the_axes_point():
    turn = Rotation.from_euler("xyz", [0.3, 1.1, -2.0]).as_matrix()
    water = np.random.default_rng(3).normal(size=(MESH.knot_count, 3))
    here = bar_values(MESH, MESH.positions, water, ConstantBar(), NU)
    there = bar_values(MESH, MESH.positions @ turn.T, water @ turn.T, ConstantBar(), NU)
    assert all(there[key] == pytest.approx(here[key], rel=1e-9) for key in here)


def test_a_bar_along_the_flow_and_a_knot_in_still_water_are_not_judged():
    values = bar_values(MESH, MESH.positions, flow(0.0, 0.7, 0.0), ConstantBar(), NU)
    assert np.isnan(values["Re"]).tolist() == ALONG_Y.tolist()
    assert values["angle"][ALONG_Y] == pytest.approx(0.0)
    assert np.isnan(knot_values(MESH, flow(0, 0, 0), NU)["Re"]).all()
    assert np.isnan(knot_values(replace(MESH, knot_diameter=np.zeros(4)), flow(1, 0, 0), NU)["Re"]).all()
    assert judged([0.0], bars=White(), knots=SchillerNaumann()).warnings == ()


def test_each_quantity_is_told_once_with_value_limit_how_many_and_when():
    # Re of the bars: 1000, 2e4, 12000, 10; of the law 31.6 to 1e4.
    told = judged([0.5, 10.0, 6.0, 0.005], bars=KristiansenFaltinsenBar())
    assert told.warnings == (
        "drag law 'kristiansen-faltinsen' is used outside its range at 4 of 4 bars: Re = 2e+04, above its limit "
        "of 1e+04, at t = 1 s",
    )
    assert told.counts == {"bars": {"kristiansen-faltinsen": {"Re": 4}}}
    below = judged([0.5, 0.005, 0.01], bars=KristiansenFaltinsenBar())
    assert "Re = 10, below its limit of 31.62, at t = 1 s" in below.warnings[0]
    # An equilibrium has one state and no time.
    assert judged([10.0], bars=KristiansenFaltinsenBar()).warnings[0].endswith("above its limit of 1e+04")


def test_bars_are_counted_once_however_often_and_only_those_outside():
    # At 12 m/s at a sine of 0.2 to y: Re of 4800 across the bars along y, 24000 across the others.
    water = flow(12.0 * 0.2, 12.0 * np.sqrt(0.96), 0.0)
    states = [(0.1 * i, MESH.positions, REST) for i in range(7)]
    told = out_of_range(in_water(tuple(water[0]), bars=KristiansenFaltinsenBar()), states)
    assert told.counts["bars"]["kristiansen-faltinsen"]["Re"] == 2
    assert "2 of 4 bars: Re = 2.4e+04" in told.warnings[0] and told.warnings[0].endswith("at t = 0 s")


def test_velocity_counts_against_the_water():
    system = in_water((10.0, 0.0, 0.0), bars=KristiansenFaltinsenBar(), knots=CliftGauvin())
    drifting = [(0.0, MESH.positions, flow(10.0, 0, 0))]
    assert out_of_range(system, drifting).warnings == ()
    meeting = [(0.0, MESH.positions, flow(-60.0, 0, 0))]
    told = out_of_range(system, meeting)
    assert told.counts["knots"] == {"clift-gauvin": {"Re": 4}}
    assert "Re = 2.8e+05, above its limit of 2e+05" in told.warnings[1]  # 70 m/s, 4 mm


def netting(meshes, size, diameter=2e-3):
    """Knotless square netting across x of 50 mm bars, held nowhere."""
    twine = replace(TWINE, diameter=diameter)
    return panel(twine, mesh="square", meshes=meshes, bar_length=0.05, size=size, fixed="none")


def stretched(net, *factors):
    """Return the knots of a net, stretched along y and z."""
    return net.positions * [1.0, *factors]


def test_screens_are_judged_by_the_solidity_that_they_have_now():
    # Knotless square netting, d = 8 mm, a = 50 mm: 2 d / a - d^2 / a^2 = 0.2944; twice as wide half of it, 0.1472, and
    # of 2.5 times the area 0.1178, below 0.13.
    net = netting((2, 3), (0.1, 0.15), diameter=8e-3)
    system = in_water((1.0, 0.0, 0.0), net=net, screens=Loland())
    rest = np.zeros_like(net.positions)
    assert out_of_range(system, [(0.0, stretched(net, 2.0, 1.0), rest)]).warnings == ()
    told = out_of_range(system, [(0.0, stretched(net, 2.0, 1.25), rest)])
    assert told.counts == {"screens": {"loland": {"solidity": 6}}}
    assert "6 of 6 screens: solidity = 0.1178, below its limit of 0.13" in told.warnings[0]


def test_screens_are_judged_by_the_speed_between_the_twines_and_bars_of_theirs_are_not():
    # Solidity 2 d / a - d^2 / a^2 = 0.0784, Re = 1e4 at 5 m/s and 2 mm: 10851 between the twines, above 1e4.
    net = netting((2, 3), (0.1, 0.15))
    laws = {"bars": KristiansenFaltinsenBar(), "screens": KristiansenFaltinsen()}
    system = in_water((5.0, 0.0, 0.0), net=net, **laws)
    told = out_of_range(system, [(0.0, net.positions, np.zeros_like(net.positions))])
    assert told.counts == {"screens": {"kristiansen-faltinsen": {"Re/(1-Sn)": 6}}}
    assert "Re/(1-Sn) = 1.085e+04" in told.warnings[0]


def test_wakes_are_judged_by_the_netting_that_makes_them():
    net = netting((2, 3), (0.1, 0.15))
    system = in_water((1.0, 0.0, 0.0), net=net, wake=LolandWake())
    told = out_of_range(system, [(0.0, net.positions, np.zeros_like(net.positions))])
    assert told.counts == {"wakes": {"loland": {"solidity": 6}}}
    assert "6 of 6 wakes: solidity = 0.0784, below its limit of 0.13" in told.warnings[0]


def test_shelter_and_waves_count_in_the_water_that_is_judged():
    # Re = 1.2e4 in the open; behind a mesh a tenth of it is left, and the law is content there.
    states = [(0.0, moved(0.0, 0.0, -1.0), REST)]
    open_water = in_water((6.0, 0.0, 0.0), bars=KristiansenFaltinsenBar())
    assert out_of_range(open_water, states).counts
    behind = in_two_sheets(GivenWake(0.1))
    there = [(0.0, behind.net.positions, np.zeros_like(behind.net.positions))]
    assert out_of_range(behind, there).counts["bars"]["kristiansen-faltinsen"]["Re"] == 4
    # A crest of 1 m and 4 s has pi H / T = 0.785 m/s at the surface, e^(-k) of it 1 m below: Re = 1222 with 2 mm.
    sea = replace(fyke.make_system(MESH, waves=airy(1.0, 4.0)), surface=True)
    swung = out_of_range(replace(sea, coefficients=fyke.Coefficients(bars=Narrow())), states)
    speed = np.pi / 4.0 * np.exp(-((np.pi / 2.0) ** 2) / 9.81 * 1.5)
    assert float(swung.warnings[0].split("Re = ")[1].split(",")[0]) == pytest.approx(2000.0 * speed, rel=0.05)


def moved(*by):
    """Return the knots of the mesh elsewhere."""
    return MESH.positions + np.array(by)


def in_two_sheets(wake):
    """Two meshes one behind the other, 1 m apart, in 6 m/s."""
    both = together([MESH, replace(MESH, positions=moved(1.0, 0.0, 0.0))])
    return in_water((6.0, 0.0, 0.0), net=both, bars=KristiansenFaltinsenBar(), wake=wake)


class Narrow(White):
    """A law that holds for next to nothing."""

    stated = (Range("Re", 1.0, 2.0),)


def test_what_is_above_the_surface_is_not_judged():
    # The upper bar of the mesh and its knots lie 25 mm above still water, the lower 25 mm below; those between reach.
    system = replace(in_water((10.0, 0.0, 0.0), bars=KristiansenFaltinsenBar()), surface=True)
    told = out_of_range(system, [(0.0, MESH.positions, REST)])
    assert told.counts["bars"]["kristiansen-faltinsen"]["Re"] == 3
    assert out_of_range(system, [(0.0, moved(0.0, 0.0, 1.0), REST)]).counts == {}


@pytest.mark.parametrize(("height", "outside"), [(0.0287, 0), (0.0210, 4)])
def test_keulegan_carpenter_number_is_u_t_over_d(height, outside):
    """U T / d = pi H / d at the surface, e^(-kz) of it below: of 0.0287 m 45, of 0.0210 m 33, times 0.98."""
    deep = moved(0.0, 0.0, -0.05)  # m, where e^(-kz) of 3 s is 0.978
    system = fyke.make_system(MESH, waves=airy(height, 3.0))
    states = [(0.25 * i, deep, REST) for i in range(13)]
    counts = out_of_range(system, states).counts.get("bars", {}).get("constant", {})
    assert counts.get("Keulegan-Carpenter number", 0) == outside
    if outside:
        lowest = np.pi * height / 2e-3 * np.exp(-((2.0 * np.pi / 3.0) ** 2) / 9.81 * 0.075)
        (sentence,) = out_of_range(system, states).warnings
        found = float(sentence.split("number = ")[1].split(",")[0])
        assert found == pytest.approx(lowest, rel=0.02) and "below its limit of 40" in sentence


def test_a_long_run_is_looked_at_in_fifty_frames_from_the_first_to_the_last():
    case = fyke.load_case(PANEL)
    one = fyke.solve_static(fyke.build_system(fyke.build_net(case), case))
    count = 1234
    long = replace(
        one,
        time=np.arange(count) * 0.1,
        position=np.broadcast_to(one.position[0], (count, *one.position.shape[1:])),
        velocity=np.broadcast_to(one.velocity[0], (count, *one.velocity.shape[1:])),
    )
    times = [time for time, _, _ in moments(long)]
    assert len(times) == 50 and times[0] == 0.0 and times[-1] == pytest.approx(123.3)
    assert np.ptp(np.diff(times)) < 0.11
    assert [time for time, _, _ in moments(one)] == [one.time[0]]


def test_check_tells_laws_and_reynolds_numbers_and_warns(tmp_path):
    text = PANEL.read_text()
    file = tmp_path / "case.toml"
    file.write_text(text.replace("velocity = [0.5, 0.0, 0.0]", "velocity = [0.3, 0.0, -0.4]"))
    told = CliRunner().invoke(app, ["check", str(file), "--json"], catch_exceptions=False)
    found = json.loads(told.stdout)
    assert found["drag"] == {"bars": "constant", "knots": "constant"} and found["out_of_range"] == {}
    # Bars at 45 deg in the plane across x: t = (0, 1, 1) / sqrt 2, speed across sqrt(0.25 - 0.08), 1.5 mm.
    assert found["panels"][0]["reynolds_across"] == pytest.approx([1500.0 * np.sqrt(0.17)] * 2, rel=1e-6)
    assert found["panels"][0]["reynolds_knots"] == pytest.approx(1750.0)
    shown = CliRunner().invoke(app, ["check", str(file)], catch_exceptions=False).stdout
    assert "bars: constant, knots: constant" in shown and "618.5 across the bars, 1750 at the knots" in shown


def test_a_run_tells_what_lay_outside_in_its_summary(tmp_path):
    # 0.5 m/s, twine of 1.5 mm, 1e-9 m2/s: Re = 7.5e5 across the flat panel's bars; White's law ends at 2e5.
    file = tmp_path / "case.toml"
    text = PANEL.read_text().replace("1.0e-6", "1.0e-9")
    file.write_text(
        text.replace('bars = { law = "constant", normal = 1.2, tangential = 0.1 }', 'bars = "white"')
    )
    command = ["run", str(file), "-o", str(tmp_path / "out"), "--json", "--no-figures"]
    told = json.loads(CliRunner().invoke(app, command, catch_exceptions=False).stdout)
    assert told["out_of_range"] == {"bars": {"white": {"Re": 256}}}
    (sentence,) = told["warnings"]
    assert "at 256 of 256 bars" in sentence and sentence.endswith("above its limit of 2e+05")
    # No bar of the bag stands better across the flow than those of the flat panel, and the best nearly so.
    assert 7.3e5 < float(sentence.split("Re = ")[1].split(",")[0]) <= 7.5e5
