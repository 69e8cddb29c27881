"""The current in the case file: one velocity, a profile by depth, or a file of measured or computed velocities."""

from __future__ import annotations

from itertools import pairwise
from math import cos, sin
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, PrivateAttr

from ..water import Current as Flow
from ..water import LayerCurrent, PowerCurrent, RampedCurrent, SeriesCurrent, TableCurrent, UniformCurrent
from .current_file import read_current
from .fields import Angle, Table, Time, Velocity
from .quantity import Quantity, wrong
from .units import LENGTH, SPEED, TIME

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

Depth = Annotated[float, Quantity(LENGTH, 0.0, 1e4)]
Swiftness = Annotated[float, Quantity(SPEED, 0.0, 100.0)]
Moment = Annotated[float, Quantity(TIME, -1e11, 1e11)]
# Components below this, over the speed, are the rounding of a right angle.
ROUNDING = 1e-15


def _rising(depths: tuple[float, ...]) -> tuple[float, ...]:
    if any(b <= a for a, b in pairwise(depths)):
        raise wrong("depths that rise from each to the next", "sort them from the surface down, each once")
    return depths


def heading(speed: float, direction: float) -> Vector:
    """Velocity (m/s) of water that goes at a speed (m/s) in a horizontal direction (rad from +x, turning to +y)."""
    x, y = (0.0 if abs(part) < ROUNDING else part for part in (cos(direction), sin(direction)))
    return speed * x, speed * y, 0.0


class PowerProfile(Table):
    """U(z) = U_surface ((depth + z) / depth)^exponent."""

    kind: Literal["power"] = Field(description="kind of profile", examples=["power"])
    exponent: Annotated[float, Quantity(None, 0.0, 10.0)] = Field(
        description="of the height above the sea bed, which is the depth of [water]", examples=[0.143]
    )

    def current(self, surface: Vector, depth: float) -> Flow:
        """Return the current; surface: m/s at z = 0; depth: m, of the sea bed."""
        return PowerCurrent(surface, depth, self.exponent)

    @property
    def described(self) -> str:
        """What it is, in words."""
        return f"power law of exponent {self.exponent:g} down to the sea bed"


class DepthTable(Table):
    """Velocities at depths, as vectors or as speed and direction."""

    depth: Annotated[tuple[Depth, ...], Field(min_length=1), AfterValidator(_rising)] = Field(
        description="m below still water, rising", examples=[[0.0, 5.0, 10.0]]
    )
    velocity: tuple[Velocity, ...] | None = Field(
        default=None,
        description="m/s, three components for every depth",
        examples=[[[0.5, 0.0, 0.0], [0.4, 0.1, 0.0], [0.2, 0.1, 0.0]]],
    )
    speed: tuple[Swiftness, ...] | None = Field(
        default=None, description="m/s, one for every depth, with direction", examples=[[0.5, 0.4, 0.2]]
    )
    direction: tuple[Angle, ...] | None = Field(
        default=None,
        description="in which the water goes, one for every depth, from +x turning to +y",
        examples=[["0 deg", "15 deg", "30 deg"]],
    )

    @property
    def vectors(self) -> Array:
        """Velocity at every depth, (k, 3) m/s."""
        if self.velocity is not None:
            return np.array(self.velocity)
        pairs = zip(self.speed or (), self.direction or (), strict=True)
        return np.array([heading(speed, direction) for speed, direction in pairs])


class LayerProfile(DepthTable):
    """A velocity from each depth down to the next."""

    kind: Literal["layers"] = Field(description="kind of profile", examples=["layers"])

    def current(self, surface: Vector, depth: float) -> Flow:
        """Return the current; what is given at the surface and to the bed plays no part."""
        return LayerCurrent(np.array(self.depth), self.vectors)

    @property
    def described(self) -> str:
        """What it is, in words."""
        return f"{len(self.depth)} layers, the lowest from {self.depth[-1]:g} m down"


class TableProfile(DepthTable):
    """Velocities that are straight between depths."""

    kind: Literal["table"] = Field(description="kind of profile", examples=["table"])

    def current(self, surface: Vector, depth: float) -> Flow:
        """Return the current; what is given at the surface and to the bed plays no part."""
        return TableCurrent(np.array(self.depth), self.vectors)

    @property
    def described(self) -> str:
        """What it is, in words."""
        return f"table of {len(self.depth)} depths down to {self.depth[-1]:g} m"


