"""The model cage of examples/model_cage.toml at the speeds of the tests, whose forces were not found."""

from __future__ import annotations

from pathlib import Path

import fyke
from fyke.study import Found

CASE = (Path(__file__).resolve().parents[1] / "examples" / "model_cage.toml").read_text(encoding="utf-8")
SPEED = "velocity = [0.5, 0.0, 0.0]"
SPEEDS = (0.12, 0.26, 0.39, 0.50, 0.65, 0.76, 0.93)  # m/s


SHELTER = "wake = 0.886"


def drag(speed, shelter=SHELTER):
    """Drag (N) of the cage in a current."""
    for words in (SPEED, SHELTER):
        if words not in CASE:
            raise ValueError(f"'{words}' is not in the case")
    text = CASE.replace(SPEED, f"velocity = [{speed}, 0.0, 0.0]").replace(SHELTER, shelter)
    case = fyke.parse_case(text)
    result = fyke.solve_static(fyke.build_system(fyke.build_net(case), case))
    if not result.outcome.ok:
        raise RuntimeError(f"{speed} m/s: {result.outcome.message}")
    return result.hydrodynamic_force[-1][0]


def measure(tables):
    drags = {speed: drag(speed) for speed in SPEEDS}
    for speed, found in drags.items():
        yield Found("drag", found, case=f"{speed:g} m/s")
    for speed in (SPEEDS[0], SPEEDS[-1]):
        yield Found("open", 100.0 * (drag(speed, 'wake = "off"') / drags[speed] - 1.0), case=f"{speed:g} m/s")
