"""Force on a block of knots, gathered from the bars around them: the hot loop of the explicit steppers.

Per knot, equations (1) to (6) of the panel model: F = tension + water + weight and buoyancy, with
    bar:   T t on end a, -T t on end b, T by the elastic law plus Kelvin-Voigt damping, never below zero;
           c_n L |w_n| w_n + c_t L |w_t| w_t on each end, w the velocity of the water relative to the bar's middle;
    knot:  1/2 rho C_D pi/4 d_k^2 |w| w.
Positions x, velocities v and velocities u of the water lie in fields as forces.around lays them out.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .apart import keep, kept, put, settle, summed, take
from .around import (
    BAR_ROWS,
    BLOCK,
    DAMPING,
    KNOT_DRAG,
    KNOT_REYNOLDS,
    KNOT_ROWS,
    KNOT_SHARE,
    NORMAL,
    PITCH,
    REST_LENGTH,
    REYNOLDS,
    STIFFNESS,
    TANGENTIAL,
    extent,
    neighbours,
    own_fields,
)
from .compiled import INLINED, OPTIONS
from .drag import bar_water_force
from .laws import flow_by_bar, varies, vary, vary_knots
from .tension import law_tension
from .total import TINY_LENGTH

# Rows of the work array g (WORK_ROWS x PITCH,): the force in 0 to 2, speed of the water past the knots, force on the
# far ends of bars; tension is SLOPE x stretch + OFFSET; ACROSS, ALONG hold the flow past bars, then c_n, c_t of it;
# laws work in LAW_WORK and the rows behind it, up to SLOPE, before there is a force on far ends.
SPEED, FAR, LAW_WORK, SLOPE, OFFSET, ACROSS, ALONG, WORK_ROWS = 3, 4, 5, 13, 14, 15, 16, 17


@njit(**OPTIONS)
def laws_of_bars(start, end, old, fields, el, around, law):
    """Slope dT/dl (N/m) of bars start .. end and tension less slope x stretch (N) into law (2, m + 1).

    old: row of x in fields.
    """
    for e in range(start, end):
        first = old * around.width + around.margin
        a, b = first + np.int64(el.knot_a[e]), first + np.int64(el.knot_b[e])
        square = 0.0
        for q in range(3):
            square += (take(fields, b + q * around.width) - take(fields, a + q * around.width)) ** 2
        length = np.sqrt(square)
        stretch = length - el.rest_length[e]
        law[0, e] = law[1, e] = 0.0
        if stretch > 0.0:
            strain = length / el.rest_length[e] - 1.0
            tension, slope = law_tension(max(strain, 0.0), el.law_rows, el.law_first[e], el.law_end[e])
            law[0, e] = slope / el.rest_length[e]
            law[1, e] = tension - law[0, e] * stretch


@njit(**OPTIONS)
def share_laws(rank, team, old, fields, el, around, law):
    """Do one thread's share of laws_of_bars; whole blocks, so that no bit depends on the number of threads."""
    bars = el.knot_a.shape[0]
    blocks = (bars + BLOCK - 1) // BLOCK
    for block in range(blocks * rank // team, blocks * (rank + 1) // team):
        laws_of_bars(block * BLOCK, min(bars, (block + 1) * BLOCK), old, fields, el, around, law)


@njit(**INLINED)
def block_force(block, old, fields, uniform, laws, around, law, work):
    """Force on every knot of a block into rows 0 to 2 of g N, speed of the water past the knots into SPEED m/s.

    old: row of x in fields; uniform: the water has the same velocity everywhere; laws: DragLaws, or None
    for constant drag; law: (2, m + 1) as laws_of_bars gives it, used where laws are not linear; work: arrays near
    (NEAR_ROWS x PITCH,) and g (WORK_ROWS x PITCH,), OFFSET zero.
    """
    near, g = work
    here, size = extent(block, around)
    water = around.margin if uniform else here
    own = own_fields(old, here, water, fields, around)
    _own_forces(size, own, around.knots_row[block] * KNOT_ROWS * BLOCK, around.knots, g)
    by_law = False
    if laws is not None:
        by_law = varies(laws.bars)
        if laws.knots.shape[0] > 0:
            _by_knot_laws(size, own, around.knots_row[block] * KNOT_ROWS * BLOCK, around.knots, laws.knots, g)
    for slot in range(around.first[block], around.first[block + 1]):
        begin, end = around.begin[slot], around.end[slot]
        row = around.bars_row[slot] * BAR_ROWS
        slopes, slope = around.bars, (row + STIFFNESS) * BLOCK
        drags, across, along = around.bars, (row + NORMAL) * BLOCK, (row + TANGENTIAL) * BLOCK
        if not around.linear:
            slopes, slope = g, SLOPE * PITCH
            for i in range(begin, end):
                g[SLOPE * PITCH + i] = law[0, around.bar[slot, i]]
                g[OFFSET * PITCH + i] = law[1, around.bar[slot, i]]
        others = neighbours(slot, old, here, water, fields, around, near)
        if laws is not None:
            if by_law:
                reference = drags, across, drags, along
                drags, across, along = g, ACROSS * PITCH, ALONG * PITCH
                _flow_past(begin, end, own, others, (around.bars, (row + REYNOLDS) * BLOCK), g)
                vary(begin, end, g, (across, along), LAW_WORK * PITCH, reference, laws.bars)
                settle()
        _add_bars(slot, own, others, (slopes, slope), (drags, across, along), around, g)
        if around.both[slot]:
            shift = around.shift[slot]
            for i in range(begin, end):
                put(g, shift + i, summed(g, shift + i) + kept(g, FAR * PITCH + i))
                put(g, PITCH + shift + i, summed(g, PITCH + shift + i) + kept(g, (FAR + 1) * PITCH + i))
                put(
                    g,
                    2 * PITCH + shift + i,
                    summed(g, 2 * PITCH + shift + i) + kept(g, (FAR + 2) * PITCH + i),
                )


@njit(**INLINED)
def _own_forces(size, own, first, knots, g):
    """Weight and knot drag into rows 0 to 2 of g, speed of the water past the knots into SPEED.

    own: as own_fields gives it; first: place of the first knot's weight in knots.
    """
    fields, width, _, v, u = own
    for i in range(size):
        p = take(fields, u + i) - take(fields, v + i)
        q = take(fields, u + width + i) - take(fields, v + width + i)
        r = take(fields, u + 2 * width + i) - take(fields, v + 2 * width + i)
        speed = np.sqrt(p * p + q * q + r * r)
        c = take(knots, first + KNOT_DRAG * BLOCK + i) * speed
        put(g, i, take(knots, first + i) + c * p)
        put(g, PITCH + i, take(knots, first + BLOCK + i) + c * q)
        put(g, 2 * PITCH + i, take(knots, first + 2 * BLOCK + i) + c * r)
        put(g, SPEED * PITCH + i, speed)


@njit(**OPTIONS)
def _by_knot_laws(size, own, first, knots, curve, g):
    """Change the drag in rows 0 to 2 of g from that at the reference to that of the law; arguments as before."""
    fields, width, _, v, u = own
    for i in range(size):
        re = take(knots, first + KNOT_REYNOLDS * BLOCK + i) * summed(g, SPEED * PITCH + i)
        keep(g, ACROSS * PITCH + i, re * re)
    share = first + KNOT_SHARE * BLOCK
    vary_knots(0, size, g, ACROSS * PITCH, LAW_WORK * PITCH, (knots, share), curve)
    for i in range(size):
        c = take(knots, first + KNOT_DRAG * BLOCK + i) * summed(g, SPEED * PITCH + i)
        c *= kept(g, ACROSS * PITCH + i) - take(knots, share + i)
        for q in range(3):
            w = take(fields, u + q * width + i) - take(fields, v + q * width + i)
            put(g, q * PITCH + i, summed(g, q * PITCH + i) + c * w)


@njit(**OPTIONS)
def _flow_past(begin, end, own, others, scale, g):
    """Re^2 across one slot's bars into ACROSS, Re along them into ALONG; scale: array and place of Re over speed."""
    fields, width, x, v, u = own
    far, pitch, far_x, far_v, far_u = others
    per_speed, first = scale
    for i in range(begin, end):
        dx = take(far, far_x + i) - take(fields, x + i)
        dy = take(far, far_x + pitch + i) - take(fields, x + width + i)
        dz = take(far, far_x + 2 * pitch + i) - take(fields, x + 2 * width + i)
        p = take(fields, u + i) + take(far, far_u + i) - take(fields, v + i) - take(far, far_v + i)
        q = take(fields, u + width + i) + take(far, far_u + pitch + i)
        q -= take(fields, v + width + i) + take(far, far_v + pitch + i)
        r = take(fields, u + 2 * width + i) + take(far, far_u + 2 * pitch + i)
        r -= take(fields, v + 2 * width + i) + take(far, far_v + 2 * pitch + i)
        half = 0.5 * take(per_speed, first + i)
        square, along = flow_by_bar(dx, dy, dz, half * p, half * q, half * r)
        keep(g, ACROSS * PITCH + i, square)
        keep(g, ALONG * PITCH + i, along)


@njit(**INLINED)
def _add_bars(slot, own, others, tensions, resistance, around, g):
    """Add the forces of one slot's bars to rows 0 to 2 of g; those on their far ends into FAR.

    own, others: fields of the knots and their neighbours as own_fields gives them; tensions: an array and the place of
    dT/dl of the first knot's bar in it; resistance: the same, with the places of c_n and c_t.
    """
    (slopes, slope), (drags, across, along) = tensions, resistance
    fields, width, x, v, u = own
    far, pitch, far_x, far_v, far_u = others
    bars, bar = around.bars, around.bars_row[slot] * BAR_ROWS * BLOCK
    for i in range(around.begin[slot], around.end[slot]):
        dx = take(far, far_x + i) - take(fields, x + i)
        dy = take(far, far_x + pitch + i) - take(fields, x + width + i)
        dz = take(far, far_x + 2 * pitch + i) - take(fields, x + 2 * width + i)
        v0, w0 = take(fields, v + i), take(far, far_v + i)
        v1, w1 = take(fields, v + width + i), take(far, far_v + pitch + i)
        v2, w2 = take(fields, v + 2 * width + i), take(far, far_v + 2 * pitch + i)
        length = np.sqrt(dx * dx + dy * dy + dz * dz)
        inverse = 1.0 / max(length, TINY_LENGTH)
        tx, ty, tz = dx * inverse, dy * inverse, dz * inverse
        fx, fy, fz = bar_water_force(
            0.5 * (take(fields, u + i) + take(far, far_u + i) - v0 - w0),
            0.5 * (take(fields, u + width + i) + take(far, far_u + pitch + i) - v1 - w1),
            0.5 * (take(fields, u + 2 * width + i) + take(far, far_u + 2 * pitch + i) - v2 - w2),
            tx,
            ty,
            tz,
            take(drags, across + i) * length,
            take(drags, along + i) * length,
        )
        stretch = length - take(bars, bar + REST_LENGTH * BLOCK + i)
        rate = (w0 - v0) * tx + (w1 - v1) * ty + (w2 - v2) * tz
        tension = take(slopes, slope + i) * (stretch + take(bars, bar + DAMPING * BLOCK + i) * rate)
        tension += take(g, OFFSET * PITCH + i)
        tension = max(tension, 0.0) if stretch > 0.0 else 0.0
        px, py, pz = tension * tx, tension * ty, tension * tz
        put(g, i, summed(g, i) + (fx + px))
        put(g, PITCH + i, summed(g, PITCH + i) + (fy + py))
        put(g, 2 * PITCH + i, summed(g, 2 * PITCH + i) + (fz + pz))
        keep(g, FAR * PITCH + i, fx - px)
        keep(g, (FAR + 1) * PITCH + i, fy - py)
        keep(g, (FAR + 2) * PITCH + i, fz - pz)
