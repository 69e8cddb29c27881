"""What the bars of a picture are coloured by: one value for each bar in each frame, with name and unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..results.derive import bar_lengths
from ..solve.result import Result

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BarQuantity:
    """A value of every bar: key, name with capital, unit, and values(result, frame index, current) -> (m,) in the unit.

    current: (3,) m/s of the undisturbed water, None where it is not known; needs_current: whether there are no values
    without it.
    """

    key: str
    name: str
    unit: str
    values: Callable[[Result, int, Array | None], Array]
    needs_current: bool = False


def _tension(result: Result, index: int, _current: Array | None) -> Array:
    return np.asarray(result.tension[index])


def _strain(result: Result, index: int, _current: Array | None) -> Array:
    """Elongation over unloaded length in percent, 0 where slack."""
    return np.maximum(100.0 * (bar_lengths(result, index) / result.net.rest_length - 1.0), 0.0)


def _local_velocity(result: Result, index: int, current: Array | None) -> Array:
    """Speed of the undisturbed water past the middle of a bar; of the bar itself where no current is known."""
    start, end = result.net.bars.T
    velocity = 0.5 * (result.velocity[index][start] + result.velocity[index][end])
    return np.asarray(np.linalg.norm((0.0 if current is None else current) - velocity, axis=1))


def _angle(result: Result, index: int, current: Array | None) -> Array:
    """Angle between a bar and the current in degrees: 0 along it, 90 across."""
    start, end = result.net.bars.T
    along = result.position[index][end] - result.position[index][start]
    if current is None or not np.any(current):
        return np.zeros(len(along))
    across = np.linalg.norm(np.cross(along, current), axis=1)
    return np.asarray(np.degrees(np.arctan2(across, np.abs(along @ current))))


QUANTITIES: dict[str, BarQuantity] = {
    q.key: q
    for q in (
        BarQuantity("tension", "Bar tension", "N", _tension),
        BarQuantity("strain", "Bar strain", "%", _strain),
        BarQuantity("velocity", "Local water velocity", "m/s", _local_velocity),
        BarQuantity("angle", "Angle of bar to current", "deg", _angle, needs_current=True),
    )
}


def quantities(current: ArrayLike | None) -> tuple[BarQuantity, ...]:
    """Return the quantities that have values with a current (3,) m/s, or without one."""
    flows = current is not None and bool(np.any(current))
    return tuple(q for q in QUANTITIES.values() if flows or not q.needs_current)
