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
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from ..forces.bars import add_tension, assemble, bar_geometry, elastic, largest_on_free, load_at_rest
from ..forces.evaluate import evaluate
from ..system.system import State, System
from . import central_path as path
from . import cone
from .linear import Factorizer, Pattern, SingularMatrixError, factorizer
from .outcome import Outcome, OutcomeName
from .result import Result
from .strain import strain_warnings

Array = NDArray[np.float64]
Solve = Callable[[Array], Array]
Progress = Callable[[float, str], None]

# Fraction of the way to the edge of the cone that one step may take.
TO_EDGE = 0.98
TO_EDGE_NEAR = 0.95
# Strain that every bar is at least allowed at the start.
START_STRAIN = 0.05
# Gap of a bar to its cone's edge, over the bar's length, at which the near field takes over.
NEAR = 1e-3
# When that was too early the far field goes on to a gap NEARER times as large, down to LEAST_NEAR.
NEARER, LEAST_NEAR = 1e-3, 1e-8
# Largest rotation of a bar in one step of the near field (rad).
LARGEST_ROTATION = 0.5
# Bounds of Mehrotra's centring, (mu_affine / mu)^3; the second one holds where rotations cut the step short.
LEAST_CENTRING, LEAST_CENTRING_CUT = 1e-6, 0.1
CUT = 0.3
# Steps shorter than SHORT, so many in a row, are a stall.
SHORT, SHORT_STEPS = 1e-2, 5
# Rounding of a residual: so many units in the last place of stiffness times coordinate.
ROUNDING = 8.0


@dataclass
class _Bars:
    """Work arrays of the solve, n knots and m bars."""

    t: Array
    length: Array
    f: Array
    k: Array
    block: Array
    load: Array
    total: Array
    right: Array
    data: Array
    dx: Array

    @classmethod
    def of(cls, n: int, m: int, pattern: Pattern) -> _Bars:
        z = np.zeros
        size = len(pattern.indptr) - 1
        return cls(
            z((m, 3)),
            z(m),
            z(m),
            z(m),
            z((m, 3, 3)),
            z((n, 3)),
            z((n, 3)),
            z(size),
            z(len(pattern.indices)),
            z((n, 3)),
        )


class _Statics:
    """One static solve: positions, both fields' variables, counters."""

    def __init__(self, system: System, start: State, linear: Factorizer | None) -> None:
        self.system, self.el = system, system.elements
        self.pattern = Pattern.of(self.el)
        self.linear = linear or factorizer(self.pattern)
        # About the net's middle, coordinates are smallest and so is their rounding.
        self.origin = start.position.mean(axis=0)
        self.x = start.position - self.origin
        self.u = system.current.velocity(start.position, start.time)
        self.b = _Bars.of(len(self.x), len(self.el.knot_a), self.pattern)
        self.iterations = self.factorizations = 0
        self.residual, self.worst = self.true_residual()
        self.good = self.x.copy()

    @property
    def floor(self) -> float:
        """Residual (N) that rounding of the coordinates makes."""
        size = float(np.abs(self.x).max(initial=0.0))
        return ROUNDING * float(np.finfo(float).eps) * float(self.el.stiffness.max(initial=0.0)) * size

    def true_residual(self) -> tuple[float, int]:
        """Largest unbalanced force (N) on a free knot, and that knot."""
        b, el = self.b, self.el
        bar_geometry(self.x, el, b.t, b.length)
        elastic(b.length - el.rest_length, el, b.f, b.k)
        load_at_rest(self.u, el, b.t, b.length, b.load)
        b.total[:] = b.load
        add_tension(np.maximum(b.f, 0.0), el, b.t, b.total)
        worst, where = largest_on_free(b.total, el.free)
        return float(worst), int(where)

    def factor(self) -> Solve:
        """Factorize the tangent for the present stiffness blocks."""
        b = self.b
        assemble(b.block, self.u, self.el, b.t, self.pattern.start, self.pattern.stride, b.data)
        self.factorizations += 1
        return self.linear.factor(b.data)

    def move(self, solve: Solve) -> None:
        """Motion of the free knots for the present right side."""
        self.b.dx[self.pattern.free] = solve(self.b.right).reshape(-1, 3)

    def begin_at(self, x: Array) -> None:
        """Go to positions x (n, 3) m about the origin."""
        self.x[:] = x
        self.residual, self.worst = self.true_residual()

    def accept(self, step: float) -> None:
        """Take a step and judge it."""
        self.x += step * self.b.dx
        self.iterations += 1
        self.residual, self.worst = self.true_residual()
        if np.isfinite(self.residual):
            self.good[:] = self.x


