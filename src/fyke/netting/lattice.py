"""Mesh lattices of a rectangular panel: which knots, which bars, how far apart; hexagons: netting.hexagon.

Knots have a row and a column (i, j), i along the width and j along the height. Diamond netting has a knot wherever
i + j is even, i = 0 .. 2 n, one half mesh diagonal apart; square netting has a knot at every (i, j), i = 0 .. n,
one bar apart. Bars of diamond netting run along the lattice diagonals, none along the frame; bars of square
netting run along rows and columns, those along the frame included.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .cutting import Taper
from .hexagon import Hexagon

Array = NDArray[np.float64]
MeshKind = Literal["diamond", "square"]
Mesh = MeshKind | Hexagon
Edge = Literal["edges", "top", "corners", "none"]
Side = Literal["top", "bottom", "left", "right"]
Corner = Literal["corner1", "corner2", "corner3", "corner4"]  # upright, of a box

# Lattice intervals per mesh along an axis.
INTERVALS = {"diamond": 2, "square": 1}


@dataclass(frozen=True)
class Lattice:
    """Knots (n, 2) as (i, j) and bars (m, 2) as knot indices; intervals: the largest i and j.

    cut: knots along the left and the right side from below, where these are cut; None where they are straight.
    """

    knots: NDArray[np.int64]
    bars: NDArray[np.int64]
    intervals: tuple[int, int]
    cut: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None

    def edge(self, which: Side) -> NDArray[np.int64]:
        """Return the knots along an edge, in order from left to right or from below."""
        if self.cut is not None and which in ("left", "right"):
            return self.cut[0 if which == "left" else 1]
        along, end = {"bottom": (0, 0), "top": (0, 1), "left": (1, 0), "right": (1, 1)}[which]
        there = np.flatnonzero(self.knots[:, 1 - along] == end * self.intervals[1 - along])
        return np.asarray(there[np.argsort(self.knots[there, along], kind="stable")])

    def held(self, where: Edge, *, closed: bool = False) -> NDArray[np.bool_]:
        """Knots (n,) that are held: on all edges, on the top row, on the four corners, or none.

        closed: the width closes round, and there are no edges and corners at its ends.
        """
        j = self.knots[:, 1]
        at_side, corners = np.zeros(len(j), dtype=bool), np.zeros(len(j), dtype=bool)
        at_end = (j == 0) | (j == self.intervals[1])
        if not closed:
            for side in (self.edge("left"), self.edge("right")):
                at_side[side] = True
                # Hexagons have no knot in some corners; the last one of the side stands for it.
                corners[side[[0, -1]]] = True
        held: dict[Edge, NDArray[np.bool_]] = {
            "edges": at_side | at_end,
            "corners": corners,
            "top": j == self.intervals[1],
            "none": np.zeros(len(j), dtype=bool),
        }
        return held[where]


def lattice(mesh: Mesh, meshes: tuple[int, int], taper: Taper | None = None) -> Lattice:
    """Return the lattice of a panel of so many meshes along the width and the height.

    An 8 x 8 diamond panel has 145 knots and 256 bars, an 8 x 8 square panel 81 and 144, one of hexagons 153 and 212.
    taper: how its sides are cut; meshes are then those of the wide end. ValueError for cuts that do not fit.
    """
    if isinstance(mesh, Hexagon):
        if taper is not None:
            raise ValueError("hexagonal netting is not cut to shape")
        return Lattice(*mesh.grid(meshes))
    ni, nj = (INTERVALS[mesh] * count for count in meshes)
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(ni + 1), np.arange(nj + 1), indexing="ij"))
    if mesh == "diamond":
        there = (i + j) % 2 == 0
        i, j = i[there], j[there]
        steps = ((1, 1), (1, -1))
    else:
        steps = ((1, 0), (0, 1))
    if taper is not None:
        first, last = taper.columns(mesh, (ni, nj))
        there = (i >= first[j]) & (i <= last[j])
        i, j = i[there], j[there]
    index = np.full((ni + 1, nj + 1), -1, dtype=np.int64)
    index[i, j] = np.arange(len(i))
    bars = []
    for di, dj in steps:
        inside = (i + di <= ni) & (j + dj >= 0) & (j + dj <= nj)
        pairs = np.column_stack([index[i[inside], j[inside]], index[i[inside] + di, j[inside] + dj]])
        bars.append(pairs[pairs[:, 1] >= 0])
    all_bars = np.concatenate(bars)
    # Bars in the order of their first knot, so that neighbours in space are neighbours in memory.
    order = np.argsort(all_bars[:, 0] * len(i) + all_bars[:, 1], kind="stable")
    sides = None
    if taper is not None:
        left, right = (index[path[:, 0], path[:, 1]] for path in taper.paths(mesh, (ni, nj)))
        sides = (left, right)
    return Lattice(np.column_stack([i, j]), all_bars[order], (ni, nj), sides)


def places(
    grid: Lattice, mesh: Mesh, meshes: tuple[int, int], bar_length: float, size: tuple[float, float]
) -> Array:
    """Where the knots of a lattice lie, hung at a size (m), in even intervals (n, 2): at i, j but for hexagons."""
    if isinstance(mesh, Hexagon):
        return mesh.places(grid.knots, meshes, bar_length, size)
    return grid.knots.astype(float)


def rest_lengths(grid: Lattice, mesh: Mesh, bar_length: float) -> Array:
    """Unloaded length of every bar of a lattice, (b,) m."""
    long = mesh.long_bar if isinstance(mesh, Hexagon) else 1.0
    which = mesh.long(grid.knots, grid.bars) if isinstance(mesh, Hexagon) else False
    return np.asarray(bar_length * np.where(which, long, np.ones(len(grid.bars))))


def taut_ratios(mesh: Mesh, first: float) -> tuple[float, float] | None:
    """E1, E2 of netting with every bar just taut, from E1; None where no E2 is. Square netting: E1 = E2 = 1."""
    if isinstance(mesh, Hexagon):
        return mesh.taut(first)
    return (first, float(np.sqrt(1.0 - first**2))) if mesh == "diamond" else None


def hung_size(
    mesh: Mesh, meshes: tuple[int, int], bar_length: float, ratios: tuple[float, float]
) -> tuple[float, float]:
    """Width and height (m) of a panel hung at ratios E1, E2 of its fully stretched width and height.

    The stretched size is meshes x 2 bars for diamond netting and meshes x 1 bar for square netting. bar_length of
    hexagons: of the slanted bars.
    """
    if isinstance(mesh, Hexagon):
        return mesh.hung_size(meshes, bar_length, ratios)
    bars_per_mesh = INTERVALS[mesh]
    return (
        meshes[0] * bars_per_mesh * bar_length * ratios[0],
        meshes[1] * bars_per_mesh * bar_length * ratios[1],
    )


def hanging_ratios(
    mesh: Mesh, meshes: tuple[int, int], bar_length: float, size: tuple[float, float]
) -> tuple[float, float]:
    """Return E1, E2: width and height over the fully stretched ones. Unloaded diamonds have E1^2 + E2^2 = 1."""
    if isinstance(mesh, Hexagon):
        return mesh.ratios(meshes, bar_length, size)
    full = hung_size(mesh, meshes, bar_length, (1.0, 1.0))
    return (size[0] / full[0], size[1] / full[1])


def flat_strain(
    mesh: Mesh, meshes: tuple[int, int], bar_length: float, size: tuple[float, float]
) -> tuple[float, ...]:
    """Strain of the bars of a flat panel spread on a frame of this size; negative where slack.

    One value for diamond netting, sqrt(E1^2 + E2^2) - 1; two for square netting, E1 - 1 along the width and
    E2 - 1 along the height; of hexagons the slanted and the long ones.
    """
    if isinstance(mesh, Hexagon):
        return mesh.strains(meshes, bar_length, size)
    e1, e2 = hanging_ratios(mesh, meshes, bar_length, size)
    return (float(np.hypot(e1, e2)) - 1.0,) if mesh == "diamond" else (e1 - 1.0, e2 - 1.0)
