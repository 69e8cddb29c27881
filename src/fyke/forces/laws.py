"""Coefficients of bars and knots under laws that know the Reynolds number, the angle, or both.

Every law is written as coefficients c_n, c_t (kg/m2) of the force of forces.drag, F = L (c_n |n| n + c_t |s| s t), at
the flow n across and s along a bar, w = n + s t, with c_n and c_t of Elements, here c and k:
    split laws    c_n = c C_n(Re_n),  c_t = k, or c (viscous(Re_n) / |Re_t| + along(Re_n)), from system.curves;
    whole         c_n = c + k |w| / |n|,  c_t = k |w| / |s|: k is a friction along the flow;
    angle tables  in forces.angle_cells.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numba.extending import register_jitable

from .angle_cells import STILL, by_cells, laws_of_angle
from .angle_cells import WORK_ROWS as LAW_ROWS
from .apart import keep, kept, take
from .around import PITCH
from .compiled import OPTIONS, WITHIN
from .cubics import READ_ROWS, cubic, find, read

__all__ = [
    "LAW_ROWS",
    "coefficients_of_bars",
    "coefficients_of_knots",
    "flow_by_bar",
    "varies",
    "vary",
    "vary_knots",
]


@register_jitable(**WITHIN)
def flow_by_bar(dx, dy, dz, wx, wy, wz):
    """Square (m2/s2) of the part across d of a velocity w, and its part along d (m/s)."""
    inverse = 1.0 / np.sqrt(max(dx * dx + dy * dy + dz * dz, STILL))
    tx, ty, tz = dx * inverse, dy * inverse, dz * inverse
    s = wx * tx + wy * ty + wz * tz
    nx, ny, nz = wx - s * tx, wy - s * ty, wz - s * tz
    return nx * nx + ny * ny + nz * nz, s


@register_jitable(**WITHIN)
def varies(curves):
    """Whether a law of bars is more than two constants."""
    return (
        curves.whole
        or curves.across.shape[0] > 0
        or curves.viscous.shape[0] > 0
        or curves.along.shape[0] > 0
        or curves.cells.reynolds.shape[0] > 0
    )


@register_jitable(**WITHIN)
def _on_the_whole(square, along, c, k):
    """c_n and c_t of a friction k along the flow besides c across the bar."""
    n, s = max(np.sqrt(square), STILL), max(abs(along), STILL)
    r = np.sqrt(square + along * along)
    return c + k * r / n, k * r / s


@njit(**OPTIONS)
def vary(begin, end, g, flow, work, reference, curves):
    """Put c_n and c_t (kg/m2) of bars in place of Re^2 across them and Re along them.

    What lies in g up to the end of the last stride is written too. flow: places of both in g less begin; work: place of
    LAW_ROWS rows in g; reference: c_n and c_t of Elements, each an array and a place in it, less begin.
    """
    across, along = flow
    c, c_at, k, k_at = reference
    if curves.whole:
        for i in range(begin, end):
            drag, friction = take(c, c_at + i), take(k, k_at + i)
            n, t = _on_the_whole(kept(g, across + i), kept(g, along + i), drag, friction)
            keep(g, across + i, n)
            keep(g, along + i, t)
        return
    if curves.cells.reynolds.shape[0] > 0:
        by_cells(begin, end, g, across, along, work, curves.cells)
        for i in range(begin, end):
            keep(g, across + i, take(c, c_at + i) * kept(g, across + i))
            keep(g, along + i, take(c, c_at + i) * kept(g, along + i))
        return
    find(begin, end, g, across, work)
    if curves.across.shape[0] > 0:
        read(begin, end, g, work, curves.across, (c, c_at), across)
    else:
        for i in range(begin, end):
            keep(g, across + i, take(c, c_at + i))
    _vary_along(begin, end, g, along, work, reference, curves)


@njit(**OPTIONS)
def _vary_along(begin, end, g, along, work, reference, curves):
    """Put c_t (kg/m2) of split laws in place of Re along bars; find has found the places of Re^2 across."""
    c, c_at, k, k_at = reference
    if curves.viscous.shape[0] == 0 and curves.along.shape[0] == 0:
        for i in range(begin, end):
            keep(g, along + i, take(k, k_at + i))
        return
    if curves.viscous.shape[0] == 0:
        read(begin, end, g, work, curves.along, (c, c_at), along)
        return
    found = work + READ_ROWS * PITCH
    read(begin, end, g, work, curves.viscous, (c, c_at), found)
    for i in range(begin, end):
        keep(g, along + i, kept(g, found + i) / max(abs(kept(g, along + i)), STILL))
    if curves.along.shape[0] > 0:
        read(begin, end, g, work, curves.along, (c, c_at), found)
        for i in range(begin, end):
            keep(g, along + i, kept(g, along + i) + kept(g, found + i))


@njit(**OPTIONS)
def vary_knots(begin, end, g, square, work, share, curve):
    """Put C_D of knots over that of Elements in place of Re^2, in g from square + begin on, times their share.

    share: an array and a place in it, less begin; the rest as in vary.
    """
    find(begin, end, g, square, work)
    read(begin, end, g, work, curve, share, square)


@njit(**OPTIONS)
def coefficients_of_bars(x, rel, el, laws, out):
    """Present c_n and c_t (kg/m2) of the bars and their slopes into out (6, m).

    Slopes of c_n by the square of the speed across and by the speed along, then of c_t. x: (n, 3) m; rel: (n, 3) m/s,
    the water against the knots.
    """
    curves, reynolds = laws.bars, laws.bar_reynolds
    for e in range(out.shape[1]):
        a, b, half = el.knot_a[e], el.knot_b[e], 0.5 * reynolds[e]
        out[0, e], out[1, e] = flow_by_bar(
            x[b, 0] - x[a, 0],
            x[b, 1] - x[a, 1],
            x[b, 2] - x[a, 2],
            half * (rel[a, 0] + rel[b, 0]),
            half * (rel[a, 1] + rel[b, 1]),
            half * (rel[a, 2] + rel[b, 2]),
        )
    if curves.whole:
        _whole_laws(el.normal_drag, el.tangential_drag, out)
    elif curves.cells.reynolds.shape[0] > 0:
        laws_of_angle(el.normal_drag, curves.cells, out)
    else:
        _split_laws(el.normal_drag, el.tangential_drag, curves.across, curves.viscous, curves.along, out)
    for e in range(out.shape[1]):
        r = reynolds[e]
        out[2, e] *= r * r
        out[3, e] *= r
        out[4, e] *= r * r
        out[5, e] *= r


@njit(**OPTIONS)
def _whole_laws(c, k, out):
    """Put coefficients_of_bars, slopes by Re^2 and Re, into out for a friction k; Re^2 and Re lie in rows 0 and 1."""
    for e in range(out.shape[1]):
        square, along = out[0, e], out[1, e]
        n, s = max(np.sqrt(square), STILL), max(abs(along), STILL)
        r = max(np.sqrt(square + along * along), STILL)
        side = 1.0 if along >= 0.0 else -1.0
        out[0, e], out[1, e] = c[e] + k[e] * r / n, k[e] * r / s
        out[2, e], out[3, e] = 0.5 * k[e] / (r * n) - 0.5 * k[e] * r / (n * n * n), k[e] * along / (r * n)
        out[4, e], out[5, e] = 0.5 * k[e] / (r * s), k[e] * along / (r * s) - side * k[e] * r / (s * s)


@njit(**OPTIONS)
def _split_laws(c, k, across, viscous, along, out):
    """Put the same into out for a law by curves."""
    varies_along = viscous.shape[0] > 0 or along.shape[0] > 0
    for e in range(out.shape[1]):
        square, s = out[0, e], out[1, e]
        n, n_q, t, t_q, t_s = 1.0, 0.0, 0.0, 0.0, 0.0
        if across.shape[0] > 0:
            n, n_q = cubic(across, square)
        if viscous.shape[0] > 0:
            a, a_q = cubic(viscous, square)
            inverse = 1.0 / max(abs(s), STILL)
            t, t_q, t_s = a * inverse, a_q * inverse, -a * inverse * (inverse if s >= 0.0 else -inverse)
        if along.shape[0] > 0:
            b, b_q = cubic(along, square)
            t, t_q = t + b, t_q + b_q
        out[0, e], out[1, e] = c[e] * n, c[e] * t if varies_along else k[e]
        out[2, e], out[3, e], out[4, e], out[5, e] = c[e] * n_q, 0.0, c[e] * t_q, c[e] * t_s


@njit(**OPTIONS)
def coefficients_of_knots(rel, el, laws, drag, slope):
    """Present drag (kg/m) of the knots over |w| w into drag (n,), its slope by the speed squared into slope (n,)."""
    curve, share = laws.knots, laws.knot_share
    for i in range(rel.shape[0]):
        square, r2 = rel[i, 0] ** 2 + rel[i, 1] ** 2 + rel[i, 2] ** 2, laws.knot_reynolds[i] ** 2
        value, steep = cubic(curve, square * r2) if curve.shape[0] > 0 else (1.0, 0.0)
        drag[i] = el.knot_drag[i] * (1.0 + share[i] * (value - 1.0))
        slope[i] = el.knot_drag[i] * share[i] * steep * r2
