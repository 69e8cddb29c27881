"""Bars and knots drawn into plain axes, with tension as colour."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from ..netting.net import Net
from . import style
from .parts import Bars, Knots, Outline, parts_of
from .plane import size_of
from .ticks import STEPS, number, text_size

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

DASHED_UP_TO = 2000  # bars; beyond, a bar is shorter on paper than a dash
VECTORS_UP_TO = 8000  # bars; beyond, they go into a vector file as one image, which keeps it small
KNOTS_UP_TO = 600
BESIDE_ENTRY = 24.0  # points, of a handle and the spaces of an entry in a legend
LARGEST_ENTRY = 4.5  # points, of a marker in a legend
EDGE = 0.3  # points, of the rim of a float or sinker
MARKERS = {"square": "s", "circle": "o", "diamond": "D"}
# Drawn of one kind; beyond, bars are finer than the dots of a page and some show as much as all.
BARS_UP_TO = 150_000


def tension_scale(tension: Array) -> Normalize:
    """Return the colour scale of tensions (N) of any shape: from 0 to the largest, to 1 N when all are slack."""
    largest = float(np.max(tension, initial=0.0))
    return Normalize(0.0, largest if largest > 0.0 else 1.0)


def line_width(bars: int) -> float:
    """Return the width (points) at which so many bars of a net stay apart on a column."""
    return float(np.clip(1.4 * np.sqrt(300.0 / max(bars, 1)), 0.25, 1.4))


def thickness(ax: Axes, part: Bars, bars: int) -> float:
    """Return the width (points) of the lines of a part on a net of so many bars, of a tube at least its own."""
    inch = float(np.ptp(ax.get_xlim()) / size_of(ax)[0])
    return max(part.width * line_width(bars), 72.0 * part.diameter / inch)


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


def knot_size(knots: int) -> float:
    """Return the size (points) of the marker of a fixed knot on a net of so many knots."""
    return float(np.clip(2.6 * np.sqrt(150.0 / max(knots, 1)), 1.2, 2.6))


def draw_free_knots(ax: Axes, points: Array, fixed: NDArray[np.bool_]) -> None:
    """Mark the free knots among points (n, 2), unless they are too many."""
    if not fixed.all() and len(points) <= KNOTS_UP_TO:
        size = 0.85 * knot_size(len(points))
        mark(ax, points[~fixed], marker="o", markersize=size, color=style.BLUE, label="free knot")


def draw_knots(ax: Axes, points: Array, part: Knots) -> None:
    """Mark the knots of a part among points (n, 2) m, unless they are too many."""
    if len(part.knots) <= KNOTS_UP_TO:
        inch = float(np.ptp(ax.get_xlim()) / size_of(ax)[0])
        size = max(part.size * knot_size(len(points)), 72.0 * part.diameter / inch)
        options: dict[str, Any] = {"markersize": size, "color": part.colour, "label": part.name}
        if part.diameter > 0.0:
            options |= {"markeredgecolor": style.BLACK, "markeredgewidth": EDGE}
        mark(ax, points[part.knots], marker=MARKERS[part.marker], **options)


def draw_outline(ax: Axes, points: Array, part: Outline) -> None:
    """Draw the line of a part through points (k, 2) on paper."""
    line = LineCollection(
        [points], colors=part.colour, linewidths=0.5 * part.width, zorder=1.5, clip_on=False
    )
    ax.add_collection(line, autolim=False)


def mark(ax: Axes, points: Array, **options: Any) -> None:
    """Add unconnected markers at points (k, 2); options are those of Line2D."""
    ax.plot(
        *points.T,
        **{"linestyle": "none", "markeredgewidth": 0.0, "zorder": 3, "clip_on": False, **options},
        scalex=False,
        scaley=False,
    )


def tension_bar(home: Figure | Axes, room: tuple[float, float, float, float], scale: Normalize) -> Colorbar:
    """Add a colour bar with its unit to a figure or to axes, with which it moves.

    room: left, bottom, width and height in inches, from the lower left of figure or axes.
    """
    figure: Any = home.get_figure(root=True)
    cax = figure.add_axes((0.0, 0.0, 1.0, 1.0), label="colour bar")

    def place(_cax: Axes, _renderer: Any) -> Bbox:
        corner = (home.bbox.x0, home.bbox.y0) if isinstance(home, Axes) else (0.0, 0.0)
        inches = Bbox.from_bounds(*room).transformed(figure.dpi_scale_trans)
        return inches.translated(*corner).transformed(figure.transFigure.inverted())

    cax.set_axes_locator(place)
    cax.set_position(place(cax, None))
    upright = room[3] > room[2]
    mappable, options = shown_tensions(scale)
    bar: Colorbar = figure.colorbar(
        mappable, cax=cax, orientation="vertical" if upright else "horizontal", **options
    )
    return bar


def shown_tensions(scale: Normalize) -> tuple[ScalarMappable, dict[str, Any]]:
    """Return what a colour bar of tensions shows, and its options: ticks, numbers and label with the unit."""
    factor, unit = style.prefixed(float(scale.vmax or 0.0), "N")
    options = {
        "ticks": MaxNLocator(5, steps=STEPS),
        "format": FuncFormatter(lambda value, _: number(value * factor)),
        "label": f"Bar tension ({unit})",
    }
    return ScalarMappable(scale, style.TENSION_COLOURS), options


def legend_rows(names: Iterable[str], width: float) -> int:
    """Return how many rows a legend of these names takes in so many inches."""
    lengths = [text_size(len(name), style.SMALL_TYPE)[0] + BESIDE_ENTRY for name in names]
    return int(np.ceil(sum(lengths) / (72.0 * width)))


def part_names(net: Net, *others: str) -> list[str]:
    """Return what a legend of a net may name: its parts that are not coloured by a quantity, and others."""
    named = (p.name for p in parts_of(net) if isinstance(p, Knots) or (isinstance(p, Bars) and p.colour))
    return [*dict.fromkeys(named), *others]


def name_marks(home: Figure | Axes) -> None:
    """Name what is drawn in a figure or in axes, each thing once, in as few rows as will do, above it."""
    named: dict[str, Any] = {}
    for ax in home.axes if isinstance(home, Figure) else [home]:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    if named:
        width = home.get_figwidth() if isinstance(home, Figure) else float(size_of(home)[0])
        legend = home.legend(
            list(named.values()),
            list(named),
            loc="upper center",
            ncols=-(-len(named) // legend_rows(named, width)),
            borderaxespad=0.2,
            labelspacing=0.2,
            handletextpad=0.5,
            columnspacing=1.2,
        )
        for entry in legend.legend_handles:
            # Lines of a large net are too thin to be known again by their entry, and a float may be large.
            if isinstance(entry, LineCollection):
                entry.set_linewidth(0.9)
            elif isinstance(entry, Line2D):
                entry.set_markersize(min(float(entry.get_markersize()), LARGEST_ENTRY))
