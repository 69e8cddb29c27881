"""Tubes in the case file, and the rings and collars that are made of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from ..netting.tubes import TUBE_MATERIALS, Tube, TubeMaterial
from ..netting.twine import Material
from .fields import Density, Length, Modulus, Name, Point, Switch, Table, whole
from .gear import Part
from .quantity import Quantity
from .units import LINEAR_DENSITY

MOST_TUBES = 20  # side by side
LEAST_ROUND, MOST_ROUND = 3, 10_000  # knots of a ring


class TubeSpec(Table):
    """One tube. The material gives density, modulus and yield stress where they are left out."""

    material: str | None = Field(
        default=None,
        description=f"{', '.join(TUBE_MATERIALS)}, or the name of a [material.NAME]",
        examples=["HDPE"],
    )
    diameter: Length = Field(description="m, outer", examples=["315 mm"])
    wall: Length = Field(description="m, thickness of the wall", examples=["17.9 mm"])
    density: Density | None = Field(
        default=None, description="kg/m3, of the wall; the material's by default", examples=[958.0]
    )
    youngs_modulus: Modulus | None = Field(
        default=None, description="Pa; the material's by default", examples=["900 MPa"]
    )
    contents: Literal["air", "water"] = Field(default="air", description="what it is filled with")
    mass_per_length: Annotated[float, Quantity(LINEAR_DENSITY, 0.0, 1e5, open_below=True)] | None = Field(
        default=None,
        description="kg/m, with what is fitted to it and without water in it; that of the wall by default",
        examples=["18 kg/m"],
    )
    yield_stress: Modulus | None = Field(
        default=None,
        description="Pa, which the largest stress is compared with; the material's by default",
        examples=["26 MPa"],
    )

    def made_of(self, own: dict[str, Material]) -> TubeMaterial | None:
        """Return the material, looked up first in those of the file; None where there is none of this name."""
        name = self.material or ""
        if name in own and own[name].youngs_modulus is not None:
            m = own[name]
            return TubeMaterial(name, m.density, m.youngs_modulus or 0.0, None, m.source)
        return TUBE_MATERIALS.get(name)

    def tube(self, own: dict[str, Material]) -> Tube:
        """Return the tube of the netting, own: materials of the file; only of a checked case."""
        m = self.made_of(own)
        density = self.density or (m.density if m else None)
        modulus = self.youngs_modulus or (m.youngs_modulus if m else None)
        if density is None or modulus is None:
            raise ValueError("a tube has no density or no modulus")
        return Tube(
            self.diameter,
            self.wall,
            density,
            modulus,
            self.contents,
            self.mass_per_length,
            self.yield_stress or (m.yield_stress if m else None),
            material=self.material or "",
        )


class TubularSpec(Part):
    """A part that is made of tubes."""

    tube: Name = Field(description="name of a [tube.NAME] that it is made of", examples=["pipe"])
    tubes: Annotated[int, *whole(1, MOST_TUBES)] = Field(
        default=1, description="how many of them side by side", examples=[2]
    )
    rigid: Switch = Field(default=False, description="true: of so stiff a tube that it keeps its shape")
    along: str | None = None

    @property
    def free(self) -> bool:
        """Whether it has knots of its own and follows no edge."""
        return False

    def made(self, tubes: dict[str, Tube]) -> Tube:
        """Return its tube, of those of the case."""
        return replace(tubes[self.tube], rigid=self.rigid)


class RingSpec(TubularSpec):
    """A ring of tubes along an edge of the netting, such as a sinker tube, or one of its own."""

    kind: Literal["ring"] = Field(description="kind of gear", examples=["ring"])
    along: str | None = Field(
        default=None,
        description="edge that it follows, made fast at every knot, NAME.EDGE of gear that is netting",
        examples=["cage.bottom"],
    )
    diameter: Length | None = Field(
        default=None,
        description="m, of a ring of its own, through its knots, instead of along",
        examples=["25 m"],
    )
    centre: Point | None = Field(
        default=None,
        description="m, of a ring of its own, z up from still water",
        examples=[[0.0, 0.0, -15.0]],
    )
    knots: Annotated[int, *whole(LEAST_ROUND, MOST_ROUND)] | None = Field(
        default=None, description="of a ring of its own", examples=[48]
    )

    @property
    def free(self) -> bool:
        """Whether it has knots of its own and follows no edge."""
        return self.along is None


class CollarSpec(TubularSpec):
    """A floating collar along an edge of the netting, which it sets free."""

    kind: Literal["collar"] = Field(description="kind of gear", examples=["collar"])
    along: str = Field(
        description="edge that it follows, made fast at every knot; these are no longer held",
        examples=["cage.top"],
    )
