"""Force on a block of knots, gathered from the bars around them: the hot loop of the explicit steppers.

Per knot, equations (1) to (6) of the panel model: F = tension + water + weight and buoyancy, with
    bar:   T t on end a, -T t on end b, T by the elastic law plus Kelvin-Voigt damping, never below zero;
           c_n L |w_n| w_n + c_t L |w_t| w_t on each end, w the velocity of the water relative to the bar's middle;
    knot:  1/2 rho C_D pi/4 d_k^2 |w| w.
Positions x, velocities v and velocities u of the water are (3, width) m, m/s, as forces.around lays them out.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .around import (
    BLOCK,
    DAMPING,
    KNOT_DRAG,
    NORMAL,
    REST_LENGTH,
    STIFFNESS,
    TANGENTIAL,
    differences,
    extent,
)
from .compiled import OPTIONS
from .drag import bar_water_force
from .tension import law_tension
from .total import TINY_LENGTH

# Rows of the work array g (WORK_ROWS, BLOCK), after the force in 0 to 2 and the velocity of the water relative to the
# knots in 3 to 5; three rows each: neighbour less knot of x, v and u. Tension is SLOPE x stretch + OFFSET.
ALONG, PASSING, SHEAR, SLOPE, OFFSET = 6, 9, 12, 15, 16


@njit(**OPTIONS)
def laws_of_bars(start, end, x, el, around, law):
    """Slope dT/dl (N/m) of bars start .. end and tension less slope x stretch (N) into law (2, m + 1)."""
    for e in range(start, end):
        a, b = around.margin + el.knot_a[e], around.margin + el.knot_b[e]
        length = np.sqrt((x[0, b] - x[0, a]) ** 2 + (x[1, b] - x[1, a]) ** 2 + (x[2, b] - x[2, a]) ** 2)
        stretch = length - el.rest_length[e]
        law[0, e] = law[1, e] = 0.0
        if stretch > 0.0:
            strain = length / el.rest_length[e] - 1.0
            tension, slope = law_tension(max(strain, 0.0), el.law_rows, el.law_first[e], el.law_end[e])
            law[0, e] = slope / el.rest_length[e]
            law[1, e] = tension - law[0, e] * stretch


@njit(**OPTIONS)
def share_laws(rank, team, x, el, around, law):
    """Do one thread's share of laws_of_bars; whole blocks, so that no bit depends on the number of threads."""
    bars = el.knot_a.shape[0]
    blocks = (bars + BLOCK - 1) // BLOCK
    for block in range(blocks * rank // team, blocks * (rank + 1) // team):
        laws_of_bars(block * BLOCK, min(bars, (block + 1) * BLOCK), x, el, around, law)


@njit(**OPTIONS)
def block_force(block, x, v, u, uniform, around, law, g):
    """Force on every knot of a block into g[0:3] N, velocity of the water relative to the knots into g[3:6] m/s.

    uniform: u is the same everywhere; law: (2, m + 1) as laws_of_bars gives it, used where laws are not linear; g:
    (WORK_ROWS, BLOCK), zero before the first call.
    """
    here, size = extent(block, around)
    own = around.knots_row[block]
    for i in range(size):
        p, q, r = (
            u[0, here + i] - v[0, here + i],
            u[1, here + i] - v[1, here + i],
            u[2, here + i] - v[2, here + i],
        )
        c = around.knots[own, KNOT_DRAG, i] * np.sqrt(p * p + q * q + r * r)
        g[0, i] = around.knots[own, 0, i] + c * p
        g[1, i] = around.knots[own, 1, i] + c * q
        g[2, i] = around.knots[own, 2, i] + c * r
        g[3, i], g[4, i], g[5, i] = p, q, r
    for slot in range(around.first[block], around.first[block + 1]):
        differences(slot, here, size, x, around, g, ALONG)
        differences(slot, here, size, v, around, g, PASSING)
        if not uniform:
            differences(slot, here, size, u, around, g, SHEAR)
        bar = around.bars_row[slot]
        for i in range(size):
            g[SLOPE, i] = around.bars[bar, STIFFNESS, i]
        if not around.linear:
            for i in range(size):
                g[SLOPE, i] = law[0, around.bar[slot, i]]
                g[OFFSET, i] = law[1, around.bar[slot, i]]
        _add_bars(bar, size, around, g)


@njit(**OPTIONS)
def _add_bars(bar, size, around, g):
    """Add the forces of one slot's bars to g[0:3]; bar: row of their properties."""
    bars = around.bars
    for i in range(size):
        dx, dy, dz = g[6, i], g[7, i], g[8, i]
        length = np.sqrt(dx * dx + dy * dy + dz * dz)
        inverse = 1.0 / max(length, TINY_LENGTH)
        tx, ty, tz = dx * inverse, dy * inverse, dz * inverse
        fx, fy, fz = bar_water_force(
            g[3, i] + 0.5 * (g[12, i] - g[9, i]),
            g[4, i] + 0.5 * (g[13, i] - g[10, i]),
            g[5, i] + 0.5 * (g[14, i] - g[11, i]),
            tx,
            ty,
            tz,
            bars[bar, NORMAL, i] * length,
            bars[bar, TANGENTIAL, i] * length,
        )
        stretch = length - bars[bar, REST_LENGTH, i]
        rate = g[9, i] * tx + g[10, i] * ty + g[11, i] * tz
        tension = g[SLOPE, i] * (stretch + bars[bar, DAMPING, i] * rate) + g[OFFSET, i]
        tension = max(tension, 0.0) if stretch > 0.0 else 0.0
        g[0, i] += fx + tension * tx
        g[1, i] += fy + tension * ty
        g[2, i] += fz + tension * tz
