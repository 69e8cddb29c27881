"""Bars in implicit dynamics: tension and slack with a smoothed complementarity.

T >= 0, w = T - g >= 0, T w = 0 with g = f(e) + damping is replaced by the function of Chen & Harker 1993, Kanzow 1996
and Smale 1987, T + w = sqrt((T - w)^2 + 4 mu), that is T w = mu with both positive at the solution only: Newton may
pass through anything and starts well from the last step, also when a bar snaps taut. A two-way bar has T = g and w = 0.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..forces.bars import law_of_bar
from ..forces.compiled import OPTIONS
from ..forces.drag import bar_water_tangents
from ..system.elements import Elements

Array = NDArray[np.float64]


def begin_smooth(f: Array, mu: float, el: Elements) -> tuple[Array, Array]:
    """Tension and slack (m,) N on T w = mu for forces f (m,) N of the law, so that w = T - f."""
    T = np.where(el.two_way, f, 0.5 * (f + np.sqrt(f * f + 4.0 * mu)))
    return T, T - f


@njit(**OPTIONS)
def smooth_bars(T, w, g, mu, two_way, p, r, c):
    """Share p in [0, 1] of a bar's stiffness that acts, residual r = w - T + g and change c of T without motion (N).

    Returns the largest violation of T + w = sqrt((T - w)^2 + 4 mu) and the largest r, in N.
    """
    largest_phi = largest_r = 0.0
    for e in range(T.shape[0]):
        r[e] = w[e] - T[e] + g[e]
        if two_way[e]:
            p[e], c[e] = 1.0, r[e]
            largest_r = max(largest_r, abs(r[e]))
            continue
        root = np.sqrt((T[e] - w[e]) ** 2 + 4.0 * mu)
        phi = T[e] + w[e] - root
        p[e] = 0.5 * (1.0 + (T[e] - w[e]) / root)
        c[e] = p[e] * r[e] - 0.5 * phi
        largest_phi = max(largest_phi, abs(phi))
        largest_r = max(largest_r, abs(r[e]))
    return largest_phi, largest_r


@njit(**OPTIONS)
def assemble_step(rel, el, t, length, T, along, c0, c1, cm, mass, symmetric, start, stride, diagonal, data):
    """Matrix cm M + c1 C + c0 K of one step on the pattern's data; K = -dF/dx, C = -dF/dv.

    rel: (n, 3) m/s, the water against the knots; along: (m,) N/m, stiffness of a bar along itself, damping included;
    T: (m,) N; mass: (n, 6) kg; symmetric: its symmetric part alone.
    """
    data[:] = 0.0
    turn, own, other = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    press, w = np.zeros((3, 3)), np.zeros(3)
    for e in range(along.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        for q in range(3):
            w[q] = 0.5 * (rel[a, q] + rel[b, q])
        t0 = t[e]
        # The velocity of the bar's middle is half of each end's.
        bar_water_tangents(w, t0, law_of_bar(e, el), 0.5 * c1 * length[e], turn, press)
        for q in range(3):
            for p in range(3):
                # Blocks (a, a) and (b, b) are symmetric by themselves, (b, a) and (a, b) mirror each other.
                own[p, q] = 0.5 * (turn[p, q] + turn[q, p]) if symmetric else turn[p, q]
                other[p, q] = 0.5 * (turn[p, q] - turn[q, p]) if symmetric else turn[p, q]
        across = (T[e] if el.two_way[e] else max(T[e], 0.0)) / length[e]
        aa, ba, ab, bb = start[e, 0], start[e, 1], start[e, 2], start[e, 3]
        sa, sb = stride[e, 0], stride[e, 1]
        for q in range(3):
            for p in range(3):
                identity = 1.0 if p == q else 0.0
                k = c0 * ((along[e] - across) * t0[p] * t0[q] + across * identity)
                d, g = c0 * own[p, q], c0 * other[p, q]
                c = 0.5 * (press[p, q] + press[q, p]) if symmetric else press[p, q]
                if aa >= 0:
                    data[aa + q * sa + p] += c + k + d
                if ba >= 0:
                    data[ba + q * sa + p] += c + g - k
                if ab >= 0:
                    data[ab + q * sb + p] += c - k - g
                if bb >= 0:
                    data[bb + q * sb + p] += c + k - d
    _add_knots(rel, el, c1, cm, mass, diagonal, data)


@njit(**OPTIONS)
def _add_knots(rel, el, c1, cm, mass, diagonal, data):
    """Add mass and drag of the knots to their own blocks."""
    block = np.zeros((3, 3))
    for i in range(rel.shape[0]):
        place, step = diagonal[i, 0], diagonal[i, 1]
        if place < 0:
            continue
        m = mass[i]
        block[0, 0], block[1, 1], block[2, 2] = m[0], m[1], m[2]
        block[0, 1] = block[1, 0] = m[3]
        block[0, 2] = block[2, 0] = m[4]
        block[1, 2] = block[2, 1] = m[5]
        w = rel[i]
        square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
        size = np.sqrt(square)
        inverse = 1.0 / size if size > 0.0 else 0.0
        drag = el.knot_drag[i]
        both = drag * inverse
        if el.knot_slopes.shape[0] > 0:
            both += 2.0 * el.knot_slopes[i] * size
        for q in range(3):
            for p in range(3):
                pressed = w[p] * w[q] * both + (size * drag if p == q else 0.0)
                data[place + q * step + p] += cm * block[p, q] + c1 * pressed


@njit(**OPTIONS)
def step_right_side(load, T, c, a, mass, el, t, free, total, out):
    """Load, tension T + c and inertia M a, on the free knots, into out (3 n_free,) N."""
    total[:] = load
    for e in range(T.shape[0]):
        i, j = el.knot_a[e], el.knot_b[e]
        for q in range(3):
            f = (T[e] + c[e]) * t[e, q]
            total[i, q] += f
            total[j, q] -= f
    for s in range(free.shape[0]):
        i = free[s]
        m = mass[i]
        b0, b1, b2 = a[i]
        out[3 * s] = total[i, 0] - m[0] * b0 - m[3] * b1 - m[4] * b2
        out[3 * s + 1] = total[i, 1] - m[3] * b0 - m[1] * b1 - m[5] * b2
        out[3 * s + 2] = total[i, 2] - m[4] * b0 - m[5] * b1 - m[2] * b2
