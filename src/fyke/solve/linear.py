"""Sparse linear systems of a net behind one callable: every solution is checked, and put right where that is needed."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from .cholesky import Cholmod
from .clock import charged
from .engines import BreakdownError, Engine, Factored, Rslab, RslabSmall, RslabSymmetric, SuperLU
from .memory import NotEnoughMemoryError
from .pattern import Pattern
from .residual import residual

__all__ = ["Factorizer", "LinearName", "Pattern", "SingularMatrixError", "Solve", "factorizer"]

Array = NDArray[np.float64]
Solve = Callable[[Array], Array]
LinearName = Literal["rslab", "cholmod", "superlu"]

# Below so many unknowns kept pivots are faster than a supernodal factorization.
SMALL = 3_000
# A solution whose residual, over the right side, is above REFINE is refined: on the hardest nets tried a factorization
# leaves 2e-9. One that stays above USELESS is none: on a matrix without inverse it is some 1 before refinement, and a
# thousandth and more after it.
REFINE, USELESS = 1e-8, 1e-4
# Shift of the diagonal, over the largest entry, that gives a matrix without inverse one; inverse iterations with it.
SHIFT, NULL_ITERATIONS = 1e-14, 3


class SingularMatrixError(Exception):
    """The matrix has no inverse to working precision.

    unknown: the one of the 3 n_free that the matrix holds least, None where that could not be found out.
    """

    def __init__(self, message: str, find: Callable[[], int | None]) -> None:
        super().__init__(message)
        self._find = find

    @property
    def unknown(self) -> int | None:
        """Find it: costs a factorization, which callers that go another way need not pay."""
        return self._find()


class Factorizer(Protocol):
    """Factorizes matrices of one pattern."""

    name: str

    def renew(self) -> None:
        """Keep nothing of the matrices so far, so that what follows does not depend on them."""

    def factor(self, data: Array) -> Solve:
        """Return the solve of a matrix with this data, good until the next is factorized.

        This and the solve raise SingularMatrixError; this raises NotEnoughMemoryError too.
        """


class Checked:
    """A sparse solver whose solutions are checked on the matrix itself."""

    @charged("factorizing")
    def __init__(
        self, pattern: Pattern, engine: Callable[[Pattern], Engine], name: str, useless: float = USELESS
    ) -> None:
        self.name, self._pattern, self._useless = name, pattern, useless
        self._engine: Engine | None = None
        # Told at the first factorization, where callers expect that something may fail.
        self._too_large: NotEnoughMemoryError | None = None
        try:
            self._engine = engine(pattern)
        except NotEnoughMemoryError as error:
            self._too_large = error

    def renew(self) -> None:
        """Keep nothing of the matrices so far."""
        if self._engine is not None:
            self._engine.renew()

    @charged("factorizing")
    def factor(self, data: Array) -> Solve:
        """Return the solve of a matrix with this data, good until the next is factorized."""
        if self._engine is None:
            raise self._too_large or MemoryError
        # The caller may fill its array anew while the solve is still in use.
        return CheckedSolve(self._pattern, self._engine, data.copy(), self._useless)


class CheckedSolve:
    """One factorized matrix."""

    def __init__(self, pattern: Pattern, engine: Engine, data: Array, useless: float) -> None:
        self._pattern, self._engine, self._data, self._useless = pattern, engine, data, useless
        self._indices, self._indptr = pattern.indices, pattern.indptr
        self._left = np.empty(pattern.size)
        self._solve = self._factor()

    def _factor(self) -> Factored:
        try:
            return self._engine.factor(self._data)
        except BreakdownError as error:
            raise SingularMatrixError(str(error), self._held_least) from error

    @charged("solving")
    def __call__(self, right: Array) -> Array:
        """Solve; raises SingularMatrixError."""
        x = self._solve(right)
        left = self._check(x, right)
        if left <= REFINE:
            return x
        x, left = self._refined(x, left, right)
        if not left <= REFINE and self._engine.kept:
            self._engine.forget()
            self._solve = self._factor()
            x = self._solve(right)
            x, left = self._refined(x, self._check(x, right), right)
        # Written so that a NaN fails it too.
        if not left <= self._useless:
            raise SingularMatrixError(f"a solution leaves {left:.1e} of its right side", self._held_least)
        return x

    def _check(self, x: Array, right: Array) -> float:
        left: float = residual(self._data, self._indices, self._indptr, x, right, self._left)
        return left

    def _refined(self, x: Array, left: float, right: Array) -> tuple[Array, float]:
        """One step of iterative refinement, taken back where it makes things worse."""
        better = x + self._solve(self._left)
        remains = self._check(better, right)
        return (x, left) if remains > left else (better, remains)

    def _held_least(self) -> int | None:
        """Largest entry of the vector that the matrix makes smallest, by inverse iteration; None if a number is NaN."""
        p, size = self._pattern, float(np.abs(self._data).max(initial=0.0))
        if not np.isfinite(size) or p.size == 0:
            return None
        begin, stride = p.diagonal[p.free].T
        shifted = self._data.copy()
        for q in range(3):
            shifted[begin + q * (stride + 1)] += SHIFT * size if size > 0.0 else 1.0
        self._engine.forget()
        # A vector at random, because one of ones is blind to what is odd about a symmetric net's middle.
        x = np.random.default_rng(0).standard_normal(p.size)
        try:
            solve = self._engine.factor(shifted)
        except BreakdownError:
            return None
        for _ in range(NULL_ITERATIONS):
            x = solve(x)
            x /= np.abs(x).max()
        self._engine.forget()
        return int(np.argmax(np.abs(x))) if np.all(np.isfinite(x)) else None


def factorizer(
    pattern: Pattern, name: LinearName | None = None, useless: float = USELESS, symmetric: bool = False
) -> Factorizer:
    """Return a solver: rslab (LU), cholmod (Cholesky and GMRES), superlu (LU); the first that is installed by default.

    useless: residual, over the right side, from which a solution counts as none and the matrix as without inverse.
    symmetric: all matrices will be, which rslab makes use of on large nets.
    Raises ValueError for another name, ModuleNotFoundError when the package of a chosen one is missing.
    """
    if name is None:
        found = (one for one, package in _PACKAGES.items() if find_spec(package) is not None)
        name = next(found)
    if name not in _PACKAGES:
        raise ValueError(f"linear must be one of {', '.join(_PACKAGES)}, not {name!r}")
    if name == "cholmod":
        return Checked(pattern, Cholmod, "CHOLMOD and GMRES", useless)
    if name == "superlu":
        return Checked(pattern, SuperLU, "SuperLU", useless)
    if len(pattern.indptr) <= SMALL:
        return Checked(pattern, RslabSmall, "rslab KLU", useless)
    if symmetric:
        return Checked(pattern, RslabSymmetric, "rslab LDLT", useless)
    return Checked(pattern, Rslab, "rslab LU", useless)


# By speed, and the package of each.
_PACKAGES: dict[LinearName, str] = {"rslab": "rslab", "cholmod": "cvxopt", "superlu": "scipy"}
