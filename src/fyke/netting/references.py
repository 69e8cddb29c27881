"""Knots by the words of a case file: labels, places along edges, places along ropes and lines."""

from __future__ import annotations

import re
from typing import cast

import numpy as np
from numpy.typing import NDArray

from .lattice import Corner, Side
from .net import Net, Panel

Indices = NDArray[np.int64]

# "NAME.EDGE[k]", of netting, and "NAME:k", of what is a row of knots.
ON_EDGE = re.compile(r"(.*)\.(\w+)\[(\d{1,9})\]", re.ASCII)
IN_ROW = re.compile(r"(.*):(\d{1,9})", re.ASCII)


def knot_at(net: Net, text: str) -> int | None:
    """Return the knot that a text names, None where there is none.

    "NAME:label" is a knot by its label, which it may have lost to another knot in a seam; "NAME.EDGE[k]" the k-th along
    an edge of netting, from left or from below; "NAME:k" the k-th of a rope, ring or line, counted from 0. Labels and
    places are those of the real netting: of grouped netting it is the knot nearest to that one.
    """
    edge, row = ON_EDGE.fullmatch(text), IN_ROW.fullmatch(text)
    if edge:
        name = f"{edge[1]}.{edge[2]}"
        knots, place = row_of(net, name), round(int(edge[3]) / real_step(net, name))
    elif row:
        knots, place = next((rope.knots for rope in net.ropes if rope.name == row[1]), None), int(row[2])
        place = round(place / _step_of(net, knots)) if knots is not None else place
    else:
        return knot_labelled(net, text)
    return int(knots[place]) if knots is not None and place < len(knots) else None


def knots_named(net: Net, text: str) -> Indices:
    """Return all knots (k,) that a text names, rising; none where the net has nothing of this name.

    A knot as `knot_at` takes it, the edge "NAME.EDGE" of netting, or the name of gear with all that it has: netting
    with what is sewn to it, a rope, line or ring, floats or sinkers.
    """
    whole = _of_gear(net, text)
    if whole:
        return np.unique(np.concatenate(whole))
    row = row_of(net, text)
    if row is not None:
        return np.unique(row)
    knot = knot_at(net, text)
    return np.array([] if knot is None else [knot], dtype=np.int64)


def is_gear(net: Net, name: str) -> bool:
    """Whether a name is that of whole netting, a rope, line or ring, floats or sinkers."""
    return bool(_of_gear(net, name))


def _of_gear(net: Net, name: str) -> list[Indices]:
    """Knots of everything that is the gear of a name, further sheets such as "cage bottom" included."""
    known: list[tuple[str, Indices]] = [(one.name, one.knots) for one in net.ropes]
    known += [(one.name, one.knots) for one in net.bodies]
    known += [(one.name, one.knots) for one in net.panels]
    return [knots for one, knots in known if name and (one == name or one.startswith(f"{name} "))]


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


def edges_of(panel: Panel) -> tuple[str, ...]:
    """Return the edges that a panel has: netting that closes round has no left and right, a box has corners."""
    corners = tuple(f"corner{number}" for number in range(1, len(panel.folds) + 1))
    return ("top", "bottom", *corners) if panel.closed else ("top", "bottom", "left", "right", *corners)


def _step_of(net: Net, knots: Indices) -> float:
    """For how many real meshes one stands along a row of knots, where that is an edge of grouped netting."""
    for panel in net.panels:
        for side in edges_of(panel) if panel.grouped_from else ():
            if np.array_equal(panel.edge(cast("Side | Corner", side)), knots):
                return real_step(net, f"{panel.name}.{side}")
    return 1.0


def real_step(net: Net, text: str) -> float:
    """Return for how many real meshes along it one mesh stands of an edge of netting, 1 for ropes and lines."""
    name, _, side = text.rpartition(".")
    for panel in net.panels:
        if panel.name == name and row_of(net, text) is not None:
            return float(panel.group[0 if side in ("top", "bottom") else 1])
    return 1.0


def row_of(net: Net, text: str) -> Indices | None:
    """Return the knots in a row that a text names, "NAME.EDGE" of netting or the name of a rope, ring or line."""
    name, _, side = text.rpartition(".")
    for panel in net.panels:
        if panel.name == name and side in edges_of(panel):
            return panel.edge(cast("Side | Corner", side))
    return next((rope.knots for rope in net.ropes if rope.name == text), None)


def around(knots: Indices, positions: NDArray[np.float64], bearing: float, count: int) -> Indices:
    """Choose knots of a rim that lie in evenly spread directions from its middle.

    knots: (k,) of a rim; positions: (n, 3) m; bearing: of the first direction (rad), from +x turning to +y; count: how
    many directions. No knot is chosen twice. ValueError for more directions than knots.
    """
    rim = np.unique(knots)
    out = positions[rim, :2] - positions[rim, :2].mean(axis=0)
    angle = np.arctan2(out[:, 1], out[:, 0])
    wanted = bearing + 2.0 * np.pi * np.arange(count) / count
    off = np.abs(np.exp(1j * angle)[None, :] - np.exp(1j * wanted)[:, None])
    if count > len(rim):
        raise ValueError(f"{count} lines around a rim of {len(rim)} knots")
    chosen = []
    for way in off:
        chosen.append(int(np.argmin(way)))
        off[:, chosen[-1]] = np.inf
    return np.asarray(rim[chosen])
