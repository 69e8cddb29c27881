"""Force of the water on the faces of netting under a panel law.

On a face of vector area N (area A = |N|, n = N / A) in water that goes past it with w (speed V = |w|), with
c = n.w / V, of either sign, and s = sqrt(1 - c^2):
    F = 1/2 rho A V (C_D w + C_L / (c s) c (V n - c w)),
drag along w and lift across it, towards the side of the face that the water goes to. C_D and C_L are those of
water.laws.panels at |c|, at the local solidity Sn0 A0 / A and at Re = d V / nu.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numba.extending import register_jitable
from numpy.typing import NDArray

from ..water.laws.panels import blunt
from .apart import keep, take
from .compiled import OPTIONS, WITHIN
from .screen_laws import screen

Array = NDArray[np.float64]

# Of |c|: within 1 deg of flow along a face C_D has no edge, which it would have where the flow changes sides.
GRAZING = 0.02
# Solidity that a law is given: the local one up to the first, beyond it less and less of it, and never more than the
# second, so that the force on netting drawn together to nothing goes to nothing. No law is measured so far.
DENSE, DENSEST = 0.6, 0.8
# Keeps divisions by area times speed finite (m3/s); where either is 0, so is the force.
TINY = 1e-290
# Faces are taken in blocks that fit the first-level cache: gather, vector mathematics, scatter.
BLOCK = 256


class ScreenArrays(NamedTuple):
    """p faces as the kernels see them.

    corners: (p, 4) knots; share: (p, 4) of the force at each corner; solid: (p,) m2, solidity times area as hung;
    twine: (p,) s/m, diameter over kinematic viscosity, which makes Re of a speed; half_density: kg/m3.
    """

    corners: NDArray[np.uint32]
    share: Array
    solid: Array
    twine: Array
    half_density: float


@register_jitable(**WITHIN)
def local_solidity(solid, area, per_area):
    """Solidity for the law and its derivative with ln A; per_area: 1 / A, anything where A is 0."""
    if solid <= DENSE * area:
        sn = solid * per_area
        return sn, -sn
    room = DENSEST - DENSE
    below = solid - (DENSE - room) * area
    sn = DENSE + room * (solid - DENSE * area) / below
    return sn, -room * room * area * solid / (below * below)


@register_jitable(**WITHIN)
def gather(first, size, x, rel, screens, g):
    """Vector area (m2) and velocity of the water past it (m/s) of a block of faces into rows 0 to 5 of g."""
    for i in range(size):
        f = first + i
        a, b, c, d = (
            screens.corners[f, 0],
            screens.corners[f, 1],
            screens.corners[f, 2],
            screens.corners[f, 3],
        )
        p, q, r = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
        s, t, u = x[d, 0] - x[b, 0], x[d, 1] - x[b, 1], x[d, 2] - x[b, 2]
        g[0, i], g[1, i], g[2, i] = 0.5 * (q * u - r * t), 0.5 * (r * s - p * u), 0.5 * (p * t - q * s)
        fa, fb, fc, fd = screens.share[f, 0], screens.share[f, 1], screens.share[f, 2], screens.share[f, 3]
        g[3, i] = fa * rel[a, 0] + fb * rel[b, 0] + fc * rel[c, 0] + fd * rel[d, 0]
        g[4, i] = fa * rel[a, 1] + fb * rel[b, 1] + fc * rel[c, 1] + fd * rel[d, 1]
        g[5, i] = fa * rel[a, 2] + fb * rel[b, 2] + fc * rel[c, 2] + fd * rel[d, 2]


@register_jitable(**WITHIN)
def _force(first, size, screens, law, wet, g):
    """Force (N) of a block of faces from rows 0 to 5 of g into rows 6 to 8."""
    for i in range(size):
        n0, n1, n2 = take(g, i), take(g, BLOCK + i), take(g, 2 * BLOCK + i)
        w0, w1, w2 = take(g, 3 * BLOCK + i), take(g, 4 * BLOCK + i), take(g, 5 * BLOCK + i)
        area, speed = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2), np.sqrt(w0 * w0 + w1 * w1 + w2 * w2)
        # One division for all: where there is no speed, nothing counts.
        inverse = 1.0 / max(area * speed, TINY)
        c = (n0 * w0 + n1 * w1 + n2 * w2) * inverse
        s = np.sqrt(max(1.0 - c * c, 0.0))
        sn, _ = local_solidity(take(screens.solid, first + i), area, speed * inverse)
        drag, lift = screen(law, blunt(abs(c), GRAZING), s, sn, take(screens.twine, first + i) * speed)
        pressed = screens.half_density * take(wet, first + i) * speed
        by_w = pressed * area * (drag - c * c * lift)
        by_n = pressed * speed * c * lift
        keep(g, 6 * BLOCK + i, by_w * w0 + by_n * n0)
        keep(g, 7 * BLOCK + i, by_w * w1 + by_n * n1)
        keep(g, 8 * BLOCK + i, by_w * w2 + by_n * n2)


@njit(**OPTIONS)
def add_screens(x, rel, screens, law, wet, out):
    """Add the force of the water on all faces to out (n, 3) N, at their corners.

    x: (n, 3) m; rel: (n, 3) m/s, the water against the knots; law: the form of a law, in tables;
    wet: (p,) part of every face under water.
    """
    g = np.empty((9, BLOCK))
    p = screens.solid.shape[0]
    for first in range(0, p, BLOCK):
        size = min(BLOCK, p - first)
        gather(first, size, x, rel, screens, g)
        _force(first, size, screens, law, wet, g)
        for i in range(size):
            for corner in range(4):
                knot, part = screens.corners[first + i, corner], screens.share[first + i, corner]
                out[knot, 0] += part * g[6, i]
                out[knot, 1] += part * g[7, i]
                out[knot, 2] += part * g[8, i]


@njit(**OPTIONS)
def screen_forces(x, rel, screens, law, wet, out):
    """Force of the water on every face into out (p, 3) N; arguments as in add_screens."""
    g = np.empty((9, BLOCK))
    p = screens.solid.shape[0]
    for first in range(0, p, BLOCK):
        size = min(BLOCK, p - first)
        gather(first, size, x, rel, screens, g)
        _force(first, size, screens, law, wet, g)
        for i in range(size):
            out[first + i, 0], out[first + i, 1], out[first + i, 2] = g[6, i], g[7, i], g[8, i]


@njit(**OPTIONS)
def screen_places(x, rel, screens, out):
    """What the law is asked for at every face into out (3, p): solidity, angle (rad, at most pi/2) and Re."""
    g = np.empty((6, BLOCK))
    p = screens.solid.shape[0]
    for first in range(0, p, BLOCK):
        size = min(BLOCK, p - first)
        gather(first, size, x, rel, screens, g)
        for i in range(size):
            n0, n1, n2, w0, w1, w2 = g[0, i], g[1, i], g[2, i], g[3, i], g[4, i], g[5, i]
            along = np.sqrt((n1 * w2 - n2 * w1) ** 2 + (n2 * w0 - n0 * w2) ** 2 + (n0 * w1 - n1 * w0) ** 2)
            area = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
            out[0, first + i], _ = local_solidity(screens.solid[first + i], area, 1.0 / max(area, TINY))
            out[1, first + i] = np.arctan2(along, abs(n0 * w0 + n1 * w1 + n2 * w2))
            out[2, first + i] = screens.twine[first + i] * np.sqrt(w0 * w0 + w1 * w1 + w2 * w2)
