"""From a case and its system to a result."""

from __future__ import annotations

from collections.abc import Callable

from ..case.schema import Case, DynamicSolve
from ..forces.compiled import is_compiled
from ..forces.frame import Frame
from ..system.system import System
from .cone import cone_changes
from .dynamic import Settle, output_times, simulate
from .result import Result
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


def needs_compiling(case: Case) -> bool:
    """Whether a run of the case has to compile its kernels first, which takes some ten seconds, once."""
    if not isinstance(case.solve, DynamicSolve):
        return not is_compiled(cone_changes)
    return not is_compiled(leap if case.solve.stepper == "symplectic" else advance)


def stepper_of(chosen: DynamicSolve) -> Stepper:
    """Return the stepper that a dynamic case names."""
    if chosen.stepper == "symplectic":
        return Symplectic(max_step=chosen.max_step)
    return Verner(rtol=chosen.rtol, atol=chosen.atol, max_step=chosen.max_step)


def solve_case(
    system: System,
    case: Case,
    *,
    on_frame: Callable[[Frame], None] | None = None,
    on_progress: Progress | None = None,
) -> Result:
    """Do what the case's [solve] asks; on_frame gets every frame as it comes, on_progress a fraction and a text."""
    chosen = case.solve
    if not isinstance(chosen, DynamicSolve):
        result = solve_static(system, tolerance=chosen.tolerance, on_progress=on_progress)
        if on_frame is not None:
            on_frame(result.frame())
        return result
    settle = Settle(chosen.settle_force, chosen.settle_energy)
    return simulate(
        system,
        duration=chosen.duration,
        stepper=stepper_of(chosen),
        every=case.output.every,
        settle=settle if settle != Settle() else None,
        on_frame=on_frame,
        on_progress=on_progress,
    )
