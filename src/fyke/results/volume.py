"""Volume that netting encloses.

By the divergence theorem a closed surface of faces with vector areas N about the places c encloses 1/3 |sum c.N|. An
open rim is closed by triangles to the mean of its knots, which for a flat rim is its plane.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..netting.faces import Faces, faces_of
from ..netting.net import Net

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def enclosed_volume(net: Net, positions: Array, panels: Sequence[str] | None = None) -> float | None:
    """Return the volume (m3) that some panels enclose with the knots at positions (n, 3) m; all panels when None.

    None where they are no sack: netting whose open edges do not run round closed rims.
    """
    faces = faces_of(net)
    wanted = [k for k, one in enumerate(net.panels) if panels is None or one.name in panels]
    own = np.isin(faces.panel, wanted)
    pieces = _pieces(faces, own, positions)
    rims = _rims(faces.corners[own])
    if rims is None:
        return None
    middle = positions[np.unique(faces.corners[own])].mean(axis=0)
    volume = sum(float(np.sum((c - middle) * n)) for c, n in pieces)
    for rim in rims:
        centre = positions[rim].mean(axis=0)
        ahead = positions[np.roll(rim, -1)]
        area = 0.5 * np.cross(positions[rim] - centre, ahead - centre)
        place = (positions[rim] + ahead + centre) / 3.0 - middle
        # The rim runs with the netting, so its lid looks inwards.
        volume -= float(np.sum(place * area))
    return abs(volume) / 3.0


def _pieces(faces: Faces, own: NDArray[np.bool_], x: Array) -> list[tuple[Array, Array]]:
    """Middles (p, 3) m and vector areas (p, 3) m2 of the triangles that faces are cut into along one diagonal."""
    corners = faces.corners[own]
    out = []
    for which in ((0, 1, 2), (0, 2, 3)):
        a, b, c = (x[corners[:, k]] for k in which)
        out.append(((a + b + c) / 3.0, 0.5 * np.cross(b - a, c - a)))
    return out


def _rims(corners: Indices) -> list[Indices] | None:
    """Knots of the open edges in order, one list for each closed rim; None where an edge leads nowhere."""
    after = np.roll(corners, -1, axis=1)
    sides = np.column_stack([corners.ravel(), after.ravel()])
    sides = sides[sides[:, 0] != sides[:, 1]]
    size = int(sides.max(initial=0)) + 1
    keys, back = sides[:, 0] * size + sides[:, 1], sides[:, 1] * size + sides[:, 0]
    free = sides[~np.isin(keys, back)]
    following = dict(free.tolist())
    if len(following) != len(free):
        return None
    rims = []
    while following:
        begin, knot = following.popitem()
        rim = [begin]
        while knot != begin:
            rim.append(knot)
            if knot not in following:
                return None
            knot = following.pop(knot)
        rims.append(np.array(rim, dtype=np.int64))
    return rims
