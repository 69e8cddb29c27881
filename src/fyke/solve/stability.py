"""Equilibria that a net with tubes does not stay in, as a strut beyond its buckling load, and the way out of them.

Newton's method goes to such an equilibrium as to any other. Whether one is stable under loads that keep their direction
is seen from the stiffness without the water: it has no negative eigenvalue. Otherwise the net is pushed a little along
the eigenvector of the lowest, and relaxes in time from there (solve.relaxation), which goes downhill.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from ..system.system import System
from .engines import falling
from .equilibrium import Equilibrium
from .linear import SingularMatrixError
from .modes import inverse, lowest, stiffness_of
from .relaxation import relax

Array = NDArray[np.float64]

# Stiffness, over the largest, that counts as none: of what may turn freely, as a ring about its own middle.
NEUTRAL = 1e-12
# What a shift of the eigenvalues grows by until it is beyond the lowest.
FURTHER = 10.0
# Largest rotation of a bar in a push, one after the other (rad): a small one may fall back.
PUSHES = (0.1, -0.3, 0.9)
# Iterations that each may take, and the part of a push up to which a net has come back from it.
MOST, BACK = 100, 0.1

UNSTABLE = (
    "this equilibrium is not stable: a tube buckles, or something turns over, when it is touched; begin from another "
    "shape, bent or turned, or let it move in a dynamic case",
)


def unstable_direction(system: System, position: Array) -> Array | None:
    """Direction (n, 3) in which a net at position (n, 3) m falls, None where it is stable or has no tube.

    None, too, where no solver at hand counts the negative eigenvalues of a matrix; zero where it was not found.
    """
    if not system.elements.two_way.any():
        return None
    if system.bed is not None:
        # Friction makes nothing fall, but its share in the stiffness goes with the load on the ground, which is no
        # potential's: its symmetric part alone would have negative eigenvalues.
        system = replace(system, bed=replace(system.bed, friction=0.0))
    _, pattern, data, _ = stiffness_of(system, position)
    begin, stride = pattern.diagonal[pattern.free].T
    own = begin + np.arange(3)[:, None] * (stride + 1)
    shift = NEUTRAL * float(data[own].max(initial=0.0))
    data[own] += shift
    if not falling(pattern, data):
        return None
    stiffness = pattern.matrix(data.copy())
    while falling(pattern, data):
        # Until the lowest eigenvalue is the one next to the shift.
        data[own] += (FURTHER - 1.0) * shift
        shift *= FURTHER
    ones, out = sp.identity(pattern.size, format="bsr").tobsr((3, 3)), np.zeros_like(position)
    try:
        # Short products gain nothing from threads.
        with threadpool_limits(1, user_api="blas"):
            _, vectors = lowest(inverse(stiffness, ones, shift, pattern), ones, shift, 1)
    except (SingularMatrixError, sp.linalg.ArpackError):
        return out
    out[pattern.free] = vectors[0].reshape(-1, 3)
    return out


def settle(s: Equilibrium, tolerance: float, limit: int) -> tuple[int, tuple[str, ...]]:
    """Leave an equilibrium, found to a tolerance (N), for one that is stable.

    A net that comes back from every push is held by what the water does when it turns, which its stiffness does not
    know. Returns how many iterations it took to leave, 0 where it stayed, and then what to warn of.
    """
    direction = unstable_direction(s.system, s.x + s.origin)
    begin, iterations, left, stays = s.x.copy(), s.iterations, 0, True
    for push in PUSHES:
        if direction is None:
            break
        turn = _turn(s, direction)
        if s.follows or not turn > 0.0:
            stays = False
            break
        by = push / turn * direction
        s.begin_at(begin + by)
        end = relax(
            s, lambda: s.residual <= max(tolerance, s.floor), min(limit, s.iterations + MOST), _silent
        )
        if end != "there":
            stays = False
        elif np.abs(s.x - begin).max() > BACK * np.abs(by).max():
            begin, left, stays = s.x.copy(), s.iterations - iterations, push != PUSHES[-1]
            direction = unstable_direction(s.system, s.x + s.origin)
    s.begin_at(begin)
    s.good[:], s.iterations = begin, iterations + left
    return left, () if direction is None or stays else UNSTABLE


def _silent() -> None:
    """Report nothing: progress has come to its end."""


def _turn(s: Equilibrium, direction: Array) -> float:
    """Largest rotation of a bar in a motion (n, 3) of one metre at most (rad)."""
    a, b = s.el.knot_a, s.el.knot_b
    apart = direction[b] - direction[a]
    across = apart - np.einsum("eq,eq->e", apart, s.b.t)[:, None] * s.b.t
    return float((np.linalg.norm(across, axis=1) / s.el.rest_length).max(initial=0.0))
