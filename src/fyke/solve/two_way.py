"""Two-way bars beside the cones of the far field of statics.

Their tension T, of either sign, is an unknown of its own as in the near field (solve.central_path): the false stretch
of a turning bar makes a residual f(e) - T once, and no stiffness across the bar.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..forces.bars import add_tension
from ..forces.compiled import OPTIONS
from .central_path import second_order
from .equilibrium import Equilibrium

Array = NDArray[np.float64]


class TwoWay:
    """Tensions T (m,) N of the two-way bars of a net, zero in all others, and their changes dT in a step."""

    def __init__(self, s: Equilibrium, scale: float) -> None:
        """Begin with tensions up to a typical one, scale (N): a start that strains bars more does so by mistake."""
        self.s = s
        m = len(s.el.knot_a)
        self.any = bool(s.el.two_way.any())
        self.T = np.where(s.el.two_way, np.clip(s.b.f, -scale, scale), 0.0)
        z = np.zeros
        self.target, self.de, self.dT, self._bent = z(m), z(m), z(m), z(m)

    def stiffness(self) -> None:
        """Put their stiffness into the blocks of the net."""
        b = self.s.b
        if self.any:
            two_way_stiffness(self.T, b.k, b.t, b.length, self.s.el.two_way, b.block)
            self.target[:] = np.where(self.s.el.two_way, b.f - self.T, 0.0)

    def bend(self, step: float) -> None:
        """Put the elongation of second order of a step along the last motion into the target."""
        s, b = self.s, self.s.b
        if self.any:
            second_order(s.x, b.dx, self.de, step, s.el, b.length, b.k, self.target, self._bent)
            self.target[:] = np.where(s.el.two_way, self._bent, 0.0)

    def load(self) -> Array:
        """Load of the net with the tensions that come without motion, (n, 3) N."""
        b = self.s.b
        if not self.any:
            return b.load
        load = b.load.copy()
        add_tension(self.T + self.target, self.s.el, b.t, load)
        return load

    def changes(self) -> float:
        """Changes of tension in the last motion; returns the largest rotation (rad)."""
        s, b = self.s, self.s.b
        if not self.any:
            return 0.0
        return float(two_way_changes(b.dx, b.k, self.target, s.el, b.t, self.de, self.dT))


@njit(**OPTIONS)
def two_way_stiffness(T, k, t, length, two_way, block):
    """Stiffness k along and T/L across every two-way bar into block (m, 3, 3) N/m."""
    for e in range(T.shape[0]):
        if two_way[e]:
            across = T[e] / length[e]
            for p in range(3):
                for q in range(3):
                    block[e, p, q] = (k[e] - across) * t[e, p] * t[e, q] + (across if p == q else 0.0)


@njit(**OPTIONS)
def two_way_changes(dx, k, target, el, t, de, dT):
    """Elongation de (m,) m and change of tension dT (m,) N for a motion dx (n, 3) m; return the largest rotation."""
    rotation = 0.0
    for e in range(k.shape[0]):
        if not el.two_way[e]:
            continue
        a, b = el.knot_a[e], el.knot_b[e]
        d0, d1, d2 = dx[b, 0] - dx[a, 0], dx[b, 1] - dx[a, 1], dx[b, 2] - dx[a, 2]
        de[e] = d0 * t[e, 0] + d1 * t[e, 1] + d2 * t[e, 2]
        across = np.sqrt(max(d0 * d0 + d1 * d1 + d2 * d2 - de[e] * de[e], 0.0))
        rotation = max(rotation, across / el.rest_length[e])
        dT[e] = target[e] + k[e] * de[e]
    return rotation
