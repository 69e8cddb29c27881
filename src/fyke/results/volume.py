"""Volume that netting encloses.

By the divergence theorem a closed surface of faces with vector areas N about the places c encloses 1/3 |sum c.N|. An
open rim is closed by triangles to the mean of its knots, which for a flat rim is its plane.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..netting.faces import faces_of
from ..netting.net import Net
from ..solve.result import Result

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Volume over the cube of the largest extent below which netting is flat.
FLAT = 1e-6


def enclosed_volume(net: Net, positions: Array, panels: Sequence[str] | None = None) -> float | None:
    """Return the volume (m3) that some panels enclose with the knots at positions (n, 3) m; all panels when None.

    None where they are no sack: netting whose open edges do not run round closed rims.
    """
    sack = _sack(net, panels)
    return None if sack is None else _volume(*sack, positions)


def volume_history(result: Result) -> tuple[float, Array] | None:
    """Return the volume (m3) that all netting of a net encloses as built, and in every frame (k,).

    None where it is no sack, or one without volume as built, such as a flat panel.
    """
    net = result.net
    sack = _sack(net, None) if net.panels else None
    if sack is None:
        return None
    built = _volume(*sack, net.positions)
    if built <= FLAT * float(np.ptp(net.positions, axis=0).max()) ** 3:
        return None
    return built, np.array([_volume(*sack, positions) for positions in result.position])


def _sack(net: Net, panels: Sequence[str] | None) -> tuple[Indices, list[Indices]] | None:
    """Corners (p, 4) of the faces of some panels, and the rims that they leave open; None where they are no sack."""
    faces = faces_of(net)
    wanted = [k for k, one in enumerate(net.panels) if panels is None or one.name in panels]
    corners = faces.corners[np.isin(faces.panel, wanted)]
    rims = _rims(corners)
    return None if rims is None or not len(corners) else (corners, rims)


def _volume(corners: Indices, rims: list[Indices], positions: Array) -> float:
    """Volume (m3) within faces (p, 4) and lids on their rims, with the knots at positions (n, 3) m."""
    middle = positions[np.unique(corners)].mean(axis=0)
    volume = sum(float(np.sum((c - middle) * n)) for c, n in _pieces(corners, positions))
    for rim in rims:
        centre = positions[rim].mean(axis=0)
        ahead = positions[np.roll(rim, -1)]
        area = 0.5 * np.cross(positions[rim] - centre, ahead - centre)
        place = (positions[rim] + ahead + centre) / 3.0 - middle
        # The rim runs with the netting, so its lid looks inwards.
        volume -= float(np.sum(place * area))
    return abs(volume) / 3.0


def _pieces(corners: Indices, x: Array) -> list[tuple[Array, Array]]:
    """Middles (p, 3) m and vector areas (p, 3) m2 of the triangles that faces are cut into along one diagonal."""
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
