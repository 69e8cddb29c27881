"""Which faces of netting lie upstream of every knot, and what they leave of the current there.

The ray from a knot against its own current meets a face where the face, seen along the ray, covers the knot. Faces lie
in the cells of a grid across the mean current; a ray looks through the cells that it passes, one where the current is
uniform, and no more knots and faces are compared than lie near each other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..water.wakes import current_left
from .compiled import OPTIONS
from .face_grid import across, cell_at
from .face_sheet import AREA, CENTRE, CORNERS, EDGE_ON, MARGIN, REACH, SPAN, VECTOR

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

# A wake begins one span of a face (the widest that its corners lie apart) behind it and is whole at two, and faces less
# than a span apart are one sheet: what lies nearer is the same netting or a mesh beside it.
BEGIN, WHOLE = 1.0, 2.0
# Netting of the knot's own panel leaves it a wake from this cosine between their normals on, and the whole from the
# second on: 30 and 45 deg. Netting that has turned by less is one sheet, whose twines the law between twines is for;
# a bag and a closed ring turn by more.
ONE_SHEET, TURNED = 0.8660254037844386, 0.7071067811865476
# Cosines below it are rounding: the ray goes along the other axes of the grid only.
ROUNDING = 1e-12

left = njit(**OPTIONS)(current_left)


class Found(NamedTuple):
    """Faces upstream of a knot, nearest first: m upstream, coverage 0 to 1, |cos| of the angle, which; (p,) each."""

    upstream: Array
    covered: Array
    cosine: Array
    face: Ints


@njit(**OPTIONS)
def fade(part):
    """1 up to part = 0, 0 from 1 on, smooth between."""
    s = min(max(part, 0.0), 1.0)
    return 1.0 - s * s * (3.0 - 2.0 * s)


@njit(**OPTIONS)
def _near(f, knot, x, axes, sheet):
    """How far (m) a face lies upstream of a knot where the knot may lie in its wake; else 0.

    axes: (3, 3) as across gives them for the direction of the current at the knot.
    """
    dx, dy = x[knot, 0] - sheet[f, CENTRE], x[knot, 1] - sheet[f, CENTRE + 1]
    dz = x[knot, 2] - sheet[f, CENTRE + 2]
    s = dx * axes[2, 0] + dy * axes[2, 1] + dz * axes[2, 2]
    beside = dx * dx + dy * dy + dz * dz - s * s
    return s if s > BEGIN * sheet[f, SPAN] and beside < sheet[f, REACH] ** 2 else 0.0


@njit(**OPTIONS)
def _coverage(f, s, knot, x, axes, sheet):
    """How far (0 to 1) a knot lies in the wake of a face s (m) upstream, and |cos| of the face's angle."""
    across_it = 0.0
    for q in range(3):
        across_it += sheet[f, VECTOR + q] * axes[2, q]
    projected, area = abs(across_it), sheet[f, AREA]
    if projected <= EDGE_ON * area:
        return 0.0, 0.0
    cosine = min(projected / area, 1.0)
    covered = fade(_beside(f, knot, x, axes, sheet) / (sheet[f, MARGIN] * cosine))
    covered *= 1.0 - fade((s / sheet[f, SPAN] - BEGIN) / (WHOLE - BEGIN))
    covered *= 1.0 - fade(cosine / EDGE_ON - 1.0)
    return covered, cosine


@njit(**OPTIONS)
def _beside(f, knot, x, axes, sheet):
    """Distance (m) of a knot from a face as seen along axes[2], 0 within it."""
    nearest, inside = np.inf, False
    u0, v0 = _seen(f, 3, knot, x, axes, sheet)
    for k in range(4):
        u1, v1 = _seen(f, k, knot, x, axes, sheet)
        du, dv = u1 - u0, v1 - v0
        square = du * du + dv * dv
        if square > 0.0:
            part = min(max(-(u0 * du + v0 * dv) / square, 0.0), 1.0)
            nearest = min(nearest, (u0 + part * du) ** 2 + (v0 + part * dv) ** 2)
            if (v0 > 0.0) != (v1 > 0.0) and (u0 * dv - v0 * du > 0.0) == (dv > 0.0):
                inside = not inside
        u0, v0 = u1, v1
    return 0.0 if inside else np.sqrt(nearest)


@njit(**OPTIONS)
def _seen(f, k, knot, x, axes, sheet):
    """Where corner k of a face is seen from a knot along axes[2], two coordinates (m)."""
    at = CORNERS + 3 * k
    dx, dy, dz = sheet[f, at] - x[knot, 0], sheet[f, at + 1] - x[knot, 1], sheet[f, at + 2] - x[knot, 2]
    return dx * axes[0, 0] + dy * axes[0, 1] + dz * axes[0, 2], dx * axes[1, 0] + dy * axes[1, 1] + dz * axes[
        1, 2
    ]


@njit(**OPTIONS)
def _way_through(knot, here, run, low, high):
    """From where to where (m) the ray of a knot passes what faces cover; ends before it begins if it does not."""
    begin, end = 0.0, np.inf
    for q in range(3):
        if abs(run[knot, q]) < ROUNDING:
            if here[knot, q] < low[q] or here[knot, q] > high[q]:
                return 0.0, -1.0
        else:
            a, b = (low[q] - here[knot, q]) / run[knot, q], (high[q] - here[knot, q]) / run[knot, q]
            begin, end = max(begin, min(a, b)), min(end, max(a, b))
    return begin, end


