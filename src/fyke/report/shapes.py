"""Figures of the net in space: before anything acts, and in equilibrium."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from numpy.typing import ArrayLike, NDArray

from ..netting.net import Net
from ..solve.result import Result
from . import style
from .bars import (
    draw_bars,
    draw_free_knots,
    draw_knots,
    draw_outline,
    draw_tension,
    legend_rows,
    line_width,
    name_marks,
    part_names,
    slack_name,
    tension_bar,
    tension_scale,
    thickness,
)
from .carried import brought_back, carried
from .ground import bed_under, draw_ground
from .parts import Bars, Knots, Outline, coloured_bars, parts_of, tied_knots
from .plane import size_of
from .space import View, box, draw_space, far_to_near, seen_extent

Array = NDArray[np.float64]

LEFT, RIGHT, LEGEND, NUMBERS, COLOUR_BAR, ARROW = 0.64, 0.25, 0.24, 0.42, 0.46, 0.3  # in, around the box
LEGEND_ROW = 0.13  # in, of each further row
LEAST = 0.3  # in, of the box in axes that are too small for what stands around it
ARROW_LENGTH = 0.32  # in, of a current across the line of sight
ARROW_LEFT, ARROWS_APART = 0.45, 1.55  # in, of the middle of the first, and to the next


@style.styled
def initial_position(
    result: Result, *, current: ArrayLike | None = None, waves: ArrayLike | None = None
) -> Figure:
    """Show the net before anything acts: its bars and knots, and which knots are fixed.

    current: (3,) m/s, and waves: (3,) direction in which they go, each shown as an arrow when given.
    """
    result = brought_back(result)
    net = result.net
    speed = 0.0 if current is None else float(np.linalg.norm(current))
    flows = (
        []
        if current is None or not speed
        else [(np.asarray(current, dtype=float), f"current, {speed:.3g} m/s")]
    )
    if waves is not None:
        flows.append((np.asarray(waves, dtype=float), "waves"))
    legend = _legend(net, "free knot", style.SINGLE_COLUMN)
    above = legend + (ARROW if flows else 0.0)
    figure, ax = _page(result, above=above, below=NUMBERS)
    view = _in_space(ax, result, above=above, below=NUMBERS)
    width = line_width(net.bar_count)

    def plain(points: Array, part: Bars) -> None:
        options = {"gid": "bars"} if part.colour is None else {"gid": "ropes", "label": part.name}
        colour, thick = part.colour or style.BLUE, 0.6 * part.width * width
        if part.diameter:
            thick = thickness(ax, part, net.bar_count)
        draw_bars(ax, points, net.bars[part.bars], colors=colour, linewidths=thick, **options)

    seen = view.see(net.positions)
    _draw_parts(ax, view, net, seen, plain)
    shown = tied_knots(net)
    for part in parts_of(net):
        if isinstance(part, Knots):
            shown[part.knots] = net.fixed[part.knots]
    draw_free_knots(ax, seen[shown, :2], net.fixed[shown])
    for place, (flow, words) in enumerate(flows):
        corner = ARROW_LEFT + place * ARROWS_APART, figure.get_figheight() - legend - ARROW / 2.0
        _draw_flow(figure, view, flow / np.linalg.norm(flow), words, corner)
    name_marks(figure)
    return figure


@style.styled
def equilibrium_shape(result: Result) -> Figure:
    """Show the last frame in space: every bar in the colour of its tension, slack bars grey and dashed."""
    shown = result.tension[-1][coloured_bars(result.net)]
    below = NUMBERS + (COLOUR_BAR if np.any(shown > 0.0) else 0.0)
    legend = _legend(result.net, slack_name(shown), style.SINGLE_COLUMN)
    figure, ax = _page(carried(result), above=legend, below=below)
    draw_shape(ax, result)
    return figure


@style.styled
def draw_shape(ax: Axes, result: Result) -> None:
    """Draw the last frame in space, with axes, colour bar and names, into the rectangle of plain axes as it is now."""
    result = carried(result)
    net, tension = result.net, result.tension[-1]
    shown = tension[coloured_bars(net)]
    taut, scale = bool(np.any(shown > 0.0)), tension_scale(shown)
    legend = _legend(net, slack_name(shown), float(size_of(ax)[0]))
    view = _in_space(ax, result, above=legend, below=NUMBERS + (COLOUR_BAR if taut else 0.0))

    def coloured(points: Array, part: Bars) -> None:
        bars = part.bars[far_to_near(seen, net.bars[part.bars])]
        if part.colour is None:
            draw_tension(ax, points, net.bars[bars], tension[bars], scale, named=slack_name(shown))
        else:
            options = {"linewidths": thickness(ax, part, net.bar_count), "zorder": 2.2, "gid": "ropes"}
            draw_bars(ax, points, net.bars[bars], colors=part.colour, label=part.name, **options)

    seen = view.see(result.position[-1])
    _draw_parts(ax, view, net, seen, coloured)
    if taut:
        tension_bar(ax, (0.55, 0.34, float(size_of(ax)[0]) - 1.1, 0.07), scale)
    name_marks(ax)


def _draw_parts(ax: Axes, view: View, net: Net, seen: Array, draw: Callable[[Array, Bars], None]) -> None:
    """Draw all parts of a net whose knots are seen at (n, 3); draw: how its bars are drawn."""
    for part in parts_of(net):
        if isinstance(part, Outline):
            draw_outline(ax, view.see(part.points)[:, :2], part)
        elif isinstance(part, Bars):
            draw(seen[:, :2], part)
        else:
            draw_knots(ax, seen[:, :2], part)


def _page(result: Result, *, above: float, below: float) -> tuple[Figure, Axes]:
    """Start a figure of one column with axes that fill it, as tall as the net needs; above, below: room in inches."""
    width = style.SINGLE_COLUMN - LEFT - RIGHT
    seen = np.ptp(seen_extent(_corners(result)), axis=0)
    height = float(np.clip(width * seen[1] / seen[0], 0.4 * width, 1.1 * width))
    figure = Figure(figsize=(style.SINGLE_COLUMN, below + height + above))
    return figure, figure.add_axes((0.0, 0.0, 1.0, 1.0), label="space")


def _corners(result: Result) -> Array:
    """Return the box of the first and the last shape, the same for both, so that figures compare."""
    return box(result.net.positions, result.position[-1])


def _in_space(ax: Axes, result: Result, *, above: float, below: float) -> View:
    """Draw the box of a net into axes, with room above and below it (in)."""
    width, height = np.maximum(size_of(ax) - [LEFT + RIGHT, above + below], LEAST).tolist()
    corners = _corners(result)
    view = draw_space(ax, corners, (LEFT, below, width, height))
    bed = bed_under(result)
    if bed is not None:
        draw_ground(ax, view, corners, bed)
    return view


def _legend(net: Net, other: str, width: float) -> float:
    """Room (in) of the legend over a net, in so many inches; other: what may be named besides its parts."""
    return LEGEND + LEGEND_ROW * (legend_rows(part_names(net, other), width) - 1)


def _draw_flow(figure: Figure, view: View, direction: Array, words: str, corner: tuple[float, float]) -> None:
    """Draw an arrow as a direction (3,) is seen, with words beside it; corner: in, of its middle."""
    draw_arrow(figure, view.axes[:2] @ direction, words, corner)


def draw_arrow(figure: Figure, step: Array, words: str, corner: tuple[float, float]) -> None:
    """Draw the arrow of a flow whose unit vector goes by a step (2,) on paper; corner: in, of its middle."""
    left, up = corner
    du, dv = step * ARROW_LENGTH / 2.0
    arrow = FancyArrowPatch(
        (left - du, up - dv),
        (left + du, up + dv),
        transform=figure.dpi_scale_trans,
        arrowstyle="-|>",
        mutation_scale=7.0,
        linewidth=1.0,
        color=style.VERMILION,
        shrinkA=0.0,
        shrinkB=0.0,
    )
    figure.add_artist(arrow)
    figure.text(
        left + ARROW_LENGTH / 2.0 + 0.08,
        up,
        words,
        transform=figure.dpi_scale_trans,
        ha="left",
        va="center",
    )
