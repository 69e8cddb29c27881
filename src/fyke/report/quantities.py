"""What the bars of a picture are coloured by: one value for each bar in each frame, with name and unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..results.derive import bar_lengths
from ..solve.result import Result

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BarQuantity:
    """A value of every bar: key, name with capital, unit, and values(result, frame index) -> (m,) in the unit."""

    key: str
    name: str
    unit: str
    values: Callable[[Result, int], Array]


def _tension(result: Result, index: int) -> Array:
    return np.asarray(result.tension[index])


def _strain(result: Result, index: int) -> Array:
    """Elongation over unloaded length in percent, 0 where slack."""
    return np.maximum(100.0 * (bar_lengths(result, index) / result.net.rest_length - 1.0), 0.0)


def _flow(result: Result, index: int) -> Array:
    """Velocity of the water past the middle of every bar, (m, 3) m/s: current, waves and shelter less its own."""
    start, end = result.net.bars.T
    velocity = result.velocity[index]
    return np.asarray(result.water_velocity[index] - 0.5 * (velocity[start] + velocity[end]))


def _local_velocity(result: Result, index: int) -> Array:
    return np.asarray(np.linalg.norm(_flow(result, index), axis=1))


def _angle(result: Result, index: int) -> Array:
    """Angle between a bar and the water that passes it in degrees: 0 along it, 90 across, 0 where none passes."""
    start, end = result.net.bars.T
    along, flow = result.position[index][end] - result.position[index][start], _flow(result, index)
    across = np.linalg.norm(np.cross(along, flow), axis=1)
    return np.asarray(np.degrees(np.arctan2(across, np.abs(np.einsum("eq,eq->e", along, flow)))))


QUANTITIES: dict[str, BarQuantity] = {
    q.key: q
    for q in (
        BarQuantity("tension", "Bar tension", "N", _tension),
        BarQuantity("strain", "Bar strain", "%", _strain),
        BarQuantity("velocity", "Local water velocity", "m/s", _local_velocity),
        BarQuantity("angle", "Angle of bar to flow", "deg", _angle),
    )
}
OF_MOVING_WATER = ("velocity", "angle")


def quantities(result: Result) -> tuple[BarQuantity, ...]:
    """Return the quantities that have values in some frame of a result: in still water at rest those of the twine."""
    flows = bool(np.any(result.water_velocity) or np.any(result.velocity))
    return tuple(q for q in QUANTITIES.values() if flows or q.key not in OF_MOVING_WATER)
