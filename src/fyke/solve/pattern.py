"""Where the 3 x 3 blocks of the free knots lie in one sparse matrix of a net."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from ..system.elements import Elements

Array = NDArray[np.float64]
Places = NDArray[np.int64]


@dataclass(frozen=True)
class Pattern:
    """Where the blocks of every bar lie in the data of one compressed-column matrix of size 3 n_free.

    indices, indptr: of the matrix; start: (m, 4) position in the data of the first entry of the blocks (a, a),
    (b, a), (a, b), (b, b) of each bar, -1 where an end is held; stride: (m, 2) entries per column in the block
    columns of a and b; diagonal: (n, 2) start and stride of a knot's own block, -1 and 0 when held; free: (n_free,)
    indices of the free knots; groups: for each of the given ones start (p, q, q) of the blocks of every two knots of a
    group, rows before columns, -1 where one is held, and stride (p, q) in their columns.
    """

    indices: NDArray[np.int32]
    indptr: NDArray[np.int32]
    start: Places
    stride: Places
    diagonal: Places
    free: Places
    groups: tuple[tuple[Places, Places], ...]

    @classmethod
    def of(cls, el: Elements, groups: tuple[Places, ...] = ()) -> Pattern:
        """Find the pattern of a net; its bars may repeat a pair of knots.

        groups: each (p, q), knots that act on each other too, as the corners of faces; a group may repeat a knot.
        """
        free = np.flatnonzero(el.free)
        count, n = len(free), len(el.free)
        slot = np.full(n, -1, dtype=np.int64)
        slot[free] = np.arange(count)
        a, b = slot[el.knot_a], slot[el.knot_b]
        both = np.flatnonzero((a >= 0) & (b >= 0))
        # Blocks by column, then row: every knot with itself, and both ends of every free bar with each other.
        own = np.arange(count) * (count + 1)
        pairs = [_pairs(slot, some) for some in groups]
        keys = np.concatenate(
            [
                own,
                a[both] * count + b[both],
                b[both] * count + a[both],
                *(columns[apart] * count + rows[apart] for rows, columns, apart in pairs),
            ]
        )
        blocks, which = np.unique(keys, return_inverse=True)
        column, row = np.divmod(blocks, max(count, 1))
        degree = np.bincount(column, minlength=count)
        first = np.concatenate([[0], np.cumsum(degree)])
        stride = 3 * degree
        # Of the first entry of every block.
        place = 9 * first[column] + 3 * (np.arange(len(blocks)) - first[column])

        indices = np.empty(9 * len(blocks), dtype=np.int32)
        for q in range(3):
            for p in range(3):
                indices[place + q * stride[column] + p] = 3 * row + p

        mine = np.append(place[which[:count]], -1)
        start = np.full((len(a), 4), -1, dtype=np.int64)
        start[:, 0], start[:, 3] = mine[a], mine[b]
        ends = count + 2 * len(both)
        start[both, 1], start[both, 2] = place[which[count:ends]].reshape(2, -1)
        safe, among = np.append(stride, 0), []
        for rows, columns, apart in pairs:
            begin, ends = ends, ends + int(apart.sum())
            blocks_there = np.where(rows == columns, mine[rows], -1)
            blocks_there[apart] = place[which[begin:ends]]
            among.append((blocks_there, np.ascontiguousarray(safe[columns[:, 0]])))
        return cls(
            indices=indices,
            indptr=np.concatenate([[0], np.cumsum(np.repeat(stride, 3))]).astype(np.int32),
            start=start,
            stride=np.column_stack([safe[a], safe[b]]),
            diagonal=np.column_stack([mine[slot], safe[slot]]),
            free=free,
            groups=tuple(among),
        )

    @property
    def size(self) -> int:
        """Unknowns: 3 n_free."""
        return len(self.indptr) - 1

    def matrix(self, data: Array) -> sp.csc_matrix:
        """Put data on the pattern."""
        return sp.csc_matrix((data, self.indices, self.indptr), shape=(self.size, self.size))


def _pairs(slot: Places, groups: Places) -> tuple[Places, Places, NDArray[np.bool_]]:
    """Slots of every two knots of a group, rows and columns (p, q, q), and whether both are free and not the same."""
    corners = slot[groups]
    rows, columns = np.broadcast_arrays(corners[:, :, None], corners[:, None, :])
    return rows, columns, (rows >= 0) & (columns >= 0) & (rows != columns)
