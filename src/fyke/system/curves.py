"""Coefficient laws as the kernels read them: cubics between close nodes of the square of a speed.

Nodes divide every octave of the speed squared into equal parts, so that a place is found from the bits of a number,
without a logarithm. Value and slope are exact at the nodes; between them smooth laws are met to 1e-8, and the narrow
transitions between the pieces of some to 1e-5.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..water.laws import AngleTable, BarLaw, KnotLaw, SplitLaw
from ..water.laws.bars import Hoerner

Array = NDArray[np.float64]

# Nodes of an octave, 2^NODE_BITS; speeds squared from 2^LOWEST to 2^HIGHEST m2/s2: beyond, coefficients are held.
NODE_BITS, LOWEST, HIGHEST = 6, -40, 10
SHIFT = 52 - NODE_BITS
FIRST = (1023 + LOWEST) << NODE_BITS
INTERVALS = (HIGHEST - LOWEST) << NODE_BITS
# Columns of a row of bars: four of each of three curves, then 1 / width of the interval (s2/m2).
INVERSE_WIDTH, ROW = 12, 16
# Speed (m/s) at which a law's coefficient stands where one number is needed.
REFERENCE_SPEED = 0.5


class Angles(NamedTuple):
    """C_D and C_L by speed and angle, over a reference: logs of Re (r,), angles (a,) rad, drag and lift (r, a).

    All are empty for none.
    """

    reynolds: Array
    angle: Array
    drag: Array
    lift: Array


NO_ANGLES = Angles(np.zeros(0), np.zeros(0), np.zeros((0, 0)), np.zeros((0, 0)))


class BarCurves(NamedTuple):
    """Coefficients of bars of some thicknesses under one law, over the coefficient `reference` of each.

    reference: (k,) C_n at REFERENCE_SPEED, or 1 where that is 0; along: (k,) C_t there; rows: (k, INTERVALS, ROW), see
    forces.laws; friction: of the whole speed, along the flow.
    """

    reference: Array
    along: Array
    rows: Array
    friction: float
    angles: Angles


def nodes() -> Array:
    """Squares of speeds at the ends of the intervals, (INTERVALS + 1,) m2/s2."""
    bits = (np.arange(INTERVALS + 1, dtype=np.int64) + FIRST) << SHIFT
    return bits.view(np.float64)


def _cubics(value: Array, slope: Array) -> Array:
    """Coefficients (INTERVALS, 4) of Hermite's cubics over the part of an interval, from values and slopes at nodes."""
    width = np.diff(nodes())
    rise, first, last = np.diff(value), width * slope[:-1], width * slope[1:]
    return np.column_stack([value[:-1], first, 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise])


def bar_curves(law: BarLaw, reynolds_per_speed: Array) -> BarCurves:
    """Tabulate a law for bars of thickness over viscosity (k,) s/m. TypeError for a law of no known form."""
    count = len(reynolds_per_speed)
    if isinstance(law, AngleTable):
        middle = REFERENCE_SPEED * float(np.mean(reynolds_per_speed))
        reference = float(law.force(middle, np.pi / 2.0)[0]) or 1.0
        tables = (np.array(table, dtype=float) / reference for table in (law.drag, law.lift))
        angles = Angles(np.log(law.reynolds), np.array(law.angle, dtype=float), *tables)
        along = np.full(count, float(law.force(middle, 0.0)[1]))
        return BarCurves(np.full(count, reference), along, np.zeros((count, 1, ROW)), 0.0, angles)
    if isinstance(law, Hoerner):
        rows = np.zeros((count, INTERVALS, ROW))
        rows[:, :, 0] = 1.0
        rows[:, :, INVERSE_WIDTH] = 1.0 / np.diff(nodes())
        return BarCurves(
            np.full(count, law.across),
            np.full(count, law.friction),
            rows,
            law.friction / law.across,
            NO_ANGLES,
        )
    if not isinstance(law, SplitLaw):
        raise TypeError(f"no way is known to tabulate the law {type(law).__name__}")
    return _split_curves(law, reynolds_per_speed)


def _split_curves(law: SplitLaw, reynolds_per_speed: Array) -> BarCurves:
    """C_n, and C_t = a(Re_n)/Re_t + b(Re_n), which every split law is: found from two Re_t."""
    square = nodes()
    speed = np.sqrt(square)
    tables, reference, tangential = [], [], []
    for r in reynolds_per_speed.tolist():
        there = np.array([REFERENCE_SPEED * r])
        normal, along = (float(one[0]) for one in law.coefficients(there, there))
        scale = normal or 1.0
        re, one, two = r * speed, np.ones_like(speed), np.full_like(speed, 2.0)
        steep = r / (2.0 * speed)
        (across, once), (_, half) = law.coefficients(re, one), law.coefficients(re, two)
        (slope, once_slope), (_, half_slope) = law.derivative(re, one), law.derivative(re, two)
        row = np.zeros((INTERVALS, ROW))
        row[:, 0:4] = _cubics(across / scale, slope * steep / scale)
        row[:, 4:8] = _cubics(
            2.0 * (once - half) / (r * scale), 2.0 * (once_slope - half_slope) * steep / (r * scale)
        )
        row[:, 8:12] = _cubics((2.0 * half - once) / scale, (2.0 * half_slope - once_slope) * steep / scale)
        row[:, INVERSE_WIDTH] = 1.0 / np.diff(square)
        tables.append(row)
        reference.append(scale)
        tangential.append(along)
    rows = np.array(tables).reshape(len(tables), INTERVALS, ROW)
    return BarCurves(np.array(reference), np.array(tangential), rows, 0.0, NO_ANGLES)


def knot_curves(law: KnotLaw, reynolds_per_speed: Array) -> tuple[Array, Array]:
    """C_D (k,) at REFERENCE_SPEED, or 1 where that is 0, and rows (k, INTERVALS, 5) of C_D over it."""
    speed = np.sqrt(nodes())
    r = reynolds_per_speed[:, None]
    reference = _not_zero(np.asarray(law.coefficients(REFERENCE_SPEED * reynolds_per_speed), dtype=float))
    value = np.asarray(law.coefficients(r * speed)) / reference[:, None]
    slope = np.asarray(law.derivative(r * speed)) * r / (2.0 * speed) / reference[:, None]
    inverse = 1.0 / np.diff(nodes())
    rows = [np.column_stack([_cubics(v, s), inverse]) for v, s in zip(value, slope, strict=True)]
    return reference, np.array(rows).reshape(len(rows), INTERVALS, 5)


def _not_zero(coefficients: Array) -> Array:
    return np.where(coefficients == 0.0, 1.0, coefficients)
