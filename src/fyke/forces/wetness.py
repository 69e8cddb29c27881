"""How much of a net is under water where it reaches the surface, and what a change of that does to the load.

A bar is round: the part of its cross-section that is wet, its axis at a depth s r with r its radius, is a segment of a
circle, and the bar's part is the mean of that along its length; with depths a and b of its ends and the integral I,
    A(s) = 1/2 + (s sqrt(1 - s^2) + asin s) / pi,          so that a half-wet bar lifts rho g 2 r more a metre of depth,
    I(s) = (1 + s)/2 + ((1 - s^2)^(1/2) - (1 - s^2)^(3/2)/3 + s asin s - pi/2) / pi,
    beta = r (I(b/r) - I(a/r)) / (b - a).
A is that of a level bar; in a steep one the segments are parts of ellipses of the same height, which is left out.
A knot, or what hangs there, is a sphere, with the volume of a cap; a face of netting is the mean of its two diagonals
as if they were twines. Drag, added mass and buoyancy are multiplied by the part, so that with F the load that the
whole bar or face would have, dF/dz = F dbeta/dz by the heights of its corners.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .compiled import OPTIONS
from .drag import bar_water_force
from .total import TINY_LENGTH

# Ends of a bar that differ in depth by less than this part of its radius lie level: differences of I lose as many
# digits of the part, and twice as many of its slopes, and the middle alone stands for the mean to the square of it.
LEVEL = 1e-5
# Least wet part that the load is divided by.
TINY_PART = 1e-100


@njit(**OPTIONS)
def _segment(s):
    """Part A of a circle that is under water, its middle s radii deep."""
    if s >= 1.0:
        return 1.0
    return 0.5 + (s * np.sqrt((1.0 - s) * (1.0 + s)) + np.arcsin(s)) / np.pi if s > -1.0 else 0.0


@njit(**OPTIONS)
def _immersed(s):
    """Integral I of A over s, from where nothing is wet."""
    if s >= 1.0:
        return s
    if s <= -1.0:
        return 0.0
    square = (1.0 - s) * (1.0 + s)
    return 0.5 * (1.0 + s) + (np.sqrt(square) * (1.0 - square / 3.0) + s * np.arcsin(s)) / np.pi - 0.5


@njit(**OPTIONS)
def wet_bar(a, b, radius):
    """Wet part of a bar with its ends at depths a and b (m), and its slopes by both (1/m)."""
    if (a >= radius and b >= radius) or (a <= -radius and b <= -radius):
        return (1.0 if a > 0.0 else 0.0), 0.0, 0.0
    s, t = a / radius, b / radius
    if abs(t - s) > LEVEL:
        part = (_immersed(t) - _immersed(s)) / (t - s)
        return part, (part - _segment(s)) / (b - a), (_segment(t) - part) / (b - a)
    middle = 0.5 * (s + t)
    # Half of 2/(pi r) sqrt(1 - s^2) for each end.
    slope = np.sqrt(max((1.0 - middle) * (1.0 + middle), 0.0)) / (np.pi * radius)
    return _segment(middle), slope, slope


@njit(**OPTIONS)
def wet_knot(depth, radius):
    """Wet part of a sphere with its middle at a depth (m), and its slope by that (1/m)."""
    r = max(radius, TINY_LENGTH)
    part = min(max(0.5 * (depth + r) / r, 0.0), 1.0)
    # The volume of a spherical cap over that of the sphere.
    return part * part * (3.0 - 2.0 * part), 3.0 * part * (1.0 - part) / r


@njit(**OPTIONS)
def wet_parts(depth, el, bar_radius, knot_radius, bars, knots):
    """Part under water of every bar into bars (m,) and of every knot, or what hangs there, into knots (n,).

    depth: (n,) m, of the knots below the surface, which is straight between them.
    """
    for i in range(depth.shape[0]):
        knots[i] = wet_knot(depth[i], knot_radius[i])[0]
    for e in range(bar_radius.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        bars[e] = wet_bar(depth[a], depth[b], bar_radius[e])[0]


@njit(**OPTIONS)
def wet_faces(depth, corners, radius, out):
    """Part under water of every face of netting into out (p,); corners: (p, 4) knots; radius: (p,) m, of the twine."""
    for f in range(out.shape[0]):
        a, b, c, d = corners[f, 0], corners[f, 1], corners[f, 2], corners[f, 3]
        one, other = wet_bar(depth[a], depth[c], radius[f])[0], wet_bar(depth[b], depth[d], radius[f])[0]
        out[f] = 0.5 * (one + other)


@njit(**OPTIONS)
def add_wetting(depth, rel, el, sizes, bars, symmetric, places, data):
    """Add to -dF/dx what the wet parts change, or its symmetric part alone.

    depth: (n,) m; rel: (n, 3) m/s, the water against the knots; el: with the wet parts in its coefficients; sizes:
    radius (m) of the bars (m,) and of the knots (n,), buoyancy (N) of half a bar (m,) and of a knot (n,) all under
    water; bars: unit vectors (m, 3) and lengths (m,) m; places: start, stride, diagonal of solve.pattern.Pattern.
    """
    t, length = bars
    bar_radius, knot_radius, bar_lift, knot_lift = sizes
    start, stride, diagonal = places
    half = 0.5 if symmetric else 1.0
    for i in range(depth.shape[0]):
        part, slope = wet_knot(depth[i], knot_radius[i])
        if slope == 0.0 or diagonal[i, 0] < 0:
            continue
        drag = (
            el.knot_drag[i] * np.sqrt(rel[i, 0] ** 2 + rel[i, 1] ** 2 + rel[i, 2] ** 2) / max(part, TINY_PART)
        )
        for p in range(3):
            value = half * slope * (drag * rel[i, p] + (knot_lift[i] if p == 2 else 0.0))
            data[diagonal[i, 0] + 2 * diagonal[i, 1] + p] += value
            if symmetric:
                data[diagonal[i, 0] + p * diagonal[i, 1] + 2] += value
    slopes = np.zeros(2)
    for e in range(length.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        part, slopes[0], slopes[1] = wet_bar(depth[a], depth[b], bar_radius[e])
        if slopes[0] == 0.0 and slopes[1] == 0.0:
            continue
        whole = length[e] / max(part, TINY_PART)
        drag = bar_water_force(
            0.5 * (rel[a, 0] + rel[b, 0]),
            0.5 * (rel[a, 1] + rel[b, 1]),
            0.5 * (rel[a, 2] + rel[b, 2]),
            t[e, 0],
            t[e, 1],
            t[e, 2],
            el.normal_drag[e] * whole,
            el.tangential_drag[e] * whole,
        )
        # Blocks (a, a), (b, a), (a, b), (b, b): row first.
        for row in range(2):
            for column in range(2):
                place, mirrored = start[e, row + 2 * column], start[e, column + 2 * row]
                if place < 0:
                    continue
                for p in range(3):
                    value = half * slopes[column] * (drag[p] + (bar_lift[e] if p == 2 else 0.0))
                    data[place + 2 * stride[e, column] + p] += value
                    if symmetric:
                        data[mirrored + p * stride[e, row] + 2] += value


@njit(**OPTIONS)
def add_face_wetting(depth, force, screens, radius, wet, symmetric, groups, data):
    """Add to -dF/dx what the wet parts (p,) of faces change, or its symmetric part alone.

    force: (p, 3) N, with the wet parts in it; screens: ScreenArrays; radius: (p,) m, of the twine; groups: of
    solve.pattern.Pattern.
    """
    start, stride = groups
    half = 0.5 if symmetric else 1.0
    slopes = np.zeros(4)
    for f in range(wet.shape[0]):
        a, b, c, d = (
            screens.corners[f, 0],
            screens.corners[f, 1],
            screens.corners[f, 2],
            screens.corners[f, 3],
        )
        _, slopes[0], slopes[2] = wet_bar(depth[a], depth[c], radius[f])
        _, slopes[1], slopes[3] = wet_bar(depth[b], depth[d], radius[f])
        for row in range(4):
            for column in range(4):
                place, mirrored = start[f, row, column], start[f, column, row]
                if place < 0 or slopes[column] == 0.0:
                    continue
                part = half * screens.share[f, row] * 0.5 * slopes[column] / max(wet[f], TINY_PART)
                for p in range(3):
                    data[place + 2 * stride[f, column] + p] += part * force[f, p]
                    if symmetric:
                        data[mirrored + p * stride[f, row] + 2] += part * force[f, p]
