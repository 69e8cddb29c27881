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

from ..forces.apart import keep, kept, leave, settle, summed, take
from ..forces.around import (
    AREA,
    BLOCK,
    HERE_ROWS,
    KNOT_ROWS,
    NEAR_ROWS,
    PITCH,
    WATER,
    bars_around,
    extent,
    knots_in_order,
    renew,
    renumbered,
)
from ..forces.compiled import INLINED, OPTIONS
from ..forces.gather import FAR, SPEED, WORK_ROWS, block_force, share_laws
from ..forces.inertia import block_inverse_masses
from ..forces.team import LINE, meet, run_team, threads_for
from ..system.system import State, System
from .held_water import HeldWater
from .stepper import Count, Memory, Status, highest_frequency

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


@njit(**INLINED)
def _kick_and_drift(block, old, new, kick, drift, around, inverse, fields, g):
    """Change velocities of a block by the forces over a time kick (s), then positions over a time drift (s).

    old, new: rows of x in fields before and after; g: work array with what block_force left there.
    """
    here, size = extent(block, around)
    area = (around.knots_row[block] * KNOT_ROWS + AREA) * BLOCK
    for i in range(size):
        hc = kick * take(around.knots, area + i) * summed(g, SPEED * PITCH + i)
        f0, f1, f2, k = summed(g, i), summed(g, PITCH + i), summed(g, 2 * PITCH + i), block * 6 * BLOCK + i
        m0, m1, m2 = kept(inverse, k), kept(inverse, k + BLOCK), kept(inverse, k + 2 * BLOCK)
        m3, m4, m5 = kept(inverse, k + 3 * BLOCK), kept(inverse, k + 4 * BLOCK), kept(inverse, k + 5 * BLOCK)
        a0, a1, a2 = m0 * f0 + m3 * f1 + m4 * f2, m3 * f0 + m1 * f1 + m5 * f2, m4 * f0 + m5 * f1 + m2 * f2
        b0, b1, b2 = m0 * a0 + m3 * a1 + m4 * a2, m3 * a0 + m1 * a1 + m5 * a2, m4 * a0 + m5 * a1 + m2 * a2
        square = a0 * a0 + a1 * a1 + a2 * a2
        s = hc * square / max(square + hc * (a0 * b0 + a1 * b1 + a2 * b2), TINY_SQUARE)
        keep(g, FAR * PITCH + i, kick * (a0 - s * b0))
        keep(g, (FAR + 1) * PITCH + i, kick * (a1 - s * b1))
        keep(g, (FAR + 2) * PITCH + i, kick * (a2 - s * b2))
    width = around.width
    for q in range(3):
        x, v = (old + q) * width + here, (old + 3 + q) * width + here
        then_x, then_v = (new + q) * width + here, (new + 3 + q) * width + here
        for i in range(size):
            speed = take(fields, v + i) + kept(g, (FAR + q) * PITCH + i)
            leave(fields, then_v + i, speed)
            leave(fields, then_x + i, take(fields, x + i) + drift * speed)


