"""Figure of how many bars carry how much tension."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from ..solve.result import Result
from . import style
from .bars import name_marks, slack_name, tension_scale
from .parts import coloured_bars
from .ticks import STEPS, number

Array = NDArray[np.float64]

WIDTH, HEIGHT = style.SINGLE_COLUMN, 2.2  # in
LEFT, RIGHT, BELOW, ABOVE = 0.6, 0.1, 0.38, 0.26  # in
BINS = 20
TOWERING = 3.0  # times the highest column of taut bars: a higher one of slack bars is cut off


@style.styled
def tension_histogram(result: Result) -> Figure:
    """Count the bars by tension in the last frame; slack bars stand apart, on the left. Ropes are not counted in."""
    figure = Figure(figsize=(WIDTH, HEIGHT))
    room = (LEFT / WIDTH, BELOW / HEIGHT, 1.0 - (LEFT + RIGHT) / WIDTH, 1.0 - (BELOW + ABOVE) / HEIGHT)
    shown = coloured_bars(result.net)
    ax = figure.add_axes(room)
    draw_histogram(ax, result.tension[-1][shown])
    if len(shown) < result.net.bar_count:
        ax.set_ylabel("Number of bars of netting")
    name_marks(figure)
    return figure


def draw_histogram(ax: Axes, tension: Array) -> None:
    """Draw the number of bars in BINS equal steps of tension (m,) N, and a hatched column for the slack ones.

    The column of slack bars is cut off, and its number written on it, where it would dwarf all others.
    """
    taut = tension[tension > 0.0]
    factor, unit = style.prefixed(float(np.max(taut, initial=0.0)), "N")
    scale = tension_scale(tension)
    step = float(scale.vmax or 1.0) / BINS
    ticks, names, highest = np.array([]), [], 0
    if len(taut):
        counts, edges = np.histogram(taut, bins=BINS, range=(0.0, BINS * step))
        colours = style.TENSION_COLOURS(scale(edges[:-1] + step / 2.0))
        ax.bar(edges[:-1], counts, width=step, align="edge", color=colours, edgecolor="white", linewidth=0.4)
        highest = int(counts.max())
        ticks = np.asarray(MaxNLocator(5, steps=STEPS).tick_values(0.0, edges[-1]))
        ticks = ticks[ticks <= edges[-1]]
        names = [number(tick * factor) for tick in ticks]
    if len(taut) < len(tension):
        _draw_slack(ax, tension, -2.5 * step, 2.0 * step, highest)
        ticks, names = np.append(ticks, -2.5 * step), [*names, "slack"]
    ax.set_xticks(ticks, names)
    ax.set_xlim((-4.2 if len(taut) < len(tension) else -0.8) * step, (BINS + 0.8) * step)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10], integer=True))
    ax.set(xlabel=f"Bar tension ({unit})", ylabel="Number of bars")


def _draw_slack(ax: Axes, tension: Array, middle: float, width: float, highest: int) -> None:
    number = int(np.count_nonzero(tension <= 0.0))
    column: dict[str, Any] = {
        "facecolor": "white",
        "edgecolor": style.SLACK_GREY,
        "hatch": "/////",
        "linewidth": 0.6,
    }
    ax.bar(middle, number, width=width, label=slack_name(tension), gid="slack-column", **column)
    if highest and number > TOWERING * highest:
        ax.set_ylim(0.0, 1.3 * highest)
        ax.text(
            middle + 0.7 * width,
            1.28 * highest,
            f"↑ {number}",
            ha="left",
            va="top",
            fontsize=style.SMALL_TYPE,
        )
