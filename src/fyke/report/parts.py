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
from ..netting.net import Net, Rope
from . import style

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Bars:
    """Bars (k,) of the net, drawn between their knots; colour None: by the quantity that the picture shows.

    width: over that of a bar of netting, where lines are not as thick as the twine; own: the name in the net;
    diameter: m, of a tube, which is never drawn thinner; 0 for twine.
    """

    name: str
    bars: Indices
    colour: str | None = None
    width: float = 1.0
    own: str = ""
    diameter: float = 0.0


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

# Colour of bars in a row, by their kind.
ROWS = {"rope": style.VERMILION, "ring": style.PURPLE, "collar": style.ORANGE}

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
    """Return the bars (k,) that a picture colours by its quantity: the netting; without any the ropes, else all.

    A rope bears a multiple of what a bar of netting does, and would take the colours for itself, and so does a tube.
    """
    netting, twine = np.ones(net.bar_count, dtype=bool), np.ones(net.bar_count, dtype=bool)
    for rope in net.ropes:
        netting[rope.bars] = False
        twine[rope.bars] = not _tubular(net, rope)
    own = next((one for one in (netting, twine) if one.any()), np.ones(net.bar_count, dtype=bool))
    return np.flatnonzero(own)


def _tubular(net: Net, rope: Rope) -> bool:
    return net.twines[int(net.twine_of_bar[rope.bars[0]])].wall > 0.0


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
    """Yield the ropes, rings and collars that do not have the colour of the quantity, each in one piece."""
    coloured = coloured_bars(net)
    for rope in net.ropes:
        if not np.isin(rope.bars, coloured).all():
            thick = float(net.bar_diameter[rope.bars[0]]) if _tubular(net, rope) else 0.0
            colour = ROWS.get(rope.kind, style.VERMILION)
            yield Bars(rope.kind, rope.bars, colour, ROPE_WIDTH, rope.name, thick)


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
