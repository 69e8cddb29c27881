"""The model cage of examples/c01_cage.toml at the speeds of the tests, whose forces were not found."""

from __future__ import annotations

from pathlib import Path

import fyke
from fyke.case.load import load_cases_of
from fyke.study import Found

CASE = (Path(__file__).resolve().parents[1] / "examples" / "c01_cage.toml").read_text(encoding="utf-8")
SHELTER = "wake = 0.886"


def drags(text):
    """Drag (N) of the cage by the name of its load case."""
    case = fyke.parse_case(text)
    net = fyke.build_net(case)
    out = {}
    for _, name, one in load_cases_of(case):
        result = fyke.solve_static(fyke.build_system(net, one))
        if not result.outcome.ok:
            raise RuntimeError(f"{name} m/s: {result.outcome.message}")
        out[name] = result.hydrodynamic_force[-1][0]
    return out


def measure(tables):
    if SHELTER not in CASE:
        raise ValueError(f"'{SHELTER}' is not in the case")
    sheltered, bare = drags(CASE), drags(CASE.replace(SHELTER, 'wake = "off"'))
    for name, drag in sheltered.items():
        yield Found("drag", drag, case=f"{name} m/s")
        yield Found("open", 100.0 * (bare[name] / drag - 1.0), case=f"{name} m/s")
