"""The bars around every knot, laid out so that the forces on a block of knots are worked out at full vector width.

A knot gathers the forces of its own bars, so every bar is worked out twice, once for each end. That makes blocks of
knots independent of each other: any number of threads finds the same bits, because a block is never divided. In
netting the neighbours of knots that follow each other follow each other too: then one shift of the index serves a
whole block, and nothing is looked up.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..system.elements import Elements
from .compiled import OPTIONS

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

# Knots that are worked on together: their work arrays fit the first-level cache.
BLOCK = 256
# Loops go on to whole strides, so that vector instructions leave no knots over.
STRIDE = 8
# Mark of a slot whose neighbours are looked up.
SCATTERED = np.iinfo(np.int64).min
# Part of a block's knots that a shift must serve to be worth a slot of its own.
WORTH = 0.5

# Rows of the kernels' work arrays (WORK_ROWS, BLOCK).
WORK_ROWS = 17

# Rows of Around.bars.
REST_LENGTH, STIFFNESS, NORMAL, TANGENTIAL, DAMPING, ADDED = range(6)
# Rows of Around.knots; 0 to 2 hold the weight.
KNOT_DRAG, AREA, MASS, FREE = range(3, 7)


class Around(NamedTuple):
    """Slots of every block: in one slot each knot of the block has one bar, or none (a bar without any property).

    knot_count: n; margin: columns before the first knot in the arrays of positions and velocities, (3, width) each,
    and behind the last; first: (blocks + 1,) first slot of a block; shift: (s,) index of the neighbour less that of the
    knot, or SCATTERED; other: (r, BLOCK) columns of looked-up neighbours, other_row: (s,) which row of it; bars:
    (rows, 6, BLOCK) properties as in Elements, bars_row: (s,) which row; knots: (rows, 7, BLOCK) weight N, knot drag
    kg/m, drag coefficient of all that hangs on the knot kg/m, mass kg, free; knots_row: (blocks,). Blocks and slots
    that are alike share a row, which spares memory traffic. bar: (s, BLOCK) index of the bar, m for none, only where
    laws are not linear. linear, damped: as in Elements.
    """

    knot_count: int
    margin: int
    width: int
    first: Ints
    shift: Ints
    other: NDArray[np.uint32]
    other_row: Ints
    bars: Array
    bars_row: Ints
    knots: Array
    knots_row: Ints
    bar: NDArray[np.uint32]
    linear: bool
    damped: bool

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return len(self.first) - 1

    def columns(self, rows: Array) -> Array:
        """Turn (n, 3) into (3, width) with margins of zeros."""
        out = np.zeros((3, self.width))
        out[:, self.margin : self.margin + self.knot_count] = rows.T
        return out

    def rows(self, columns: Array) -> Array:
        """Turn (3, width) back into (n, 3)."""
        return np.ascontiguousarray(columns[:, self.margin : self.margin + self.knot_count].T)


@njit(**OPTIONS)
def differences(slot, here, size, a, around, g, row):
    """What a (3, width) has at the neighbours less what it has at the knots of a block, into three rows of g.

    here: column of the block's first knot; indices are unsigned so that none is taken for one from the end.
    """
    if around.shift[slot] != SCATTERED:
        there = here + np.uint64(around.shift[slot])
        for q in range(3):
            for i in range(size):
                g[row + q, i] = a[q, there + i] - a[q, here + i]
    else:
        other = around.other_row[slot]
        for i in range(size):
            j = around.other[other, i]
            g[row, i] = a[0, j] - a[0, here + i]
            g[row + 1, i] = a[1, j] - a[1, here + i]
            g[row + 2, i] = a[2, j] - a[2, here + i]


@njit(**OPTIONS)
def extent(block, around):
    """First column and number of the knots of a block, unsigned; rounded up to a STRIDE with knots without anything."""
    low = block * BLOCK
    strides = (min(BLOCK, around.knot_count - low) + STRIDE - 1) // STRIDE
    return np.uint64(around.margin + low), np.uint64(strides * STRIDE)


class _Shared:
    """Arrays of one shape, the equal ones kept once."""

    def __init__(self) -> None:
        self.kept: list[Array] = []
        self._place: dict[bytes, int] = {}

    def keep(self, array: Array) -> int:
        place = self._place.setdefault(array.tobytes(), len(self.kept))
        if place == len(self.kept):
            self.kept.append(array)
        return place


class _Ends(NamedTuple):
    """Ends of bars by blocks of knots: knot, index of the neighbour less that of the knot, bar, whether it is a twin.

    Only the first of several bars between the same two knots can go by shift; the others are twins.
    """

    knot: Ints
    away: Ints
    bar: Ints
    twin: NDArray[np.bool_]


def bars_around(el: Elements) -> Around:
    """Lay out the bars around the knots of a net."""
    n, m = len(el.free), len(el.knot_a)
    a, b = el.knot_a.astype(np.int64), el.knot_b.astype(np.int64)
    knot, away, bar = np.concatenate([a, b]), np.concatenate([b - a, a - b]), np.tile(np.arange(m), 2)
    order = np.lexsort((bar, knot, away, knot // BLOCK))
    knot, away, bar = knot[order], away[order], bar[order]
    twin = np.zeros(2 * m, dtype=bool)
    twin[1:] = (knot[1:] == knot[:-1]) & (away[1:] == away[:-1])
    blocks = -(-n // BLOCK)
    start = np.searchsorted(knot // BLOCK, np.arange(blocks + 1))
    margin = int(np.abs(away).max(initial=0)) + BLOCK
    slots = _SlotTable(el, margin)
    for block in range(blocks):
        s = slice(start[block], start[block + 1])
        low = block * BLOCK
        slots.add_block(low, min(BLOCK, n - low), _Ends(knot[s] - low, away[s], bar[s], twin[s]))
    own, own_row = _knot_rows(el, blocks)
    return Around(
        knot_count=n,
        margin=margin,
        width=2 * margin + blocks * BLOCK,
        first=np.array(slots.first),
        shift=np.array(slots.shift, dtype=np.int64),
        other=np.array(slots.other, dtype=np.uint32).reshape(-1, BLOCK),
        other_row=np.array(slots.other_row, dtype=np.int64),
        bars=np.array(slots.bars.kept).reshape(-1, 6, BLOCK),
        bars_row=np.array(slots.bars_row, dtype=np.int64),
        knots=own,
        knots_row=own_row,
        bar=np.array(slots.bar, dtype=np.uint32).reshape(-1, BLOCK),
        linear=el.linear,
        damped=el.damped,
    )


class _SlotTable:
    """The slots of the blocks so far, as in Around."""

    def __init__(self, el: Elements, margin: int) -> None:
        self.properties = np.stack(
            (
                el.rest_length,
                el.stiffness,
                el.normal_drag,
                el.tangential_drag,
                el.damping_time,
                el.bar_added_mass,
            )
        )
        self.look_up_bars, self.margin = not el.linear, margin
        self.bars = _Shared()
        self.first, self.shift, self.bars_row, self.other_row = [0], [], [], []  # type: ignore[var-annotated]
        self.other: list[Ints] = []
        self.bar: list[Ints] = []

    def add_block(self, low: int, size: int, ends: _Ends) -> None:
        """Add the slots of the knots from low on, which are numbered from 0 in ends."""
        none = self.properties.shape[1]
        for which, step in _slots(ends, size):
            place, bar = ends.knot[which], ends.bar[which]
            row = np.zeros((6, BLOCK))
            row[REST_LENGTH] = 1.0
            row[:, place] = self.properties[:, bar]
            self.bars_row.append(self.bars.keep(row))
            self.shift.append(step)
            self.other_row.append(len(self.other))
            if step == SCATTERED:
                column = self.margin + low + np.arange(BLOCK)
                column[place] += ends.away[which]
                self.other.append(column)
            if self.look_up_bars:
                number = np.full(BLOCK, none)
                number[place] = bar
                self.bar.append(number)
        self.first.append(len(self.shift))


def _slots(ends: _Ends, size: int) -> Iterator[tuple[Ints, int]]:
    """Ends that share a slot, and their shift or SCATTERED."""
    shifts, served = np.unique(ends.away[~ends.twin], return_counts=True)
    shifts = shifts[served >= WORTH * size]
    goes = np.isin(ends.away, shifts) & ~ends.twin
    for shift in shifts.tolist():
        yield np.flatnonzero(goes & (ends.away == shift)), shift
    rest = np.flatnonzero(~goes)
    rest = rest[np.argsort(ends.knot[rest], kind="stable")]
    rank = np.arange(len(rest)) - np.searchsorted(ends.knot[rest], ends.knot[rest])
    for slot in range(rank.max(initial=-1) + 1):
        yield rest[rank == slot], SCATTERED


def _knot_rows(el: Elements, blocks: int) -> tuple[Array, Ints]:
    """Arrays knots and knots_row of Around."""
    area = el.knot_drag.copy()
    for end in (el.knot_a, el.knot_b):
        np.add.at(area, end, el.normal_drag * el.rest_length)
    own = np.zeros((7, blocks * BLOCK))
    own[:, : len(el.free)] = (*el.weight.T, el.knot_drag, area, el.knot_mass, el.free)
    shared = _Shared()
    row = [shared.keep(own[:, k * BLOCK : (k + 1) * BLOCK].copy()) for k in range(blocks)]
    return np.array(shared.kept).reshape(-1, 7, BLOCK), np.array(row, dtype=np.int64)
