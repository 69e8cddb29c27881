"""Pictures of nets whose held knots moved: still ones go along with them, in moving ones frames are left out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..solve.result import Result
from .parts import Outline, Part, parts_of

Array = NDArray[np.float64]

# Way (m) of a held knot below which it stands still: rounding.
STILL = 1e-9


def way(result: Result) -> Array:
    """Return how far the held knots were from where they were built in every frame, the mean, (k, 3) m."""
    fixed = result.net.fixed
    if not fixed.any():
        return np.zeros((len(result.time), 3))
    return np.asarray((result.position[:, fixed] - result.net.positions[fixed]).mean(axis=1))


def carried(result: Result, index: int = -1) -> Result:
    """Return the result with the net as built where its held knots have taken it in one frame, the last by default."""
    net, shape = result.net, result.position[index]
    if np.array_equal(shape[net.fixed], net.positions[net.fixed]):
        return result
    positions = net.positions + way(result)[index]
    positions[net.fixed] = shape[net.fixed]
    return replace(result, net=replace(net, positions=positions))


def brought_back(result: Result) -> Result:
    """Return the result with all positions less the way of the held knots, beside the net as built."""
    return replace(result, position=result.position - way(result)[:, None])


def parts_in_time(result: Result) -> tuple[Part, ...]:
    """Return all parts of a net that have something to draw in every frame: outlines that do not move, and the rest."""
    fixed = result.net.fixed
    moved = np.abs(result.position[:, fixed] - result.net.positions[fixed]).max(initial=0.0) > STILL
    return tuple(part for part in parts_of(result.net) if not (moved and isinstance(part, Outline)))
