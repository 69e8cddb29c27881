"""The sparse solvers that fyke knows: RSLAB's three, and SciPy's SuperLU."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .memory import check_memory
from .pattern import Pattern

Array = NDArray[np.float64]


class BreakdownError(Exception):
    """A pivot vanished."""


class Factored(Protocol):
    """One factorized matrix."""

    def __call__(self, right: Array, /) -> Array:
        """Solve for a right side."""


class Engine(Protocol):
    """A sparse solver at work on one pattern.

    Made with the pattern, after which it knows how much memory a factorization takes: NotEnoughMemoryError is raised
    when that is more than is free. kept: whether the last matrix was factorized with pivots of one before it.
    """

    kept: bool

    def renew(self) -> None:
        """Go on with pivots that do not depend on the matrices so far."""

    def forget(self) -> None:
        """Keep no pivots."""

    def factor(self, data: Array) -> Factored:
        """Factorize; raises BreakdownError. The last factorized matrix need not stay solvable."""


# What rslab raises for a matrix without inverse.
_FAULTS = (RuntimeError, ValueError, ArithmeticError)
# Bytes that rslab's symbolic analysis takes for every entry of the matrix, on panels of 1 to 3 million unknowns.
_ANALYSIS = 85.0
# Least fill is as good as any order of rslab's on nets up to 3 million unknowns, and alone it takes a half to a seventh
# of the time of comparing them all. Narrow supernodes store fewer zeros, which quickens the solves by a fifth.
_LU_SETTINGS = {"ordering": "amf", "nemin": 8}


class Rslab:
    """RSLAB's supernodal LU; the symbolic analysis is done once. Same bits for any number of threads."""

    kept = False

    def __init__(self, pattern: Pattern) -> None:
        import rslab

        check_memory(_ANALYSIS * len(pattern.indices))
        self._symbolic = rslab.analyze(
            pattern.matrix(np.ones(len(pattern.indices))), path="lu", **_LU_SETTINGS
        )
        plan = self._symbolic.memory_plan()
        check_memory(plan["peak_bytes"] - plan["analysis_bytes"])

    def renew(self) -> None:
        """Nothing is kept but the symbolic analysis."""

    forget = renew

    def factor(self, data: Array) -> Factored:
        """Factorize; raises BreakdownError."""
        try:
            handle = self._symbolic.factor(data)
        except _FAULTS as error:
            raise BreakdownError(str(error)) from error
        solve: Factored = handle.solve
        return solve


class RslabSymmetric:
    """RSLAB's supernodal LDL^T of symmetric matrices, half the work of the LU. Same bits for any number of threads."""

    kept = False

    def __init__(self, pattern: Pattern) -> None:
        import rslab

        check_memory(_ANALYSIS * len(pattern.indices))
        self._matrix = pattern.matrix(np.ones(len(pattern.indices)))
        self._symbolic = rslab.analyze(self._matrix, path="ldlt", **_LU_SETTINGS)
        plan = self._symbolic.memory_plan()
        check_memory(plan["peak_bytes"] - plan["analysis_bytes"])

    def renew(self) -> None:
        """Nothing is kept but the symbolic analysis."""

    forget = renew

    def factor(self, data: Array) -> Factored:
        """Factorize; raises BreakdownError."""
        self._matrix.data = data
        try:
            handle = self._symbolic.factor(self._matrix)
        except _FAULTS as error:
            raise BreakdownError(str(error)) from error
        solve: Factored = handle.solve
        return solve


def falling(pattern: Pattern, data: Array) -> int:
    """Count the negative eigenvalues of a symmetric matrix by its LDL^T; 0 where RSLAB is not there or finds none."""
    if find_spec("rslab") is None:
        return 0
    import rslab

    matrix = pattern.matrix(data)
    try:
        handle = rslab.analyze(matrix, path="ldlt", **_LU_SETTINGS).factor(matrix)
    except _FAULTS:
        return 0
    return int(handle.inertia[1])


class RslabSmall:
    """RSLAB's KLU for small systems: the pivots of a matrix are kept for the next, which halves the time."""

    def __init__(self, pattern: Pattern) -> None:
        import rslab

        self.kept = False
        # Ordered for a heavy diagonal, as stiffness and mass make it, whatever the first matrix.
        model = pattern.matrix(np.ones(len(pattern.indices)))
        model.setdiag(float(len(pattern.indptr)))
        self._symbolic = rslab.analyze(model, path="klu")
        check_memory(self._symbolic.memory_plan()["peak_bytes"])
        self._model = model.data
        self._of_model: Any = None
        self._handle: Any = None

    def renew(self) -> None:
        """Take the pivots of the model, which are those of most matrices of a net."""
        if self._of_model is None:
            self._of_model = self._symbolic.factor(self._model)
        self._handle = self._of_model

    def forget(self) -> None:
        """Choose new pivots at the next matrix."""
        self._handle = None

    def factor(self, data: Array) -> Factored:
        """Factorize, with the pivots of the matrix before if they do; raises BreakdownError."""
        self.kept = self._handle is not None and self._again(data)
        if not self.kept:
            try:
                self._handle = self._symbolic.factor(data)
            except _FAULTS as error:
                self._handle = None
                raise BreakdownError(str(error)) from error
        solve: Factored = self._handle.solve
        return solve

    def _again(self, data: Array) -> bool:
        try:
            self._handle.refactor(data)
        except _FAULTS:
            return False
        return True


# Bytes that SuperLU takes for n unknowns and e entries of the matrix, over e log2(n): n log2(n) is the law of fill on
# planar graphs, as nets are (R.J. Lipton, D.J. Rose, R.E. Tarjan, Generalized nested dissection, SIAM J. Numer. Anal.
# 16, 346-358, 1979), and faces, which nearly double the entries, nearly double the fill. The most found on panels of
# 60 000 to 960 000 unknowns.
_SUPERLU = 10.0


class SuperLU:
    """SciPy's SuperLU, always there."""

    kept = False

    def __init__(self, pattern: Pattern) -> None:
        self._pattern = pattern
        check_memory(_SUPERLU * len(pattern.indices) * np.log2(max(pattern.size, 2)))

    def renew(self) -> None:
        """Nothing is kept."""

    forget = renew

    def factor(self, data: Array) -> Factored:
        """Factorize; raises BreakdownError."""
        from scipy.sparse.linalg import splu

        try:
            handle = splu(
                self._pattern.matrix(data), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
            )
        except RuntimeError as error:
            raise BreakdownError(str(error)) from error
        solve: Factored = handle.solve
        return solve
