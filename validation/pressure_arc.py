"""A strip under a constant pressure, cut into bars: an arc of a circle.

fyke has no pressure: each bar's is put on its ends as dead load, and renewed on the shape found until it holds.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, STIFF, orders, thread

# Rounds of renewing, and the change of a place over the length at which they end.
ROUNDS, STILL = 400, 1e-10


def pressed(row, bars):
    """Places (n, 3) m, and tensions (N) of a strip of 1 m of width."""
    half, length = row["half_span"], row["length"] / bars
    points = np.zeros((bars + 1, 3))
    points[:, 0] = np.linspace(-half, half, bars + 1)
    points[:, 2] = row["camber"] * (1.0 - (points[:, 0] / half) ** 2)
    net = fyke.line(thread(STIFF * row["tension"]), points, length)
    state = None
    for _ in range(ROUNDS):
        load = np.zeros_like(points)
        each = np.diff(points, axis=0)
        push = row["pressure"] * np.column_stack([-each[:, 2], np.zeros(bars), each[:, 0]])
        load[:-1] += 0.5 * push
        load[1:] += 0.5 * push
        system = fyke.make_system(replace(net, load=load), water=NO_WATER, coefficients=NO_FORCES)
        result = fyke.solve_static(system, start=state)
        if not result.outcome.ok:
            raise RuntimeError(result.outcome.message)
        state = result.state()
        moved = np.abs(result.position[-1] - points).max()
        points = 0.5 * (points + result.position[-1])
        if moved < STILL * row["length"]:
            return result.position[-1], result.tension[-1], result.support_reaction[-1][2]
    raise RuntimeError(f"the pressure still changes by {moved:.1e} m after {ROUNDS} rounds")


def errors(row, bars):
    """Errors of radius, tension, camber and force over the exact values."""
    x, tension, force = pressed(row, bars)
    # The circle through the ends and the middle.
    camber = x[bars // 2, 2]
    radius = (row["half_span"] ** 2 + camber**2) / (2.0 * camber)
    found = np.array([radius, tension.mean(), camber, force])
    return np.abs(found / [row["radius"], row["tension"], row["camber"], row["force"]] - 1.0)


def measure(tables):
    for row in tables["strips"]:
        case = f"{row['length']:.3g} m over {2.0 * row['half_span']:g} m"
        found = [errors(row, bars).max() for bars in (10, 20, 40)]
        yield Found("order", orders(found)[-1], case=case)
        yield Found("values", found[-1], case=case)
