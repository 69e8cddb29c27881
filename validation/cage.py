"""The model cage of examples/model_cage.toml at the speeds of the tests, whose forces were not found."""

from __future__ import annotations

from pathlib import Path

import fyke
from fyke.study import Found

CASE = (Path(__file__).resolve().parents[1] / "examples" / "model_cage.toml").read_text(encoding="utf-8")
SPEED = "velocity = [0.5, 0.0, 0.0]"
SPEEDS = (0.12, 0.26, 0.39, 0.50, 0.65, 0.76, 0.93)  # m/s


def measure(tables):
    if SPEED not in CASE:
        raise ValueError(f"'{SPEED}' is not in the case")
    for speed in SPEEDS:
        case = fyke.parse_case(CASE.replace(SPEED, f"velocity = [{speed}, 0.0, 0.0]"))
        result = fyke.solve_static(fyke.build_system(fyke.build_net(case), case))
        if not result.outcome.ok:
            raise RuntimeError(f"{speed} m/s: {result.outcome.message}")
        yield Found("drag", result.hydrodynamic_force[-1][0], case=f"{speed:g} m/s")
