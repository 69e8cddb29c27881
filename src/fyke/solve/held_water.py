"""Water that explicit steppers hold still over short spans of time: as it is in the middle of each.

Their steps are a thousand times shorter than waves and changes of current, so that the water is found anew only when it
has changed by VARIES of its speed. Taken in the middle, what it does to a net is second order in the span; bars carry
knots to the middle of the span along their velocities.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..forces.part import only_implicit
from ..forces.surroundings import Surroundings
from ..system.elements import Elements
from ..system.system import State, System
from .stepper import Memory

Array = NDArray[np.float64]

# Change of the water's velocity over one span, over the largest velocity; spans grow and shrink by these at most.
VARIES, GROWTH, SHRINK = 1e-2, 2.0, 0.25
# Spans of so many steps at least, so that finding the water does not cost more than moving the net; s at most.
FEWEST_STEPS, LONGEST = 4, 0.1
# Part of the net's size that must lie between it and the surface, or the surface is looked after.
MARGIN = 0.05
TINY = 1e-300


class HeldWater:
    """Elements and water for one span after the other."""

    def __init__(self, system: System, state: State) -> None:
        what = only_implicit(system)
        if what:
            raise ValueError(f"{what} an implicit method: take Implicit, Newmark or Auto")
        self._around = Surroundings(system)
        self._around.renew(state.position, state.time)
        self._present = self._around.given(state.position, state.velocity, state.time)
        self._span, self._middle = 0.0, state.time

    def rests(self, state: State) -> bool:
        """Whether the water stays as it is, the surface far enough from the net."""
        fastest = float(state.velocity[:, 2].max(initial=0.0))
        size = float(np.ptp(state.position, axis=0).max(initial=0.0))
        rise = max(LONGEST * fastest, MARGIN * size)
        return self._around.steady and not self._around.near_surface(state.position, rise)

    def ahead(self, state: State, end: float, step: float) -> tuple[Elements, Array, float]:
        """Elements, velocity of the water (n, 3) m/s, and the time (s) until which they are held, at most end.

        step: s, of the stepper.
        """
        x, left = state.position, end - state.time
        if self.rests(state):
            self._present = self._around.given(x, state.velocity, state.time)
            return *self._present, end
        span = min(max(self._span, FEWEST_STEPS * step), LONGEST)
        # Two spans of the same length rather than a long and a short one.
        span = left if span >= left else min(span, 0.5 * left)
        middle, before = state.time + 0.5 * span, self._present[1]
        x = x + 0.5 * span * state.velocity
        self._around.renew(x, middle)
        self._present = self._around.given(x, state.velocity, middle)
        change = float(np.abs(self._present[1] - before).max(initial=0.0)) / max(middle - self._middle, TINY)
        largest = float(np.abs(self._present[1]).max(initial=0.0))
        wanted = VARIES * largest / max(change, TINY)
        self._span = min(max(wanted, SHRINK * span), GROWTH * span)
        self._middle = middle
        return *self._present, end if span == left else state.time + span

    def memory(self) -> Memory:
        """Return what the next span depends on."""
        return {"water_time": np.array([self._span, self._middle]), "water": self._present[1]}

    def restore(self, memory: Memory) -> None:
        """Go on from there."""
        self._span, self._middle = (float(value) for value in memory["water_time"])
        self._present = self._present[0], memory["water"]
