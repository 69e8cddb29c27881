"""What an export says of knots, bars and the whole net: all that the register of fields has, lengths and strains."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...solve.result import Result
from ..fields import FRAME_FIELDS, NET_FIELDS, Field

Values = NDArray[np.float64] | NDArray[np.int64]

# Bytes of one array that are made at once, so that a long run does not have to fit into memory twice.
BLOCK = 16 * 2**20
LENGTH = Field("length", ("time", "bar"), "m", "distance between the two knots of every bar")
STRAIN = Field(
    "strain", ("time", "bar"), "1", "length less unloaded length over unloaded length, below 0 where slack"
)
KNOT = Field("knot", ("knot",), "1", "number of every knot, counted from 0")
BAR = Field("bar", ("bar",), "1", "number of every bar, counted from 0")
# Not numbers of a knot or a bar of their own: written apart, as places, topology and texts.
APART = ("position", "knot_label", "bar_knots")


@dataclass(frozen=True)
class Column:
    """Values of all knots, all bars or the whole net, described by a field.

    values: of the frames first to behind-last, with the time axis in front where the field has one.
    """

    field: Field
    values: Callable[[int, int], Values]

    @property
    def name(self) -> str:
        """Name of the field."""
        return self.field.name

    @property
    def moves(self) -> bool:
        """Whether the values change with time."""
        return self.field.dimensions[:1] == ("time",)

    @property
    def components(self) -> int:
        """Numbers in one value."""
        return 3 if self.field.dimensions[-1] == "xyz" else 1


def columns_of(result: Result, where: str) -> tuple[Column, ...]:
    """Return what a result knows of every "knot" or "bar", or in every frame of the whole net ("")."""
    mine = {"knot": _of_knots, "bar": _of_bars, "": _of_net}[where]
    return tuple(mine(result))


def blocks(result: Result, rows: int) -> Iterator[tuple[int, int]]:
    """Cut the frames into runs (first, behind-last), each of some BLOCK bytes at so many values of three."""
    step = max(1, BLOCK // (24 * max(rows, 1)))
    for first in range(0, len(result.time), step):
        yield first, min(first + step, len(result.time))


def _registered(result: Result, where: str) -> Iterator[Column]:
    for attribute, field in NET_FIELDS.items():
        if field.dimensions[0] == where and field.name not in APART:
            yield _still(field, getattr(result.net, attribute))
    for field in FRAME_FIELDS:
        if field.dimensions[1:2] == (where,) and field.name not in APART:
            yield _moving(field, getattr(result, field.name))


def _still(field: Field, values: Values) -> Column:
    plain = values.astype(np.int64) if values.dtype.kind in "bi" else values
    return Column(field, lambda first, last: plain)


def _moving(field: Field, values: Values) -> Column:
    return Column(field, lambda first, last: values[first:last])


def _of_knots(result: Result) -> Iterator[Column]:
    yield _still(KNOT, np.arange(result.net.knot_count))
    yield from _registered(result, "knot")


def _of_bars(result: Result) -> Iterator[Column]:
    net = result.net
    start, end = net.bars.T

    def length(first: int, last: int) -> Values:
        along = result.position[first:last, end] - result.position[first:last, start]
        return np.asarray(np.sqrt(np.einsum("kmq,kmq->km", along, along)))

    def strain(first: int, last: int) -> Values:
        return np.asarray(length(first, last) / net.rest_length - 1.0)

    yield _still(BAR, np.arange(net.bar_count))
    yield Column(LENGTH, length)
    yield Column(STRAIN, strain)
    yield from _registered(result, "bar")


def _of_net(result: Result) -> Iterator[Column]:
    for field in FRAME_FIELDS:
        if field.dimensions in (("time",), ("time", "xyz")):
            yield _moving(field, getattr(result, field.name))
