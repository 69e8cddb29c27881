"""From a case and its system to a result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..case.schema import Case, DynamicSolve
from ..forces.compiled import is_compiled
from ..forces.frame import Frame
from ..forces.screen_tangents import screen_tangents
from ..forces.upstream import wake_factors
from ..system.system import State, System
from ..water.waves.kernel import motion_of
from .auto import Auto
from .cone import cone_changes
from .dynamic import Checkpoint, Settle, output_times, simulate
from .implicit import Implicit, Newmark
from .result import Result
from .smooth import assemble_step
from .static import solve_static
from .stepper import Stepper
from .symplectic import Symplectic, leap
from .verner import Verner, advance

Progress = Callable[[float, str], None]


def planned_frames(case: Case) -> int:
    """Count the frames that a run of the case makes when nothing ends it early."""
    if isinstance(case.solve, DynamicSolve):
        return len(output_times(case.solve.duration, case.output.every))
    return 1


STEPPERS: dict[str, Callable[..., Stepper]] = {
    "auto": Auto,
    "implicit": Implicit,
    "newmark": Newmark,
    "verner": Verner,
    "symplectic": Symplectic,
}
# The kernels that take longest to compile, by what is asked for.
_KERNELS: dict[str, tuple[Any, ...]] = {
    "static": (cone_changes,),
    "auto": (assemble_step, leap),
    "implicit": (assemble_step,),
    "newmark": (assemble_step,),
    "verner": (advance,),
    "symplectic": (leap,),
}


def needs_compiling(case: Case) -> bool:
    """Whether a run of the case has to compile its kernels first, which takes some ten seconds, once."""
    chosen = case.solve
    kernels = [*_KERNELS[chosen.stepper if isinstance(chosen, DynamicSolve) else "static"]]
    if isinstance(chosen, DynamicSolve) and case.waves is not None:
        kernels.append(motion_of)
    if case.drag.kind == "screens":
        kernels.append(screen_tangents)
    if case.shelter.wake_law() is not None:
        kernels.append(wake_factors)
    return not all(is_compiled(kernel) for kernel in kernels)


def stepper_of(chosen: DynamicSolve) -> Stepper:
    """Return the stepper that a dynamic case names, with the options that it gives."""
    names = ("max_step",) if chosen.stepper == "symplectic" else ("rtol", "atol", "max_step")
    given = {name: value for name in names if (value := getattr(chosen, name)) is not None}
    return STEPPERS[chosen.stepper](**given)


def solve_case(
    system: System,
    case: Case,
    *,
    on_frame: Callable[[Frame], None] | None = None,
    on_progress: Progress | None = None,
    on_checkpoint: Callable[[Checkpoint], None] | None = None,
    resume: tuple[Checkpoint, Sequence[Frame]] | None = None,
    start: State | None = None,
) -> Result:
    """Do what the case's [solve] asks.

    on_frame gets every frame as it comes, on_progress a fraction and a text; on_checkpoint and resume are those of
    simulate and for dynamic cases only; start is that of solve_static and for static ones.
    """
    chosen = case.solve
    if not isinstance(chosen, DynamicSolve):
        result = solve_static(system, tolerance=chosen.tolerance, start=start, on_progress=on_progress)
        if on_frame is not None:
            on_frame(result.frame())
        return result
    begin = None
    if chosen.start == "equilibrium" and resume is None:
        rest = solve_static(system, tolerance=chosen.tolerance)
        if not rest.outcome.ok:
            message = f"no equilibrium to begin at: {rest.outcome.message}"
            if on_frame is not None:
                on_frame(rest.frame())
            return replace(rest, outcome=replace(rest.outcome, message=message))
        begin = State(0.0, rest.position[-1], np.zeros_like(rest.position[-1]))
    ends = chosen.settle_force is not None or chosen.settle_energy is not None
    return simulate(
        system,
        duration=chosen.duration,
        stepper=stepper_of(chosen),
        every=case.output.every,
        settle=Settle(chosen.settle_force, chosen.settle_energy) if ends else None,
        start=begin,
        on_frame=on_frame,
        on_progress=on_progress,
        on_checkpoint=on_checkpoint,
        resume=resume,
    )
