"""Knots by the names that a case file has for them."""

from __future__ import annotations

from typing import get_args

import numpy as np
from numpy.typing import NDArray

from .lattice import Side
from .net import Net

Indices = NDArray[np.int64]


def knots_named(net: Net, name: str) -> Indices:
    """Return the knots (k,) that a name says, rising; none where the net has nothing of this name.

    A name is the label of a knot, NAME.EDGE of a panel, or that of a panel with all that is sewn to it, a rope, line
    or ring, floats or sinkers.
    """
    whole = _of_gear(net, name)
    if whole:
        return np.unique(np.concatenate(whole))
    of, _, side = name.rpartition(".")
    for panel in net.panels:
        if panel.name == of and side in get_args(Side):
            return np.unique(panel.edge(side))  # type: ignore[arg-type] # one of them
    return np.array([net.labels.index(name)] if name in net.labels else [], dtype=np.int64)


def is_gear(net: Net, name: str) -> bool:
    """Whether a name is that of a whole panel, rope, line or ring, floats or sinkers."""
    return bool(_of_gear(net, name))


def _of_gear(net: Net, name: str) -> list[Indices]:
    """Knots of everything that is the gear of a name, further sheets such as "cage bottom" included."""
    known: list[tuple[str, Indices]] = [(one.name, one.knots) for one in net.ropes]
    known += [(one.name, one.knots) for one in net.bodies]
    known += [(one.name, one.knots) for one in net.panels]
    return [knots for one, knots in known if name and (one == name or one.startswith(f"{name} "))]
