"""Total force on every knot: the hot loop of all explicit steppers.

Per knot, equations (1) to (6) of the panel model: F = tension + water + weight and buoyancy, with
    bar:   T t on end a, -T t on end b, T by the elastic law plus Kelvin-Voigt damping, never below zero;
           c_n L |w_n| w_n + c_t L |w_t| w_t on each end, w the velocity of the water relative to the bar's middle;
    knot:  1/2 rho C_D pi/4 d_k^2 |w| w.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .compiled import OPTIONS
from .drag import bar_water_force
from .laws import flow_by_bar, knot_law, vary
from .tension import law_tension

# Bars are taken in blocks that fit the first-level cache: gather, vector mathematics, scatter.
BLOCK = 256

# A bar of no length has no direction: this keeps the division finite and the direction zero (m).
TINY_LENGTH = 1e-300


@njit(**OPTIONS)
def knot_forces(v, u, el, rel, out):
    """Weight and knot drag into out (n, 3) N; velocity of the water relative to the knot into rel (n, 3) m/s."""
    curves = el.knot_curves
    for i in range(v.shape[0]):
        wx = u[i, 0] - v[i, 0]
        wy = u[i, 1] - v[i, 1]
        wz = u[i, 2] - v[i, 2]
        square = wx * wx + wy * wy + wz * wz
        c = el.knot_drag[i] * np.sqrt(square)
        if not el.plain:
            c *= knot_law(square, el.knot_curve[i], curves)[0]
        rel[i, 0], rel[i, 1], rel[i, 2] = wx, wy, wz
        out[i, 0] = el.weight[i, 0] + c * wx
        out[i, 1] = el.weight[i, 1] + c * wy
        out[i, 2] = el.weight[i, 2] + c * wz


@njit(**OPTIONS)
def total_force(x, v, u, el, rel, g, out):
    """Force on every knot into out (n, 3) N.

    x, v, u: (n, 3) position m, velocity m/s, velocity of the water at the knots m/s; el: Elements; rel: (n, 3) and
    g: (16, BLOCK) work arrays.
    """
    knot_forces(v, u, el, rel, out)
    m = el.knot_a.shape[0]
    for start in range(0, m, BLOCK):
        size = min(BLOCK, m - start)
        for i in range(size):
            a = el.knot_a[start + i]
            b = el.knot_b[start + i]
            g[0, i] = x[b, 0] - x[a, 0]
            g[1, i] = x[b, 1] - x[a, 1]
            g[2, i] = x[b, 2] - x[a, 2]
            g[3, i] = 0.5 * (rel[a, 0] + rel[b, 0])
            g[4, i] = 0.5 * (rel[a, 1] + rel[b, 1])
            g[5, i] = 0.5 * (rel[a, 2] + rel[b, 2])
        if el.damped:
            for i in range(size):
                a = el.knot_a[start + i]
                b = el.knot_b[start + i]
                g[6, i] = v[b, 0] - v[a, 0]
                g[7, i] = v[b, 1] - v[a, 1]
                g[8, i] = v[b, 2] - v[a, 2]
        if not el.linear:
            _law_of_block(start, size, el, g)
        _drag_of_block(start, size, el, g)
        for i in range(size):
            e = start + i
            dx, dy, dz = g[0, i], g[1, i], g[2, i]
            length = np.sqrt(dx * dx + dy * dy + dz * dz)
            inverse = 1.0 / max(length, TINY_LENGTH)
            tx, ty, tz = dx * inverse, dy * inverse, dz * inverse
            fx, fy, fz = bar_water_force(
                g[3, i], g[4, i], g[5, i], tx, ty, tz, g[11, i] * length, g[12, i] * length
            )
            stretch = length - el.rest_length[e]
            if el.linear:
                tension = el.stiffness[e] * stretch
                slope = el.stiffness[e]
            else:
                tension = g[9, i]
                slope = g[10, i]
            if el.damped:
                tension += el.damping_time[e] * slope * (g[6, i] * tx + g[7, i] * ty + g[8, i] * tz)
            tension = max(tension, 0.0) if stretch > 0.0 else 0.0
            g[0, i], g[1, i], g[2, i] = fx + tension * tx, fy + tension * ty, fz + tension * tz
            g[3, i], g[4, i], g[5, i] = fx - tension * tx, fy - tension * ty, fz - tension * tz
        for i in range(size):
            a = el.knot_a[start + i]
            b = el.knot_b[start + i]
            out[a, 0] += g[0, i]
            out[a, 1] += g[1, i]
            out[a, 2] += g[2, i]
            out[b, 0] += g[3, i]
            out[b, 1] += g[4, i]
            out[b, 2] += g[5, i]


@njit(**OPTIONS)
def _law_of_block(start, size, el, g):
    """Tension (N) into g[9] and slope dT/dl (N/m) into g[10] by laws that are not all linear."""
    for i in range(size):
        e = start + i
        length = np.sqrt(g[0, i] ** 2 + g[1, i] ** 2 + g[2, i] ** 2)
        strain = length / el.rest_length[e] - 1.0
        g[9, i] = 0.0
        g[10, i] = 0.0
        if strain > 0.0:
            tension, slope = law_tension(strain, el.law_rows, el.law_first[e], el.law_end[e])
            g[9, i] = tension
            g[10, i] = slope / el.rest_length[e]


@njit(**OPTIONS)
def _drag_of_block(start, size, el, g):
    """Coefficients c_n and c_t (kg/m2) of the drag into g[11] and g[12]."""
    if el.plain:
        for i in range(size):
            g[11, i] = el.normal_drag[start + i]
            g[12, i] = el.tangential_drag[start + i]
        return
    for i in range(size):
        square, along = flow_by_bar(g[0, i], g[1, i], g[2, i], g[3, i], g[4, i], g[5, i])
        g[11, i] = square
        g[12, i] = along
        g[13, i] = el.normal_drag[start + i]
        g[14, i] = el.bar_curve[start + i]
        g[15, i] = el.bar_reynolds[start + i]
    vary(0, size, g, 11 * BLOCK, 12 * BLOCK, g, (13 * BLOCK, 14 * BLOCK, 15 * BLOCK), el)


def work_arrays(knots: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the work arrays of total_force for so many knots."""
    return np.zeros((knots, 3)), np.zeros((16, BLOCK))
