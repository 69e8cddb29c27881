"""The parts that a net shows of itself, one register for figures, report page, live view, exports and movies.

A drawer is a function from a net to parts; `draws` puts it into the register, and every picture asks `parts_of`. A new
kind of gear registers a drawer of its own and no picture has to know it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..netting.lattice import Side
from ..netting.net import Net
from . import style

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Bars:
    """Bars (k,) of the net, drawn between their knots; colour None: by the quantity that the picture shows.

    width: over that of a bar of netting, where lines are not as thick as the twine; own: the name in the net.
    """

    name: str
    bars: Indices
    colour: str | None = None
    width: float = 1.0
    own: str = ""


@dataclass(frozen=True)
class Knots:
    """Knots (k,) of the net, each with a marker: "square", "circle" or "diamond"; size: over that of a fixed knot.

    diameter: m, of the sphere that hangs there, which is never drawn smaller; 0 for a mere mark; own: the name in the
    net.
    """

    name: str
    knots: Indices
    marker: str = "circle"
    colour: str = style.BLACK
    size: float = 1.0
    diameter: float = 0.0
    own: str = ""


@dataclass(frozen=True)
class Outline:
    """A line through points (k, 3) m that do not move, such as a frame; the last may repeat the first."""

    name: str
    points: Array
    colour: str = style.FRAME_GREY
    width: float = 1.6


SIDES: tuple[Side, ...] = ("top", "bottom", "left", "right")
ROPE_WIDTH, BODY_SIZE = 1.7, 1.4  # over a bar of netting, over a fixed knot
# Marker and colour of what hangs at knots.
BODIES = {"float": ("circle", style.ORANGE), "sinker": ("diamond", style.BLACK)}

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


def coloured_bars(net: Net) -> Indices:
    """Return the bars (k,) that a picture colours by its quantity: all but the ropes of a net that is more than ropes.

    A rope bears a multiple of what a bar of netting does, and would take the colours for itself.
    """
    own = np.ones(net.bar_count, dtype=bool)
    for rope in net.ropes:
        own[rope.bars] = False
    return np.flatnonzero(own) if own.any() else np.arange(net.bar_count)


def tied_knots(net: Net) -> NDArray[np.bool_]:
    """Return which knots (n,) are knots indeed, and not places where a bar in segments may bow."""
    inner = np.zeros(net.knot_count, dtype=bool)
    for panel in net.panels:
        if panel.bars.shape[1] > 1:
            inner[net.bars[panel.bars]] = True
    for knots in [part.knots for part in net.panels] + [rope.knots for rope in net.ropes]:
        inner[knots] = False
    return ~inner


@draws
def netting(net: Net) -> Iterator[Part]:
    """Yield all bars that have the colour of the quantity."""
    if net.bar_count:
        yield Bars("netting", coloured_bars(net))


@draws
def ropes(net: Net) -> Iterator[Part]:
    """Yield the ropes, each in one piece, unless the net is nothing else."""
    for rope in net.ropes:
        if len(coloured_bars(net)) < net.bar_count:
            yield Bars("rope", rope.bars, style.VERMILION, ROPE_WIDTH, rope.name)


@draws
def fixed_knots(net: Net) -> Iterator[Part]:
    """Yield the knots that are held in place."""
    if net.fixed.any():
        yield Knots("fixed knot", np.flatnonzero(net.fixed), marker="square")


@draws
def bodies(net: Net) -> Iterator[Part]:
    """Yield floats and sinkers."""
    for one in net.bodies:
        marker, colour = BODIES[one.kind]
        yield Knots(one.kind, one.knots, marker, colour, BODY_SIZE, one.diameter, one.name)
