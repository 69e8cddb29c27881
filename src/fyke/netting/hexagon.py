"""Hexagonal meshes: four slanted bars, and two long ones along the height or along the width.

A panel has rows of hexagons, every other row half a mesh aside, between zigzags of slanted bars; from row to row, long
bars join the high knots of one zigzag to the low ones of the next. One hexagon has two knots, two slanted bars and one
long bar of its own. "Across" is square to the long bars, "along" is along them. All lengths in m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Pair = tuple[float, float]


@dataclass(frozen=True)
class Hexagon:
    """A kind of mesh.

    long_bar: length of a long bar over a slanted one, above 0; turned: the long bars lie along the width (T90) and
    not along the height (T0).
    """

    long_bar: float
    turned: bool = False

    def turn(self, pair: Pair) -> Pair:
        """From width and height to across and along, or back."""
        return (pair[1], pair[0]) if self.turned else pair

    def last(self, meshes: tuple[int, int]) -> tuple[int, int]:
        """Return the largest i and j."""
        columns, rows = self.counts(meshes)
        return (2 * rows + 1, 2 * columns) if self.turned else (2 * columns, 2 * rows + 1)

    def knots_along(self, meshes: tuple[int, int], axis: int, *, last: bool) -> int:
        """Count the knots of an edge along an axis, 0: width, 1: height; last: of the upper or right edge."""
        columns, rows = self.counts(meshes)
        if axis == (1 if self.turned else 0):
            return columns + int(last and rows % 2 == 0)
        return rows + 1

    def has(self, i: int, j: int) -> bool:
        """Whether there is a knot (i, j), within the largest i and j."""
        across, along = (j, i) if self.turned else (i, j)
        return along % 2 == (across + along // 2 + 1) % 2

    def counts(self, meshes: tuple[int, int]) -> tuple[int, int]:
        """Hexagons across, and rows of them along."""
        return (meshes[1], meshes[0]) if self.turned else meshes

    def hung_size(self, meshes: tuple[int, int], side: float, ratios: Pair) -> Pair:
        """Width and height of a panel hung at E1, E2; side: length of a slanted bar.

        Hung at e across and f along, a hexagon is 2 side e wide, its rows are f (side + long) apart, and one zigzag
        more than there are rows stands out at the end.
        """
        (columns, rows), (e, f) = self.counts(meshes), self.turn(ratios)
        pitch = f * side * (1.0 + self.long_bar)
        return self.turn((columns * 2.0 * side * e, rows * pitch + pitch - side * self.long_bar))

    def ratios(self, meshes: tuple[int, int], side: float, size: Pair) -> Pair:
        """E1, E2 of a panel of this size: the inverse of hung_size."""
        (columns, rows), (across, along) = self.counts(meshes), self.turn(size)
        long = side * self.long_bar
        return self.turn((across / (columns * 2.0 * side), (along + long) / ((rows + 1) * (side + long))))

    def taut(self, first: float) -> Pair | None:
        """E1, E2 with every bar just taut where E1 is the first; None when no E2 is."""
        long = self.long_bar
        if not self.turned:
            return (first, (long + float(np.sqrt(1.0 - first**2))) / (1.0 + long))
        rise = first * (1.0 + long) - long
        return (first, float(np.sqrt(1.0 - rise**2))) if 0.0 <= rise < 1.0 else None

    def rise(self, ratios: Pair) -> Pair:
        """How far a slanted bar reaches across and along, over its length, with the long bars as long as unloaded."""
        e, f = self.turn(ratios)
        return e, f * (1.0 + self.long_bar) - self.long_bar

    def strains(self, meshes: tuple[int, int], side: float, size: Pair) -> Pair:
        """Strain of the slanted bars of a flat panel that spreads on a frame, and of the long ones, negative: slack."""
        ratios = self.ratios(meshes, side, size)
        e, rise = self.rise(ratios)
        if rise >= 0.0:
            return float(np.hypot(e, rise)) - 1.0, 0.0
        return e - 1.0, rise / self.long_bar

    def area(self, side: float, ratios: Pair) -> float:
        """Area of one hexagon, 2 side e f (side + long) (m2)."""
        return 2.0 * side**2 * (1.0 + self.long_bar) * ratios[0] * ratios[1]

    def solid_area(self, side: float, ratios: Pair, diameter: float, knot_diameter: float) -> float:
        """Area that one hexagon's own bars and knots cover (m2): straight bars and discs, less what they share.

        Two bars of diameter d that meet at an angle t share d^2/4 cot(t/2) on the inside. The slanted bars of a knot
        meet at 2 p, the long one meets either at pi - p, p being the angle of a slanted to a long bar.
        """
        d, dk = diameter, knot_diameter
        bars = side * (2.0 + self.long_bar)
        if dk > d:
            return d * (bars - 3.0 * dk) + np.pi * dk**2 / 2.0
        e, rise = self.rise(ratios)
        half = np.arctan2(e, max(rise, 0.0))
        return float(d * bars - 0.5 * d**2 * (1.0 / np.tan(half) + 2.0 * np.tan(half / 2.0)))

    def grid(self, meshes: tuple[int, int]) -> tuple[Indices, Indices, tuple[int, int]]:
        """Knots (n, 2) as (i, j), rising; bars (m, 2), in the order of their first knots; the largest i and j."""
        columns, rows = self.counts(meshes)
        across, zigzag = (a.ravel() for a in np.indices((2 * columns + 1, rows + 1)))
        along = 2 * zigzag + (across + zigzag + 1) % 2
        places = np.column_stack([along, across] if self.turned else [across, along])
        ends = self.last(meshes)
        places = places[np.lexsort((places[:, 1], places[:, 0]))]
        index = np.full((ends[0] + 1, ends[1] + 1), -1, dtype=np.int64)
        index[places[:, 0], places[:, 1]] = np.arange(len(places))
        bars = []
        steps: tuple[tuple[int, int], ...] = ((1, 1), (1, -1), (0, 1))
        for step in steps:
            di, dj = step[::-1] if self.turned else step
            i, j = places[:, 0] + di, places[:, 1] + dj
            there = (i >= 0) & (i <= ends[0]) & (j >= 0) & (j <= ends[1])
            other = np.full(len(places), -1)
            other[there] = index[i[there], j[there]]
            # Between zigzags, slanted steps lead to no knot or to one that no bar joins.
            level = places[:, 0 if self.turned else 1]
            joins = np.minimum(level, level + step[1]) % 2 == (step[0] == 0)
            from_here = np.flatnonzero((other >= 0) & joins)
            bars.append(np.column_stack([from_here, other[from_here]]))
        every = np.sort(np.concatenate(bars), axis=1)
        return places, every[np.lexsort((every[:, 1], every[:, 0]))], ends

    def long(self, knots: Indices, bars: Indices) -> NDArray[np.bool_]:
        """Whether a bar of the grid is a long one, (m,)."""
        across = knots[:, 1 if self.turned else 0][bars]
        return np.asarray(across[:, 0] == across[:, 1])

    def places(self, knots: Indices, meshes: tuple[int, int], side: float, size: Pair) -> Array:
        """Where knots (n, 2) of the grid lie when hung, in even intervals of the grid (n, 2).

        Long bars are as long as unloaded where the frame has room for them.
        """
        _, rise = self.rise(self.ratios(meshes, side, size))
        _, rows = self.counts(meshes)
        up = max(rise, 0.0)
        whole = rows * self.long_bar + (rows + 1) * up
        out = knots.astype(float)
        axis = 0 if self.turned else 1
        low = knots[:, axis] // 2
        high = knots[:, axis] - low
        out[:, axis] = (2 * rows + 1) * (low * self.long_bar + high * up) / whole
        return out
