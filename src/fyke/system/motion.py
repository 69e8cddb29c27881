"""Prescribed motion: held knots that are moved, as by a towing carriage, a shaker or a ship.

Every move turns its knots about a point and shifts them. Moves of the same knots add up: all turns first, in their
order, each about its point as built, then all shifts. With r the way from the point, w the angular velocity and e its
change, one turn R makes of place, velocity and acceleration relative to the point
    r' = R r,  v' = R v + w x r',  a' = R a + e x r' + w x (w x r') + 2 w x R v
(rigid body kinematics, any textbook of mechanics).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..netting.net import Net
from .courses import Course, Steady, of_vector

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Turn:
    """A rotation about an axis (3,), right-handed, through a point (3,) m as built; angle: its course (rad).

    Several in a row turn one after the other: roll, pitch and yaw about x, y and z is the order of a ship.
    """

    axis: ArrayLike
    point: ArrayLike
    angle: Course

    def __post_init__(self) -> None:
        axis = of_vector(self.axis)
        length = float(np.linalg.norm(axis))
        if length == 0.0:
            raise ValueError("the axis of a Turn must not be zero")
        object.__setattr__(self, "axis", axis / length)
        object.__setattr__(self, "point", of_vector(self.point))

    def turned(self, x: Array, v: Array, a: Array, time: float) -> tuple[Array, Array, Array]:
        """Turn places x, velocities v and accelerations a, (k, 3) m, m/s and m/s2, all knots alike."""
        axis, point = np.asarray(self.axis), np.asarray(self.point)
        angle, rate, change = self.angle.at(time)[:, 0]
        cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
        # O. Rodrigues's formula; transposed, for rows.
        rotation = (np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross).T
        r, v, a = (x - point) @ rotation, v @ rotation, a @ rotation
        a = a + change * r @ cross.T + rate**2 * r @ (cross @ cross).T + 2.0 * rate * v @ cross.T
        return point + r, v + rate * r @ cross.T, a


@dataclass(frozen=True, eq=False)
class Move:
    """What happens to some knots (k,): turns, then shifts, whose courses have three components (m)."""

    knots: Indices
    shifts: tuple[Course, ...] = ()
    turns: tuple[Turn, ...] = ()

    @property
    def courses(self) -> tuple[Course, ...]:
        """All its parts."""
        return (*self.shifts, *(turn.angle for turn in self.turns))


@dataclass(frozen=True, eq=False)
class Motion:
    """The moves of the held knots of a net.

    knots: (k,) those that are moved, rising; built: (k, 3) m, where they were built; tow: (3,) m/s, the mean of their
    steady velocities. Raises ValueError for knots that are free.
    """

    net: Net = field(repr=False)
    moves: Sequence[Move]
    knots: Indices = field(init=False)
    built: Array = field(init=False)
    _rows: tuple[Indices, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        moves = tuple(self.moves)
        none = np.zeros(0, dtype=np.int64)
        knots = np.unique(np.concatenate([none, *(np.asarray(one.knots, dtype=np.int64) for one in moves)]))
        free = knots[~self.net.fixed[knots]]
        if free.size:
            raise ValueError(
                f"knot {self.net.labels[free[0]]} is free: only held knots can be moved as one likes"
            )
        object.__setattr__(self, "moves", moves)
        object.__setattr__(self, "knots", knots)
        object.__setattr__(self, "built", self.net.positions[knots])
        object.__setattr__(self, "_rows", tuple(np.searchsorted(knots, one.knots) for one in moves))

    def at(self, time: float) -> tuple[Array, Array, Array]:
        """Place, velocity and acceleration of the moved knots at a time (s), (k, 3) m, m/s, m/s2."""
        x, v, a = self.built.copy(), np.zeros_like(self.built), np.zeros_like(self.built)
        for move, rows in zip(self.moves, self._rows, strict=True):
            for turn in move.turns:
                x[rows], v[rows], a[rows] = turn.turned(x[rows], v[rows], a[rows], time)
        for move, rows in zip(self.moves, self._rows, strict=True):
            for shift in move.shifts:
                dx, dv, da = shift.at(time)
                x[rows] += dx
                v[rows] += dv
                a[rows] += da
        return x, v, a

    def carry(self, x: Array, v: Array, time: float) -> None:
        """Put the moved knots of positions x and velocities v, (n, 3) m and m/s, where they are at a time (s)."""
        x[self.knots], v[self.knots], _ = self.at(time)

    def acceleration(self, time: float) -> Array:
        """Acceleration of all knots that are moved, (n, 3) m/s2, zero of others."""
        out = np.zeros((self.net.knot_count, 3))
        out[self.knots] = self.at(time)[2]
        return out

    def longest_step(self, time: float) -> float:
        """Longest step (s) from a time that does not miss any of it."""
        return min((course.longest_step(time) for course in self._courses), default=np.inf)

    @property
    def steady_from(self) -> float:
        """Time (s) from which every knot goes at its constant velocity; infinite where none does."""
        if any(move.turns for move in self.moves):
            return np.inf
        return max((course.steady_from for course in self._courses), default=0.0)

    @property
    def tows(self) -> bool:
        """Whether something goes on and on at a steady velocity."""
        return any(isinstance(one, Steady) and one.rate.any() for move in self.moves for one in move.shifts)

    @property
    def tow(self) -> Array:
        """Steady velocity at which the knots are towed, (3,) m/s, the mean over those that are moved."""
        total = np.zeros(3)
        for move in self.moves:
            for shift in move.shifts:
                if isinstance(shift, Steady):
                    total += len(move.knots) * shift.rate
        return total / max(len(self.knots), 1)

    @property
    def _courses(self) -> tuple[Course, ...]:
        return tuple(course for move in self.moves for course in move.courses)
