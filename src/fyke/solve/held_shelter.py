"""Shelter that is held while the net finds its shape in it, and renewed there, until it leaves the net where it is.

The slower of the two ways of statics with shelter: for nets on which the other, a shelter that follows at every step,
does not arrive. Knots of slack netting at the rim of a dense wake are such: a little of the current more or less moves
them far, and they would step in and out of it for ever.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import borne
from .equilibrium import Equilibrium
from .outcome import Verdict

Array = NDArray[np.float64]

# Most renewals. Between two of them the unbalanced force falls to CLOSER of what the last one made.
MOST_RENEWALS, CLOSER = 100, 0.02
# Least part of a change of the shelter that is made.
LEAST_PART = 0.02

# Finds the shape in the shelter that is held, to a tolerance (N), from tensions (m,) N or none.
FindShape = Callable[[float, Array | None], Verdict]


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


def by_renewals(s: Equilibrium, tolerance: float, tension: Array | None, find_shape: FindShape) -> Verdict:
    """Hold the shelter, find the shape, renew the shelter there and so on; from tensions (m,) N or none.

    The net is in equilibrium when the unbalanced force in the shelter of its own shape is within tolerance (N).
    """
    s.follows = False
    water, approach, near_by = s.surroundings, Approach(), CLOSER * tolerance
    for renewal in range(1, MOST_RENEWALS + 1):
        verdict = find_shape(near_by, tension)
        if verdict[0] != "converged":
            return verdict
        held = water.left
        s.renew()
        if s.residual <= max(tolerance, s.floor):
            return "converged", f"{verdict[1]}, shelter renewed {renewal} times", ""
        near_by, tension = CLOSER * max(tolerance, s.residual), borne(s.b.f, s.el)
        water.left = approach.step(held, water.left)
        s.begin_at(s.x)
    s.renew()
    return (
        "stalled",
        f"the shelter still moves the net after {MOST_RENEWALS} renewals, by {s.residual:.1e} N",
        "leave the wake out, or take a factor for it that leaves more of the current; knots at the rim of a wake may "
        "step in and out of it",
    )
