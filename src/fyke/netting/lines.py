"""Lines that run free of netting: mooring lines, dropper lines, main lines, buoy ropes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from .catenary import end_tension, hanging_line
from .joining import joined
from .line import line
from .net import Net, Rope
from .together import together
from .twine import Twine

Array = NDArray[np.float64]
End = int | tuple[float, float, float]

LONGEST_STRAIN, LONGER = 0.2, 1.01  # of a line made by its pretension; step in which its length is looked for
LAW_STRAIN = 0.01  # strain at which the secant of an elastic law stands for EA while a line is laid


@dataclass(frozen=True)
class LinePiece:
    """A piece of a line, of one twine; length: m, unloaded; segments: straight bars that it is cut into."""

    twine: Twine
    length: float
    segments: int = 10

    def __post_init__(self) -> None:
        """Refuse what is no piece of a line."""
        if not (self.length > 0.0 and self.segments >= 1):
            raise ValueError(f"a piece of line of {self.length:g} m in {self.segments} segments")


def with_line(
    net: Net | None,
    begin: End,
    end: End,
    pieces: Sequence[LinePiece],
    *,
    name: str,
    held: tuple[bool, bool] = (True, True),
    water: float = 1000.0,
    gravity: float = 9.81,
    bed: float | None = None,
) -> Net:
    """Return the net with a line from one place or knot to another, laid as it hangs at rest in still water.

    net: None for a net that is this line alone; begin, end: a knot of the net, or a place (x, y, z) m, which becomes a
    knot of the line; held: whether such places are anchors; pieces: from begin to end; water: kg/m3 and gravity: m/s2,
    for the way it hangs; bed: z (m) of the sea bed, which bears it. Its knots are "NAME:0" at begin, "NAME:1" ..., but
    for ends that are knots of the net, which keep their labels. The line may be slack or taut. ValueError without
    pieces, and for ends that the net does not have or that are one.
    """
    if not pieces:
        raise ValueError(f"line '{name}' has no piece")
    first, last = (_place(net, one, name) for one in (begin, end))
    if np.array_equal(first, last):
        raise ValueError(f"line '{name}' ends where it begins")
    segments = [piece.segments for piece in pieces]
    length = np.repeat([piece.length / piece.segments for piece in pieces], segments)
    weight = np.repeat([weight_per_metre(piece.twine, water, gravity) for piece in pieces], segments) * length
    stiffness = np.repeat([_stiffness(piece.twine) for piece in pieces], segments)
    places = hanging_line(first, last, length, weight, stiffness, bed=bed)
    made = line(pieces[0].twine, places, length, fixed=())
    made.fixed[[0, -1]] = held
    twines = tuple(dict.fromkeys(piece.twine for piece in pieces))
    n, m = made.knot_count, made.bar_count
    made = replace(
        made,
        labels=tuple(f"{name}:{label}" if name else label for label in made.labels),
        twines=twines,
        twine_of_bar=np.repeat([twines.index(piece.twine) for piece in pieces], segments),
        ropes=(Rope(name, np.arange(n), np.arange(m), "line"),),
    )
    if net is None:
        return made
    tied = [(knot, at) for knot, at in ((begin, 0), (end, n - 1)) if not isinstance(knot, tuple)]
    made.fixed[[at for _, at in tied]] = False
    stays, goes = [knot for knot, _ in tied], [net.knot_count + at for _, at in tied]
    return joined(together([net, made]), stays, goes)


def length_for(
    pretension: float,
    begin: ArrayLike,
    end: ArrayLike,
    twine: Twine,
    segments: int,
    *,
    water: float = 1000.0,
    gravity: float = 9.81,
    bed: float | None = None,
) -> float:
    """Return the unloaded length (m) of a line that has a tension of pretension (N) at its end as it hangs at rest.

    Of two such lengths, taut and slack, the taut one; other arguments as of `with_line`. ValueError where every line
    between these places has less or more.
    """
    first, last = np.array(begin, dtype=float), np.array(end, dtype=float)
    way, one = float(np.linalg.norm(last - first)), np.ones(segments) / segments
    weight, stiffness = weight_per_metre(twine, water, gravity), np.full(segments, _stiffness(twine))

    def surplus(length: float) -> float:
        pull = end_tension(first, last, length * one, weight * length * one, stiffness, bed=bed)
        return pull - pretension

    taut = way / (1.0 + LONGEST_STRAIN)
    if not (way > 0.0 and surplus(taut) > 0.0):
        raise ValueError(
            f"no line of twine '{twine.name}' between these places has {pretension:g} N at its end"
        )
    short, least = taut, surplus(taut)
    while True:
        long = short * LONGER
        now = surplus(long)
        if now <= 0.0:
            return float(brentq(surplus, short, long, xtol=1e-9 * way))
        if now >= least:
            low = least + pretension
            raise ValueError(
                f"every line of twine '{twine.name}' between these places has {low:.4g} N or more at its end"
            )
        short, least = long, now


def weight_per_metre(twine: Twine, water: float, gravity: float) -> float:
    """Weight in water of a metre of twine (N/m), negative where it floats; water: kg/m3, gravity: m/s2."""
    return gravity * (twine.soaked_density(water) - water) * twine.area


def _place(net: Net | None, one: End, name: str) -> Array:
    """Where an end of a line is, (3,) m."""
    if isinstance(one, tuple):
        return np.array(one, dtype=float)
    if net is None or not 0 <= one < net.knot_count:
        raise ValueError(f"line '{name}' ends at knot {one}, which the net does not have")
    return np.array(net.positions[one])


def _stiffness(twine: Twine) -> float:
    """Secant EA of a twine, N."""
    rows = twine.law.rows(twine.diameter)
    row = rows[np.searchsorted(rows[:, 0], LAW_STRAIN, side="right") - 1]
    x = LAW_STRAIN - row[0]
    return float((row[1] + row[2] * x + row[3] * x ** row[4]) / LAW_STRAIN)