class _Far:
    """Steps on cones."""

    def __init__(self, s: _Statics) -> None:
        self.s, el = s, s.el
        m = len(el.knot_a)
        z = np.zeros
        self.f, self.k = z(m), z(m)
        self.scaling, self.scaled, self.row = z((m, 5)), z((m, 4)), z((m, 4))
        self.target, self.cross, self.push = z((m, 4)), z((m, 4)), z((m, 3))
        self.Y, self.Z, self.dY, self.dZ = z((m, 4)), z((m, 4)), z((m, 4)), z((m, 4))
        held = np.count_nonzero((el.free[el.knot_a] == 0.0) | (el.free[el.knot_b] == 0.0))
        tension = np.linalg.norm(s.b.load, axis=1).sum() / max(held, 1)
        tension = max(tension, float(s.b.f.max(initial=0.0)), s.floor)
        allowance = np.maximum(tension / el.stiffness, START_STRAIN * el.rest_length)
        self.Y[:, 0] = el.rest_length + np.maximum(s.b.length - el.rest_length, 0.0) + allowance
        self.Y[:, 1:] = s.x[el.knot_b] - s.x[el.knot_a]
        self.Z[:, 0] = tension
        # Halfway between no dual force and the one of the central path.
        self.Z[:, 1:] = -0.5 * tension * self.Y[:, 1:] / self.Y[:, :1]

    def near(self, gap: float) -> bool:
        """Whether a bar is so near to its cone's edge, over its length, that the near field may take over."""
        return bool(cone.smallest_gap(self.Y, self.s.el.rest_length) < gap)

    def step(self) -> float:
        """Predictor and corrector; return the length of the step taken."""
        s, b = self.s, self.s.b
        elastic(self.Y[:, 0] - s.el.rest_length, s.el, self.f, self.k)
        mu = cone.cone_product(self.Y, self.Z, self.dY, self.dZ, 0.0)
        cone.scaling_point(self.Y, self.Z, self.scaling, self.scaled)
        cone.cone_stiffness(self.scaling, self.k, b.block, self.row)
        solve = s.factor()
        self.cross[:] = 0.0
        self._direction(solve, 0.0)
        affine = min(1.0, cone.cone_step(self.Y, self.dY), cone.cone_step(self.Z, self.dZ))
        ratio = cone.cone_product(self.Y, self.Z, self.dY, self.dZ, affine) / mu
        cone.cone_cross(self.scaling, self.dY, self.dZ, affine * affine, self.cross)
        self._direction(solve, min(1.0, max(ratio**3, LEAST_CENTRING)) * mu)
        step: float = min(
            1.0, TO_EDGE * cone.cone_step(self.Y, self.dY), TO_EDGE * cone.cone_step(self.Z, self.dZ)
        )
        self.Y += step * self.dY
        self.Z += step * self.dZ
        s.accept(step)
        return step

    def _direction(self, solve: Solve, centre: float) -> None:
        s, b = self.s, self.s.b
        cone.cone_target(self.scaling, self.scaled, centre, self.cross, self.target)
        cone.cone_right_side(
            b.load, self.Z, self.f, self.target, self.row, s.el, s.pattern.free, self.push, b.total, b.right
        )
        s.move(solve)
        cone.cone_changes(
            b.dx, self.Z, self.f, self.k, self.target, self.row, self.push, b.block, s.el, self.dY, self.dZ
        )


class _Near:
    """Steps on tension and slack."""

    def __init__(self, s: _Statics, far: _Far) -> None:
        self.s = s
        m = len(s.el.knot_a)
        z = np.zeros
        gap = far.Y[:, 0] - np.linalg.norm(far.Y[:, 1:], axis=1)
        tiny = np.finfo(float).tiny
        self.T = np.maximum(far.Z[:, 0], tiny)
        self.w = np.maximum(self.T - s.b.f, np.maximum(s.el.stiffness * gap, tiny))
        self.target, self.cross, self.r, self.bent = z(m), z(m), z(m), z(m)
        self.de, self.dT, self.dw = z(m), z(m), z(m)

    def step(self) -> float:
        """Predictor and corrector; return the length of the step taken."""
        s, b = self.s, self.s.b
        np.subtract(self.w, self.T, out=self.r)
        self.r += b.f
        mu = path.path_product(self.T, self.w, self.dT, self.dw, 0.0)
        path.path_stiffness(self.T, self.w, b.k, b.t, b.length, b.block)
        solve = s.factor()
        self.cross[:] = 0.0
        turn = self._direction(solve, 0.0, self.r)
        affine = min(1.0, path.path_step(self.T, self.w, self.dT, self.dw))
        turning = min(1.0, LARGEST_ROTATION / max(turn, LARGEST_ROTATION))
        ratio = path.path_product(self.T, self.w, self.dT, self.dw, affine) / mu
        least = LEAST_CENTRING_CUT if turning < CUT else LEAST_CENTRING
        path.second_order(s.x, b.dx, self.de, min(affine, turning), s.el, b.length, b.k, self.r, self.bent)
        np.multiply(self.dT, self.dw, out=self.cross)
        self.cross *= affine * turning
        turn = self._direction(solve, min(1.0, max(ratio**3, least)) * mu, self.bent)
        turning = LARGEST_ROTATION / max(turn, LARGEST_ROTATION)
        edge = max(TO_EDGE_NEAR, 1.0 - ratio)
        step: float = min(turning, edge * path.path_step(self.T, self.w, self.dT, self.dw))
        self.T += step * self.dT
        self.w += step * self.dw
        s.accept(step)
        return step

    def _direction(self, solve: Solve, mu: float, r: Array) -> float:
        s, b = self.s, self.s.b
        path.path_target(mu, self.T, self.w, r, self.cross, self.target)
        path.path_right_side(b.load, self.T, self.target, s.el, b.t, s.pattern.free, b.total, b.right)
        s.move(solve)
        turn = path.path_changes(
            b.dx, self.T, self.w, b.k, r, self.target, s.el, b.t, self.de, self.dT, self.dw
        )
        return float(turn)


