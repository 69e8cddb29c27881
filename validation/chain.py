"""A chain of point weights, whose equilibrium is known to 1e-12 m, from six starts."""

from __future__ import annotations

from itertools import groupby

import numpy as np

import fyke
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, thread


def starts(ends, knots):
    """Places to begin from: along the chord, where bars are slack, in heaps, and all in one place."""
    chord = np.linspace(*ends, knots)
    yield "from its chord", chord
    for scale, seed in ((0.5, 1), (0.5, 2), (20.0, 3)):
        heap = chord.copy()
        heap[1:-1] = np.random.default_rng(seed).normal(scale=scale, size=(knots - 2, 3))
        yield f"from heap {seed} of {scale:g} m", heap
    gathered = chord.copy()
    gathered[1:-1] = chord[0]
    yield "from one place", gathered


def measure(tables):
    for name, some in groupby(tables["chains"], key=lambda row: row["case"]):
        rows = list(some)
        exact = np.array([[r["x"], 0.0, r["z"]] for r in rows])
        tension = np.array([r["tension"] for r in rows[:-1]])
        load = np.zeros_like(exact)
        load[1:-1, 2] = -rows[0]["knot_weight"]
        twine = thread(rows[0]["k"] * rows[0]["l0"])
        for start, points in starts(exact[[0, -1]], len(exact)):
            net = fyke.line(twine, points, rows[0]["l0"], load=load)
            system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
            result = fyke.solve_static(system, tolerance=1e-10)
            case = f"{name}, {start}"
            if not result.outcome.ok:
                raise RuntimeError(f"{case}: {result.outcome.message}")
            yield Found("place", np.abs(result.position[-1] - exact).max(), case=case)
            yield Found("tension", np.abs(result.tension[-1] - tension).max(), case=case)
