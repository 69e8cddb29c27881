"""A panel of 96 x 96 meshes, 2 x 2, 4 x 4 and 8 x 8 of which are one: how its sag and tension go with the group."""

from __future__ import annotations

import numpy as np

from fyke.study import Found
from panels import BAR, framed, settled

MESHES = 96
SIDE = 0.9 * MESHES * BAR * np.sqrt(2.0)
GROUPS = (1, 2, 4, 8)


def grouped(group):
    """Sag (m), drag (N) and largest tension of a real bar (N)."""
    result = settled(framed(meshes=(MESHES, MESHES), size=(SIDE, SIDE), group=group))
    sag = np.abs(result.position[-1][:, 0]).max()
    return np.array([sag, result.hydrodynamic_force[-1][0], result.tension[-1].max()])


def measure(tables):
    found = np.array([grouped(group) for group in GROUPS])
    for group, one in zip(GROUPS[1:], found[1:], strict=True):
        case = f"{group} x {group} meshes for one"
        yield Found("sag", one[0], found[0, 0], case)
        yield Found("drag", one[1], found[0, 1], case)
        yield Found("tension", one[2], found[0, 2], case)
    yield Found("order", np.log2((found[3, 0] - found[1, 0]) / (found[2, 0] - found[1, 0]) - 1.0))
