"""Figure of closed netting in sections: cut upright along the water's way, and rows of knots seen from above."""

from __future__ import annotations

from math import floor, log10
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from ..netting.faces import faces_of
from ..netting.lattice import Side
from ..netting.net import Net
from ..solve.result import Result
from . import style
from .bars import legend_rows, mark, name_marks, thickness
from .carried import carried
from .parts import Bars, parts_of
from .plane import frame, plane_axes
from .shapes import draw_arrow
from .ticks import number

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEFT, RIGHT, BELOW, TITLE, ARROW, LEGEND = 0.6, 0.15, 0.38, 0.2, 0.26, 0.22  # in, around axes
TALLEST = 2.6  # in, of axes
ROWS = 4  # of knots from above, the highest and the lowest among them
COLOURS = (style.SKY, style.BLUE, style.GREEN, style.NAVY)  # of rows; tubes and the cut have others
BUILT = (0, (2.0, 1.4))
_LEAST_SPAN = 1e-3  # m, of heights that are told apart
AS_BUILT = "as built"


@style.styled
def sections(
    result: Result, *, current: ArrayLike | None = None, waves: ArrayLike | None = None
) -> Figure | None:
    """Show closed netting in the last frame and as built, cut along the current and from above; None without any.

    The cut stands upright through the middle of the netting as built, along the current (3,) m/s, else along the waves
    (3,), else along x. From above there are rows of knots, named by the height at which they were built.
    """
    net = result.net
    closed = [which for which, panel in enumerate(net.panels) if panel.closed]
    if not closed:
        return None
    flow, words = _flow(current, waves)
    triangles = _triangles(net, closed + _floors(net, closed))
    built = carried(result).net.positions
    middle = 0.5 * np.sum([f(built[np.unique(triangles)], axis=0) for f in (np.min, np.max)], axis=0)
    shapes = built, result.position[-1]
    cuts = [_cut(x, triangles, middle, flow) for x in shapes]
    rows = _rows(net, closed)
    rings = [[x[knots][:, :2] for x in shapes] for _, knots in rows]
    limits = [frame(*(cut.reshape(-1, 2) for cut in cuts)), frame(*(ring for pair in rings for ring in pair))]
    figure, axes = _sheet(limits, [*_names(rows), *_tubes(net)], arrow=bool(words))
    _draw_cuts(axes[0], cuts)
    _draw_tubes(axes, net, shapes[1], (middle, flow))
    for index, (name, pair) in enumerate(zip(_row_names(rows), rings, strict=True)):
        _draw_row(axes[1], pair, COLOURS[index % ROWS], name)
    if words:
        top = figure.get_figheight() - LEGEND * _legend_rows(rows, net) - 0.5 * ARROW
        for ax, step, said in zip(axes, ([1.0, 0.0], flow[:2]), ("", words), strict=True):
            left = ax.get_position().x0 * figure.get_figwidth() + 0.2
            draw_arrow(figure, np.array(step), said, (left, top))
    name_marks(figure)
    return figure


def _flow(current: ArrayLike | None, waves: ArrayLike | None) -> tuple[Array, str]:
    """Horizontal unit vector (3,) of the water's way, and its words, "" where it has none."""
    speed = 0.0 if current is None else float(np.linalg.norm(current))
    for flow, words in ((current, f"current, {speed:.3g} m/s"), (waves, "waves")):
        level = np.zeros(3) if flow is None else np.asarray(flow, dtype=float) * [1.0, 1.0, 0.0]
        if level.any():
            return level / np.linalg.norm(level), words
    return np.array([1.0, 0.0, 0.0]), ""


def _floors(net: Net, closed: list[int]) -> list[int]:
    """Flat panels whose whole edge lies on closed netting: the bottoms of boxes."""
    walls = np.unique(np.concatenate([net.panels[which].knots for which in closed]))
    sides: tuple[Side, ...] = ("top", "bottom", "left", "right")
    return [
        which
        for which, panel in enumerate(net.panels)
        if not panel.closed and all(np.isin(panel.edge(side), walls).all() for side in sides)
    ]


def _triangles(net: Net, panels: list[int]) -> Indices:
    """Halves (t, 3) of the meshes of some panels."""
    faces = faces_of(net)
    corners = faces.corners[np.isin(faces.panel, panels)]
    return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])


def _cut(x: Array, triangles: Indices, middle: Array, along: Array) -> Array:
    """Lines (k, 2, 2) m in which triangles meet the upright plane along a direction: way from the middle, and z."""
    across = np.array([-along[1], along[0], 0.0])
    off = ((x - middle) @ across)[triangles]
    ahead = np.roll(off, -1, axis=1)
    over = (off >= 0.0) != (ahead >= 0.0)
    share = np.divide(off, off - ahead, out=np.zeros_like(off), where=over)[:, :, None]
    start = x[triangles]
    places = start + share * (np.roll(start, -1, axis=1) - start)
    met = places[over].reshape(-1, 2, 3)
    return np.stack([(met - middle) @ along, met[:, :, 2]], axis=2)


