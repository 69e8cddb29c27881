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

from ..forces.around import AREA, BLOCK, WORK_ROWS, bars_around, extent
from ..forces.compiled import OPTIONS
from ..forces.gather import block_force, share_laws
from ..forces.inertia import block_inverse_masses
from ..forces.team import LINE, meet, run_team, threads_for
from ..system.system import State, System
from .stepper import Count, Memory, Status, fluid_velocity, highest_frequency

Array = NDArray[np.float64]

# Part of the stable step that is used: bars that snap taut leave no more. At 0.9 an undamped panel never comes to rest.
SAFETY = 0.7
# Masses turn with the bars; they are renewed before a bar has turned by so much (rad), at the latest after so many
# steps.
TURN, LONGEST_LAG = 0.01, 64
# Steps of one compiled call, fewest and most, and steps x bars in between: the stable step is renewed, progress and
# Ctrl-C come through between calls.
STEPS_PER_CALL, WORK_PER_CALL = (200, 2000), 50_000_000
# Squares of accelerations below this are nothing (m2/s4); keeps a division finite.
TINY_SQUARE = 1e-300


@njit(**OPTIONS)
def _kick_and_drift(block, old, new, kick, drift, around, inverse, g):
    """Change velocities of a block by the forces over a time kick (s), then positions over a time drift (s).

    old, new: (2, 3, width) positions m and velocities m/s; g: work array with what block_force left there.
    """
    here, size = extent(block, around)
    low, own = here - np.uint64(around.margin), around.knots_row[block]
    for i in range(size):
        w = np.sqrt(g[3, i] * g[3, i] + g[4, i] * g[4, i] + g[5, i] * g[5, i])
        hc = kick * around.knots[own, AREA, i] * w
        f0, f1, f2, k = g[0, i], g[1, i], g[2, i], low + i
        m0, m1, m2, m3, m4, m5 = (
            inverse[0, k],
            inverse[1, k],
            inverse[2, k],
            inverse[3, k],
            inverse[4, k],
            inverse[5, k],
        )
        a0, a1, a2 = m0 * f0 + m3 * f1 + m4 * f2, m3 * f0 + m1 * f1 + m5 * f2, m4 * f0 + m5 * f1 + m2 * f2
        b0, b1, b2 = m0 * a0 + m3 * a1 + m4 * a2, m3 * a0 + m1 * a1 + m5 * a2, m4 * a0 + m5 * a1 + m2 * a2
        square = a0 * a0 + a1 * a1 + a2 * a2
        s = hc * square / max(square + hc * (a0 * b0 + a1 * b1 + a2 * b2), TINY_SQUARE)
        g[6, i], g[7, i], g[8, i] = kick * (a0 - s * b0), kick * (a1 - s * b1), kick * (a2 - s * b2)
    for q in range(3):
        for i in range(size):
            v = old[1, q, here + i] + g[6 + q, i]
            new[1, q, here + i] = v
            new[0, q, here + i] = old[0, q, here + i] + drift * v


@njit(**OPTIONS)
def leap(rank, team, signal, states, h, steps, u, uniform, el, around, law, inverse, rates):
    """Take so many steps of h (s) as one of a team; x and v at the same time before and after.

    states: (2, 2, 3, width) positions m and velocities m/s, the first of which is the start; the last lies in
    states[(steps + 1) % 2]; u: (3, width) m/s, uniform when the same everywhere; law: (2, m + 1); inverse:
    (6, blocks x BLOCK); rates: (2, team x LINE).
    """
    blocks = around.first.shape[0] - 1
    first, last = blocks * rank // team, blocks * (rank + 1) // team
    g = np.zeros((WORK_ROWS, BLOCK))
    lag = 0
    for step in range(steps + 1):
        old, new = states[step & 1], states[1 - (step & 1)]
        if not around.linear:
            share_laws(rank, team, old[0], el, around, law)
            if not meet(signal, team):
                return
        renew = lag <= 0
        fastest = 0.0
        kick = h if 0 < step < steps else 0.5 * h
        for block in range(first, last):
            if renew:
                fastest = max(fastest, block_inverse_masses(block, old[0], old[1], around, g, inverse))
            block_force(block, old[0], old[1], u, uniform, around, law, g)
            _kick_and_drift(block, old, new, kick, h if step < steps else 0.0, around, inverse, g)
        rates[step & 1, rank * LINE] = fastest
        if not meet(signal, team):
            return
        lag -= 1
        if renew:
            for other in range(team):
                fastest = max(fastest, rates[step & 1, other * LINE])
            # The first kick may set off at once a net that stood still.
            lag = 0 if step == 0 else int(TURN / (h * np.sqrt(fastest) + TURN / LONGEST_LAG))


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
        self.around = around = bars_around(el)
        self.threads = threads_for(system.net.bar_count)
        self.steps_per_call = int(np.clip(WORK_PER_CALL // max(system.net.bar_count, 1), *STEPS_PER_CALL))
        self._law = np.zeros((2, 1 if el.linear else system.net.bar_count + 1))
        self._inverse = np.zeros((6, around.blocks * BLOCK))
        self._states = np.zeros((2, 2, 3, around.width))
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
        steps = min(wanted, self.steps_per_call)
        h = left / wanted
        around = self.around
        self._states[0, 0], self._states[0, 1] = around.columns(old.position), around.columns(old.velocity)
        flow = fluid_velocity(self.system, old)
        u, uniform = around.columns(flow), bool(np.all(flow == flow[0]))
        rates = np.zeros((2, self.threads * LINE))
        el = self.system.elements
        run_team(
            self.threads,
            leap,
            self._states,
            h,
            steps,
            u,
            uniform,
            el,
            around,
            self._law,
            self._inverse,
            rates,
        )
        self.count.evaluations += steps + 1
        x, v = (around.rows(columns) for columns in self._states[(steps + 1) % 2])
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
