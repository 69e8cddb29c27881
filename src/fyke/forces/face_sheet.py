"""Faces of netting as they lie at one moment, one row of numbers each, and which netting a knot belongs to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .compiled import OPTIONS

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

# A wake ends beside a face at this part of the radius 2 A / perimeter of a circle in it, times the cosine of its angle.
PENUMBRA = 0.5
# A face less than so much of its area across the current is seen edge on and leaves no wake; from twice that on the
# whole wake. Without it rounding would decide whether flat netting along the current lies behind itself.
EDGE_ON = 0.01
# Columns of a sheet (p, COLUMNS), faces as they lie: centre m; reach m, from there to the end of the wake beside the
# face; span m, the widest that two corners lie apart; area m2; vector area m2; margin m of the wake beside it, at most;
# the four corners m.
CENTRE, REACH, SPAN, AREA, VECTOR, MARGIN, CORNERS, COLUMNS = 0, 3, 4, 5, 6, 9, 10, 22


class Own(NamedTuple):
    """The netting that knots belong to: panel (n,), -1 for none, normal (n, 3) of length 1 or 0; of_face (p,) panel."""

    panel: Ints
    normal: Array
    of_face: Ints


@njit(**OPTIONS)
def spread(x, corners):
    """Return the sheet (p, COLUMNS) of faces with these corners (p, 4) with the knots at x (n, 3) m."""
    sheet = np.empty((len(corners), COLUMNS))
    for f in range(len(corners)):
        count = 3 if corners[f, 3] == corners[f, 2] else 4
        for q in range(3):
            total = 0.0
            for k in range(4):
                sheet[f, CORNERS + 3 * k + q] = x[corners[f, k], q]
                total += x[corners[f, k], q] if k < count else 0.0
            sheet[f, CENTRE + q] = total / count
        _measure(sheet[f])
    return sheet


@njit(**OPTIONS)
def _measure(face):
    """Fill in the other columns of a face (COLUMNS,) whose centre and corners are there."""
    a, b, c, d = CORNERS, CORNERS + 3, CORNERS + 6, CORNERS + 9
    square = furthest = 0.0
    for q in range(3):
        i, j = (q + 1) % 3, (q + 2) % 3
        part = (face[c + i] - face[a + i]) * (face[d + j] - face[b + j])
        part -= (face[c + j] - face[a + j]) * (face[d + i] - face[b + i])
        face[VECTOR + q] = 0.5 * part
        square += 0.25 * part * part
    for k in range(4):
        furthest = max(furthest, _apart(face, CENTRE, CORNERS + 3 * k))
    ab, bc, cd, da = _apart(face, a, b), _apart(face, b, c), _apart(face, c, d), _apart(face, d, a)
    face[AREA] = np.sqrt(square)
    face[SPAN] = max(ab, bc, cd, da, _apart(face, a, c), _apart(face, b, d))
    face[MARGIN] = 2.0 * PENUMBRA * face[AREA] / (ab + bc + cd + da) if face[AREA] > 0.0 else 0.0
    face[REACH] = furthest + face[MARGIN]


@njit(**OPTIONS)
def _apart(face, a, b):
    return np.sqrt(
        (face[a] - face[b]) ** 2 + (face[a + 1] - face[b + 1]) ** 2 + (face[a + 2] - face[b + 2]) ** 2
    )


@njit(**OPTIONS)
def own_netting(n, sheet, corners, of_face):
    """Return the Own netting of n knots; a knot in a seam belongs to the last panel, in the order of the faces."""
    panel, normal = np.full(n, -1, dtype=np.int64), np.zeros((n, 3))
    for f in range(len(corners)):
        for k in range(4):
            i = corners[f, k]
            if panel[i] != of_face[f]:
                panel[i] = of_face[f]
                normal[i, 0] = normal[i, 1] = normal[i, 2] = 0.0
            for q in range(3):
                normal[i, q] += sheet[f, VECTOR + q]
    for i in range(n):
        size = np.sqrt(normal[i, 0] ** 2 + normal[i, 1] ** 2 + normal[i, 2] ** 2)
        for q in range(3):
            normal[i, q] = normal[i, q] / size if size > 0.0 else 0.0
    return Own(panel, normal, of_face)
