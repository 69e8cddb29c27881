"""Currents."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

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
