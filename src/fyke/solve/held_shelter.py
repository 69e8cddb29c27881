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
from .approach import Approach
from .equilibrium import Equilibrium
from .outcome import Verdict

Array = NDArray[np.float64]

# Most renewals. Between two of them the unbalanced force falls to CLOSER of what the last one made.
MOST_RENEWALS, CLOSER = 100, 0.02

# Finds the shape in the shelter that is held, to a tolerance (N), from tensions (m,) N or none.
FindShape = Callable[[float, Array | None], Verdict]


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
