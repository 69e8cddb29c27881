"""An elastic line hung by both ends, cut into 10, 20 and 40 bars, against the closed form."""

from __future__ import annotations

import numpy as np

import fyke
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, thread, towards


def hung(row, bars):
    """Hang a line by both ends, each bar's weight half on its ends."""
    load = np.zeros((bars + 1, 3))
    load[:, 2] = -row["w"] * row["L"] / bars
    load[[0, -1]] *= 0.5
    points = np.linspace([0.0, 0.0, 0.0], [row["dx"], 0.0, row["dz"]], bars + 1)
    net = fyke.line(thread(row["EA"]), points, row["L"] / bars, load=load)
    system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
    return fyke.solve_static(system, tolerance=1e-10)


def errors(row, points, bars):
    """Errors of the end forces, over the largest tension, and of ten points, over the length."""
    exact = np.array([[p["x"], 0.0, p["z"]] for p in points])
    result = hung(row, bars)
    if not result.outcome.ok:
        raise RuntimeError(f"{row['case']}, {bars} bars: {result.outcome.message}")
    x, tension = result.position[-1], result.tension[-1]
    half_bar = np.array([0.0, 0.0, 0.5 * row["w"] * row["L"] / bars])
    at_a = tension[0] * towards(x[0], x[1]) - half_bar
    at_b = tension[-1] * towards(x[-2], x[-1]) + half_bar
    wrong = [at_a - [row["H"], 0.0, row["VA"]], at_b - [row["H"], 0.0, row["VB"]]]
    largest = max(p["T"] for p in points)
    return np.abs(wrong).max() / largest, np.abs(x[:: bars // 10] - exact).max() / row["L"]


def measure(tables):
    for row in tables["lines"]:
        points = [p for p in tables["points"] if p["case"] == row["case"]]
        found = np.array([errors(row, points, bars) for bars in (10, 20, 40)])
        force, shape = np.log2(found[0] / found[2]) / 2.0
        yield Found("order of forces", force, case=row["case"])
        yield Found("order of shape", shape, case=row["case"])
        yield Found("force", 1.0 + found[2, 0], case=row["case"])
