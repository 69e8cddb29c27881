"""System and State: what the forces and solvers work on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..netting.net import Net
from ..water.current import Current
from .elements import Elements

Array = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """Time (s), position (n, 3) m, velocity (n, 3) m/s.

    tension: (m,) N where a method knows it better than the elastic law does from positions that it does not resolve to
    the nanometre; None to take the law.
    """

    time: float
    position: Array
    velocity: Array
    tension: Array | None = None


@dataclass(frozen=True)
class System:
    """A net in water, frozen: the net, the current and the arrays of the kernels.

    weight_in_water: weight less buoyancy of bars and knots, N, positive when it sinks; sources: one line for each
    law, with what it says and where it comes from; case_text: the case file behind it, "" when made in Python.
    """

    net: Net
    current: Current
    elements: Elements
    weight_in_water: float
    sources: tuple[str, ...] = ()
    case_text: str = ""

    def at_rest(self) -> State:
        """Return the state that the net was built in, at rest at time 0."""
        return State(0.0, self.net.positions.copy(), np.zeros_like(self.net.positions))
