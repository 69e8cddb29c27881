"""The parts that a net shows of itself, one register for figures, report page, live view, exports and movies.

A drawer is a function from a net to parts; `draws` puts it into the register, and every picture asks `parts_of`. A new
kind of gear registers a drawer of its own and no picture has to know it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..netting.net import Net, Side
from . import style

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Bars:
    """Bars (k,) of the net, drawn between their knots; colour None: by the quantity that the picture shows.

    width: over that of a bar of netting.
    """

    name: str
    bars: Indices
    colour: str | None = None
    width: float = 1.0


@dataclass(frozen=True)
class Knots:
    """Knots (k,) of the net, each with a marker: "square", "circle" or "diamond"; size: over that of a fixed knot."""

    name: str
    knots: Indices
    marker: str = "circle"
    colour: str = style.BLACK
    size: float = 1.0


@dataclass(frozen=True)
class Outline:
    """A line through points (k, 3) m that do not move, such as a frame; the last may repeat the first."""

    name: str
    points: Array
    colour: str = style.FRAME_GREY
    width: float = 1.6


SIDES: tuple[Side, ...] = ("top", "bottom", "left", "right")

Part = Bars | Knots | Outline
Drawer = Callable[[Net], Iterator[Part]]
_REGISTER: list[Drawer] = []


def draws(drawer: Drawer) -> Drawer:
    """Put a drawer into the register; parts are drawn in the order of registration."""
    _REGISTER.append(drawer)
    return drawer


def parts_of(net: Net) -> tuple[Part, ...]:
    """Return all parts of a net that have something to draw, in the order of drawing."""
    return tuple(part for drawer in _REGISTER for part in drawer(net))


@draws
def frames(net: Net) -> Iterator[Part]:
    """Yield the frame of every flat panel that is held along all its edges, and the held rims of closed shapes."""
    for panel in net.panels:
        sides = {side: panel.edge(side) for side in SIDES}
        if panel.closed:
            for rim in (sides["top"], sides["bottom"]):
                if net.fixed[rim].all() and len(np.unique(rim)) > 1:
                    yield Outline("rim", net.positions[rim])
        elif all(net.fixed[edge].all() for edge in sides.values()):
            (low_left, low_right), (high_left, high_right) = sides["bottom"][[0, -1]], sides["top"][[0, -1]]
            round_it = [low_left, low_right, high_right, high_left, low_left]
            yield Outline("frame", net.positions[round_it])


@draws
def netting(net: Net) -> Iterator[Part]:
    """Yield all bars."""
    if net.bar_count:
        yield Bars("netting", np.arange(net.bar_count))


@draws
def fixed_knots(net: Net) -> Iterator[Part]:
    """Yield the knots that are held in place."""
    if net.fixed.any():
        yield Knots("fixed knot", np.flatnonzero(net.fixed), marker="square")
