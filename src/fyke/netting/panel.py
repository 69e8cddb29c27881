"""A rectangular panel of netting on a frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cutting import Taper
from .lattice import Edge, Mesh
from .net import Net
from .sheet import Netting, sheet
from .twine import Twine

Array = NDArray[np.float64]


def panel_axes(normal: Array) -> Array:
    """Unit vectors (2, 3) of the width, which is horizontal, and of the height, for a panel of this normal.

    width x height = normal. A panel that lies flat (normal along z) has its width along y.
    """
    n = np.asarray(normal, dtype=float)
    n = n / np.linalg.norm(n)
    width = np.cross([0.0, 0.0, 1.0], n)
    length = float(np.linalg.norm(width))
    width = np.array([0.0, 1.0, 0.0]) if length < 1e-12 else width / length
    return np.array([width, np.cross(n, width)])


def panel(
    twine: Twine,
    *,
    mesh: Mesh,
    meshes: tuple[int, int],
    bar_length: float,
    size: tuple[float, float],
    knot_diameter: float = 0.0,
    knot_density: float | None = None,
    segments: int = 1,
    group: int = 1,
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0),
    normal: tuple[float, float, float] = (1.0, 0.0, 0.0),
    taper: Taper | None = None,
    fixed: Edge = "edges",
    name: str = "",
) -> Net:
    """Lay a flat panel with evenly spaced knots on a frame.

    meshes and size: along width and height (size in m); bar_length: m, knot centre to knot centre, unloaded, of
    hexagons the slanted bars; knot_diameter: m, 0 for knotless; knot_density: kg/m3, the twine's when left out;
    segments: straight pieces of a bar; group: one mesh is laid for so many real ones along width and height; taper: how
    its sides are cut, meshes and size being those of the wide end and centre that of the whole rectangle. Knots are
    labelled "i-j", with "name:" before it when a name is given.
    """
    shape = "panel"
    if taper is not None:
        shape = taper.shape(mesh if isinstance(mesh, str) else "hexagonal", meshes)
    axes, where = panel_axes(np.array(normal)), np.array(centre, dtype=float)
    return sheet(
        Netting(twine, mesh, bar_length, knot_diameter, knot_density, segments, group),
        meshes,
        lambda steps, intervals: steps * (np.array(size) / intervals) @ axes + where,
        shape=shape,
        size=size,
        taper=taper,
        fixed=fixed,
        name=name,
    )
