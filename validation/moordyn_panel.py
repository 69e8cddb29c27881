"""The mid-side panel in MoorDyn, a point for each knot and a line for each bar, swung to rest."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import fyke
from fyke.study import Found

# The panel as all tools of the benchmarks know it.
sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

STEP = 90e-6  # s


def measure(tables):
    from peer_motion import moordyn
    from peer_panel import fyke_system, make_panel

    panel = make_panel(8)
    position, velocity = moordyn(panel, STEP)()
    static = fyke.solve_static(fyke_system(panel), tolerance=1e-10)
    if not static.outcome.ok:
        raise RuntimeError(static.outcome.message)
    yield Found("speed", np.abs(velocity).max())
    yield Found("sag", static.position[-1][panel.centre, 0].mean(), position[panel.centre, 0].mean())
    yield Found("place", np.abs(position - static.position[-1]).max())