@njit(**OPTIONS)
def _collect(knot, x, here, run, axes, sheet, grid, found):
    """Find the faces in whose wake a knot lies, nearest first, into found; returns how many."""
    low, width, cells, first = grid.low, grid.width, grid.cells, grid.first
    begin, end = _way_through(knot, here, run, low, grid.high)
    if begin > end:
        return 0
    i = cell_at(here[knot, 0] + begin * run[knot, 0], 0, low, width, cells)
    j = cell_at(here[knot, 1] + begin * run[knot, 1], 1, low, width, cells)
    count = 0
    while True:
        for place in range(first[i * cells[1] + j], first[i * cells[1] + j + 1]):
            f = grid.faces[place]
            s = _near(f, knot, x, axes, sheet)
            if s > 0.0:
                covered, cosine = _coverage(f, s, knot, x, axes, sheet)
                count = _insert(f, s, covered, cosine, count, found) if covered > 0.0 else count
        due_i = _due(i, here[knot, 0], run[knot, 0], low[0], width[0])
        due_j = _due(j, here[knot, 1], run[knot, 1], low[1], width[1])
        if min(due_i, due_j) > end:
            return count
        if due_i <= due_j:
            i += 1 if run[knot, 0] > 0.0 else -1
        else:
            j += 1 if run[knot, 1] > 0.0 else -1
        if i < 0 or j < 0 or i >= cells[0] or j >= cells[1]:
            return count


@njit(**OPTIONS)
def _due(cell, here, run, low, width):
    """How far along a ray (m) it leaves a cell along one axis, infinite when it never does."""
    if abs(run) < ROUNDING:
        return np.inf
    return (low + (cell + (1 if run > 0.0 else 0)) * width - here) / run


@njit(**OPTIONS)
def _insert(f, s, covered, cosine, count, found):
    """Put a face among those found so far, nearest first, unless it is there; returns how many there are then."""
    for k in range(count):
        if found.face[k] == f:
            return count
    k = count
    while k > 0 and found.upstream[k - 1] > s:
        found.upstream[k], found.covered[k] = found.upstream[k - 1], found.covered[k - 1]
        found.cosine[k], found.face[k] = found.cosine[k - 1], found.face[k - 1]
        k -= 1
    found.upstream[k], found.covered[k], found.cosine[k], found.face[k] = s, covered, cosine, f
    return count + 1


@njit(**OPTIONS)
def _spare_own(knot, count, found, sheet, own):
    """Take back the coverage by faces of the knot's own panel that have not turned away from it."""
    for k in range(count):
        f = found.face[k]
        if own.of_face[f] == own.panel[knot]:
            cosine = 0.0
            for q in range(3):
                cosine += sheet[f, VECTOR + q] * own.normal[knot, q]
            cosine /= sheet[f, AREA]
            found.covered[k] *= fade((cosine - TURNED) / (ONE_SHEET - TURNED))


@njit(**OPTIONS)
def _through(count, found, sheet, deficit, bend):
    """Factor that the faces found leave: the product over sheets of the mean over the faces of each."""
    factor, k = 1.0, 0
    while k < count:
        most = total = weight = 0.0
        while True:
            covered, f = found.covered[k], found.face[k]
            most = max(most, covered)
            weight += covered
            total += covered * left(deficit[f], found.cosine[k], bend[0], bend[1])
            k += 1
            if k == count:
                break
            apart = max(sheet[f, SPAN], sheet[found.face[k], SPAN])
            if found.upstream[k] - found.upstream[k - 1] > apart:
                break
        factor *= 1.0 - most * (1.0 - total / weight) if weight > 0.0 else 1.0
    return factor


@njit(**OPTIONS)
def wake_factors(x, way, sheet, own, grid, deficit, bend, out):
    """Multiply out (n,) by what the faces upstream of every knot leave of its current.

    x: (n, 3) m; way: (n, 3) unit vector of the current at each knot, zero where it stands still; deficit: (p,) and
    bend: lean and rest, of the WakeLaw.
    """
    n, p = len(x), len(sheet)
    here, run, axes = np.zeros((n, 3)), np.zeros((n, 3)), np.empty((3, 3))
    found = Found(np.empty(p), np.empty(p), np.empty(p), np.empty(p, dtype=np.int64))
    for i in range(n):
        for q in range(3):
            for k in range(3):
                here[i, q] += grid.axes[q, k] * x[i, k]
                run[i, q] -= grid.axes[q, k] * way[i, k]
    for i in range(n if len(grid.faces) > 0 else 0):
        if way[i, 0] != 0.0 or way[i, 1] != 0.0 or way[i, 2] != 0.0:
            across(way[i, 0], way[i, 1], way[i, 2], axes)
            count = _collect(i, x, here, run, axes, sheet, grid, found)
            _spare_own(i, count, found, sheet, own)
            out[i] *= _through(count, found, sheet, deficit, bend)
