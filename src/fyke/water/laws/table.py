"""Laws of a user's own measurements: coefficients at points, straight in ln Re (and in the angle) between them.

Beyond the first and the last point they are held. The slope jumps at the points; the coefficients do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .joints import LEAST_REYNOLDS, numbers
from .law import ANGLE, REYNOLDS, AngleLaw, Numbers, Pair, Range, SplitLaw

Row = tuple[float, ...]
_SOURCE = "the user's table"


def _rising(values: Sequence[float], what: str, low: float, high: float = np.inf) -> None:
    row = np.asarray(values, dtype=float)
    fits = row.ndim == 1 and len(row) > 1 and bool(np.all(np.isfinite(row) & (row >= low) & (row <= high)))
    if not fits or bool(np.any(np.diff(row) <= 0.0)):
        raise ValueError(f"{what} must be two or more rising numbers from {low:g} to {high:g}: {values!r}")


def _usable(values: ArrayLike, shape: tuple[int, ...], what: str, *, signed: bool = False) -> None:
    table = np.asarray(values, dtype=float)
    if table.shape != shape or not np.all(np.isfinite(table)) or (not signed and bool(np.any(table < 0.0))):
        sign = "" if signed else " that are not negative"
        raise ValueError(f"{what} must be finite numbers{sign} in the shape {shape}")


def _place(points: Numbers, at: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Return interval, fraction of it (0 to 1) and whether that is held at an end."""
    first = np.clip(np.searchsorted(points, np.real(at), side="right") - 1, 0, len(points) - 2)
    fraction = (at - points[first]) / (points[first + 1] - points[first])
    low, high = np.real(fraction) < 0.0, np.real(fraction) >= 1.0
    return first, np.where(low, 0.0, np.where(high, 1.0, fraction)), low | high


def _logarithm(reynolds: Numbers) -> Numbers:
    return np.asarray(np.log(np.where(np.real(reynolds) < LEAST_REYNOLDS, LEAST_REYNOLDS, reynolds)))


@dataclass(frozen=True)
class BarTable(SplitLaw):
    """C_n and C_t at n Reynolds numbers; ValueError when they do not rise or a coefficient is negative."""

    name = "table"
    title = "C_n and C_t by Re, from a file"
    source = _SOURCE
    read = "-"
    reynolds: Row
    normal: Row
    tangential: Row

    def __post_init__(self) -> None:
        """Check the numbers."""
        _rising(self.reynolds, "Reynolds numbers", LEAST_REYNOLDS)
        for what, values in (("C_n", self.normal), ("C_t", self.tangential)):
            _usable(values, (len(self.reynolds),), what)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """From the first to the last Reynolds number."""
        return (Range(REYNOLDS, self.reynolds[0], self.reynolds[-1]),)

    def coefficients(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return C_n and C_t, both at the Reynolds number of the speed across."""
        first, part, _ = _place(np.log(self.reynolds), _logarithm(numbers(reynolds)))
        normal, tangential = np.asarray(self.normal), np.asarray(self.tangential)
        return (
            normal[first] * (1.0 - part) + normal[first + 1] * part,
            tangential[first] * (1.0 - part) + tangential[first + 1] * part,
        )

    def derivative(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return the derivatives, at a point those of the interval above it."""
        re, points = numbers(reynolds), np.log(self.reynolds)
        first, _, held = _place(points, _logarithm(re))
        rate = np.where(held, 0.0, 1.0) / (np.where(held, 1.0, re) * np.diff(points)[first])
        return rate * np.diff(self.normal)[first], rate * np.diff(self.tangential)[first]


@dataclass(frozen=True)
class AngleTable(AngleLaw):
    """C_D and C_L at n Reynolds numbers (rows) and m angles (rad, columns), 0 to pi/2; ValueError as in BarTable."""

    name = "angle-table"
    title = "C_D and C_L by Re and angle, from a file"
    source = _SOURCE
    read = "-"
    reynolds: Row
    angle: Row
    drag: tuple[Row, ...]
    lift: tuple[Row, ...]

    def __post_init__(self) -> None:
        """Check the numbers."""
        _rising(self.reynolds, "Reynolds numbers", LEAST_REYNOLDS)
        _rising(self.angle, "angles", 0.0, float(np.pi / 2.0))
        shape = (len(self.reynolds), len(self.angle))
        _usable(self.drag, shape, "C_D")
        _usable(self.lift, shape, "C_L", signed=True)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """From the first to the last Reynolds number and angle."""
        return (
            Range(REYNOLDS, self.reynolds[0], self.reynolds[-1]),
            Range(ANGLE, self.angle[0], self.angle[-1]),
        )

    def drag_lift(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return C_D and C_L; angles beyond pi/2 mirror those below it, with the lift the other way."""
        low, high, part, _, turned = self._rows(reynolds, angle)
        drag, lift = (below * (1.0 - part) + above * part for below, above in zip(low, high, strict=True))
        return drag, lift * turned

    def derivative(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return the derivatives with respect to Re, at a point those of the interval above it."""
        low, high, _, rate, turned = self._rows(reynolds, angle)
        drag, lift = ((above - below) * rate for below, above in zip(low, high, strict=True))
        return drag, lift * turned

    def _rows(self, reynolds: ArrayLike, angle: ArrayLike) -> tuple[Pair, Pair, Numbers, Numbers, Numbers]:
        """Return both tables at the Reynolds numbers around, the part of the way between them, its slope, the side."""
        re, slant = numbers(reynolds), np.asarray(angle, dtype=float)
        turned = np.where(np.cos(slant) < 0.0, -1.0, 1.0)
        points = np.log(self.reynolds)
        row, part, held = _place(points, _logarithm(re))
        rate = np.where(held, 0.0, 1.0) / (np.where(held, 1.0, re) * np.diff(points)[row])
        column, across, _ = _place(
            np.asarray(self.angle), np.arctan2(np.abs(np.sin(slant)), np.abs(np.cos(slant)))
        )

        def at(line: Numbers) -> Pair:
            tables = np.asarray(self.drag), np.asarray(self.lift)
            drag, lift = (t[line, column] * (1.0 - across) + t[line, column + 1] * across for t in tables)
            return drag, lift

        return at(row), at(row + 1), part, rate, turned
