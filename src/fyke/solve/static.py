"""Static equilibrium by a primal-dual interior-point method, from any start, without tuning.

Two fields. Far from the solution the steps are those of second-order cones (solve.cone), in which a turning bar
makes no false stretch. As soon as one bar is within NEAR of its cone's edge, the steps are those of tension and slack
(solve.central_path), which end quadratically. Both use the full tangent, the water's load included, with one sparse LU
an iteration and two solves with it. A net on which they do not arrive relaxes in time (solve.relaxation). The end is
judged on the true residual: the largest unbalanced force on a free knot with tensions by the elastic law itself.
Shelter is that of the present shape at every step, though the tangent does not know how it changes; where that way
does not arrive it goes part of the way a step (solve.approach), and at last is held between renewals
(solve.held_shelter).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from ..forces.bars import borne
from ..forces.evaluate import evaluate
from ..system.system import State, System
from .approach import Approach, Gain
from .equilibrium import Equilibrium
from .far_field import Far
from .held_shelter import by_renewals
from .linear import Factorizer, SingularMatrixError
from .near_field import Near
from .nested import Nested, nested_start
from .outcome import Outcome, Verdict, out_of_memory
from .relaxation import relax
from .result import Result
from .stability import settle
from .strain import strain_warnings
from .warm_field import Warm

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

# Gap of a bar to its cone's edge, over the bar's length, at which the near field takes over.
NEAR = 1e-3
# When that was too early the far field goes on to a gap NEARER times as large, down to LEAST_NEAR.
NEARER, LEAST_NEAR = 1e-3, 1e-8
# Steps shorter than SHORT, so many in a row, are a stall.
SHORT, SHORT_STEPS = 1e-2, 5
# A warm start that is not there after so many iterations was none: the solve begins anew.
WARM_STEPS = 45
# The interior point arrives within so many iterations, or most often not at all: then the net relaxes in time.
PATIENCE = 50
# Floating parts that are named one by one.
NAMED_PARTS = 3


def solve_static(
    system: System,
    *,
    tolerance: float = 1e-8,
    max_iterations: int = 1000,
    start: State | None = None,
    linear: Factorizer | None = None,
    on_progress: Progress | None = None,
) -> Result:
    """Find the static equilibrium of a net.

    tolerance: N, largest unbalanced force on a free knot; where the rounding of the coordinates alone makes more than
    that, its size is the tolerance and the outcome says so. start: where to begin, the net as built by default; with
    tensions, as Result.state gives them for a net like this one, it is a warm start that takes a few iterations. A
    large panel without such a start is begun on grouped meshes (solve.nested): the outcome counts the iterations on
    the real meshes, its message names the others. How it ended is the result's outcome; a solve that fails or is
    stopped by Ctrl-C returns the last good state. Held knots stay where the net has them, whatever the start. Raises
    ValueError for a tolerance that is not above zero, less than one iteration, and a start of another shape or with
    values that are no numbers. Waves are left out, and so are held knots that swing; ValueError for a steady tow.
    """
    began = time.perf_counter()
    if system.motion is not None and system.motion.tows:
        raise ValueError(
            "a net that is towed has its equilibrium as it is seen from what tows it: "
            "solve fyke.system.carriage.seen_from_the_carriage(system)"
        )
    system = system.resting()
    begin = _begin(system, tolerance, max_iterations, start)
    nest = _nested(system, begin, tolerance, on_progress)
    begin = nest.start if nest else begin
    s = Equilibrium(system, begin, linear)
    if nest:
        s.smoothing = nest.smoothing
    loose = loose_parts(system)
    unstable: tuple[str, ...] = ()
    if loose:
        name, message, advice = _floating(system, loose)
    elif not np.isfinite(s.residual):
        name, message, advice = _not_finite(s)
    elif nest and nest.interrupted:
        name, message, advice = _interrupted(s)
    else:
        try:
            name, message, advice = _iterate(s, tolerance, max_iterations, begin.tension, on_progress)
            if name != "converged" and s.follows:
                s.begin_at(begin.position - s.origin)
                name, message, advice = by_renewals(
                    s, tolerance, begin.tension, lambda to, f: _iterate(s, to, max_iterations, f, on_progress)
                )
            if name == "converged":
                more, unstable = settle(s, tolerance, max_iterations)
                message += f", {more} more to leave an equilibrium that is not stable" if more else ""
        except KeyboardInterrupt:
            name, message, advice = _interrupted(s)
        except MemoryError as error:
            name, message, advice = out_of_memory(error)
    if nest and name == "converged":
        message += f", begun from {nest.levels}"
    if name == "converged" and s.residual > tolerance:
        message += f"; the asked {tolerance:g} N is below the rounding of the coordinates, {s.floor:.1e} N"
    return _result(s, (name, message, advice), unstable, began)


def _result(s: Equilibrium, verdict: Verdict, unstable: tuple[str, ...], began: float) -> Result:
    """Result of the last good state; unstable: what to warn of; began: time.perf_counter() at the start."""
    system, (name, message, advice) = s.system, verdict
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
        warnings=strain_warnings(system.net, [frame]) + unstable,
    )
    return Result.from_frames(system.net, outcome, system.weight_in_water, [frame], system.case_text)


def _begin(system: System, tolerance: float, max_iterations: int, start: State | None) -> State:
    """Return where to begin, with the held knots in their places; raises ValueError for what cannot be meant."""
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise ValueError(f"tolerance is {tolerance}, a force (N) above zero was expected")
    if max_iterations < 1:
        raise ValueError(f"max_iterations is {max_iterations}, at least 1 was expected")
    if start is None:
        return system.at_rest()
    net = system.net
    wanted: dict[str, tuple[Array, tuple[int, ...]]] = {"position": (start.position, (net.knot_count, 3))}
    if start.tension is not None:
        wanted["tension"] = (start.tension, (net.bar_count,))
    for name, (values, shape) in wanted.items():
        if np.shape(values) != shape:
            raise ValueError(f"the start's {name} has the shape {np.shape(values)}, the net's is {shape}")
        wrong = np.flatnonzero(~np.isfinite(values).reshape(shape[0], -1).all(axis=1))
        if wrong.size:
            where = net.labels[wrong[0]] if name == "position" else net.bar_label(int(wrong[0]))
            raise ValueError(f"the start's {name} at {where} is not a number")
    return replace(start, position=np.where(net.fixed[:, None], net.positions, start.position))


def _nested(system: System, begin: State, tolerance: float, on_progress: Progress | None) -> Nested | None:
    """Warm start of a large panel from grouped meshes, where there is one and none was given."""

    def report(_: float, text: str) -> None:
        if on_progress is not None:
            on_progress(0.0, text)

    def solve(coarse: System, at: State, loosely: float) -> Result:
        return solve_static(coarse, tolerance=loosely, start=at, on_progress=report)

    return nested_start(system, begin, tolerance, solve) if begin.tension is None else None


def loose_parts(system: System) -> list[NDArray[np.int64]]:
    """Parts of the net that no chain of bars joins to a held knot, each the indices of its knots, largest first."""
    el, n = system.elements, system.net.knot_count
    graph = csr_matrix((np.ones(len(el.knot_a)), (el.knot_a, el.knot_b)), shape=(n, n))
    count, part = connected_components(graph, directed=False)
    size = np.bincount(part, minlength=count)
    size[part[el.free == 0.0]] = 0
    loose = np.flatnonzero(size)
    return [np.flatnonzero(part == which) for which in loose[np.argsort(-size[loose], kind="stable")]]


def _floating(system: System, parts: list[NDArray[np.int64]]) -> Verdict:
    labels = system.net.labels
    named = [
        f"knots {labels[part[0]]} .. {labels[part[-1]]} ({len(part)})"
        if len(part) > 1
        else f"knot {labels[part[0]]}"
        for part in parts[:NAMED_PARTS]
    ]
    if len(parts) > NAMED_PARTS:
        more = len(parts) - NAMED_PARTS
        named.append(f"{more} more part{'s' if more > 1 else ''}")
    which = named[0] if len(named) == 1 else f"{', '.join(named[:-1])} and {named[-1]}"
    one = len(parts) == 1 and len(parts[0]) == 1
    return (
        "singular",
        f"{which} {'is' if one else 'are'} held by nothing, so no equilibrium exists",
        "hold a knot of that part, for example fixed = 'top', or run it as a dynamic case",
    )


def _iterate(
    s: Equilibrium, tolerance: float, limit: int, tension: Array | None, on_progress: Progress | None
) -> Verdict:
    """Interior point, and where that does not arrive relaxation in time, until the residual is below tolerance."""
    begin, first = s.x.copy(), max(s.residual, tolerance)

    def there() -> bool:
        # The rounding is that of the shape found, which may be much larger than the start.
        return s.residual <= max(tolerance, s.floor)

    def report() -> None:
        if on_progress is not None:
            done = np.log(first / max(s.residual, tolerance)) / max(np.log(first / tolerance), 1.0)
            on_progress(
                float(np.clip(done, 0.0, 1.0)), f"iteration {s.iterations}, residual {s.residual:.1e} N"
            )

    patience = PATIENCE + (0 if tension is None else WARM_STEPS)
    fault = _interior_point(s, there, min(limit, s.iterations + patience), tension, report)
    if not there() and s.iterations < limit and not s.follows:
        s.begin_at(begin)
        end = relax(s, there, limit, report)
        if end == "not_finite":
            return _not_finite(s)
        if end == "short" and fault is None:
            return _stalled(s)
    if there():
        return (
            "converged",
            f"largest unbalanced force {s.residual:.1e} N after {s.iterations} iterations",
            "",
        )
    return _out_of_iterations(s) if fault is None else _no_inverse(s, fault)


def _interior_point(
    s: Equilibrium, there: Callable[[], bool], limit: int, tension: Array | None, report: Callable[[], None]
) -> SingularMatrixError | None:
    """Far field, then near field; a warm start has a field of its own. Returns the fault that ended it, if any."""
    begin, gap, short = s.x.copy(), NEAR, 0
    warm_end = s.iterations + WARM_STEPS
    warm = tension is not None
    gain, s.approach = Gain(), None
    floats = s.follows and bool(s.el.two_way.any())
    field: Far | Near | Warm = Far(s) if tension is None else Warm(s, tension)
    while not there() and s.iterations < limit:
        if isinstance(field, Far) and field.near(gap):
            field = Near.after(field)
        try:
            step = field.step()
        except SingularMatrixError as error:
            return error
        report()
        if not np.isfinite(s.residual):
            return None
        # Nets without tubes get through such spells by themselves, most often in fewer steps.
        if floats and isinstance(field, Near) and gain.none(s.residual, step):
            s.approach, field = Approach(), Warm(s, borne(s.b.f, s.el))
        short = short + 1 if step < SHORT else 0
        if short >= SHORT_STEPS and (isinstance(field, Far) or gap <= LEAST_NEAR):
            return None
        if short >= SHORT_STEPS or (warm and s.iterations >= warm_end):
            # The near field jams when it begins too far off: once more from the start, with a longer far field.
            gap = gap if warm else gap * NEARER
            warm, short = False, 0
            s.begin_at(begin)
            field = Far(s)
    return None


def _interrupted(s: Equilibrium) -> Verdict:
    return (
        "interrupted",
        f"stopped by hand after {s.iterations} iterations",
        "the last shape is saved; run it again",
    )


def _left(s: Equilibrium) -> str:
    return f"{s.residual:.3g} N are left at knot {s.system.net.labels[s.worst]}"


def _out_of_iterations(s: Equilibrium) -> Verdict:
    jumps = (
        ""
        if s.system.current.uniform
        else (
            "; where the current jumps, as from layer to layer, a knot may find no rest: take a table of depths"
        )
    )
    return (
        "iteration_limit",
        f"{s.iterations} iterations were not enough: {_left(s)}",
        "raise max_iterations; a net held by few knots may turn or flap for ever in this current: a dynamic case shows "
        f"it, more held knots or another start may end it{jumps}",
    )


def _no_inverse(s: Equilibrium, error: SingularMatrixError) -> Verdict:
    where, unknown = "", error.unknown
    if unknown is not None:
        knot = s.system.net.labels[s.pattern.free[unknown // 3]]
        where = f", where nothing holds knot {knot} in direction {'xyz'[unknown % 3]}"
    return (
        "singular",
        f"the tangent has no inverse in iteration {s.iterations + 1}{where} ({error}): {_left(s)}",
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
        f"neither interior point nor relaxation in time find a step after {s.iterations} iterations: {_left(s)}",
        "look for bars much stiffer or shorter than the others, begin from another shape, or run a dynamic case",
    )
