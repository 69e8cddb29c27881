"""fyke modes: the periods that fyke.modes finds, exit codes, 80 columns."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.netting.line import line
from fyke.results.periods import told_modes

PANEL = Path(__file__).parents[1] / "examples" / "panel.toml"


def modes(*arguments):
    return CliRunner().invoke(app, ["modes", *map(str, arguments)], catch_exceptions=False)


def test_one_mesh_by_hand(tmp_path):
    """One square mesh on four held corners has no free knot; two in a row have none either: no modes at all."""
    text = PANEL.read_text().replace('"diamond"', '"square"').replace("[8, 8]", "[1, 1]")
    (tmp_path / "one.toml").write_text(text.replace("[0.3055, 0.3055]", "[0.0303, 0.0303]"))
    found = json.loads(modes(tmp_path / "one.toml", "--json").stdout)
    assert found["modes"] == [] and found["outcome"] == "converged"


def test_stretched_cross_by_hand(tmp_path):
    """2 x 2 square meshes strained by 1 %: one free knot on four taut bars, out of plane omega^2 = 4 (T / L) / m.

    Without weight, current and water the knot stays in the middle; in the plane two bars stretch and two turn.
    """
    text = PANEL.read_text().replace('"diamond"', '"square"').replace("[8, 8]", "[2, 2]")
    text = text.replace("[0.3055, 0.3055]", "[0.0606, 0.0606]").replace("[0.5, 0.0, 0.0]", "[0.0, 0.0, 0.0]")
    text = text.replace("density = 1000.0", "density = 0.0").replace("gravity = 9.81", "gravity = 0.0")
    (tmp_path / "cross.toml").write_text(text)
    done = modes(tmp_path / "cross.toml", "-n", 10, "--json")
    assert done.exit_code == 0
    found = json.loads(done.stdout)["modes"]
    stiffness = 1e9 * math.pi / 4 * 1.5e-3**2 / 0.03
    mass = 1140.0 * (math.pi / 6 * 3.5e-3**3 + 4 * 0.5 * math.pi / 4 * 1.5e-3**2 * 0.03)
    across = stiffness * 0.0003 / 0.0303
    expected = [math.sqrt(4 * across / mass)] + [math.sqrt((2 * stiffness + 2 * across) / mass)] * 2
    assert [one["circular_frequency"] for one in found] == pytest.approx(expected, rel=1e-9)
    assert [one["period"] for one in found] == pytest.approx([2 * math.pi / w for w in expected], rel=1e-9)
    assert [one["frequency"] * one["period"] for one in found] == pytest.approx([1.0] * 3)
    assert {one["largest_motion"] for one in found} == {"1-1"}
    assert [abs(x) for x in found[0]["direction"]] == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)


def test_table_fits_80_columns():
    done = modes(PANEL, "-n", 10)
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert [line.split()[0] for line in lines[-10:]] == [str(n) for n in range(1, 11)]


def test_wrong_input_and_no_equilibrium_have_their_exit_codes(tmp_path):
    assert modes(tmp_path / "no.toml").exit_code == 2
    assert "problems" in json.loads(modes(tmp_path / "no.toml", "--json").stdout)
    assert modes(PANEL, "-n", 0).exit_code == 2
    text = PANEL.read_text().replace('kind = "static"', 'kind = "dynamic"\nduration = 1')
    (tmp_path / "loose.toml").write_text(text.replace('fixed = "edges"', 'fixed = "none"'))
    loose = modes(tmp_path / "loose.toml")
    assert loose.exit_code == 1 and "singular" in loose.stderr and "held by nothing" in loose.stderr


def test_shares_of_all_modes_add_up_to_the_whole():
    """Effective modal masses of a complete set are the mass itself, along every axis."""
    twine = fyke.Twine("s", 1140.0, 1e-3, fyke.LinearLaw(1e9))
    points = [(0.0, 0.0, 0.0), (0.0, 0.0, -0.5), (0.1, 0.0, -1.0)]
    balls = {"knot_diameter": [0.0, 0.02, 0.2], "knot_density": [1000.0, 3000.0, 8000.0]}
    system = fyke.make_system(line(twine, points, 0.5, fixed=(0,), **balls), current=(0.0, 0.0, 0.0))
    at = fyke.solve_static(system).position[-1]
    told = told_modes(system, at, fyke.modes(system, at, count=6))
    assert np.sum([one["share"] for one in told], axis=0) == pytest.approx(np.ones(3), rel=1e-9)
    # The two slowest are the pendulum, one each way in any mixture.
    assert np.sum([one["share"] for one in told[:2]], axis=0)[:2] == pytest.approx(np.ones(2), abs=1e-2)


def test_a_run_tells_the_periods_that_modes_finds(tmp_path):
    text = PANEL.read_text() + "\n[output]\nperiods = 3\n"
    file = tmp_path / "panel.toml"
    file.write_text(text)
    done = CliRunner().invoke(app, ["run", str(file), "-o", str(tmp_path / "out"), "--no-figures", "--json"])
    assert done.exit_code == 0, done.output
    told = json.loads(done.output)["natural_periods"]
    found = json.loads(modes(PANEL, "-n", "3", "--json").output)["modes"]
    assert [one["period"] for one in told] == pytest.approx([one["period"] for one in found], rel=1e-6)
