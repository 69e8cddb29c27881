"""Shelter: the factor by which netting slows the current at every knot, by its wakes and between its own twines.

It multiplies the undisturbed current, not the motion of waves, and belongs to the present shape: a static solver keeps
it while it iterates and renews it until it stays, a dynamic one renews it every step.

    r = (product of r_wake over the sheets of netting upstream) x r_twines

r_wake is that of the face crossed, by its angle to the current and its solidity as it is stretched, Sn = Sn0 A0 / A.
r_twines is that of the faces around the knot itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..netting.faces import Faces
from ..water.wakes import TwineLaw, WakeLaw
from .compiled import OPTIONS
from .face_grid import grid_of
from .face_sheet import AREA, VECTOR, own_netting, spread
from .upstream import wake_factors

Array = NDArray[np.float64]

# Viscosity of fresh water at 20 degrees, m2/s: only wakes by a panel law that knows the Reynolds number use it.
FRESH_WATER = 1.0e-6


@njit(**OPTIONS)
def _around_knots(way, sheet, corners, share, solid, out):
    """Sums over the faces around every knot into out (3, n): share x area, solid area, area across the current (m2)."""
    for f in range(len(corners)):
        for k in range(4):
            i = corners[f, k]
            across = 0.0
            for q in range(3):
                across += sheet[f, VECTOR + q] * way[i, q]
            out[0, i] += share[f, k] * sheet[f, AREA]
            out[1, i] += share[f, k] * solid[f]
            out[2, i] += share[f, k] * abs(across)


@dataclass(frozen=True)
class Shelter:
    """What shelters the knots of a net: its faces and the laws, None for no such shelter.

    viscosity: m2/s.
    """

    faces: Faces
    wake: WakeLaw | None = None
    twines: TwineLaw | None = None
    viscosity: float = FRESH_WATER

    @property
    def acts(self) -> bool:
        """Whether any factor can differ from 1."""
        return self.faces.count > 0 and (self.wake is not None or self.twines is not None)

    def factors(self, x: Array, current: Array) -> Array:
        """Return r (n,), 0 to 1, for the knots at x (n, 3) m in the undisturbed current (n, 3) m/s at them.

        Each knot has its own direction of the current. Where the current stands still r is 1; where a knot's place or
        current is no number r is none.
        """
        out = np.ones(len(x))
        if not self.acts:
            return out
        if not (np.isfinite(x).all() and np.isfinite(current).all()):
            return np.full(len(x), np.nan)
        speed = np.sqrt(np.einsum("nq,nq->n", current, current))
        way = current / np.where(speed > 0.0, speed, 1.0)[:, None]
        if not speed.any():
            return out
        sheet = spread(np.ascontiguousarray(x), self.faces.corners)
        solid = np.minimum(self.faces.solidity * self.faces.area, sheet[:, AREA])
        if self.wake is not None:
            self._wakes(self.wake, x, way, speed, sheet, solid, out)
        if self.twines is not None:
            out *= self._between_twines(self.twines, way, sheet, solid)
        return out

    def _wakes(
        self, law: WakeLaw, x: Array, way: Array, speed: Array, sheet: Array, solid: Array, out: Array
    ) -> None:
        """Multiply out (n,) by the wakes; solid: (p,) m2, solid area of each face."""
        solidity = np.divide(solid, sheet[:, AREA], out=np.ones_like(solid), where=sheet[:, AREA] > 0.0)
        at_faces = np.einsum("pk,pk->p", self.faces.share, speed[self.faces.corners])
        deficit = law.deficit(solidity, at_faces * self.faces.diameter / self.viscosity)
        mean = _mean_way(way)
        grid = grid_of(sheet, mean, _stray(way, mean))
        own = own_netting(len(x), sheet, self.faces.corners, self.faces.panel)
        wake_factors(np.ascontiguousarray(x), way, sheet, own, grid, deficit, (law.lean, law.rest), out)

    def _between_twines(self, law: TwineLaw, way: Array, sheet: Array, solid: Array) -> Array:
        """Return r (n,) of the twines around each knot, 1 where there is no face or no current."""
        area, filled, across = sums = np.zeros((3, len(way)))
        _around_knots(way, sheet, self.faces.corners, self.faces.share, solid, sums)
        there = (area > 0.0) & way.any(axis=1)
        safe = np.where(there, area, 1.0)
        angle = np.arccos(np.minimum(across / safe, 1.0))
        return np.where(there, law.factor(angle, np.where(there, filled / safe, 0.0)), 1.0)


def _mean_way(way: Array) -> Array:
    """Return a unit vector (3,) along the mean of directions (n, 3), along x when they have none in common."""
    mean = way.sum(axis=0)
    size = float(np.linalg.norm(mean))
    return mean / size if size > 1e-9 * len(way) else np.array([1.0, 0.0, 0.0])


def _stray(way: Array, mean: Array) -> float:
    """Return the sine of the largest angle between directions (n, 3) and their mean (3,), 1 beyond 90 degrees."""
    along = way @ mean
    square = np.einsum("nq,nq->n", way, way) - along**2
    return float(np.sqrt(max(square.max(), 0.0))) if (along >= 0.0).all() else 1.0
