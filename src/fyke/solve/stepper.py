"""What a time stepper offers to the one time loop, and the stable step that explicit ones obey."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry, elastic
from ..forces.inertia import invert_masses, largest_frequency, mass_matrices
from ..forces.surroundings import Surroundings
from ..system.system import State, System

Array = NDArray[np.float64]
Status = Literal["ok", "not_finite", "step_too_small"]


@dataclass
class Count:
    """Steps taken and thrown away, force evaluations, factorizations."""

    steps: int = 0
    rejected: int = 0
    evaluations: int = 0
    factorizations: int = 0


# What a run must keep to be taken up again, by name.
Memory = dict[str, Array]


class Run(Protocol):
    """One stepper at work on one system."""

    count: Count

    @property
    def state(self) -> State:
        """State at the last step or output."""

    @property
    def step(self) -> float:
        """Step at work (s)."""

    @property
    def linear_solver(self) -> str:
        """Name of the linear solver, "" where there is none."""

    def advance(self, end: float) -> Status:
        """Go on towards the time end (s), as far as one call is worth; state is left untouched on failure."""

    def memory(self) -> Memory:
        """Return all that the steps to come depend on, besides system and options."""

    def restore(self, memory: Memory) -> None:
        """Go on from what memory gave: the same bits as without a stop."""


class Stepper(Protocol):
    """A method of time integration with its options."""

    @property
    def name(self) -> str:
        """The word of the case file for it."""

    @property
    def max_step(self) -> float | None:
        """Longest step wanted (s)."""

    def start(self, system: System, state: State) -> Run:
        """Begin a run."""

    def stability_bound(self, system: System, state: State) -> float:
        """Largest stable step (s) of the undamped or damped net in this state."""


def highest_frequency(system: System, state: State) -> float:
    """Upper bound (rad/s) of the frequencies of the net with all its bars taut, see forces.inertia."""
    el = system.elements
    m = system.net.bar_count
    k = el.stiffness
    if not el.linear:
        t, length, f, slope = np.empty((m, 3)), np.empty(m), np.empty(m), np.empty(m)
        bar_geometry(state.position, el, t, length)
        elastic(length - el.rest_length, el, f, slope)
        k = np.maximum(slope, el.stiffness)
    inverse = np.empty((system.net.knot_count, 6))
    mass_matrices(state.position, el, inverse)
    invert_masses(inverse, el.free)
    return float(largest_frequency(state.position, k, inverse, el))


def fluid_velocity(system: System, state: State) -> Array:
    """Velocity of the water at the knots, (n, 3) m/s, without shelter."""
    return Surroundings(system).at(state.position, state.velocity, state.time)[1]
