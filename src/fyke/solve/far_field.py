"""Statics far from equilibrium: predictor and corrector on second-order cones (solve.cone)."""

from __future__ import annotations

import numpy as np

from ..forces.bars import elastic
from . import cone
from .equilibrium import Equilibrium, typical_tension
from .linear import Solve
from .two_way import TwoWay

# Fraction of the way to the edge of the cone that one step may take.
TO_EDGE = 0.99
# Largest rotation of a bar in one step (rad): a turning bar makes no false stretch here, but the water's load turns.
LARGEST_TURN = 0.35
# A net with tubes goes far as a whole, and the first taut line says little: near it is with a gap FARTHER times the
# usual, or with the usual one and steps below SHORT_FAR, as slack netting makes them.
FARTHER, SHORT_FAR = 1e-3, 0.05
# Strain that every bar is at least allowed at the start.
START_STRAIN = 0.05
# Least centring, (mu_affine / mu)^3 being Mehrotra's.
LEAST_CENTRING = 1e-6


class Far:
    """Steps on cones."""

    def __init__(self, s: Equilibrium) -> None:
        self.s, el = s, s.el
        m = len(el.knot_a)
        z = np.zeros
        self.f, self.k = z(m), z(m)
        self.scaling, self.scaled, self.row = z((m, 5)), z((m, 4)), z((m, 4))
        self.target, self.cross, self.push = z((m, 4)), z((m, 4)), z((m, 3))
        self.Y, self.Z, self.dY, self.dZ = z((m, 4)), z((m, 4)), z((m, 4)), z((m, 4))
        tension = max(typical_tension(el, s.b.load), float(s.b.f.max(initial=0.0)), s.floor)
        allowance = np.maximum(tension / el.stiffness, START_STRAIN * el.rest_length)
        self.Y[:, 0] = el.rest_length + np.maximum(s.b.length - el.rest_length, 0.0) + allowance
        self.Y[:, 1:] = s.x[el.knot_b] - s.x[el.knot_a]
        self.Z[:, 0] = tension
        # Halfway between no dual force and the one of the central path.
        self.Z[:, 1:] = -0.5 * tension * self.Y[:, 1:] / self.Y[:, :1]
        self.tubes = TwoWay(s, tension)
        # No cones: whatever lies well inside one, and does not change.
        self.Y[el.two_way] = 0.0
        self.Y[el.two_way, 0] = 2.0 * el.rest_length[el.two_way]
        self.Z[el.two_way] = 0.0
        self._last = 1.0
        self.cones = m - int(np.count_nonzero(el.two_way))

    def near(self, gap: float) -> bool:
        """Whether a bar is so near to its cone's edge, over its length, that the near field may take over."""
        if self.tubes.any and self.cones and self._last > SHORT_FAR:
            gap *= FARTHER
        return not self.cones or bool(cone.smallest_gap(self.Y, self.s.el.rest_length) < gap)

    def step(self) -> float:
        """Predictor and corrector; return the length of the step taken."""
        s, b, two_way = self.s, self.s.b, self.s.el.two_way
        elastic(self.Y[:, 0] - s.el.rest_length, s.el, self.f, self.k)
        mu = cone.cone_product(self.Y, self.Z, self.dY, self.dZ, 0.0, self.cones)
        cone.scaling_point(self.Y, self.Z, two_way, self.scaling, self.scaled)
        cone.cone_stiffness(self.scaling, self.k, two_way, b.block, self.row)
        self.tubes.stiffness()
        solve = s.factor()
        self.cross[:] = 0.0
        turn = self._direction(solve, 0.0)
        affine = min(1.0, cone.cone_step(self.Y, self.dY), cone.cone_step(self.Z, self.dZ))
        ratio = cone.cone_product(self.Y, self.Z, self.dY, self.dZ, affine, self.cones) / mu
        cone.cone_cross(self.scaling, self.dY, self.dZ, affine * affine, two_way, self.cross)
        self.tubes.bend(min(affine, LARGEST_TURN / max(turn, LARGEST_TURN)))
        turn = self._direction(solve, min(1.0, max(ratio**3, LEAST_CENTRING)) * mu)
        turn = LARGEST_TURN / max(turn, cone.cone_turn(self.Y, self.dY), LARGEST_TURN)
        edge = TO_EDGE * min(cone.cone_step(self.Y, self.dY), cone.cone_step(self.Z, self.dZ))
        step: float = min(turn, edge)
        self.Y += step * self.dY
        self.Z += step * self.dZ
        self.tubes.T += step * self.tubes.dT
        s.accept(step)
        self._last = step
        return step

    def _direction(self, solve: Solve, centre: float) -> float:
        """Search direction; returns the largest rotation of a two-way bar (rad)."""
        s, b = self.s, self.s.b
        cone.cone_target(self.scaling, self.scaled, centre, self.cross, s.el.two_way, self.target)
        cone.cone_right_side(
            self.tubes.load(),
            self.Z,
            self.f,
            self.target,
            self.row,
            s.el,
            s.pattern.free,
            self.push,
            b.total,
            b.right,
        )
        s.move(solve)
        cone.cone_changes(
            b.dx, self.Z, self.f, self.k, self.target, self.row, self.push, b.block, s.el, self.dY, self.dZ
        )
        return self.tubes.changes()
