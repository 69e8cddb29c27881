"""Sheets of square and diamond netting that hang by their upper edge under weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, thread

COLUMNS, ROWS, BAR, GRAVITY = 3, 8, 0.03, 9.81
# Of the square sheet: diameter of bars and knots (m), their weights in water and that of a sinker (N), stiffness (N/m).
DIAMETER, KNOT, BAR_WEIGHT, KNOT_WEIGHT, SINKER, STIFFNESS = 3e-3, 6e-3, 0.0005, 0.001, 0.05, 5000.0
# Of the diamond netting: meshes along the edge and down, weight on the lower edge (N).
ACROSS, DOWN, WEIGHT = 10, 8, 0.5


def rows_and_columns(net):
    return np.array([[int(part) for part in label.split("-")] for label in net.labels])


def settled(net, **given):
    result = fyke.solve_static(fyke.make_system(net, **given), tolerance=1e-10)
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return result


def square_sheet(rows, start_height):
    """Errors of places and tensions. Weights come from densities and sizes.

    The side columns, which have half a bar less, get it as dead load.
    """
    volume, knot_volume = np.pi / 4.0 * DIAMETER**2 * BAR, np.pi / 6.0 * KNOT**3
    height = ROWS * BAR * start_height
    net = fyke.panel(
        thread(STIFFNESS * BAR, DIAMETER, density=1000.0 + BAR_WEIGHT / (GRAVITY * volume)),
        mesh="square",
        meshes=(COLUMNS, ROWS),
        bar_length=BAR,
        size=(COLUMNS * BAR, height),
        knot_diameter=KNOT,
        knot_density=1000.0 + KNOT_WEIGHT / (GRAVITY * knot_volume),
        centre=(0.0, 0.0, -height / 2.0),
        fixed="top",
    )
    i, j = rows_and_columns(net).T
    load = np.zeros_like(net.positions)
    load[(i == 0) | (i == COLUMNS), 2] -= 0.5 * BAR_WEIGHT
    load[j == 0, 2] -= SINKER
    result = settled(replace(net, load=load))
    exact = net.positions.copy()
    exact[:, 2] = np.array([0.0, *(r["z_lower_knot"] for r in rows)])[ROWS - j]
    a, b = net.bars.T
    upright = i[a] == i[b]
    from_top = ROWS - 1 - np.minimum(j[a], j[b])
    tension = np.where(upright, np.array([r["tension"] for r in rows])[from_top.clip(0)], 0.0)
    return np.abs(result.position[-1] - exact).max(), np.abs(result.tension[-1] - tension).max()


def diamonds(row, stiffness):
    """Dead load on the side knots holds the width: the pull of two bars there, W tan(phi) / n, of one at the bottom.

    The start has half the height, all bars slack.
    """
    tan = row["E"] / np.sqrt(1.0 - row["E"] ** 2)
    height = row["height"] / 2.0
    net = fyke.panel(
        thread(stiffness * BAR),
        mesh="diamond",
        meshes=(ACROSS, DOWN),
        bar_length=BAR,
        size=(row["width"], height),
        centre=(0.0, 0.0, -height / 2.0),
        fixed="top",
    )
    i, j = rows_and_columns(net).T
    side = np.where(i == 0, -1.0, np.where(i == 2 * ACROSS, 1.0, 0.0))
    share = np.where(side == 0.0, 1.0, 0.5)
    load = np.outer(WEIGHT / ACROSS * tan * side * np.where(j == 0, 0.5, 1.0), [0.0, 1.0, 0.0])
    load[j == 0, 2] -= (WEIGHT / ACROSS * share)[j == 0]
    return settled(replace(net, load=load), water=NO_WATER, coefficients=NO_FORCES)


def diamond_errors(row):
    """Errors of places and tensions; two stiffnesses give the netting that does not stretch."""
    soft, stiff = diamonds(row, 4e5), diamonds(row, 8e5)
    i, j = rows_and_columns(stiff.net).T
    exact = np.zeros_like(stiff.net.positions)
    exact[:, 1] = (i / (2 * ACROSS) - 0.5) * row["width"]
    exact[:, 2] = (j / (2 * DOWN) - 1.0) * row["height"]
    place = 2.0 * stiff.position[-1] - soft.position[-1] - exact
    tension = 2.0 * stiff.tension[-1] - soft.tension[-1] - row["tension"]
    return np.abs(place).max(), np.abs(tension).max()


def measure(tables):
    cases = [
        (f"squares from {part:g} of their height", square_sheet(tables["squares"], part))
        for part in (0.5, 1.0, 1.3)
    ]
    cases += [(f"diamonds hung at {row['E']:.4g}", diamond_errors(row)) for row in tables["diamonds"]]
    for case, (place, tension) in cases:
        yield Found("place", place, case=case)
        yield Found("tension", tension, case=case)
