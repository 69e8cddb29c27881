"""Twine in the case file: material, diameter and elastic law."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from ..netting.elastic import ElasticLaw, LinearLaw, PowerLaw, TableLaw
from ..netting.twine import MATERIALS, Twine
from .fields import Density, Force, Length, Modulus, Table
from .quantity import Quantity, wrong
from .units import FORCE, RATIO, TIME


class LinearSpec(Table):
    """T = E A strain."""

    kind: Literal["linear"] = Field(description="kind of elastic law", examples=["linear"])
    youngs_modulus: Modulus = Field(description="Pa", examples=["1.0 GPa"])

    def elastic(self) -> ElasticLaw:
        """Return the law of the netting."""
        return LinearLaw(self.youngs_modulus)


class PowerSpec(Table):
    """T = d^2 c1 strain^c2."""

    kind: Literal["power"] = Field(description="kind of elastic law", examples=["power"])
    c1: Modulus = Field(description="Pa", examples=["345.37 MPa"])
    c2: Annotated[float, Quantity(None, 1.0, 10.0)] = Field(description="exponent", examples=[1.0121])

    def elastic(self) -> ElasticLaw:
        """Return the law of the netting."""
        return PowerLaw(self.c1, self.c2)


def _rising(values: tuple[float, ...]) -> tuple[float, ...]:
    if values[0] != 0.0 or any(b <= a for a, b in pairwise(values)):
        raise wrong(
            "values that start at 0 and rise from each to the next", "start with 0.0 and sort the points"
        )
    return values


class TableSpec(Table):
    """Tension measured at some strains, straight between and beyond them."""

    kind: Literal["table"] = Field(description="kind of elastic law", examples=["table"])
    strain: Annotated[
        tuple[Annotated[float, Quantity(RATIO, 0.0, 10.0)], ...], Field(min_length=2), AfterValidator(_rising)
    ] = Field(description="strain, rising from 0", examples=[[0.0, 0.05, 0.1]])
    tension: Annotated[
        tuple[Annotated[float, Quantity(FORCE, 0.0, 1e9)], ...], Field(min_length=2), AfterValidator(_rising)
    ] = Field(description="N, rising from 0, one for every strain", examples=[[0.0, 20.0, 60.0]])

    def elastic(self) -> ElasticLaw:
        """Return the law of the netting."""
        return TableLaw(self.strain, self.tension)


ElasticSpec = Annotated[LinearSpec | PowerSpec | TableSpec, Field(discriminator="kind")]
MaterialName = Literal["PA", "PES", "PP", "PE", "UHMWPE"]


class TwineSpec(Table):
    """One twine. The material gives density and modulus where they are left out."""

    material: MaterialName | None = Field(default=None, description="fibre", examples=["PA"])
    density: Density | None = Field(
        default=None, description="kg/m3, the material's by default", examples=[1140.0]
    )
    diameter: Length = Field(description="m", examples=["1.5 mm"])
    youngs_modulus: Modulus | None = Field(
        default=None, description="Pa, of the linear law; the material's by default", examples=["1.0 GPa"]
    )
    law: ElasticSpec | None = Field(
        default=None, description="elastic law instead of youngs_modulus: linear, power or table"
    )
    damping_time: Annotated[float, Quantity(TIME, 0.0, 1e7)] | None = Field(
        default=None,
        description="s, retardation time of Kelvin-Voigt damping; 0 for none, "
        "from the material's loss factor by default",
        examples=["20 us"],
    )
    breaking_strength: Force | None = Field(
        default=None, description="N, of one twine or rope, wet and knotted as it is used", examples=["250 N"]
    )

    @property
    def resolved_density(self) -> float | None:
        """Density as given or of the material (kg/m3); None where neither says it."""
        if self.density is not None:
            return self.density
        return MATERIALS[self.material].density if self.material else None

    @property
    def resolved_law(self) -> ElasticLaw | None:
        """Elastic law as given or of the material; None where neither says it."""
        if self.law is not None:
            return self.law.elastic()
        modulus = self.youngs_modulus
        if modulus is None and self.material:
            modulus = MATERIALS[self.material].youngs_modulus
        return None if modulus is None else LinearLaw(modulus)

    @property
    def resolved_loss_factor(self) -> float:
        """Loss factor of the material where no damping_time is given; 0 where the material has none."""
        if self.damping_time is not None or self.material is None:
            return 0.0
        return MATERIALS[self.material].loss_factor or 0.0

    @property
    def damping_source(self) -> str:
        """Where the damping comes from, in words."""
        if self.damping_time is not None:
            return "as given"
        if self.material is None:
            return "none given"
        factor = self.resolved_loss_factor
        return (
            f"loss factor {factor:g} of {self.material}"
            if factor
            else f"no loss factor of {self.material} found"
        )

    @property
    def takes_from_material(self) -> bool:
        """Whether density or modulus is the material's."""
        return self.density is None or (self.youngs_modulus is None and self.law is None)

    def twine(self, name: str) -> Twine:
        """Return the twine of the netting under this name; only of a checked case."""
        density, law = self.resolved_density, self.resolved_law
        if density is None or law is None:
            raise ValueError(f"twine '{name}' has no density or no elastic law")
        return Twine(
            name,
            density,
            self.diameter,
            law,
            damping_time=self.damping_time or 0.0,
            material=self.material or "",
            loss_factor=self.resolved_loss_factor,
            breaking_strength=self.breaking_strength,
        )
