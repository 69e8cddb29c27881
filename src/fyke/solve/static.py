"""Static equilibrium by a primal-dual interior-point method, from any start, without tuning.

Two fields. Far from the solution the steps are those of second-order cones (solve.cone), in which a turning bar
makes no false stretch. As soon as one bar is within NEAR of its cone's edge, the steps are those of tension and slack
(solve.central_path), which end quadratically. Both use the full tangent, the water's load included, with one sparse LU
an iteration and two solves with it. The end is judged on the true residual: the largest unbalanced force on a free
knot with tensions by the elastic law itself.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from ..forces.evaluate import evaluate
from ..system.system import State, System
from .equilibrium import Equilibrium
from .far_field import Far
from .linear import Factorizer, SingularMatrixError
from .near_field import Near
from .outcome import Outcome, OutcomeName
from .result import Result
from .strain import strain_warnings

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

# Gap of a bar to its cone's edge, over the bar's length, at which the near field takes over.
NEAR = 1e-3
# When that was too early the far field goes on to a gap NEARER times as large, down to LEAST_NEAR.
NEARER, LEAST_NEAR = 1e-3, 1e-8
# Steps shorter than SHORT, so many in a row, are a stall.
SHORT, SHORT_STEPS = 1e-2, 5
# A warm start that is not there after so many iterations was none: the solve begins anew.
WARM_STEPS = 12


def solve_static(
    system: System,
    *,
    tolerance: float = 1e-8,
    max_iterations: int = 100,
    start: State | None = None,
    linear: Factorizer | None = None,
    on_progress: Progress | None = None,
) -> Result:
    """Find the static equilibrium of a net.

    tolerance: N, largest unbalanced force on a free knot; where the rounding of the coordinates alone makes more than
    that, its size is the tolerance and the outcome says so. start: where to begin, the net as built by default; with
    tensions, as Result.state gives them for a net like this one, it is a warm start that takes a few iterations. How
    it ended is the result's outcome; a solve that fails or is stopped by Ctrl-C returns the last good state.
    """
    began = time.perf_counter()
    begin = start or system.at_rest()
    s = Equilibrium(system, begin, linear)
    loose = loose_knots(system)
    if loose.size:
        name, message, advice = _floating(system, loose)
    else:
        try:
            name, message, advice = _iterate(s, tolerance, max_iterations, begin.tension, on_progress)
        except KeyboardInterrupt:
            name, message = "interrupted", f"stopped by hand after {s.iterations} iterations"
            advice = "the last shape is saved; run it again"
    if name == "converged" and s.residual > tolerance:
        message += f"; the asked {tolerance:g} N is below the rounding of the coordinates, {s.floor:.1e} N"
    state = State(0.0, s.good + s.origin, np.zeros_like(s.good))
    frame = evaluate(system, state)
    outcome = Outcome(
        name=name,
        message=message,
        advice=advice,
        solver="static interior point",
        linear_solver=s.linear.name,
        iterations=s.iterations,
        factorizations=s.factorizations,
        residual=frame.unbalanced_force,
        wall_time=time.perf_counter() - began,
        warnings=strain_warnings(system.net, [frame]),
    )
    return Result.from_frames(system.net, outcome, system.weight_in_water, [frame], system.case_text)


def loose_knots(system: System) -> NDArray[np.int64]:
    """Knots that no chain of bars joins to a held knot."""
    el, n = system.elements, system.net.knot_count
    graph = csr_matrix((np.ones(len(el.knot_a)), (el.knot_a, el.knot_b)), shape=(n, n))
    part = connected_components(graph, directed=False)[1]
    return np.flatnonzero(~np.isin(part, part[el.free == 0.0]))


Verdict = tuple[OutcomeName, str, str]


def _floating(system: System, loose: NDArray[np.int64]) -> Verdict:
    labels = system.net.labels
    return (
        "singular",
        f"knots {labels[loose[0]]} .. {labels[loose[-1]]} ({len(loose)}) are held by nothing, so no equilibrium exists",
        "hold a knot of that part, for example fixed = 'top', or run it as a dynamic case",
    )


def _iterate(
    s: Equilibrium, tolerance: float, limit: int, tension: Array | None, on_progress: Progress | None
) -> Verdict:
    """Far field, then near field, until the true residual is below tolerance; a warm start begins in the near one."""
    begin, gap, short = s.x.copy(), NEAR, 0
    first = max(s.residual, tolerance)
    warm = tension is not None
    far, near = Far(s), None if tension is None else Near.warm(s, tension)
    # The rounding is that of the shape found, which may be much larger than the start.
    while not s.residual <= max(tolerance, s.floor):
        if s.iterations >= limit:
            return _out_of_iterations(s)
        if near is None and far.near(gap):
            near = Near.after(far)
        try:
            step = (near or far).step()
        except SingularMatrixError as error:
            return _no_inverse(s, error)
        if not np.isfinite(s.residual):
            return _not_finite(s)
        short = short + 1 if step < SHORT else 0
        if short >= SHORT_STEPS and (near is None or gap <= LEAST_NEAR):
            return _stalled(s)
        if short >= SHORT_STEPS or (warm and s.iterations >= WARM_STEPS):
            # The near field jams when it begins too far off: once more from the start, with a longer far field.
            gap = gap if warm else gap * NEARER
            warm, short = False, 0
            s.begin_at(begin)
            far, near = Far(s), None
        if on_progress is not None:
            done = np.log(first / max(s.residual, tolerance)) / max(np.log(first / tolerance), 1.0)
            on_progress(
                float(np.clip(done, 0.0, 1.0)), f"iteration {s.iterations}, residual {s.residual:.1e} N"
            )
    return "converged", f"largest unbalanced force {s.residual:.1e} N after {s.iterations} iterations", ""


def _left(s: Equilibrium) -> str:
    return f"{s.residual:.3g} N are left at knot {s.system.net.labels[s.worst]}"


def _out_of_iterations(s: Equilibrium) -> Verdict:
    return (
        "iteration_limit",
        f"{s.iterations} iterations were not enough: {_left(s)}",
        "raise max_iterations, or let a dynamic case with twine damping find the shape",
    )


def _no_inverse(s: Equilibrium, error: SingularMatrixError) -> Verdict:
    return (
        "singular",
        f"the tangent has no inverse in iteration {s.iterations + 1} ({error}): {_left(s)}",
        "look for knots that nothing holds in some direction, or begin from another shape",
    )


def _not_finite(s: Equilibrium) -> Verdict:
    return (
        "not_finite",
        f"the force on knot {s.system.net.labels[s.worst]} is not a number in iteration {s.iterations}",
        "look for bars of zero length or an elastic law that has no value there",
    )


def _stalled(s: Equilibrium) -> Verdict:
    return (
        "stalled",
        f"steps became too short after {s.iterations} iterations: {_left(s)}",
        "the net may have no stable shape near this start: begin from another one, or run a dynamic case",
    )
