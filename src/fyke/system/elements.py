"""Elements: the plain arrays that the compiled kernels read."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .curves import BarCurves

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class Elements(NamedTuple):
    """n knots and m bars as the kernels see them; every array is contiguous.

    knot_a, knot_b: (m,) ends of a bar, unsigned so that no kernel looks for negative indices; rest_length: (m,) m;
    stiffness: (m,) N/m, dT/dl of a linear law, and of any other law the secant at REFERENCE_STRAIN;
    damping_time: (m,) s; normal_drag, tangential_drag: (m,) kg/m2, half of 1/2 rho C d, so that each end gets
    coefficient x length x |w| w, at a reference where DragLaws change it; bar_added_mass: (m,) kg, half of
    C_a rho pi/4 d^2 l0, normal to the bar, for each end; law_rows: (r, 5), see netting.elastic; law_first, law_end:
    (m,) rows of a bar; linear: every law is linear; damped: some damping time is not zero; knot_drag: (n,) kg/m,
    1/2 rho C_D pi/4 d_k^2; knot_mass: (n,) kg, isotropic: half of each bar, the knot and its added mass; weight: (n, 3)
    N, weight less buoyancy and dead load; free: (n,) 1 where free, 0 where held.
    drag_slopes: (4, m), knot_slopes: (n,), where normal_drag, tangential_drag and knot_drag are those of one moment:
    their slopes, see forces.laws; else (4, 0) and (0,). two_way: (m,) whether a bar pushes, too, as a tube does.
    """

    knot_a: NDArray[np.uint32]
    knot_b: NDArray[np.uint32]
    rest_length: Array
    stiffness: Array
    damping_time: Array
    normal_drag: Array
    tangential_drag: Array
    bar_added_mass: Array
    law_rows: Array
    law_first: NDArray[np.int32]
    law_end: NDArray[np.int32]
    linear: bool
    damped: bool
    knot_drag: Array
    knot_mass: Array
    weight: Array
    free: Array
    drag_slopes: Array
    knot_slopes: Array
    two_way: NDArray[np.bool_]


class DragLaws(NamedTuple):
    """What makes the present coefficients of drag of those in Elements, which are at curves.REFERENCE_REYNOLDS.

    bar_reynolds: (m,), knot_reynolds: (n,) s/m, thickness over viscosity; bars: C_n and C_t over that C_n; knots: C_D
    over that of knots, (INTERVALS, 4), or (0, 4) where it is constant; knot_share: (n,) part of knot_drag that belongs
    to the knot and not to a body at it, whose coefficient is constant.
    """

    bar_reynolds: Array
    bars: BarCurves
    knot_reynolds: Array
    knots: Array
    knot_share: Array

    def of(self, bars: Indices, knots: Indices) -> DragLaws:
        """Return the laws of some of the bars and knots, or of all in another order."""
        return self._replace(
            bar_reynolds=self.bar_reynolds[bars],
            knot_reynolds=self.knot_reynolds[knots],
            knot_share=self.knot_share[knots],
        )