def solve_static(
    system: System,
    *,
    tolerance: float = 1e-8,
    max_iterations: int = 100,
    start: State | None = None,
    linear: Factorizer | None = None,
    case_text: str = "",
    on_progress: Progress | None = None,
) -> Result:
    """Find the static equilibrium of a net.

    tolerance: N, largest unbalanced force on a free knot; where the rounding of the coordinates alone makes more than
    that, its size is the tolerance and the outcome says so. start: where to begin, the net as built by default.
    How it ended is the result's outcome; a solve that fails or is stopped by Ctrl-C returns the last good state.
    """
    began = time.perf_counter()
    s = _Statics(system, start or system.at_rest(), linear)
    loose = loose_knots(system)
    if loose.size:
        name, message, advice = _floating(system, loose)
    else:
        try:
            name, message, advice = _iterate(s, max(tolerance, s.floor), max_iterations, on_progress)
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
    return Result.from_frames(system.net, outcome, system.weight_in_water, [frame], case_text)


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


def _iterate(s: _Statics, tolerance: float, limit: int, on_progress: Progress | None) -> Verdict:
    """Far field, then near field, until the true residual is below tolerance."""
    far, near, gap = _Far(s), None, NEAR
    begin = s.x.copy()
    first, short = max(s.residual, tolerance), 0
    while not s.residual <= tolerance:
        if s.iterations >= limit:
            return _out_of_iterations(s)
        if near is None and far.near(gap):
            near = _Near(s, far)
        try:
            step = (near or far).step()
        except SingularMatrixError as error:
            return _no_inverse(s, error)
        if not np.isfinite(s.residual):
            return _not_finite(s)
        short = short + 1 if step < SHORT else 0
        if short >= SHORT_STEPS and (near is None or gap <= LEAST_NEAR):
            return _stalled(s)
        if short >= SHORT_STEPS:
            # The near field jams when it begins too far off: once more from the start, with a longer far field.
            gap, short = gap * NEARER, 0
            s.begin_at(begin)
            far, near = _Far(s), None
        if on_progress is not None:
            done = np.log(first / max(s.residual, tolerance)) / max(np.log(first / tolerance), 1.0)
            on_progress(
                float(np.clip(done, 0.0, 1.0)), f"iteration {s.iterations}, residual {s.residual:.1e} N"
            )
    return "converged", f"largest unbalanced force {s.residual:.1e} N after {s.iterations} iterations", ""


def _left(s: _Statics) -> str:
    return f"{s.residual:.3g} N are left at knot {s.system.net.labels[s.worst]}"


def _out_of_iterations(s: _Statics) -> Verdict:
    return (
        "iteration_limit",
        f"{s.iterations} iterations were not enough: {_left(s)}",
        "raise max_iterations, or let a dynamic case with twine damping find the shape",
    )


def _no_inverse(s: _Statics, error: SingularMatrixError) -> Verdict:
    return (
        "singular",
        f"the tangent has no inverse in iteration {s.iterations + 1} ({error}): {_left(s)}",
        "look for knots that nothing holds in some direction, or begin from another shape",
    )


def _not_finite(s: _Statics) -> Verdict:
    return (
        "not_finite",
        f"the force on knot {s.system.net.labels[s.worst]} is not a number in iteration {s.iterations}",
        "look for bars of zero length or an elastic law that has no value there",
    )


def _stalled(s: _Statics) -> Verdict:
    return (
        "stalled",
        f"steps became too short after {s.iterations} iterations: {_left(s)}",
        "the net may have no stable shape near this start: begin from another one, or run a dynamic case",
    )
