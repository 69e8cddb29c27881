"""Dynamics: one time loop, any stepper."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..forces.evaluate import evaluate
from ..forces.frame import Frame
from ..system.system import State, System
from .implicit import Implicit
from .outcome import Outcome, OutcomeName
from .result import Result
from .stepper import Run, Status, Stepper
from .strain import strain_warnings

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class Settle:
    """When a net has come to rest: every criterion given holds at an output time.

    force: largest unbalanced force on a free knot, N; energy: kinetic energy, J.
    """

    force: float | None = None
    energy: float | None = None

    def reached(self, frame: Frame) -> bool:
        """Whether the frame is at rest."""
        return (self.force is None or frame.unbalanced_force < self.force) and (
            self.energy is None or frame.kinetic_energy < self.energy
        )

    def describe(self) -> str:
        """Return the criterion in words."""
        parts = []
        if self.force is not None:
            parts.append(f"unbalanced force below {self.force:g} N")
        if self.energy is not None:
            parts.append(f"kinetic energy below {self.energy:g} J")
        return " and ".join(parts)


def output_times(duration: float, every: float | None) -> np.ndarray:
    """Times (s) of the frames: 0, every, 2 every .. and the end; a hundred intervals by default."""
    interval = every or duration / 100.0
    whole = int(np.floor(duration / interval * (1.0 + 1e-12)))
    times = interval * np.arange(whole + 1)
    if times[-1] < duration * (1.0 - 1e-12):
        times = np.append(times, duration)
    times[-1] = duration
    return times


def simulate(
    system: System,
    *,
    duration: float,
    stepper: Stepper | None = None,
    every: float | None = None,
    settle: Settle | None = None,
    start: State | None = None,
    on_frame: Callable[[Frame], None] | None = None,
    on_progress: Progress | None = None,
) -> Result:
    """Let a net move in the water from a state at rest (the net as built) or from start.

    duration, every: s, every is the interval of the frames; settle: stop as soon as the net is at rest; on_frame is
    handed every frame as it comes. Ctrl-C ends the run with the frames so far and the outcome "interrupted".
    """
    began = time.perf_counter()
    method: Stepper = stepper or Implicit()
    state = start or system.at_rest()
    state = State(state.time, state.position, state.velocity)
    run = method.start(system, state)
    warnings = _step_warnings(system, state, method)
    frames: list[Frame] = []
    try:
        verdict = _loop(system, run, duration, every, settle, frames, on_frame, on_progress)
    except KeyboardInterrupt:
        if not frames or run.state.time > frames[-1].time:
            _keep(frames, evaluate(system, run.state), on_frame)
        verdict = "interrupted", f"stopped by hand at {run.state.time:.4g} s", "the frames so far are saved"
    name, message, advice = verdict
    outcome = Outcome(
        name=name,
        message=message,
        advice=advice,
        solver=f"dynamic {method.name}",
        linear_solver=run.linear_solver,
        iterations=run.count.steps,
        factorizations=run.count.factorizations,
        residual=frames[-1].unbalanced_force,
        wall_time=time.perf_counter() - began,
        time=run.state.time,
        rejected=run.count.rejected,
        force_evaluations=run.count.evaluations,
        warnings=warnings + strain_warnings(system.net, frames),
    )
    return Result.from_frames(system.net, outcome, system.weight_in_water, frames, system.case_text)


def _step_warnings(system: System, state: State, method: Stepper) -> tuple[str, ...]:
    bound = method.stability_bound(system, state)
    if method.max_step is None or method.max_step <= bound:
        return ()
    return (
        f"max_step {method.max_step:g} s is above the stability bound {bound:.3g} s of the {method.name} stepper on "
        "this net; the bound is used",
    )


Verdict = tuple[OutcomeName, str, str]


def _loop(
    system: System,
    run: Run,
    duration: float,
    every: float | None,
    settle: Settle | None,
    frames: list[Frame],
    on_frame: Callable[[Frame], None] | None,
    on_progress: Progress | None,
) -> Verdict:
    """From output time to output time until the end, rest or a fault."""
    begin = run.state.time
    massless = np.flatnonzero((system.elements.free > 0.0) & (system.elements.knot_mass == 0.0))
    if massless.size:
        _keep(frames, evaluate(system, run.state), on_frame)
        return (
            "singular",
            f"knot {system.net.labels[massless[0]]} is free and has no mass",
            "give its twine a density or the knot a diameter and a density",
        )
    _keep(frames, evaluate(system, run.state), on_frame)
    for offset in output_times(duration, every)[1:]:
        while run.state.time < begin + offset:
            status = run.advance(begin + float(offset))
            if status != "ok":
                return _fault(system, run, status)
            if on_progress is not None:
                done = (run.state.time - begin) / duration
                on_progress(done, f"t = {run.state.time:.4g} s, step {run.step:.2e} s")
        frame = evaluate(system, run.state)
        _keep(frames, frame, on_frame)
        if settle is not None and settle.reached(frame):
            return "converged", f"at rest after {frame.time:.4g} s: {settle.describe()}", ""
    if settle is None:
        return "completed", f"{duration:g} s simulated", ""
    last = frames[-1]
    return (
        "not_settled",
        f"not at rest after {last.time:.4g} s: unbalanced force {last.unbalanced_force:.2e} N, kinetic energy "
        f"{last.kinetic_energy:.2e} J",
        "let it run longer, or give the twine a damping_time, without which taut bars ring",
    )


def _keep(frames: list[Frame], frame: Frame, on_frame: Callable[[Frame], None] | None) -> None:
    frames.append(frame)
    if on_frame is not None:
        on_frame(frame)


def _fault(system: System, run: Run, status: Status) -> Verdict:
    """Name the time, the knot and the likely cause."""
    state = run.state
    speed = np.linalg.norm(state.velocity, axis=1)
    knot = system.net.labels[int(np.argmax(speed))]
    where = f"after t = {state.time:.6g} s, fastest knot {knot} at {speed.max():.3g} m/s"
    if status == "not_finite":
        return (
            "not_finite",
            f"a position or velocity is not a number {where}",
            "a step above the stable one or an elastic law without a value is the usual cause: leave max_step out",
        )
    return (
        "step_too_small",
        f"the step fell to {run.step:.2e} s {where}",
        "loosen rtol and atol, or give the twine a damping_time",
    )
