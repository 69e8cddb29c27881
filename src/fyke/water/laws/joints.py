"""Curves of the Reynolds number, and published pieces of them joined smoothly.

Laws are published in pieces that do not meet: at a joint their coefficient jumps by up to 25 %, which no Newton
iteration likes and no flow has. A curve here goes from one piece to the next within 5 % of the joint on either side,
as w = x^3 (10 - 15 x + 6 x^2) of the logarithm of Re, which has two continuous derivatives. Outside these bands every
piece is as published.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .law import Numbers

BAND = 1.05  # ratio of a joint to the ends of the band around it
LEAST_REYNOLDS = 1e-6  # below it curves are held, so that still water has a finite coefficient and no force
_LN10 = float(np.log(10.0))


@dataclass(frozen=True)
class Curve:
    """A function of the Reynolds number and its derivative; both take float or complex arrays of any shape."""

    value: Callable[[Any], Any]
    slope: Callable[[Any], Any]


def numbers(values: ArrayLike) -> Numbers:
    """Return values as an array of float64, or of complex numbers where they are."""
    array = np.asarray(values)
    return array if np.iscomplexobj(array) else array.astype(np.float64)


def level(value: float) -> Curve:
    """Return a constant."""
    return Curve(lambda re: np.full_like(re, value), np.zeros_like)


def powers(*terms: tuple[float, float]) -> Curve:
    """Return the sum of a Re^b over terms (a, b)."""
    return Curve(
        lambda re: sum(a * re**b for a, b in terms), lambda re: sum(a * b * re ** (b - 1.0) for a, b in terms)
    )


def log_polynomial(*coefficients: float) -> Curve:
    """Return the sum of c_k (log10 Re)^k, lowest power first."""
    row = np.polynomial.Polynomial(coefficients)
    steep = row.deriv()
    return Curve(lambda re: row(np.log(re) / _LN10), lambda re: steep(np.log(re) / _LN10) / (re * _LN10))


def ten_to(curve: Curve) -> Curve:
    """Return ten to the power of a curve."""
    return Curve(
        lambda re: np.exp(_LN10 * curve.value(re)),
        lambda re: np.exp(_LN10 * curve.value(re)) * _LN10 * curve.slope(re),
    )


def joined(pieces: Sequence[Curve], joints: Sequence[float] = ()) -> Curve:
    """Join pieces, in the order of rising Re, at the Reynolds numbers between them.

    joints: one fewer than the pieces, more than BAND^2 apart from each other. ValueError when they are not.
    """
    ends = [LEAST_REYNOLDS, *joints, np.inf]
    if len(joints) != len(pieces) - 1 or any(b <= a * BAND**2 for a, b in pairwise(ends)):
        raise ValueError(
            "the pieces of a curve need rising joints between them, further apart than their bands"
        )
    reach = [
        (low if number == 0 else low / BAND, high * BAND) for number, (low, high) in enumerate(pairwise(ends))
    ]

    def value(re: Any) -> Any:
        shares, _ = _shares(re, joints)
        return sum(
            share * piece.value(_within(re, *room))
            for share, piece, room in zip(shares, pieces, reach, strict=True)
        )

    def slope(re: Any) -> Any:
        shares, steep = _shares(re, joints)
        held = np.real(re) < LEAST_REYNOLDS
        total = sum(
            share * piece.slope(_within(re, *room)) + change * piece.value(_within(re, *room))
            for share, change, piece, room in zip(shares, steep, pieces, reach, strict=True)
        )
        return np.where(held, 0.0, total)

    return Curve(value, slope)


def _within(re: Any, low: float, high: float) -> Any:
    return np.where(np.real(re) < low, low, np.where(np.real(re) > high, high, re))


def _shares(re: Any, joints: Sequence[float]) -> tuple[list[Any], list[Any]]:
    """Return the weight of every piece and its derivative; at any Re no more than two weights are not 0."""
    safe = _within(re, LEAST_REYNOLDS, np.inf)
    shares, steep = [np.ones_like(safe)], [np.zeros_like(safe)]
    for joint in joints:
        x = _within(0.5 + 0.5 * np.log(safe / joint) / np.log(BAND), 0.0, 1.0)
        after = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
        rate = 30.0 * x**2 * (1.0 - x) ** 2 * 0.5 / (np.log(BAND) * safe)
        before, slope_before = shares[-1], steep[-1]
        shares[-1:] = [before * (1.0 - after), before * after]
        steep[-1:] = [slope_before * (1.0 - after) - before * rate, slope_before * after + before * rate]
    return shares, steep
