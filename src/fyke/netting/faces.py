"""Faces: the meshes of netting as plane pieces that the water pushes on, with corners at the knots.

A mesh of diamond netting is a rhombus, half a mesh along the frame a triangle, a mesh of square netting a quadrangle. A
hexagon is two quadrangles, cut along its long bars' direction; between the tips at its ends lie triangles, and of a
flat panel the corners without a knot are left out.
The corners go round a face so that its vector area N = 1/2 (x_c - x_a) x (x_d - x_b) points to the panel's normal,
width x height. That is the vector area of any quadrangle, flat or not, and of a triangle a, b, c whose last corner is
repeated.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .hexagon import Hexagon
from .lattice import Lattice, hanging_ratios
from .measures import mesh_area, solidity
from .net import Net, Panel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Corners of a face as steps (i, j) on the lattice, in order round it. Whole diamonds go from the middle of the mesh;
# halves lack one of the four, in this order, and their side c-a is the one along the frame.
_DIAMOND = ((-1, 0), (0, -1), (1, 0), (0, 1))
_HALVES = (
    ((0, -1), (1, 0), (0, 1), (0, 1)),
    ((1, 0), (0, 1), (-1, 0), (-1, 0)),
    ((0, 1), (-1, 0), (0, -1), (0, -1)),
    ((-1, 0), (0, -1), (1, 0), (1, 0)),
)
_SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))


@dataclass(frozen=True)
class Faces:
    """p faces of a net.

    corners: (p, 4) knots in order round the face, a triangle repeating its last; share: (p, 4) of the face's force
    that each corner bears, 0 where repeated; area: (p,) m2, outline, hung on the frame and not yet stretched;
    solidity: (p,) as hung; diameter: (p,) m, of the twine; panel: (p,) index into net.panels; bars: (p, 4 s) bars from
    each corner to the next, with their s segments, -1 where there is none.
    """

    corners: Indices
    share: Array
    area: Array
    solidity: Array
    diameter: Array
    panel: Indices
    bars: Indices

    @property
    def count(self) -> int:
        """Number of faces, p."""
        return len(self.corners)

    @cached_property
    def triangle(self) -> NDArray[np.bool_]:
        """Whether a face has three corners, (p,)."""
        return np.asarray(self.corners[:, 3] == self.corners[:, 2])

    def vector_area(self, x: Array) -> Array:
        """Vector area N of every face (p, 3) m2 with the knots at x (n, 3) m."""
        a, b, c, d = self.corners.T
        return np.asarray(0.5 * np.cross(x[c] - x[a], x[d] - x[b]))


def faces_of(net: Net) -> Faces:
    """Return the faces of all panels of netting in a net, in the order of the panels; none for ropes.

    ValueError when a panel's range of knots is not that of its meshes.
    """
    parts = [_faces_of_panel(net, panel, which) for which, panel in enumerate(net.panels)]
    if not parts:
        none, nothing = np.empty((0, 4), dtype=np.int64), np.empty(0)
        return Faces(none, np.empty((0, 4)), nothing, nothing, nothing, np.empty(0, dtype=np.int64), none)
    return Faces(
        corners=np.concatenate([part.corners for part in parts]),
        share=np.concatenate([part.share for part in parts]),
        area=np.concatenate([part.area for part in parts]),
        solidity=np.concatenate([part.solidity for part in parts]),
        diameter=np.concatenate([part.diameter for part in parts]),
        panel=np.concatenate([part.panel for part in parts]),
        bars=np.concatenate([part.bars for part in parts]),
    )


def _faces_of_panel(net: Net, panel: Panel, which: int) -> Faces:
    grid = panel.lattice
    if len(grid.knots) != len(panel.knots):
        raise ValueError(
            f"panel '{panel.name}' has {len(panel.knots)} knots, but {panel.meshes[0]} x {panel.meshes[1]} "
            f"{panel.mesh} meshes have {len(grid.knots)}: give it the knots of its own meshes"
        )
    places = _corners(panel, grid)
    corners = panel.knots[places]
    triangle = places[:, 3] == places[:, 2]
    a, b, c, d = net.positions[corners].transpose(1, 0, 2)
    area = np.linalg.norm(0.5 * np.cross(c - a, d - b), axis=1)
    third = np.array([1.0, 1.0, 1.0, 0.0]) / 3.0
    count = len(corners)
    twine = next(t for t in net.twines if t.name == panel.twine)
    # Solidity is that of the real meshes, of which a face has many.
    real = area / (panel.group[0] * panel.group[1])
    return Faces(
        corners=corners,
        share=np.where(triangle[:, None], third, np.full(4, 0.25)),
        area=area,
        solidity=_solidity(panel, twine.diameter, real * _parts_of_a_mesh(panel, triangle)),
        diameter=np.full(count, twine.diameter),
        panel=np.full(count, which, dtype=np.int64),
        bars=_sides(panel, grid, places),
    )


def _corners(panel: Panel, grid: Lattice) -> Indices:
    kind = panel.kind
    if isinstance(kind, Hexagon):
        return _hexagon_corners(panel, grid, kind)
    return _square_corners(grid) if kind == "square" else _diamond_corners(grid)


def _parts_of_a_mesh(panel: Panel, triangle: NDArray[np.bool_]) -> Array:
    """How many times a face goes into the area of a mesh, (p,)."""
    kind = panel.kind
    if not isinstance(kind, Hexagon):
        return np.where(triangle, 2.0, 1.0)
    ratios = hanging_ratios(kind, panel.real_meshes, panel.bar_length, panel.size)
    across, rise = kind.rise(ratios)
    whole, tip = kind.area(1.0, ratios), across * max(rise, 0.0)
    return np.where(triangle, whole / tip if tip > 0.0 else 0.0, 2.0)


def _solidity(panel: Panel, diameter: float, area: Array) -> Array:
    """Solidity of meshes of these areas (p,) m2 hung like the panel, whose ratios E1, E2 differ with its width."""
    mesh = panel.kind
    e1, e2 = hanging_ratios(mesh, panel.real_meshes, panel.bar_length, panel.size)
    whole = mesh_area(mesh, panel.bar_length, (e1, e2))
    out = np.empty(len(area))
    # Meshes of one row are alike: few different areas.
    for one in np.unique(np.round(area / whole, 9)):
        alike = np.round(area / whole, 9) == one
        out[alike] = (
            solidity(mesh, panel.bar_length, (e1 * one, e2), diameter, panel.knot_diameter) if one else 1.0
        )
    return out


def _places(grid: Lattice) -> Indices:
    """Index of the knot at every (i, j), -1 where there is none."""
    index = np.full((grid.intervals[0] + 1, grid.intervals[1] + 1), -1, dtype=np.int64)
    index[grid.knots[:, 0], grid.knots[:, 1]] = np.arange(len(grid.knots))
    return index


def _around(index: Indices, at: Indices, steps: tuple[tuple[int, int], ...]) -> Indices:
    """Knots (k, 4) by steps from lattice points at (k, 2)."""
    return np.column_stack([index[at[:, 0] + i, at[:, 1] + j] for i, j in steps])


def _square_corners(grid: Lattice) -> Indices:
    i, j = np.indices(grid.intervals).reshape(2, -1)
    corners = _around(_places(grid), np.column_stack([i, j]), _SQUARE)
    return corners[(corners >= 0).all(axis=1)]


def _diamond_corners(grid: Lattice) -> Indices:
    """Whole meshes about every lattice point between four knots, and halves between three, row by row."""
    i, j = np.indices((grid.intervals[0] + 1, grid.intervals[1] + 1)).reshape(2, -1)
    middle = np.column_stack([i, j])[(i + j) % 2 == 1]
    # With a rim of places without knots, every middle has four neighbours.
    index = np.pad(_places(grid), 1, constant_values=-1)
    around = _around(index, middle + 1, _DIAMOND)
    missing = around < 0
    corners = np.full((len(middle), 4), -1, dtype=np.int64)
    whole = ~missing.any(axis=1)
    corners[whole] = around[whole]
    half = missing.sum(axis=1) == 1
    for side, steps in enumerate(_HALVES):
        here = half & missing[:, side]
        corners[here] = _around(index, middle[here] + 1, steps)
    return corners[corners[:, 0] >= 0]


def _hexagon_corners(panel: Panel, grid: Lattice, hexagon: Hexagon) -> Indices:
    """Halves of hexagons between two columns of knots, row by row, and triangles between the tips of both ends."""
    index, shape = _places(grid), grid.intervals
    if hexagon.turned:
        index, shape = index.T, shape[::-1]
    columns, rows = shape[0], shape[1] // 2
    i, row = np.indices((columns, rows)).reshape(2, -1)

    def knot(column: Indices, zigzag: Indices) -> Indices:
        return index[column, 2 * zigzag + (column + zigzag + 1) % 2]

    corners = [np.column_stack([knot(i, row), knot(i + 1, row), knot(i + 1, row + 1), knot(i, row + 1)])]
    for first, end, inner in ((1, 0, 1), (rows % 2, shape[1], shape[1] - 1)):
        tip = np.arange(first, columns - 1, 2)
        if panel.closed and first == 1:
            tip = np.append(tip, columns - 1)
        after = np.where(tip + 2 > columns, tip + 2 - columns, tip + 2)
        a, b, c = index[tip, end], index[tip + 1, inner], index[after, end]
        corners.append(np.column_stack([c, b, a, a] if end == 0 else [a, b, c, c]))
    every = np.concatenate(corners)
    if not hexagon.turned:
        return every
    turned = every[:, ::-1].copy()
    triangle = every[:, 3] == every[:, 2]
    turned[triangle] = every[triangle][:, [2, 1, 0, 0]]
    return turned


def _sides(panel: Panel, grid: Lattice, corners: Indices) -> Indices:
    """Bars (p, 4 s) from each corner to the next, all their segments; -1 where no bar joins them."""
    count = len(grid.knots)
    ends = np.sort(grid.bars, axis=1)
    keys = ends[:, 0] * count + ends[:, 1]
    order = np.argsort(keys, kind="stable")
    after = np.roll(corners, -1, axis=1)
    wanted = np.minimum(corners, after) * count + np.maximum(corners, after)
    which = order[np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)]
    there = (keys[which] == wanted)[:, :, None]
    return np.where(there, panel.bars[which], -1).reshape(len(corners), -1)
