"""The panel in MoorDyn, another program, by `make test-peers`: one point for each knot, one line for each bar."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import fyke

pytestmark = [
    pytest.mark.peers,
    pytest.mark.skipif(
        importlib.util.find_spec("moordyn") is None,
        reason='MoorDyn is not installed; `make test-peers` does it, or pip install -e ".[peers]"',
    ),
]


def test_moordyn_swings_the_panel_into_the_shape_of_statics(monkeypatch):
    """Two seconds from rest in 0.5 m/s by Runge-Kutta steps of 90 us, nothing of fyke in it: the same 144 knots."""
    monkeypatch.syspath_prepend(Path(__file__).parents[1] / "benchmarks")
    from peer_motion import moordyn
    from peer_panel import fyke_system, make_panel

    panel = make_panel(8)
    position, velocity = moordyn(panel, 90e-6)()
    assert np.abs(velocity).max() < 1e-6
    static = fyke.solve_static(fyke_system(panel), tolerance=1e-10)
    assert static.outcome.ok
    assert np.ptp(static.position[-1][:, 0]) > 0.09
    # MoorDyn takes the drag on the unloaded length of a bar, fyke on its length: 3e-5 m.
    assert np.abs(position - static.position[-1]).max() < 1e-4
