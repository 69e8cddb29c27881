"""Laws for the drag of a bar, one class each.

Cylinder fits know the flow across only; what they take along the bar is their parameter `tangential`. Reynolds numbers
are those of the speed across the bar, whatever speed an author used at the angles that he measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from . import cylinder
from .joints import BAND, LEAST_REYNOLDS, Curve, joined, level, numbers, powers
from .law import PAPER_UNREAD, REYNOLDS, AngleLaw, Numbers, Pair, Range, SplitLaw


def _alike(value: float, reynolds: ArrayLike) -> Numbers:
    return np.full_like(numbers(reynolds), value)


@dataclass(frozen=True)
class ConstantBar(SplitLaw):
    """C_n and C_t that nothing changes."""

    name = "constant"
    title = "Constant C_n and C_t"
    source = "given by the user"
    read = "-"
    normal: float = 1.2
    tangential: float = 0.1

    def coefficients(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return C_n and C_t."""
        return _alike(self.normal, reynolds), _alike(self.tangential, reynolds)

    def derivative(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return zeros."""
        return _alike(0.0, reynolds), _alike(0.0, reynolds)


@dataclass(frozen=True)
class BessonneauMarichal(ConstantBar):
    """C_n = 1.2, C_t = 0.1."""

    name = "bessonneau-marichal"
    title = "Bessonneau and Marichal's constants"
    source = (
        "V. Bessonneau, D. Marichal, Study of the dynamics of submerged supple nets (applications to trawls), "
        "Ocean Engineering 25(7), 563-583, 1998"
    )
    read = PAPER_UNREAD


@dataclass(frozen=True)
class Wan(ConstantBar):
    """C_n = 1.3, C_t = 0."""

    name = "wan"
    title = "Wan's constants"
    source = "R. Wan et al., 2002, as cited by H. Cheng et al., Aquacultural Engineering 90, 102070, 2020"
    read = PAPER_UNREAD
    normal: float = 1.3
    tangential: float = 0.0


@dataclass(frozen=True)
class CylinderFit(SplitLaw):
    """A fit of the drag across a smooth cylinder; tangential: C_t, which such a fit does not give."""

    curve: ClassVar[Curve]
    tangential: float = 0.0

    def coefficients(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return C_n of the fit and C_t as given."""
        return self.curve.value(numbers(reynolds)), _alike(self.tangential, reynolds)

    def derivative(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return the slope of the fit and 0."""
        return self.curve.slope(numbers(reynolds)), _alike(0.0, reynolds)


@dataclass(frozen=True)
class Takagi(CylinderFit):
    """C_n = 10^0.7 Re^-0.3 below Re = 200, from there 1.2; C_t = 0.1. Of the net model NaLA.

    C_n jumps from 1.02 to 1.20 at 200; here it goes over between 190 and 210.
    """

    name = "takagi"
    title = "Takagi's law, of NaLA"
    source = (
        "T. Takagi, T. Shimizu, K. Suzuki, T. Hiraishi, K. Yamamoto, Validity and layout of NaLA, Fisheries Research "
        "66, 235-243, 2004"
    )
    curve = cylinder.TAKAGI
    tangential: float = 0.1


@dataclass(frozen=True)
class White(CylinderFit):
    """C_n = 1 + 10 Re^(-2/3)."""

    name = "white"
    title = "White's cylinder"
    source = "F.M. White, Viscous fluid flow, McGraw-Hill, 1974"
    read = "from memory, and in public code for Balash 2009; the book was not opened"
    stated = (Range(REYNOLDS, 1.0, 2e5),)
    curve = cylinder.WHITE


@dataclass(frozen=True)
class SuckerBrauer(CylinderFit):
    """C_n = 6.8 Re^-0.89 + 1.96 Re^-0.5 + 1.18 - 4e-4 Re / (1 + 3.64e-7 Re^2)."""

    name = "sucker-brauer"
    title = "Sucker and Brauer's cylinder"
    source = (
        "D. Sucker, H. Brauer, Fluiddynamik bei quer angestroemten Zylindern, Waerme- und Stoffuebertragung 8, "
        "149-158, 1975"
    )
    read = "from memory; the paper was not opened"
    stated = (Range(REYNOLDS, 1e-4, 2e5),)
    curve = cylinder.SUCKER_BRAUER


@dataclass(frozen=True)
class Cheng(CylinderFit):
    """C_n = 11 Re^-0.75 + 0.9 (1 - exp(-1000 / Re)) + 1.2 (1 - exp(-(Re / 4500)^0.7))."""

    name = "ns-cheng"
    title = "N.-S. Cheng's cylinder"
    source = (
        "N.-S. Cheng, Calculation of drag coefficient for arrays of emergent circular cylinders with pseudofluid "
        "model, J. Hydraulic Engineering 139(6), 602-611, 2013, doi 10.1061/(ASCE)HY.1943-7900.0000722"
    )
    stated = (Range(REYNOLDS, 0.0, 2e5),)
    curve = cylinder.CHENG


@dataclass(frozen=True)
class KristiansenFaltinsenBar(CylinderFit):
    """C_n = sum of c_k (log10 Re)^k up to the seventh power, between Re = 10^1.5 and 10^4.

    Above it the value at 10^4 is held. Below it follows 1.45 + 8.55 Re^-0.9, never above 7, as REEF3D does; it goes
    over between Re = 28.7 and 31.6.
    """

    name = "kristiansen-faltinsen"
    title = "Kristiansen and Faltinsen's cylinder"
    source = (
        "T. Kristiansen, O.M. Faltinsen, Modelling of current loads on aquaculture net cages, J. Fluids and Structures "
        "34, 218-235, 2012"
    )
    stated = (Range(REYNOLDS, cylinder.KF_LOW, cylinder.KF_HIGH),)
    curve = cylinder.KRISTIANSEN_FALTINSEN


@dataclass(frozen=True)
class ChooCasarella(SplitLaw):
    """Across the bar the pieces below; along it a force per length, pi mu (0.55 Re_n^1/2 + 0.084 Re_n^2/3) v_t.

    C_n: 8 pi / (Re s) (1 - 0.87 / s^2), s = ln(8 / Re) - 0.0772, up to Re = 1; 1.45 + 8.55 Re^-0.9 to 30;
    1.1 + 4 Re^-1/2 to 2.33e5; -3.41e-6 (Re - 5.78e5) to 4.92e5; 0.401 (1 - exp(-Re / 5.99e5)). The jumps at the four
    joints (9.83 to 10.0, 1.850 to 1.830, 1.108 to 1.176, 0.293 to 0.225) are gone over within 5 % of the joint.

    C_t = 2 pi (0.55 Re_n^1/2 + 0.084 Re_n^2/3) / Re_t. Public codes multiply the bracket by pi mu and call the result
    a coefficient; its unit is that of a viscosity, so it can only multiply v_t, once.
    """

    name = "choo-casarella"
    title = "Choo and Casarella's towed cable"
    source = "Y.I. Choo, M.J. Casarella, Hydrodynamic resistance of towed cables, J. Hydronautics 5(4), 126-131, 1971"
    read = (
        "in three public codes that agree, beyond Re = 2.33e5 in one of them; the unit of C_t was worked out; the "
        "paper was not opened"
    )
    stated = (Range(REYNOLDS, 0.0, 1e7),)
    curve: ClassVar[Curve] = cylinder.CHOO_CASARELLA
    bracket: ClassVar[Curve] = joined([powers((1.1 * np.pi, 0.5), (0.168 * np.pi, 2.0 / 3.0))])

    def coefficients(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return C_n and C_t."""
        across = numbers(reynolds)
        return self.curve.value(across), self.bracket.value(across) / self._along(across, along)

    def derivative(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return the derivatives; C_t falls as 1 / Re_t when no `along` is given, too."""
        across = numbers(reynolds)
        moving = self._along(across, along)
        slope = self.bracket.slope(across) / moving
        if along is None:
            held = np.real(across) < LEAST_REYNOLDS
            slope = slope - np.where(held, 0.0, self.bracket.value(across) / moving**2)
        return self.curve.slope(across), slope

    @staticmethod
    def _along(across: Numbers, along: ArrayLike | None) -> Numbers:
        moving = across if along is None else numbers(along)
        return np.where(np.real(moving) < LEAST_REYNOLDS, LEAST_REYNOLDS, moving)


@dataclass(frozen=True)
class CifuentesKim(SplitLaw):
    """C_n = 1.4253 + 0.00068 X - 3.2891e-5 X^2 with X = Re Sn^2, C_t = 0; solidity: Sn of the netting.

    The parabola is 0 at X = 218.8; here it goes over to its value at X = 200, which is held.
    """

    name = "cifuentes-kim"
    title = "Cifuentes and Kim's law of solidity"
    source = (
        "C. Cifuentes, M.H. Kim, Hydrodynamic response of a cage system under waves and currents using a Morison-force "
        "model, Ocean Engineering 141, 283-294, 2017"
    )
    stated = (Range(REYNOLDS, 0.0, 5000.0),)
    last: ClassVar[float] = 200.0
    curve: ClassVar[Curve] = joined(
        [
            powers((1.4253, 0.0), (0.00068, 1.0), (-3.2891e-5, 2.0)),
            level(1.4253 + 0.00068 * 200.0 - 3.2891e-5 * 4e4),
        ],
        [200.0 * BAND],
    )
    solidity: float = 0.2

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Up to X = 200."""
        return (Range(REYNOLDS, 0.0, self.last / self.solidity**2),)

    def coefficients(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return C_n of the parabola and 0."""
        return self.curve.value(numbers(reynolds) * self.solidity**2), _alike(0.0, reynolds)

    def derivative(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return the slope of the parabola and 0."""
        square = self.solidity**2
        return self.curve.slope(numbers(reynolds) * square) * square, _alike(0.0, reynolds)


@dataclass(frozen=True)
class Hoerner(AngleLaw):
    """C_D = 1.1 sin^3 a + 0.02, C_L = 1.1 sin^2 a cos a: a force 1.1 sin^2 a across the bar, and friction.

    across: 1.1; friction: 0.02, along the flow. Used by Lee's group for ropes and bars.
    """

    name = "hoerner"
    title = "Hoerner's cross-flow principle, of Lee's group"
    source = (
        "S.F. Hoerner, Fluid-dynamic drag, 1965, section 3; C.-W. Lee et al., Ocean Engineering 32, 331, 2005"
    )
    read = "the numbers from memory, the cross-flow part worked out; neither text was opened"
    across: float = 1.1
    friction: float = 0.02

    def drag_lift(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return C_D and C_L; nothing depends on the Reynolds number."""
        sine, cosine = np.abs(np.sin(angle)), np.cos(angle)
        ones = _alike(1.0, reynolds)
        return (self.across * sine**3 + self.friction) * ones, self.across * sine**2 * cosine * ones

    def derivative(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return zeros."""
        zeros = _alike(0.0, reynolds) * np.asarray(angle)
        return zeros, zeros
