"""Rigging in the case file: ropes along the netting, floats and sinkers at its knots."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from ..netting.rigging import SPHERE_DRAG, Sphere
from .fields import Coefficient, Density, Force, Length, Mass, Name, whole
from .gear import Part

MOST_BODIES = 1_000_000


class RopeSpec(Part):
    """A rope along an edge of the netting, made fast at every knot."""

    kind: Literal["rope"] = Field(description="kind of gear", examples=["rope"])
    twine: Name = Field(description="name of a [twine.NAME] that the rope is made of", examples=["rope"])
    along: str = Field(
        description="edge that it follows, NAME.EDGE of gear that is netting: top, bottom, left or right",
        examples=["cage.bottom"],
    )
    length: Length | None = Field(
        default=None, description="m, unloaded, that of the edge by default", examples=["5.4 m"]
    )


class BodiesSpec(Part, ABC):
    """Bodies at knots, all alike, taken as spheres."""

    along: str | None = Field(
        default=None,
        description="edge that they hang on, NAME.EDGE of gear that is netting: top, bottom, left or right",
        examples=["cage.bottom"],
    )
    at: Annotated[tuple[str, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="instead of along: labels of the knots they hang at",
        examples=[["cage:0-0", "cage:8-0"]],
    )
    count: Annotated[int, *whole(1, MOST_BODIES)] | None = Field(
        default=None,
        description="how many along the edge, evenly; one at every knot by default",
        examples=[16],
    )
    spacing: Length | None = Field(
        default=None,
        description="m, instead of count: from one to the next along the edge as built",
        examples=["0.5 m"],
    )
    mass: Mass | None = Field(default=None, description="kg, of each one in air", examples=["250 g"])
    diameter: Length | None = Field(default=None, description="m, of each one, with mass", examples=["60 mm"])
    density: Density | None = Field(
        default=None, description="kg/m3, of each one, with its force in water", examples=[7850.0]
    )
    drag: Coefficient = Field(default=SPHERE_DRAG, description="C_D of each one, on pi d^2 / 4")

    @property
    @abstractmethod
    def force(self) -> float | None:
        """The force (N) with which each one acts in water, where it is given."""

    @abstractmethod
    def sphere(self, water: float, gravity: float) -> Sphere:
        """Return one of them; water: density of the water (kg/m3), gravity: m/s2."""

    def many(self, knots: int, length: float, *, closed: bool) -> int:
        """Return how many there are along an edge of so many knots and a length (m), as near to the spacing as can be.

        closed: the edge goes round; otherwise one is at either end.
        """
        if self.count is not None:
            return self.count
        if self.spacing is None:
            return knots
        return max(1, round(length / self.spacing)) + (not closed)

    def _given(self) -> Sphere | None:
        """Return one of them by its mass and diameter, None where these are not given."""
        if self.mass is None or self.diameter is None:
            return None
        return Sphere(self.mass, self.diameter)


class SinkersSpec(BodiesSpec):
    """Sinkers."""

    kind: Literal["sinkers"] = Field(description="kind of gear", examples=["sinkers"])
    weight: Force | None = Field(
        default=None, description="N, of each one in water; with density", examples=["5 N"]
    )

    @property
    def force(self) -> float | None:
        """Weight (N) of each one in water, where it is given."""
        return self.weight

    def sphere(self, water: float, gravity: float) -> Sphere:
        """Return one of them; water: density of the water (kg/m3), gravity: m/s2. ValueError where it floats."""
        made = self._given() or Sphere.of_weight(
            self.weight or 0.0, density=self.density or 0.0, water=water, gravity=gravity
        )
        return replace(made, drag=self.drag)


class FloatsSpec(BodiesSpec):
    """Floats."""

    kind: Literal["floats"] = Field(description="kind of gear", examples=["floats"])
    buoyancy: Force | None = Field(
        default=None, description="N, lift of each one under water; with density", examples=["5 N"]
    )

    @property
    def force(self) -> float | None:
        """Lift (N) of each one under water, where it is given."""
        return self.buoyancy

    def sphere(self, water: float, gravity: float) -> Sphere:
        """Return one of them; water: density of the water (kg/m3), gravity: m/s2. ValueError where it sinks."""
        made = self._given() or Sphere.of_buoyancy(
            self.buoyancy or 0.0, density=self.density or 0.0, water=water, gravity=gravity
        )
        return replace(made, drag=self.drag)
