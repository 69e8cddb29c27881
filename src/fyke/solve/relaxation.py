"""Statics by relaxation in time: the second way, for nets on which the interior point does not arrive.

The net sinks and drifts towards rest through a very viscous water without inertia,
    C dx/dt = F(x),
C a drag per knot, by the linearly implicit Euler method with steps h that grow as the net comes to rest
(pseudo-transient continuation, Kelley & Keyes 1998). The shift C/h keeps the matrix regular where parts of the net
have no stiffness or a negative one, as slack netting has that a current blows along itself. Tension and slack are
unknowns of their own with the smoothed complementarity of solve.smooth. Close to rest the near field
(solve.near_field) tries to finish.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..forces.bars import add_tension, borne, largest_on_free
from ..forces.compiled import OPTIONS
from . import central_path as path
from .equilibrium import Equilibrium, typical_tension
from .linear import SingularMatrixError, Solve
from .near_field import Near
from .smooth import begin_smooth, smooth_bars

Array = NDArray[np.float64]

# Root of the smoothing's mu over the typical tension; when a relaxation of so many iterations has not come to rest, it
# begins once more with the second.
SMOOTHING, SMOOTHER_STILL, FIRST_STEPS = 0.1, 0.5, 450
# Rotation of a bar that a step aims at, and beyond which it is not taken (rad).
ROTATION, LARGEST_ROTATION = 0.25, 0.5
# A step is at most GROWTH times the last. Where the net gathers speed it has left a rest that was none: not longer, and
# back to BACK of its length when it gathers more than FASTER times.
GROWTH, FASTER, BACK = 2.0, 3.0, 1e-2
# Least change of the step when its rotations were too large.
LEAST_CHANGE, LEAST_AGAIN = 0.25, 0.1
# Least step in units of a bar's length moved by the mean load; and the one from which steps are Newton's, which may go
# to and fro for ever between two shapes.
LEAST_STEP, LONGEST_STEP = 1e-12, 1e3
# Share of the drag that is the same on all knots; the rest goes with what the water finds on the knot.
EVEN = 0.1
# Motions across bars are over no less than this part of their unloaded length.
SHORTEST = 1e-3
# Elongation of second order, over the typical tension, that is worth a second solve.
SECOND_ORDER = 1e-3
# The near field is tried when the unbalanced force is below READY of the typical tension, and READIER of that after
# every failure; a net that turns less than STILL has relaxed for this smoothing, which then goes down by SMOOTHER.
READY, READIER, STILL, SMOOTHER = 0.1, 0.1, 1e-2, 0.1
# Steps of one try, steps shorter than SHORT_NEAR that end it, and the least share of sqrt(mu) it begins with.
NEAR_STEPS, SHORT_NEAR, SHORT_TIMES, LEAST_NEAR = 25, 0.1, 3, 1e-3


@njit(**OPTIONS)
def relaxing_stiffness(p, T, k, t, length, el, along, block):
    """Stiffness p k of every bar along itself into along (m,) N/m; with T/L across it into block (m, 3, 3)."""
    for e in range(T.shape[0]):
        along[e] = p[e] * k[e]
        across = (T[e] if el.two_way[e] else max(T[e], 0.0)) / max(length[e], SHORTEST * el.rest_length[e])
        for a in range(3):
            for b in range(3):
                block[e, a, b] = (along[e] - across) * t[e, a] * t[e, b] + (across if a == b else 0.0)


@njit(**OPTIONS)
def add_drag(drag, diagonal, data):
    """Add drag (n,) N/m to the diagonal of every free knot's own block."""
    for i in range(drag.shape[0]):
        if diagonal[i, 0] >= 0:
            for q in range(3):
                data[diagonal[i, 0] + q * diagonal[i, 1] + q] += drag[i]


def knot_drag(s: Equilibrium) -> Array:
    """Drag (n,) N/m of the knots in a time that moves a knot under the mean load by a mean bar length in one unit."""
    el, free = s.el, s.pattern.free
    load = float(np.linalg.norm(s.b.load[free], axis=1).mean())
    if load == 0.0:
        load = float(s.b.f.max(initial=0.0))
    even = max(load, s.floor, float(np.finfo(float).tiny)) / float(el.rest_length.mean())
    speed = np.linalg.norm(s.u, axis=1)
    water = el.knot_drag * speed
    half = el.normal_drag * el.rest_length * speed[el.knot_a]
    np.add.at(water, el.knot_a, half)
    np.add.at(water, el.knot_b, half)
    mean = float(water.mean())
    return even * (EVEN + water / mean) if mean > 0.0 else np.full(len(speed), even)