@njit(**OPTIONS)
def leap(rank, team, signal, fields, h, steps, uniform, el, around, law, inverse, rates, laws):
    """Take so many steps of h (s) as one of a team; x and v at the same time before and after.

    fields: as forces.around lays them out; x begins in row 0 and ends in row 0 after an odd number of steps, else in
    row HERE_ROWS; uniform: the water has the same velocity everywhere; law: (2, m + 1); inverse: flat
    (blocks, 6, BLOCK); rates: (2, team x LINE); laws: DragLaws, or None for constant drag.
    """
    blocks = around.first.shape[0] - 1
    first, last = blocks * rank // team, blocks * (rank + 1) // team
    near, g = np.zeros(NEAR_ROWS * PITCH), np.zeros(WORK_ROWS * PITCH)
    lag = 0
    for step in range(steps + 1):
        old = HERE_ROWS * (step & 1)
        new = HERE_ROWS - old
        if not around.linear:
            share_laws(rank, team, old, fields, el, around, law)
            if not meet(signal, team):
                return
        renew = lag <= 0
        fastest = 0.0
        kick = h if 0 < step < steps else 0.5 * h
        for block in range(first, last):
            if renew:
                fastest = max(fastest, block_inverse_masses(block, old, fields, around, near, g, inverse))
            block_force(block, old, fields, uniform, laws, around, law, (near, g))
            _kick_and_drift(block, old, new, kick, h if step < steps else 0.0, around, inverse, fields, g)
        rates[step & 1, rank * LINE] = fastest
        settle()
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
        self._order = knots_in_order(system.elements, system.net.positions)
        self.water = HeldWater(system, state)
        self._elements = el = renumbered(system.elements, self._order)
        self._renewable = not self.water.rests(state)
        self._laws = system.drag_laws and system.drag_laws.of(np.arange(len(el.stiffness)), self._order)
        self.around = around = bars_around(el, self._laws, renewable=self._renewable)
        self.threads = threads_for(system.net.bar_count)
        self.steps_per_call = int(np.clip(WORK_PER_CALL // max(system.net.bar_count, 1), *STEPS_PER_CALL))
        self._law = np.zeros((2, 1 if el.linear else system.net.bar_count + 1))
        self._inverse = np.zeros(around.blocks * 6 * BLOCK)
        self._fields = around.fields()
        self.step = self._bound(state)

    def _bound(self, state: State) -> float:
        bound = SAFETY * self.method.stability_bound(self.system, state)
        longest = bound if self.method.max_step is None else min(bound, self.method.max_step)
        return longest if np.isfinite(longest) else 1e-3

    def advance(self, end: float) -> Status:
        """Go on towards the time end (s); state is left untouched on failure."""
        old = self.state
        self.step = self._bound(old)
        present, flow, until = self.water.ahead(old, end, self.step)
        left = until - old.time
        if self._renewable or not self.water.rests(old):
            self._elements = renumbered(present, self._order)
            if not self._renewable:
                self.around = bars_around(self._elements, self._laws, renewable=True)
                self._renewable = True
            self.around = renew(self.around, self._elements, self._laws)
        wanted = int(np.ceil(left / self.step * (1.0 - 1e-12)))
        steps = min(wanted, self.steps_per_call)
        h = left / wanted
        for row, values in ((0, old.position), (3, old.velocity), (WATER, flow)):
            self.write(row, values)
        self.leap(h, steps, bool(np.all(flow == flow[0])))
        self.count.evaluations += steps + 1
        last = HERE_ROWS * ((steps + 1) % 2)
        x, v = self.read(last), self.read(last + 3)
        if not (np.all(np.isfinite(x)) and np.all(np.isfinite(v))):
            return "not_finite"
        self.count.steps += steps
        self.state = State(until if steps == wanted else old.time + steps * h, x, v)
        return "ok"

    def write(self, row: int, values: Array) -> None:
        """Write values of the knots (n, 3) into three rows of the fields from row on."""
        self.around.write(self._fields, row, values[self._order])

    def read(self, row: int) -> Array:
        """Return three rows of the fields from row on as values of the knots (n, 3)."""
        values = np.empty((len(self._order), 3))
        values[self._order] = self.around.read(self._fields, row)
        return values

    def leap(self, h: float, steps: int, uniform: bool) -> None:
        """Take so many steps of h (s) from the fields as they stand; uniform: the same water velocity everywhere."""
        rates = np.zeros((2, self.threads * LINE))
        arrays = (self._elements, self.around, self._law, self._inverse, rates, self._laws)
        run_team(self.threads, leap, self._fields, h, steps, uniform, *arrays)

    def memory(self) -> Memory:
        """Return what the next steps depend on."""
        s = self.state
        return {
            "time": np.array(s.time),
            "position": s.position,
            "velocity": s.velocity,
        } | self.water.memory()

    def restore(self, memory: Memory) -> None:
        """Go on from there."""
        self.state = State(float(memory["time"]), memory["position"], memory["velocity"])
        self.water.restore(memory)
