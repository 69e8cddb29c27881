"""Interior-point steps on second-order cones: the far field of statics.

A bar of elongation allowance s has Y = (l0 + s, d), d = x_b - x_a, and its dual Z = (T, q); both lie in the
second-order cone {(y0, y1): y0 >= |y1|}. Equilibrium under dead load is the convex program
    min  sum phi(s) - load.x,  Y in the cone,  with T = phi'(s) = f(s), q = -T d/(l0 + s) and Y o Z = 0,
whose constraint is linear in x: a rotating bar makes no false stretch. Scaling, search direction and corrector are
those of Nesterov & Todd 1997 and Mehrotra 1992 as set out for cone programs by Vandenberghe, The CVXOPT linear and
quadratic cone program solvers (2010). Two-way bars are no cones (solve.two_way): Z, dY and dZ of theirs stay zero.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ..forces.compiled import OPTIONS
from ..forces.total import TINY_LENGTH


@njit(**OPTIONS)
def _cone_norm(y):
    """Return sqrt(y0^2 - |y1|^2) of one point inside the cone."""
    r = np.sqrt(y[1] * y[1] + y[2] * y[2] + y[3] * y[3])
    return np.sqrt((y[0] - r) * (y[0] + r))


@njit(**OPTIONS)
def _scale(s, v, forward, out):
    """Scale one vector v (4,) by W, or by its inverse; s: (5,), eta and the unit vector of the scaling point."""
    eta = s[0] if forward else 1.0 / s[0]
    sign = 1.0 if forward else -1.0
    d = s[2] * v[1] + s[3] * v[2] + s[4] * v[3]
    c = sign * v[0] + d / (1.0 + s[1])
    out[0] = eta * (s[1] * v[0] + sign * d)
    for q in range(1, 4):
        out[q] = eta * (v[q] + c * s[1 + q])


@njit(**OPTIONS)
def scaling_point(Y, Z, two_way, scaling, scaled):
    """Nesterov-Todd scaling of every bar into scaling (m, 5), scaled point W Z = W^-1 Y into scaled (m, 4)."""
    for e in range(Y.shape[0]):
        if two_way[e]:
            continue
        ny, nz = _cone_norm(Y[e]), _cone_norm(Z[e])
        dot = 0.0
        for q in range(4):
            dot += Y[e, q] * Z[e, q]
        g = 2.0 * np.sqrt(0.5 * (1.0 + dot / (ny * nz)))
        scaling[e, 0] = np.sqrt(ny / nz)
        scaling[e, 1] = (Y[e, 0] / ny + Z[e, 0] / nz) / g
        for q in range(1, 4):
            scaling[e, 1 + q] = (Y[e, q] / ny - Z[e, q] / nz) / g
        _scale(scaling[e], Z[e], True, scaled[e])


@njit(**OPTIONS)
def cone_stiffness(scaling, k, two_way, block, row):
    """Stiffness of every bar with its allowance s eliminated, block (m, 3, 3) N/m, and row (m, 4) N/m.

    With M = W^-2: row = (k + M00, M01), block = M11 - M01 M01^T / (k + M00).
    """
    for e in range(k.shape[0]):
        if two_way[e]:
            continue
        inverse = 1.0 / scaling[e, 0] ** 2
        w0 = scaling[e, 1]
        pivot = k[e] + inverse * (2.0 * w0 * w0 - 1.0)
        row[e, 0] = pivot
        c = 2.0 * (k[e] - inverse) / pivot
        for p in range(3):
            row[e, 1 + p] = -2.0 * inverse * w0 * scaling[e, 2 + p]
            for q in range(3):
                identity = 1.0 if p == q else 0.0
                block[e, p, q] = inverse * (identity + c * scaling[e, 2 + p] * scaling[e, 2 + q])


@njit(**OPTIONS)
def cone_target(scaling, scaled, centre, cross, two_way, target):
    """Dual change without motion, W^-1 u, into target (m, 4); l o u = centre e - l o l - cross, l the scaled point."""
    d = np.zeros(4)
    for e in range(scaled.shape[0]):
        if two_way[e]:
            continue
        l0, l1, l2, l3 = scaled[e]
        square = l1 * l1 + l2 * l2 + l3 * l3
        r = np.sqrt(square)
        d[0] = centre - (l0 * l0 + square) - cross[e, 0]
        for q in range(1, 4):
            d[q] = -2.0 * l0 * scaled[e, q] - cross[e, q]
        d[0] = (l0 * d[0] - (l1 * d[1] + l2 * d[2] + l3 * d[3])) / ((l0 - r) * (l0 + r))
        for q in range(1, 4):
            d[q] = (d[q] - scaled[e, q] * d[0]) / l0
        _scale(scaling[e], d, False, target[e])


@njit(**OPTIONS)
def cone_right_side(load, Z, f, target, row, el, free, push, total, out):
    """Load less dual force with its change push (m, 3) N, on the free knots, into out (3 n_free,) N."""
    total[:] = load
    for e in range(Z.shape[0]):
        if el.two_way[e]:
            continue
        a, b = el.knot_a[e], el.knot_b[e]
        c = (target[e, 0] + Z[e, 0] - f[e]) / row[e, 0]
        for q in range(3):
            push[e, q] = target[e, 1 + q] - row[e, 1 + q] * c
            force = Z[e, 1 + q] + push[e, q]
            total[a, q] -= force
            total[b, q] += force
    for i in range(free.shape[0]):
        for q in range(3):
            out[3 * i + q] = total[free[i], q]


@njit(**OPTIONS)
def cone_changes(dx, Z, f, k, target, row, push, block, el, dY, dZ):
    """Changes dY and dZ (m, 4) of every bar for a motion dx (n, 3) m."""
    for e in range(Z.shape[0]):
        if el.two_way[e]:
            continue
        a, b = el.knot_a[e], el.knot_b[e]
        coupling = 0.0
        for q in range(3):
            dY[e, 1 + q] = dx[b, q] - dx[a, q]
            coupling += row[e, 1 + q] * dY[e, 1 + q]
        dY[e, 0] = (target[e, 0] + Z[e, 0] - f[e] - coupling) / row[e, 0]
        dZ[e, 0] = f[e] + k[e] * dY[e, 0] - Z[e, 0]
        for p in range(3):
            change = push[e, p]
            for q in range(3):
                change -= block[e, p, q] * dY[e, 1 + q]
            dZ[e, 1 + p] = change


@njit(**OPTIONS)
def cone_cross(scaling, dY, dZ, factor, two_way, cross):
    """Second-order term factor (W^-1 dY) o (W dZ) of the corrector into cross (m, 4)."""
    y, z = np.zeros(4), np.zeros(4)
    for e in range(dY.shape[0]):
        if two_way[e]:
            continue
        _scale(scaling[e], dY[e], False, y)
        _scale(scaling[e], dZ[e], True, z)
        cross[e, 0] = factor * (y[0] * z[0] + y[1] * z[1] + y[2] * z[2] + y[3] * z[3])
        for q in range(1, 4):
            cross[e, q] = factor * (y[0] * z[q] + z[0] * y[q])


@njit(**OPTIONS)
def cone_step(Y, dY):
    """Return the longest step along dY that keeps every Y in its cone, at most 1e30."""
    longest = 1e30
    for e in range(Y.shape[0]):
        y, d = Y[e], dY[e]
        r = np.sqrt(y[1] * y[1] + y[2] * y[2] + y[3] * y[3])
        c = (y[0] - r) * (y[0] + r)
        b = y[0] * d[0] - y[1] * d[1] - y[2] * d[2] - y[3] * d[3]
        a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2] - d[3] * d[3]
        # First positive root of c + 2 b s + a s^2; none when the ray stays inside.
        square = b * b - a * c
        if square >= 0.0:
            root = np.sqrt(square)
            if b < 0.0:
                longest = min(longest, c / (root - b))
            elif a < 0.0:
                longest = min(longest, -(b + root) / a)
        if d[0] < 0.0:
            longest = min(longest, -y[0] / d[0])
    return longest


@njit(**OPTIONS)
def cone_turn(Y, dY):
    """Return the largest motion of a bar's end across the bar over its allowed length, about its rotation (rad)."""
    square = 0.0
    for e in range(Y.shape[0]):
        along = across = length = 0.0
        for q in range(1, 4):
            along += Y[e, q] * dY[e, q]
            across += dY[e, q] * dY[e, q]
            length += Y[e, q] * Y[e, q]
        across -= along * along / max(length, TINY_LENGTH)
        square = max(square, across / (Y[e, 0] * Y[e, 0]))
    return np.sqrt(square)


@njit(**OPTIONS)
def cone_product(Y, Z, dY, dZ, step, count):
    """Mean over a count of one-way bars of (Y + step dY).(Z + step dZ), N m."""
    total = 0.0
    for e in range(Y.shape[0]):
        for q in range(4):
            total += (Y[e, q] + step * dY[e, q]) * (Z[e, q] + step * dZ[e, q])
    return total / count


@njit(**OPTIONS)
def smallest_gap(Y, rest_length):
    """Return the smallest (y0 - |y1|) / l0 of all bars."""
    gap = 1e30
    for e in range(Y.shape[0]):
        r = np.sqrt(Y[e, 1] * Y[e, 1] + Y[e, 2] * Y[e, 2] + Y[e, 3] * Y[e, 3])
        gap = min(gap, (Y[e, 0] - r) / rest_length[e])
    return gap
