"""Twine in the case file: material, thickness and elastic law."""

from __future__ import annotations

from itertools import pairwise
from math import hypot, pi
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, PrivateAttr

from ..netting.elastic import ElasticLaw, LinearLaw, PowerLaw, QuadraticLaw, TableLaw
from ..netting.twine import LEAD, MATERIALS, PACKING, Material, Twine, diameter_of
from .fields import Density, Force, Length, Modulus, Share, Table, Title
from .quantity import Quantity, wrong
from .units import FORCE, LINEAR_DENSITY, RATIO, TIME


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


class QuadraticSpec(Table):
    """T = c1 strain + c2 strain^2."""

    kind: Literal["quadratic"] = Field(description="kind of elastic law", examples=["quadratic"])
    c1: Force = Field(description="N, of the twine itself, whatever its diameter", examples=["1160 N"])
    c2: Annotated[float, Quantity(FORCE, 0.0, 1e9)] = Field(
        description="N, of the twine itself, whatever its diameter", examples=["37.3 kN"]
    )

    def elastic(self) -> ElasticLaw:
        """Return the law of the netting."""
        return QuadraticLaw(self.c1, self.c2)


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


ElasticSpec = Annotated[LinearSpec | PowerSpec | QuadraticSpec | TableSpec, Field(discriminator="kind")]


class MaterialSpec(Table):
    """A material of the user's own."""

    density: Density = Field(description="kg/m3", examples=[1140.0])
    youngs_modulus: Modulus | None = Field(default=None, description="Pa", examples=["1.0 GPa"])
    loss_factor: Annotated[float, Quantity(None, 0.0, 10.0)] | None = Field(
        default=None,
        description="tan delta, from which twine damping comes; none by default",
        examples=[0.02],
    )
    source: Title = Field(default="", description="one line: where the figures come from")

    def material(self, name: str) -> Material:
        """Return the material of the netting under this name."""
        source = self.source or "as the case gives it"
        return Material(name, self.density, self.youngs_modulus, source, self.loss_factor, source)


class TwineSpec(Table):
    """One twine. The material gives density and modulus where they are left out, rtex the diameter."""

    material: str | None = Field(
        default=None,
        description=f"fibre: {', '.join(MATERIALS)}, or the name of a [material.NAME]",
        examples=["PA"],
    )
    density: Density | None = Field(
        default=None, description="kg/m3, of the fibre; the material's by default", examples=[1140.0]
    )
    given_diameter: Length | None = Field(
        default=None,
        alias="diameter",
        description="m, of the outline; from rtex by default",
        examples=["1.5 mm"],
    )
    rtex: Annotated[float, Quantity(LINEAR_DENSITY, 0.0, 100.0, open_below=True, unit_needed=True)] | None = (
        Field(
            default=None,
            description="mass per length; by default that of fibre all through the cross-section",
            examples=["2000 tex"],
        )
    )
    lead: Annotated[float, Quantity(LINEAR_DENSITY, 0.0, 100.0, open_below=True, unit_needed=True)] | None = (
        Field(
            default=None,
            description="mass of lead per length in a lead line, beside its fibre",
            examples=["150 g/m"],
        )
    )
    packing: Share | None = Field(
        default=None,
        description=f"share of the cross-section that is fibre, {PACKING:g} by default; with rtex alone",
        examples=[PACKING],
    )
    youngs_modulus: Modulus | None = Field(
        default=None, description="Pa, of the linear law; the material's by default", examples=["1.0 GPa"]
    )
    law: ElasticSpec | None = Field(
        default=None, description="elastic law instead of youngs_modulus: linear, power, quadratic or table"
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
    _material: Material | None = PrivateAttr(default=None)

    def settle(self, materials: dict[str, Material]) -> None:
        """Take up the material, once, when the whole case is known."""
        self._material = materials.get(self.material or "")

    @property
    def resolved_diameter(self) -> float | None:
        """Diameter as given or from rtex (m); None where it cannot be told."""
        density = self.resolved_density
        if self.given_diameter is not None or self.rtex is None or density is None:
            return self.given_diameter
        fibre = diameter_of(self.rtex, density, self.packing or PACKING)
        return float(hypot(fibre, diameter_of(self.lead, LEAD, 1.0))) if self.lead else fibre

    @property
    def diameter(self) -> float:
        """Diameter as given or from rtex (m); only of a checked case."""
        diameter = self.resolved_diameter
        if diameter is None:
            raise ValueError("a twine has neither diameter nor rtex with a density")
        return diameter

    @property
    def resolved_density(self) -> float | None:
        """Density as given or of the material (kg/m3); None where neither says it."""
        if self.density is not None:
            return self.density
        return self._material.density if self._material else None

    @property
    def fibre_per_length(self) -> float:
        """Mass of fibre per length (kg/m): as given, or all the room that the lead leaves."""
        if self.rtex is not None:
            return self.rtex
        return (self.resolved_density or 0.0) * (pi / 4.0 * self.diameter**2 - (self.lead or 0.0) / LEAD)

    @property
    def mean_density(self) -> float | None:
        """Density of fibre and lead together (kg/m3); None where the fibre's is not known."""
        density = self.resolved_density
        if density is None or not self.lead:
            return density
        fibre = self.fibre_per_length
        return (fibre + self.lead) / (fibre / density + self.lead / LEAD)

    @property
    def resolved_law(self) -> ElasticLaw | None:
        """Elastic law as given or of the material; None where neither says it."""
        if self.law is not None:
            return self.law.elastic()
        modulus = self.youngs_modulus
        if modulus is None and self._material:
            modulus = self._material.youngs_modulus
        return None if modulus is None else LinearLaw(modulus)

    @property
    def resolved_loss_factor(self) -> float:
        """Loss factor of the material where no damping_time is given; 0 where the material has none."""
        if self.damping_time is not None or self._material is None:
            return 0.0
        return self._material.loss_factor or 0.0

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
        density, law = self.mean_density, self.resolved_law
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
            linear_density=self.fibre_per_length + self.lead if self.lead else self.rtex,
        )
