"""A rectangular panel of netting on a frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .lattice import Edge, MeshKind, lattice
from .net import Net, Panel
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
    mesh: MeshKind,
    meshes: tuple[int, int],
    bar_length: float,
    size: tuple[float, float],
    knot_diameter: float = 0.0,
    knot_density: float | None = None,
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0),
    normal: tuple[float, float, float] = (1.0, 0.0, 0.0),
    fixed: Edge = "edges",
    name: str = "",
) -> Net:
    """Lay a flat panel with evenly spaced knots on a frame.

    meshes and size: along width and height (size in m); bar_length: m, knot centre to knot centre, unloaded;
    knot_diameter: m, 0 for knotless; knot_density: kg/m3, the twine's when left out. Knots are labelled "i-j", with
    "name:" before it when a name is given.
    """
    grid = lattice(mesh, meshes)
    axes = panel_axes(np.array(normal))
    spacing = np.array(size) / grid.intervals
    plan = (grid.knots - np.array(grid.intervals) / 2.0) * spacing
    prefix = f"{name}:" if name else ""
    n, m = len(grid.knots), len(grid.bars)
    where = Panel(
        name=name,
        mesh=mesh,
        meshes=meshes,
        size=size,
        bar_length=bar_length,
        knot_diameter=knot_diameter,
        twine=twine.name,
        centre=np.array(centre, dtype=float),
        axes=axes,
        knots=(0, n),
        bars=(0, m),
    )
    return Net(
        positions=plan @ axes + np.array(centre, dtype=float),
        labels=tuple(f"{prefix}{i}-{j}" for i, j in grid.knots),
        fixed=grid.held(fixed),
        bars=grid.bars,
        rest_length=np.full(m, float(bar_length)),
        twines=(twine,),
        twine_of_bar=np.zeros(m, dtype=np.int64),
        knot_diameter=np.full(n, float(knot_diameter)),
        knot_density=np.full(n, twine.density if knot_density is None else float(knot_density)),
        load=np.zeros((n, 3)),
        panels=(where,),
    )
