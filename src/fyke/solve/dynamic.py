"""Dynamics: one time loop, any stepper."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..forces.evaluate import evaluate
from ..forces.frame import Frame
from ..system.system import State, System
from .auto import Auto, AutoRun
from .outcome import Outcome, Verdict, out_of_memory
from .result import Result
from .stepper import Count, Memory, Run, Status, Stepper
from .strain import strain_warnings

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

# All frames of a run are kept in memory; more than this is a slip of the pen.
MOST_FRAMES = 10_000_000


@dataclass(frozen=True)
class Settle:
    """When a net has come to rest: every criterion given holds at an output time.

    force: largest unbalanced force on a free knot, N; energy: kinetic energy, J. ValueError without either and for one
    that is not above 0.
    """

    force: float | None = None
    energy: float | None = None

    def __post_init__(self) -> None:
        """Refuse what is met at once or never."""
        if self.force is None and self.energy is None:
            raise ValueError("Settle needs force (N) or energy (J), or a run would end at once")
        for name, limit in (("force", self.force), ("energy", self.energy)):
            if limit is not None and not limit > 0.0:
                raise ValueError(
                    f"{name} of Settle must be above 0, not {limit:g}: nothing ever falls below it"
                )

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


@dataclass(frozen=True)
class Checkpoint:
    """Where a run stands after an output.

    frames: outputs so far; memory: of the stepper; count: its steps so far.
    """

    frames: int
    memory: Memory
    count: Count


def output_times(duration: float, every: float | None) -> np.ndarray:
    """Times (s) of the frames: 0, every, 2 every .. and the end; a hundred intervals by default.

    ValueError for a duration or interval that is not a number above 0, an interval above the duration and more than
    MOST_FRAMES frames.
    """
    for name, value in (("duration", duration), ("every", every)):
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be a number of seconds above 0, not {value:g}")
    if every is not None and every > duration:
        raise ValueError(f"every {every:g} s is longer than the duration of {duration:g} s")
    if every is not None and duration / every > MOST_FRAMES:
        raise ValueError(
            f"every {every:g} s makes {duration / every:.3g} frames in {duration:g} s; {MOST_FRAMES:.0e} are the most"
        )
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
    on_checkpoint: Callable[[Checkpoint], None] | None = None,
    resume: tuple[Checkpoint, Sequence[Frame]] | None = None,
) -> Result:
    """Let a net move in the water from a state at rest (the net as built) or from start.

    duration, every: s, every is the interval of the frames; settle: stop as soon as the net is at rest; on_frame is
    handed every frame as it comes. Ctrl-C ends the run with the frames so far and the outcome "interrupted".
    on_checkpoint gets a checkpoint after every frame; resume: such a checkpoint of a run with the same arguments and
    the frames up to it, from which the run goes on with the same bits. ValueError for times that contradict each
    other: those of output_times, and a max_step that is not above 0 or above the duration.
    """
    began = time.perf_counter()
    method: Stepper = stepper or Auto()
    if isinstance(method, Auto):
        method = replace(method, duration=duration)
    planned = output_times(duration, every)
    _check_max_step(method, duration)
    state = start or system.at_rest()
    state = State(state.time, state.position, state.velocity)
    run = method.start(system, state)
    warnings = _step_warnings(system, state, method)
    frames: list[Frame] = []
    times = state.time + planned
    if resume is not None:
        frames += resume[1]
        run.restore(resume[0].memory)
        run.count = replace(resume[0].count)

    def keep(frame: Frame) -> None:
        frames.append(frame)
        if on_frame is not None:
            on_frame(frame)
        if on_checkpoint is not None:
            on_checkpoint(Checkpoint(len(frames), run.memory(), replace(run.count)))

    try:
        verdict = _loop(system, run, times[len(frames) :], settle, keep, on_progress)
    except KeyboardInterrupt:
        verdict = _by_hand(run)
    except MemoryError as error:
        verdict = out_of_memory(error)
    if not frames or run.state.time > frames[-1].time:
        # Stopped between two outputs: the last good state is kept.
        frames.append(evaluate(system, run.state))
        if on_frame is not None:
            on_frame(frames[-1])
    warnings += strain_warnings(system.net, frames)
    outcome = _outcome(run, method, verdict, time.perf_counter() - began, frames[-1], warnings)
    return Result.from_frames(system.net, outcome, system.weight_in_water, frames, system.case_text)


def _by_hand(run: Run) -> Verdict:
    return (
        "interrupted",
        f"stopped by hand at {run.state.time:.4g} s",
        "the frames so far are saved; fyke run --resume goes on from there",
    )


def _outcome(
    run: Run, method: Stepper, verdict: Verdict, seconds: float, last: Frame, warnings: tuple[str, ...]
) -> Outcome:
    name, message, advice = verdict
    story = f": {run.story()}" if isinstance(run, AutoRun) else ""
    return Outcome(
        name=name,
        message=message,
        advice=advice,
        solver=f"dynamic {method.name}{story}",
        linear_solver=run.linear_solver,
        iterations=run.count.steps,
        factorizations=run.count.factorizations,
        residual=last.unbalanced_force,
        wall_time=seconds,
        time=run.state.time,
        rejected=run.count.rejected,
        force_evaluations=run.count.evaluations,
        warnings=warnings,
    )


def _check_max_step(method: Stepper, duration: float) -> None:
    longest = method.max_step
    if longest is not None and not 0.0 < longest <= duration:
        raise ValueError(
            f"max_step must be above 0 and at most the duration of {duration:g} s, not {longest:g} s"
        )


def _step_warnings(system: System, state: State, method: Stepper) -> tuple[str, ...]:
    bound = method.stability_bound(system, state)
    if method.max_step is None or method.max_step <= bound:
        return ()
    return (
        f"max_step {method.max_step:g} s is above the stability bound {bound:.3g} s of the {method.name} stepper on "
        "this net; the bound is used",
    )


def _loop(
    system: System,
    run: Run,
    times: Array,
    settle: Settle | None,
    keep: Callable[[Frame], None],
    on_progress: Progress | None,
) -> Verdict:
    """From output time to output time until the end, rest or a fault."""
    begin, massless = (
        run.state.time,
        np.flatnonzero((system.elements.free > 0.0) & (system.elements.knot_mass == 0.0)),
    )
    if massless.size:
        keep(evaluate(system, run.state))
        return (
            "singular",
            f"knot {system.net.labels[massless[0]]} is free and has no mass",
            "give its twine a density or the knot a diameter and a density",
        )
    frame = evaluate(system, run.state)
    steady_from = 0.0 if system.motion is None else system.motion.steady_from
    for end in times.tolist():
        while run.state.time < end:
            status = run.advance(end)
            if status != "ok":
                return _fault(system, run, status)
            if on_progress is not None:
                done = (run.state.time - begin) / (times[-1] - begin)
                on_progress(float(done), f"t = {run.state.time:.4g} s, step {run.step:.2e} s")
        frame = evaluate(system, run.state)
        keep(frame)
        if settle is not None and end > begin and end >= steady_from and settle.reached(frame):
            return "converged", f"at rest after {frame.time:.4g} s: {settle.describe()}", ""
    if settle is None:
        return "completed", f"{frame.time:g} s simulated", ""
    return (
        "not_settled",
        f"not at rest after {frame.time:.4g} s: unbalanced force {frame.unbalanced_force:.2e} N, kinetic energy "
        f"{frame.kinetic_energy:.2e} J",
        "let it run longer, or give the twine a damping_time, without which taut bars ring",
    )


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
