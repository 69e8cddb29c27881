"""Currents: what they offer, the one that is the same everywhere, and the smooth start of any of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from .ramp import ramp

Array = NDArray[np.float64]


class Current(Protocol):
    """What a current must offer; steady: it does not change with time; uniform: nor with place."""

    @property
    def steady(self) -> bool:
        """Whether the velocity is the same at all times."""

    @property
    def uniform(self) -> bool:
        """Whether the velocity is the same in all places."""

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity of the undisturbed water at points (n, 3) m and a time (s), (n, 3) m/s, contiguous."""


@dataclass(frozen=True)
class UniformCurrent:
    """The same velocity (3,) m/s everywhere and always."""

    value: tuple[float, float, float]
    steady: ClassVar[bool] = True
    uniform: ClassVar[bool] = True

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        return np.tile(np.array(self.value, dtype=float), (len(points), 1))


@dataclass(frozen=True)
class RampedCurrent:
    """A current that rises from rest at time 0 to its full strength at `duration` (s), by water.ramp.ramp."""

    full: Current
    duration: float
    steady: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not self.duration > 0.0:
            raise ValueError(f"the ramp of a current must take a time above 0 s, not {self.duration:g} s")

    @property
    def uniform(self) -> bool:
        """Whether the velocity is the same in all places."""
        return self.full.uniform

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        return self.full.velocity(points, time) * ramp(time, self.duration)


def at_full_strength(current: Current) -> Current:
    """Return the current without its ramp, for an equilibrium, which has no beginning."""
    return current.full if isinstance(current, RampedCurrent) else current


@dataclass(frozen=True)
class RelativeCurrent:
    """A current as it is seen from something that goes at a velocity (3,) m/s, in places that go with it."""

    full: Current
    tow: tuple[float, float, float]

    @property
    def steady(self) -> bool:
        """Whether the velocity is the same at all times."""
        return self.full.steady

    @property
    def uniform(self) -> bool:
        """Whether the velocity is the same in all places."""
        return self.full.uniform

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        return np.ascontiguousarray(self.full.velocity(points, time) - np.array(self.tow))
