"""Tension of a bar: the elastic law and its slope, taut only."""

from __future__ import annotations

from numba import njit

from .compiled import OPTIONS


@njit(**OPTIONS)
def law_tension(strain, rows, first, end):
    """Tension (N) and its slope dT/dstrain (N) at a strain > 0 by the rows of netting.elastic."""
    row = first
    while row + 1 < end and strain >= rows[row + 1, 0]:
        row += 1
    x = strain - rows[row, 0]
    tension = rows[row, 1] + rows[row, 2] * x
    slope = rows[row, 2]
    if rows[row, 3] != 0.0:
        power = x ** rows[row, 4]
        tension += rows[row, 3] * power
        slope += rows[row, 3] * rows[row, 4] * (power / x if x > 0.0 else 0.0)
    return tension, slope
