"""Newton's method on the equations of one implicit step.

Unknowns are the accelerations of the free knots and tension and slack of every bar (solve.smooth). The residual is
exact; the matrix of a large net is symmetrised, which halves the work of a factorization: what makes it unsymmetric,
the turning of bars in the water, is small beside inertia, drag and tension, and Newton then needs no more iterations.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry, elastic
from ..forces.inertia import mass_matrices
from ..forces.surroundings import Surroundings
from .central_path import bar_changes, second_order
from .linear import SMALL, Pattern, Solve, factorizer
from .smooth import assemble_step, smooth_bars, step_right_side

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MOST_NEWTON = 25
# Where the motion that is still to come is foretold, r may be so many times larger: it too falls in the last iteration.
FORCE_FORETOLD = 10.0
# Motion of an iteration over that of the one before it, from which nothing is foretold.
SLOW = 0.9
# Rotation of a bar in one Newton step (rad).
LARGEST_ROTATION = 0.5
# The elongation of second order is put in while it makes more than this part of the typical tension, in so many of the
# first Newton steps.
SECOND_ORDER, SECOND_ORDER_STEPS = 0.02, 6


class Ahead(NamedTuple):
    """What a step makes of the acceleration to be found: x = x0 + c0 a, v = v0 + c1 a; its local error constant."""

    c0: float
    c1: float
    x0: Array
    v0: Array
    error: float


class StepNewton:
    """Equations of the steps of n knots and m bars.

    x, v, a: (n, 3) and T, w: (m,) N, the present guess, and the solution in the end. u: (n, 3) m/s, the water, which is
    found anew for every guess where it changes;
    mu: smoothing (N2), see solve.smooth; scale: typical tension (N).
    """

    ahead: Ahead
    damps: Mask

    def __init__(self, surroundings: Surroundings, u: Array, mu: float, scale: float) -> None:
        self.surroundings, self.u, self.mu, self.scale = surroundings, u, mu, scale
        el = self.el = surroundings.system.elements
        n, m = len(el.free), len(el.knot_a)
        self.pattern = Pattern.of(el, surroundings.groups)
        self.symmetric = self.pattern.size > SMALL
        self.linear = factorizer(self.pattern, symmetric=self.symmetric)
        z = np.zeros
        self.t, self.load, self.total, self.mass = z((m, 3)), z((n, 3)), z((n, 3)), z((n, 6))
        self.length, self.f, self.k, self.damp = z(m), z(m), z(m), z(m)
        self.p, self.r, self.c, self.bent, self.along = z(m), z(m), z(m), z(m), z(m)
        self.de, self.dT, self.dw, self.dx = z(m), z(m), z(m), z((n, 3))
        self.right, self.data = z(3 * len(self.pattern.free)), z(len(self.pattern.indices))
        self.x, self.v, self.rel, self.a, self.T, self.w = u, u, u, z((n, 3)), z(m), z(m)
        self.evaluations = self.factorizations = 0

    def begin(self, ahead: Ahead, time: float, damps: Mask, a: Array, T: Array, w: Array) -> None:
        """Take up a step that ends at a time (s) from a guess; damps: (m,) bars whose twine damps in it."""
        # A step depends on the guess alone, so that a run may be taken up again at any.
        self.linear.renew()
        self.ahead, self.damps, self.time = ahead, damps, time
        self.surroundings.renew(ahead.x0, time)
        self.a[:], self.T[:], self.w[:] = a, T, w
        self._move()

    def _move(self) -> None:
        self.x, self.v = self.ahead.x0 + self.ahead.c0 * self.a, self.ahead.v0 + self.ahead.c1 * self.a

    def solve(self, motion_left: float, force_left: float) -> bool:
        """Go on until the motion still to come (m) and r (N), root mean squares, are below these; False if they stay.

        The motion to come is the last one, m, or q / (1 - q) m where iterations shrink by q: E. Hairer, G. Wanner,
        Solving ordinary differential equations II, section IV.8, 1996. Raises SingularMatrixError.
        """
        last = np.inf
        for iteration in range(MOST_NEWTON):
            part = self._iterate(iteration)
            moved, r = _rms(self.dx, len(self.pattern.free)), _rms(self.r, len(self.r))
            if not np.isfinite(moved):
                return False
            if part < 1.0:
                last = np.inf
                continue
            if moved < motion_left and r < force_left:
                return True
            if moved < SLOW * last < np.inf:
                to_come = moved * moved / (last - moved)
                if to_come < motion_left and r < FORCE_FORETOLD * force_left:
                    return True
            last = moved
        return False

    def _iterate(self, iteration: int) -> float:
        """One Newton iteration; returns the part of its step that was taken."""
        if iteration == 1:
            # The shelter was that of positions without the accelerations, which are off in long steps close to rest.
            self.surroundings.renew(self.x, self.time)
        self._residual()
        solve = self._factor()
        turn = self._direction(solve, self.r)
        if iteration < SECOND_ORDER_STEPS:
            second_order(self.x, self.dx, self.de, 1.0, self.el, self.length, self.k, self.r, self.bent)
            if np.abs(self.bent - self.r).max(initial=0.0) > SECOND_ORDER * self.scale:
                self.c += self.p * (self.bent - self.r)
                turn = self._direction(solve, self.bent)
        part = LARGEST_ROTATION / max(turn, LARGEST_ROTATION)
        self.a += (part / self.ahead.c0) * self.dx
        self.T += part * self.dT
        self.w += part * self.dw
        self._move()
        return part

    def _residual(self) -> None:
        """Geometry, law, loads and masses of the present guess; residuals of the bars' equations (N)."""
        self.el, self.u = self.surroundings.at(self.x, self.v, self.time)
        el = self.el
        bar_geometry(self.x, el, self.t, self.length)
        np.subtract(self.length, el.rest_length, out=self.de)
        elastic(self.de, el, self.f, self.k)
        if el.damped:
            rate = np.einsum("eq,eq->e", self.v[el.knot_b] - self.v[el.knot_a], self.t)
            self.damp = np.where(self.damps, el.damping_time * self.k, 0.0)
            self.f += self.damp * rate
        mass_matrices(self.x, el, self.mass)
        self.evaluations += 1
        self.rel = self.u - self.v
        self.surroundings.load(self.x, self.rel, el, self.t, self.length, self.load)
        smooth_bars(self.T, self.w, self.f, self.mu, el.two_way, self.p, self.r, self.c)

    def _factor(self) -> Solve:
        """Factorize the matrix of the step for accelerations over c0, so that it solves for motions."""
        p, c0, c1 = self.pattern, self.ahead.c0, self.ahead.c1
        if self.el.damped:
            # The slope of the law, what the rate of elongation adds included.
            self.k += self.damp * (c1 / c0)
        np.multiply(self.p, self.k, out=self.along)
        assemble_step(
            self.rel, self.el, self.t, self.length, self.T, self.along, 1.0, c1 / c0, 1.0 / c0, self.mass,
            self.symmetric, p.start, p.stride, p.diagonal, self.data,
        )  # fmt: skip
        self.surroundings.assemble(
            self.x, self.rel, 1.0, c1 / c0, p.groups, symmetric=self.symmetric, data=self.data
        )
        places = p.start, p.stride, p.diagonal
        self.surroundings.add_wetting(
            self.x, self.rel, self.el, self.t, self.length, places, p.groups,
            symmetric=self.symmetric, data=self.data,
        )  # fmt: skip
        self.factorizations += 1
        return self.linear.factor(self.data)

    def _direction(self, solve: Solve, r: Array) -> float:
        """Motion dx and the changes of the bars for the residual r; returns the largest rotation."""
        p, el = self.pattern, self.el
        step_right_side(
            self.load, self.T, self.c, self.a, self.mass, el, self.t, p.free, self.total, self.right
        )
        self.dx[p.free] = solve(self.right).reshape(-1, 3)
        return float(
            bar_changes(self.dx, self.along, self.k, r, self.c, el, self.t, self.de, self.dT, self.dw)
        )


def _rms(values: Array, count: int) -> float:
    """Root of the sum of squares over a count, by einsum, whose bits do not depend on the threads of BLAS."""
    return float(np.sqrt(np.einsum("i,i->", values.ravel(), values.ravel()) / max(count, 1)))
