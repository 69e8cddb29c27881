"""Values of a run outside the ranges of its laws: what is counted, and the sentence with value, limit and time."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.netting.panel import panel
from fyke.results.ranges import LawsInUse, bar_values, knot_values, moments, out_of_range
from fyke.water.laws.bars import ConstantBar, Hoerner, KristiansenFaltinsenBar, White
from fyke.water.laws.knots import CliftGauvin, SchillerNaumann
from fyke.water.laws.panels import KristiansenFaltinsen, Loland

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


def judged(speeds, bars=None, knots=None, **further):
    """Judge the mesh at rest in currents along x, one at a second each."""
    states = [(float(i), MESH.positions, REST) for i in range(len(speeds))]
    return out_of_range(
        MESH, states, LawsInUse(bars, knots, None, NU), lambda x, t: flow(speeds[int(t)], 0, 0), **further
    )


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
    assert judged([0.0], White(), SchillerNaumann()).warnings == ()


def test_each_quantity_is_told_once_with_value_limit_how_many_and_when():
    # Re of the bars: 1000, 2e4, 12000, 10; of the law 31.6 to 1e4.
    told = judged([0.5, 10.0, 6.0, 0.005], KristiansenFaltinsenBar())
    assert told.warnings == (
        "drag law 'kristiansen-faltinsen' is used outside its range at 4 of 4 bars: Re = 2e+04, above its limit "
        "of 1e+04, at t = 1 s",
    )
    assert told.counts == {"bars": {"kristiansen-faltinsen": {"Re": 4}}}
    below = judged([0.5, 0.005, 0.01], KristiansenFaltinsenBar())
    assert "Re = 10, below its limit of 31.62, at t = 1 s" in below.warnings[0]
    # An equilibrium has one state and no time.
    assert judged([10.0], KristiansenFaltinsenBar()).warnings[0].endswith("above its limit of 1e+04")


def test_bars_are_counted_once_however_often_and_only_those_outside():
    # At 12 m/s at a sine of 0.2 to y: Re of 4800 across the bars along y, 24000 across the others.
    water = flow(12.0 * 0.2, 12.0 * np.sqrt(0.96), 0.0)
    states = [(0.1 * i, MESH.positions, REST) for i in range(7)]
    told = out_of_range(
        MESH, states, LawsInUse(KristiansenFaltinsenBar(), None, None, NU), lambda x, t: water
    )
    assert told.counts["bars"]["kristiansen-faltinsen"]["Re"] == 2
    assert "2 of 4 bars: Re = 2.4e+04" in told.warnings[0] and told.warnings[0].endswith("at t = 0 s")


def test_velocity_counts_against_the_water():
    laws = LawsInUse(KristiansenFaltinsenBar(), CliftGauvin(), None, NU)
    drifting = [(0.0, MESH.positions, flow(10.0, 0, 0))]
    assert out_of_range(MESH, drifting, laws, lambda x, t: flow(10.0, 0, 0)).warnings == ()
    meeting = [(0.0, MESH.positions, flow(-60.0, 0, 0))]
    told = out_of_range(MESH, meeting, laws, lambda x, t: flow(10.0, 0, 0))
    assert told.counts["knots"] == {"clift-gauvin": {"Re": 4}}
    assert "Re = 2.8e+05, above its limit of 2e+05" in told.warnings[1]  # 70 m/s, 4 mm


def test_screens_are_judged_by_solidity_and_by_the_speed_between_the_twines():
    def local(x, relative):
        return np.array([0.1, 0.2, 0.5]), np.array([0.0, 0.5, 1.0]), np.array([1000.0, 20.0, 6000.0])

    states = [(0.0, MESH.positions, REST)]
    told = out_of_range(
        MESH, states, LawsInUse(None, None, Loland(), NU), lambda x, t: flow(1, 0, 0), screens=local
    )
    assert told.counts == {"screens": {"loland": {"solidity": 2}}}
    assert "2 of 3 screens: solidity = 0.5, above its limit of 0.317" in told.warnings[0]
    told = out_of_range(
        MESH,
        states,
        LawsInUse(None, None, KristiansenFaltinsen(), NU),
        lambda x, t: flow(1, 0, 0),
        screens=local,
    )
    # 20 / 0.8 = 25 is below 31.6, 6000 / 0.5 = 12000 above 1e4.
    assert told.counts == {"screens": {"kristiansen-faltinsen": {"Re/(1-Sn)": 2}}}
    assert "Re/(1-Sn) = 1.2e+04" in told.warnings[0]


@pytest.mark.parametrize(("amplitude", "outside"), [(0.030, 0), (0.022, 4)])
def test_keulegan_carpenter_number_is_u_t_over_d(amplitude, outside):
    """U T / d with U = 0.03 or 0.022 m/s, T = 3 s, d = 2 mm: 45 and 33."""

    def swing(x, t):
        return flow(amplitude * np.cos(2.0 * np.pi * t / 3.0), 0, 0)

    states = [(0.25 * i, MESH.positions, REST) for i in range(13)]
    told = out_of_range(MESH, states, LawsInUse(ConstantBar(), None, None, NU), swing, waves=(swing, 3.0))
    counts = told.counts.get("bars", {}).get("constant", {})
    assert counts.get("Keulegan-Carpenter number", 0) == outside
    if outside:
        assert "Keulegan-Carpenter number = 33, below its limit of 40" in told.warnings[0]


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


def test_a_run_tells_what_lay_outside_in_its_summary(tmp_path, monkeypatch):
    # 0.5 m/s, twine of 1.5 mm: Re = 750 across the flat panel's bars; White's law begins at 1 and ends at 2e5.
    thick = LawsInUse(White(), None, None, 1e-9)  # m2/s, so that Re is 7.5e5
    monkeypatch.setattr("fyke.cli.run.laws_of", lambda case: thick)
    command = ["run", str(PANEL), "-o", str(tmp_path / "out"), "--json", "--no-figures"]
    told = json.loads(CliRunner().invoke(app, command, catch_exceptions=False).stdout)
    assert told["out_of_range"] == {"bars": {"white": {"Re": 256}}}
    (sentence,) = told["warnings"]
    assert "at 256 of 256 bars" in sentence and sentence.endswith("above its limit of 2e+05")
    # No bar of the bag stands better across the flow than those of the flat panel, and the best nearly so.
    assert 7.3e5 < float(sentence.split("Re = ")[1].split(",")[0]) <= 7.5e5
