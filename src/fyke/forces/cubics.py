"""Curves of system.curves in kernels: where a number lies in them, and their cubics there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped] # has no types
from numba import njit, types
from numba.extending import intrinsic as _intrinsic
from numba.extending import register_jitable

from ..system.curves import FIRST, HIGHEST, LOWEST, NODE_BITS, SHIFT
from .apart import keep, kept, take
from .around import PITCH, STRIDE
from .compiled import OPTIONS, WITHIN

# What numba makes of this function has fewer arguments than it is written with.
intrinsic: Any = _intrinsic

_LEAST, _MOST = (1023 + LOWEST) << 52, ((1023 + HIGHEST) << 52) - 1
_FRACTION, _ONE = (1 << SHIFT) - 1, 1023 << 52
_EXPONENT, _WIDTHS = 0x7FF << 52, (2 * 1023 + NODE_BITS) << 52

# Work rows of read, PITCH apart: row of the curve as an integer, part of the interval, the four coefficients there.
ROW, PART, FOUR, READ_ROWS = 0, 1, 2, 6


@register_jitable(**WITHIN)
def place(square):
    """Row of a curve for a square of the Reynolds number, the part of the interval, 0 to 1, and the bits of both.

    Bits of positive numbers rise with them; whatever is beyond the curve, NaN too, is kept to it.
    """
    bits = min(max(int(np.float64(square).view(np.int64)), _LEAST), _MOST)
    part = np.int64(((bits & _FRACTION) << NODE_BITS) | _ONE).view(np.float64) - 1.0
    return (bits >> SHIFT) - FIRST, part, bits


@register_jitable(**WITHIN)
def cubic(curve, square):
    """Value of a curve at a square of the Reynolds number, and its slope by the square."""
    row, t, bits = place(square)
    a, b = take(curve, 4 * row), take(curve, 4 * row + 1)
    c, d = take(curve, 4 * row + 2), take(curve, 4 * row + 3)
    # One over the width of the interval, a power of two; 0 where the curve is held.
    steep = np.int64(_WIDTHS - (bits & _EXPONENT)).view(np.float64) if _LEAST < bits < _MOST else 0.0
    return a + t * (b + t * (c + t * d)), steep * (b + t * (2.0 * c + t * 3.0 * d))


@register_jitable(**WITHIN)
def in_strides(begin, end):
    """End of the last of the strides from begin on that are needed to come to end."""
    return begin + (end - begin + STRIDE - 1) // STRIDE * STRIDE


@njit(**OPTIONS)
def find(begin, end, g, square, work):
    """Find the places of squares that lie in g from square + begin on, for read, to the end of the last stride.

    work: place of the work rows in g.
    """
    for i in range(begin, in_strides(begin, end)):
        row, part, _ = place(kept(g, square + i))
        keep(g, work + ROW * PITCH + i, np.int64(row).view(np.float64))
        keep(g, work + PART * PITCH + i, part)


@njit(**OPTIONS)
def read(begin, end, g, work, curve, factor, out):
    """Put values of a curve at the places that find found, times factors, into g from out + begin on.

    factor: an array and a place in it, less begin.
    """
    factors, at = factor
    fetch_all(begin, end, g, work, curve)
    first = work + FOUR * PITCH
    for i in range(begin, end):
        t = kept(g, work + PART * PITCH + i)
        a, b = kept(g, first + i), kept(g, first + PITCH + i)
        c, d = kept(g, first + 2 * PITCH + i), kept(g, first + 3 * PITCH + i)
        keep(g, out + i, take(factors, at + i) * (a + t * (b + t * (c + t * d))))


@njit(**OPTIONS)
def fetch_all(begin, end, g, work, table):
    """Bring the four numbers of the rows ROW of a table into the work rows FOUR, to the end of the last stride."""
    for i in range(begin, end, STRIDE):
        _fetch(table, g, work + ROW * PITCH + i, work + FOUR * PITCH + i)


def _shuffled(builder: Any, one: Any, other: Any, places: Sequence[int]) -> Any:
    mask = ir.Constant(ir.VectorType(ir.IntType(32), len(places)), list(places))
    return builder.shuffle_vector(one, other, mask)


def _columns(builder: Any, lines: Sequence[Any]) -> list[Any]:
    """Turn eight vectors of four numbers into four of eight."""
    pairs = [_shuffled(builder, lines[k], lines[k + 1], range(8)) for k in range(0, 8, 2)]
    columns = []
    for first in (0, 2):
        taken = [first + which + line for which in (0, 1) for line in (0, 4, 8, 12)]
        halves = [_shuffled(builder, pairs[k], pairs[k + 1], taken) for k in (0, 2)]
        columns += [
            _shuffled(builder, halves[0], halves[1], [*range(k, k + 4), *range(k + 8, k + 12)])
            for k in (0, 4)
        ]
    return columns


@intrinsic
def _fetch(typing, table, g, rows, out):
    """Bring rows of four numbers, which lie together in a table, into four rows of STRIDE numbers, PITCH apart.

    Rows are int64 in g from the place rows on. Eight loads and a transposition in registers take a fraction of the time
    of four gathers, which load 32 times.
    """

    def code(context, builder, signature, args):
        number, whole = ir.DoubleType(), ir.IntType(64)
        four, eight = ir.VectorType(number, 4).as_pointer(), ir.VectorType(number, STRIDE).as_pointer()
        curves, work = (context.make_array(signature.args[k])(context, builder, args[k]).data for k in (0, 1))
        lines = []
        for lane in range(STRIDE):
            at = builder.gep(work, [builder.add(args[2], whole(lane))])
            row = builder.load(builder.bitcast(at, whole.as_pointer()), align=8)
            line = builder.gep(curves, [builder.shl(row, whole(2))])
            lines.append(builder.load(builder.bitcast(line, four), align=8))
        for k, column in enumerate(_columns(builder, lines)):
            at = builder.gep(work, [builder.add(args[3], whole(k * PITCH))])
            builder.store(column, builder.bitcast(at, eight), align=8)

    flat = table.layout == "C" and g.layout == "C"
    return (types.void(table, g, types.int64, types.int64), code) if flat else None
