"""Elastic laws of twine: tension as a function of strain, taut only.

Every law is handed on as rows of one shape, so that one kernel serves all: row s holds
(strain_s, tension_s, slope_s, coefficient_s, exponent_s) and, for strain >= strain_s,

    T = tension_s + slope_s (strain - strain_s) + coefficient_s (strain - strain_s)^exponent_s      (N)

up to the next row; the last row has no end. T = 0 for strain <= 0. A row is straight, a power, or a slope with a
square: where coefficient and slope are both above 0 the exponent is 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class ElasticLaw(Protocol):
    """What an elastic law must offer."""

    def rows(self, diameter: float) -> Array:
        """Rows of shape (s, 5) as the module's page says; diameter in m, strains without unit, tensions in N."""

    def describe(self) -> str:
        """Return one line with formula and source."""


@dataclass(frozen=True)
class LinearLaw:
    """T = E (pi d^2 / 4) strain: equation (2) of the panel model, T = k (l - l0) with k = EA / l0."""

    youngs_modulus: float  # Pa

    def rows(self, diameter: float) -> Array:
        """One row of slope EA (N)."""
        return np.array([[0.0, 0.0, self.youngs_modulus * np.pi * diameter**2 / 4.0, 0.0, 1.0]])

    def describe(self) -> str:
        """Return one line with formula and source."""
        return f"T = E A strain, E = {self.youngs_modulus:g} Pa"


@dataclass(frozen=True)
class PowerLaw:
    """T = d^2 C1 strain^C2, the form of B.W. Wilson, Elastic characteristics of moorings (1967)."""

    c1: float  # Pa
    c2: float

    def rows(self, diameter: float) -> Array:
        """One row of coefficient d^2 C1 (N) and exponent C2."""
        return np.array([[0.0, 0.0, 0.0, diameter**2 * self.c1, self.c2]])

    def describe(self) -> str:
        """Return one line with formula and source."""
        return f"T = d^2 C1 strain^C2, C1 = {self.c1:g} Pa, C2 = {self.c2:g} (Wilson 1967)"


@dataclass(frozen=True)
class QuadraticLaw:
    """T = C1 strain + C2 strain^2, with forces measured on the twine itself, whatever its diameter.

    C1 = 1160 N and C2 = 37300 N stand in REEF3D, a public code; the literature credits Lader & Fredheim, Dynamic
    properties of a flexible net sheet in waves and current, Aquacultural Engineering 35, 228-238, 2006, not opened.
    """

    c1: float  # N, above 0
    c2: float  # N, at least 0

    def rows(self, diameter: float) -> Array:
        """One row of slope C1 (N), coefficient C2 (N) and exponent 2."""
        return np.array([[0.0, 0.0, self.c1, self.c2, 2.0]])

    def describe(self) -> str:
        """Return one line with formula and source."""
        return (
            f"T = C1 strain + C2 strain^2, C1 = {self.c1:g} N, C2 = {self.c2:g} N (form: Lader & Fredheim 2006, as "
            "REEF3D has it; paper not opened)"
        )


@dataclass(frozen=True)
class TableLaw:
    """Measured tension (N) against strain, straight between the points and beyond the last one.

    Both columns rise strictly and start at (0, 0).
    """

    strain: tuple[float, ...]
    tension: tuple[float, ...]

    def rows(self, diameter: float) -> Array:
        """Return one row per interval; the diameter plays no part because the tensions are measured."""
        strain, tension = np.array(self.strain), np.array(self.tension)
        slope = np.diff(tension) / np.diff(strain)
        zero = np.zeros_like(slope)
        return np.column_stack([strain[:-1], tension[:-1], slope, zero, zero + 1.0])

    def describe(self) -> str:
        """Return one line with formula and source."""
        return f"T(strain) from a table of {len(self.strain)} points up to strain {self.strain[-1]:g}"
