"""How a solve ended, as a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

OutcomeName = Literal[
    "converged",  # static: residual below tolerance; dynamic: came to rest by the stated criterion
    "completed",  # dynamic: the asked duration is over
    "iteration_limit",
    "stalled",
    "singular",
    "not_finite",
    "out_of_memory",
    "step_too_small",
    "not_settled",  # dynamic: the duration ran out before the stated criterion was met
    "interrupted",
]

# Name, message and advice.
Verdict = tuple[OutcomeName, str, str]


def out_of_memory(error: MemoryError) -> Verdict:
    """Return the verdict on a solve that there is no room for."""
    return (
        "out_of_memory",
        str(error) or "the memory ran out",
        "group meshes so that the net has fewer knots, take a larger machine, or let an explicit stepper bring the net "
        "to rest, which factorizes nothing; the last good state is kept",
    )


@dataclass(frozen=True)
class Outcome:
    """How a solve ended.

    message: one sentence, what happened and where (time, knot); advice: one sentence, what to try, "" when all is
    well; residual: largest unbalanced force on a free knot (N); iterations: Newton iterations or time steps;
    rejected: time steps thrown away; force_evaluations: of a dynamic run; wall_time: s; time: simulated time (s);
    warnings: sentences with the number and the limit.
    """

    name: OutcomeName
    message: str
    advice: str
    solver: str
    linear_solver: str
    iterations: int
    factorizations: int
    residual: float
    wall_time: float
    time: float = 0.0
    rejected: int = 0
    force_evaluations: int = 0
    warnings: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the solve did what was asked."""
        return self.name in ("converged", "completed")
