"""Currents."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Current(Protocol):
    """What a current must offer."""

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity of the undisturbed water at points (n, 3) m and a time (s), (n, 3) m/s, contiguous."""


@dataclass(frozen=True)
class UniformCurrent:
    """The same velocity (3,) m/s everywhere and always."""

    value: tuple[float, float, float]

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        return np.tile(np.array(self.value, dtype=float), (len(points), 1))
