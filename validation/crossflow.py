"""A string stretched across a current, cut into bars: a catenary of constant tension."""

from __future__ import annotations

import numpy as np

import fyke
from fyke.study import Found
from lines import STIFF, orders, thread, towards

NO_GRAVITY = fyke.Water(gravity=0.0)


def stretched(row, bars):
    """Stretch a string across the current from its straight, slack state.

    Returns the errors of tension, camber, drag and lateral pull, and the spread of the tension, over the exact values.
    """
    half = row["half_span"]
    points = np.zeros((bars + 1, 3))
    points[:, 1] = np.linspace(-half, half, bars + 1)
    net = fyke.line(thread(STIFF * row["tension"], row["diameter"]), points, row["length"] / bars)
    coefficients = fyke.Coefficients(
        bars=fyke.ConstantBar(row["Cn"], 0.0),
        knots=fyke.ConstantKnot(0.0),
        added_mass_bar=0.0,
        added_mass_knot=0.0,
    )
    current = (row["speed"], 0.0, 0.0)
    result = fyke.solve_static(
        fyke.make_system(net, current=current, water=NO_GRAVITY, coefficients=coefficients)
    )
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    x, tension = result.position[-1], result.tension[-1]
    pull = tension[0] * towards(x[0], x[1]) + result.water_force[-1][0]
    drag = result.support_reaction[-1][0]
    found = np.array([tension.mean(), x[:, 0].max(), drag, pull[1]])
    exact = [row[key] for key in ("tension", "camber", "drag", "lateral_pull")]
    return np.append(found / exact - 1.0, np.ptp(tension) / row["tension"])


def measure(tables):
    for row in tables["strings"]:
        case = f"{row['length']:g} m of {1e3 * row['diameter']:g} mm, {row['speed']:g} m/s"
        order = orders([np.linalg.norm(stretched(row, bars)) for bars in (10, 20, 40)])
        *values, spread = stretched(row, 50)
        yield Found("order", order[-1], case=case)
        yield Found("values", np.abs(values).max(), case=case)
        yield Found("spread", spread, case=case)
