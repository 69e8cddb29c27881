"""A net on its way to equilibrium: positions, forces, tangent and counters of one static solve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import add_tension, assemble, bar_geometry, borne, elastic, largest_on_free
from ..forces.shear import add_shear
from ..forces.surroundings import Surroundings
from ..system.elements import Elements
from ..system.system import State, System
from .approach import Approach
from .linear import Factorizer, Pattern, Solve, factorizer
from .smooth import assemble_step

Array = NDArray[np.float64]

# Rounding of a residual: so many units in the last place of stiffness times coordinate.
ROUNDING = 8.0


def typical_tension(el: Elements, load: Array) -> float:
    """All loads (n, 3) N together over the bars that end on a held knot, or over one bar when there is none; N."""
    held = int(np.count_nonzero((el.free[el.knot_a] == 0.0) | (el.free[el.knot_b] == 0.0)))
    return float(np.linalg.norm(load, axis=1).sum() / max(held, 1))


@dataclass
class Work:
    """Work arrays, n knots and m bars.

    t: (m, 3) unit vectors; length: (m,) m; f, k: (m,) law (N) and slope (N/m); block: (m, 3, 3) stiffness (N/m);
    load, total: (n, 3) N; right: (3 n_free,) N; data: of the tangent; dx: (n, 3) m.
    """

    t: Array
    length: Array
    f: Array
    k: Array
    block: Array
    load: Array
    total: Array
    right: Array
    data: Array
    dx: Array

    @classmethod
    def of(cls, n: int, m: int, pattern: Pattern) -> Work:
        """Return arrays of zeros."""
        z = np.zeros
        size = len(pattern.indptr) - 1
        return cls(
            z((m, 3)),
            z(m),
            z(m),
            z(m),
            z((m, 3, 3)),
            z((n, 3)),
            z((n, 3)),
            z(size),
            z(len(pattern.indices)),
            z((n, 3)),
        )


class Equilibrium:
    """Positions about the net's middle, the forces there, and how often the tangent was factorized.

    follows: the shelter is that of the present shape at every step; else it is held until it is renewed. approach: how
    much of its change a step makes, None for all of it; the residual is that of the whole change. smoothing: of
    a warm start with carried tensions, see solve.warm_field, None for the usual.
    """

    def __init__(self, system: System, start: State, linear: Factorizer | None) -> None:
        self.system, self.el = system, system.elements
        self.surroundings, self.time = Surroundings(system), start.time
        self.pattern = Pattern.of(self.el, self.surroundings.groups)
        self.follows = self.surroundings.shelters
        self.linear = linear or factorizer(self.pattern)
        # About the net's middle, coordinates are smallest and so is their rounding.
        self.origin = start.position.mean(axis=0)
        self.x = start.position - self.origin
        self._still = np.zeros_like(self.x)
        self.u = self.x
        self.b = Work.of(len(self.x), len(self.el.knot_a), self.pattern)
        self.iterations = self.factorizations = 0
        self.smoothing: tuple[float, float] | None = None
        self.approach: Approach | None = None
        self.residual, self.worst = self.true_residual()
        self.good = self.x.copy()

    @property
    def floor(self) -> float:
        """Residual (N) that rounding of the coordinates makes."""
        size = float(np.abs(self.x).max(initial=0.0))
        return ROUNDING * float(np.finfo(float).eps) * float(self.el.stiffness.max(initial=0.0)) * size

    def true_residual(self) -> tuple[float, int]:
        """Largest unbalanced force (N) on a free knot, and that knot."""
        if self.follows:
            self.surroundings.renew(self.x + self.origin, self.time)
        self.el, self.u = self.surroundings.at(self.x + self.origin, self._still, self.time)
        b, el = self.b, self.el
        bar_geometry(self.x, el, b.t, b.length)
        elastic(b.length - el.rest_length, el, b.f, b.k)
        self.surroundings.load(self.x, self.u, el, b.t, b.length, b.load)
        b.total[:] = b.load
        add_tension(borne(b.f, el), el, b.t, b.total)
        worst, where = largest_on_free(b.total, el.free)
        return float(worst), int(where)

    def renew(self) -> None:
        """Find the shelter of the present shape, and the forces in it."""
        self.surroundings.renew(self.x + self.origin, self.time)
        self.residual, self.worst = self.true_residual()

    def factor(self) -> Solve:
        """Factorize the tangent for the present stiffness blocks."""
        self.assemble()
        self.factorizations += 1
        return self.linear.factor(self.b.data)

    def assemble(self) -> None:
        """Put the tangent together for the present stiffness blocks."""
        b, p = self.b, self.pattern
        assemble(b.block, self.u, self.el, b.t, p.start, p.stride, b.data)
        water = self.surroundings
        water.assemble(self.x, self.u, 1.0, 0.0, p.groups, symmetric=False, data=b.data)
        shear = water.shear(self.x + self.origin, self.time)
        if shear is not None:
            add_shear(self._drag(), shear, p.free, p.indptr, b.data)
        places = p.start, p.stride, p.diagonal
        water.add_wetting(
            self.x, self.u, self.el, b.t, b.length, places, p.groups, symmetric=False, data=b.data
        )

    def _drag(self) -> Array:
        """Return -dF/dv, the tangent of the water's load by the knots' velocities, as data of the pattern."""
        b, p, m, n = self.b, self.pattern, len(self.el.knot_a), len(self.x)
        data, none = np.zeros(len(p.indices)), np.zeros(m)
        assemble_step(
            self.u, self.el, b.t, b.length, none, none, 0.0, 1.0, 0.0, np.zeros((n, 6)), False,
            p.start, p.stride, p.diagonal, data,
        )  # fmt: skip
        screens = self.surroundings.screens
        if screens is not None:
            screens.assemble(self.x, self.u, 0.0, 1.0, p.groups[0], symmetric=False, data=data)
        return data

    def move(self, solve: Solve) -> None:
        """Motion of the free knots for the present right side."""
        self.b.dx[self.pattern.free] = solve(self.b.right).reshape(-1, 3)

    def begin_at(self, x: Array) -> None:
        """Go to positions x (n, 3) m about the origin."""
        self.x[:] = x
        self.residual, self.worst = self.true_residual()

    def accept(self, step: float) -> None:
        """Take a step and judge it."""
        held = self.surroundings.left
        self.x += step * self.b.dx
        self.iterations += 1
        self.residual, self.worst = self.true_residual()
        if self.follows and self.approach is not None:
            self._follow_in_part(held, self.approach)
        if np.isfinite(self.residual):
            self.good[:] = self.x

    def _follow_in_part(self, held: Array, approach: Approach) -> None:
        """Let the shelter of the next step go part of the way from the one held (n, 1) to that of the shape."""
        water, b = self.surroundings, self.b
        water.left = approach.step(held, water.left)
        self.el, self.u = water.at(self.x + self.origin, self._still, self.time)
        water.load(self.x, self.u, self.el, b.t, b.length, b.load)
