"""Tangents of the force of the water on faces, and their places in a sparse matrix.

With k = C_D - c^2 C_L / (c s) and m = c C_L / (c s), which depend on c, ln A and ln V alone, and unit vectors e of w
and n of N, the force of screen_faces is F = r A V^2 (k e + m n), r = 1/2 rho. Hence
    dF/dw = r A V (k I + e (k + k_V - c k_c) e^T + e k_c n^T + n (2 m + m_V - c m_c) e^T + n m_c n^T),
    dF/dN = r V^2 (m I + e (k + k_A - c k_c) n^T + e k_c e^T + n (m_A - c m_c) n^T + n m_c e^T).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numba.extending import register_jitable

from ..water.laws.panels import blunt
from .compiled import OPTIONS, WITHIN
from .screen_faces import GRAZING, TINY, gather, local_solidity
from .screen_laws import screen

# Imaginary step that carries derivatives through the formula of a law; its square is below the rounding of anything.
_STEP = 1e-30


@register_jitable(**WITHIN)
def _slopes(law, c, sn, sn_by_area, re, out):
    """Write k and m and their derivatives with c, ln A and ln V into the rows of out (4, 2)."""
    sine = np.sqrt(max(1.0 - c * c, 0.0))
    edge = blunt(complex(abs(c), _STEP), GRAZING)
    turn = -abs(c) / sine if sine > 0.0 else 0.0
    drag, lift = screen(law, edge.real, sine, sn, re)
    out[0, 0], out[0, 1] = drag - c * c * lift, c * lift
    for row in range(1, 4):
        by_c = 1.0 if row == 1 else 0.0
        by_area = _STEP if row == 2 else 0.0
        by_speed = _STEP if row == 3 else 0.0
        change = screen(
            law,
            complex(edge.real, edge.imag * by_c),
            complex(sine, turn * by_c * _STEP),
            complex(sn, sn_by_area * by_area),
            complex(re, re * by_speed),
        )
        drag_by, lift_by = change[0].imag / _STEP, change[1].imag / _STEP
        out[row, 0], out[row, 1] = drag_by - c * c * lift_by, c * lift_by
    # The row of c is by |c| so far, and C_L / (c s) stood still in it where c stands by itself.
    if c < 0.0:
        out[1, 0], out[1, 1] = -out[1, 0], -out[1, 1]
    out[1, 0] -= 2.0 * c * lift
    out[1, 1] += lift


@njit(**OPTIONS)
def screen_tangents(x, rel, screens, law, wet, by_area, by_speed):
    """Tangents of the force on every face, dF/dN (p, 3, 3) Pa and dF/dw (p, 3, 3) N s/m, at this wetness."""
    n, e, s, g = np.zeros(3), np.zeros(3), np.zeros((4, 2)), np.zeros((6, 1))
    for i in range(screens.solid.shape[0]):
        gather(i, 1, x, rel, screens, g)
        area, speed = 0.0, 0.0
        for q in range(3):
            area += g[q, 0] ** 2
            speed += g[3 + q, 0] ** 2
        area, speed = np.sqrt(area), np.sqrt(speed)
        c = 0.0
        for q in range(3):
            n[q] = g[q, 0] / max(area, TINY)
            e[q] = g[3 + q, 0] / max(speed, TINY)
            c += n[q] * e[q]
        sn, sn_by_area = local_solidity(screens.solid[i], area, 1.0 / max(area, TINY))
        _slopes(law, c, sn, sn_by_area, screens.twine[i] * speed, s)
        k, m = s[0, 0], s[0, 1]
        for p in range(3):
            along = e[p] * (k + s[3, 0] - c * s[1, 0]) + n[p] * (2.0 * m + s[3, 1] - c * s[1, 1])
            across = e[p] * (k + s[2, 0] - c * s[1, 0]) + n[p] * (s[2, 1] - c * s[1, 1])
            both = e[p] * s[1, 0] + n[p] * s[1, 1]
            for q in range(3):
                identity = 1.0 if p == q else 0.0
                by_speed[i, p, q] = area * speed * (k * identity + along * e[q] + both * n[q])
                by_area[i, p, q] = speed * speed * (m * identity + across * n[q] + both * e[q])
                by_speed[i, p, q] *= screens.half_density * wet[i]
                by_area[i, p, q] *= screens.half_density * wet[i]


@register_jitable(**WITHIN)
def _turns(f, x, by_area, screens, out):
    """Tangent -dF/dx of one face by each of its corners into out (4, 3, 3) N/m.

    Corner a moves N = 1/2 (x_c - x_a) x (x_d - x_b) by 1/2 (x_d - x_b) x dx, b by -1/2 (x_c - x_a) x dx, and c and d
    the other way.
    """
    for corner in range(2):
        start, end = screens.corners[f, 1 - corner], screens.corners[f, 3 - corner]
        half = 0.5 if corner == 0 else -0.5
        a, b, c = x[end, 0] - x[start, 0], x[end, 1] - x[start, 1], x[end, 2] - x[start, 2]
        for p in range(3):
            t = by_area[f, p]
            out[corner, p, 0] = half * (t[2] * b - t[1] * c)
            out[corner, p, 1] = half * (t[0] * c - t[2] * a)
            out[corner, p, 2] = half * (t[1] * a - t[0] * b)
            for q in range(3):
                out[corner + 2, p, q] = -out[corner, p, q]


@njit(**OPTIONS)
def assemble_screens(x, tangents, c0, c1, screens, symmetric, places, data):
    """Add c0 (-dF/dx) + c1 (-dF/dv) of all faces, or its symmetric part alone, to the data of a sparse matrix.

    tangents: both of screen_tangents; places: start (p, 4, 4) and stride (p, 4) of the blocks, rows before columns, as
    in solve.pattern.
    """
    by_area, by_speed = tangents
    start, stride = places
    turn, block = np.zeros((4, 3, 3)), np.zeros((12, 12))
    for f in range(screens.solid.shape[0]):
        _turns(f, x, by_area, screens, turn)
        for i in range(4):
            for k in range(4):
                for p in range(3):
                    for q in range(3):
                        drag = c1 * screens.share[f, k] * by_speed[f, p, q]
                        block[3 * i + p, 3 * k + q] = screens.share[f, i] * (c0 * turn[k, p, q] + drag)
        for i in range(4):
            for k in range(4):
                place = start[f, i, k]
                if place < 0:
                    continue
                for q in range(3):
                    for p in range(3):
                        value = block[3 * i + p, 3 * k + q]
                        if symmetric:
                            value = 0.5 * (value + block[3 * k + q, 3 * i + p])
                        data[place + q * stride[f, k] + p] += value
