"""Verner's Runge-Kutta pair of orders 5 and 6 with eight stages, as in DVERK.

T.E. Hull, W.H. Enright, K.R. Jackson, User's guide for DVERK, TR 100, Univ. Toronto, 1976; J.H. Verner, Explicit
Runge-Kutta methods with estimates of the local truncation error, SIAM J. Numer. Anal. 15(4), 772-790, 1978. The step
control is DVERK's: accept when the error is within tolerance, then h (0.9 (tol/err)^(1/6)) between 1/2 and 2; after two
rejections in a row halve; never go past the end, and at most half way to an end nearer than two steps.

A net is stiff, so stability, not accuracy, sets the step: the reference and teaching method.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..forces.compiled import OPTIONS
from ..forces.inertia import invert_masses, mass_matrices
from ..forces.total import total_force, work_arrays
from ..system.system import State, System
from .held_water import HeldWater
from .stepper import Count, Memory, Status, fluid_velocity, highest_frequency

Array = NDArray[np.float64]

F = Fraction
C = (F(0), F(1, 6), F(4, 15), F(2, 3), F(5, 6), F(1), F(1, 15), F(1))
A: tuple[tuple[F, ...], ...] = (
    (),
    (F(1, 6),),
    (F(4, 75), F(16, 75)),
    (F(5, 6), F(-8, 3), F(5, 2)),
    (F(-165, 64), F(55, 6), F(-425, 64), F(85, 96)),
    (F(12, 5), F(-8), F(4015, 612), F(-11, 36), F(88, 255)),
    (F(-8263, 15000), F(124, 75), F(-643, 680), F(-81, 250), F(2484, 10625), F(0)),
    (F(3501, 1720), F(-300, 43), F(297275, 52632), F(-319, 2322), F(24068, 84065), F(0), F(3850, 26703)),
)
# Order 6, the solution that goes on, and order 5.
B6 = (F(3, 40), F(0), F(875, 2244), F(23, 72), F(264, 1955), F(0), F(125, 11592), F(43, 616))
B5 = (F(13, 160), F(0), F(2375, 5984), F(5, 16), F(12, 85), F(3, 44), F(0), F(0))
STAGES = len(C)

_A = np.array([[float(a) for a in row] + [0.0] * (STAGES - len(row)) for row in A])
_B6 = np.array([float(b) for b in B6])
_ERROR = np.array([float(b6 - b5) for b6, b5 in zip(B6, B5, strict=True)])

# Steps of one compiled call: progress and Ctrl-C come through between calls.
STEPS_PER_CALL = 400
# Smallest step over the time reached, and in seconds.
LEAST_STEP = 1e-13


@njit(**OPTIONS)
def _accelerate(x, v, u, el, laws, rel, g, force, inverse, out):
    """Acceleration of every knot into out (n, 3) m/s2."""
    total_force(x, v, u, el, rel, g, force, laws)
    mass_matrices(x, el, inverse)
    invert_masses(inverse, el.free)
    for i in range(x.shape[0]):
        f0, f1, f2 = force[i, 0], force[i, 1], force[i, 2]
        m = inverse[i]
        out[i, 0] = m[0] * f0 + m[3] * f1 + m[4] * f2
        out[i, 1] = m[3] * f0 + m[1] * f1 + m[5] * f2
        out[i, 2] = m[4] * f0 + m[5] * f1 + m[2] * f2


@njit(**OPTIONS)
def _combine(y, h, weights, k, count, out):
    """Put y + h sum of weights[r] k[r] over r < count into out; all (3 n,), k (stages, 3 n)."""
    out[:] = y
    for r in range(count):
        c = h * weights[r]
        if c != 0.0:
            for q in range(out.shape[0]):
                out[q] += c * k[r, q]


@njit(**OPTIONS)
def _step(x, v, h, u, el, laws, work, kx, kv, table, weights, error, first):
    """One trial step: new x and v, and the error estimate of both, into work; first: the first stage is still good."""
    rel, g, force, inverse, xs, vs, ex, ev = work
    flat_x, flat_v = x.ravel(), v.ravel()
    fx, fv, fex, fev = xs.ravel(), vs.ravel(), ex.ravel(), ev.ravel()
    for s in range(1 if first else 0, kx.shape[0]):
        _combine(flat_x, h, table[s], kx, s, fx)
        _combine(flat_v, h, table[s], kv, s, fv)
        _accelerate(xs, vs, u, el, laws, rel, g, force, inverse, kv[s].reshape(x.shape))
        for q in range(flat_x.shape[0]):
            kx[s, q] = fv[q]
    fex[:] = 0.0
    fev[:] = 0.0
    _combine(fex, h, error, kx, kx.shape[0], fex)
    _combine(fev, h, error, kv, kx.shape[0], fev)
    _combine(flat_x, h, weights, kx, kx.shape[0], fx)
    _combine(flat_v, h, weights, kv, kx.shape[0], fv)


@njit(**OPTIONS)
def _largest(a):
    """Largest absolute entry; NaN when there is one."""
    worst = 0.0
    for q in a.ravel():
        size = abs(q)
        if not size <= worst:
            worst = size
            if np.isnan(size):
                break
    return worst


@njit(**OPTIONS)
def advance(x, v, clock, limit, u, el, laws, work, stages, table, weights, error, tolerance):
    """Adaptive steps until clock[1] or for so many steps.

    clock: time, end, step, largest step (s), written back; laws: DragLaws, or None for constant drag; tolerance: rtol,
    atol, length (m), speed (m/s).
    Returns accepted steps, rejected steps, force evaluations and 0 when well, 1 for NaN, 2 for a step too small.
    """
    kx, kv = stages
    xs, vs, ex, ev = work[4], work[5], work[6], work[7]
    accepted = rejected = evaluations = in_a_row = 0
    first = False
    while clock[0] < clock[1] and accepted < limit:
        left = clock[1] - clock[0]
        h = min(clock[2], clock[3])
        if h >= left:
            h = left
        elif 2.0 * h > left:
            h = 0.5 * left
        if h < LEAST_STEP * max(clock[0], 1.0):
            return accepted, rejected, evaluations, 2
        _step(x, v, h, u, el, laws, work, kx, kv, table, weights, error, first)
        evaluations += kx.shape[0] - (1 if first else 0)
        speed = max(tolerance[3], _largest(v))
        err = max(
            _largest(ex) / (tolerance[1] + tolerance[0] * tolerance[2]),
            _largest(ev) / (tolerance[1] + tolerance[0] * speed),
        )
        if np.isnan(err):
            return accepted, rejected, evaluations, 1
        if err <= 1.0:
            x[:] = xs
            v[:] = vs
            clock[0] = clock[1] if h == left else clock[0] + h
            accepted += 1
            in_a_row = 0
            first = False
        else:
            rejected += 1
            in_a_row += 1
            first = True
        factor = 0.9 * (1.0 / max(err, 1e-30)) ** (1.0 / 6.0)
        clock[2] = 0.5 * h if in_a_row >= 2 else h * max(0.5, min(2.0, factor))
    return accepted, rejected, evaluations, 0


@dataclass(frozen=True)
class Verner:
    """Options: rtol relative to the smallest bar or knot and to the speeds, atol in m and m/s, max_step in s."""

    rtol: float = 1e-4
    atol: float = 1e-7
    max_step: float | None = None
    name: str = "verner"

    def __post_init__(self) -> None:
        """Refuse tolerances that a net at rest could never meet."""
        if not (self.rtol >= 0.0 and self.atol > 0.0):
            raise ValueError(f"rtol {self.rtol:g} must not be below 0 and atol {self.atol:g} must be above 0")

    def start(self, system: System, state: State) -> VernerRun:
        """Begin a run."""
        return VernerRun(self, system, state)

    def stability_bound(self, system: System, state: State) -> float:
        """Largest h for which |R(h lambda)| <= 1 for every mode of the net, twine damping included."""
        return stable_step(
            highest_frequency(system, state), float(system.elements.damping_time.max(initial=0.0))
        )


def growth(z: NDArray[np.complex128]) -> Array:
    """Size of the stability polynomial of the order 6 solution, |R(z)|."""
    coefficients = [1.0, 1.0, 1 / 2, 1 / 6, 1 / 24, 1 / 120, 1 / 720, 1 / 5400]
    return np.abs(np.polynomial.polynomial.polyval(z, coefficients))


def stable_step(frequency: float, damping_time: float) -> float:
    """Largest stable step (s) for all modes up to a frequency (rad/s); a mode has damping ratio damping_time w/2.

    Undamped it is 1.307/frequency. The step is searched by bisection on the damped modes below the highest.
    """
    if frequency == 0.0:
        return np.inf
    modes = frequency * np.linspace(0.02, 1.0, 50)
    zeta = 0.5 * damping_time * modes
    root = np.emath.sqrt(zeta**2 - 1.0)
    rates = np.concatenate([modes * (-zeta + root), modes * (-zeta - root)]).astype(complex)
    low, high = 0.0, 4.1 / frequency
    for _ in range(40):
        middle = 0.5 * (low + high)
        # A step is stable only if every shorter one is too.
        if np.all(growth(np.outer(np.linspace(0.05, 1.0, 20) * middle, rates)) <= 1.0 + 1e-9):
            low = middle
        else:
            high = middle
    return low


class VernerRun:
    """Verner's pair at work."""

    linear_solver = ""

    def __init__(self, method: Verner, system: System, state: State) -> None:
        self.method, self.system, self.state = method, system, state
        self.count = Count()
        el = system.elements
        self.water = HeldWater(system, state)
        n = system.net.knot_count
        rel, g = work_arrays(n)
        self._work = (rel, g, *(np.zeros(s) for s in ((n, 3), (n, 6), (n, 3), (n, 3), (n, 3), (n, 3))))
        self._stages = (np.zeros((STAGES, 3 * n)), np.zeros((STAGES, 3 * n)))
        speed = float(np.linalg.norm(fluid_velocity(system, state), axis=1).max(initial=0.0))
        size = np.concatenate([el.rest_length, system.net.knot_diameter[system.net.knot_diameter > 0.0]])
        self._tolerance = np.array([method.rtol, method.atol, float(size.min(initial=1.0)), speed])
        self.step = 0.1 * self._bound(state)

    def _bound(self, state: State) -> float:
        bound = self.method.stability_bound(self.system, state)
        longest = bound if self.method.max_step is None else min(bound, self.method.max_step)
        return longest if np.isfinite(longest) else 1.0

    def advance(self, end: float) -> Status:
        """Go on towards the time end (s); state is left untouched on failure."""
        old = self.state
        x, v = old.position.copy(), old.velocity.copy()
        bound = self._bound(old)
        present, flow, until = self.water.ahead(old, end, bound)
        clock = np.array([old.time, until, self.step, bound])
        accepted, rejected, evaluations, fault = advance(
            x,
            v,
            clock,
            STEPS_PER_CALL,
            flow,
            present,
            self.system.drag_laws,
            self._work,
            self._stages,
            _A,
            _B6,
            _ERROR,
            self._tolerance,
        )
        self.count.steps += accepted
        self.count.rejected += rejected
        self.count.evaluations += evaluations
        if fault == 1:
            return "not_finite"
        if fault == 2:
            return "step_too_small"
        self.step = float(clock[2])
        self.state = State(float(clock[0]), x, v)
        return "ok"

    def memory(self) -> Memory:
        """Return what the next steps depend on."""
        s = self.state
        return {
            "time": np.array(s.time),
            "position": s.position,
            "velocity": s.velocity,
            "step": np.array(self.step),
        } | self.water.memory()

    def restore(self, memory: Memory) -> None:
        """Go on from there."""
        self.state = State(float(memory["time"]), memory["position"], memory["velocity"])
        self.step = float(memory["step"])
        self.water.restore(memory)
