"""Knots by the words of a case file: labels, places along edges, places along ropes and lines."""

from __future__ import annotations

import re
from typing import cast

import numpy as np
from numpy.typing import NDArray

from .lattice import Side
from .net import Net

Indices = NDArray[np.int64]

# "NAME.EDGE[k]", of netting, and "NAME:k", of what is a row of knots.
ON_EDGE = re.compile(r"(.*)\.(top|bottom|left|right)\[(\d{1,9})\]", re.ASCII)
IN_ROW = re.compile(r"(.*):(\d{1,9})", re.ASCII)


def knot_at(net: Net, text: str) -> int | None:
    """Return the knot that a text names, None where there is none.

    "NAME:label" is a knot by its label; "NAME.EDGE[k]" the k-th along an edge of netting, from left or from below;
    "NAME:k" the k-th of a rope, ring or line, counted from 0.
    """
    if text in net.labels:
        return net.labels.index(text)
    edge, row = ON_EDGE.fullmatch(text), IN_ROW.fullmatch(text)
    knots = np.empty(0, dtype=np.int64)
    if edge:
        knots = next((p.edge(cast(Side, edge[2])) for p in net.panels if p.name == edge[1]), knots)
    elif row:
        knots = next((rope.knots for rope in net.ropes if rope.name == row[1]), knots)
    place = int(edge[3]) if edge else int(row[2]) if row else 0
    return int(knots[place]) if place < len(knots) else None


def around(knots: Indices, positions: NDArray[np.float64], bearing: float, count: int) -> Indices:
    """Choose knots of a rim that lie in evenly spread directions from its middle.

    knots: (k,) of a rim; positions: (n, 3) m; bearing: of the first direction (rad), from +x turning to +y; count: how
    many directions. ValueError where two of them find the same knot.
    """
    rim = np.unique(knots)
    out = positions[rim, :2] - positions[rim, :2].mean(axis=0)
    angle = np.arctan2(out[:, 1], out[:, 0])
    wanted = bearing + 2.0 * np.pi * np.arange(count) / count
    off = np.abs(np.exp(1j * angle)[None, :] - np.exp(1j * wanted)[:, None])
    chosen = rim[np.argmin(off, axis=1)]
    if len(np.unique(chosen)) < count:
        raise ValueError(f"{count} lines around a rim of {len(rim)} knots")
    return np.asarray(chosen)
