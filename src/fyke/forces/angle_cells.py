"""Laws of the angle between bar and flow in kernels: C_D and C_L by ln Re and angle, in the cells of a user's table.

In the unit Re of velocities, with n = Re_n across and s = |Re_t| along a bar and r^2 = n^2 + s^2,
    c_n = c r (C_D n + C_L s) / n^2,  c_t = c r (C_D s - C_L n) / s^2.
Library logarithms and arc tangents are called one number at a time; those here are polynomials that vectorise.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numba.extending import register_jitable

from .apart import keep, kept, take
from .around import PITCH
from .compiled import OPTIONS, WITHIN
from .cubics import FOUR, PART, READ_ROWS, ROW, fetch_all, in_strides

# Flow below this has no direction (in units of Re): divisions stay finite where the force is zero.
STILL = 1e-100
# Work rows: those of cubics, then ln Re and the angle.
LOGARITHM, ANGLE, WORK_ROWS = READ_ROWS, READ_ROWS + 1, READ_ROWS + 2

_LN2, _ROOT2, _HALF_PI = math.log(2.0), math.sqrt(2.0), 0.5 * math.pi
_TAN_EIGHTH = math.sqrt(2.0) - 1.0  # of pi / 8
_FRACTION, _ONE, _BIAS = (1 << 52) - 1, 1023 << 52, 1023
# 2 artanh(f) / f in powers of f^2, which is at most 0.0295: the next term is below 1e-16.
_ARTANH = tuple(2.0 / (2 * k + 1) for k in range(10))
# arctan(z) / z in powers of z^2, which is at most tan^2(pi / 8): Chebyshev interpolation in 60 digits, 7e-17 off.
_ARCTAN = (
    1.0,
    -0.3333333333332844,
    0.1999999999885511,
    -0.14285714180976467,
    0.11111106180455946,
    -0.09090773074808414,
    0.07689953496306857,
    -0.06640233930429408,
    0.056883492268090106,
    -0.04348052215716462,
    0.021135373157693246,
)


@register_jitable(**WITHIN)
def logarithm(x):
    """Natural logarithm of a normal number above 0."""
    bits = np.float64(x).view(np.int64)
    m = np.int64((bits & _FRACTION) | _ONE).view(np.float64)
    large = m > _ROOT2
    m = 0.5 * m if large else m
    # By way of 32 bits: not every processor turns int64 into float64 at vector width.
    e = np.float64(np.int32((bits >> 52) - _BIAS)) + (1.0 if large else 0.0)
    f = (m - 1.0) / (m + 1.0)
    s = f * f
    p = _ARTANH[5] + s * (_ARTANH[6] + s * (_ARTANH[7] + s * (_ARTANH[8] + s * _ARTANH[9])))
    p = _ARTANH[0] + s * (_ARTANH[1] + s * (_ARTANH[2] + s * (_ARTANH[3] + s * (_ARTANH[4] + s * p))))
    return e * _LN2 + f * p


@register_jitable(**WITHIN)
def angle_of(n, s):
    """Angle (rad) from 0 to pi / 2 whose tangent is n / s; both at least STILL."""
    small, great = min(n, s), max(n, s)
    turned = small > _TAN_EIGHTH * great
    z = (small - great if turned else small) / (small + great if turned else great)
    y = z * z
    p = _ARCTAN[6] + y * (_ARCTAN[7] + y * (_ARCTAN[8] + y * (_ARCTAN[9] + y * _ARCTAN[10])))
    p = _ARCTAN[1] + y * (_ARCTAN[2] + y * (_ARCTAN[3] + y * (_ARCTAN[4] + y * (_ARCTAN[5] + y * p))))
    angle = z * (_ARCTAN[0] + y * p) + (0.5 * _HALF_PI if turned else 0.0)
    return _HALF_PI - angle if n > s else angle


@register_jitable(**WITHIN)
def _slant(square, along, reynolds, angle):
    """Ln Re and angle, kept to the table, of a flow with this Re^2 across and Re along a bar."""
    log = 0.5 * logarithm(max(square + along * along, STILL))
    q = angle_of(max(np.sqrt(square), STILL), max(abs(along), STILL))
    return (
        min(max(log, take(reynolds, 0)), take(reynolds, reynolds.shape[0] - 1)),
        min(max(q, take(angle, 0)), take(angle, angle.shape[0] - 1)),
    )


@register_jitable(**WITHIN)
def _in_axes(square, along, drag, lift):
    """c_n and c_t over c from C_D and C_L."""
    n, s = max(np.sqrt(square), STILL), max(abs(along), STILL)
    r = np.sqrt(n * n + s * s)
    return r * (drag * n + lift * s) / (n * n), r * (drag * s - lift * n) / (s * s)


@njit(**OPTIONS)
def by_cells(begin, end, g, across, along, work, cells):
    """Put c_n and c_t over c in place of Re^2 across and Re along, in g from across + begin and along + begin on.

    To the end of the last stride; work: place of WORK_ROWS rows in g.
    """
    end = in_strides(begin, end)
    reynolds, angle = cells.reynolds, cells.angle
    by_log, by_q = work + LOGARITHM * PITCH, work + ANGLE * PITCH
    count, four = work + PART * PITCH, work + FOUR * PITCH
    for i in range(begin, end):
        log, q = _slant(kept(g, across + i), kept(g, along + i), reynolds, angle)
        keep(g, by_log + i, log)
        keep(g, by_q + i, q)
        keep(g, count + i, 0.0)
    _count(begin, end, g, reynolds, by_log, 2.0 * (angle.shape[0] - 1), count)
    _count(begin, end, g, angle, by_q, 2.0, count)
    for i in range(begin, end):
        keep(g, work + ROW * PITCH + i, np.int64(np.int32(kept(g, count + i))).view(np.float64))
    fetch_all(begin, end, g, work, cells.rows)
    for i in range(begin, end):
        keep(g, count + i, _plane(g, four + i, kept(g, by_log + i), kept(g, by_q + i)))
        row = np.float64(kept(g, work + ROW * PITCH + i)).view(np.int64)
        keep(g, work + ROW * PITCH + i, np.int64(row + 1).view(np.float64))
    fetch_all(begin, end, g, work, cells.rows)
    for i in range(begin, end):
        lift = _plane(g, four + i, kept(g, by_log + i), kept(g, by_q + i))
        n, t = _in_axes(kept(g, across + i), kept(g, along + i), kept(g, count + i), lift)
        keep(g, across + i, n)
        keep(g, along + i, t)


@njit(**OPTIONS)
def _count(begin, end, g, edges, values, size, count):
    """Add so much (size) to a count for every edge between the first and the last that a value reaches.

    Comparing with all of them, four in one go, keeps the loop over values one of vectors, which a search is not.
    """
    last = edges.shape[0] - 1
    for k in range(1, last, 4):
        e0, e1 = edges[k], edges[k + 1] if k + 1 < last else np.inf
        e2, e3 = edges[k + 2] if k + 2 < last else np.inf, edges[k + 3] if k + 3 < last else np.inf
        for i in range(begin, end):
            value = kept(g, values + i)
            low = (1.0 if value >= e0 else 0.0) + (1.0 if value >= e1 else 0.0)
            high = (1.0 if value >= e2 else 0.0) + (1.0 if value >= e3 else 0.0)
            keep(g, count + i, kept(g, count + i) + size * (low + high))


@register_jitable(**WITHIN)
def _plane(g, at, log, q):
    """Value of a cell at ln Re and angle, its four numbers in rows of g."""
    low = kept(g, at) + kept(g, at + 2 * PITCH) * q
    return low + (kept(g, at + PITCH) + kept(g, at + 3 * PITCH) * q) * log


@njit(**OPTIONS)
def laws_of_angle(c, cells, out):
    """Put what laws.coefficients_of_bars says, slopes by Re^2 and Re, into out; those lie in rows 0 and 1 of it."""
    for e in range(out.shape[1]):
        law = _law_of_angle(out[0, e], out[1, e], cells.reynolds, cells.angle, cells.rows)
        for k in range(6):
            out[k, e] = c[e] * law[k]


@njit(**OPTIONS)
def _law_of_angle(square, along, reynolds, angle, rows):
    """c_n and c_t over c at Re^2 across and Re along a bar, slopes of c_n by both, then of c_t by both."""
    n, s = max(np.sqrt(square), STILL), max(abs(along), STILL)
    side = 1.0 if along >= 0.0 else -1.0
    r2 = n * n + s * s
    r = np.sqrt(r2)
    log, q = _slant(square, along, reynolds, angle)
    i, by_logog = _cell(reynolds, log)
    j, by_angle = _cell(angle, q)
    row = 2 * (i * (angle.shape[0] - 1) + j)
    drag, drag_l, drag_q = _plane_with_slopes(rows[row], log, q)
    lift, lift_l, lift_q = _plane_with_slopes(rows[row + 1], log, q)
    drag_l, lift_l, drag_q, lift_q = (
        by_logog * drag_l,
        by_logog * lift_l,
        by_angle * drag_q,
        by_angle * lift_q,
    )
    drag_n, lift_n = _by_speed(n, s, r2, drag_l, drag_q, lift_l, lift_q)
    drag_s, lift_s = _by_speed(s, -n, r2, drag_l, drag_q, lift_l, lift_q)
    p, t = drag * n + lift * s, drag * s - lift * n
    p_n, p_s = drag_n * n + drag + lift_n * s, drag_s * n + lift_s * s + lift
    t_n, t_s = drag_n * s - lift_n * n - lift, drag_s * s + drag - lift_s * n
    inverse_n, inverse_s = 1.0 / (n * n), 1.0 / (s * s)
    cn_n = (n / r * p + r * p_n - 2.0 * r * p / n) * inverse_n
    cn_s = (s / r * p + r * p_s) * inverse_n
    ct_n = (n / r * t + r * t_n) * inverse_s
    ct_s = (s / r * t + r * t_s - 2.0 * r * t / s) * inverse_s
    slopes = 0.5 * cn_n / n, side * cn_s, 0.5 * ct_n / n, side * ct_s
    return r * p * inverse_n, r * t * inverse_s, *slopes


@njit(**OPTIONS)
def _plane_with_slopes(row, log, q):
    """Value of the plane of a cell at ln Re and angle, and its slopes by both."""
    low, high = row[0] + row[2] * q, row[1] + row[3] * q
    return low + high * log, high, row[2] + row[3] * log


@njit(**OPTIONS)
def _cell(edges, at):
    """Interval of rising edges, and 1, or 0 where the table is held beyond its ends."""
    last = edges.shape[0] - 1
    k = min(max(np.searchsorted(edges, at, side="right") - 1, 0), last - 1)
    return k, 1.0 if edges[0] < at < edges[last] else 0.0


@njit(**OPTIONS)
def _by_speed(one, other, r2, drag_log, drag_angle, lift_log, lift_angle):
    """Slopes of C_D and C_L by one of the speeds n, s: d ln r = one / r^2, d angle = (s, -n) / r^2."""
    turn = other / r2
    return drag_log * one / r2 + drag_angle * turn, lift_log * one / r2 + lift_angle * turn
