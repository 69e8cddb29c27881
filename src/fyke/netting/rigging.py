"""Rigging: ropes along the netting, and floats and sinkers at its knots."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .net import Bodies, Net, Rope
from .twine import Twine

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Drag coefficient of a float or sinker taken as a sphere, on pi d^2 / 4: the plateau below the drag crisis, see the
# standard curve that Clift, Grace and Weber 1978 fit.
SPHERE_DRAG = 0.47
ROUNDING = 1e-9  # of places along an edge, over the distance of knots


def with_rope(
    net: Net,
    knots: ArrayLike,
    twine: Twine,
    *,
    length: float | None = None,
    name: str,
    kind: str = "rope",
) -> Net:
    """Return the net with a rope or a tube through some of its knots, one bar from each to the next.

    knots: (k,) of the net, in order, the last may be the first; twine: what the rope is made of; length: unloaded, m,
    shared among its bars as they are long; that of the net as built when None; kind: as of Rope. ValueError for fewer
    than two knots and a rope without length.
    """
    path = np.asarray(knots, dtype=np.int64)
    ends = np.column_stack([path[:-1], path[1:]])
    apart = np.linalg.norm(net.positions[ends[:, 1]] - net.positions[ends[:, 0]], axis=1)
    whole = float(apart.sum())
    if not len(ends) or not whole > 0.0:
        raise ValueError(f"{kind} '{name}' needs two knots or more that lie apart")
    if not apart.all():
        raise ValueError(f"{kind} '{name}' passes the same place twice in a row")
    twines = list(dict.fromkeys((*net.twines, twine)))
    m = net.bar_count
    return replace(
        net,
        bars=np.concatenate([net.bars, ends]),
        rest_length=np.concatenate([net.rest_length, apart * (1.0 if length is None else length / whole)]),
        twines=tuple(twines),
        twine_of_bar=np.concatenate([net.twine_of_bar, np.full(len(ends), twines.index(twine))]),
        ropes=(*net.ropes, Rope(name, path, np.arange(m, m + len(ends)), kind)),
    )


def with_bodies(net: Net, bodies: Bodies) -> Net:
    """Return the net with floats or sinkers at some of its knots."""
    return replace(net, bodies=(*net.bodies, bodies))


def evenly(knots: Indices, count: int, *, closed: bool, real: int | None = None) -> Indices:
    """Choose so many of the knots along an edge, evenly spread; closed: the last knot is the first.

    real: how many knots the edge of the real netting has, where it is grouped: each place there is that of the nearest
    knot here, which may be chosen several times. ValueError for more places than there are.
    """
    there = knots[:-1] if closed else knots
    number = len(there) if real is None else real
    if not 1 <= count <= number:
        raise ValueError(f"{count} places along an edge of {number} knots")
    step = number / count if closed else (number - 1) / max(count - 1, 1)
    places = np.floor(np.arange(count) * step + 0.5).astype(np.int64)
    if number == len(there):
        return np.asarray(there[places % number] if closed else there[places])
    return np.asarray(there[_nearest(places, number, len(there), closed=closed)])


def _nearest(places: Indices, number: int, few: int, *, closed: bool) -> Indices:
    """Which of a few knots along an edge are nearest to places among a number of them; mirrored ones stay so."""
    if closed:
        away = (places % number) * (few / number)
        away = np.where(away > 0.5 * few, away - few, away)
        middle = 0.0
    else:
        middle = 0.5 * (few - 1)
        away = places * ((few - 1) / (number - 1)) - middle
    # Knots lie at whole distances from the middle of the edge, or at halves. Of two as near, the one further out.
    half = middle % 1.0
    steps = np.floor(np.abs(away) - half + 0.5 + ROUNDING) + half
    return np.asarray(np.rint(np.where(away < 0.0, -steps, steps) + middle).astype(np.int64) % few)


@dataclass(frozen=True)
class Sphere:
    """A float or sinker: mass kg; diameter m; drag: C_D on pi d^2 / 4."""

    mass: float
    diameter: float
    drag: float = SPHERE_DRAG

    @classmethod
    def of_weight(cls, weight: float, *, density: float, water: float, gravity: float = 9.81) -> Sphere:
        """Make a sinker of a weight in water (N) from its density (kg/m3), water: that of the water.

        ValueError where such a body would not sink.
        """
        if not (density > water and weight > 0.0):
            raise ValueError(
                f"a body of {density:g} kg/m3 has no weight of {weight:g} N in water of {water:g} kg/m3"
            )
        volume = weight / (gravity * (density - water))
        return cls(density * volume, _diameter(volume))

    @classmethod
    def of_buoyancy(cls, buoyancy: float, *, density: float, water: float, gravity: float = 9.81) -> Sphere:
        """Make a float of a net buoyancy (N) when submerged from its density (kg/m3), water: that of the water.

        ValueError where such a body would not float.
        """
        if not (0.0 <= density < water and buoyancy > 0.0):
            raise ValueError(
                f"a body of {density:g} kg/m3 does not lift {buoyancy:g} N in water of {water:g} kg/m3"
            )
        volume = buoyancy / (gravity * (water - density))
        return cls(density * volume, _diameter(volume))

    def at(self, knots: ArrayLike, *, name: str, kind: str) -> Bodies:
        """Put one of it at each of some knots."""
        volume = np.pi / 6.0 * self.diameter**3
        area = self.drag * np.pi / 4.0 * self.diameter**2
        return Bodies(name, kind, np.asarray(knots, dtype=np.int64), self.mass, volume, area, self.diameter)


def _diameter(volume: float) -> float:
    return float(np.cbrt(6.0 * volume / np.pi))
