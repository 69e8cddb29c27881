"""Force of the water on one bar: normal and tangential part, and its tangent.

On each end, with w the velocity of the water relative to the bar's middle and t the unit vector along it,
    F = L (c_n |n| n + c_t |s| s t),   s = w.t,  n = w - s t,
c = 1/4 rho C d (kg/m2): half of 1/2 rho C d L. Choo & Casarella 1971 use the same split; it holds for any coefficient
law, because the laws (forces.laws) only change c_n and c_t.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .compiled import OPTIONS


@njit(**OPTIONS)
def bar_water_force(wx, wy, wz, tx, ty, tz, cn, ct):
    """Force per length (N/m) of one end: three components."""
    s = wx * tx + wy * ty + wz * tz
    nx, ny, nz = wx - s * tx, wy - s * ty, wz - s * tz
    qn = cn * np.sqrt(nx * nx + ny * ny + nz * nz)
    qt = ct * abs(s) * s
    return qn * nx + qt * tx, qn * ny + qt * ty, qn * nz + qt * tz


@njit(**OPTIONS)
def bar_water_tangents(w, t, law, length, turn, press):
    """Tangents of one end's force: dF/d(x_b - x_a) into turn N/m, dF/dw into press N s/m, both (3, 3); w, t: (3,).

    law: c_n, c_t and their slopes as forces.laws gives them. F = L g(t) gives dF = g t^T + dg/dt (I - t t^T), with
    dg/dt = c_n (|n| I + n n^T/|n|) (-(t w^T + s I)) + c_t (2 |s| t w^T + |s| s I);
    dF/dw = L (c_n (|n| (I - t t^T) + n n^T/|n|) + 2 c_t |s| t t^T). With the square q = |n|^2 the slopes add
    (c_n,s - 2 s c_n,q) |n| n n^T + (c_t,s - 2 s c_t,q) |s| s t n^T to the first, and to the second
    L (|n| n (2 c_n,q n + c_n,s t)^T + |s| s t (2 c_t,q n + c_t,s t)^T).
    """
    cn, ct, cn_q, cn_s, ct_q, ct_s = law
    s = w[0] * t[0] + w[1] * t[1] + w[2] * t[2]
    n0, n1, n2 = w[0] - s * t[0], w[1] - s * t[1], w[2] - s * t[2]
    size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    inverse = 1.0 / size if size > 0.0 else 0.0
    n = (n0, n1, n2)
    g = bar_water_force(w[0], w[1], w[2], t[0], t[1], t[2], cn, ct)
    speed = abs(s)
    # (|n| I + n n^T/|n|) t = |n| t because n is normal to t.
    for p in range(3):
        row0 = row1 = row2 = 0.0
        for q in range(3):
            identity = 1.0 if p == q else 0.0
            nn, tt = n[p] * n[q], t[p] * t[q]
            dg = -cn * (size * t[p] * w[q] + s * (size * identity + nn * inverse))
            dg += ct * speed * (2.0 * t[p] * w[q] + s * identity)
            row0 += dg * ((1.0 if q == 0 else 0.0) - t[q] * t[0])
            row1 += dg * ((1.0 if q == 1 else 0.0) - t[q] * t[1])
            row2 += dg * ((1.0 if q == 2 else 0.0) - t[q] * t[2])
            drag = cn * (size * (identity - tt) + nn * inverse) + 2.0 * ct * speed * tt
            press[p, q] = length * drag
        turn[p, 0], turn[p, 1], turn[p, 2] = g[p] * t[0] + row0, g[p] * t[1] + row1, g[p] * t[2] + row2
    if cn_q == 0.0 and cn_s == 0.0 and ct_q == 0.0 and ct_s == 0.0:
        return
    turn_n, turn_t = (cn_s - 2.0 * s * cn_q) * size, (ct_s - 2.0 * s * ct_q) * speed * s
    for q in range(3):
        by_n, by_t = size * (2.0 * cn_q * n[q] + cn_s * t[q]), speed * s * (2.0 * ct_q * n[q] + ct_s * t[q])
        for p in range(3):
            turn[p, q] += (turn_n * n[p] + turn_t * t[p]) * n[q]
            press[p, q] += length * (by_n * n[p] + by_t * t[p])
