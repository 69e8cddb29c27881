"""Netting laid on a surface: knots where the meshes meet it, bars between them, each in one or several segments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .cutting import Taper
from .hexagon import Hexagon
from .lattice import Edge, Lattice, Mesh, MeshKind, lattice, places, rest_lengths
from .multiples import bar_multiples, grouped_meshes, knot_multiples, real_indices
from .net import Net, Panel
from .twine import Twine

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
# From lattice intervals right of and above the middle (k, 2), and how many there are (2,), to places (k, 3) m. Counted
# from the middle, both halves have the same rounding.
Surface = Callable[[Array, Array], Array]


@dataclass(frozen=True)
class Netting:
    """What netting is made of.

    mesh: kind; bar_length: m, knot centre to knot centre, unloaded, of hexagons the slanted bars; knot_diameter: m,
    0 for knotless; knot_density: kg/m3, the twine's when None; segments: straight pieces that a bar is cut into, so
    that it can bow; group: one mesh is laid for so many real ones along width and along height.
    """

    twine: Twine
    mesh: Mesh
    bar_length: float
    knot_diameter: float = 0.0
    knot_density: float | None = None
    segments: int = 1
    group: int = 1


def sheet(
    netting: Netting,
    meshes: tuple[int, int],
    surface: Surface,
    *,
    shape: str,
    size: tuple[float, float],
    closed: bool = False,
    tip: bool = False,
    taper: Taper | None = None,
    folds: tuple[int, ...] = (),
    fixed: Edge = "edges",
    name: str = "",
) -> Net:
    """Lay netting of so many meshes along width and height on a surface, grouped as the netting says.

    shape: its name; size: m, width and height when laid flat; closed: the width closes round, and the last column of
    knots is the first; tip: the lowest row is one knot; taper: how its sides are cut, meshes and size being those of
    the wide end; folds: meshes from the left at which it is folded; fixed: which knots are held. Knots are labelled
    "i-j", with "name:" before it when there is a name; those within a bar of several segments by the bar's ends and
    their number, "0-0>1-1.1"; those of grouped netting by the real knots at their places. ValueError for hexagons that
    close round with their long bars along the width, or run to a tip, for netting both cut and closed, and for netting
    that cannot be grouped.
    """
    few = _fewer(netting, meshes, closed)
    hexagon = netting.mesh if isinstance(netting.mesh, Hexagon) else None
    _refuse(netting, taper, closed=closed, tip=tip)
    grid = lattice(netting.mesh, few.meshes, taper)
    intervals = np.array(grid.intervals, dtype=float)
    at = places(grid, netting.mesh, few.meshes, netting.bar_length, size)
    own, knots = _own_knots(grid, closed, tip)
    ends, bars = _own_bars(grid, knots, closed)
    prefix = f"{name}:" if name else ""
    labels = _labels(prefix, few.labels(grid.knots[own]))
    positions, held = (
        surface(at[own] - 0.5 * intervals, intervals),
        grid.held(fixed, closed=closed)[own],
    )
    n, s = len(own), netting.segments
    inner, chains = _segments(ends, n, s)
    share = (np.arange(1, s) / s)[None, :, None]
    between = positions[ends[:, :1]] * (1.0 - share) + positions[ends[:, 1:]] * share
    labels += _labels_within(prefix, labels, ends if s > 1 else ends[:0], s)
    inner_count, m = inner.size, len(ends) * s
    twine, density = netting.twine, netting.knot_density
    where = Panel(
        name=name,
        shape=shape,
        mesh="hexagonal" if isinstance(netting.mesh, Hexagon) else netting.mesh,
        meshes=few.meshes,
        size=size,
        bar_length=netting.bar_length,
        knot_diameter=netting.knot_diameter,
        twine=twine.name,
        closed=closed,
        knots=knots,
        bars=np.arange(m).reshape(-1, s)[bars],
        long_bar=hexagon.long_bar * netting.bar_length if hexagon else 0.0,
        turned=hexagon.turned if hexagon else False,
        cuts=(taper.left, taper.right, taper.narrow) if taper else (),
        folds=tuple(round(grid.intervals[0] * fold / meshes[0]) for fold in folds),
        grouped_from=None if few.meshes == meshes else meshes,
    )
    side_by_side, longer, many = few.multiples(grid, size, closed=closed, tip=tip)
    rest_length, bar_multiple = np.empty(len(ends)), np.empty(len(ends))
    rest_length[bars] = longer * rest_lengths(grid, netting.mesh, netting.bar_length) / s
    bar_multiple[bars] = side_by_side
    return Net(
        positions=np.concatenate([positions, between.reshape(-1, 3)]),
        labels=tuple(labels),
        fixed=np.concatenate([held, np.zeros(inner_count, dtype=bool)]),
        bars=chains,
        rest_length=np.repeat(rest_length, s),
        twines=(twine,),
        twine_of_bar=np.zeros(m, dtype=np.int64),
        knot_diameter=np.concatenate([np.full(n, netting.knot_diameter), np.zeros(inner_count)]),
        knot_density=np.concatenate(
            [np.full(n, twine.density if density is None else density), np.full(inner_count, twine.density)]
        ),
        load=np.zeros((n + inner_count, 3)),
        panels=(where,),
        bar_multiple=np.repeat(bar_multiple, s),
        knot_multiple=np.concatenate([many[own], np.ones(inner_count)]),
    )


def _refuse(netting: Netting, taper: Taper | None, *, closed: bool, tip: bool) -> None:
    """Raise ValueError for netting that cannot close round, be cut or be grouped as it is asked."""
    if isinstance(netting.mesh, Hexagon) and (tip or (closed and netting.mesh.turned)):
        raise ValueError(
            "hexagonal netting closes round with its long bars along the height (T0), and has no tip"
        )
    if taper is not None and (closed or tip):
        raise ValueError("netting whose sides are cut does not close round by itself: join its sides")
    if taper is not None and netting.group > 1:
        raise ValueError("netting cut to shape is not grouped: its cuts go mesh by mesh")


def _labels_within(prefix: str, labels: list[str], ends: Indices, segments: int) -> list[str]:
    """Labels "a>b.k" of the knots within bars of so many segments, whose ends (m, 2) have labels."""
    return [
        f"{prefix}{labels[a].removeprefix(prefix)}>{labels[b].removeprefix(prefix)}.{k}"
        for a, b in ends.tolist()
        for k in range(1, segments)
    ]


def _labels(prefix: str, knots: Indices) -> list[str]:
    """Labels "i-j" of lattice knots (n, 2), put together from those of columns and rows: a million take long."""
    columns, rows = ([str(k) for k in range(int(last) + 1)] for last in knots.max(axis=0))
    columns = [f"{prefix}{column}-" for column in columns]
    return [columns[i] + rows[j] for i, j in zip(knots[:, 0].tolist(), knots[:, 1].tolist(), strict=True)]


@dataclass(frozen=True)
class _Fewer:
    """The meshes that netting is laid with; many: real ones to one of them along width and height."""

    mesh: Mesh
    meshes: tuple[int, int]
    many: tuple[float, float]

    @property
    def kind(self) -> MeshKind:
        """The kind of mesh, where it can be grouped."""
        return "square" if self.mesh == "square" else "diamond"

    def labels(self, knots: Indices) -> Indices:
        """Row and column (k, 2) that knots (k, 2) of the lattice are called by."""
        return knots if self.many == (1.0, 1.0) else real_indices(knots, self.kind, self.many)

    def multiples(
        self, grid: Lattice, size: tuple[float, float], *, closed: bool, tip: bool
    ) -> tuple[Array, Array, Array]:
        """Real bars side by side and times as long (b,), real knots (k,)."""
        if self.many == (1.0, 1.0):
            return np.ones(len(grid.bars)), np.ones(len(grid.bars)), np.ones(len(grid.knots))
        bars = bar_multiples(grid, self.kind, self.many, size, closed=closed)
        return *bars, knot_multiples(grid, self.many, closed=closed, tip=tip)


def _fewer(netting: Netting, meshes: tuple[int, int], closed: bool) -> _Fewer:
    if netting.group > 1 and isinstance(netting.mesh, Hexagon):
        raise ValueError("hexagonal netting is not grouped: its zigzag edges have no larger likeness")
    if netting.group > 1 and netting.segments > 1:
        raise ValueError(
            "bars in segments are not grouped: a bundle n times as long would bow n times as far"
        )
    few = grouped_meshes(meshes, netting.group, closed=closed)
    return _Fewer(netting.mesh, few, (meshes[0] / few[0], meshes[1] / few[1]))


def _own_knots(grid: Lattice, closed: bool, tip: bool) -> tuple[Indices, Indices]:
    """Lattice knots that become knots of the net (n,), and the knot of the net at every lattice knot (k,)."""
    i, j = grid.knots.T
    column = np.where(closed & (i == grid.intervals[0]), 0, i)
    column[tip & (j == 0)] = 0
    own = np.flatnonzero(column == i)
    index = np.full((grid.intervals[0] + 1, grid.intervals[1] + 1), -1, dtype=np.int64)
    index[i[own], j[own]] = np.arange(len(own))
    return own, index[column, j]


def _own_bars(grid: Lattice, knots: Indices, closed: bool) -> tuple[Indices, Indices]:
    """Ends (m, 2) of the bars of the net, and the bar of the net at every lattice bar (b,).

    Bars along the last column of closed netting are those along the first.
    """
    i, j = grid.knots[:, 0][grid.bars], grid.knots[:, 1][grid.bars]
    again = closed & (i == grid.intervals[0]).all(axis=1)
    own = np.flatnonzero(~again)
    which = np.empty(len(grid.bars), dtype=np.int64)
    which[own] = np.arange(len(own))
    seam = np.flatnonzero((i == 0).all(axis=1))
    order = seam[np.argsort(j[seam].min(axis=1), kind="stable")]
    which[again] = which[order[np.searchsorted(j[order].min(axis=1), j[again].min(axis=1))]]
    return knots[grid.bars[own]], which


def _segments(ends: Indices, first: int, segments: int) -> tuple[Indices, Indices]:
    """Knots within the bars (m, s - 1), numbered from first on, and the ends of all segments (m s, 2)."""
    inner = first + np.arange(len(ends) * (segments - 1)).reshape(len(ends), segments - 1)
    chain = np.column_stack([ends[:, 0], inner, ends[:, 1]])
    return inner, np.stack([chain[:, :-1], chain[:, 1:]], axis=2).reshape(-1, 2)