class Relaxation:
    """Steps in time."""

    def __init__(self, s: Equilibrium, smoothing: float = SMOOTHING) -> None:
        self.s, el = s, s.el
        m = len(el.knot_a)
        z = np.zeros
        self.scale = max(typical_tension(el, s.b.load), s.floor, float(np.finfo(float).tiny))
        self.mu = (smoothing * self.scale) ** 2
        # A start that stretches bars does so by mistake.
        f = np.minimum(s.b.f, self.scale)
        self.T, self.w = begin_smooth(f, self.mu, el)
        self.p, self.r, self.c, self.along, self.bent = z(m), z(m), z(m), z(m), z(m)
        self.de, self.dT, self.dw = z(m), z(m), z(m)
        self.drag = knot_drag(s)
        self.h, self.speed = ROTATION, np.inf
        self.turn = self.force = np.inf
        self.ready = READY

    def step(self) -> None:
        """Take a step, or find that a shorter one is needed."""
        s, b, el = self.s, self.s.b, self.s.el
        turn = self._motion(self._factor())
        self.turn = turn
        if not turn <= LARGEST_ROTATION:
            s.iterations += 1
            self.force = np.inf
            self.h *= max(LEAST_AGAIN, 0.5 * ROTATION / turn) if np.isfinite(turn) else LEAST_AGAIN
            return
        self.T += self.dT
        self.w += self.dw
        s.accept(1.0)
        b.total[:] = b.load
        add_tension(borne(self.T, el), el, b.t, b.total)
        self.force = float(largest_on_free(b.total, el.free)[0])
        speed = float(np.linalg.norm(b.dx)) / self.h
        faster = speed / self.speed if self.speed > 0.0 else 0.0
        # After a step back the speed is another one: false stretch over a short time.
        self.speed = speed if faster < FASTER else np.inf
        growth = GROWTH if faster < 1.0 else 1.0 if faster < FASTER else BACK
        self.h *= min(growth, max(LEAST_CHANGE, ROTATION / max(turn, ROTATION / GROWTH)))
        if self.h > LONGEST_STEP and turn > STILL:
            self.h = 1.0

    def _factor(self) -> Solve:
        """Factorize the tangent with the drag of this step; a singular one shortens the step first."""
        s, b, el = self.s, self.s.b, self.s.el
        smooth_bars(self.T, self.w, b.f, self.mu, el.two_way, self.p, self.r, self.c)
        relaxing_stiffness(self.p, self.T, b.k, b.t, b.length, el, self.along, b.block)
        s.assemble()
        add_drag(self.drag / self.h, s.pattern.diagonal, b.data)
        s.factorizations += 1
        return s.linear.factor(b.data)

    def _motion(self, solve: Solve) -> float:
        """Motion with the elongation of second order that it makes; returns the largest rotation (rad)."""
        s, b, el = self.s, self.s.b, self.s.el
        turn = self._direction(solve, self.r)
        part = min(1.0, LARGEST_ROTATION / max(turn, LARGEST_ROTATION))
        path.second_order(s.x, b.dx, self.de, part, el, b.length, b.k, self.r, self.bent)
        if np.abs(self.bent - self.r).max(initial=0.0) > SECOND_ORDER * self.scale:
            self.c += self.p * (self.bent - self.r)
            turn = self._direction(solve, self.bent)
        return turn

    def _direction(self, solve: Solve, r: Array) -> float:
        s, b, el = self.s, self.s.b, self.s.el
        path.path_right_side(b.load, self.T, self.c, el, b.t, s.pattern.free, b.total, b.right)
        s.move(solve)
        turn = path.bar_changes(b.dx, self.along, b.k, r, self.c, el, b.t, self.de, self.dT, self.dw)
        return float(turn)

    def near(self) -> Near | None:
        """Return the near field that begins here, None while the net still moves."""
        if not (self.force < self.ready * self.scale and self.turn < 0.5 * ROTATION and self.h > 1.0):
            return None
        least = LEAST_NEAR * float(np.sqrt(self.mu))
        tension = np.where(self.s.el.two_way, self.T, np.maximum(self.T, least))
        return Near(self.s, tension, np.maximum(self.w, least))

    def go_on(self) -> None:
        """Take up the relaxation after a near field that did not arrive."""
        self.ready *= READIER
        if self.turn < STILL:
            self.mu *= SMOOTHER


def relax(s: Equilibrium, there: Callable[[], bool], limit: int, report: Callable[[], None]) -> str:
    """Relax from where s is until there() or the limit of iterations; returns how it ended.

    "there", "limit", "not_finite", or "short" when no step is short enough.
    """
    begin = s.x.copy()
    end = _run(Relaxation(s), there, min(limit, s.iterations + FIRST_STEPS), report)
    if end in {"there", "not_finite"} or s.iterations >= limit:
        return end
    s.begin_at(begin)
    return _run(Relaxation(s, SMOOTHER_STILL), there, limit, report)


def _run(r: Relaxation, there: Callable[[], bool], limit: int, report: Callable[[], None]) -> str:
    s = r.s
    while not there():
        if s.iterations >= limit:
            return "limit"
        if r.h < LEAST_STEP:
            return "short"
        try:
            r.step()
        except SingularMatrixError:
            r.h *= LEAST_CHANGE
            continue
        report()
        if not np.isfinite(s.residual):
            return "not_finite"
        near = None if there() else r.near()
        if near is not None:
            x = s.x.copy()
            if _finish(s, near, there, min(limit, s.iterations + NEAR_STEPS), report):
                return "there"
            s.begin_at(x)
            r.go_on()
    return "there"


def _finish(
    s: Equilibrium, near: Near, there: Callable[[], bool], limit: int, report: Callable[[], None]
) -> bool:
    """Whether the near field arrives."""
    short = 0
    while s.iterations < limit and short < SHORT_TIMES:
        try:
            step = near.step()
        except SingularMatrixError:
            return False
        report()
        if there():
            return True
        if not np.isfinite(s.residual):
            return False
        short = short + 1 if step < SHORT_NEAR else 0
    return False
