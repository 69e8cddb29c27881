"""Statics near equilibrium: predictor and corrector on tension and slack (solve.central_path)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import central_path as path
from .equilibrium import Equilibrium
from .far_field import LEAST_CENTRING, Far
from .linear import Solve

Array = NDArray[np.float64]

# Fraction of the way to the edge that one step may take at least; more when the predictor does well.
TO_EDGE_NEAR = 0.95
# Largest rotation of a bar in one step (rad).
LARGEST_ROTATION = 0.5
# Least centring where rotations cut the step below CUT.
LEAST_CENTRING_CUT = 0.1
CUT = 0.3
# Least slack over tension, whose rounding is in it: slack that this eats leaves no length to a step. Least tension over
# slack, which is large in stiff bars: above zero.
LEAST_SLACK, LEAST_TENSION = float(np.finfo(float).eps), float(np.finfo(float).eps) ** 2


class Near:
    """Steps on tension and slack."""

    def __init__(self, s: Equilibrium, tension: Array, slack: Array) -> None:
        """Begin with these tensions and slacks, (m,) N, of one-way bars both above zero."""
        self.s, self.T, self.w = s, tension, np.where(s.el.two_way, 0.0, slack)
        m = len(tension)
        self.one_way = ~s.el.two_way
        self.count = max(int(np.count_nonzero(self.one_way)), 1)
        z = np.zeros
        self.along, self.target, self.cross, self.r, self.bent = z(m), z(m), z(m), z(m), z(m)
        self.de, self.dT, self.dw = z(m), z(m), z(m)
        self._keep_off_the_edge()

    @classmethod
    def after(cls, far: Far) -> Near:
        """Go on where the far field ends."""
        s, tiny = far.s, np.finfo(float).tiny
        gap = far.Y[:, 0] - np.linalg.norm(far.Y[:, 1:], axis=1)
        tension = np.where(s.el.two_way, far.tubes.T, np.maximum(far.Z[:, 0], tiny))
        return cls(s, tension, np.maximum(tension - s.b.f, np.maximum(s.el.stiffness * gap, tiny)))

    def step(self) -> float:
        """Predictor and corrector; return the length of the step taken."""
        s, b = self.s, self.s.b
        np.subtract(self.w, self.T, out=self.r)
        self.r += b.f
        two_way = s.el.two_way
        mu = path.path_product(self.T, self.w, self.dT, self.dw, 0.0, self.count)
        path.path_stiffness(self.T, self.w, b.k, b.t, b.length, two_way, self.along, b.block)
        solve = s.factor()
        self.cross[:] = 0.0
        turn = self._direction(solve, 0.0, self.r)
        affine = min(1.0, path.path_step(self.T, self.w, self.dT, self.dw, two_way))
        turning = min(1.0, LARGEST_ROTATION / max(turn, LARGEST_ROTATION))
        product = path.path_product(self.T, self.w, self.dT, self.dw, affine, self.count)
        # Of a net of two-way bars alone the product is zero.
        ratio = product / mu if mu > 0.0 else 0.0
        least = LEAST_CENTRING_CUT if turning < CUT else LEAST_CENTRING
        path.second_order(s.x, b.dx, self.de, min(affine, turning), s.el, b.length, b.k, self.r, self.bent)
        np.multiply(self.dT, self.dw, out=self.cross)
        self.cross *= affine * turning
        turn = self._direction(solve, min(1.0, max(ratio**3, least)) * mu, self.bent)
        turning = LARGEST_ROTATION / max(turn, LARGEST_ROTATION)
        edge = max(TO_EDGE_NEAR, 1.0 - ratio)
        step: float = min(turning, edge * path.path_step(self.T, self.w, self.dT, self.dw, two_way))
        self.T += step * self.dT
        self.w += step * self.dw
        self._keep_off_the_edge()
        s.accept(step)
        return step

    def _keep_off_the_edge(self) -> None:
        np.maximum(self.T, LEAST_TENSION * self.w, out=self.T, where=self.one_way)
        np.maximum(self.w, LEAST_SLACK * self.T, out=self.w, where=self.one_way)

    def _direction(self, solve: Solve, mu: float, r: Array) -> float:
        s, b = self.s, self.s.b
        path.path_target(mu, self.T, self.w, r, self.cross, s.el.two_way, self.target)
        path.path_right_side(b.load, self.T, self.target, s.el, b.t, s.pattern.free, b.total, b.right)
        s.move(solve)
        turn = path.bar_changes(b.dx, self.along, b.k, r, self.target, s.el, b.t, self.de, self.dT, self.dw)
        return float(turn)
