"""Netting round an axis: cylinder, cone and frustum. Seams close: the last column of knots is the first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .lattice import Edge
from .net import Net
from .sheet import Netting, sheet

Array = NDArray[np.float64]


def frustum(
    netting: Netting,
    meshes: tuple[int, int],
    *,
    diameters: tuple[float, float],
    height: float,
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fixed: Edge = "top",
    name: str = "",
) -> Net:
    """Lay netting on a frustum of a cone that stands upright.

    meshes: around and along the height; diameters: m, of the lower and the upper rim; height: m; centre: m, of the
    upper rim. Equal rims make a cylinder. A lower rim of diameter 0 makes a cone, whose lowest knots are one, its tip;
    square meshes cannot be gathered so, because they have bars along the rim. ValueError for sizes that are no shape.
    """
    low, high = diameters
    if not (min(low, high) >= 0.0 and max(low, high) > 0.0 and height >= 0.0):
        raise ValueError(f"diameters {low:g} and {high:g} m and a height of {height:g} m make no frustum")
    if min(low, high) == 0.0 and (netting.mesh == "square" or high == 0.0):
        raise ValueError("only diamond netting is gathered in a tip, and below: give the rim a diameter")
    if height == 0.0 and low == high:
        raise ValueError(f"two rims of {low:g} m at the same height have no netting between them")

    def surface(parts: Array) -> Array:
        angle, up = 2.0 * np.pi * parts[:, 0], parts[:, 1]
        radius = 0.5 * (low + (high - low) * up)
        places = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height * (up - 1.0)])
        return np.asarray(places + np.array(centre))

    slant = float(np.hypot(0.5 * (high - low), height))
    return sheet(
        netting,
        meshes,
        surface,
        shape="cylinder" if low == high else "cone" if low == 0.0 else "frustum",
        size=(0.5 * np.pi * (low + high), slant),
        closed=True,
        tip=low == 0.0,
        fixed=fixed,
        name=name,
    )
