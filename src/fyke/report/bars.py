"""Bars and knots drawn into plain axes, with tension as colour."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator
from numpy.typing import NDArray

from . import style
from .ticks import STEPS, number

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

DASHED_UP_TO = 2000  # bars; beyond, a bar is shorter on paper than a dash
VECTORS_UP_TO = 8000  # bars; beyond, they go into a vector file as one image, which keeps it small
KNOTS_UP_TO = 600
BARS_UP_TO = (
    150_000  # drawn of one kind; beyond, bars are finer than the dots of a page and some show as much as all
)


def tension_scale(tension: Array) -> Normalize:
    """Return the colour scale of tensions (N) of any shape: from 0 to the largest, to 1 N when all are slack."""
    largest = float(np.max(tension, initial=0.0))
    return Normalize(0.0, largest if largest > 0.0 else 1.0)


def line_width(bars: int) -> float:
    """Return the width (points) at which so many bars of a net stay apart on a column."""
    return float(np.clip(1.4 * np.sqrt(300.0 / max(bars, 1)), 0.25, 1.4))


def slack_name(tension: Array) -> str:
    """Name the slack among tensions (m,) with their number, as the legend has it."""
    return f"slack bar ({np.count_nonzero(tension <= 0.0)} of {len(tension)})"


def draw_bars(ax: Axes, points: Array, bars: Indices, **options: Any) -> LineCollection:
    """Add one line per bar (m, 2) between points (n, 2); options are those of LineCollection.

    Of more than BARS_UP_TO bars so many are drawn, spread at random but always the same ones; the legend says so.
    """
    if len(bars) > BARS_UP_TO:
        some = np.sort(np.random.default_rng(0).choice(len(bars), BARS_UP_TO, replace=False))
        options = {"label": f"{BARS_UP_TO} of {len(bars)} bars drawn", **options}
        if "array" in options:
            options["array"] = options["array"][some]
        bars = bars[some]
    collection = LineCollection(
        list(points[bars]),
        **{
            "capstyle": "round" if len(bars) <= DASHED_UP_TO else "butt",
            "rasterized": len(bars) > VECTORS_UP_TO,
            "clip_on": False,
            **options,
        },
    )
    ax.add_collection(collection, autolim=False)
    return collection


def draw_tension(
    ax: Axes, points: Array, bars: Indices, tension: Array, scale: Normalize, *, named: str
) -> None:
    """Draw taut bars in the colour of their tension (m,) N and slack ones grey and dashed, so named in the legend.

    points: (n, 2); bars: (m, 2) in the order of drawing. The collections carry the ids "taut-bars" and "slack-bars".
    """
    slack = tension <= 0.0
    width = line_width(len(bars))
    draw_bars(
        ax,
        points,
        bars[~slack],
        array=tension[~slack],
        cmap=style.TENSION_COLOURS,
        norm=scale,
        linewidths=width,
        zorder=2,
        gid="taut-bars",
    )
    if slack.any():
        draw_bars(
            ax,
            points,
            bars[slack],
            colors=style.SLACK_GREY,
            linewidths=0.7 * width,
            linestyles=[style.SLACK_DASHES] if len(bars) <= DASHED_UP_TO else "solid",
            capstyle="butt",
            zorder=2.1,
            label=named,
            gid="slack-bars",
        )


def draw_knots(ax: Axes, points: Array, fixed: NDArray[np.bool_], *, free: bool = False) -> None:
    """Mark the fixed knots among points (n, 2), and the free ones when asked, unless they are too many."""
    size = float(np.clip(2.6 * np.sqrt(150.0 / len(points)), 1.2, 2.6))
    if free and not fixed.all() and len(points) <= KNOTS_UP_TO:
        mark(ax, points[~fixed], marker="o", markersize=0.85 * size, color=style.BLUE, label="free knot")
    if fixed.any() and np.count_nonzero(fixed) <= KNOTS_UP_TO:
        mark(ax, points[fixed], marker="s", markersize=size, color=style.BLACK, label="fixed knot")


def mark(ax: Axes, points: Array, **options: Any) -> None:
    """Add unconnected markers at points (k, 2); options are those of Line2D."""
    ax.plot(
        *points.T,
        **{"linestyle": "none", "markeredgewidth": 0.0, "zorder": 3, "clip_on": False, **options},
        scalex=False,
        scaley=False,
    )


def tension_bar(figure: Figure, room: tuple[float, float, float, float], scale: Normalize) -> Colorbar:
    """Add a colour bar with its unit; room: left, bottom, width and height in inches."""
    width, height = figure.get_size_inches()
    ax = figure.add_axes(
        (room[0] / width, room[1] / height, room[2] / width, room[3] / height), label="colour bar"
    )
    factor, unit = style.prefixed(float(scale.vmax or 0.0), "N")
    bar = figure.colorbar(
        ScalarMappable(scale, style.TENSION_COLOURS),
        cax=ax,
        orientation="vertical" if room[3] > room[2] else "horizontal",
        ticks=MaxNLocator(5, steps=STEPS),
        format=FuncFormatter(lambda value, _: number(value * factor)),
    )
    bar.set_label(f"Bar tension ({unit})")
    return bar


def name_marks(figure: Figure) -> None:
    """Name what is drawn, each thing once, in one row above the axes."""
    named: dict[str, Any] = {}
    for ax in figure.axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    if named:
        legend = figure.legend(
            list(named.values()),
            list(named),
            loc="upper center",
            ncols=len(named),
            borderaxespad=0.2,
            handletextpad=0.5,
            columnspacing=1.2,
        )
        for entry in legend.legend_handles:
            # Lines of a large net are too thin to be known again by their entry.
            if isinstance(entry, LineCollection):
                entry.set_linewidth(0.9)
