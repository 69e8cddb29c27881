"""Bars in the water: geometry, elastic law with slope, load of the water, stiffness.

The pieces of statics and of implicit dynamics. The law is continued into the slack range because their methods need its
slope there; the tension itself stays zero.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..system.elements import Elements
from .compiled import OPTIONS
from .drag import bar_water_force, bar_water_tangents
from .tension import law_tension
from .total import TINY_LENGTH


@njit(**OPTIONS)
def bar_geometry(x, el, t, length):
    """Unit vector of every bar into t (m, 3), length into length (m,) m."""
    for e in range(length.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        size = np.sqrt(dx * dx + dy * dy + dz * dz)
        inverse = 1.0 / max(size, TINY_LENGTH)
        t[e, 0], t[e, 1], t[e, 2] = dx * inverse, dy * inverse, dz * inverse
        length[e] = size


@njit(**OPTIONS)
def elastic(stretch, el, f, k):
    """Law f (m,) N at a stretch l - l0 (m,) m, continued as an odd function where slack, and its slope k (m,) N/m."""
    for e in range(stretch.shape[0]):
        if el.linear:
            f[e] = el.stiffness[e] * stretch[e]
            k[e] = el.stiffness[e]
        else:
            strain = abs(stretch[e]) / el.rest_length[e]
            tension, slope = law_tension(strain, el.law_rows, el.law_first[e], el.law_end[e])
            f[e] = tension if stretch[e] > 0.0 else -tension
            k[e] = slope / el.rest_length[e]


def borne(force: NDArray[np.float64], el: Elements) -> NDArray[np.float64]:
    """What bars bear of the forces (m,) N of their law: all where they are two-way, else nothing that pushes."""
    return np.where(el.two_way, force, np.maximum(force, 0.0))


@njit(**OPTIONS)
def water_load(rel, el, t, length, out):
    """Weight, buoyancy and water on every knot into out (n, 3) N; rel: (n, 3) m/s, the water against the knots."""
    for i in range(out.shape[0]):
        c = el.knot_drag[i] * np.sqrt(rel[i, 0] ** 2 + rel[i, 1] ** 2 + rel[i, 2] ** 2)
        for q in range(3):
            out[i, q] = el.weight[i, q] + c * rel[i, q]
    for e in range(length.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        f = bar_water_force(
            0.5 * (rel[a, 0] + rel[b, 0]),
            0.5 * (rel[a, 1] + rel[b, 1]),
            0.5 * (rel[a, 2] + rel[b, 2]),
            t[e, 0],
            t[e, 1],
            t[e, 2],
            el.normal_drag[e] * length[e],
            el.tangential_drag[e] * length[e],
        )
        for q in range(3):
            out[a, q] += f[q]
            out[b, q] += f[q]


@njit(**OPTIONS)
def add_tension(tension, el, t, out):
    """Add T t to end a and -T t to end b of every bar; out: (n, 3) N."""
    for e in range(tension.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        for q in range(3):
            out[a, q] += tension[e] * t[e, q]
            out[b, q] -= tension[e] * t[e, q]


@njit(**OPTIONS)
def largest_on_free(force, free):
    """Largest size (N) of force (n, 3) on a free knot, and that knot; NaN as soon as one is met."""
    worst, where = 0.0, 0
    for i in range(force.shape[0]):
        if free[i] > 0.0:
            size = np.sqrt(force[i, 0] ** 2 + force[i, 1] ** 2 + force[i, 2] ** 2)
            if not size <= worst:
                worst, where = size, i
                if np.isnan(size):
                    break
    return worst, where


@njit(**OPTIONS)
def law_of_bar(e, el):
    """c_n, c_t (kg/m2) and their four slopes of bar e."""
    cn, ct, by = el.normal_drag[e], el.tangential_drag[e], el.drag_slopes
    if by.shape[1] == 0:
        return cn, ct, 0.0, 0.0, 0.0, 0.0
    return cn, ct, by[0, e], by[1, e], by[2, e], by[3, e]


@njit(**OPTIONS)
def assemble(block, rel, el, t, start, stride, data):
    """Tangent -dF/dx on the pattern's data: stiffness less the tangent of the water's load.

    block: (m, 3, 3) N/m, stiffness of every bar; rel: (n, 3) m/s, the water against the knots; start, stride: of
    solve.linear.Pattern.
    """
    data[:] = 0.0
    drag, press = np.zeros((3, 3)), np.zeros((3, 3))
    w = np.zeros(3)
    for e in range(block.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        for q in range(3):
            w[q] = 0.5 * (rel[a, q] + rel[b, q])
        bar_water_tangents(w, t[e], law_of_bar(e, el), 0.0, drag, press)
        aa, ba, ab, bb = start[e, 0], start[e, 1], start[e, 2], start[e, 3]
        sa, sb = stride[e, 0], stride[e, 1]
        for q in range(3):
            for p in range(3):
                s = block[e, p, q]
                d = drag[p, q]
                if aa >= 0:
                    data[aa + q * sa + p] += s + d
                if ba >= 0:
                    data[ba + q * sa + p] += d - s
                if ab >= 0:
                    data[ab + q * sb + p] -= s + d
                if bb >= 0:
                    data[bb + q * sb + p] += s - d
