"""Currents that change with the depth. Above still water they are what they are at z = 0."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .current import Array


def depth_of(points: Array) -> Array:
    """Depth (n,) m of points (n, 3) m below still water, 0 above it."""
    return np.asarray(np.maximum(-points[:, 2], 0.0))


def between(depths: Array, velocities: Array, points: Array) -> Array:
    """Velocity (n, 3) m/s at points (n, 3) m, straight between depths (k,) m and held beyond the first and last.

    velocities: (k, 3) m/s, one for every depth; the depths rise.
    """
    if len(depths) == 1:
        return np.repeat(velocities, len(points), axis=0)
    where = depth_of(points)
    out = np.empty((len(points), 3))
    for axis in range(3):
        out[:, axis] = np.interp(where, depths, velocities[:, axis])
    return out


@dataclass(frozen=True)
class PowerCurrent:
    """U(z) = U_0 ((h + z) / h)^a: as at the surface above it, zero at the sea bed and below.

    surface: U_0, (3,) m/s; depth: h, m, of the sea bed; exponent: a, without unit, >= 0; 0 is a uniform current.
    DNV-RP-C205, 4.1.4.2, gives this form for tidal currents (known from others who cite it, not read).
    """

    surface: tuple[float, float, float]
    depth: float
    exponent: float
    steady: ClassVar[bool] = True
    uniform: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not (self.depth > 0.0 and self.exponent >= 0.0):
            found = f"depth {self.depth:g} m, exponent {self.exponent:g}"
            raise ValueError(f"a power law needs a depth above 0 and an exponent of 0 or more, not {found}")

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        height = np.clip(1.0 + points[:, 2] / self.depth, 0.0, 1.0)
        return np.asarray(np.multiply.outer(height**self.exponent, np.array(self.surface, dtype=float)))


@dataclass(frozen=True, eq=False)
class LayerCurrent:
    """Layers: a velocity holds from its depth down to the next depth, the first one also above.

    depths: (k,) m below still water, rising; velocities: (k, 3) m/s.
    """

    depths: Array
    velocities: Array
    steady: ClassVar[bool] = True
    uniform: ClassVar[bool] = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "depths", rising(self.depths, "depths"))
        object.__setattr__(self, "velocities", shaped(self.velocities, (len(self.depths), 3)))

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        layer = np.searchsorted(self.depths, depth_of(points), side="right") - 1
        return np.asarray(self.velocities[np.maximum(layer, 0)])


@dataclass(frozen=True, eq=False)
class TableCurrent:
    """Velocities at some depths: each component is straight between them and held beyond the first and last.

    depths: (k,) m below still water, rising; velocities: (k, 3) m/s. Where the direction turns from one depth to the
    next, the velocity between them lies on the chord, so equal speeds sag between their depths.
    """

    depths: Array
    velocities: Array
    steady: ClassVar[bool] = True
    uniform: ClassVar[bool] = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "depths", rising(self.depths, "depths"))
        object.__setattr__(self, "velocities", shaped(self.velocities, (len(self.depths), 3)))

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        return between(self.depths, self.velocities, points)


def rising(values: Array, what: str) -> Array:
    """Return values as an array (k,); ValueError unless there is one or more and each is above the one before."""
    array = np.ascontiguousarray(values, dtype=float)
    if array.ndim != 1 or not array.size or not np.all(np.isfinite(array)) or np.any(np.diff(array) <= 0.0):
        raise ValueError(f"the {what} of a current must rise from each to the next, not {array}")
    return array


def shaped(values: Array, shape: tuple[int, ...]) -> Array:
    """Return velocities as a contiguous array of this shape; ValueError for another one or what is not finite."""
    array = np.ascontiguousarray(values, dtype=float)
    if array.shape != shape or not np.all(np.isfinite(array)):
        raise ValueError(
            f"the velocities of a current must be finite and of shape {shape}, not {array.shape}"
        )
    return array
