"""A net that one plays with: its case as moved so far, its shape, its pinned knots. Knows nothing of browsers."""

from __future__ import annotations

import time
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomli_w
from numpy.typing import NDArray

from ..case import Case, CaseError, parse_case
from ..case.schema import DynamicSolve
from ..forces.evaluate import evaluate
from ..forces.surroundings import Surroundings
from ..results import flow_direction
from ..results.derive import drag_and_lift
from ..solve.implicit import Implicit
from ..solve.linear import Factorizer, factorizer
from ..solve.outcome import Outcome
from ..solve.pattern import Pattern
from ..solve.result import Result
from ..solve.static import solve_static
from ..solve.stepper import Run
from ..system.build import build_net, build_system
from ..system.carriage import seen_from_the_carriage
from ..system.system import State, System
from ..water.current import at_full_strength
from .knobs import Knob, knobs_of, turned

Array = NDArray[np.float64]

TOLERANCE = 1e-8  # N, of a dynamic case, which has none of its own


class RefusedError(Exception):
    """A wish that makes no net, or no shape; the message is one sentence, and everything is as it was."""


@dataclass(frozen=True)
class Numbers:
    """Drag and lift (N, None in still water), largest tension (N), bars slack and in all, largest displacement (m)."""

    drag: float | None
    lift: float | None
    largest_tension: float
    slack: int
    bars: int
    sag: float


def _system_of(case: Case) -> System:
    """Return the system of a case, its current at full strength: a shape that one looks at has no beginning.

    A towed net is seen from the carriage. ValueError where held knots are towed apart.
    """
    system = build_system(build_net(case), case)
    return seen_from_the_carriage(replace(system, current=at_full_strength(system.current)))


