"""Net: knots, bars and what they are made of. The noun that everything downstream reads."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .twine import Twine

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Panel:
    """Where one panel of netting lies within a Net, for plan views and derived figures.

    knots, bars: (first, behind-last) index ranges; axes: (2, 3) unit vectors of width and height; centre: (3,) m;
    mesh: "diamond" | "square"; meshes: along width and height; size: width and height of the frame (m);
    bar_length: unloaded, knot centre to knot centre (m); knot_diameter: m, 0 when knotless; twine: its name.
    """

    name: str
    mesh: str
    meshes: tuple[int, int]
    size: tuple[float, float]
    bar_length: float
    knot_diameter: float
    twine: str
    centre: Array
    axes: Array
    knots: tuple[int, int]
    bars: tuple[int, int]


@dataclass(frozen=True)
class Net:
    """n knots joined by m bars.

    positions: (n, 3) m, before anything acts; labels: n texts, row and column "i-j" on a panel; fixed: (n,) bool;
    bars: (m, 2) knot indices; rest_length: (m,) m, unloaded; twines: the twines in use; twine_of_bar: (m,) index
    into twines; knot_diameter: (n,) m, 0 for none; knot_density: (n,) kg/m3; load: (n, 3) N, dead load per knot
    on top of weight, buoyancy and water; panels: the panels of netting in it, may be empty.
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

    def bar_label(self, bar: int) -> str:
        """Return the two knot labels of a bar, "3-4 to 4-5"."""
        a, b = self.bars[bar]
        return f"{self.labels[a]} to {self.labels[b]}"
