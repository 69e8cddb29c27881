"""Sparse matrices of a net, 3 x 3 blocks for each free knot, and the solver behind one callable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from ..system.elements import Elements

Array = NDArray[np.float64]
Solve = Callable[[Array], Array]


# Below so many unknowns kept pivots are faster than a supernodal factorization.
SMALL = 3_000
# Largest residual, over the right side, that kept pivots may leave.
KEPT_PIVOTS = 1e-6


class SingularMatrixError(Exception):
    """The matrix has no inverse to working precision."""


@dataclass(frozen=True)
class Pattern:
    """Where the blocks of every bar lie in the data of one compressed-column matrix of size 3 n_free.

    indices, indptr: of the matrix; start: (m, 4) position in the data of the first entry of the blocks (a, a),
    (b, a), (a, b), (b, b) of each bar, -1 where an end is held; stride: (m, 2) entries per column in the block
    columns of a and b; diagonal: (n, 2) start and stride of a knot's own block, -1 when held; free: (n_free,)
    indices of the free knots.
    """

    indices: NDArray[np.int32]
    indptr: NDArray[np.int32]
    start: NDArray[np.int64]
    stride: NDArray[np.int64]
    diagonal: NDArray[np.int64]
    free: NDArray[np.int64]

    @classmethod
    def of(cls, el: Elements) -> Pattern:
        """Find the pattern of a net; its bars may repeat a pair of knots."""
        free = np.flatnonzero(el.free)
        slot = np.full(len(el.free), -1, dtype=np.int64)
        slot[free] = np.arange(len(free))
        a, b = slot[el.knot_a], slot[el.knot_b]
        both = (a >= 0) & (b >= 0)
        own = np.arange(len(free))
        rows = np.concatenate([own, a[both], b[both]])
        cols = np.concatenate([own, b[both], a[both]])
        blocks = sp.csc_matrix((np.ones(len(rows)), (rows, cols)), shape=(len(free), len(free)))
        blocks.sum_duplicates()
        blocks.sort_indices()
        degree = np.diff(blocks.indptr).astype(np.int64)
        key = np.repeat(own, degree) * len(free) + blocks.indices
        base = 9 * np.concatenate([[0], np.cumsum(degree)])[:-1]

        def start(row: NDArray[np.int64], col: NDArray[np.int64]) -> NDArray[np.int64]:
            held = (row < 0) | (col < 0)
            r, c = np.where(held, 0, row), np.where(held, 0, col)
            where = np.searchsorted(key, c * len(free) + r)
            return np.where(held, -1, base[c] + 3 * (where - blocks.indptr[c])) if len(free) else held * 0 - 1

        stride = 3 * degree
        indices = (3 * blocks.indices[:, None] + np.arange(3)).reshape(-1)
        per_column = [
            np.tile(indices[3 * p : 3 * q], 3) for p, q in zip(blocks.indptr, blocks.indptr[1:], strict=False)
        ]
        safe = np.append(stride, 0)
        return cls(
            indices=np.concatenate(per_column or [np.zeros(0)]).astype(np.int32),
            indptr=np.concatenate([[0], np.cumsum(np.repeat(stride, 3))]).astype(np.int32),
            start=np.column_stack([start(a, a), start(b, a), start(a, b), start(b, b)]),
            stride=np.column_stack([safe[a], safe[b]]),
            diagonal=np.column_stack([start(slot, slot), safe[slot]]),
            free=free,
        )

    def matrix(self, data: Array) -> sp.csc_matrix:
        """Put data on the pattern."""
        size = len(self.indptr) - 1
        return sp.csc_matrix((data, self.indices, self.indptr), shape=(size, size))


class Factorizer(Protocol):
    """Factorizes matrices of one pattern."""

    name: str

    def renew(self) -> None:
        """Keep nothing of the matrices so far, so that what follows does not depend on them."""

    def factor(self, data: Array) -> Solve:
        """Return the solve of a matrix with this data; raises SingularMatrixError."""


# What rslab raises for a matrix without inverse.
_FAULTS = (RuntimeError, ValueError, ArithmeticError)


class Rslab:
    """RSLAB's sparse LU; the symbolic analysis is done once. Same bits for any number of threads."""

    name = "rslab LU"

    def __init__(self, pattern: Pattern) -> None:
        import rslab

        self._symbolic = rslab.analyze(pattern.matrix(np.ones(len(pattern.indices))), path="lu")

    def renew(self) -> None:
        """Nothing is kept but the symbolic analysis."""

    def factor(self, data: Array) -> Solve:
        """Return the solve of a matrix with this data; raises SingularMatrixError."""
        try:
            handle = self._symbolic.factor(data)
        except _FAULTS as error:
            raise SingularMatrixError(str(error)) from error
        solve: Solve = handle.solve
        return solve


class RslabSmall:
    """RSLAB's KLU for small systems: the pivots of a matrix are kept for the next, which halves the time.

    The first solution with kept pivots is checked, and computed again with new ones when its residual is too large. The
    solve of one matrix is good until the next is factorized.
    """

    name = "rslab KLU"

    def __init__(self, pattern: Pattern) -> None:
        import rslab

        self._pattern = pattern
        # Ordered for a heavy diagonal, as stiffness and mass make it, whatever the first matrix.
        model = pattern.matrix(np.ones(len(pattern.indices)))
        model.setdiag(float(len(pattern.indptr)))
        self._symbolic = rslab.analyze(model, path="klu")
        self._handle: Any = None

    def renew(self) -> None:
        """Choose new pivots at the next matrix."""
        self._handle = None

    def factor(self, data: Array) -> Solve:
        """Return the solve of a matrix with this data; raises SingularMatrixError."""
        matrix = self._pattern.matrix(data)
        checked = not self._kept(matrix)

        def solve(right: Array) -> Array:
            nonlocal checked
            x: Array = self._handle.solve(right)
            if not checked:
                checked = True
                # Written so that a NaN fails it too.
                if not np.abs(matrix @ x - right).max() <= KEPT_PIVOTS * np.abs(right).max():
                    self._choose_pivots(matrix)
                    x = self._handle.solve(right)
            return x

        return solve

    def _kept(self, matrix: sp.csc_matrix) -> bool:
        """Factorize; whether that was done with kept pivots."""
        if self._handle is not None:
            try:
                self._handle.refactor(matrix.data)
            except _FAULTS:
                pass
            else:
                return True
        self._choose_pivots(matrix)
        return False

    def _choose_pivots(self, matrix: sp.csc_matrix) -> None:
        try:
            self._handle = self._symbolic.factor(matrix.data)
        except _FAULTS as error:
            raise SingularMatrixError(str(error)) from error


class SuperLU:
    """SciPy's SuperLU, always there."""

    name = "SuperLU"

    def __init__(self, pattern: Pattern) -> None:
        self._pattern = pattern

    def renew(self) -> None:
        """Nothing is kept."""

    def factor(self, data: Array) -> Solve:
        """Return the solve of a matrix with this data; raises SingularMatrixError."""
        from scipy.sparse.linalg import splu

        try:
            handle = splu(
                self._pattern.matrix(data), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
            )
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from error
        solve: Solve = handle.solve
        return solve


def factorizer(pattern: Pattern) -> Factorizer:
    """Return the fastest solver that is installed."""
    if find_spec("rslab") is None:
        return SuperLU(pattern)
    return RslabSmall(pattern) if len(pattern.indptr) <= SMALL else Rslab(pattern)
