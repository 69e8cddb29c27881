"""Implicit time stepping on smoothed tension and slack: generalized-alpha, the production method, and Newmark's.

Unknowns of a step are the accelerations and, for every bar, tension and slack (solve.smooth), so that a bar may turn
and snap taut within one step; Newton's method with the full tangent finds them:
    M (c_m a_new + (1 - c_m) a_old) = F(x_new, v_new),
    x_new = x + h v + h^2 ((1/2 - beta) a_old + beta a_new),  v_new = v + h ((1 - gamma) a_old + gamma a_new).
The step follows an estimate of the local error, h^2 (beta - 1/6)(a_new - a_old). Twine damps in a step when it was taut
at its beginning.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry, elastic, water_load
from ..forces.inertia import invert_masses, mass_matrices
from ..forces.total import total_force, work_arrays
from ..system.system import State, System
from .central_path import bar_changes, second_order
from .equilibrium import typical_tension
from .linear import Pattern, SingularMatrixError, Solve, factorizer
from .smooth import assemble_step, smooth_bars, step_right_side
from .stepper import Count, Memory, Status, fluid_velocity

Array = NDArray[np.float64]


class Scheme(NamedTuple):
    """Parameters c_m = 1 - alpha_m, gamma, beta of a one-step method with alpha_f = 0."""

    cm: float
    gamma: float
    beta: float


GENERALIZED_ALPHA = Scheme(2.0, 1.5, 1.0)
AVERAGE_ACCELERATION = Scheme(1.0, 0.5, 0.25)


# Size (N) of the smoothing, over the typical tension: T w = (SMOOTHING x tension)^2.
SMOOTHING = 1e-5
# Newton ends when the motion it still makes is below so much of the error tolerance, and r below so much of the
# typical tension.
MOTION_LEFT, FORCE_LEFT = 0.1, 0.1
MOST_NEWTON = 25
# Rotation of a bar in one Newton step (rad).
LARGEST_ROTATION = 0.5
# The elongation of second order is put in while it makes more than this part of the typical tension, in so many of the
# first Newton steps.
SECOND_ORDER, SECOND_ORDER_STEPS = 0.02, 6
GROWTH, SHRINK, SAFETY = 2.0, 0.3, 0.9
# A step is taken again when its error is above so much of the tolerance.
WORST_ERROR = 2.0
# Shortest step, over the time reached or a second; first step (s) of a net on which no force acts.
LEAST_STEP, FIRST_STEP = 1e-9, 1e-3
TINY = 1e-300


@dataclass(frozen=True)
class Implicit:
    """Generalized-alpha of spectral radius 0 at infinite frequency: second order, L-stable, no step to choose.

    What rings faster than the step can follow is gone in one step: the shape is followed, the ringing of taut bars is
    not. J. Chung, G.M. Hulbert, A time integration algorithm for structural dynamics with improved numerical
    dissipation: the generalized-alpha method, J. Appl. Mech. 60, 371-375, 1993.

    Options: rtol of the shortest bar plus atol (m) is the allowed error of the positions in one step; max_step in s;
    fixed: always take max_step, for studies of order.
    """

    rtol: float = 1e-2
    atol: float = 1e-6
    max_step: float | None = None
    fixed: bool = False
    name: str = "implicit"
    scheme: Scheme = GENERALIZED_ALPHA

    def start(self, system: System, state: State) -> ImplicitRun:
        """Begin a run."""
        return ImplicitRun(self, system, state)

    def stability_bound(self, system: System, state: State) -> float:
        """Return infinity: any step is stable on a linear problem, and accuracy sets it on a net."""
        return np.inf


@dataclass(frozen=True)
class Newmark(Implicit):
    """Newmark's average acceleration, beta 1/4, gamma 1/2, which the literature of net visualisation uses.

    It has no damping of its own: once bars snap taut, their ringing stays in the numbers at the period of the step,
    forces of one step say little, and a net that keeps switching between slack and taut may gain energy. Give the
    twine a damping_time, or use Implicit. N.M. Newmark, A method of computation for structural dynamics, J. Eng. Mech.
    Div. ASCE 85, 67-94, 1959.
    """

    name: str = "newmark"
    scheme: Scheme = AVERAGE_ACCELERATION


class ImplicitRun:
    """Generalized-alpha at work."""

    def __init__(self, method: Implicit, system: System, state: State) -> None:
        self.method, self.system, self.state = method, system, state
        self.count, self.scheme = Count(), method.scheme
        el = self.el = system.elements
        n, m = system.net.knot_count, system.net.bar_count
        self.pattern = Pattern.of(el)
        self.linear = factorizer(self.pattern)
        self.linear_solver = self.linear.name
        self.x, self.v, self.time = state.position.copy(), state.velocity.copy(), state.time
        self.u = fluid_velocity(system, state)
        self.rel = self.u - self.v
        z = np.zeros
        self.t, self.load, self.total, self.mass = z((m, 3)), z((n, 3)), z((n, 3)), z((n, 6))
        self.length, self.f, self.k, self.damp = z(m), z(m), z(m), z(m)
        self.p, self.r, self.c, self.bent, self.along = z(m), z(m), z(m), z(m), z(m)
        self.de, self.dT, self.dw, self.dx = z(m), z(m), z(m), z((n, 3))
        self.right, self.data = z(3 * len(self.pattern.free)), z(len(self.pattern.indices))
        self.xn, self.vn, self.an, self.Tn, self.wn = self.x, self.v, z((n, 3)), z(m), z(m)
        self.a = self._acceleration()
        water_load(self.u - self.v, el, self.t, self.length, self.load)
        self.tension_scale = max(typical_tension(el, self.load), TINY)
        self.mu = (SMOOTHING * self.tension_scale) ** 2
        self.T = 0.5 * (self.f + np.sqrt(self.f * self.f + 4.0 * self.mu))
        self.w = self.T - self.f
        self.before = (self.time, self.x, self.v, self._tension())
        self.tolerance = method.atol + method.rtol * float(el.rest_length.min(initial=1.0))
        self.step = self._first_step()

    def _first_step(self) -> float:
        """Step (s) in which the largest acceleration moves a knot by the tolerance."""
        method, largest = self.method, float(np.abs(self.a).max(initial=0.0))
        step = float(np.sqrt(self.tolerance / largest)) if largest > 0.0 else FIRST_STEP
        if method.max_step is None:
            return step
        return method.max_step if method.fixed else min(step, method.max_step)

    def _acceleration(self) -> Array:
        rel, g = work_arrays(len(self.x))
        force, a = np.zeros_like(self.x), np.zeros_like(self.x)
        total_force(self.x, self.v, self.u, self.el, rel, g, force)
        mass_matrices(self.x, self.el, self.mass)
        inverse = self.mass.copy()
        invert_masses(inverse, self.el.free)
        i = inverse
        a[:, 0] = i[:, 0] * force[:, 0] + i[:, 3] * force[:, 1] + i[:, 4] * force[:, 2]
        a[:, 1] = i[:, 3] * force[:, 0] + i[:, 1] * force[:, 1] + i[:, 5] * force[:, 2]
        a[:, 2] = i[:, 4] * force[:, 0] + i[:, 5] * force[:, 1] + i[:, 2] * force[:, 2]
        bar_geometry(self.x, self.el, self.t, self.length)
        elastic(self.length - self.el.rest_length, self.el, self.f, self.k)
        return a

    def advance(self, end: float) -> Status:
        """Go on towards the time end (s), by one step at most; the state is interpolated when the step passes it."""
        if self.time < end:
            status = self._step_once()
            if status != "ok":
                return status
        if self.time >= end:
            self.state = self._between(end)
        else:
            self.state = State(self.time, self.x, self.v, self._tension())
        return "ok"

    def _between(self, time: float) -> State:
        """Cubic Hermite interpolation of the last step, third order in the step like its error; linear for tensions."""
        t0, x0, v0, tension0 = self.before
        h = self.time - t0
        if h == 0.0:
            return State(time, self.x, self.v)
        s = (time - t0) / h
        x = (1 + 2 * s) * (1 - s) ** 2 * x0 + s * s * (3 - 2 * s) * self.x
        x += s * (1 - s) ** 2 * h * v0 - s * s * (1 - s) * h * self.v
        v = 6 * s * (1 - s) * (self.x - x0) / h + (1 - s) * (1 - 3 * s) * v0 - s * (2 - 3 * s) * self.v
        return State(time, x, v, (1.0 - s) * tension0 + s * self._tension())

    def _tension(self) -> Array:
        """Tension of every bar, (m,) N, without what the smoothing leaves on slack ones."""
        return np.where(self.T > self.w, self.T, 0.0)

    def _step_once(self) -> Status:
        """One accepted step."""
        method = self.method
        while True:
            h = self.step if method.max_step is None else min(self.step, method.max_step)
            if h < LEAST_STEP * max(self.time, 1.0):
                return "step_too_small"
            if not self._newton(h):
                self.count.rejected += 1
                self.step = SHRINK * h
                continue
            jump = (self.an - self.a)[self.pattern.free]
            size = float(np.sqrt((jump**2).sum() / max(len(jump), 1)))
            err = h * h * abs(self.scheme.beta - 1.0 / 6.0) * size
            factor = SAFETY * (self.tolerance / max(err, TINY)) ** (1.0 / 3.0)
            if err > WORST_ERROR * self.tolerance and not method.fixed:
                self.count.rejected += 1
                self.step = h * max(SHRINK, factor)
                continue
            self.before = (self.time, self.x, self.v, self._tension())
            self.x, self.v, self.time = self.xn, self.vn, self.time + h
            self.a, self.an = self.an, self.a
            self.T, self.Tn = self.Tn, self.T
            self.w, self.wn = self.wn, self.w
            self.count.steps += 1
            self.step = h * (GROWTH if method.fixed else min(GROWTH, max(SHRINK, factor)))
            return "ok"

    def _newton(self, h: float) -> bool:
        """Find a, T, w of a step h from the last ones; False when Newton does not get there."""
        # A step depends on the state alone, so that a run may be taken up again at any.
        self.linear.renew()
        el, c0, c1 = self.el, self.scheme.beta * h * h, self.scheme.gamma * h
        self.an[:], self.Tn[:], self.wn[:] = self.a, self.T, self.w
        x0 = self.x + h * self.v + h * h * (0.5 - self.scheme.beta) * self.a
        v0 = self.v + h * (1.0 - self.scheme.gamma) * self.a
        for iteration in range(MOST_NEWTON):
            self.xn, self.vn = x0 + c0 * self.an, v0 + c1 * self.an
            phi, r = self._residual()
            try:
                solve = self._factor(c0, c1)
            except SingularMatrixError:
                return False
            turn = self._direction(solve, self.r)
            if iteration < SECOND_ORDER_STEPS:
                second_order(self.xn, self.dx, self.de, 1.0, el, self.length, self.k, self.r, self.bent)
                if np.abs(self.bent - self.r).max(initial=0.0) > SECOND_ORDER * self.tension_scale:
                    self.c += self.p * (self.bent - self.r)
                    turn = self._direction(solve, self.bent)
            moved = float(np.abs(self.dx).max(initial=0.0))
            if not np.isfinite(moved):
                return False
            part = LARGEST_ROTATION / max(turn, LARGEST_ROTATION)
            self.an += (part / c0) * self.dx
            self.Tn += part * self.dT
            self.wn += part * self.dw
            if (
                part == 1.0
                and moved < MOTION_LEFT * self.tolerance
                and max(phi, r) < FORCE_LEFT * self.tension_scale
            ):
                self.xn, self.vn = x0 + c0 * self.an, v0 + c1 * self.an
                return True
        return False

    def _residual(self) -> tuple[float, float]:
        """Geometry, law, loads and masses of the present guess; largest violations of the bars' equations (N)."""
        el = self.el
        bar_geometry(self.xn, el, self.t, self.length)
        np.subtract(self.length, el.rest_length, out=self.de)
        elastic(self.de, el, self.f, self.k)
        if el.damped:
            rate = np.einsum("eq,eq->e", self.vn[el.knot_b] - self.vn[el.knot_a], self.t)
            self.damp = np.where(self.T > self.w, el.damping_time * self.k, 0.0)
            self.f += self.damp * rate
        mass_matrices(self.xn, el, self.mass)
        self.count.evaluations += 1
        self.rel = self.u - self.vn
        water_load(self.rel, el, self.t, self.length, self.load)
        phi, r = smooth_bars(self.Tn, self.wn, self.f, self.mu, self.p, self.r, self.c)
        return float(phi), float(r)

    def _factor(self, c0: float, c1: float) -> Solve:
        """Factorize the matrix of the step for accelerations over c0, so that it solves for motions."""
        p, cm = self.pattern, self.scheme.cm / c0
        if self.el.damped:
            # The slope of the law, what the rate of elongation adds included.
            self.k += self.damp * (c1 / c0)
        np.multiply(self.p, self.k, out=self.along)
        assemble_step(
            self.rel, self.el, self.t, self.length, self.Tn, self.along, 1.0, c1 / c0, cm, self.mass,
            p.start, p.stride, p.diagonal, self.data,
        )  # fmt: skip
        self.count.factorizations += 1
        return self.linear.factor(self.data)

    def _direction(self, solve: Solve, r: Array) -> float:
        """Motion dx and the changes of the bars for the residual r; returns the largest rotation."""
        p, el = self.pattern, self.el
        step_right_side(
            self.load,
            self.Tn,
            self.c,
            self.an,
            self.a,
            self.scheme.cm,
            self.mass,
            el,
            self.t,
            p.free,
            self.total,
            self.right,
        )
        self.dx[p.free] = solve(self.right).reshape(-1, 3)
        return float(
            bar_changes(self.dx, self.along, self.k, r, self.c, el, self.t, self.de, self.dT, self.dw)
        )

    def memory(self) -> Memory:
        """Return what the next steps depend on, and the last step, in which outputs may still lie."""
        return {
            "output": np.array(self.state.time),
            "time": np.array([self.before[0], self.time, self.step]),
            "position": np.array([self.before[1], self.x]),
            "velocity": np.array([self.before[2], self.v]),
            "tension_before": self.before[3],
            "acceleration": self.a.copy(),
            "tension": self.T.copy(),
            "slack": self.w.copy(),
        }

    def restore(self, memory: Memory) -> None:
        """Go on from there."""
        before, self.time, self.step = (float(value) for value in memory["time"])
        self.before = (before, memory["position"][0], memory["velocity"][0], memory["tension_before"])
        self.x, self.v = memory["position"][1], memory["velocity"][1]
        self.a, self.T, self.w = (memory[name].copy() for name in ("acceleration", "tension", "slack"))
        self.state = self._between(float(memory["output"]))
