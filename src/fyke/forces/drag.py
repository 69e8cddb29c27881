"""Force of the water on one bar: normal and tangential part, and its tangent.

On each end, with w the velocity of the water relative to the bar's middle and t the unit vector along it,
    F = L (c_n |n| n + c_t |s| s t),   s = w.t,  n = w - s t,
c = 1/4 rho C d (kg/m2): half of 1/2 rho C d L. Choo & Casarella 1971 use the same split; it holds for any coefficient
law, because the laws only change c_n and c_t.
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
def bar_water_tangent(w, t, cn, ct, out):
    """Tangent dF/d(x_b - x_a) of one end's force into out (3, 3) N/m; w, t: (3,).

    F = L g(t) gives dF = g t^T + dg/dt (I - t t^T), with
    dg/dt = c_n (|n| I + n n^T / |n|) (-(t w^T + s I)) + c_t (2 |s| t w^T + |s| s I).
    """
    s = w[0] * t[0] + w[1] * t[1] + w[2] * t[2]
    n0, n1, n2 = w[0] - s * t[0], w[1] - s * t[1], w[2] - s * t[2]
    size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    inverse = 1.0 / size if size > 0.0 else 0.0
    n = (n0, n1, n2)
    g = bar_water_force(w[0], w[1], w[2], t[0], t[1], t[2], cn, ct)
    # (|n| I + n n^T/|n|) t = |n| t because n is normal to t.
    for p in range(3):
        row0 = row1 = row2 = 0.0
        for q in range(3):
            identity = 1.0 if p == q else 0.0
            dg = -cn * (size * t[p] * w[q] + s * (size * identity + n[p] * n[q] * inverse))
            dg += ct * abs(s) * (2.0 * t[p] * w[q] + s * identity)
            row0 += dg * ((1.0 if q == 0 else 0.0) - t[q] * t[0])
            row1 += dg * ((1.0 if q == 1 else 0.0) - t[q] * t[1])
            row2 += dg * ((1.0 if q == 2 else 0.0) - t[q] * t[2])
        out[p, 0] = g[p] * t[0] + row0
        out[p, 1] = g[p] * t[1] + row1
        out[p, 2] = g[p] * t[2] + row2
