"""Axes in space: a net seen in perspective, obliquely from downstream, with one scale on x, y and z.

The net is projected here and drawn into plain axes, so that near bars hide far ones, and ticks and labels keep clear
of the box and of one another whatever its proportions.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from . import style
from .plane import size_of
from .ticks import number, round_values, text_size

Array = NDArray[np.float64]
Rectangle = tuple[float, float, float, float]

# Direction of the eye (deg): width and depth are both seen of a net that stands across x and bags along it.
AZIMUTH, ELEVATION = -40.0, 20.0
EYE = 3.5  # distance of the eye from the middle, in diagonals of the box
THINNEST = 0.16  # of the longest side: a flat net still has a box to stand in
TICK, GAP = 2.5, 3.0  # points
CLEAR = 9.0  # points, of ticks to the corner where two axes meet

# Of each axis: the corner (0 lower, 1 upper) where it stands, and the two steps that its grid lines take from there,
# over the floor or the first back wall to the second. Right for an eye at +x, -y, +z.
STANDS = ((0, 0, 0), (1, 0, 0), (0, 0, 0))
STEPS = ((1, 2), (0, 2), (1, 0))
# The axis of x ends where that of y begins, and their numbers would meet: how either limit moves inwards.
MEETS = ((0.0, -1.0), (1.0, 0.0), (0.0, 0.0))
GRID: dict[str, Any] = {"colors": style.GRID_GREY, "linewidths": 0.4, "zorder": 0.5, "clip_on": False}
FRAME: dict[str, Any] = {"colors": style.BLACK, "linewidths": 0.6, "zorder": 1.0, "clip_on": False}


@dataclass(frozen=True)
class View:
    """An eye on the middle of a box; axes: (3, 3) unit vectors to the right, up and towards the eye; distance: m."""

    middle: Array
    axes: Array
    distance: float

    def see(self, points: Array) -> Array:
        """Project points (n, 3) m to (n, 3): right and up, in m at the middle's distance, and nearness to the eye."""
        turned = (points - self.middle) @ self.axes.T
        turned[:, :2] *= (self.distance / (self.distance - turned[:, 2]))[:, None]
        return np.asarray(turned)


def view_of(corners: Array) -> View:
    """Return the view of a box given by its lower and upper corner (2, 3) m."""
    azimuth, elevation = np.deg2rad([AZIMUTH, ELEVATION])
    towards = np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    axes = np.array([right, np.cross(towards, right), towards])
    return View(corners.mean(axis=0), axes, EYE * float(np.linalg.norm(corners[1] - corners[0])))


def box(*points: Array) -> Array:
    """Return lower and upper corner (2, 3) of a box around all points (n, 3) m, nowhere thinner than THINNEST."""
    low = np.concatenate(points).min(axis=0)
    high = np.concatenate(points).max(axis=0)
    longest = float((high - low).max()) or 1.0
    half = np.maximum((high - low) * 1.02, THINNEST * longest) / 2.0
    middle = (low + high) / 2.0
    return np.array([middle - half, middle + half])


