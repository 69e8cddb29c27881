"""Solvers of the sparse matrices of a net, behind one callable."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from .pattern import Pattern

__all__ = ["Factorizer", "Pattern", "SingularMatrixError", "Solve", "factorizer"]

Array = NDArray[np.float64]
Solve = Callable[[Array], Array]


# Below so many unknowns kept pivots are faster than a supernodal factorization.
SMALL = 3_000
# Largest residual, over the right side, that kept pivots may leave.
KEPT_PIVOTS = 1e-6


class SingularMatrixError(Exception):
    """The matrix has no inverse to working precision."""


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
