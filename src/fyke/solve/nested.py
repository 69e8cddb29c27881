"""Nested iteration: a large net begins at the shape and tensions that the same net takes with grouped meshes.

Twice as large meshes make a quarter of the unknowns, and a shape that lies within a fraction of a percent of the real
one (system.grouped). Carried over to the real meshes it is a warm start. The grouped panel is solved in the same way,
so that levels follow one another down to a panel that is small. Cages, and other nets of several sheets with what hangs
on them, go the same way with half as many meshes each way (netting.halving).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..forces.part import parts_of
from ..forces.surroundings import Surroundings
from ..netting.grouping import Grid, carry, grid_of
from ..netting.halving import halved
from ..system.grouped import grouped
from ..system.halved import halved_system
from ..system.system import State, System
from .result import Result

Array = NDArray[np.float64]

# Panels of so many knots or more are begun on grouped meshes: below, whole solves take as long one way as the other.
LARGE = 15_000
# The same of nets of several sheets and of round ones: cages of 5 000 knots with heavy sinkers far apart took three
# times the iterations that they take from the net as built.
LARGE_ROUND = 15_000
# Of their warm starts: many of their bars are slack, and what is slack on large meshes mostly is on small ones.
SMALL_SMOOTHING = (0.03, 0.25)
# Meshes along the shorter side that a grouped panel has at least.
FEWEST_MESHES = 8
# Unbalanced force that a grouped panel may keep, over the mean weight and load of the water on its knots.
COARSE_TOLERANCE = 1e-3

Solve = Callable[[System, State, float], Result]


@dataclass(frozen=True)
class Nested:
    """Where to begin, tensions included; levels: what was solved for it; interrupted: by hand, on a level.

    smoothing: that of the warm start, see solve.warm_field.
    """

    start: State
    levels: str
    interrupted: bool = False
    smoothing: tuple[float, float] | None = None


def nested_start(system: System, begin: State, tolerance: float, solve: Solve) -> Nested | None:
    """Return a warm start from the same panel with half as many meshes each way, larger ones.

    begin: where the solve would begin without it; tolerance: N, of the solve; solve: called with a coarser system,
    its start and tolerance. None where the net is small or no single panel of netting, or the coarser one finds no
    equilibrium.
    """
    knots = system.net.knot_count
    if knots < min(LARGE, LARGE_ROUND):
        return None
    fine = grid_of(system.net)
    if fine is None:
        return _halved_start(system, begin, tolerance, solve) if knots >= LARGE_ROUND else None
    if knots < LARGE or min(fine.meshes) < 2 * FEWEST_MESHES:
        return None
    coarse = Grid.of(fine.mesh, ((fine.meshes[0] + 1) // 2, (fine.meshes[1] + 1) // 2))
    small = grouped(system, fine, coarse)
    at = carry(begin.position, fine.knots, coarse.knots, 1)
    load = np.linalg.norm(_loads(small, at), axis=1).mean()
    result = solve(small, State(0.0, at, np.zeros_like(at)), max(tolerance, COARSE_TOLERANCE * float(load)))
    if result.outcome.name == "interrupted":
        return Nested(begin, "", interrupted=True)
    if not result.outcome.ok:
        return None
    levels = f"{coarse.meshes[0]} x {coarse.meshes[1]} larger meshes ({result.outcome.iterations} iterations)"
    return Nested(_carried(system, begin, fine, coarse, result), levels)


def _halved_start(system: System, begin: State, tolerance: float, solve: Solve) -> Nested | None:
    """Warm start of a net of several sheets or a round one, None where it cannot be halved."""
    if parts_of(system) or system.motion is not None or np.any(system.elements.two_way):
        return None
    small = halved(system.net)
    if small is None:
        return None
    coarse, at = halved_system(system, small), np.ascontiguousarray(begin.position[small.knots])
    load = np.linalg.norm(_loads(coarse, at), axis=1).mean()
    result = solve(coarse, State(0.0, at, np.zeros_like(at)), max(tolerance, COARSE_TOLERANCE * float(load)))
    if result.outcome.name == "interrupted":
        return Nested(begin, "", interrupted=True)
    if not result.outcome.ok:
        return None
    position, tension = small.carried(system.net, result.position[-1], result.tension[-1])
    position[system.net.fixed] = begin.position[system.net.fixed]
    levels = f"{small.words} larger meshes ({result.outcome.iterations} iterations)"
    start = replace(begin, position=position, velocity=np.zeros_like(position), tension=tension)
    return Nested(start, levels, smoothing=SMALL_SMOOTHING)


def _loads(system: System, position: Array) -> Array:
    """Weight and an estimate of the water's force on every knot, (n, 3) N: bars square to the current."""
    el = system.elements
    u = Surroundings(system).velocity(position, 0.0)
    area = el.knot_drag.copy()
    np.add.at(area, el.knot_a, el.normal_drag * el.rest_length)
    np.add.at(area, el.knot_b, el.normal_drag * el.rest_length)
    return np.asarray(el.weight + (area * np.linalg.norm(u, axis=1))[:, None] * u)


def _carried(system: System, begin: State, fine: Grid, coarse: Grid, result: Result) -> State:
    """Shape and tensions of a grouped panel on the fine meshes; held knots stay where they are."""
    last = result.frame()
    position = carry(last.position, coarse.knots, fine.knots, 3)
    position[system.net.fixed] = begin.position[system.net.fixed]
    # Tensions of a result are those of real bars.
    tension = np.empty(system.net.bar_count)
    for which in (0, 1):
        have, want = coarse.directions[which], fine.directions[which]
        tension[fine.bars[which]] = carry(last.tension[coarse.bars[which]], have, want, 1)
    tension *= system.net.bar_multiple
    return replace(
        begin, position=position, velocity=np.zeros_like(position), tension=np.maximum(tension, 0.0)
    )