Profile = Annotated[PowerProfile | LayerProfile | TableProfile, Field(discriminator="kind")]


class Current(Table):
    """The undisturbed current. A Case makes it ready; flow() is what the forces ask."""

    velocity: Velocity | None = Field(
        default=None,
        description="m/s, three components, of the whole water or at the surface of a power law",
        examples=[[0.5, 0.0, 0.0]],
    )
    speed: Swiftness | None = Field(
        default=None, description="m/s, with direction instead of velocity", examples=[0.5]
    )
    direction: Angle | None = Field(
        default=None,
        description="in which the water goes, level, from +x turning to +y",
        examples=["15 deg"],
    )
    profile: Profile | None = Field(default=None, description="by depth: power, layers or table")
    file: str | None = Field(
        default=None,
        description="CSV file, beside the case file: columns time,u,v,w or time,depth,u,v,w (s, m, m/s), or netCDF; "
        "instead of velocity",
        examples=["current.csv"],
    )
    ramp: Time | None = Field(
        default=None, description="s, smooth start from rest, of dynamic cases", examples=["10 s"]
    )
    at: Moment | None = Field(
        default=None,
        description="s, time of the file at which the run begins, or which a static case takes; its first by default",
        examples=["3 h"],
    )
    _path: Path | None = PrivateAttr(default=None)
    _depth: float | None = PrivateAttr(default=None)
    _static: bool = PrivateAttr(default=True)

    def settle(self, folder: Path, depth: float | None, *, static: bool) -> None:
        """Take over, once, what others know; folder: where file names count from; depth: m, of the sea bed."""
        self._path = None if self.file is None else folder / self.file
        self._depth, self._static = depth, static

    def flow(self) -> Flow:
        """Return the current of a run that begins at time 0; a static case has it at full strength.

        CaseError where its file cannot be used.
        """
        full = self._full()
        return full if self.ramp is None or self._static else RampedCurrent(full, self.ramp)

    @property
    def is_one_velocity(self) -> bool:
        """Whether the velocity is the same in all places and, after the ramp, at all times."""
        return self.profile is None and self.file is None

    @property
    def at_surface(self) -> Vector:
        """Velocity (m/s) at z = 0 where the run begins, without its ramp; CaseError where its file cannot be used."""
        velocity = self._full().velocity(np.zeros((1, 3)), 0.0)[0]
        return float(velocity[0]), float(velocity[1]), float(velocity[2])

    @property
    def lowest(self) -> float | None:
        """Last depth (m) of a table or of the file, below which its velocity is held; None without one."""
        if self._path is not None:
            depths = read_current(self._path, self._depth).depths
            return float(depths[-1]) if len(depths) > 1 else None
        return self.profile.depth[-1] if isinstance(self.profile, TableProfile) else None

    @property
    def described(self) -> str:
        """What there is beside one velocity; "" for a uniform, steady current."""
        parts = []
        if self.profile is not None:
            parts.append(f"at the surface, {self.profile.described}")
        if self._path is not None:
            parts.append(_words_of(read_current(self._path, self._depth), self._path.name, self.at))
        if self.ramp is not None and not self._static:
            parts.append(f"after a ramp of {self.ramp:g} s")
        return ", ".join(parts)

    def _full(self) -> Flow:
        if self._path is not None:
            series = read_current(self._path, self._depth)
            start = series.times[0] if self.at is None else self.at
            return SeriesCurrent(series.times - start, series.depths, series.velocities)
        surface = self.velocity or heading(self.speed or 0.0, self.direction or 0.0)
        if self.profile is None:
            return UniformCurrent(surface)
        return self.profile.current(surface, self._depth or 0.0)


def _words_of(series: SeriesCurrent, name: str, at: float | None) -> str:
    """Say what a file holds and which time of it is meant."""
    first, last = series.times[[0, -1]]
    start = f"at the surface at {first if at is None else at:g} s of {name}"
    span = f"{len(series.times)} times from {first:g} to {last:g} s" if len(series.times) > 1 else "one time"
    depths = f", {len(series.depths)} depths to {series.depths[-1]:g} m" if len(series.depths) > 1 else ""
    return f"{start}: {span}{depths}"
