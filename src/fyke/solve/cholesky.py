"""CHOLMOD for a net's matrices, which the water makes unsymmetric: Cholesky of the symmetric part, and GMRES with it.

Y. Chen, T.A. Davis, W.W. Hager, S. Rajamanickam, Algorithm 887: CHOLMOD, ACM Trans. Math. Softw. 35(3), 22, 2008,
through cvxopt. Y. Saad, M.H. Schultz, GMRES: a generalized minimal residual algorithm for solving nonsymmetric linear
systems, SIAM J. Sci. Stat. Comput. 7(3), 856-869, 1986, preconditioned on the right, so that it minimises the residual
itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .engines import BreakdownError, Factored
from .memory import check_memory
from .pattern import Pattern

Array = NDArray[np.float64]

# GMRES ends at this residual, over the right side, in the Euclidean norm, or after so many iterations.
TOLERANCE, MOST_ITERATIONS = 1e-12, 60
# Bytes that CHOLMOD takes for n unknowns and e entries, over e log2(n): as in engines.
_CHOLMOD = 3.5


class Cholmod:
    """CHOLMOD of the symmetric part, which must be positive definite, as the preconditioner of GMRES."""

    kept = False

    def __init__(self, pattern: Pattern) -> None:
        from cvxopt import cholmod, spmatrix

        n = pattern.size
        check_memory(_CHOLMOD * len(pattern.indices) * np.log2(max(n, 2)) + 8.0 * MOST_ITERATIONS * n)
        self._pattern, self._cholmod = pattern, cholmod
        columns = np.repeat(np.arange(n), np.diff(pattern.indptr))
        # The pattern is symmetric: turned over, entry k lies where the mirror image of k lay.
        mirror = pattern.matrix(np.arange(len(columns), dtype=float)).T.tocsc().data.astype(np.int64)
        self._lower = np.flatnonzero(pattern.indices >= columns)
        self._upper = mirror[self._lower]
        rows, columns = pattern.indices[self._lower], columns[self._lower]
        self._matrix = spmatrix(1.0, rows, columns, (n, n))
        self._symbolic: Any = cholmod.symbolic(self._matrix) if n else None

    def renew(self) -> None:
        """Nothing is kept but the symbolic analysis."""

    forget = renew

    def factor(self, data: Array) -> Factored:
        """Factorize the symmetric part; raises BreakdownError when it is not positive definite."""
        from cvxopt import matrix

        if self._symbolic is None:
            return np.copy
        self._matrix.V = matrix(0.5 * (data[self._lower] + data[self._upper]))
        try:
            self._cholmod.numeric(self._matrix, self._symbolic)
        except ArithmeticError as error:
            raise BreakdownError("the symmetric part of the matrix is not positive definite") from error
        product = self._pattern.matrix(data)

        def precondition(right: Array) -> Array:
            x = matrix(right)
            self._cholmod.solve(self._symbolic, x)
            return np.array(x).reshape(-1)

        return lambda right: gmres(product.__matmul__, precondition, right)


def _dot(x: Array, y: Array) -> float:
    """Sum by einsum, whose bits do not depend on the number of BLAS threads."""
    return float(np.einsum("i,i->", x, y))


def gmres(product: Factored, precondition: Factored, right: Array) -> Array:
    """Solve A x = right by the product with A and a preconditioner near its inverse."""
    size = np.sqrt(_dot(right, right))
    if not 0.0 < size < np.inf:
        return 0.0 * right
    basis, columns = [right / size], []
    # The small least-squares problem, turned into a triangle by Givens rotations as it grows.
    turns: list[tuple[float, float]] = []
    left = [size]
    for k in range(MOST_ITERATIONS):
        w = product(precondition(basis[k]))
        column = np.zeros(k + 1)
        for i, v in enumerate(basis):
            column[i] = _dot(v, w)
            w -= column[i] * v
        height = np.sqrt(_dot(w, w))
        for i, (c, s) in enumerate(turns):
            column[i], column[i + 1] = c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]
        length = np.hypot(column[k], height)
        if not 0.0 < length < np.inf:
            break
        c, s = column[k] / length, height / length
        turns.append((c, s))
        column[k] = length
        columns.append(column)
        left[k:] = [c * left[k], -s * left[k]]
        if abs(left[k + 1]) <= TOLERANCE * size:
            break
        basis.append(w / height)
    weights = np.zeros(len(columns))
    for k in reversed(range(len(columns))):
        rest = sum(columns[j][k] * weights[j] for j in range(k + 1, len(columns)))
        weights[k] = (left[k] - rest) / columns[k][k]
    together = np.zeros_like(right)
    for weight, v in zip(weights, basis, strict=False):
        together += weight * v
    return precondition(together)
