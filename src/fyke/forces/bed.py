"""The force of the sea bed on knots that lie on it: it bears, damps and rubs.

A knot of area A and diameter d that is p below the ground is borne by

    N = k A r(p) + c A r'(p) dp/dt, never below 0,    r = p^2 / (2 h) up to p = h = SOFT d, then p - h / 2.

In statics friction holds a knot that has slipped by s (2 coordinates) from where it was laid, in motion it goes
against the velocity v over the ground:

    -mu N s / sqrt(|s|^2 + h^2)    or    -mu N v / sqrt(|v|^2 + CREEP^2).

So friction in statics goes against the way from the laid to the found place: where the real way was another one, by
pulling to and fro, the friction was, too.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..netting.net import Net
from ..system.system import System
from ..water.bed import CREEP, SOFT, Bed
from .compiled import OPTIONS

Array = NDArray[np.float64]
Places = NDArray[np.int64]


@njit(**OPTIONS)
def bed_forces(x, v, knots, sizes, ground, laid, out):
    """Force (k, 3) N of the ground on some knots and its tangents dF/dx, dF/dv (k, 3, 3) N/m, N s/m, into out.

    x, v: (n, 3) m, m/s; knots: (k,); sizes: (k, 4), of each the stiffness k A (N/m), the damping c A (N s/m), h (m) and
    the z at which it touches (m); ground: friction and CREEP (m/s); laid: (k, 2) m, without rows where friction goes by
    the velocity.
    """
    force, by_x, by_v = out
    resting, (mu, creep) = laid.shape[0] > 0, ground
    for i in range(knots.shape[0]):
        at = knots[i]
        stiff, damp, h, level = sizes[i]
        force[i], by_x[i], by_v[i] = 0.0, 0.0, 0.0
        p = level - x[at, 2]
        if p <= 0.0:
            continue
        whole = p > h
        r, slope, bend = (p - 0.5 * h, 1.0, 0.0) if whole else (0.5 * p * p / h, p / h, 1.0 / h)
        n = stiff * r - damp * slope * v[at, 2]
        if n <= 0.0:
            continue
        n_x, n_v = -stiff * slope + damp * bend * v[at, 2], -damp * slope
        force[i, 2], by_x[i, 2, 2], by_v[i, 2, 2] = n, n_x, n_v
        a = x[at, 0] - laid[i, 0] if resting else v[at, 0]
        b = x[at, 1] - laid[i, 1] if resting else v[at, 1]
        small = h if resting else creep
        size = np.sqrt(a * a + b * b + small * small)
        way = (a / size, b / size)
        along = by_x if resting else by_v
        for q in range(2):
            force[i, q] = -mu * n * way[q]
            by_x[i, q, 2] = -mu * n_x * way[q]
            by_v[i, q, 2] = -mu * n_v * way[q]
            for s in range(2):
                along[i, q, s] = -mu * n * ((1.0 if q == s else 0.0) - way[q] * way[s]) / size


@njit(**OPTIONS)
def add_blocks(c0, c1, by_x, by_v, symmetric, start, stride, data):
    """Add c0 (-dF/dx) + c1 (-dF/dv) of some knots to the data of a sparse matrix; start (k, 1, 1), stride (k, 1).

    symmetric: without the change of friction with the weight on the ground, which goes one way only: half of it both
    ways would make ground that is stiff and slippery an unstable one.
    """
    for i in range(by_x.shape[0]):
        place = start[i, 0, 0]
        if place < 0:
            continue
        for q in range(3):
            for p in range(3):
                if symmetric and (p == 2) != (q == 2):
                    continue
                value = c0 * by_x[i, p, q] + c1 * by_v[i, p, q]
                data[place + q * stride[i, 0] + p] -= value


class OnBed:
    """The ground under the knots of a net; normal: (k,) N, how it bears them as last seen; knots: (k,), which."""

    def __init__(self, system: System, bed: Bed) -> None:
        area, diameter, radius = footprint(system.net)
        self.knots = np.flatnonzero(area > 0.0)
        there = area[self.knots]
        self._sizes = np.column_stack(
            [
                bed.stiffness * there,
                bed.damping * there,
                SOFT * diameter[self.knots],
                radius[self.knots] - bed.depth,
            ]
        )
        self._ground = bed.friction, CREEP
        self._laid = np.zeros((0, 2)) if bed.laid is None else bed.laid[self.knots]
        k = len(self.knots)
        self.force, self.by_x, self.by_v = np.zeros((k, 3)), np.zeros((k, 3, 3)), np.zeros((k, 3, 3))

    @property
    def groups(self) -> Places:
        """Every knot by itself, (k, 1)."""
        return self.knots[:, None]

    def see(self, x: Array, v: Array, time: float) -> None:
        """Take up positions and velocities (n, 3)."""
        out = self.force, self.by_x, self.by_v
        bed_forces(x, v, self.knots, self._sizes, self._ground, self._laid, out)

    def add_load(self, out: Array) -> None:
        """Add the force on the knots to out (n, 3) N."""
        out[self.knots] += self.force

    def assemble(
        self, c0: float, c1: float, places: tuple[Places, Places], *, symmetric: bool, data: Array
    ) -> None:
        """Add the tangent to the data of a sparse matrix, as forces.part says."""
        add_blocks(c0, c1, self.by_x, self.by_v, symmetric, *places, data)


def footprint(net: Net) -> tuple[Array, Array, Array]:
    """Return how each knot of a net stands on ground: area (m2), diameter (m) and radius of its body (m), (n,) each.

    Half of every bar is at each of its ends. Bodies touch the ground by their radius; bars by their middle, so that an
    anchor is at the depth itself.
    """
    n, ends = net.knot_count, net.bars
    area, diameter, radius = np.zeros(n), net.knot_diameter.copy(), np.zeros(n)
    np.add.at(area, ends, (0.5 * net.bar_diameter * net.bar_multiple * net.rest_length)[:, None])
    area += np.pi / 4.0 * net.knot_multiple * net.knot_diameter**2
    np.maximum.at(diameter, ends, net.bar_diameter[:, None])
    for one in net.bodies:
        np.add.at(area, one.knots, np.pi / 4.0 * one.diameter**2)
        np.maximum.at(diameter, one.knots, one.diameter)
        np.maximum.at(radius, one.knots, 0.5 * one.diameter)
    return area, diameter, radius
