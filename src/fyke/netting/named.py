"""Knots by the names that a case file has for them."""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from .lattice import Corner, Side
from .net import Net, Panel

Indices = NDArray[np.int64]


def knots_named(net: Net, name: str) -> Indices:
    """Return the knots (k,) that a name says, rising; none where the net has nothing of this name.

    A name is the label of a knot, NAME.EDGE of netting, or that of netting with all that is sewn to it, a rope, line
    or ring, floats or sinkers.
    """
    whole = _of_gear(net, name)
    if whole:
        return np.unique(np.concatenate(whole))
    of, _, side = name.rpartition(".")
    for panel in net.panels:
        if panel.name == of and side in edges_of(panel):
            return np.unique(panel.edge(cast("Side | Corner", side)))
    knot = knot_labelled(net, name)
    return np.array([] if knot is None else [knot], dtype=np.int64)


def edges_of(panel: Panel) -> tuple[str, ...]:
    """Return the edges that a panel has: netting that closes round has no left and right, a box has corners."""
    corners = tuple(f"corner{number}" for number in range(1, len(panel.folds) + 1))
    return ("top", "bottom", *corners) if panel.closed else ("top", "bottom", "left", "right", *corners)


def is_gear(net: Net, name: str) -> bool:
    """Whether a name is that of whole netting, a rope, line or ring, floats or sinkers."""
    return bool(_of_gear(net, name))


def knot_labelled(net: Net, label: str) -> int | None:
    """Return the knot of a label, which it may have lost to another knot in a seam; None where there is none.

    Of grouped netting it is the one nearest to this knot of the real netting.
    """
    name, _, place = label.rpartition(":")
    column, dash, row = place.partition("-")
    panel = next((panel for panel in net.panels if panel.name == name), None)
    if panel is not None and dash and column.isdecimal() and row.isdecimal():
        return _knot_of(panel, int(column), int(row))
    return net.labels.index(label) if label in net.labels else None


def _knot_of(panel: Panel, i: int, j: int) -> int | None:
    if panel.grouped_from:
        last = np.array(panel.lattice.intervals) * np.array(panel.group)
        if not (i <= last[0] and j <= last[1]):
            return None
        away = panel.flat - panel.real_place(i, j)
        return int(panel.knots[np.argmin(np.einsum("kq,kq->k", away, away))])
    there = np.flatnonzero((panel.lattice.knots == (i, j)).all(axis=1))
    return int(panel.knots[there[0]]) if len(there) else None


def _of_gear(net: Net, name: str) -> list[Indices]:
    """Knots of everything that is the gear of a name, further sheets such as "cage bottom" included."""
    known: list[tuple[str, Indices]] = [(one.name, one.knots) for one in net.ropes]
    known += [(one.name, one.knots) for one in net.bodies]
    known += [(one.name, one.knots) for one in net.panels]
    return [knots for one, knots in known if name and (one == name or one.startswith(f"{name} "))]
