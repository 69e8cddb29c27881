"""Coefficients of bars and knots under laws that know the Reynolds number, the angle, or both.

Every law is written as coefficients c_n, c_t (kg/m2) of the force of forces.drag, F = L (c_n |n| n + c_t |s| s t), at
the flow n across and s along a bar:
    split laws    c_n = c C_n(|n|),  c_t = c (A(|n|)/|s| + B(|n|)),  from the curves of system.curves;
    Hoerner       c f |w|/|n| and c f |w|/|s| more, a friction along the flow;
    angle tables  c_n = c N |w|^2/|n|^2,  c_t = c T |w|^2/s^2,  N and T the force across and along by Re and angle.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ..system.curves import FIRST, HIGHEST, INTERVALS, INVERSE_WIDTH, LOWEST, ROW, SHIFT
from .apart import keep, kept, take
from .compiled import OPTIONS

_LOW, _HIGH = 2.0**LOWEST, 2.0**HIGHEST
_MASK, _PART = (1 << SHIFT) - 1, 2.0**-SHIFT
_LAST = ((FIRST + INTERVALS) << SHIFT) - 1
# Flow below this has no direction (m/s): divisions stay finite where the force is zero.
STILL = 1e-100


@njit(**OPTIONS)
def _place(square):
    """Interval of a speed squared (m2/s2), the part of it, 0 to 1, and 1, or 0 where the curves are held."""
    bits = min(np.float64(max(square, _LOW)).view(np.int64), np.int64(_LAST))
    moves = 1.0 if _LOW < square < _HIGH else 0.0
    return (bits >> SHIFT) - FIRST, np.float64(bits & _MASK) * _PART, moves


@njit(**OPTIONS)
def knot_law(square, curve, curves):
    """C_D of a knot over its reference at a speed squared (m2/s2), and its slope (s2/m2); curve: which of curves."""
    k, u, moves = _place(square)
    c1, c2, c3 = curves[curve, k, 1], curves[curve, k, 2], curves[curve, k, 3]
    steep = moves * curves[curve, k, 4]
    return curves[curve, k, 0] + u * (c1 + u * (c2 + u * c3)), steep * (c1 + u * (2.0 * c2 + 3.0 * u * c3))


@njit(inline="always", **OPTIONS)
def split_law(square, along, c, curve, curves, friction):
    """Present c_n, c_t (kg/m2) of a bar at a speed squared across (m2/s2) and a speed along it (m/s), with slopes.

    The slopes are those of c_n by both, then of c_t by both. c: kg/m2, the bar's normal_drag; curve: which of curves.
    """
    k, u, moves = _place(square)
    row = (curve * INTERVALS + k) * ROW
    steep = moves * take(curves, row + INVERSE_WIDTH)
    inverse = 1.0 / max(abs(along), STILL)
    side = inverse if along >= 0.0 else -inverse
    n, n_q = _cubic(curves, row, u)
    a, a_q = _cubic(curves, row + 4, u)
    b, b_q = _cubic(curves, row + 8, u)
    n_q, t_q, n_s, t_s = n_q * steep, (a_q * inverse + b_q) * steep, 0.0, -a * inverse * side
    t = a * inverse + b
    if friction > 0.0:
        across = 1.0 / max(np.sqrt(square), STILL)
        total = np.sqrt(square + along * along)
        drawn, half = friction * total, 0.5 * friction / max(total, STILL)
        n += drawn * across
        n_q += half * across - 0.5 * drawn * across * across * across
        n_s += 2.0 * half * along * across
        t += drawn * inverse
        t_q += half * inverse
        t_s += (2.0 * half * along - drawn * side) * inverse
    return c * n, c * t, c * n_q, c * n_s, c * t_q, c * t_s


@njit(**OPTIONS)
def _cubic(curves, place, u):
    """Value and slope by u of the cubic whose coefficients lie from a place on."""
    c1, c2, c3 = take(curves, place + 1), take(curves, place + 2), take(curves, place + 3)
    return take(curves, place) + u * (c1 + u * (c2 + u * c3)), c1 + u * (2.0 * c2 + 3.0 * u * c3)


@njit(**OPTIONS)
def flow_by_bar(dx, dy, dz, wx, wy, wz):
    """Square (m2/s2) of the part across d of a velocity w, and its part along d (m/s)."""
    inverse = 1.0 / np.sqrt(max(dx * dx + dy * dy + dz * dz, STILL))
    tx, ty, tz = dx * inverse, dy * inverse, dz * inverse
    s = wx * tx + wy * ty + wz * tz
    nx, ny, nz = wx - s * tx, wy - s * ty, wz - s * tz
    return nx * nx + ny * ny + nz * nz, s


@njit(**OPTIONS)
def vary(begin, end, g, across, along, rows, places, el):
    """Put c_n and c_t (kg/m2) in place of the squares of speeds across bars and speeds along them.

    These lie in g from the places across + begin and along + begin on. rows: flat, normal_drag, bar_curve and
    bar_reynolds of the bars from three places + begin on.
    """
    c_at, curve_at, reynolds_at = places
    curves, friction, angles = el.bar_curves, el.friction, el.angles
    if angles.reynolds.shape[0] > 0:
        for i in range(begin, end):
            q, s, r = kept(g, across + i), kept(g, along + i), take(rows, reynolds_at + i)
            law = angle_law(q, s, r, take(rows, c_at + i), angles)
            keep(g, across + i, law[0])
            keep(g, along + i, law[1])
        return
    for i in range(begin, end):
        which = np.int64(take(rows, curve_at + i))
        q, s = kept(g, across + i), kept(g, along + i)
        law = split_law(q, s, take(rows, c_at + i), which, curves, friction)
        keep(g, across + i, law[0])
        keep(g, along + i, law[1])


@njit(**OPTIONS)
def _between(points, at):
    """Interval of rising points, part of it, and 1 / its width, or 0 where at lies beyond the points and is held."""
    k = min(max(np.searchsorted(points, at, side="right") - 1, 0), points.shape[0] - 2)
    inverse = 1.0 / (points[k + 1] - points[k])
    u = (at - points[k]) * inverse
    if u < 0.0 or u >= 1.0:
        return k, min(max(u, 0.0), 1.0), 0.0
    return k, u, inverse


@njit(**OPTIONS)
def _grid(table, i, u, j, v):
    """Value at parts u, v of the cell (i, j) of a table, straight both ways, and its slopes by u and v."""
    low = table[i, j] + v * (table[i, j + 1] - table[i, j])
    high = table[i + 1, j] + v * (table[i + 1, j + 1] - table[i + 1, j])
    rise = table[i, j + 1] - table[i, j]
    return low + u * (high - low), high - low, rise + u * (table[i + 1, j + 1] - table[i + 1, j] - rise)


@njit(**OPTIONS)
def angle_law(square, along, reynolds, c, angles):
    """What split_law returns, from C_D and C_L by Re and angle; reynolds: d / nu (s/m)."""
    n, s = max(np.sqrt(square), STILL), max(abs(along), STILL)
    side = 1.0 if along >= 0.0 else -1.0
    r2 = n * n + s * s
    r = np.sqrt(r2)
    i, u, by_log = _between(angles.reynolds, np.log(max(r * reynolds, STILL)))
    j, v, by_angle = _between(angles.angle, np.arctan2(n, s))
    drag, drag_u, drag_v = _grid(angles.drag, i, u, j, v)
    lift, lift_u, lift_v = _grid(angles.lift, i, u, j, v)
    # With D = C_D, L = C_L: c_n = c r (D n + L s) / n^2, c_t = c r (D s - L n) / s^2.
    drag_n, lift_n = _by_speed(
        n, s, r2, drag_u * by_log, drag_v * by_angle, lift_u * by_log, lift_v * by_angle
    )
    drag_s, lift_s = _by_speed(
        s, -n, r2, drag_u * by_log, drag_v * by_angle, lift_u * by_log, lift_v * by_angle
    )
    p, t = drag * n + lift * s, drag * s - lift * n
    p_n, p_s = drag_n * n + drag + lift_n * s, drag_s * n + lift_s * s + lift
    t_n, t_s = drag_n * s - lift_n * n - lift, drag_s * s + drag - lift_s * n
    inverse_n, inverse_s = 1.0 / (n * n), 1.0 / (s * s)
    cn, ct = c * r * p * inverse_n, c * r * t * inverse_s
    cn_n = c * (n / r * p + r * p_n - 2.0 * r * p / n) * inverse_n
    cn_s = c * (s / r * p + r * p_s) * inverse_n
    ct_n = c * (n / r * t + r * t_n) * inverse_s
    ct_s = c * (s / r * t + r * t_s - 2.0 * r * t / s) * inverse_s
    return cn, ct, 0.5 * cn_n / n, side * cn_s, 0.5 * ct_n / n, side * ct_s


@njit(**OPTIONS)
def _by_speed(one, other, r2, drag_log, drag_angle, lift_log, lift_angle):
    """Slopes of C_D and C_L by one of the speeds n, s: d ln r = one / r^2, d angle = (s, -n) / r^2."""
    turn = other / r2
    return drag_log * one / r2 + drag_angle * turn, lift_log * one / r2 + lift_angle * turn


@njit(**OPTIONS)
def coefficients_of_bars(x, rel, el, out):
    """Present c_n and c_t (kg/m2) of the bars and their four slopes into out (6, m).

    x: (n, 3) m; rel: (n, 3) m/s, the water against the knots.
    """
    curves, friction, angles = el.bar_curves, el.friction, el.angles
    by_angle = angles.reynolds.shape[0] > 0
    for e in range(out.shape[1]):
        a, b = el.knot_a[e], el.knot_b[e]
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        wx, wy, wz = (
            0.5 * (rel[a, 0] + rel[b, 0]),
            0.5 * (rel[a, 1] + rel[b, 1]),
            0.5 * (rel[a, 2] + rel[b, 2]),
        )
        square, along = flow_by_bar(dx, dy, dz, wx, wy, wz)
        c = el.normal_drag[e]
        if by_angle:
            law = angle_law(square, along, el.bar_reynolds[e], c, angles)
        else:
            law = split_law(square, along, c, np.int64(el.bar_curve[e]), curves, friction)
        for k in range(6):
            out[k, e] = law[k]


@njit(**OPTIONS)
def coefficients_of_knots(rel, el, drag, slope):
    """Present 1/2 rho C_D pi/4 d^2 (kg/m) of the knots into drag (n,), its slope by the speed squared into slope."""
    curves = el.knot_curves
    for i in range(rel.shape[0]):
        square = rel[i, 0] ** 2 + rel[i, 1] ** 2 + rel[i, 2] ** 2
        value, steep = knot_law(square, el.knot_curve[i], curves)
        drag[i], slope[i] = el.knot_drag[i] * value, el.knot_drag[i] * steep
