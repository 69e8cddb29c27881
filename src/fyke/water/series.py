"""Currents that change with time, as they were measured or computed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .current import Array
from .profile import between, rising, shaped


@dataclass(frozen=True, eq=False)
class SeriesCurrent:
    """Velocities at some times and depths, straight between both and held beyond the first and last.

    times: (t,) s, rising, 0 where a run begins; depths: (k,) m below still water, rising; velocities: (t, k, 3) m/s.
    One depth makes it uniform, one time steady.
    """

    times: Array
    depths: Array
    velocities: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", rising(self.times, "times"))
        object.__setattr__(self, "depths", rising(self.depths, "depths"))
        shape = (len(self.times), len(self.depths), 3)
        object.__setattr__(self, "velocities", shaped(self.velocities, shape))

    @property
    def steady(self) -> bool:
        """Whether the velocity is the same at all times."""
        return len(self.times) == 1

    @property
    def uniform(self) -> bool:
        """Whether the velocity is the same in all places."""
        return len(self.depths) == 1

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity at every point, (n, 3) m/s."""
        return between(self.depths, self._table(time), points)

    def _table(self, time: float) -> Array:
        """Velocities (k, 3) m/s at the depths at one time (s)."""
        later = int(np.searchsorted(self.times, time, side="right"))
        if later in (0, len(self.times)):
            return np.asarray(self.velocities[0 if later == 0 else -1])
        start, end = self.times[later - 1 : later + 1]
        share = (time - start) / (end - start)
        return np.asarray((1.0 - share) * self.velocities[later - 1] + share * self.velocities[later])
