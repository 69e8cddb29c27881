"""Leapfrog (Stormer-Verlet) with implicit drag: one force evaluation a step, the fastest simple explicit method.

Velocities live half a step off the positions:
    v(n + 1/2) = v(n - 1/2) + h (M + h c |w| I)^-1 F(x(n), v(n - 1/2)),    x(n + 1) = x(n) + h v(n + 1/2).
F is taken with the old velocity; c |w|, half the slope of the quadratic drag along the flow, makes the drag a
trapezoidal rule: second order in time where the water moves along one line past knots and bars across it, first order
otherwise, and stable for any step. The inverse is taken by a rational approximation in M^-1. Stable for h omega < 2
without twine damping, h omega < 2 (sqrt(1 + zeta^2) - zeta) with it. The added mass lags behind the bars by up to TURN,
an error that no smaller step removes. E. Hairer, C. Lubich, G. Wanner, Geometric numerical integration illustrated by
the Stormer-Verlet method, Acta Numerica 12, 399-450, 2003.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..forces.compiled import OPTIONS
from ..forces.inertia import invert_masses, mass_matrices
from ..forces.total import TINY_LENGTH, total_force, work_arrays
from ..system.system import State, System
from .stepper import Count, Memory, Status, fluid_velocity, highest_frequency

Array = NDArray[np.float64]

# Part of the stable step that is used: bars that snap taut leave no more. At 0.9 an undamped panel never comes to rest.
SAFETY = 0.7
# Masses turn with the bars; they are renewed before a bar has turned by so much (rad), at the latest after so many
# steps.
TURN, LONGEST_LAG = 0.01, 64
# Steps of one compiled call: the stable step is renewed, progress and Ctrl-C come through between calls.
STEPS_PER_CALL = 2000


@njit(**OPTIONS)
def _kick(v, h, el, rel, force, inverse, area):
    """Change velocities by the forces over a time h; area: (n,) kg/m, drag coefficient of all that hangs on a knot."""
    for i in range(v.shape[0]):
        hc = h * area[i] * np.sqrt(rel[i, 0] * rel[i, 0] + rel[i, 1] * rel[i, 1] + rel[i, 2] * rel[i, 2])
        f0, f1, f2 = force[i, 0], force[i, 1], force[i, 2]
        m0, m1, m2, m3, m4, m5 = inverse[i]
        a0, a1, a2 = m0 * f0 + m3 * f1 + m4 * f2, m3 * f0 + m1 * f1 + m5 * f2, m4 * f0 + m5 * f1 + m2 * f2
        b0, b1, b2 = m0 * a0 + m3 * a1 + m4 * a2, m3 * a0 + m1 * a1 + m5 * a2, m4 * a0 + m5 * a1 + m2 * a2
        square = a0 * a0 + a1 * a1 + a2 * a2
        s = hc * square / (square + hc * (a0 * b0 + a1 * b1 + a2 * b2)) if square > 0.0 else 0.0
        v[i, 0] += h * (a0 - s * b0)
        v[i, 1] += h * (a1 - s * b1)
        v[i, 2] += h * (a2 - s * b2)


@njit(**OPTIONS)
def _drift(x, v, h):
    for i in range(x.shape[0]):
        x[i, 0] += h * v[i, 0]
        x[i, 1] += h * v[i, 1]
        x[i, 2] += h * v[i, 2]


@njit(**OPTIONS)
def _steps_until_turned(x, v, el, h):
    """Steps after which the fastest turning bar has turned by TURN."""
    fastest = 0.0
    for e in range(el.knot_a.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        rate = turn = 0.0
        for q in range(3):
            rate += (v[b, q] - v[a, q]) ** 2
            turn += (x[b, q] - x[a, q]) ** 2
        fastest = max(fastest, rate / max(turn, TINY_LENGTH))
    return int(min(max(TURN / (h * np.sqrt(fastest) + TURN / LONGEST_LAG), 1.0), LONGEST_LAG))


@njit(**OPTIONS)
def leap(x, v, h, steps, u, el, work, area):
    """Take so many steps; x and v at the same time before and after. Returns force evaluations."""
    rel, g, force, inverse = work
    total_force(x, v, u, el, rel, g, force)
    mass_matrices(x, el, inverse)
    invert_masses(inverse, el.free)
    _kick(v, 0.5 * h, el, rel, force, inverse, area)
    lag = _steps_until_turned(x, v, el, h)
    for step in range(1, steps + 1):
        _drift(x, v, h)
        total_force(x, v, u, el, rel, g, force)
        lag -= 1
        if lag <= 0:
            mass_matrices(x, el, inverse)
            invert_masses(inverse, el.free)
            lag = _steps_until_turned(x, v, el, h)
        _kick(v, h if step < steps else 0.5 * h, el, rel, force, inverse, area)
    return steps + 1


@dataclass(frozen=True)
class Symplectic:
    """Options: max_step in s, the stable step by default."""

    max_step: float | None = None
    name: str = "symplectic"

    def start(self, system: System, state: State) -> SymplecticRun:
        """Begin a run."""
        return SymplecticRun(self, system, state)

    def stability_bound(self, system: System, state: State) -> float:
        """Largest stable step (s), h = 2 (sqrt(1 + zeta^2) - zeta) / omega."""
        omega = highest_frequency(system, state)
        zeta = 0.5 * omega * float(system.elements.damping_time.max(initial=0.0))
        return 2.0 * (np.sqrt(1.0 + zeta * zeta) - zeta) / omega if omega > 0.0 else np.inf


class SymplecticRun:
    """Leapfrog at work."""

    linear_solver = ""

    def __init__(self, method: Symplectic, system: System, state: State) -> None:
        self.method, self.system, self.state = method, system, state
        self.count = Count()
        el = system.elements
        n = system.net.knot_count
        rel, g = work_arrays(n)
        self._work = (rel, g, np.zeros((n, 3)), np.zeros((n, 6)))
        self._area = el.knot_drag.copy()
        for end in (el.knot_a, el.knot_b):
            np.add.at(self._area, end, el.normal_drag * el.rest_length)
        self.step = self._bound(state)

    def _bound(self, state: State) -> float:
        bound = SAFETY * self.method.stability_bound(self.system, state)
        longest = bound if self.method.max_step is None else min(bound, self.method.max_step)
        return longest if np.isfinite(longest) else 1e-3

    def advance(self, end: float) -> Status:
        """Go on towards the time end (s); state is left untouched on failure."""
        old = self.state
        left = end - old.time
        self.step = self._bound(old)
        wanted = int(np.ceil(left / self.step * (1.0 - 1e-12)))
        steps = min(wanted, STEPS_PER_CALL)
        h = left / wanted
        x, v = old.position.copy(), old.velocity.copy()
        self.count.evaluations += leap(
            x, v, h, steps, fluid_velocity(self.system, old), self.system.elements, self._work, self._area
        )
        if not (np.all(np.isfinite(x)) and np.all(np.isfinite(v))):
            return "not_finite"
        self.count.steps += steps
        self.state = State(end if steps == wanted else old.time + steps * h, x, v)
        return "ok"

    def memory(self) -> Memory:
        """Return what the next steps depend on."""
        s = self.state
        return {"time": np.array(s.time), "position": s.position, "velocity": s.velocity}

    def restore(self, memory: Memory) -> None:
        """Go on from there."""
        self.state = State(float(memory["time"]), memory["position"], memory["velocity"])
