"""Interior-point steps on tension and slack: the near field of statics.

Unknowns x and, for every bar, T > 0 and w > 0 with w = T - f(e), T w = mu -> 0; f is the elastic law, e the
elongation, linearised at every step. Predictor and corrector after Mehrotra 1992; the corrector carries the elongation
that the predicted motion makes beyond its linear part. A two-way bar has T = f(e) of either sign and w = 0.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ..forces.bars import add_tension
from ..forces.compiled import OPTIONS


@njit(**OPTIONS)
def path_stiffness(T, w, k, t, length, two_way, along, block):
    """Stiffness T k/(w + T) of every bar along itself into along (m,) N/m; with T/L across it into block (m, 3, 3)."""
    for e in range(T.shape[0]):
        along[e] = k[e] if two_way[e] else T[e] * k[e] / (w[e] + T[e])
        across = T[e] / length[e]
        for p in range(3):
            for q in range(3):
                block[e, p, q] = (along[e] - across) * t[e, p] * t[e, q] + (across if p == q else 0.0)


@njit(**OPTIONS)
def path_target(mu, T, w, r, cross, two_way, target):
    """Tension change without motion into target (m,) N; r = w - T + f(e), cross: predictor's dT dw (N2)."""
    for e in range(T.shape[0]):
        if two_way[e]:
            target[e] = r[e]
        else:
            target[e] = (mu - T[e] * w[e] - cross[e] + T[e] * r[e]) / (w[e] + T[e])


@njit(**OPTIONS)
def path_right_side(load, T, target, el, t, free, total, out):
    """Load and tension T + target on the free knots, into out (3 n_free,) N."""
    total[:] = load
    add_tension(T + target, el, t, total)
    for i in range(free.shape[0]):
        for q in range(3):
            out[3 * i + q] = total[free[i], q]


@njit(**OPTIONS)
def bar_changes(dx, along, k, r, target, el, t, de, dT, dw):
    """Elongation de, tension dT and slack dw of every bar for a motion dx (n, 3) m; return the largest rotation.

    dT = target + along de, dw = dT - k de - r.
    """
    rotation = 0.0
    for e in range(along.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        d0, d1, d2 = dx[b, 0] - dx[a, 0], dx[b, 1] - dx[a, 1], dx[b, 2] - dx[a, 2]
        stretch = d0 * t[e, 0] + d1 * t[e, 1] + d2 * t[e, 2]
        across = np.sqrt(max(d0 * d0 + d1 * d1 + d2 * d2 - stretch * stretch, 0.0))
        rotation = max(rotation, across / el.rest_length[e])
        de[e] = stretch
        dT[e] = target[e] + along[e] * stretch
        dw[e] = dT[e] - k[e] * stretch - r[e]
    return rotation


@njit(**OPTIONS)
def path_step(T, w, dT, dw, two_way):
    """Return the longest step that keeps T and w of every one-way bar from becoming negative, at most 1e30."""
    longest = 1e30
    for e in range(T.shape[0]):
        if two_way[e]:
            continue
        if dT[e] < 0.0:
            longest = min(longest, -T[e] / dT[e])
        if dw[e] < 0.0:
            longest = min(longest, -w[e] / dw[e])
    return longest


@njit(**OPTIONS)
def path_product(T, w, dT, dw, step, count):
    """Mean of (T + step dT)(w + step dw) over a count of one-way bars, N2; of two-way bars it is zero."""
    total = 0.0
    for e in range(T.shape[0]):
        total += (T[e] + step * dT[e]) * (w[e] + step * dw[e])
    return total / count


@njit(**OPTIONS)
def second_order(x, dx, de, step, el, length, k, r, out):
    """Residual r with the elongation that a motion step dx makes beyond its linear part, into out (m,) N."""
    for e in range(r.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        d0 = x[b, 0] - x[a, 0] + step * (dx[b, 0] - dx[a, 0])
        d1 = x[b, 1] - x[a, 1] + step * (dx[b, 1] - dx[a, 1])
        d2 = x[b, 2] - x[a, 2] + step * (dx[b, 2] - dx[a, 2])
        out[e] = r[e] + k[e] * (np.sqrt(d0 * d0 + d1 * d1 + d2 * d2) - length[e] - step * de[e])
