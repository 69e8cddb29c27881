"""Statics of a whole moored cage on its collar: how many iterations it takes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import fyke
from fyke.water.current import UniformCurrent

EXAMPLE = Path(__file__).parents[1] / "examples" / "floating_cage.toml"


@pytest.mark.parametrize("speed", [0.25, 0.5, 0.75, 1.0])
def test_a_moored_cage_takes_a_few_iterations(speed):
    """A near field that begins with the first taut mooring takes 120 to 180, most of them in time."""
    case = fyke.load_case(EXAMPLE)
    net = fyke.build_net(case)
    system = fyke.build_system(net, case)
    system = replace(system, current=UniformCurrent((speed, 0.0, 0.0)))
    outcome = fyke.solve_static(system).outcome
    assert outcome.ok and outcome.iterations <= 45, outcome
