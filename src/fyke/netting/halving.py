"""Netting of several sheets with half as many meshes each way: cages of wall and bottom, with ropes along their edges.

Every coarse knot stands at a knot of the real netting, so that sheets which share knots share coarse knots as well, and
netting that closes round closes round. What is no netting stays as it is: knots of no sheet all remain, and of a rope
those that remain, its bars joined to longer ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from .grouping import Grid, carry, nearest
from .lattice import MeshKind
from .net import Net, Panel, Rope

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Meshes that coarse netting has at least, round or across, and along its height.
FEWEST_ACROSS, FEWEST_DOWN = 12, 3


@dataclass(frozen=True)
class Sheet:
    """One sheet of netting on both lattices; knots, bars: (k,), (b,) of the coarse net at its lattice."""

    panel: Panel
    fine: Grid
    coarse: Grid
    knots: Indices
    bars: Indices

    @property
    def many(self) -> Array:
        """How many real meshes a coarse one stands for, along width and height (2,)."""
        return np.asarray(np.array(self.fine.lattice.intervals) / np.array(self.coarse.lattice.intervals))

    @property
    def side(self) -> float:
        """How many real bars lie side by side in a coarse one."""
        return float(np.sqrt(self.many.prod()))

    def longer(self, which: int) -> float:
        """How many times as long the bars of a direction become, so that flat netting keeps its strain."""
        if self.fine.mesh == "square":
            return float(self.many[which])
        spacing = np.array(self.panel.size) / np.array(self.fine.lattice.intervals)
        return float(np.linalg.norm(self.many * spacing) / np.linalg.norm(spacing))


@dataclass(frozen=True)
class Halved:
    """A net with half as many meshes each way: N coarse knots, M coarse bars.

    knots: (N,) knot of the net at each; ends: (M, 2) coarse knots; bars: (M,) a bar of the net that each is made of,
    and how: times (M,) as long, beside (M,) so many; sheets: the netting; ropes: those of the net on the coarse knots;
    joined: (m,) the coarse bar that a real bar of no sheet is part of, -1 of netting.
    """

    knots: Indices
    ends: Indices
    bars: Indices
    times: Array
    beside: Array
    sheets: tuple[Sheet, ...]
    ropes: tuple[Rope, ...]
    joined: Indices

    @property
    def words(self) -> str:
        """The meshes of its sheets."""
        return " and ".join(f"{one.coarse.meshes[0]} x {one.coarse.meshes[1]}" for one in self.sheets)

    def share(self, net: Net) -> csr_matrix:
        """Return what of a load on every knot of the net each coarse knot takes, (N, n); nothing is lost."""
        n = net.knot_count
        rows, columns, parts = [np.arange(len(self.knots))], [self.knots], [np.ones(len(self.knots))]
        known = np.zeros(n, dtype=bool)
        known[self.knots] = True
        for one in self.sheets:
            own = ~known[one.panel.knots]
            at, corner, part = _corners(one, np.flatnonzero(own))
            rows.append(one.knots[corner])
            columns.append(one.panel.knots[at])
            parts.append(part)
            known[one.panel.knots] = True
        matrix = csr_matrix(
            (np.concatenate(parts), (np.concatenate(rows), np.concatenate(columns))),
            shape=(len(self.knots), n),
        )
        # A knot at a seam was met twice.
        total = np.asarray(matrix.sum(axis=0)).ravel()
        return csr_matrix(matrix.multiply(1.0 / np.where(total > 0.0, total, 1.0)[None, :]))

    def carried(self, net: Net, positions: Array, tension: Array) -> tuple[Array, Array]:
        """Return positions (n, 3) m and tensions (m,) N of the net for those of the coarse one."""
        x, force = np.empty((net.knot_count, 3)), tension[np.maximum(self.joined, 0)]
        x[self.knots] = positions
        for one in self.sheets:
            x[one.panel.knots] = carry(positions[one.knots], one.coarse.knots, one.fine.knots, 3)
            for which in (0, 1):
                have, want = one.coarse.directions[which], one.fine.directions[which]
                own = tension[one.bars[one.coarse.bars[which]]]
                force[one.panel.bars[one.fine.bars[which], 0]] = carry(own, have, want, 1) / one.side
        return x, np.maximum(force, 0.0)


def halved(net: Net) -> Halved | None:
    """Return a net with half as many meshes each way, None where it is not to be had.

    That is for nets of diamond and square netting in one piece a bar, not cut to shape, of enough meshes; ropes and
    whatever else is tied to it must be tied to knots that remain.
    """
    grids = []
    for panel in net.panels:
        if panel.mesh == "hexagonal" or panel.cuts or panel.folds or panel.bars.shape[1] != 1:
            return None
        mesh: MeshKind = "square" if panel.mesh == "square" else "diamond"
        coarse = ((panel.meshes[0] + 1) // 2, (panel.meshes[1] + 1) // 2)
        if coarse[0] < FEWEST_ACROSS or coarse[1] < FEWEST_DOWN:
            return None
        grids.append((panel, Grid.of(mesh, panel.meshes), Grid.of(mesh, coarse)))
    if not grids:
        return None
    stand = [panel.knots[nearest(fine.knots, coarse.knots)] for panel, fine, coarse in grids]
    if not all(_apart(panel, coarse, at) for (panel, _, coarse), at in zip(grids, stand, strict=True)):
        return None
    return _tied(net, grids, stand)


def _apart(panel: Panel, coarse: Grid, stand: Indices) -> bool:
    """Whether coarse knots that are not one stand at different knots."""
    i, j = coarse.knots.at.T
    ni, nj = coarse.lattice.intervals
    i = np.where((i == ni) & panel.closed, 0, i)
    bottom = np.unique(panel.edge("bottom"))
    i = np.where((j == 0) & (len(bottom) == 1), 0, i)
    return len(np.unique(stand)) == len(np.unique(i * (nj + 1) + j))


def _tied(net: Net, grids: list[tuple[Panel, Grid, Grid]], stand: list[Indices]) -> Halved | None:
    """Put sheets, ropes and all else together; None where something is tied to a knot that goes."""
    kept = np.zeros(net.knot_count, dtype=bool)
    of_netting, netting = np.zeros(net.knot_count, dtype=bool), np.zeros(net.bar_count, dtype=bool)
    for (panel, _, _), at in zip(grids, stand, strict=True):
        kept[at] = True
        of_netting[panel.knots], netting[panel.bars[:, 0]] = True, True
    kept |= ~of_netting
    knots = np.flatnonzero(kept)
    index = np.full(net.knot_count, -1, dtype=np.int64)
    index[knots] = np.arange(len(knots))
    books = _Books(net, index)
    sheets = tuple(books.sheet(*grid, index[at]) for grid, at in zip(grids, stand, strict=True))
    ropes = []
    for rope in net.ropes:
        made = books.rope(rope)
        if made is None:
            return None
        ropes.append(made)
    if not books.rest(~netting):
        return None
    ends, bars, times, beside = books.columns()
    return Halved(knots, ends, bars, times, beside, sheets, tuple(ropes), books.joined)


class _Books:
    """Coarse bars as they are found."""

    def __init__(self, net: Net, index: Indices) -> None:
        self.net, self.index = net, index
        self.joined = np.full(net.bar_count, -1, dtype=np.int64)
        self._rows: list[tuple[Indices, Indices, Array, Array]] = []
        self._count = 0
        self._there: dict[tuple[int, int, int], int] = {}

    def add(self, ends: Indices, bars: Indices, times: Array, beside: Array) -> Indices:
        """Take up coarse bars and return their numbers."""
        self._rows.append((ends, bars, times, beside))
        self._count += len(bars)
        return np.arange(self._count - len(bars), self._count)

    def columns(self) -> tuple[Indices, Indices, Array, Array]:
        """All that was taken up: ends, bars, times, beside."""
        ends, bars, times, beside = (np.concatenate(column) for column in zip(*self._rows, strict=True))
        return ends, bars, times, beside

    def sheet(self, panel: Panel, fine: Grid, coarse: Grid, knots: Indices) -> Sheet:
        """Take up the bars of a sheet."""
        made = Sheet(panel, fine, coarse, knots, np.empty(0, dtype=np.int64))
        count = len(coarse.lattice.bars)
        own, times = np.empty(count, dtype=np.int64), np.empty(count)
        for which in (0, 1):
            near = nearest(fine.directions[which], coarse.directions[which])
            own[coarse.bars[which]] = panel.bars[fine.bars[which][near], 0]
            times[coarse.bars[which]] = made.longer(which)
        ends = knots[coarse.lattice.bars]
        # Bars along a seam are there twice; two different ones may join the same knots, as at a tip.
        keys = [(min(a, b), max(a, b), bar) for (a, b), bar in zip(ends.tolist(), own.tolist(), strict=True)]
        new: list[int] = []
        for number, key in enumerate(keys):
            if key not in self._there:
                self._there[key] = self._count + len(new)
                new.append(number)
        self.add(ends[new], own[new], times[new], np.full(len(new), made.side))
        numbers = np.array([self._there[key] for key in keys])
        return Sheet(panel, fine, coarse, knots, numbers)

    def rope(self, rope: Rope) -> Rope | None:
        """Take up a rope, its bars joined between the knots that remain; None where one of its ends goes."""
        knots, bars = rope.knots, rope.bars
        if knots[0] == knots[-1] and self.index[knots[0]] < 0:
            stays = np.flatnonzero(self.index[knots] >= 0)
            if not len(stays):
                return None
            bars = np.roll(bars, -stays[0])
            knots = np.append(np.roll(knots[:-1], -stays[0]), knots[stays[0]])
        stays = np.flatnonzero(self.index[knots] >= 0)
        if stays[0] != 0 or stays[-1] != len(knots) - 1:
            return None
        lengths = np.add.reduceat(self.net.rest_length[bars], stays[:-1])
        first = bars[stays[:-1]]
        at = self.index[knots[stays]]
        times = lengths / self.net.rest_length[first]
        numbers = self.add(np.column_stack([at[:-1], at[1:]]), first, times, np.ones(len(first)))
        self.joined[bars] = np.repeat(numbers, np.diff(stays))
        return Rope(rope.name, at, numbers, rope.kind)

    def rest(self, others: NDArray[np.bool_]) -> bool:
        """Take up the bars of no sheet and no rope as they are; whether both knots of each remain."""
        left = np.flatnonzero(others & (self.joined < 0))
        ends = self.index[self.net.bars[left]]
        if len(left):
            self.joined[left] = self.add(ends, left, np.ones(len(left)), np.ones(len(left)))
        return bool((ends >= 0).all())


def _corners(one: Sheet, which: Indices) -> tuple[Indices, Indices, Array]:
    """Lattice knots among `which` with the coarse lattice knots about each, and the part that each takes."""
    x, y = one.fine.knots.on(one.coarse.knots)[which].T
    ni, nj = one.coarse.lattice.intervals
    number = np.full((ni + 1, nj + 1), -1, dtype=np.int64)
    number[tuple(one.coarse.knots.at.T)] = np.arange(len(one.coarse.knots.at))
    if one.coarse.mesh == "diamond":
        s, t = np.floor(0.5 * (x + y)), np.floor(0.5 * (y - x))
        ps, pt = 0.5 * (x + y) - s, 0.5 * (y - x) - t
        steps = [
            (s + a, t + b, (ps if a else 1.0 - ps) * (pt if b else 1.0 - pt)) for a in (0, 1) for b in (0, 1)
        ]
        steps = [(u - v, u + v, part) for u, v, part in steps]
    else:
        s, t = np.floor(x), np.floor(y)
        ps, pt = x - s, y - t
        steps = [
            (s + a, t + b, (ps if a else 1.0 - ps) * (pt if b else 1.0 - pt)) for a in (0, 1) for b in (0, 1)
        ]
    rows, columns, parts = [], [], []
    for i, j, part in steps:
        there = (i >= 0) & (i <= ni) & (j >= 0) & (j <= nj) & (part > 0.0)
        # What is on an edge stays on it.
        for at, end in ((y, 0.0), (y, float(nj))):
            there &= (at != end) | (j == end)
        at = np.flatnonzero(there)
        rows.append(which[at])
        columns.append(number[i[at].astype(np.int64), j[at].astype(np.int64)])
        parts.append(part[at])
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(parts)
