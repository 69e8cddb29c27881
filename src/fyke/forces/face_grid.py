"""A grid across the current and the faces in its cells, so that a knot is compared with the faces near it only."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .compiled import OPTIONS
from .face_sheet import AREA, CORNERS, EDGE_ON, MARGIN, VECTOR

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

# Cells of the grid for each face, at most, and width of a cell over the mean width of what faces cover.
MOST_CELLS, CELL = 4, 0.5


class Grid(NamedTuple):
    """Cells across the mean current and the faces in them.

    axes: (3, 3), the third along the current; low, high: (3,) m, from where to where faces and their margins lie along
    them; cells: (2,) how many along the first two; width: (2,) m, of a cell; first: (cells + 1,) into faces.
    """

    axes: Array
    low: Array
    high: Array
    cells: Ints
    width: Array
    first: Ints
    faces: Ints


@njit(**OPTIONS)
def across(e0, e1, e2, axes):
    """Two unit vectors across a unit vector and the vector itself into axes (3, 3).

    T. Duff et al., Building an orthonormal basis, revisited, J. Computer Graphics Techniques 6(1), 2017 (the formula
    from memory).
    """
    side = 1.0 if e2 >= 0.0 else -1.0
    a = -1.0 / (side + e2)
    b = e0 * e1 * a
    axes[0, 0], axes[0, 1], axes[0, 2] = 1.0 + side * e0 * e0 * a, side * b, -side * e0
    axes[1, 0], axes[1, 1], axes[1, 2] = b, side + e1 * e1 * a, -e1
    axes[2, 0], axes[2, 1], axes[2, 2] = e0, e1, e2


@njit(**OPTIONS)
def grid_of(sheet, e, stray):
    """Return the Grid of a sheet's faces across the unit vector e (3,).

    stray: sine of the largest angle between e and the current at a knot.
    """
    p = len(sheet)
    axes, low, high, total = np.empty((3, 3)), np.full(3, np.inf), np.full(3, -np.inf), np.zeros(3)
    across(e[0], e[1], e[2], axes)
    begin, end, count = np.full((p, 3), np.inf), np.full((p, 3), -np.inf), 0
    for f in range(p):
        broadside = 0.0
        for q in range(3):
            broadside += sheet[f, VECTOR + q] * e[q]
        # No knot sees a face with a larger cosine than this.
        cosine = min(abs(broadside) / sheet[f, AREA] + stray, 1.0) if sheet[f, AREA] > 0.0 else 0.0
        if cosine > EDGE_ON:
            _between(sheet[f], axes, sheet[f, MARGIN] * cosine, begin[f], end[f])
            count += 1
            for q in range(3):
                low[q], high[q] = min(low[q], begin[f, q]), max(high[q], end[f, q])
                total[q] += end[f, q] - begin[f, q]
    cells, width = _cells(low, high, total, count)
    first, faces = _into_cells(begin, end, low, width, cells)
    return Grid(axes, low, high, cells, width, first, faces)


@njit(**OPTIONS)
def _between(face, axes, margin, begin, end):
    """From where to where a face (COLUMNS,) and its margin (m) lie along axes (3, 3), into begin and end (3,) m."""
    for q in range(3):
        for k in range(4):
            at = 0.0
            for i in range(3):
                at += axes[q, i] * face[CORNERS + 3 * k + i]
            begin[q], end[q] = min(begin[q], at - margin), max(end[q], at + margin)


@njit(**OPTIONS)
def _cells(low, high, total, count):
    """How many cells along each of two axes (2,), and their width (2,) m; total: m, of the widths of so many faces."""
    cells, width, wanted = np.ones(2, dtype=np.int64), np.zeros(2), np.ones(2)
    if count == 0:
        return cells, width
    for q in range(2):
        if total[q] > 0.0:
            wanted[q] = (high[q] - low[q]) * count / (CELL * total[q])
    shrink = min(1.0, np.sqrt(MOST_CELLS * count / (wanted[0] * wanted[1])))
    for q in range(2):
        cells[q] = np.int64(max(1.0, min(float(MOST_CELLS * count), wanted[q] * shrink)))
        width[q] = (high[q] - low[q]) / cells[q]
    return cells, width


@njit(**OPTIONS)
def _into_cells(begin, end, low, width, cells):
    """Sort faces from begin to end (p, 3) m into all the cells that they touch; returns first and faces of Grid.

    A face that ends before it begins belongs nowhere.
    """
    p = len(begin)
    touched = np.empty((p, 4), dtype=np.int64)
    first = np.zeros(cells[0] * cells[1] + 1, dtype=np.int64)
    for f in range(p):
        for q in range(2):
            there = begin[f, q] <= end[f, q]
            touched[f, 2 * q] = cell_at(begin[f, q], q, low, width, cells) if there else 0
            touched[f, 2 * q + 1] = cell_at(end[f, q], q, low, width, cells) + 1 if there else 0
        for i in range(touched[f, 0], touched[f, 1]):
            for j in range(touched[f, 2], touched[f, 3]):
                first[i * cells[1] + j + 1] += 1
    first = np.cumsum(first)
    faces, put = np.empty(first[-1], dtype=np.int64), first.copy()
    for f in range(p):
        for i in range(touched[f, 0], touched[f, 1]):
            for j in range(touched[f, 2], touched[f, 3]):
                faces[put[i * cells[1] + j]] = f
                put[i * cells[1] + j] += 1
    return first, faces


@njit(**OPTIONS)
def cell_at(at, q, low, width, cells):
    """Index of the cell at a place along axis q, the nearest when it lies outside."""
    if not width[q] > 0.0:
        return 0
    return min(max(np.int64((at - low[q]) / width[q]), 0), cells[q] - 1)
