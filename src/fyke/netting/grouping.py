"""Grouped meshes: a panel's lattice with fewer, larger meshes, and fields carried from one lattice to the other.

A coarse lattice lies on the same frame. Its point (I, J) is the point (I ni/NI, J nj/NJ) of the fine one, in general
between knots. Diamond netting has knots and bars of either direction only at every other point of their grids, so
fields are carried row by row along i first, where points lie evenly two apart, then along j.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .lattice import INTERVALS, Lattice, MeshKind, lattice
from .net import Net

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Places:
    """Where knots or bars of one direction lie on a lattice.

    at: (k, 2) indices (i, j); offset: of the indices from lattice coordinates, 1/2 for the middle of a bar;
    apart: points in a row along i are so many apart; intervals: of the lattice.
    """

    at: Indices
    offset: tuple[float, float]
    apart: int
    intervals: tuple[int, int]

    def on(self, other: Places) -> Array:
        """Return these places (k, 2) in the indices of another lattice on the same frame."""
        scale = np.array(other.intervals) / np.array(self.intervals)
        return np.asarray((self.at + np.array(self.offset)) * scale - np.array(other.offset))


@dataclass(frozen=True)
class Grid:
    """The lattice of a panel as places: knots, and bars by direction; bars: indices of the bars of each direction."""

    mesh: MeshKind
    meshes: tuple[int, int]
    lattice: Lattice
    knots: Places
    directions: tuple[Places, Places]
    bars: tuple[Indices, Indices]

    @classmethod
    def of(cls, mesh: MeshKind, meshes: tuple[int, int]) -> Grid:
        """Return the grid of a panel of so many meshes."""
        whole = lattice(mesh, meshes)
        i, j = whole.knots.T
        a, b = whole.bars.T
        apart = INTERVALS[mesh]
        rising = (i[b] > i[a]) & (j[b] >= j[a])
        first = np.column_stack([np.minimum(i[a], i[b]), np.minimum(j[a], j[b])])
        offsets = ((0.5, 0.5), (0.5, 0.5)) if mesh == "diamond" else ((0.5, 0.0), (0.0, 0.5))
        bars = (np.flatnonzero(rising), np.flatnonzero(~rising))
        return cls(
            mesh,
            meshes,
            whole,
            Places(whole.knots, (0.0, 0.0), apart, whole.intervals),
            (
                Places(first[bars[0]], offsets[0], apart, whole.intervals),
                Places(first[bars[1]], offsets[1], apart, whole.intervals),
            ),
            bars,
        )


def grid_of(net: Net) -> Grid | None:
    """Return the grid of a net that is one whole panel of netting, None for any other."""
    if len(net.panels) != 1:
        return None
    panel = net.panels[0]
    if (
        panel.mesh == "hexagonal"
        or panel.closed
        or len(panel.knots) != net.knot_count
        or panel.bars.shape != (net.bar_count, 1)
    ):
        return None
    mesh: MeshKind = "square" if panel.mesh == "square" else "diamond"
    grid = Grid.of(mesh, panel.meshes)
    there = len(grid.lattice.knots) == net.knot_count and np.array_equal(grid.lattice.bars, net.bars)
    return grid if there else None


def carry(values: Array, have: Places, want: Places, degree: int) -> Array:
    """Carry a field (k, ...) from places to places on another lattice by splines of a degree, 1 or 3.

    Beyond the outermost points the field is continued.
    """
    where = want.on(have)
    rows = np.unique(where[:, 1])
    columns = np.unique(where[:, 0])
    size = have.at.max(axis=0) + 1
    inner = values.reshape(len(values), -1)
    sheet = np.zeros((*size, inner.shape[1]))
    sheet[have.at[:, 0], have.at[:, 1]] = inner
    along = np.empty((len(columns), *sheet.shape[1:]))
    if have.apart == 1:
        along[:] = _spline(np.arange(size[0]), sheet, columns, degree)
    else:
        odd = int(have.at[0].sum() % 2)
        j = np.arange(size[1])
        for parity in (0, 1):
            at = np.arange((odd + parity) % 2, size[0], 2)
            ends = [end for end in (0, size[0] - 1) if end not in at]
            for end in ends:
                # Between its points an edge is known from the edge alone.
                there = (j + end) % 2 == odd
                sheet[end, ~there] = _spline(j[there], sheet[end, there], j[~there].astype(float), degree)
            at = np.unique(np.concatenate([at, ends]).astype(np.int64))
            along[:, parity::2] = _spline(at, sheet[at, parity::2], columns, degree)
    both = _spline(np.arange(size[1]), np.swapaxes(along, 0, 1), rows, degree)
    out = both[np.searchsorted(rows, where[:, 1]), np.searchsorted(columns, where[:, 0])]
    return np.asarray(out.reshape(len(where), *values.shape[1:]))


def nearest(have: Places, want: Places) -> Indices:
    """Return for each wanted place the index of a near one; edges answer to edges, the inside to the inside."""
    size = have.at.max(axis=0) + 1
    index = np.full(size, -1, dtype=np.int64)
    index[have.at[:, 0], have.at[:, 1]] = np.arange(len(have.at))
    edge = want.at.max(axis=0)
    near = np.rint(want.on(have)).astype(np.int64)
    for axis in (0, 1):
        inside = (want.at[:, axis] > 0) & (want.at[:, axis] < edge[axis])
        low, high = np.where(inside, 1, 0), np.where(inside, size[axis] - 2, size[axis] - 1)
        near[:, axis] = np.clip(near[:, axis], np.minimum(low, high), np.maximum(low, high))
    missing = index[near[:, 0], near[:, 1]] < 0
    # One step along an edge, or anywhere inside, reaches a point that is there.
    middle = size // 2
    along_j = missing & (want.at[:, 1] > 0) & (want.at[:, 1] < edge[1])
    along_i = missing & ~along_j
    near[along_j, 1] += np.where(near[along_j, 1] < middle[1], 1, -1)
    near[along_i, 0] += np.where(near[along_i, 0] < middle[0], 1, -1)
    return np.asarray(index[near[:, 0], near[:, 1]])


def _spline(at: Indices, values: Array, wanted: Array, degree: int) -> Array:
    """Values (k, ...) at wanted coordinates, from values at the coordinates `at`."""
    degree = min(degree, len(at) - 1)
    if degree == 0:
        return np.repeat(values, len(wanted), axis=0)
    # A sixth of a second to import, which only large nets need.
    from scipy.interpolate import make_interp_spline

    return np.asarray(make_interp_spline(at.astype(float), values, k=degree)(wanted, extrapolate=True))
