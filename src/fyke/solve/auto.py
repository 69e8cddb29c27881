"""Stepper "auto": implicit or leapfrog, whichever needs less work; it changes over when that turns out wrong.

The work of both is counted and never timed, so that the same input gives the same bits on any machine:
    leapfrog  (LEAP_STEP + LEAP_BAR m) / h for a second of motion, h its stable step (s), m bars
    implicit  NEWTON + NEWTON_BAR m for a Newton iteration, FACTOR n^FACTOR_POWER for a factorization, n unknowns
in ns of one core, measured on panels (benchmarks/run.py). While bars snap tight leapfrog is often cheaper; in a net at
rest the steps of the implicit method grow and leave it far behind. The plan compares both until the net is expected
at rest and begins with the cheaper; leapfrog gives way to the implicit method at that time. Where the implicit method
needs more than leapfrog would, the excess is added up, and leapfrog takes over once it passes what the plan allows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..forces.part import only_implicit
from ..forces.surroundings import Surroundings
from ..system.elements import Elements
from ..system.system import State, System
from .implicit import Implicit, ImplicitRun
from .stepper import Count, Memory, Status, fluid_velocity
from .symplectic import Symplectic, SymplecticRun

Array = NDArray[np.float64]
Name = Literal["implicit", "symplectic"]

# Work in ns of one core: of a leapfrog step and each of its bars, of a Newton iteration and each of its bars, and of
# a factorization over n^FACTOR_POWER.
LEAP_STEP, LEAP_BAR = 600.0, 9.0
NEWTON, NEWTON_BAR = 75_000.0, 700.0
FACTOR, FACTOR_POWER = 200.0, 1.2
# What the plan expects, as seen on panels of 3 to 32 meshes: Newton iterations of the first steps; REST m^REST_POWER
# more until a net is at rest; the time that takes over the time in which the water crosses the net.
FIRST, REST, REST_POWER, REST_TIME = 16, 60.0, 0.2, 0.5
# The implicit method may need so many times more than planned. After that leapfrog goes on for RETURN times the work
# lost before it is tried again: what is lost on trials in vain is at most 1 / RETURN.
PATIENCE, RETURN = 1.5, 2.0
# Planned work of the implicit method over that of leapfrog up to which it begins in water that keeps changing. Of a
# wall of 5 101 knots in irregular waves it needed a quarter of its plan.
LASTING = 4.0
# Changes that the outcome tells one by one.
TOLD = 4


@dataclass(frozen=True)
class Auto:
    """Implicit or leapfrog, by the work that they need, with changes from one to the other on the way.

    Options: rtol of the shortest bar plus atol (m) is the error of the positions that an implicit step may make; the
    stable step of leapfrog mostly makes less. max_step in s, for both. duration of the whole run in s, which simulate
    fills in.
    """

    rtol: float = 1e-2
    atol: float = 1e-6
    max_step: float | None = None
    duration: float = np.inf
    name: str = "auto"

    def __post_init__(self) -> None:
        """Refuse tolerances that no step could meet."""
        if not (self.rtol >= 0.0 and self.atol > 0.0):
            raise ValueError(f"rtol {self.rtol:g} must not be below 0 and atol {self.atol:g} must be above 0")

    def start(self, system: System, state: State) -> AutoRun | ImplicitRun:
        """Begin a run; screens, parts and moved knots are for the implicit method alone."""
        if only_implicit(system):
            return Implicit(self.rtol, self.atol, self.max_step).start(system, state)
        return AutoRun(self, system, state)

    def stability_bound(self, system: System, state: State) -> float:
        """Return infinity: the implicit method takes any step, leapfrog never more than its own."""
        return np.inf


@dataclass(frozen=True)
class Work:
    """What both methods cost on one net, in ns: a leapfrog step, a Newton iteration, a factorization."""

    leap: float
    newton: float
    factor: float

    @classmethod
    def on(cls, system: System) -> Work:
        """Estimate it from bars and unknowns."""
        bars, unknowns = system.net.bar_count, 3.0 * float(system.elements.free.sum())
        return cls(LEAP_STEP + LEAP_BAR * bars, NEWTON + NEWTON_BAR * bars, FACTOR * unknowns**FACTOR_POWER)

    def between(self, begin: Count, now: Count) -> float:
        """Work of implicit steps between two counts; a Newton iteration evaluates once."""
        factors = now.factorizations - begin.factorizations
        return self.newton * (now.evaluations - begin.evaluations) + self.factor * factors


class AutoRun:
    """One of the two methods at work, and the books on both."""

    def __init__(self, method: Auto, system: System, state: State) -> None:
        self.method, self.system, self.work = method, system, Work.on(system)
        self.end = state.time + method.duration
        self.rest = REST_TIME * crossing_time(system, state)
        self.newtons = FIRST + REST * system.net.bar_count**REST_POWER
        self.share = self._planned_share(state)
        self.changes: list[tuple[float, Name]] = []
        self.linear_solver, self._excess, self._may_try = "", 0.0, True
        self._run: ImplicitRun | SymplecticRun
        # Water that keeps changing never lets the net come to rest, which the plan counts by: implicit is tried first.
        self.steady = Surroundings(system).steady
        most = 1.0 if self.steady else LASTING
        self._take("implicit" if self.share < most else "symplectic", state, Count())

    def _planned_share(self, state: State) -> float:
        """Work of the implicit method over that of leapfrog until the net is at rest or the run over."""
        moving = min(self.rest, self.method.duration)
        if not np.isfinite(moving):
            return 0.0
        newtons = FIRST + (self.newtons - FIRST) * moving / self.rest
        if self.method.max_step is not None:
            newtons = max(newtons, moving / self.method.max_step)
        return float(newtons * (self.work.newton + self.work.factor) / (self._leap_rate(state) * moving))

    def _leap_rate(self, state: State) -> float:
        """Work of leapfrog for a second of motion, ns/s."""
        return self.work.leap / Symplectic(self.method.max_step).start(self.system, state).step

    def _take(self, name: Name, state: State, count: Count) -> None:
        """Let a method go on from a state."""
        m, self.begun = self.method, state
        method = Implicit(m.rtol, m.atol, m.max_step) if name == "implicit" else Symplectic(m.max_step)
        self._run = method.start(self.system, state)
        self._run.count = count
        self.linear_solver = self._run.linear_solver or self.linear_solver
        self._excess, self._rate = 0.0, self._leap_rate(state)
        planned = PATIENCE * self.newtons * (self.work.newton + self.work.factor)
        # Leapfrog to the end is the most that can be lost.
        self._allowed = min(planned, self._rate * (self.end - state.time))
        self._until = state.time + (RETURN * planned / self._rate if self.changes else self.rest)
        self.changes.append((state.time, name))

    @property
    def name(self) -> Name:
        """The method at work."""
        return self.changes[-1][1]

    @property
    def state(self) -> State:
        """State at the last output or step."""
        return self._run.state

    @property
    def step(self) -> float:
        """Step of the method at work, s."""
        return self._run.step

    @property
    def count(self) -> Count:
        """What both methods did so far."""
        return self._run.count

    @count.setter
    def count(self, count: Count) -> None:
        self._run.count = count

    def advance(self, end: float) -> Status:
        """Go on towards the time end (s).

        A fault of the implicit method, or too little memory for it, hands over to leapfrog for good.
        """
        run = self._run
        if isinstance(run, SymplecticRun):
            if not self._trial_due(run.state.time):
                # Stop there, so that the time of a change does not depend on the outputs.
                return run.advance(min(end, self._until) if run.state.time < self._until else end)
            self._take("implicit", run.state, run.count)
            return self.advance(end)
        # Outputs within the last step come before a change at its end.
        if run.time < end and self._excess > self._allowed:
            self._leap(run)
            return self._run.advance(end)
        time, count = run.time, replace(run.count)
        try:
            status = run.advance(end)
        except MemoryError:
            status = "step_too_small"
        if status != "ok":
            self._may_try = False
            self._leap(run)
            return self._run.advance(end)
        spent = self.work.between(count, run.count) - self._rate * (run.time - time)
        self._excess = max(0.0, self._excess + spent)
        return status

    def _leap(self, run: ImplicitRun) -> None:
        """Hand over to leapfrog at the end of the last implicit step."""
        self._take("symplectic", State(run.time, run.x, run.v), run.count)

    def _trial_due(self, time: float) -> bool:
        """Whether it is the implicit method's turn, and enough is left for it to pay."""
        left = self._rate * (self.end - time)
        return self._may_try and time >= self._until and left > FIRST * (self.work.newton + self.work.factor)

    def story(self) -> str:
        """Which method was at work and why, in one line."""
        first = self.changes[0][1]
        share = self.share if first == "implicit" else 1.0 / self.share
        other = "symplectic" if first == "implicit" else "implicit"
        why = f"because it needs {share:.2g} of the work of {other} until the net is at rest"
        parts = [f"{first}, {why if self.steady else 'in water that keeps changing'}"]
        parts += [f"{name} from {time:.3g} s" for time, name in self.changes[1 : TOLD + 1]]
        if len(self.changes) > TOLD + 1:
            parts.append(f"{len(self.changes) - 1} changes in all")
        return "; ".join(parts)

    def memory(self) -> Memory:
        """Return what the next steps depend on: the books, where the method at work began, and its own memory."""
        inner = {f"run_{name}": value for name, value in self._run.memory().items()}
        return inner | {
            "change_times": np.array([time for time, _ in self.changes]),
            "change_to_implicit": np.array([name == "implicit" for _, name in self.changes]),
            "may_try": np.array(self._may_try),
            "excess": np.array(self._excess),
            "begun_position": self.begun.position,
            "begun_velocity": self.begun.velocity,
        }

    def restore(self, memory: Memory) -> None:
        """Go on from there."""
        times: list[float] = memory["change_times"].tolist()
        names: list[Name] = [
            "implicit" if one else "symplectic" for one in memory["change_to_implicit"].tolist()
        ]
        self.changes = list(zip(times[:-1], names[:-1], strict=True))
        self._take(
            names[-1], State(times[-1], memory["begun_position"], memory["begun_velocity"]), self.count
        )
        self._may_try, self._excess = bool(memory["may_try"]), float(memory["excess"])
        self._run.restore(
            {name.removeprefix("run_"): value for name, value in memory.items() if name.startswith("run_")}
        )


def crossing_time(system: System, state: State) -> float:
    """Time (s) in which the water crosses the net, or in which the net would sink by its own length; the shorter."""
    el, net = system.elements, system.net
    size = float(np.ptp(state.position, axis=0).max(initial=0.0))
    size = max(size, float(el.rest_length.max(initial=0.0)), float(net.knot_diameter.max(initial=0.0)))
    past = np.linalg.norm(fluid_velocity(system, state) - state.velocity, axis=1).max(initial=0.0)
    speed = max(float(past), _sinking_speed(el, size))
    return size / speed if speed > 0.0 else np.inf


def _sinking_speed(el: Elements, size: float) -> float:
    """Speed (m/s) at which drag carries the loads, or that of a free fall by size (m) where that is less."""
    load = float(np.linalg.norm(el.weight * el.free[:, None], axis=1).sum())
    mass = float(el.knot_mass @ el.free)
    drag = float(el.knot_drag.sum() + 2.0 * (el.normal_drag * el.rest_length).sum())
    fall = np.sqrt(2.0 * size * load / mass) if mass > 0.0 else 0.0
    return float(min(fall, np.sqrt(load / drag) if drag > 0.0 else np.inf))
