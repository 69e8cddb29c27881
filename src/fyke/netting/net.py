"""Net: knots, bars and what they are made of. The noun that everything downstream reads."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from .cutting import End, Taper
from .hexagon import Hexagon
from .lattice import Corner, Lattice, Mesh, Side, lattice, places
from .twine import Twine

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Panel:
    """Where one piece of netting lies within a Net, for plan views and derived figures.

    shape: "panel" for a flat one, "cylinder", "cone" ...; mesh: "diamond" | "square" | "hexagonal"; meshes: along
    width and height; size: width and height laid flat (m); bar_length: unloaded, knot centre to knot centre (m);
    knot_diameter: m, 0 when knotless; twine: its name; closed: whether the width closes round. Of the knots and bars of
    netting.lattice: knots: (k,) knot of the net at each; bars: (b, s) bars of the net, the s segments of each. Of
    hexagons: long_bar: m, unloaded, bar_length being that of the slanted ones; turned: the long bars lie along the
    width (T90). Of netting cut to shape: cuts: of the left and the right side, from the wide end on, and the narrow
    end; meshes and size are those of the wide end. folds: lattice columns of the corners of a box, where its wall is
    folded. Of grouped netting meshes, knots and bars are those that it is laid with, and grouped_from: the meshes of
    the real netting, whose bar_length and knot_diameter these are; None where each mesh stands for itself.
    """

    name: str
    shape: str
    mesh: str
    meshes: tuple[int, int]
    size: tuple[float, float]
    bar_length: float
    knot_diameter: float
    twine: str
    closed: bool
    knots: NDArray[np.int64]
    bars: NDArray[np.int64]
    long_bar: float = 0.0
    turned: bool = False
    cuts: tuple[str, ...] = ()
    folds: tuple[int, ...] = ()
    grouped_from: tuple[int, int] | None = None

    @property
    def real_meshes(self) -> tuple[int, int]:
        """Meshes of the real netting along width and height."""
        return self.grouped_from or self.meshes

    @property
    def group(self) -> tuple[float, float]:
        """How many real meshes one of the net stands for along width and height."""
        real = self.real_meshes
        return real[0] / self.meshes[0], real[1] / self.meshes[1]

    @property
    def taper(self) -> Taper | None:
        """How its sides are cut, None where they are straight."""
        return Taper(self.cuts[0], self.cuts[1], cast(End, self.cuts[2])) if self.cuts else None

    @property
    def kind(self) -> Mesh:
        """The kind of mesh, as functions of netting.lattice take it."""
        if self.mesh == "hexagonal":
            return Hexagon(self.long_bar / self.bar_length, self.turned)
        return "square" if self.mesh == "square" else "diamond"

    @cached_property
    def lattice(self) -> Lattice:
        """The lattice of the meshes."""
        return lattice(self.kind, self.meshes, self.taper)

    @property
    def flat(self) -> Array:
        """Where the lattice knots lie on the netting laid flat, about its middle, (k, 2) m."""
        grid = self.lattice
        intervals = np.array(grid.intervals, dtype=float)
        at = places(grid, self.kind, self.meshes, self.bar_length, self.size)
        return np.asarray((at - 0.5 * intervals) * (np.array(self.size) / intervals))

    def real_place(self, i: int, j: int) -> Array:
        """Where a knot (i, j) of the real netting lies on the netting laid flat, about its middle, (2,) m."""
        intervals = np.array(self.lattice.intervals) * np.array(self.group)
        return np.asarray((np.array([i, j]) / intervals - 0.5) * np.array(self.size))

    def edge(self, which: Side | Corner) -> NDArray[np.int64]:
        """Knots of the net along an edge, in order from left to right or from below; corners: of a box.

        The rims of netting that closes round end with the knot that they begin with.
        """
        grid = self.lattice
        if which in ("top", "bottom", "left", "right"):
            knots = self.knots[grid.edge(which)]
            # Where a rim of hexagons has no knot in the first column, it has none in the last one that is the first.
            around = self.closed and which in ("top", "bottom") and knots[0] != knots[-1]
            return np.append(knots, knots[:1]) if around else knots
        number = int(which.removeprefix("corner")) - 1
        if number >= len(self.folds):
            raise ValueError(f"netting '{self.name}' has no {which}")
        there = np.flatnonzero(grid.knots[:, 0] == self.folds[number])
        return self.knots[there[np.argsort(grid.knots[there, 1], kind="stable")]]

    def real_along(self, which: Side | Corner) -> Array:
        """How many real knots of an edge each of its knots stands for, in the order of edge()."""
        along = 0 if which in ("top", "bottom") else 1
        many = np.full(len(self.edge(which)), self.group[along])
        if not (self.closed and along == 0):
            many[[0, -1]] = 0.5 * (self.group[along] + 1.0)
        return many


@dataclass(frozen=True)
class Rope:
    """Bars in a row: its knots (k,) in order, the last one the first where it closes, and its bars (k - 1,).

    kind: "rope" along netting, "line" that runs free of it, such as a mooring line, "ring" and "collar" of tubes.
    """

    name: str
    knots: NDArray[np.int64]
    bars: NDArray[np.int64]
    kind: str = "rope"


@dataclass(frozen=True)
class Bodies:
    """Floats or sinkers, all alike, one at each of some knots (k,).

    kind: "float" or "sinker"; each: mass kg, volume m3, drag_area m2 (C_D times area), diameter m.
    """

    name: str
    kind: str
    knots: NDArray[np.int64]
    mass: float
    volume: float
    drag_area: float
    diameter: float


def _single() -> Array:
    return np.empty(0)


@dataclass(frozen=True)
class Net:
    """n knots joined by m bars.

    positions: (n, 3) m, before anything acts; labels: n texts, row and column "i-j" on a panel; fixed: (n,) bool;
    bars: (m, 2) knot indices; rest_length: (m,) m, unloaded; twines: the twines in use; twine_of_bar: (m,) index
    into twines; knot_diameter: (n,) m, 0 for none; knot_density: (n,) kg/m3; load: (n, 3) N, dead load per knot on
    top of weight, buoyancy and water; panels, ropes, bodies: the panels of netting, the ropes, the floats and
    sinkers in it, each may be empty; bar_multiple: (m,) how many real bars side by side a bar stands for,
    knot_multiple: (n,) how many real knots a knot, see netting.multiples; what is missing at their ends is 1.
    Diameters and twines are those of the real bar and knot.
    """

    positions: Array
    labels: tuple[str, ...]
    fixed: NDArray[np.bool_]
    bars: NDArray[np.int64]
    rest_length: Array
    twines: tuple[Twine, ...]
    twine_of_bar: NDArray[np.int64]
    knot_diameter: Array
    knot_density: Array
    load: Array
    panels: tuple[Panel, ...] = field(default=())
    ropes: tuple[Rope, ...] = field(default=())
    bodies: tuple[Bodies, ...] = field(default=())
    bar_multiple: Array = field(default_factory=_single)
    knot_multiple: Array = field(default_factory=_single)

    def __post_init__(self) -> None:
        """Fit multiples that are all 1, and fill up others; ValueError for more of these than bars or knots."""
        for name, count in (("bar_multiple", self.bar_count), ("knot_multiple", self.knot_count)):
            given = getattr(self, name)
            if len(given) == count:
                continue
            if len(given) > count and np.any(given != 1.0):
                raise ValueError(f"{name} has {len(given)} numbers for {count}")
            fitted = np.concatenate([given[:count], np.ones(max(count - len(given), 0))])
            object.__setattr__(self, name, fitted)

    @property
    def knot_count(self) -> int:
        """Number of knots, n."""
        return len(self.positions)

    @property
    def bar_count(self) -> int:
        """Number of bars, m."""
        return len(self.bars)

    @property
    def bar_diameter(self) -> Array:
        """Twine diameter of every bar, (m,) m."""
        return np.array([t.diameter for t in self.twines])[self.twine_of_bar]

    @property
    def two_way(self) -> NDArray[np.bool_]:
        """Whether a bar also pushes, as those of tubes do, (m,)."""
        return np.array([t.compression for t in self.twines], dtype=bool)[self.twine_of_bar]

    def at_knots(self, what: Literal["mass", "volume", "drag_area"]) -> Array:
        """Return the mass (kg), volume (m3) or drag area (m2) of the bodies at every knot, (n,)."""
        out = np.zeros(self.knot_count)
        for bodies in self.bodies:
            np.add.at(out, bodies.knots, getattr(bodies, what))
        return out

    def bar_label(self, bar: int) -> str:
        """Return the two knot labels of a bar, "3-4 to 4-5"."""
        a, b = self.bars[bar]
        return f"{self.labels[a]} to {self.labels[b]}"
