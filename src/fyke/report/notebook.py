"""A result in a notebook: its numbers and a picture at a glance, and plots into anyone's axes."""

from __future__ import annotations

import base64
import html
import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from ..results.derive import summary
from ..solve.result import Result
from . import style
from .histories import curves, draw_history
from .plan import draw_plan
from .shapes import draw_shape, equilibrium_shape

# Bars that are drawn in a second or so; of more, a glance has the numbers only.
GLANCE_UP_TO = 20_000
GLANCE_DOTS = 110  # per inch


@dataclass(frozen=True)
class Plot:
    """Plots of a result; each draws into the axes that it is given, or into those of a new pyplot figure.

    All return the axes, and draw in the style of the figures for print whatever the settings are.
    """

    result: Result

    def shape(self, ax: Axes | None = None) -> Axes:
        """Draw the last frame in space, bars coloured by tension, into the rectangle of the axes."""
        ax = ax or _new_axes(*equilibrium_shape(self.result).get_size_inches(), filled=True)
        draw_shape(ax, self.result)
        return ax

    def tension(self, ax: Axes | None = None, *, panel: str | None = None) -> Axes:
        """Draw the tensions of the last frame on the netting laid flat; panel: which, where there are several.

        ValueError for a panel that is not there.
        """
        ax = ax or _new_axes(style.SINGLE_COLUMN, 0.9 * style.SINGLE_COLUMN)
        draw_plan(ax, self.result, panel)
        return ax

    def history(self, ax: Axes | None = None, *, of: str = "drag", current: ArrayLike | None = None) -> Axes:
        """Draw a value against time; of: "drag", "centre deflection", "largest tension" or "kinetic energy".

        current: (3,) of any length, the direction in which drag is counted; as for `histories` when left out.
        ValueError for a result of one frame and for a value that is not there.
        """
        told = {name.lower(): (name, values, unit) for name, values, unit in curves(self.result, current)}
        if len(self.result.time) < 2:
            raise ValueError(
                "a history needs two frames at least; this result has one, as that of a static solve"
            )
        if of not in told:
            raise ValueError(f"there is no history of {of!r}; choose one of {', '.join(told)}")
        name, values, unit = told[of]
        ax = ax or _new_axes(style.SINGLE_COLUMN, 0.6 * style.SINGLE_COLUMN)
        with style.house_style():
            draw_history(ax, self.result.time, values, name=name, unit=unit)
            ax.set_xlabel("Time (s)")
        return ax


def _new_axes(width: float, height: float, *, filled: bool = False) -> Axes:
    """Make axes in a figure of pyplot, which a notebook shows by itself; filled: axes as large as the figure."""
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(width, height), layout=None if filled else "constrained")
    return figure.add_axes((0.0, 0.0, 1.0, 1.0)) if filled else figure.add_subplot()


def glance(result: Result) -> str:
    """Return numbers and a small picture of a result as HTML, for a notebook to show it."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
        f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
        for name, value in _rows(result)
    )
    table = f"<table>{rows}</table>"
    if result.net.bar_count > GLANCE_UP_TO:
        return f"<div>{table}</div>"
    with io.BytesIO() as file:
        equilibrium_shape(result).savefig(file, format="png", dpi=GLANCE_DOTS)
        picture = base64.b64encode(file.getvalue()).decode()
    image = f"<img alt='shape and tensions of the last frame' src='data:image/png;base64,{picture}'/>"
    return f"<div style='display:flex;align-items:center;gap:1em'>{table}{image}</div>"


def _rows(result: Result) -> list[tuple[str, str]]:
    told: dict[str, Any] = summary(result)
    where = told["max_tension_bar_label"]
    last = float(result.time[-1])
    frames = "one frame" if len(result.time) == 1 else f"{len(result.time)} frames, up to {last:g} s"
    force, reaction = (np.round(told[k], 12).tolist() for k in ("hydrodynamic_force", "support_reaction"))
    rows = [
        ("title", told["title"]),
        ("outcome", f"{told['outcome']}: {told['message']}" if told["message"] else told["outcome"]),
        ("what to try", told["advice"]),
        ("knots, bars", f"{told['knots']}, {told['bars']}"),
        ("time", frames),
        ("largest tension", f"{told['max_tension']:.4g} N" + (f", bar {where}" if where else "")),
        ("slack bars", f"{told['slack_bars']} of {told['bars']}"),
        ("force of the water", _vector(force, "N")),
        ("force on supports", _vector(reaction, "N")),
        ("largest displacement", f"{told['max_displacement']:.4g} m"),
    ]
    return [row for row in rows if row[1]]


def _vector(values: list[float], unit: str) -> str:
    return "[" + ", ".join(f"{value:.4g}" for value in values) + f"] {unit}"
