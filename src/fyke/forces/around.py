"""The bars around every knot, laid out so that the forces on a block of knots are worked out at full vector width.

A block of knots gathers the forces of its own bars: those between two of its knots are worked out once, those to other
blocks once for each end. That makes blocks independent of each other: any number of threads finds the same bits,
because a block is never divided. In netting the neighbours of knots that follow each other follow each other too: then
one shift of the index serves a whole block, and nothing is looked up.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..system.elements import DragLaws, Elements
from .apart import take
from .compiled import INLINED

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

# Knots that are worked on together: their work arrays fit the first-level cache.
BLOCK = 256
# Loops go on to whole strides, so that vector instructions leave no knots over.
STRIDE = 8
# Mark of a slot whose neighbours are looked up.
SCATTERED = np.iinfo(np.int64).min
# A shift is worth a slot of its own for so many bars, and so large a part of the knots from the first to the last.
FEWEST, WORTH = 4, 0.5
# Knots nearer in height than so much of the shortest bar lie in one row; another order must have so many times fewer
# ways from knot to neighbour.
ROW, FEWER_WAYS = 1e-3, 0.5

# Fields, flat with rows of Around.width: position m and velocity m/s at two times, velocity of the water m/s.
HERE_ROWS, WATER, FIELD_ROWS = 6, 12, 15
# Work arrays of the kernels: flat, rows of PITCH; sums of bars may end a stride behind the last knot.
PITCH = BLOCK + STRIDE
# Rows of the work array of looked-up neighbours: position, velocity, velocity of the water.
NEAR_ROWS = 9

# Rows of Around.bars.
REST_LENGTH, STIFFNESS, NORMAL, TANGENTIAL, DAMPING, ADDED, REYNOLDS, BAR_ROWS = range(8)
# Rows of Around.knots; 0 to 2 hold the weight.
KNOT_DRAG, AREA, MASS, FREE, KNOT_REYNOLDS, KNOT_SHARE, KNOT_ROWS = range(3, 10)


class Around(NamedTuple):
    """Slots of every block: in one slot each knot of the block has one bar, or none (a bar without any property).

    knot_count: n; margin: columns before the first knot in the rows of fields, and behind the last; width: length of a
    row; first: (blocks + 1,) first slot of a block; shift: (s,) index of the neighbour less that of the knot, or
    SCATTERED; begin, end: (s,) knots of the block, in whole strides, that have bars in the slot; both: (s,) whether the
    neighbours lie in the block too and get their forces from this slot; other: (r, BLOCK) columns of looked-up
    neighbours, other_row: (s,) which row of it; bars: flat (rows, BAR_ROWS, BLOCK), properties as in Elements,
    bars_row: (s,) which row; knots: flat (rows, KNOT_ROWS, BLOCK), weight N, knot drag kg/m, drag coefficient of all
    that hangs on the knot kg/m, mass kg, free, Re over speed s/m, part of its drag by law; knots_row: (blocks,).
    Blocks and slots that are alike share a row, which spares memory traffic. bar: (s, BLOCK) index of the bar, m for
    none, only where laws are not linear or bars are renewed. linear, damped: as in Elements.
    """

    knot_count: int
    margin: int
    width: int
    first: Ints
    shift: Ints
    begin: Ints
    end: Ints
    both: NDArray[np.bool_]
    other: NDArray[np.int64]
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

    def fields(self) -> Array:
        """Return fields of zeros."""
        return np.zeros(FIELD_ROWS * self.width)

    def write(self, fields: Array, row: int, values: Array) -> None:
        """Write (n, 3) into three rows of fields from row on."""
        fields.reshape(FIELD_ROWS, self.width)[row : row + 3, self.margin : self.margin + self.knot_count] = (
            values.T
        )

    def read(self, fields: Array, row: int) -> Array:
        """Return three rows of fields from row on as (n, 3)."""
        rows = fields.reshape(FIELD_ROWS, self.width)[row : row + 3]
        return np.ascontiguousarray(rows[:, self.margin : self.margin + self.knot_count].T)


@njit(**INLINED)
def own_fields(old, here, water, fields, around):
    """Where the fields of a block's knots lie: array, pitch of its rows, places of x, v and u of the first knot.

    old: row of x in fields; here: column of the block's first knot; water: column of the velocity of the water at it.
    """
    width = around.width
    return fields, width, old * width + here, (old + 3) * width + here, WATER * width + water


@njit(**INLINED)
def neighbours(slot, old, here, water, fields, around, near):
    """Where the fields of the neighbours of a block's knots lie in one slot, as own_fields says it.

    old, here, water: as there; near: work array (NEAR_ROWS x PITCH,) for the neighbours that have to be looked up.
    """
    shift, width = around.shift[slot], around.width
    if shift != SCATTERED:
        there = here + shift
        return own_fields(old, there, there if water == here else water, fields, around)
    other = around.other_row[slot] * BLOCK
    for q in range(3):
        for i in range(around.begin[slot], around.end[slot]):
            j = take(around.other, other + i)
            near[q * PITCH + i] = take(fields, (old + q) * width + j)
            near[(3 + q) * PITCH + i] = take(fields, (old + 3 + q) * width + j)
            near[(6 + q) * PITCH + i] = take(fields, (WATER + q) * width + j)
    return near, PITCH, 0, 3 * PITCH, 6 * PITCH


@njit(**INLINED)
def extent(block, around):
    """First column and number of the knots of a block, rounded up to a STRIDE with knots without anything."""
    low = block * BLOCK
    strides = (min(BLOCK, around.knot_count - low) + STRIDE - 1) // STRIDE
    return around.margin + low, strides * STRIDE


class _Shared:
    """Arrays of one shape, the equal ones kept once."""

    def __init__(self, *, all_apart: bool = False) -> None:
        self.kept: list[Array] = []
        self._place: dict[bytes, int] = {}
        self._all_apart = all_apart

    def keep(self, array: Array) -> int:
        if self._all_apart:
            self.kept.append(array)
            return len(self.kept) - 1
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


def knots_in_order(el: Elements, positions: Array) -> Ints:
    """Order (n,) of the knots in which most bars lead as far ahead as others: as numbered, or by place, rows first.

    positions: (n, 3) m, of the net as built. Knots numbered by rows, as fyke numbers netting, stay as they are.
    """
    n = len(positions)
    grain = ROW * float(el.rest_length.min(initial=np.inf))
    if not (np.isfinite(grain) and grain > 0.0):
        return np.arange(n)
    rows = np.rint(positions / grain)
    by_place = np.lexsort((rows[:, 0], rows[:, 1], rows[:, 2]))
    place = np.empty(n, dtype=np.int64)
    place[by_place] = np.arange(n)

    def ways(numbers: Ints) -> int:
        return len(np.unique(np.abs(numbers[el.knot_a] - numbers[el.knot_b])))

    return by_place if ways(place) < FEWER_WAYS * ways(np.arange(n)) else np.arange(n)


def renumbered(el: Elements, order: Ints) -> Elements:
    """Return the elements with the knots in another order (n,)."""
    place = np.empty(len(order), dtype=np.uint32)
    place[order] = np.arange(len(order), dtype=np.uint32)
    return el._replace(
        knot_a=place[el.knot_a],
        knot_b=place[el.knot_b],
        knot_drag=el.knot_drag[order],
        knot_mass=el.knot_mass[order],
        weight=el.weight[order],
        free=el.free[order],
    )


def bars_around(el: Elements, laws: DragLaws | None = None, *, renewable: bool = False) -> Around:
    """Lay out the bars around the knots of a net under laws of drag, or None.

    renewable: drag and added mass are to be renewed later on.
    """
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
    slots = _SlotTable(el, laws, margin, renewable=renewable)
    for block in range(blocks):
        s = slice(start[block], start[block + 1])
        low = block * BLOCK
        slots.add_block(low, min(BLOCK, n - low), _Ends(knot[s] - low, away[s], bar[s], twin[s]))
    own, own_row = _knot_rows(el, laws, blocks)
    return Around(
        knot_count=n,
        margin=margin,
        width=2 * margin + blocks * BLOCK,
        first=np.array(slots.first),
        shift=np.array(slots.shift, dtype=np.int64),
        begin=np.array(slots.begin, dtype=np.int64),
        end=np.array(slots.end, dtype=np.int64),
        both=np.array(slots.both, dtype=bool),
        other=np.array(slots.other, dtype=np.int64).reshape(-1, BLOCK),
        other_row=np.array(slots.other_row, dtype=np.int64),
        bars=np.array(slots.bars.kept).reshape(-1),
        bars_row=np.array(slots.bars_row, dtype=np.int64),
        knots=own,
        knots_row=own_row,
        bar=np.array(slots.bar, dtype=np.uint32).reshape(-1, BLOCK),
        linear=el.linear,
        damped=el.damped,
    )


def renew(around: Around, el: Elements, laws: DragLaws | None) -> Around:
    """Return what bars_around laid out to be renewed with the drag, mass and weight of present elements."""
    rows = around.bars.reshape(-1, BAR_ROWS, BLOCK)
    for row, values in (
        (NORMAL, el.normal_drag),
        (TANGENTIAL, el.tangential_drag),
        (ADDED, el.bar_added_mass),
    ):
        rows[:, row] = np.append(values, 0.0)[around.bar]
    knots, knots_row = _knot_rows(el, laws, around.blocks)
    return around._replace(knots=knots, knots_row=knots_row)


class _SlotTable:
    """The slots of the blocks so far, as in Around."""

    def __init__(self, el: Elements, laws: DragLaws | None, margin: int, *, renewable: bool) -> None:
        none = np.zeros_like(el.rest_length)
        self.properties = np.stack(
            (
                el.rest_length,
                el.stiffness,
                el.normal_drag,
                el.tangential_drag,
                el.damping_time,
                el.bar_added_mass,
                none if laws is None else laws.bar_reynolds,
            )
        )
        self.look_up_bars, self.margin = renewable or not el.linear, margin
        self.bars = _Shared(all_apart=renewable)
        self.first: list[int] = [0]
        self.shift: list[int] = []
        self.bars_row: list[int] = []
        self.other_row: list[int] = []
        self.begin: list[int] = []
        self.end: list[int] = []
        self.both: list[bool] = []
        self.other: list[Ints] = []
        self.bar: list[Ints] = []

    def add_block(self, low: int, size: int, ends: _Ends) -> None:
        """Add the slots of the knots from low on, which are numbered from 0 in ends."""
        none = self.properties.shape[1]
        for which, step, both in _slots(ends, size):
            place, bar = ends.knot[which], ends.bar[which]
            row = np.zeros((BAR_ROWS, BLOCK))
            row[REST_LENGTH] = 1.0
            row[:, place] = self.properties[:, bar]
            self.bars_row.append(self.bars.keep(row))
            self.shift.append(step)
            self.begin.append(int(place.min()) // STRIDE * STRIDE)
            self.end.append(-(-(int(place.max()) + 1) // STRIDE) * STRIDE)
            self.both.append(both)
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


def _slots(ends: _Ends, size: int) -> Iterator[tuple[Ints, int, bool]]:
    """Ends that share a slot, their shift or SCATTERED, and whether the ends of the same bars at the neighbours do."""
    there = ends.knot + ends.away
    inside = (there >= 0) & (there < size)
    left = np.ones(len(ends.knot), dtype=bool)
    for both in (True, False):
        may = ~ends.twin & ((inside & (ends.away > 0)) if both else ~inside)
        shifts, served = np.unique(ends.away[may], return_counts=True)
        for shift in shifts[served >= FEWEST].tolist():
            which = np.flatnonzero(may & (ends.away == shift))
            if len(which) >= WORTH * (ends.knot[which[-1]] - ends.knot[which[0]] + 1):
                left[which] = False
                if both:
                    left &= ~((ends.away == -shift) & inside & ~ends.twin)
                yield which, shift, both
    rest = np.flatnonzero(left)
    rest = rest[np.argsort(ends.knot[rest], kind="stable")]
    rank = np.arange(len(rest)) - np.searchsorted(ends.knot[rest], ends.knot[rest])
    for slot in range(rank.max(initial=-1) + 1):
        yield rest[rank == slot], SCATTERED, False


def _knot_rows(el: Elements, laws: DragLaws | None, blocks: int) -> tuple[Array, Ints]:
    """Arrays knots and knots_row of Around."""
    area = el.knot_drag.copy()
    for end in (el.knot_a, el.knot_b):
        np.add.at(area, end, el.normal_drag * el.rest_length)
    own = np.zeros((KNOT_ROWS, blocks * BLOCK))
    n = len(el.free)
    own[:KNOT_REYNOLDS, :n] = (*el.weight.T, el.knot_drag, area, el.knot_mass, el.free)
    if laws is not None:
        own[KNOT_REYNOLDS, :n], own[KNOT_SHARE, :n] = laws.knot_reynolds, laws.knot_share
    shared = _Shared()
    row = [shared.keep(own[:, k * BLOCK : (k + 1) * BLOCK].copy()) for k in range(blocks)]
    return np.array(shared.kept).reshape(-1), np.array(row, dtype=np.int64)