def _rows(net: Net, panels: list[int]) -> list[tuple[float, Indices]]:
    """Height as built (m) and knots in order of the rows nearest to ROWS even heights, from above; tips left out."""
    found: dict[float, Indices] = {}
    for which in panels:
        panel = net.panels[which]
        grid, z = panel.lattice, net.positions[panel.knots, 2]
        for j in range(grid.intervals[1] + 1):
            there = np.flatnonzero(grid.knots[:, 1] == j)
            knots = panel.knots[there[np.argsort(grid.knots[there, 0])]]
            if np.ptp(net.positions[knots, :2], axis=0).any():
                ring = knots if knots[0] == knots[-1] else np.append(knots, knots[0])
                found.setdefault(round(float(z[there].mean()), 6) + 0.0, ring)
    heights = np.array(sorted(found, reverse=True))
    even = np.linspace(heights[0], heights[-1], ROWS)
    chosen = np.unique(np.abs(heights[:, None] - even).argmin(axis=0))
    return [(float(heights[k]), found[float(heights[k])]) for k in chosen]


def _row_names(rows: list[tuple[float, Indices]]) -> list[str]:
    """Names of rows by their heights, to a hundredth of what lies between the highest and the lowest."""
    heights = [height for height, _ in rows]
    digits = 2 - floor(log10(max(np.ptp(heights), _LEAST_SPAN)))
    return [f"built at z = {number(round(height, max(digits, 0)))} m" for height in heights]


def _names(rows: list[tuple[float, Indices]]) -> list[str]:
    return [AS_BUILT, "last frame", *_row_names(rows)]


def _legend_rows(rows: list[tuple[float, Indices]], net: Net) -> int:
    return legend_rows([*_names(rows), *_tubes(net)], style.DOUBLE_COLUMN)


def _tubes(net: Net) -> dict[str, list[Bars]]:
    """Parts that are tubes, by what they are."""
    found: dict[str, list[Bars]] = {}
    for part in parts_of(net):
        if isinstance(part, Bars) and part.diameter:
            found.setdefault(part.name, []).append(part)
    return found


def _draw_tubes(axes: list[Axes], net: Net, x: Array, plane: tuple[Array, Array]) -> None:
    """Draw tubes in their thickness: cut across by the upright plane through a point along a direction; from above."""
    middle, along = plane
    across = np.array([-along[1], along[0], 0.0])
    for name, parts in _tubes(net).items():
        for part in parts:
            ends = x[net.bars[part.bars]]
            off = (ends - middle) @ across
            there = (off[:, 0] >= 0.0) != (off[:, 1] >= 0.0)
            share = (off[there, 0] / (off[there, 0] - off[there, 1]))[:, None]
            met = ends[there, 0] + share * (ends[there, 1] - ends[there, 0])
            places = np.column_stack([(met - middle) @ along, met[:, 2]])
            look: dict[str, Any] = {"color": part.colour, "clip_on": False}
            size = thickness(axes[0], part, net.bar_count)
            mark(axes[0], places, marker="o", markersize=size, label=name, color=part.colour)
            wide = thickness(axes[1], part, net.bar_count)
            row = LineCollection(list(ends[:, :, :2]), linewidths=wide, zorder=1.4, **look)
            axes[1].add_collection(row, autolim=False)


def _sheet(limits: list[Array], names: list[str], *, arrow: bool) -> tuple[Figure, list[Axes]]:
    """Start a figure of two columns with two axes side by side on one scale."""
    sides = np.array([np.ptp(one, axis=0) for one in limits])
    width = style.DOUBLE_COLUMN - 2.0 * (LEFT + RIGHT)
    metres = float(max(sides[:, 0].sum() / width, sides[:, 1].max() / TALLEST))
    spare = (width - float(sides[:, 0].sum()) / metres) / 2.0
    tall = float(sides[:, 1].max()) / metres
    above = TITLE + (ARROW if arrow else 0.0) + LEGEND * legend_rows(names, style.DOUBLE_COLUMN)
    figure = Figure(figsize=(style.DOUBLE_COLUMN, BELOW + tall + above))
    axes, left = [], LEFT
    for one, (across, up), title, labels in zip(
        limits,
        sides / metres,
        ("Cut through the middle, from the side", "Rows of knots, from above"),
        (("Along the flow", "z"), ("x", "y")),
        strict=True,
    ):
        place = (left + 0.5 * spare, BELOW + 0.5 * (tall - up))
        axes.append(plane_axes(figure, one, place, metres=metres, names=labels))
        axes[-1].set_title(title)
        left += spare + across + RIGHT + LEFT
    return figure, axes


def _draw_cuts(ax: Axes, cuts: list[Array]) -> None:
    looks: tuple[dict[str, Any], ...] = (
        {"colors": style.SLACK_GREY, "linewidths": 0.8, "label": AS_BUILT, "linestyles": [BUILT]},
        {"colors": style.BLACK, "linewidths": 1.1, "label": "last frame"},
    )
    for lines, look in zip(cuts, looks, strict=True):
        ax.add_collection(LineCollection(list(lines), clip_on=False, **look), autolim=False)


def _draw_row(ax: Axes, pair: list[Array], colour: str, name: str) -> None:
    """Draw a closed row of knots, as built and in the last frame, each (k, 2) m."""
    built, last = pair
    ax.plot(*built.T, color=colour, linewidth=0.6, linestyle=BUILT, clip_on=False)
    ax.plot(*last.T, color=colour, linewidth=1.1, label=name, clip_on=False)
