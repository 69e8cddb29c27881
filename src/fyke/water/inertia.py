"""Laws of the added mass of a bar: C_a, over the mass of the water that the bar displaces, across the bar.

Papers give either C_a or the inertia coefficient C_m = 1 + C_a, whose 1 is the force of the accelerating water itself;
here everything is C_a. Along a bar there is none. Angles lie between bar and flow, 0 along and pi/2 across (rad).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

CYLINDER, SPHERE = (
    1.0,
    0.5,
)  # C_a in potential flow, of a long cylinder across and of a sphere: H. Lamb, Hydrodynamics
WATER_ITSELF = 1.0  # what C_m has over C_a


class AddedMassLaw(ABC):
    """A law of the added mass across a bar: a frozen dataclass whose fields are its parameters.

    name: the word for it in a case file; title: one line; source: paper; read: how far it was read; constant: whether
    the angle plays no part.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    source: ClassVar[str]
    read: ClassVar[str]
    constant: ClassVar[bool] = False

    @abstractmethod
    def coefficient(self, angle: ArrayLike) -> Array:
        """Return C_a at angles (m,) rad between bar and flow; the angle counts from either end of the bar."""


@dataclass(frozen=True)
class ConstantAddedMass(AddedMassLaw):
    """C_a that nothing changes."""

    name = "constant"
    title = "Constant C_a"
    source = "given by the user"
    read = "-"
    constant = True
    value: float = CYLINDER

    def coefficient(self, angle: ArrayLike) -> Array:
        """Return C_a at every angle."""
        return np.full(np.shape(angle), self.value)


@dataclass(frozen=True)
class PotentialFlow(AddedMassLaw):
    """C_a = 1 across the bar and 0 along it: C_a (I - t t^T), t along the bar.

    Along a flow at the angle a this makes e.(I - t t^T) e = sin^2 a, the factor of models that know one direction only.
    """

    name = "potential-flow"
    title = "Long cylinder in potential flow"
    source = "H. Lamb, Hydrodynamics, 6th edition, 1932"
    read = "worked out; the book was not opened"
    constant = True

    def coefficient(self, angle: ArrayLike) -> Array:
        """Return 1 at every angle."""
        return np.full(np.shape(angle), CYLINDER)


@dataclass(frozen=True)
class LeeAddedMass(AddedMassLaw):
    """C_a = sin a, from C_m = 1 + sin a.

    The paper's word is added mass, but 1 + sin a has the values of an inertia coefficient, 2 across the bar; it is
    taken as C_m. The paper adds it in all directions; here it acts across the bar.
    """

    name = "lee"
    title = "Lee's C_m = 1 + sin a"
    source = (
        "C.-W. Lee et al., Physical modeling for underwater flexible systems dynamic simulation, Ocean Engineering 32, "
        "331, 2005"
    )
    read = "the formula from memory; the paper was not opened"

    def coefficient(self, angle: ArrayLike) -> Array:
        """Return the sine of the angle."""
        return np.asarray(np.abs(np.sin(angle)), dtype=float)


@dataclass(frozen=True)
class AddedMassTable(AddedMassLaw):
    """C_a at n rising angles (rad) from 0 to pi/2, straight between and held beyond them; ValueError for others."""

    name = "table"
    title = "C_a by angle, your own"
    source = "the user's table"
    read = "-"
    angle: tuple[float, ...]
    value: tuple[float, ...]

    def __post_init__(self) -> None:
        """Check the numbers."""
        angles = np.asarray(self.angle, dtype=float)
        rising = len(angles) > 1 and all(a < b for a, b in pairwise(self.angle))
        if not rising or not (angles[0] >= 0.0 and angles[-1] <= np.pi / 2.0):
            raise ValueError(f"angles must be two or more rising numbers from 0 to pi/2: {self.angle!r}")
        values = np.asarray(self.value, dtype=float)
        if values.shape != angles.shape or not np.all(np.isfinite(values) & (values >= 0.0)):
            raise ValueError(
                f"C_a must be a finite number that is not negative at every angle: {self.value!r}"
            )

    def coefficient(self, angle: ArrayLike) -> Array:
        """Return C_a between the points."""
        turned = np.arctan2(np.abs(np.sin(angle)), np.abs(np.cos(angle)))
        return np.asarray(np.interp(turned, self.angle, self.value))


ADDED_MASS_LAWS: Mapping[str, type[AddedMassLaw]] = MappingProxyType(
    {law.name: law for law in (ConstantAddedMass, PotentialFlow, LeeAddedMass, AddedMassTable)}
)
