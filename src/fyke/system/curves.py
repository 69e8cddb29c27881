"""Coefficient laws as the kernels read them: cubics between close nodes of the square of the Reynolds number.

Nodes divide every octave of the square into equal parts, so that a place is found from the bits of a number, without a
root or a logarithm (IEEE 754: 52 bits of fraction behind the exponent). Value and slope are exact at the nodes.
Between them smooth laws are met to 1e-11, the transitions between the pieces of joined ones to 1e-6 at worst, and the
corners of a user's table are round within 0.4 % of Re.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..water.laws import AngleTable, BarLaw, KnotLaw, SplitLaw
from ..water.laws.bars import ConstantBar, Hoerner
from ..water.laws.knots import ConstantKnot

Array = NDArray[np.float64]

# Nodes of an octave, 2^NODE_BITS; squares from 2^LOWEST, below water.laws.joints.LEAST_REYNOLDS from which curves are
# held, to 2^HIGHEST, beyond the range of every law.
NODE_BITS, LOWEST, HIGHEST = 8, -40, 48
SHIFT = 52 - NODE_BITS
FIRST = (1023 + LOWEST) << NODE_BITS
INTERVALS = (HIGHEST - LOWEST) << NODE_BITS
LOWEST_REYNOLDS, HIGHEST_REYNOLDS = 2.0 ** (LOWEST / 2), 2.0 ** (HIGHEST / 2)
# Where a law's coefficient stands when one number is needed: of a twine of 2 mm at 0.5 m/s.
REFERENCE_REYNOLDS = 1000.0

NONE = np.zeros((0, 4))


class Angles(NamedTuple):
    """C_D and C_L by speed and angle: a + b ln Re + c q + d q ln Re at the angle q in every cell of a user's table.

    reynolds: (r,) ln Re and angle: (a,) rad, edges of the cells; rows: ((r - 1) (a - 1) 2, 4), a to d of C_D and then
    of C_L of every cell, over the reference. All are empty for none.
    """

    reynolds: Array
    angle: Array
    rows: Array


NO_CELLS = Angles(np.zeros(0), np.zeros(0), NONE)


class BarCurves(NamedTuple):
    """A law of bars over its C_n at REFERENCE_REYNOLDS, or 1 where that is 0; every curve is (INTERVALS, 4).

    across: C_n of Re_n, (0, 4) where it is the constant 1; viscous, along: curves of Re_n of which
    C_t = viscous / Re_t + along, both (0, 4) where C_t is constant; whole: C_t is a friction on the whole speed, along
    the flow; cells: C_D and C_L in place of all that.
    """

    across: Array
    viscous: Array
    along: Array
    whole: bool
    cells: Angles


CONSTANT_BARS = BarCurves(NONE, NONE, NONE, whole=False, cells=NO_CELLS)


def squares() -> Array:
    """Squares of the Reynolds number at the ends of the intervals, (INTERVALS + 1,)."""
    bits = (np.arange(INTERVALS + 1, dtype=np.int64) + FIRST) << SHIFT
    return bits.view(np.float64)


def curve_of(value: Callable[[Any], ArrayLike], slope: Callable[[Any], ArrayLike]) -> Array:
    """Tabulate a function of the Reynolds number and its derivative, (INTERVALS, 4)."""
    re = np.sqrt(squares())
    return _hermite(np.asarray(value(re)), np.asarray(slope(re)) / (2.0 * re))


def _hermite(value: Array, slope: Array) -> Array:
    """Coefficients (INTERVALS, 4) of the powers of the part of an interval, from values and slopes at the nodes."""
    width = np.diff(squares())
    rise, first, last = np.diff(value), width * slope[:-1], width * slope[1:]
    return np.column_stack([value[:-1], first, 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise])


def bar_curves(law: BarLaw) -> tuple[float, float, BarCurves]:
    """C_n and C_t at REFERENCE_REYNOLDS, C_n 1 where it is 0, and the law over that C_n. TypeError for unknown laws."""
    if isinstance(law, ConstantBar):
        return law.normal, law.tangential, CONSTANT_BARS
    if isinstance(law, AngleTable):
        reference = float(law.force(REFERENCE_REYNOLDS, np.pi / 2.0)[0]) or 1.0
        along = float(law.force(REFERENCE_REYNOLDS, 0.0)[1])
        return reference, along, CONSTANT_BARS._replace(cells=_cells(law, reference))
    if isinstance(law, Hoerner):
        return law.across, law.friction, CONSTANT_BARS._replace(whole=True)
    if not isinstance(law, SplitLaw):
        raise TypeError(f"no way is known to tabulate the law {type(law).__name__}")
    return _split_curves(law)


@lru_cache(maxsize=16)
def _split_curves(law: SplitLaw) -> tuple[float, float, BarCurves]:
    """C_n, and C_t = a(Re_n) / Re_t + b(Re_n), which every split law is: found from two Re_t."""
    there = np.array([REFERENCE_REYNOLDS])
    normal, tangential = (float(one[0]) for one in law.coefficients(there, there))
    reference = normal or 1.0
    re = np.sqrt(squares())
    one, two = np.ones_like(re), np.full_like(re, 2.0)
    (across, once), (_, half) = law.coefficients(re, one), law.coefficients(re, two)
    (slope, once_slope), (_, half_slope) = law.derivative(re, one), law.derivative(re, two)

    def curve(value: Array, steep: Array) -> Array:
        return _hermite(value / reference, steep / (2.0 * re * reference))

    viscous, along = NONE, NONE
    if np.any(once != half):
        viscous = curve(2.0 * (once - half), 2.0 * (once_slope - half_slope))
    left, left_slope = 2.0 * half - once, 2.0 * half_slope - once_slope
    if np.any(left != (tangential if viscous is NONE else 0.0)):
        along = curve(left, left_slope)
    constant = normal != 0.0 and np.all(across == normal)
    across = NONE if constant else curve(across, slope)
    return reference, tangential, BarCurves(across, viscous, along, whole=False, cells=NO_CELLS)


def _cells(law: AngleTable, reference: float) -> Angles:
    """Cells of a table between whose points C_D and C_L are straight in ln Re and in the angle."""
    log, q = np.log(law.reynolds), np.array(law.angle, dtype=float)
    rows = np.stack([_planes(log, q, np.array(table) / reference) for table in (law.drag, law.lift)], axis=2)
    return Angles(log, q, rows.reshape(-1, 4))


def _planes(log: Array, q: Array, table: Array) -> Array:
    """Coefficients (r - 1, a - 1, 4) of 1, ln Re, q and q ln Re in the cells of a table (r, a)."""
    dlog, dq = np.diff(log)[:, None], np.diff(q)[None, :]
    log0, q0, corner = log[:-1, None], q[None, :-1], table[:-1, :-1]
    by_log, by_q = np.diff(table, axis=0)[:, :-1] / dlog, np.diff(table, axis=1)[:-1] / dq
    both = np.diff(np.diff(table, axis=0), axis=1) / (dlog * dq)
    flat = corner - by_log * log0 - by_q * q0 + both * log0 * q0
    return np.stack([flat, by_log - both * q0, by_q - both * log0, both], axis=-1)


@lru_cache(maxsize=16)
def knot_curve(law: KnotLaw) -> tuple[float, Array]:
    """C_D at REFERENCE_REYNOLDS, or 1 where that is 0, and C_D over it: (INTERVALS, 4), (0, 4) where it is constant."""
    if isinstance(law, ConstantKnot):
        return law.drag, NONE
    reference = float(law.coefficients(REFERENCE_REYNOLDS)) or 1.0
    return reference, curve_of(law.coefficients, law.derivative) / reference
