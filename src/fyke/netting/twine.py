"""Twine and its materials.

A twine is fibre and pores. Its diameter is that of its outline: drag, added mass and elastic laws that count by area
go by it. In water the pores are full: the water in them moves with the twine and weighs nothing there, so that its
weight in water is that of the fibre alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .elastic import ElasticLaw

KSI = 6.894757e6  # Pa, 1000 pounds of force per square inch
# Share of a twine's cross-section that is fibre: the middle of 0.6 to 0.7, remembered from netting books, none opened.
PACKING = 0.65
LEAD = 11340.0  # kg/m3, density of lead: textbook value


@dataclass(frozen=True)
class Material:
    """A fibre: density (kg/m3), modulus (Pa), loss factor tan delta, and where they were read; None: no source."""

    name: str
    density: float
    youngs_modulus: float | None
    source: str
    loss_factor: float | None = None
    loss_source: str = "no loss factor found of this fibre as twine, at the frequencies at which bars ring"


# Moduli of rope-laid fibre follow from E = (EA/MBL)(MBL/d^2) 4/pi with the rope properties listed by MoorPy
# (MoorProps_default.yaml): PA 5 x 207e6, PES 14 x 308e6, UHMWPE 56 x 580e6 Pa. Published moduli of netting
# spread from 40 MPa to 2 GPa, so a study should give its own.
_ROPE = "MoorPy MoorProps_default.yaml: density, quasi-static EA/MBL and MBL/d^2"
# Measured where bars ring, at hundreds of hertz and more; slow swings lose more, and so should wet and twisted fibres:
# a lower bound.
_STRINGS = (
    "loss factor 0.020 to 0.024 of bending in plucked nylon strings, dry: Woodhouse, Plucked guitar "
    "transients, Acta Acustica united with Acustica 90, 945-965, 2004, as a public code repeats it; paper not opened"
)
MATERIALS: dict[str, Material] = {
    m.name: m
    for m in (
        Material("PA", 1140.0, 5 * 207e6 * 4 / np.pi, _ROPE, 0.02, _STRINGS),
        Material("PES", 1380.0, 14 * 308e6 * 4 / np.pi, _ROPE),
        Material("UHMWPE", 975.0, 56 * 580e6 * 4 / np.pi, _ROPE),
        Material(
            "PE",
            950.0,
            345.37e6 * 4 / np.pi,
            "density: textbook value; modulus 4 C1/pi of T = d^2 C1 strain^C2 with C1 = 345.37 MPa, C2 = 1.0121 "
            "(Wilson 1967, as used by Bi et al. 2014)",
        ),
        Material(
            "CuZn",
            8410.0,
            15000 * KSI,
            "naval brass C46400 (60 % Cu, 39.2 % Zn, 0.8 % Sn), data of the Copper Development Association as dealers "
            "repeat them: 8.41 g/cm3, 15000 ksi in tension; textbook values of the metal, woven wire yields more",
        ),
        Material("PP", 910.0, None, "density: Korean fibre table, JAKO200415875836662; no modulus read"),
    )
}


@dataclass(frozen=True)
class Twine:
    """A twine as the bars of the netting need it.

    density: of the fibre (kg/m3); diameter: of the outline, m; damping_time: retardation time of the Kelvin-Voigt
    damping (s), tension = T(strain) + damping_time dT/dt, zero by default and never letting a bar push; loss_factor:
    tan delta, which adds to the retardation time of each bar as much as makes this loss at the bar's ringing, see
    system.build.ringing; linear_density: mass per length (kg/m), Rtex in SI, where the twine is known to be porous;
    None: fibre all through the cross-section; breaking_strength: N, None where it is not known; compression: whether
    its bars also push, by the same law, as those of a tube do; bending_stiffness: EI, N m2, against bending from bar to
    bar along a rope of it; wall: m, thickness of that of a tube, 0 for a twine; yield_stress: Pa, of the wall, None
    where not known.
    """

    name: str
    density: float
    diameter: float
    law: ElasticLaw
    damping_time: float = 0.0
    material: str = ""
    loss_factor: float = 0.0
    linear_density: float | None = None
    breaking_strength: float | None = None
    compression: bool = False
    bending_stiffness: float = 0.0
    wall: float = 0.0
    yield_stress: float | None = None

    @property
    def area(self) -> float:
        """Cross-section of the outline, pi d^2 / 4 (m2)."""
        return float(np.pi * self.diameter**2 / 4.0)

    @property
    def mass_per_length(self) -> float:
        """Dry mass per length (kg/m)."""
        return self.density * self.area if self.linear_density is None else self.linear_density

    @property
    def fibre_area(self) -> float:
        """Cross-section of the fibre alone (m2): mass per length over the fibre's density."""
        return self.area if self.linear_density is None else self.linear_density / self.density

    def soaked_density(self, water: float) -> float:
        """Density (kg/m3) of fibre and pores full of water of a density (kg/m3), over the whole cross-section."""
        if self.linear_density is None:
            return self.density
        return (self.linear_density + water * (self.area - self.fibre_area)) / self.area


def diameter_of(linear_density: float, density: float, packing: float = PACKING) -> float:
    """Outer diameter (m) of a twine: d = 2 sqrt(linear_density / (pi density packing)).

    linear_density: mass per length (kg/m); density: of the fibre (kg/m3); packing: share of the cross-section that is
    fibre, a round one.
    """
    return float(2.0 * np.sqrt(linear_density / (np.pi * density * packing)))
