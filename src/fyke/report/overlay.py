"""Figure of measured knot positions laid over the computed shape."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..results.compare import Comparison
from ..solve.result import Result
from . import style
from .bars import draw_bars, line_width, mark, name_marks
from .plane import plane_axes
from .space import box, far_to_near, seen_extent, space_axes

Array = NDArray[np.float64]

HEIGHT, ABOVE, BELOW = 2.3, 0.45, 0.42  # in, of the room for axes, and over and under it
SPACE_LEFT, SPACE_WIDTH, SPACE_RIGHT, LEFT, RIGHT = 0.64, 2.2, 0.15, 0.55, 0.1  # in, from left to right
COMPUTED, MEASURED = style.BLUE, style.VERMILION


@style.styled
def shape_comparison(result: Result, comparison: Comparison) -> Figure:
    """Lay measured positions over the last frame: in space, from the side (x, z), and in a second projection.

    The second one is along x (y, z), or along z (x, y) where the net is deeper along x than it is tall.
    """
    net, shape = result.net, result.position[-1]
    corners = box(net.positions, shape, comparison.measured)
    figure = Figure(figsize=(style.DOUBLE_COLUMN, ABOVE + HEIGHT + BELOW))
    height = min(HEIGHT, float(SPACE_WIDTH * np.divide(*np.ptp(seen_extent(corners), axis=0)[::-1])))
    room = (SPACE_LEFT, BELOW + (HEIGHT - height) / 2.0, SPACE_WIDTH, height)
    ax, view = space_axes(figure, corners, room)
    seen = view.see(shape)
    order = far_to_near(seen, net.bars)
    _draw_overlay(ax, seen[:, :2], net.bars[order], comparison, view.see(comparison.measured)[:, :2])

    depth, _, tall = np.ptp(corners, axis=0)
    pairs = ((0, 2), (1, 2) if tall >= depth else (0, 1))
    sides = np.array([np.ptp(corners[:, pair], axis=0) for pair in pairs])
    start = SPACE_LEFT + SPACE_WIDTH + SPACE_RIGHT
    width = style.DOUBLE_COLUMN - start - 2.0 * (LEFT + RIGHT)
    metres = float(max(sides[:, 0].sum() / width, sides[:, 1].max() / HEIGHT))
    spare = (width - float(sides[:, 0].sum()) / metres) / 3.0
    for pair, (across, up) in zip(pairs, sides / metres, strict=True):
        start += LEFT + spare
        names = ("xyz"[pair[0]], "xyz"[pair[1]])
        place = (start, BELOW + (HEIGHT - up) / 2.0)
        ax = plane_axes(figure, corners[:, pair], place, metres=metres, names=names)
        _draw_overlay(ax, shape[:, pair], net.bars, comparison, comparison.measured[:, pair])
        start += across + RIGHT
    name_marks(figure)
    figure.text(0.5, 1.0 - 0.3 / figure.get_figheight(), _sentence(comparison), ha="center", va="center")
    return figure


def _draw_overlay(
    ax: Axes, shape: Array, bars: NDArray[np.int64], comparison: Comparison, measured: Array
) -> None:
    """Draw bars of a shape (n, 2), its compared knots, the measured ones (k, 2), and a line between each two."""
    computed = shape[comparison.knots]
    draw_bars(ax, shape, bars, colors=COMPUTED, linewidths=0.5 * line_width(len(bars)), alpha=0.55)
    apart = np.stack([computed, measured], axis=1)
    ax.add_collection(LineCollection(list(apart), colors=MEASURED, linewidths=0.8, zorder=2.5), autolim=False)
    size = float(np.clip(3.6 * np.sqrt(60.0 / max(len(measured), 1)), 1.5, 3.6))
    mark(ax, computed, marker="o", markersize=0.6 * size, color=COMPUTED, label="computed")
    mark(
        ax,
        measured,
        marker="o",
        markersize=size,
        markerfacecolor="none",
        markeredgecolor=MEASURED,
        markeredgewidth=0.8,
        zorder=4,
        label="measured",
    )


def _sentence(comparison: Comparison) -> str:
    factor, unit = style.prefixed(comparison.largest, "m")
    count = len(comparison.knots)
    return (
        f"RMS distance {comparison.rms * factor:.3g} {unit}, largest {comparison.largest * factor:.3g} {unit} "
        f"at knot {comparison.largest_label} ({count} knot{'s' if count > 1 else ''} measured)"
    )
