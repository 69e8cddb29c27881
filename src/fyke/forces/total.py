"""Total force on every knot: the hot loop of all explicit steppers.

Per knot, equations (1) to (6) of the panel model: F = tension + water + weight and buoyancy, with
    bar:   T t on end a, -T t on end b, T by the elastic law plus Kelvin-Voigt damping, never below zero;
           c_n L |w_n| w_n + c_t L |w_t| w_t on each end, w the velocity of the water relative to the bar's middle;
    knot:  1/2 rho C_D pi/4 d_k^2 |w| w.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .around import BLOCK, PITCH
from .compiled import OPTIONS
from .drag import bar_water_force
from .laws import LAW_ROWS, flow_by_bar, varies, vary, vary_knots
from .tension import law_tension

# Bars are taken in blocks that fit the first-level cache: gather, vector mathematics, scatter. Rows of the work array
# g, PITCH apart: difference of positions and water past the middle, which become the forces on both ends; rate;
# tension and its slope; Re^2 across and Re along a bar, or Re^2 of a knot, then the law; what laws work in.
RATE, TENSION, SLOPE, ACROSS, ALONG, LAW_WORK = 6, 9, 10, 11, 12, 13
WORK_ROWS = LAW_WORK + LAW_ROWS

# A bar of no length has no direction: this keeps the division finite and the direction zero (m).
TINY_LENGTH = 1e-300


@njit(**OPTIONS)
def knot_forces(v, u, el, rel, g, out, laws):
    """Weight and knot drag into out (n, 3) N; velocity of the water relative to the knot into rel (n, 3) m/s."""
    by_law = False
    if laws is not None:
        by_law = laws.knots.shape[0] > 0
        if by_law:
            _knot_laws(v, u, laws, g, out)
    for i in range(v.shape[0]):
        wx = u[i, 0] - v[i, 0]
        wy = u[i, 1] - v[i, 1]
        wz = u[i, 2] - v[i, 2]
        c = el.knot_drag[i] * np.sqrt(wx * wx + wy * wy + wz * wz)
        if by_law:
            c *= out[i, 0]
        rel[i, 0], rel[i, 1], rel[i, 2] = wx, wy, wz
        out[i, 0] = el.weight[i, 0] + c * wx
        out[i, 1] = el.weight[i, 1] + c * wy
        out[i, 2] = el.weight[i, 2] + c * wz


@njit(**OPTIONS)
def _knot_laws(v, u, laws, g, out):
    """Drag of the knots over that of Elements into the first column of out."""
    for start in range(0, v.shape[0], BLOCK):
        size = min(BLOCK, v.shape[0] - start)
        for i in range(size):
            k = start + i
            square = (u[k, 0] - v[k, 0]) ** 2 + (u[k, 1] - v[k, 1]) ** 2 + (u[k, 2] - v[k, 2]) ** 2
            g[ACROSS * PITCH + i] = square * laws.knot_reynolds[k] ** 2
        share = laws.knot_share, start
        vary_knots(0, size, g, ACROSS * PITCH, LAW_WORK * PITCH, share, laws.knots)
        for i in range(size):
            out[start + i, 0] = 1.0 - laws.knot_share[start + i] + g[ACROSS * PITCH + i]


@njit(**OPTIONS)
def total_force(x, v, u, el, rel, g, out, laws=None):
    """Force on every knot into out (n, 3) N.

    x, v, u: (n, 3) position m, velocity m/s, velocity of the water at the knots m/s; el: Elements; rel: (n, 3) and
    g: (WORK_ROWS x PITCH,) work arrays; laws: DragLaws, or None where Elements say it all.
    """
    knot_forces(v, u, el, rel, g, out, laws)
    m = el.knot_a.shape[0]
    for start in range(0, m, BLOCK):
        size = min(BLOCK, m - start)
        for i in range(size):
            a = el.knot_a[start + i]
            b = el.knot_b[start + i]
            for q in range(3):
                g[q * PITCH + i] = x[b, q] - x[a, q]
                g[(3 + q) * PITCH + i] = 0.5 * (rel[a, q] + rel[b, q])
        if el.damped:
            for i in range(size):
                a = el.knot_a[start + i]
                b = el.knot_b[start + i]
                for q in range(3):
                    g[(RATE + q) * PITCH + i] = v[b, q] - v[a, q]
        if not el.linear:
            _law_of_block(start, size, el, g)
        drags = el.normal_drag, start, el.tangential_drag, start
        if laws is not None:
            if varies(laws.bars):
                _drag_of_block(start, size, el, laws, g)
                drags = g, ACROSS * PITCH, g, ALONG * PITCH
        _forces_of_block(start, size, el, drags, g)
        for i in range(size):
            a = el.knot_a[start + i]
            b = el.knot_b[start + i]
            for q in range(3):
                out[a, q] += g[q * PITCH + i]
                out[b, q] += g[(3 + q) * PITCH + i]


@njit(**OPTIONS)
def _forces_of_block(start, size, el, drags, g):
    """Forces (N) on the first ends of bars into rows 0 to 2 of g, on their far ends into 3 to 5.

    drags: c_n and c_t (kg/m2), each an array and the place in it of the first bar's.
    """
    cn, cn_at, ct, ct_at = drags
    for i in range(size):
        e = start + i
        dx, dy, dz = g[i], g[PITCH + i], g[2 * PITCH + i]
        length = np.sqrt(dx * dx + dy * dy + dz * dz)
        inverse = 1.0 / max(length, TINY_LENGTH)
        tx, ty, tz = dx * inverse, dy * inverse, dz * inverse
        fx, fy, fz = bar_water_force(
            g[3 * PITCH + i],
            g[4 * PITCH + i],
            g[5 * PITCH + i],
            tx,
            ty,
            tz,
            cn[cn_at + i] * length,
            ct[ct_at + i] * length,
        )
        stretch = length - el.rest_length[e]
        if el.linear:
            tension = el.stiffness[e] * stretch
            slope = el.stiffness[e]
        else:
            tension = g[TENSION * PITCH + i]
            slope = g[SLOPE * PITCH + i]
        if el.damped:
            rate = g[RATE * PITCH + i] * tx + g[(RATE + 1) * PITCH + i] * ty + g[(RATE + 2) * PITCH + i] * tz
            tension += el.damping_time[e] * slope * rate
        tension = max(tension, 0.0) if stretch > 0.0 else 0.0
        px, py, pz = tension * tx, tension * ty, tension * tz
        g[i], g[PITCH + i], g[2 * PITCH + i] = fx + px, fy + py, fz + pz
        g[3 * PITCH + i], g[4 * PITCH + i], g[5 * PITCH + i] = fx - px, fy - py, fz - pz


@njit(**OPTIONS)
def _law_of_block(start, size, el, g):
    """Tension (N) into TENSION and slope dT/dl (N/m) into SLOPE by laws that are not all linear."""
    for i in range(size):
        e = start + i
        length = np.sqrt(g[i] ** 2 + g[PITCH + i] ** 2 + g[2 * PITCH + i] ** 2)
        strain = length / el.rest_length[e] - 1.0
        g[TENSION * PITCH + i] = 0.0
        g[SLOPE * PITCH + i] = 0.0
        if strain > 0.0:
            tension, slope = law_tension(strain, el.law_rows, el.law_first[e], el.law_end[e])
            g[TENSION * PITCH + i] = tension
            g[SLOPE * PITCH + i] = slope / el.rest_length[e]


@njit(**OPTIONS)
def _drag_of_block(start, size, el, laws, g):
    """Coefficients c_n and c_t (kg/m2) by their laws into ACROSS and ALONG."""
    for i in range(size):
        r = laws.bar_reynolds[start + i]
        g[ACROSS * PITCH + i], g[ALONG * PITCH + i] = flow_by_bar(
            g[i],
            g[PITCH + i],
            g[2 * PITCH + i],
            r * g[3 * PITCH + i],
            r * g[4 * PITCH + i],
            r * g[5 * PITCH + i],
        )
    reference = el.normal_drag, start, el.tangential_drag, start
    vary(0, size, g, (ACROSS * PITCH, ALONG * PITCH), LAW_WORK * PITCH, reference, laws.bars)


def work_arrays(knots: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the work arrays of total_force for so many knots."""
    return np.zeros((knots, 3)), np.zeros(WORK_ROWS * PITCH)
