"""Statics from a warm start: Newton's method on smoothed tension and slack (solve.smooth).

Begun at shape and tensions of a net like this one, an interior point would first have to leave the edge where most
bars are. The smoothed complementarity T w = mu needs neither T nor w above zero, so that Newton's method keeps what is
known of both, and bars go slack or taut on the way. mu falls as the bars' changes of mind do.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..forces.bars import borne
from ..forces.compiled import OPTIONS
from . import central_path as path
from .equilibrium import Equilibrium, typical_tension
from .linear import Solve
from .smooth import smooth_bars

Array = NDArray[np.float64]

# Tensions that differ from the elastic law's by less than CLOSE of the mean are those of a net's own shape; others were
# carried over from another net and say where the tension is, not which bars are just slack.
CLOSE = 1e-6
# First size (N) of the smoothing T w = size^2 over the mean tension, and what a whole step leaves of the size.
OWN, CARRIED = (1e-2, 0.1), (0.2, 0.25)
# Least size over the first.
LEAST = 1e-9
# Largest rotation of a bar in one step (rad).
LARGEST_ROTATION = 0.5


class Warm:
    """Steps on smoothed tension and slack."""

    def __init__(self, s: Equilibrium, tension: Array) -> None:
        """Begin with the tensions (m,) N of a net like this one, none below zero but those of two-way bars."""
        self.s = s
        mean = float(np.abs(tension).mean()) if np.any(tension > 0.0) else typical_tension(s.el, s.b.load)
        apart = float(np.abs(tension - borne(s.b.f, s.el)).mean())
        smoothing, self.shrink = OWN if apart < CLOSE * mean else s.smoothing or CARRIED
        # Of a net without any load or tension the size has only to be a number whose square is one.
        self.size = max(smoothing * mean, float(np.finfo(float).tiny) ** 0.25)
        self.least = LEAST * self.size
        m = len(tension)
        self.T, self.w = np.empty(m), np.empty(m)
        _start(tension, s.b.f, self.size, s.el.two_way, self.T, self.w)
        z = np.zeros
        self.along, self.p, self.r, self.bent, self.target = z(m), z(m), z(m), z(m), z(m)
        self.de, self.dT, self.dw = z(m), z(m), z(m)

    def step(self) -> float:
        """Newton step, with the elongation of second order in a second solve; return the length of the step taken."""
        s, b = self.s, self.s.b
        smooth_bars(self.T, self.w, b.f, self.size**2, s.el.two_way, self.p, self.r, self.target)
        # A bar on the edge resists turning as if it bore the smoothing's size: slack netting would swing about.
        _stiffness(self.T, self.p, b.k, self.size, b.t, b.length, s.el.two_way, self.along, b.block)
        solve = s.factor()
        turn = self._direction(solve, self.r)
        step = min(1.0, LARGEST_ROTATION / max(turn, LARGEST_ROTATION))
        path.second_order(s.x, b.dx, self.de, step, s.el, b.length, b.k, self.r, self.bent)
        self.target += self.p * (self.bent - self.r)
        turn = self._direction(solve, self.bent)
        step = LARGEST_ROTATION / max(turn, LARGEST_ROTATION)
        self.T += step * self.dT
        self.w += step * self.dw
        s.accept(step)
        if step == 1.0:
            self.size = max(self.shrink * self.size, self.least)
        return step

    def _direction(self, solve: Solve, r: Array) -> float:
        s, b = self.s, self.s.b
        path.path_right_side(b.load, self.T, self.target, s.el, b.t, s.pattern.free, b.total, b.right)
        s.move(solve)
        turn = path.bar_changes(b.dx, self.along, b.k, r, self.target, s.el, b.t, self.de, self.dT, self.dw)
        return float(turn)


@njit(**OPTIONS)
def _start(tension, f, size, two_way, T, w):
    """T and w (m,) N on T w = size^2: bars that bear tension keep it, the others keep the slack of the law f (N)."""
    for e in range(tension.shape[0]):
        if two_way[e]:
            T[e], w[e] = tension[e], 0.0
            continue
        known = tension[e] if tension[e] > size else min(f[e], 0.0)
        root = np.sqrt(known * known + 4.0 * size * size)
        # Written without the difference of two large numbers.
        big = 0.5 * (abs(known) + root)
        T[e] = big if known > 0.0 else size * size / big
        w[e] = size * size / T[e]


@njit(**OPTIONS)
def _stiffness(T, p, k, least, t, length, two_way, along, block):
    """Stiffness p k of every bar along itself into along (m,) N/m; with max(T, least)/L across into block (m, 3, 3)."""
    for e in range(T.shape[0]):
        along[e] = p[e] * k[e]
        across = (T[e] if two_way[e] else max(T[e], least)) / length[e]
        for i in range(3):
            for j in range(3):
                block[e, i, j] = (along[e] - across) * t[e, i] * t[e, j] + (across if i == j else 0.0)
