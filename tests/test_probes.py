"""Probes of a run in waves: what they are asked, what waves.csv holds, what the figure draws, what fyke check says."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fyke.cli.app import app
from fyke.report.waves import wave_histories
from fyke.results import probe, write_probes
from fyke.water.current import UniformCurrent
from fyke.water.waves import airy

PANEL = Path(__file__).parents[1] / "examples" / "panel.toml"
CURRENT = UniformCurrent((0.5, 0.1, 0.0))
WAVES = airy(2.0, 8.0)  # deep water: u = (pi H / T) e^(kz') cos, w = (pi H / T) e^(kz') sin
TIMES = [0.0, 2.0, 4.0, 6.0]
POINTS = [[0.0, 0.0, 0.0], [0.0, 7.0, -5.0]]


def test_probes_see_current_and_waves():
    seen = probe(CURRENT, WAVES, TIMES, POINTS)
    assert seen.elevation[:, 0] == pytest.approx([1.0, 0.0, -1.0, 0.0], abs=1e-15)
    k, u = (math.pi / 4.0) ** 2 / 9.81, math.pi / 4.0
    crest, trough = u * math.exp(-6.0 * k), u * math.exp(-4.0 * k)  # z' = z - eta
    assert seen.velocity[0, 1] == pytest.approx([0.5 + crest, 0.1, 0.0], rel=1e-12, abs=1e-15)
    assert seen.velocity[2, 1] == pytest.approx([0.5 - trough, 0.1, 0.0], rel=1e-12, abs=1e-15)
    assert seen.acceleration[2, 1] == pytest.approx([0.0, 0.0, math.pi / 4.0 * trough], rel=1e-12, abs=1e-15)


def test_a_dry_probe_sees_nothing():
    seen = probe(CURRENT, WAVES, TIMES, POINTS)
    assert seen.wet[0].all() and not seen.wet[2, 0] and seen.wet[:, 1].all()
    assert not seen.velocity[2, 0].any() and not seen.acceleration[2, 0].any()


def test_the_table_reads_back_to_the_last_digit(tmp_path):
    seen = probe(CURRENT, WAVES, TIMES, POINTS)
    with write_probes(seen, tmp_path / "new").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == "time,probe,x,y,z,wet,elevation,u,v,w,ax,ay,az".split(",")
    assert [(float(row["time"]), int(row["probe"])) for row in rows] == [
        (t, p) for t in TIMES for p in (0, 1)
    ]

    def column(*names):
        return np.array([[float(row[name]) for name in names] for row in rows]).reshape(4, 2, -1)

    assert np.array_equal(column("u", "v", "w"), seen.velocity)
    assert np.array_equal(column("ax", "ay", "az"), seen.acceleration)
    assert np.array_equal(column("elevation")[:, :, 0], seen.elevation)
    assert np.array_equal(column("wet")[:, :, 0], seen.wet)
    assert np.array_equal(column("x", "y", "z")[0], POINTS)


def test_the_figure_draws_elevations_and_the_velocity_with_gaps():
    seen = probe(CURRENT, WAVES, np.linspace(0.0, 16.0, 81), [*POINTS, *POINTS, [1.0, 0.0, 0.0]])
    elevation, velocity = wave_histories(seen).axes
    assert (elevation.get_ylabel(), velocity.get_ylabel()) == ("Elevation (m)", "Velocity at\nprobe 0 (m/s)")
    assert velocity.get_xlabel() == "Time (s)"
    assert len(elevation.lines) == 4 and len(velocity.lines) == 3
    assert elevation.lines[1].get_ydata() == pytest.approx(seen.elevation[:, 1])
    x = velocity.lines[0].get_ydata()
    assert np.array_equal(np.isnan(x), ~seen.wet[:, 0]) and np.isnan(x).sum() > 20
    assert x[0] == pytest.approx(0.5 + math.pi / 4.0 * math.exp(-((math.pi / 4.0) ** 2) / 9.81))  # z' = -eta
    assert len({(line.get_color(), line.get_linestyle()) for line in elevation.lines}) == 4


def test_the_figure_of_one_moment_in_small_waves_is_in_millimetres():
    figure = wave_histories(
        probe(UniformCurrent((0.0, 0.0, 0.0)), airy(0.02, 1.0), [0.0], [[0.0, 0.0, -0.1]])
    )
    assert figure.axes[0].get_ylabel() == "Elevation (mm)"
    assert figure.axes[0].lines[0].get_ydata() == pytest.approx([10.0])
    assert figure.axes[0].get_legend() is None and figure.axes[1].get_legend() is not None


def test_check_tells_the_waves(tmp_path):
    file = tmp_path / "waves.toml"
    file.write_text(PANEL.read_text() + '\n[waves]\nkind = "airy"\nheight = 0.5\nperiod = "4 s"\n')
    shown = CliRunner().invoke(app, ["check", str(file)], catch_exceptions=False)
    assert shown.exit_code == 0 and "airy, 0.5 m, 4 s, towards 0 deg" in shown.stdout
    told = CliRunner().invoke(app, ["check", str(file), "--json"], catch_exceptions=False)
    assert json.loads(told.stdout)["waves"] == "airy, 0.5 m, 4 s, towards 0 deg"
    without = CliRunner().invoke(app, ["check", str(PANEL), "--json"], catch_exceptions=False)
    assert json.loads(without.stdout)["waves"] is None
