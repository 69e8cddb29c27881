"""Figure of the tension of every bar on the netting laid flat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..netting.net import Net, Panel
from ..solve.result import Result
from . import style
from .bars import (
    draw_bars,
    draw_knots,
    draw_tension,
    legend_rows,
    name_marks,
    part_names,
    shown_tensions,
    slack_name,
    tension_bar,
    tension_scale,
    thickness,
)
from .parts import Bars, Knots, parts_of
from .plane import draw_plane, frame, plane_axes, size_of

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEFT, RIGHT, BELOW, LEGEND, TITLE, COLOUR_BAR, COLOUR_BAR_UNDER = 0.6, 0.1, 0.38, 0.26, 0.18, 0.62, 0.46  # in
LEGEND_ROW = 0.13  # in, of each further row of the legend
TALLEST = 1.3  # height over width of a plan
LEAST_HEIGHT, COLOUR_BAR_LENGTH = 0.65, 1.15  # in, for the labels beside them
COLUMNS = 3  # panels side by side


@dataclass(frozen=True)
class _Plan:
    """Netting laid flat: points (k, 2) m, the knot of the net at each (k,), bars between them, ends (b, 2).

    bars: (b, s) bars of the net, the segments of each.
    """

    title: str
    names: tuple[str, str]
    points: Array
    knots: Indices
    ends: Indices
    bars: Indices

    def tension(self, result: Result) -> Array:
        """Largest tension of the segments of every bar in the last frame, (b,) N."""
        return np.asarray(result.tension[-1][self.bars].max(axis=1, initial=0.0))

    def between(self, bars: Indices) -> Indices:
        """Places (k, 2) of those bars (m, 2) of the net whose two knots are on the plan, at a seam the nearer ones."""
        first = np.full(max(int(self.knots.max()), int(bars.max(initial=0))) + 1, -1)
        last = first.copy()
        first[self.knots[::-1]] = np.arange(len(self.knots))[::-1]
        last[self.knots] = np.arange(len(self.knots))
        there = bars[np.all(first[bars] >= 0, axis=1)]
        ways = np.array([[a[there[:, 0]], b[there[:, 1]]] for a in (first, last) for b in (first, last)])
        apart = np.linalg.norm(self.points[ways[:, 0]] - self.points[ways[:, 1]], axis=2)
        return np.asarray(ways[apart.argmin(axis=0), :, np.arange(len(there))])


@style.styled
def tension_plan(result: Result) -> Figure:
    """Show the tension of every bar on the netting laid flat, as it was before anything acted.

    One plan per panel, in the panel's own width and height; bars of no panel are left out. A net without panels is
    seen square to the plane that fits its knots best.
    """
    plans = _plans(result.net)
    shown = np.concatenate([plan.tension(result) for plan in plans])
    # Bars along the seam of closed netting are on its plan twice.
    once = np.unique(np.concatenate([plan.bars[:, 0] for plan in plans]), return_index=True)[1]
    scale, taut, slack = tension_scale(shown), bool(np.any(shown > 0.0)), slack_name(shown[once])
    names = part_names(result.net, slack)
    sheet = _Sheet.holding([frame(plan.points) for plan in plans], colour_bar=taut, names=names)
    figure = Figure(figsize=(sheet.width, sheet.height))
    for index, plan in enumerate(plans):
        limits, left, bottom = sheet.place(index)
        ax = plane_axes(figure, limits, (left, bottom), metres=sheet.metres, names=plan.names)
        ax.set_title(plan.title)
        _draw_netting(ax, result, plan, scale, named=slack)
    if taut:
        tension_bar(figure, sheet.colour_bar, scale)
    name_marks(figure)
    return figure


@style.styled
def draw_plan(ax: Axes, result: Result, panel: str | None = None) -> None:
    """Draw the plan of a panel, or of the only one, into axes, with a colour bar that takes its room from them.

    ValueError for a name that no panel has, and without a name where there are several.
    """
    plans = {named.name: plan for named, plan in zip(result.net.panels, _plans(result.net), strict=False)}
    if panel is None and len(plans) < 2:
        (plan,) = _plans(result.net)
    elif panel in plans:
        plan = plans[panel]
    else:
        asked = "the net has several panels" if panel is None else f"the net has no panel {panel!r}"
        raise ValueError(f"{asked}; choose one of {', '.join(plans) or 'none'}")
    tension = plan.tension(result)
    scale, limits = tension_scale(tension), frame(plan.points)
    if np.any(tension > 0.0):
        figure: Any = ax.get_figure(root=True)
        mappable, options = shown_tensions(scale)
        figure.colorbar(mappable, ax=ax, **options)
    metres = float((np.ptp(limits, axis=0) / size_of(ax)).max())
    draw_plane(ax, limits, metres=metres, names=plan.names)
    _draw_netting(ax, result, plan, scale, named=slack_name(tension))
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)


def _draw_netting(ax: Axes, result: Result, plan: _Plan, scale: Normalize, *, named: str) -> None:
    """Draw bars and marked knots of a plan; named: slack bars in the legend."""
    draw_tension(ax, plan.points, plan.ends, plan.tension(result), scale, named=named)
    for part in parts_of(result.net):
        if isinstance(part, Bars) and part.colour is not None:
            ends = plan.between(result.net.bars[part.bars])
            thick = thickness(ax, part, len(plan.ends))
            options = {"linewidths": thick, "zorder": 2.2, "gid": "ropes"}
            if len(ends):
                draw_bars(ax, plan.points, ends, colors=part.colour, label=part.name, **options)
        elif isinstance(part, Knots):
            shown = np.flatnonzero(np.isin(plan.knots, part.knots))
            draw_knots(ax, plan.points, replace(part, knots=shown))


@dataclass(frozen=True)
class _Sheet:
    """Plans in rows and columns, all on one scale; lengths in inches, metres: to an inch.

    limits: (2, 2) m of each plan; cell: width and height of the room that each has for its axes; low, end: room under
    the last row and at the right, with the colour bar if there is one; legend: above.
    """

    limits: list[Array]
    columns: int
    rows: int
    metres: float
    cell: tuple[float, float]
    low: float
    end: float
    width: float
    legend: float

    @classmethod
    def holding(cls, limits: list[Array], *, colour_bar: bool, names: list[str]) -> _Sheet:
        columns = min(len(limits), COLUMNS)
        rows = -(-len(limits) // columns)
        page = style.SINGLE_COLUMN if columns == 1 else style.DOUBLE_COLUMN
        sides = np.max([np.ptp(one, axis=0) for one in limits], axis=0)

        def lay(end: float) -> tuple[float, float, float]:
            width = (page - end) / columns - LEFT
            metres = float(max(sides[0] / width, sides[1] / (TALLEST * width)))
            return width, max(float(sides[1]) / metres, LEAST_HEIGHT), metres

        legend = LEGEND + LEGEND_ROW * (legend_rows(names, page) - 1)
        low, end = 0.0, COLOUR_BAR if colour_bar else RIGHT
        width, height, metres = lay(end)
        if colour_bar and rows * height < COLOUR_BAR_LENGTH:
            low, end = COLOUR_BAR_UNDER, RIGHT
            width, height, metres = lay(end)
        return cls(limits, columns, rows, metres, (width, height), low, end, page, legend)

    @property
    def step(self) -> float:
        """Height of a row with its title and labels."""
        return BELOW + self.cell[1] + (TITLE if len(self.limits) > 1 else 0.0)

    @property
    def height(self) -> float:
        return self.low + self.rows * self.step + self.legend

    @property
    def colour_bar(self) -> tuple[float, float, float, float]:
        """Left, bottom, width and height: under the plans where they are flat, else at their right."""
        if self.low:
            return LEFT, 0.34, self.width - LEFT - RIGHT, 0.07
        length = min(self.height - BELOW - self.legend, 3.0)
        middle = (BELOW + self.height - self.legend) / 2.0
        return self.width - self.end + 0.12, middle - length / 2.0, 0.07, length

    def place(self, index: int) -> tuple[Array, float, float]:
        """Limits of a plan, and left and bottom of its axes, in the middle of its cell."""
        row, column = divmod(index, self.columns)
        spare = (np.array(self.cell) - np.ptp(self.limits[index], axis=0) / self.metres) / 2.0
        left = LEFT + column * (LEFT + self.cell[0]) + float(spare[0])
        bottom = self.low + BELOW + (self.rows - 1 - row) * self.step + float(spare[1])
        return self.limits[index], left, bottom


def _plans(net: Net) -> list[_Plan]:
    if net.panels:
        return [_plan_of(net, panel, title=len(net.panels) > 1) for panel in net.panels]
    offsets = net.positions - net.positions.mean(axis=0)
    axes = np.linalg.svd(offsets, full_matrices=False)[2][:2]
    # The sign of a singular vector is arbitrary: let its largest component be positive.
    axes *= np.sign(axes[[0, 1], np.abs(axes).argmax(axis=1)])[:, None]
    knots, bars = np.arange(net.knot_count), np.arange(net.bar_count)[:, None]
    return [_Plan("", ("Along", "Across"), offsets @ axes.T, knots, net.bars, bars)]


def _plan_of(net: Net, panel: Panel, *, title: bool) -> _Plan:
    name, names = panel.name if title else "", ("Round" if panel.closed else "Width", "Height")
    return _Plan(name, names, _laid_flat(net, panel), panel.knots, panel.lattice.bars, panel.bars)


def _laid_flat(net: Net, panel: Panel) -> Array:
    """Where the lattice knots lie on the netting laid flat (k, 2) m, every row as wide as it was built."""
    grid, points = panel.lattice, panel.flat
    if panel.folds or panel.cuts:
        return points  # rows that cut the corners of a box short, or end at a cut, are no narrower netting
    order = np.lexsort((grid.knots[:, 0], grid.knots[:, 1]))
    j, across = grid.knots[order, 1], points[order, 0]
    step = np.linalg.norm(np.diff(net.positions[panel.knots[order]], axis=0), axis=1)
    row = j[1:] == j[:-1]
    length = np.bincount(j[1:][row], step[row], minlength=grid.intervals[1] + 1)
    spans = np.bincount(j[1:][row], np.diff(across)[row], minlength=grid.intervals[1] + 1)
    told = np.flatnonzero(spans)
    if len(told):
        wider = np.interp(np.arange(len(spans)), told, length[told] / spans[told])
        points[:, 0] *= wider[grid.knots[:, 1]]
    return points