def far_to_near(seen: Array, bars: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the order in which bars between projected points (n, 3) are to be drawn."""
    return np.argsort(seen[bars, 2].sum(axis=1), kind="stable")


def seen_extent(corners: Array) -> Array:
    """Lower left and upper right (2, 2) of a box (2, 3) m as seen, in m."""
    seen = view_of(corners).see(np.array(list(product(*corners.T))))[:, :2]
    return np.array([seen.min(axis=0), seen.max(axis=0)])


def space_axes(figure: Figure, corners: Array, room: Rectangle) -> tuple[Axes, View]:
    """Add axes with a framed box (2, 3) m that fills the room; ticks and labels stand outside.

    room: left, bottom, width and height in inches.
    """
    page, size = np.array(figure.get_size_inches()), np.array(room[2:])
    ax = figure.add_axes((*(np.array(room[:2]) / page), *(size / page)), label="space")
    return ax, draw_space(ax, corners, (0.0, 0.0, *room[2:]))


def draw_space(ax: Axes, corners: Array, room: Rectangle) -> View:
    """Draw a framed box (2, 3) m that fills a room within axes, with its ticks and labels around; return the view.

    room: left, bottom, width and height in inches, from the lower left of the axes, which become a plane in m.
    """
    extent, page, size = seen_extent(corners), size_of(ax), np.array(room[2:])
    metres = float(((extent[1] - extent[0]) / size).max())  # per inch
    off = np.array(room[:2]) + size / 2.0 - page / 2.0
    limits = extent.mean(axis=0) - off * metres + np.outer([-0.5, 0.5], page * metres)
    ax.set(xlim=limits[:, 0], ylim=limits[:, 1])
    # Axes that a layout stretches afterwards show more of the plane, on one scale still.
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_axis_off()
    view = view_of(corners)
    for axis in range(3):
        _draw_axis(ax, view, corners, axis, metres)
    return view


def _draw_axis(ax: Axes, view: View, corners: Array, axis: int, metres: float) -> None:
    """Draw grid, line, ticks, numbers and label of one axis; metres: to an inch of paper."""
    start, stop = view.see(_edge(corners, axis, corners[:, axis]))[:, :2]
    outward = _outward(start, stop)
    side = corners[1, axis] - corners[0, axis]
    along = (stop - start) / side * 72.0 / metres
    clear = min(CLEAR / float(np.linalg.norm(along)), 0.3 * side) * np.array(MEETS[axis])
    values = round_values(corners[:, axis] + clear, along)
    on_edge = _edge(corners, axis, values)
    places = view.see(on_edge)[:, :2]
    tick = TICK * metres / 72.0 * outward
    frame = [np.array([start, stop]), *np.stack([places, places + tick], axis=1)]
    ax.add_collection(LineCollection(list(_grid(view, corners, axis, on_edge)), **GRID), autolim=False)
    ax.add_collection(LineCollection(frame, **FRAME), autolim=False)

    numbers = [number(value) for value in values]
    reaches = [_reach(len(text), style.SMALL_TYPE, outward) for text in numbers]
    for place, text, reach in zip(places, numbers, reaches, strict=True):
        u, v = place + (TICK + GAP + reach) * metres / 72.0 * outward
        ax.text(u, v, text, fontsize=style.SMALL_TYPE, ha="center", va="center")
    label = f"{'xyz'[axis]} (m)"
    upright = abs(outward[0]) > 0.9
    across = outward[::-1] if upright else outward
    beyond = TICK + 1.6 * GAP + 2.0 * max(reaches) + _reach(len(label), style.TYPE, across)
    u, v = (start + stop) / 2.0 + beyond * metres / 72.0 * outward
    ax.text(u, v, label, fontsize=style.TYPE, ha="center", va="center", rotation=90 if upright else 0)


def _edge(corners: Array, axis: int, values: Array) -> Array:
    """Points (k, 3) with these values on the edge where an axis stands."""
    points = np.tile(corners[STANDS[axis], range(3)], (len(values), 1))
    points[:, axis] = values
    return points


def _grid(view: View, corners: Array, axis: int, start: Array) -> Array:
    """Grid lines (k, 3, 2) as seen, from points on the edge of an axis (k, 3) over two back sides of the box."""
    path = [start]
    for across in STEPS[axis]:
        point = path[-1].copy()
        point[:, across] = corners[1 - STANDS[axis][across], across]
        path.append(point)
    return np.stack([view.see(points)[:, :2] for points in path], axis=1)


def _outward(start: Array, stop: Array) -> Array:
    """Unit vector (2,) on paper, across an edge and away from the middle of the box, which is seen at (0, 0)."""
    along = (stop - start) / np.linalg.norm(stop - start)
    middle = (start + stop) / 2.0
    away = middle - along * (along @ middle)
    return np.asarray(away / np.linalg.norm(away))


def _reach(characters: int, size: float, direction: Array) -> float:
    """Half the extent of a text along a direction on paper (points)."""
    return float(np.abs(direction) @ text_size(characters, size)) / 2.0
