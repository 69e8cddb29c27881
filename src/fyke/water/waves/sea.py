"""A sea of any kind: a sum of harmonics, and what it does to the water at points and times."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..ramp import ramp

Array = NDArray[np.float64]

Stretching = Literal["wheeler", "none", "formula"]
LOG2_E = 1.0 / math.log(2.0)


@dataclass(frozen=True, eq=False)
class Motion:
    """What the waves do at n points: velocity (n, 3) m/s, acceleration (n, 3) m/s2 and the elevation (n,) m there."""

    velocity: Array
    acceleration: Array
    elevation: Array


class Harmonics(NamedTuple):
    """Harmonics as the kernels take them, arrays (c,): eta = a cos, u = U C cos, w = U S sin of the phase.

    The phase in turns is turns_x x + turns_y y + phase - frequency t. With E = 2^(decay z) = e^(kz) and M = e^(-2kh),
    C = cosh k(z+h) / sinh kh = (E + M/E) / (1 - M) and S = sinh k(z+h) / sinh kh = (E - M/E) / (1 - M): no term
    overflows. velocity: U / (1 - M) along x, y, z (3, c) m/s; acceleration: the same times angular frequency.
    """

    turns_x: Array  # 1/m
    turns_y: Array  # 1/m
    frequency: Array  # 1/s
    phase: Array
    amplitude: Array  # a, m
    decay: Array  # k log2(e), 1/m
    mirror: Array  # M
    velocity: Array
    acceleration: Array


def harmonics(
    *,
    wavenumber: ArrayLike,
    omega: ArrayLike,
    direction: ArrayLike,
    phase: ArrayLike,
    amplitude: ArrayLike,
    speed: ArrayLike,
    depth: float,
) -> Harmonics:
    """Make harmonics of arrays (c,): 1/m, rad/s, rad, rad, m, and the speed U (m/s); depth: m, may be infinite.

    direction: where they go, from +x turning to +y. An Airy wave of amplitude a has U = a omega.
    """
    k, w, beta, phi, a, u = (
        np.ascontiguousarray(one, dtype=float)
        for one in np.broadcast_arrays(
            *map(np.atleast_1d, (wavenumber, omega, direction, phase, amplitude, speed))
        )
    )
    turn = 2.0 * np.pi
    scaled = u / -np.expm1(-2.0 * k * depth)
    velocity = scaled * np.array([np.cos(beta), np.sin(beta), np.ones_like(beta)])
    return Harmonics(
        k * np.cos(beta) / turn,
        k * np.sin(beta) / turn,
        w / turn,
        phi / turn,
        a,
        k * LOG2_E,
        np.exp(-2.0 * k * depth),
        velocity,
        w * velocity,
    )


@dataclass(frozen=True)
class Named:
    """What a sea is called and where it comes from.

    kind: the word of the case file; height: m, of a sea the significant one; period: s, of a sea at the peak of its
    spectrum; regular: whether all waves are alike; source: of its formulas.
    """

    kind: str
    height: float
    period: float
    regular: bool
    source: str


@dataclass(frozen=True, eq=False)
class Waves:
    """A sea. Airy, Stokes and irregular seas differ in their harmonics only.

    direction: mean direction in which the waves go, a horizontal unit vector (3,). depth: m, infinite in deep water.
    stretching: what holds up to the surface: "wheeler" takes the motion of depth (z - eta) h / (h + eta); "none" holds
    that of z = 0 above it; "formula" goes on with the formula. ramp: s, over which the waves grow from nothing.
    warnings: what is odd about them, sentences with the number and the limit. named: what they are, None when made of
    harmonics by hand.

    There is no water above the surface: points there have no motion. Points below the bed have that of the bed.
    """

    harmonics: Harmonics = field(repr=False)
    direction: tuple[float, float, float]
    depth: float = math.inf
    stretching: Stretching = "wheeler"
    ramp: float = 0.0
    warnings: tuple[str, ...] = ()
    named: Named | None = None

    def motion(self, points: Array, time: float) -> Motion:
        """Return the motion of the water at points (n, 3) m and a time (s).

        The acceleration is the derivative of the velocity at a fixed point, at a fixed stretched depth under Wheeler:
        that of the stretching itself is left out, as is usual. It is of the order of the wave's slope, and at the
        surface the convective term w du/dz, which is left out too, balances it.
        """
        # Here, because numba loads slowly, and reading a case needs none of it.
        from .kernel import motion_of

        points = np.ascontiguousarray(points, dtype=float)
        moved = Motion(np.empty_like(points), np.empty_like(points), np.empty(len(points)))
        surface = (
            self.depth,
            1.0 / self.depth,
            1.0 if self.stretching == "wheeler" else 0.0,
            math.inf if self.stretching == "formula" else 0.0,
        )
        out = (moved.velocity, moved.acceleration, moved.elevation)
        motion_of(points, self.harmonics, self._turns(time), surface, self._growth(time), *out)
        return moved

    def elevation(self, points: Array, time: float) -> Array:
        """Return the elevation (n,) m of the surface above z = 0 at the x and y of points (n, 3) m, and a time (s)."""
        from .kernel import elevation_of

        points = np.ascontiguousarray(points, dtype=float)
        elevation = np.empty(len(points))
        elevation_of(points, self.harmonics, self._turns(time), self._growth(time)[0], elevation)
        return elevation

    def _turns(self, time: float) -> Array:
        """Phases (c,) at x = y = 0 in turns, from 0 to 1."""
        return np.remainder(self.harmonics.phase - self.harmonics.frequency * time, 1.0)

    def _growth(self, time: float) -> tuple[float, float]:
        """Factor of the ramp, and its derivative in time (1/s)."""
        if self.ramp <= 0.0:
            return 1.0, 0.0
        x = min(max(time / self.ramp, 0.0), 1.0)
        return ramp(time, self.ramp), 30.0 * (
            x * (1.0 - x)
        ) ** 2 / self.ramp  # derivative of x^3 (10 - 15 x + 6 x^2)


def heading(direction: float) -> tuple[float, float, float]:
    """Return the unit vector of a direction (rad) from +x turning to +y."""
    return (math.cos(direction), math.sin(direction), 0.0)
