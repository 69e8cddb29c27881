"""Figure of load cases against the speed of their current: force of the water, and the volume that is left."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..results.loads import LoadRow
from . import style
from .ticks import STEPS

WIDTH, HEIGHT, LEFT, RIGHT, BELOW, ABOVE, GAP = style.SINGLE_COLUMN, 1.3, 0.62, 0.12, 0.38, 0.1, 0.14  # in
# Fewer different speeds make no curve.
FEWEST = 3


@style.styled
def load_curves(rows: Sequence[LoadRow]) -> Figure | None:
    """Show drag and volume left of the load cases that converged, one over another; None for fewer than FEWEST speeds.

    Load cases that differ in more than their current have no curve.
    """
    good = sorted((row for row in rows if row.ok and row.drag is not None), key=lambda row: row.current)
    alike = {(row.towards, row.wave_height, row.wave_period, row.waves_towards) for row in good}
    if len({row.current for row in good}) < FEWEST or len(alike) > 1:
        return None
    speed = np.array([row.current for row in good])
    shown = [("Drag", "N", np.array([row.drag for row in good], dtype=float))]
    if all(row.volume_left is not None for row in good):
        left = np.array([row.volume_left for row in good], dtype=float)
        shown.append(("Volume left", "%", 100.0 * left))
    count = len(shown)
    height = ABOVE + count * HEIGHT + (count - 1) * GAP + BELOW
    figure = Figure(figsize=(WIDTH, height))
    for index, (name, unit, values) in enumerate(shown):
        bottom = height - ABOVE - HEIGHT - index * (HEIGHT + GAP)
        room = (LEFT / WIDTH, bottom / height, 1.0 - (LEFT + RIGHT) / WIDTH, HEIGHT / height)
        ax = figure.add_axes(room, label=name)
        factor, prefixed = style.prefixed(float(values.max()), unit) if unit == "N" else (1.0, unit)
        ax.plot(speed, values * factor, color=style.BLUE, marker="o", markersize=3.0)
        ax.set_ylabel(f"{name} ({prefixed})")
        ax.set_ylim(bottom=0.0)
        ax.set_xlim(left=0.0)
        ax.yaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
        ax.grid(True)
        ax.tick_params(labelbottom=index == count - 1)
    figure.axes[-1].set_xlabel("Speed of the current (m/s)")
    return figure
