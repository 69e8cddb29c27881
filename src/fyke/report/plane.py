"""Axes in a plane with one scale on both axes, as tall and wide as what they show."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .ticks import number, round_values

Array = NDArray[np.float64]

THINNEST = 0.12  # of the longer side: a straight row of bars still has axes to stand in


def frame(*points: Array) -> Array:
    """Return lower left and upper right (2, 2) of a frame with a margin around all points (n, 2)."""
    low = np.concatenate(points).min(axis=0)
    high = np.concatenate(points).max(axis=0)
    longest = float((high - low).max()) or 1.0
    half = np.maximum(high - low + 0.04 * longest, THINNEST * longest) / 2.0
    return np.array([(low + high) / 2.0 - half, (low + high) / 2.0 + half])


def plane_axes(
    figure: Figure, limits: Array, room: tuple[float, float], *, metres: float, names: tuple[str, str]
) -> Axes:
    """Add axes with limits (2, 2) m on a scale of so many metres to an inch.

    room: left and bottom in inches; names: of the axes, without unit.
    """
    page = figure.get_size_inches()
    size = np.ptp(limits, axis=0) / metres
    ax = figure.add_axes((*(np.array(room) / page), *(size / page)), label="plane")
    draw_plane(ax, limits, metres=metres, names=names)
    return ax


def draw_plane(ax: Axes, limits: Array, *, metres: float, names: tuple[str, str]) -> None:
    """Give axes limits (2, 2) m, ticks for a scale of so many metres to an inch, and labels; names: without unit."""
    ax.set(xlim=limits[:, 0], ylim=limits[:, 1], aspect="equal")
    ax.set(xlabel=f"{names[0]} (m)", ylabel=f"{names[1]} (m)")
    for axis, ends, direction in zip((ax.xaxis, ax.yaxis), limits.T, np.eye(2), strict=True):
        values = round_values(ends, direction * 72.0 / metres)
        axis.set_ticks(list(values), [number(value) for value in values])


def size_of(ax: Axes) -> Array:
    """Width and height of axes in inches, as they stand now."""
    figure: Any = ax.get_figure(root=True)
    return np.asarray(np.array([ax.bbox.width, ax.bbox.height]) / figure.dpi)
