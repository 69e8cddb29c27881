"""How a shelter that is held goes to the one that the net's shape in it would have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Least part of a change of the shelter that is made.
LEAST_PART = 0.02
# So many steps in a row of at least this length that leave the residual above its least are no gain.
NO_GAIN_STEPS, LONG = 4, 0.5


class Approach:
    """Steps of the shelter from the one held towards the one that the shape found in it would have.

    Each makes that part of the change which would have ended the last change along itself, the first a whole one:
    Aitken's process for vectors, as fluid-structure solvers use it (U. Kuettler, W.A. Wall, Comput. Mech. 43, 2008;
    known, not read).
    """

    def __init__(self) -> None:
        self._part = 1.0
        self._change: Array | None = None

    def step(self, held: Array, found: Array) -> Array:
        """Return the shelter (n, 1) to hold next."""
        last, change = self._change, found - held
        if last is not None:
            turn = change - last
            size = float(np.einsum("nq,nq->", turn, turn))
            part = -self._part * float(np.einsum("nq,nq->", last, turn)) / size if size > 0.0 else self._part
            self._part = min(max(part, LEAST_PART), 1.0)
        self._change = change
        return np.asarray(held + self._part * change)


class Gain:
    """Whether steps that are long still gain anything: a shelter that follows at once may drive a net to and fro."""

    def __init__(self) -> None:
        self._least, self._without = np.inf, 0

    def none(self, residual: float, step: float) -> bool:
        """Take note of a step and of the residual (N) after it; whether that is the end of all gain."""
        gained = residual < self._least
        self._least = min(residual, self._least)
        self._without = 0 if gained or step < LONG else self._without + 1
        return self._without >= NO_GAIN_STEPS