class Study:
    """One net in the hands of one person.

    path: where the case was read, for the files that it names. Raises CaseError for a case that is none, and
    RefusedError where it has no equilibrium.
    """

    def __init__(self, text: str, path: Path | None = None) -> None:
        self.path = path
        self.case: Case = parse_case(text, str(path or "case"), path=path)
        self._raw = tomllib.loads(text)
        self.knobs: tuple[Knob, ...] = knobs_of(self.case)
        self.values: dict[str, float] = {knob.key: knob.value for knob in self.knobs}
        self.pins: dict[int, Array] = {}
        try:
            self._built: System = _system_of(self.case)
        except ValueError as error:
            raise error if isinstance(error, CaseError) else RefusedError(str(error)) from None
        self.system: System = self._built
        self.run: Run | None = None
        self._linear: tuple[bytes, Factorizer] | None = None
        self.result: Result = self._solved(self.system, None)

    @property
    def waves_note(self) -> str:
        """What a reader must know of the waves of the case, "" without any."""
        if self.case.waves is None:
            return ""
        if self._built.waves is None:
            return "The waves of this case play no part: it is a static one."
        return f"Waves ({self.case.waves.described}) act in motion only: the equilibrium is without them."

    @property
    def numbers(self) -> Numbers:
        """Numbers of the present shape."""
        last, net = self.result.frame(), self.result.net
        drag, lift = drag_and_lift(last.hydrodynamic_force, flow_direction(self._built))
        return Numbers(
            drag,
            lift,
            float(last.tension.max(initial=0.0)),
            int(np.count_nonzero(last.tension <= 0.0)),
            net.bar_count,
            float(np.max(np.linalg.norm(last.position - net.positions, axis=1))),
        )

    def turn(self, changes: dict[str, float]) -> None:
        """Give knobs new values (in their units) and find the new shape; in motion, go on with the new net.

        RefusedError when they make no net or the net finds no equilibrium: all is as it was.
        """
        values = self.values | changes
        try:
            case = parse_case(tomli_w.dumps(turned(self._raw, self.knobs, values)), path=self.path)
            built = _system_of(case)
        except CaseError as error:
            raise RefusedError(
                "; ".join(f"{p.found}: {p.allowed} is allowed" for p in error.problems)
            ) from None
        except ValueError as error:
            raise RefusedError(str(error)) from None
        system = self._pinned(built)
        begin = self._start(system)
        if self.run is None:
            self.result = self._solved(system, begin)
        else:
            self._let_go(system, begin)
        self.case, self.values, self._built, self.system = case, values, built, system

    def pin(self, knot: int, place: Array | None = None) -> None:
        """Hold a knot where it is, or at a place (3,) m; RefusedError leaves all as it was."""
        before = dict(self.pins)
        self.pins[knot] = np.array(self.result.position[-1][knot] if place is None else place, dtype=float)
        self._held_anew(before)

    def release(self, knot: int) -> None:
        """Let a pinned knot go."""
        before = dict(self.pins)
        if self.pins.pop(knot, None) is not None:
            self._held_anew(before)

    def _held_anew(self, before: dict[int, Array]) -> None:
        system = self._pinned(self._built)
        try:
            begin = self._start(system)
            if self.run is None:
                self.result = self._solved(system, begin)
            else:
                self._let_go(system, begin)
        except RefusedError:
            self.pins = before
            raise
        self.system = system

    def _pinned(self, built: System) -> System:
        """Return the system with the pinned knots held."""
        if not self.pins:
            return built
        fixed, free, positions = (
            built.net.fixed.copy(),
            built.elements.free.copy(),
            built.net.positions.copy(),
        )
        knots = list(self.pins)
        fixed[knots], free[knots], positions[knots] = True, 0.0, list(self.pins.values())
        net = replace(built.net, fixed=fixed, positions=positions)
        return replace(built, net=net, elements=built.elements._replace(free=free))

    def _start(self, system: System) -> State:
        """Present state, with held knots where the system holds them."""
        state = self.result.state()
        position, velocity = state.position.copy(), state.velocity.copy()
        held = system.net.fixed
        position[held], velocity[held] = system.net.positions[held], 0.0
        return State(state.time, position, velocity, state.tension)

    def _solved(self, system: System, begin: State | None) -> Result:
        solve = self.case.solve
        tolerance = TOLERANCE if isinstance(solve, DynamicSolve) else solve.tolerance
        linear = self._factorizer(system)
        result = solve_static(system, tolerance=tolerance, start=begin, linear=linear)
        if not result.outcome.ok and begin is not None and not self.pins:
            result = solve_static(system, tolerance=tolerance, linear=linear)
        if not result.outcome.ok:
            raise RefusedError(f"no equilibrium: {result.outcome.message}. Try: {result.outcome.advice}")
        return result

    def _factorizer(self, system: System) -> Factorizer:
        """Solver for the pattern of a system, the last one while the same knots are free."""
        free = system.elements.free.tobytes()
        if self._linear is None or self._linear[0] != free:
            self._linear = free, factorizer(Pattern.of(system.elements, Surroundings(system).groups))
        return self._linear[1]

    def play(self) -> None:
        """Set the net in motion from its present shape."""
        if self.run is None:
            self._let_go(self.system, replace(self.result.state(), time=0.0))

    def reset(self) -> None:
        """Lay the net out as it was built, at rest, and set it in motion."""
        self._let_go(self.system, self.system.at_rest())

    def _let_go(self, system: System, begin: State) -> None:
        self.run = Implicit().start(system, State(begin.time, begin.position, begin.velocity))
        self._picture(system, begin)

    def pause(self) -> None:
        """End the motion; the shape stays as it is until something is moved."""
        self.run = None

    def advance(self, seconds: float) -> float:
        """Go on by so much simulated time (s); returns the wall time (s) that it took."""
        if self.run is None:
            return 0.0
        began, end = time.perf_counter(), self.run.state.time + seconds
        while self.run.state.time < end:
            status = self.run.advance(end)
            if status != "ok":
                self.run = None
                raise RefusedError(f"the motion ends here: {status.replace('_', ' ')}")
        self._picture(self.system, self.run.state)
        return time.perf_counter() - began

    def _picture(self, system: System, state: State) -> None:
        """Make a frame of a state in motion the present one."""
        frame = evaluate(system, state)
        outcome = Outcome(
            name="completed",
            message=f"in motion at {state.time:.3f} s",
            advice="",
            solver="dynamic implicit",
            linear_solver="",
            iterations=0,
            factorizations=0,
            residual=frame.unbalanced_force,
            wall_time=0.0,
        )
        self.result = Result.from_frames(system.net, outcome, system.weight_in_water, [frame], self.case.text)

    def nearest_knot(self, origin: Sequence[float], direction: Sequence[float]) -> int | None:
        """Knot nearest to a ray of sight, within half a bar of it; None where there is none."""
        points = self.result.position[-1] - np.asarray(origin)
        along = np.asarray(direction) / np.linalg.norm(direction)
        depth = points @ along
        away = np.linalg.norm(points - depth[:, None] * along, axis=1)
        away[depth <= 0.0] = np.inf
        knot = int(np.argmin(away))
        return knot if away[knot] <= 0.5 * float(np.median(self.result.net.rest_length)) else None

    def case_text(self) -> str:
        """Return the case as it is now, to be run; pinned knots, for which it has no word, are named in a comment."""
        labels = self.result.net.labels
        pins = [
            f"#   {labels[k]} at {', '.join(f'{v:.6g}' for v in p)} m" for k, p in sorted(self.pins.items())
        ]
        head = ["# Saved from the live view of fyke."]
        if pins:
            head += ["# Knots that were pinned there, which a case file cannot say:", *pins]
        return "\n".join([*head, tomli_w.dumps(turned(self._raw, self.knobs, self.values))])
