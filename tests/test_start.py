"""Where a dynamic case begins: as built, or at its equilibrium in the water of time 0."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.solve.run import solve_case

CASE = """
schema = 1
title = "Panel that begins at rest"
[water]
depth = 5.0
[current]
velocity = [0.4, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2 mm"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "0.2 m"
[[gear]]
kind = "panel"
name = "wall"
netting = "main"
meshes = [4, 4]
hanging_ratio = [0.95, 0.95]
centre = [0.0, 0.0, -1.5]
fixed = "edges"
"""
AT_REST = CASE + '[solve]\nkind = "dynamic"\nduration = 0.5\nstart = "equilibrium"\n'


def solved(text):
    case = fyke.parse_case(text)
    return solve_case(fyke.build_system(fyke.build_net(case), case), case)


@pytest.mark.parametrize("stepper", ["auto", "symplectic"])
def test_a_net_that_begins_at_rest_stays_there(stepper):
    rest = solved(CASE)
    result = solved(AT_REST + f'stepper = "{stepper}"\n')
    assert result.outcome.name == "completed", result.outcome
    assert np.abs(rest.position[-1] - rest.net.positions).max() > 0.1
    assert np.abs(result.position - rest.position[-1]).max() < 1e-6
    assert np.abs(result.velocity).max() < 1e-5
    assert np.abs(result.tension - rest.tension[-1]).max() < 1e-4 * rest.tension[-1].max()


def test_waves_come_to_a_net_at_rest():
    """In waves that have not risen yet the first moments are those of the equilibrium."""
    waves = '[waves]\nkind = "airy"\nheight = 0.2\nperiod = 2.0\nramp = 100.0\n'
    rest, result = solved(CASE), solved(AT_REST + waves)
    assert np.abs(result.position[0] - rest.position[-1]).max() < 1e-12
    assert np.abs(result.position[-1] - rest.position[-1]).max() < 1e-3


def test_a_start_without_an_equilibrium_is_told(tmp_path):
    case = tmp_path / "free.toml"
    case.write_text(AT_REST.replace('fixed = "edges"', 'fixed = "none"'))
    done = CliRunner().invoke(app, ["run", str(case), "-o", str(tmp_path / "out"), "--no-figures"])
    assert done.exit_code == 1
    assert "no equilibrium to begin at" in " ".join(done.output.split())
    assert (tmp_path / "out" / "summary.json").is_file()


def test_a_tow_has_no_equilibrium_to_begin_at():
    with pytest.raises(fyke.CaseError) as error:
        fyke.parse_case(AT_REST + '[[motion]]\nof = ["wall"]\nvelocity = [0.1, 0.0, 0.0]\n')
    assert "leave start out" in str(error.value)
