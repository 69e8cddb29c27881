"""Implicit time stepping on smoothed tension and slack: BDF2, the production method, and Newmark's.

Unknowns of a step are the accelerations and, for every bar, tension and slack (solve.smooth), so that a bar may turn
and snap taut within one step; Newton's method with the full tangent finds them:
    M a_new = F(x_new, v_new),   x_new = x* + c0 a_new,   v_new = v* + c1 a_new,
where the method gives x*, v*, c0, c1 from the last steps. The step follows an estimate of the local error,
C h^2 (a_new - a_old). Twine damps in a step when it was taut at its beginning.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import add_tension, bar_geometry, elastic
from ..forces.evaluate import bar_tensions
from ..forces.inertia import invert_masses, mass_matrices
from ..forces.surroundings import Surroundings
from ..system.system import State, System
from .equilibrium import ROUNDING, typical_tension
from .linear import SingularMatrixError
from .smooth import begin_smooth
from .step_newton import Ahead, StepNewton
from .stepper import Count, Memory, Status

Array = NDArray[np.float64]


class Past(NamedTuple):
    """Last step: its length h (s), positions x and velocities v (n, 3) before it and now, acceleration a now."""

    h: float
    before: tuple[Array, Array]
    now: tuple[Array, Array]
    a: Array


# Size (N) of the smoothing, over the typical tension: T w = (SMOOTHING x tension)^2.
SMOOTHING = 1e-5
# Newton ends when the motion it still makes is below so much of the error tolerance, and r below so much of the
# typical tension, both root mean squares: a few bars of a large net may still be found in the next step.
MOTION_LEFT, FORCE_LEFT = 0.1, 0.3
# Typical tension, over the mean tension at the beginning, of a net that is stretched and bears no loads: small, because
# the stretch of other beginnings is gone after a moment.
PRESTRESS = 1e-4
GROWTH, SHRINK, SAFETY = 2.0, 0.3, 0.9
# Allowed error, over the tolerance, of knots that drift with slack twine, where errors add up. Elsewhere taut bars
# take errors back.
DRIFT = 0.02
# A step is taken again when its error is above so much of the tolerance.
WORST_ERROR = 2.0
# Shortest step, over the time reached or a second; first step (s) of a net on which no force acts.
LEAST_STEP, FIRST_STEP = 1e-9, 1e-3
TINY = 1e-300


@dataclass(frozen=True)
class Implicit:
    """Backward differences of second order with variable steps (BDF2): L-stable, no step to choose.

    What rings faster than the step can follow is gone in a few steps: the shape is followed, the ringing of taut bars
    is not. E. Hairer, S.P. Norsett, G. Wanner, Solving ordinary differential equations I, section III.5, 1993.

    Options: rtol of the shortest bar plus atol (m) is the allowed error of the positions in one step, DRIFT times that
    where twine is slack; max_step in s; fixed: always take max_step, for studies of order. Raises ValueError for
    options that contradict each other.
    """

    rtol: float = 1e-2
    atol: float = 1e-6
    max_step: float | None = None
    fixed: bool = False
    name: str = "implicit"

    def __post_init__(self) -> None:
        """Refuse tolerances that no step could meet and steps that are none."""
        if not (self.rtol >= 0.0 and self.atol >= 0.0 and self.rtol + self.atol > 0.0):
            raise ValueError(
                f"rtol {self.rtol:g} and atol {self.atol:g} must not be below 0, and one of them must be above 0"
            )
        if self.max_step is not None and not self.max_step > 0.0:
            raise ValueError(f"max_step {self.max_step:g} s must be above 0")
        if self.fixed and self.max_step is None:
            raise ValueError("fixed steps need max_step, the length of the step in s")

    def ahead(self, h: float, past: Past) -> Ahead:
        """Return what a step h makes of its acceleration."""
        (x, v), w = past.now, h / past.h
        b, k = h * (1.0 + w) / (1.0 + 2.0 * w), w * w / (1.0 + 2.0 * w)
        v0 = v + k * (v - past.before[1])
        error = (1.0 + w) ** 2 / (6.0 * w * (1.0 + 2.0 * w))
        return Ahead(b * b, b, x + k * (x - past.before[0]) + b * v0, v0, error)

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

    def ahead(self, h: float, past: Past) -> Ahead:
        """Return what a step h makes of its acceleration."""
        (x, v), a = past.now, past.a
        return Ahead(0.25 * h * h, 0.5 * h, x + h * v + 0.25 * h * h * a, v + 0.5 * h * a, 1.0 / 12.0)


class ImplicitRun:
    """An implicit method at work."""

    def __init__(self, method: Implicit, system: System, state: State) -> None:
        self.method, self.system, self.state = method, system, state
        self.count = Count()
        el = self.el = system.elements
        self.surroundings = Surroundings(system)
        self.x, self.v, self.time = state.position.copy(), state.velocity.copy(), state.time
        if system.motion is not None:
            system.motion.carry(self.x, self.v, self.time)
            self.state = State(self.time, self.x.copy(), self.v.copy())
        self.surroundings.renew(self.x, self.time)
        self.a, f, load = self._beginning()
        prestress = float(np.maximum(f, 0.0).sum()) / max(len(f), 1)
        rounding = ROUNDING * float(
            np.finfo(float).eps * el.stiffness.max(initial=0.0) * np.abs(self.x).max()
        )
        self.tension_scale = max(typical_tension(el, load), PRESTRESS * prestress, rounding, TINY)
        mu = (SMOOTHING * self.tension_scale) ** 2
        self.newton = StepNewton(self.surroundings, self.u, mu, self.tension_scale)
        self.linear_solver = self.newton.linear.name
        self.T, self.w = begin_smooth(f, mu, el)
        self.before = (self.time, self.x, self.v, self._tension())
        self.tolerance = method.atol + method.rtol * float(el.rest_length.min(initial=1.0))
        self.step = self._first_step()

    def _first_step(self) -> float:
        """Step (s) in which the largest acceleration moves a knot by what a drifting one may err."""
        method, largest = self.method, float(np.abs(self.a).max(initial=0.0))
        step = float(np.sqrt(2.0 * DRIFT * self.tolerance / largest)) if largest > 0.0 else FIRST_STEP
        if method.max_step is None:
            return step
        return method.max_step if method.fixed else min(step, method.max_step)

    def _beginning(self) -> tuple[Array, Array, Array]:
        """Acceleration (n, 3), law (m,) and load (n, 3) of the state at the beginning."""
        el, self.u = self.surroundings.at(self.x, self.v, self.time)
        bars = self.system.net.bar_count
        a, load, inverse = (np.zeros((len(self.x), width)) for width in (3, 3, 6))
        t, length, f, k = np.zeros((bars, 3)), np.zeros(bars), np.zeros(bars), np.zeros(bars)
        bar_geometry(self.x, el, t, length)
        elastic(length - el.rest_length, el, f, k)
        self.surroundings.load(self.x, self.u - self.v, el, t, length, load)
        force = load.copy()
        add_tension(bar_tensions(self.system, self.state, t, length), el, t, force)
        mass_matrices(self.x, el, inverse)
        invert_masses(inverse, el.free)
        i = inverse
        a[:, 0] = i[:, 0] * force[:, 0] + i[:, 3] * force[:, 1] + i[:, 4] * force[:, 2]
        a[:, 1] = i[:, 3] * force[:, 0] + i[:, 1] * force[:, 1] + i[:, 5] * force[:, 2]
        a[:, 2] = i[:, 4] * force[:, 0] + i[:, 5] * force[:, 1] + i[:, 2] * force[:, 2]
        return a, f, load

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
        if self.system.motion is not None:
            self.system.motion.carry(x, v, time)
        return State(time, x, v, (1.0 - s) * tension0 + s * self._tension())

    def _tension(self) -> Array:
        """Tension of every bar, (m,) N, without what the smoothing leaves on slack ones."""
        return np.where(self.el.two_way | (self.T > self.w), self.T, 0.0)

    def _step_once(self) -> Status:
        """One accepted step."""
        method = self.method
        while True:
            h = self._next_step()
            if h < LEAST_STEP * max(self.time, 1.0):
                return "step_too_small"
            if not self._arrives(h):
                self.count.rejected += 1
                self.step = SHRINK * h
                continue
            err = self.newton.ahead.error * h * h * self._jump() / self.tolerance
            factor = SAFETY * max(err, TINY) ** (-1.0 / 3.0)
            if err > WORST_ERROR and not method.fixed:
                self.count.rejected += 1
                self.step = h * max(SHRINK, factor)
                continue
            self.before = (self.time, self.x, self.v, self._tension())
            found = self.newton
            self.x, self.v, self.time = found.x, found.v, self.time + h
            self.a, self.T, self.w = found.a.copy(), found.T.copy(), found.w.copy()
            self.count.steps += 1
            self.step = h * (GROWTH if method.fixed else min(GROWTH, max(SHRINK, factor)))
            return "ok"

    def _next_step(self) -> float:
        """Step (s) to try: the one wanted, short enough for the motion of held knots unless steps are fixed."""
        method, motion = self.method, self.system.motion
        step = self.step if method.max_step is None else min(self.step, method.max_step)
        return step if motion is None or method.fixed else min(step, motion.longest_step(self.time))

    def _ahead(self, h: float) -> Ahead:
        """What a step h makes of its acceleration; moved knots are where they will be, whatever it is."""
        ahead = self.method.ahead(h, self._past(h))
        if self.system.motion is not None:
            self.system.motion.carry(ahead.x0, ahead.v0, self.time + h)
        return ahead

    def _arrives(self, h: float) -> bool:
        """Whether Newton finds the step."""
        try:
            return self._newton(h)
        except SingularMatrixError:
            return False

    def _jump(self) -> float:
        """Change of the accelerations, root mean square (m/s2): of all knots, or of drifting ones over DRIFT."""
        found, el = self.newton, self.el
        free = found.pattern.free
        drifting = np.ones(len(self.x), dtype=bool)
        taut = el.two_way | (self.T > self.w) | (found.T > found.w)
        drifting[el.knot_a[taut]] = drifting[el.knot_b[taut]] = False
        square = ((found.a - self.a)[free] ** 2).sum(axis=1)
        alone = square[drifting[free]]
        everywhere = square.sum() / max(len(square), 1)
        return float(np.sqrt(max(everywhere, alone.sum() / max(len(alone), 1) / DRIFT**2)))

    def _past(self, h: float) -> Past:
        """Return the last step, or before the first one what the acceleration makes of a step h back."""
        last = self.time - self.before[0]
        if last > 0.0:
            return Past(last, (self.before[1], self.before[2]), (self.x, self.v), self.a)
        back = self.x - h * self.v + 0.5 * h * h * self.a, self.v - h * self.a
        return Past(h, back, (self.x, self.v), self.a)

    def _newton(self, h: float) -> bool:
        """Find a, T, w of a step h from the last ones; False when Newton does not get there."""
        newton = self.newton
        # The last accelerations are no guess: where bars have just snapped they are large and gone.
        newton.begin(
            self._ahead(h),
            self.time + h,
            self.el.two_way | (self.T > self.w),
            np.zeros_like(self.x),
            self.T,
            self.w,
        )
        begun = newton.evaluations, newton.factorizations
        try:
            return newton.solve(MOTION_LEFT * self.tolerance, FORCE_LEFT * self.tension_scale)
        finally:
            self.count.evaluations += newton.evaluations - begun[0]
            self.count.factorizations += newton.factorizations - begun[1]

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
