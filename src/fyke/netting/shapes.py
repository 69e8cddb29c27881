"""Netting that closes: cylinder, cone, frustum, round cage and box. Its last column of knots is the first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cutting import Taper
from .hexagon import Hexagon
from .joining import joined, seam, sewn, with_shared_bars
from .lattice import Edge
from .net import Net
from .sheet import Netting, sheet
from .together import together

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
    if min(low, high) == 0.0 and (netting.mesh != "diamond" or high == 0.0):
        raise ValueError("only diamond netting is gathered in a tip, and below: give the rim a diameter")
    if height == 0.0 and low == high:
        raise ValueError(f"two rims of {low:g} m at the same height have no netting between them")

    def surface(steps: Array, intervals: Array) -> Array:
        angle, up = (steps / intervals + 0.5).T * np.array([[2.0 * np.pi], [1.0]])
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


def cage(
    netting: Netting,
    meshes: tuple[int, int],
    *,
    diameter: float,
    depth: float,
    lower: float | None = None,
    bottom: tuple[int, float] | None = None,
    top: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fixed: Edge = "top",
    name: str = "cage",
) -> Net:
    """Lay a round cage: a cylinder or a frustum, closed below by a cone or a disc of the same diamond netting.

    meshes: around and along the depth; diameter: m, of the upper rim; depth: m, of the wall; lower: diameter of the
    lower rim, m, that of the upper one when None; bottom: meshes from the rim to the middle
    and how far (m) the middle hangs below the rim, 0 for flat; None for open; top: m, centre of the upper rim. Its
    panels are called NAME and NAME bottom.
    """
    waist = diameter if lower is None else lower
    wall = frustum(
        netting, meshes, diameters=(waist, diameter), height=depth, centre=top, fixed=fixed, name=name
    )
    if bottom is None:
        return wall
    deep, sink = bottom
    rim = (top[0], top[1], top[2] - depth)
    floor = frustum(
        netting,
        (meshes[0], deep),
        diameters=(0.0, waist),
        height=sink,
        centre=rim,
        fixed="none",
        name=f"{name} bottom".strip(),
    )
    whole = together([wall, floor])
    above, below = whole.panels
    rims = seam(above.edge("bottom"), below.edge("top"), closed=True)
    return joined(whole, *rims, above.real_along("bottom")[:-1])


def bag(
    netting: Netting,
    meshes: tuple[int, int],
    *,
    panels: int,
    cuts: str,
    diameters: tuple[float, float],
    height: float,
    top: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fixed: Edge = "top",
    name: str = "bag",
) -> Net:
    """Lay a tapered bag, a piece of a trawl: equal trapezoids side by side on a frustum, joined along their cut sides.

    meshes: of one panel, along its wide end and along the height; panels: how many, two to four by custom; cuts: of
    every side, from the wide end to the narrow one, see netting.cutting; diameters: m, of the lower and the upper rim,
    the wider of which is the wide end; height: m; top: m, centre of the upper rim. Panels are called NAME 1, NAME 2 ...
    in the order in which they go round. ValueError for fewer than two panels and for cuts that do not fit.
    """
    if panels < 2:
        raise ValueError("a bag has two panels or more")
    low, high = diameters
    taper = Taper(cuts, cuts, "bottom" if low <= high else "top")
    slant = float(np.hypot(0.5 * (high - low), height))
    mesh = netting.mesh if isinstance(netting.mesh, str) else "hexagonal"

    def piece(number: int) -> Net:
        def surface(steps: Array, intervals: Array) -> Array:
            at = steps + 0.5 * intervals
            left, right = (
                np.interp(at[:, 1], *_by_row(path))
                for path in taper.paths(mesh, (round(intervals[0]), round(intervals[1])))
            )
            width = right - left
            along = np.divide(at[:, 0] - left, width, out=np.full_like(width, 0.5), where=width > 0.0)
            angle, up = 2.0 * np.pi / panels * (number + along), steps[:, 1] / intervals[1] + 0.5
            radius = 0.5 * (low + (high - low) * up)
            places = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height * (up - 1.0)])
            return np.asarray(places + np.array(top))

        return sheet(
            netting,
            meshes,
            surface,
            shape="trapezoid",
            size=(np.pi * max(diameters) / panels, slant),
            taper=taper,
            fixed=fixed,
            name=f"{name} {number + 1}",
        )

    net = together([piece(number) for number in range(panels)])
    for number in range(panels):
        net = sewn(net, (f"{name} {number + 1}", "right"), (f"{name} {(number + 1) % panels + 1}", "left"))
    return net


def _by_row(path: NDArray[np.int64]) -> tuple[Array, Array]:
    """Rows (r,) along a cut side, and its mean column in each."""
    rows, which = np.unique(path[:, 1], return_inverse=True)
    return rows.astype(float), np.bincount(which, path[:, 0]) / np.bincount(which)


def box(
    netting: Netting,
    meshes: tuple[int, int, int],
    *,
    size: tuple[float, float, float],
    bottom: bool = True,
    top: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fixed: Edge = "top",
    name: str = "box",
) -> Net:
    """Lay a cage with four upright walls and a flat bottom, its sides along x and y.

    meshes: along x, along y and along the depth; size: m, likewise; bottom: whether it has one, of the meshes of its
    sides; top: m, middle of the upper rim; fixed: which knots are held. The walls are one panel, NAME, that goes round
    from the corner at +x -y by +x +y; its corners are corner1 to corner4 in this order. The bottom is NAME bottom, i
    along x and j against y; along the seam it has the knots and the bars of the walls. ValueError for a bottom of
    hexagons, whose edges do not match those of the walls, and for a group that does not divide the meshes of the sides.
    """
    if bottom and isinstance(netting.mesh, Hexagon):
        raise ValueError("a bottom of hexagonal netting does not match its walls: leave it out")
    nx, ny, nz = meshes
    if nx % netting.group or ny % netting.group:
        raise ValueError(
            f"a group of {netting.group} does not divide the {nx} and {ny} meshes between corners"
        )
    lx, ly, lz = size
    folds = np.cumsum([0, ny, nx, ny, nx])
    corners = 0.5 * np.array([(lx, -ly), (lx, ly), (-lx, ly), (-lx, -ly), (lx, -ly)])

    def walls(steps: Array, intervals: Array) -> Array:
        across = (steps[:, 0] + 0.5 * intervals[0]) * (folds[-1] / intervals[0])
        x, y = (np.interp(across, folds, corner) for corner in corners.T)
        return np.asarray(np.column_stack([x, y, lz * steps[:, 1] / intervals[1]]) + where)

    where = np.array(top) - [0.0, 0.0, 0.5 * lz]
    made = sheet(
        netting,
        (2 * (nx + ny), nz),
        walls,
        shape="box",
        size=(2.0 * (lx + ly), lz),
        closed=True,
        folds=tuple(folds[:-1].tolist()),
        fixed=fixed,
        name=name,
    )
    return _with_floor(made, netting, (nx, ny), (lx, ly), where - [0.0, 0.0, 0.5 * lz]) if bottom else made


def _with_floor(
    walls: Net, netting: Netting, meshes: tuple[int, int], size: tuple[float, float], middle: Array
) -> Net:
    """Close the walls of a box below with a flat bottom, joined to them knot by knot; middle: (3,) m, of the bottom."""

    def floor(steps: Array, intervals: Array) -> Array:
        x, y = (steps * np.array([size[0], -size[1]]) / intervals).T
        return np.asarray(np.column_stack([x, y, np.zeros(len(x))]) + middle)

    name = f"{walls.panels[0].name} bottom".strip()
    below = sheet(netting, meshes, floor, shape="panel", size=size, fixed="none", name=name)
    whole = together([walls, below])
    wall, flat = whole.panels
    right, near, left, far = (flat.edge(side) for side in ("right", "bottom", "left", "top"))
    round_it = np.concatenate([right[:0:-1], near[:0:-1], left[:-1], far[:-1]])
    return with_shared_bars(joined(whole, wall.edge("bottom")[:-1], round_it, wall.real_along("bottom")[:-1]))
