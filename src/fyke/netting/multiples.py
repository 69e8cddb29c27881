"""Grouped netting: fewer, larger meshes on the same frame, and how many real bars and knots each of theirs stands for.

Real netting of M meshes along an axis is laid with K, one for nu = M / K real ones. By the rule of trapezoids a row of
the larger lattice stands for nu real rows inside and for (nu + 1) / 2 at an open edge, which adds up to the real rows,
those at both edges included. A knot stands for the product of both axes. A bar along an axis is nu times as long as a
real one, and stands for as many side by side as there are rows at it; one of diamonds for nu. So the number of knots
and the length of twine, and with them mass, weight and the area that the water meets, are those of the real netting.
Derived here; the usual rules for nu x nu meshes inside are the same.
"""

from __future__ import annotations

from math import floor

import numpy as np
from numpy.typing import NDArray

from .lattice import Lattice, MeshKind

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Pair = tuple[float, float]

LEAST_AROUND = 3  # meshes that go round an axis


def grouped_meshes(meshes: tuple[int, int], group: int, *, closed: bool = False) -> tuple[int, int]:
    """Return how many larger meshes lie along width and height where each stands for `group` real ones either way.

    Rounded to the nearest where the group does not divide them; closed: the width closes round, with at least three.
    """
    if group == 1:
        return meshes
    across, along = (max(1, floor(count / group + 0.5)) for count in meshes)
    return (min(meshes[0], max(LEAST_AROUND, across)) if closed else across), along


def knot_multiples(grid: Lattice, many: Pair, *, closed: bool, tip: bool) -> Array:
    """Return how many real knots every knot of the larger lattice stands for, (k,).

    many: real meshes to one along width and height; closed: the first column is the last; tip: the lowest row is one
    knot in the real netting and here, which stands for the rows next to it, too.
    """
    i, j = grid.knots.T
    across, up = _rows(grid.intervals[0], many[0], closed=closed), _rows(grid.intervals[1], many[1])
    out = across[i] * up[j]
    if tip:
        # Of a row of diamonds every other point of the lattice is a knot, so many in the real netting:
        around = 0.5 * many[0] * grid.intervals[0]
        out[j == 0] = 1.0 + around * 0.5 * (many[1] - 1.0)
    return np.asarray(out)


def bar_multiples(
    grid: Lattice, mesh: MeshKind, many: Pair, size: tuple[float, float], *, closed: bool
) -> tuple[Array, Array]:
    """Return how many real bars side by side every bar stands for, and how many times as long it is, (b,) each.

    Bars of diamonds are longer in the ratio of the meshes' diagonals on the frame, size: m, so that all strains are
    those of the real bars there; nu where both axes have it.
    """
    count = len(grid.bars)
    if mesh == "diamond":
        longer = many[0]
        if many[0] != many[1]:
            spacing = np.array(size) / (np.array(grid.intervals) * np.array(many))
            longer = float(np.linalg.norm(spacing * np.array(many)) / np.linalg.norm(spacing))
        return np.full(count, many[0] * many[1] / longer), np.full(count, longer)
    i, j = grid.knots[grid.bars[:, 0]].T
    level = grid.knots[grid.bars[:, 1], 1] == j
    across, up = _rows(grid.intervals[0], many[0], closed=closed), _rows(grid.intervals[1], many[1])
    return np.where(level, up[j], across[i]), np.where(level, many[0], many[1])


def real_indices(places: Indices, mesh: MeshKind, many: Pair) -> Indices:
    """Return row and column (k, 2) in the real netting of knots (k, 2) of the larger lattice, the nearest there."""
    ratio = np.array(many)
    odd = places % 2 if mesh == "diamond" and not _lands_on_knots(many) else np.zeros_like(places)
    step = 2 if mesh == "diamond" and not _lands_on_knots(many) else 1
    return np.asarray(odd + step * np.floor((places * ratio - odd) / step + 0.5).astype(np.int64))


def _lands_on_knots(many: Pair) -> bool:
    """Whether every knot of the larger lattice of diamonds lies at a knot of the real one."""
    return all(one == int(one) for one in many) and (many[0] - many[1]) % 2 == 0


def _rows(last: int, many: float, *, closed: bool = False) -> Array:
    """How many real rows or columns every one of the larger lattice stands for, (last + 1,)."""
    rows = np.full(last + 1, many)
    if not closed:
        rows[[0, -1]] = 0.5 * (many + 1.0)
    return rows
