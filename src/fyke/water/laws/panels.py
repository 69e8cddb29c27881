"""Laws for a plane panel of netting as a whole (screen models), q the angle between its normal and the flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from . import cylinder
from .joints import numbers
from .law import GAP_REYNOLDS, SOLIDITY, Numbers, Pair, PanelLaw, Range

_LOELAND_RANGE = (Range(SOLIDITY, 0.13, 0.317),)


def _spread(*values: ArrayLike) -> list[Numbers]:
    return [numbers(one) for one in np.broadcast_arrays(*values)]


@dataclass(frozen=True)
class Aarsnes(PanelLaw):
    """C_D = 0.04 + (-0.04 + Sn - 1.24 Sn^2 + 13.7 Sn^3) cos q, C_L = (0.57 Sn - 3.54 Sn^2 + 10.1 Sn^3) sin 2q."""

    name = "aarsnes"
    title = "Aarsnes, Rudi and Loeland's screen"
    source = (
        "J.V. Aarsnes, H. Rudi, G. Loeland, Current forces on cage, net deflection, Engineering for offshore fish "
        "farming, 137-152, 1990"
    )
    read = "in three public codes that agree, the range from memory; the paper was not opened"
    stated = _LOELAND_RANGE

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L; the Reynolds number plays no part."""
        q, sn, _ = _spread(angle, solidity, reynolds)
        drag = 0.04 + (-0.04 + sn - 1.24 * sn**2 + 13.7 * sn**3) * np.cos(q)
        return drag, (0.57 * sn - 3.54 * sn**2 + 10.1 * sn**3) * np.sin(2.0 * q)


@dataclass(frozen=True)
class Loland(PanelLaw):
    """C_D = 0.04 + (-0.04 + 0.33 Sn + 6.54 Sn^2 - 4.88 Sn^3) cos q, C_L = (-0.05 Sn + 2.3 Sn^2 - 1.76 Sn^3) sin 2q."""

    name = "loland"
    title = "Loeland's screen"
    source = (
        "G. Loeland, Current forces on and flow through fish farms, thesis, Norwegian Inst. Technology, 1991"
    )
    read = "in two public codes that agree, the range from memory; the thesis was not opened"
    stated = _LOELAND_RANGE

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L; the Reynolds number plays no part."""
        q, sn, _ = _spread(angle, solidity, reynolds)
        drag = 0.04 + (-0.04 + 0.33 * sn + 6.54 * sn**2 - 4.88 * sn**3) * np.cos(q)
        return drag, (-0.05 * sn + 2.3 * sn**2 - 1.76 * sn**3) * np.sin(2.0 * q)


# (a1, a3, a5), (b2, b4, b6); each a sums to 1, so that C_D face on is that of the cylinders.
_SERIES = {
    "simple": ((0.9, 0.1, 0.0), (1.0, 0.1, 0.0)),
    "sheet": ((0.97252, 0.01387, 0.01361), (1.45, 0.05369, 0.000367)),
    "quasi-static": ((0.972, 0.0129, 0.0151), (1.2044, 0.1466, 0.135)),
}


@dataclass(frozen=True)
class KristiansenFaltinsen(PanelLaw):
    """Fourier series of the angle, with the drag of the twines in the faster water between them.

    With Re' = Re / (1 - Sn) and C that of Kristiansen and Faltinsen's cylinder at Re',
    C_D0 = C Sn (2 - Sn) / (2 (1 - Sn)^2), C_N45 = C_D0 / 2, C_T45 = pi C_N45 / (8 + C_N45),
    C_D = C_D0 sum a_k cos kq (k = 1, 3, 5), C_L = (C_N45 - C_T45) / sqrt 2 sum b_k sin kq (k = 2, 4, 6).

    series: simple (a 0.9, 0.1; b 1, 0.1, believed to be the paper's), sheet or quasi-static (those of REEF3D).
    One public code takes C_N45 = C Sn / (2 (1 - Sn)^2), which does not agree with its own C_D0; it is not used here.
    """

    name = "kristiansen-faltinsen"
    title = "Kristiansen and Faltinsen's screen"
    source = (
        "T. Kristiansen, O.M. Faltinsen, Modelling of current loads on aquaculture net cages, J. Fluids and Structures "
        "34, 218-235, 2012"
    )
    read = "in three public codes; which series is printed is not known; the paper was not opened"
    stated = (Range(GAP_REYNOLDS, cylinder.KF_LOW, cylinder.KF_HIGH),)
    series: Literal["simple", "sheet", "quasi-static"] = "simple"

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L."""
        q, sn, re = _spread(angle, solidity, reynolds)
        even, odd = _SERIES[self.series]
        face_on = (
            cylinder.KRISTIANSEN_FALTINSEN.value(re / (1.0 - sn)) * sn * (2.0 - sn) / (2.0 * (1.0 - sn) ** 2)
        )
        normal = 0.5 * face_on
        lift = (normal - np.pi * normal / (8.0 + normal)) / np.sqrt(2.0)
        return (
            face_on * sum(a * np.cos(k * q) for k, a in zip((1, 3, 5), even, strict=True)),
            lift * sum(b * np.sin(k * q) for k, b in zip((2, 4, 6), odd, strict=True)),
        )


@dataclass(frozen=True)
class Balash(PanelLaw):
    """C_D face on = (0.12 - 0.74 Sn + 8.03 Sn^2) (1 + 10 Re'^(-2/3)), Re' = Re / (1 - Sn).

    The angle is not the paper's: that part of the public code is faulty, and here the pressure on the panel goes with
    cos^2 q, so that C_D = C_D0 cos^3 q and C_L = C_D0 cos^2 q sin q. The term for knots, faulty too, is left out.
    """

    name = "balash"
    title = "Balash's screen"
    source = "C. Balash et al., Aquacultural Engineering 41, 14-21, 2009"
    read = "face on in one public code, the angle by cross-flow; the paper was not opened"

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L."""
        q, sn, re = _spread(angle, solidity, reynolds)
        face_on = (0.12 - 0.74 * sn + 8.03 * sn**2) * cylinder.WHITE.value(re / (1.0 - sn))
        return face_on * np.cos(q) ** 3, face_on * np.cos(q) ** 2 * np.sin(q)


@dataclass(frozen=True)
class Fridman(PanelLaw):
    """A coefficient across and one along the panel, each on its own speed squared.

    c_n = 3 (Re / (2 Sn))^-0.07 Sn, c_t = 0.1 Re^0.14 Sn,
    C_D = c_n cos^3 q + c_t sin^3 q, C_L = c_n cos^2 q sin q - c_t sin^2 q cos q. A public code adds in C_L; a force
    along the panel lowers the lift.
    """

    name = "fridman"
    title = "Fridman's screen"
    source = (
        "A.L. Fridman, Theory and design of commercial fishing gear, 1973; Calculations for fishing gear designs, "
        "1986"
    )
    read = "in one public code, its sign in C_L put right by geometry; the books were not opened"

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L; without netting (Sn = 0) or in still water (Re = 0) they are 0."""
        q, sn, re = _spread(angle, solidity, reynolds)
        some = (np.real(sn) > 0.0) & (np.real(re) > 0.0)
        ratio = np.where(some, re, 1.0) / (2.0 * np.where(some, sn, 1.0))
        normal = np.where(some, 3.0 * ratio**-0.07 * sn, 0.0)
        tangential = np.where(some, 0.1 * np.where(some, re, 1.0) ** 0.14 * sn, 0.0)
        cosine, sine = np.cos(q), np.sin(q)
        return (
            normal * cosine**3 + tangential * sine**3,
            normal * cosine**2 * sine - tangential * sine**2 * cosine,
        )


@dataclass(frozen=True)
class Bi(PanelLaw):
    """C_D = 0.04 + 0.4921 cos q + 0.1873 cos^2 q, C_L = 0.4159 sin 2q - 0.169 sin^2 2q: one netting, nothing else."""

    name = "bi"
    title = "Bi's fit to one netting"
    source = "C.-W. Bi et al., 2014, as coded in HydroModules"
    read = "in one public code; the paper was not opened"

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L; neither solidity nor Reynolds number plays a part."""
        q, *_ = _spread(angle, solidity, reynolds)
        twice = np.sin(2.0 * q)
        return 0.04 + 0.4921 * np.cos(q) + 0.1873 * np.cos(q) ** 2, 0.4159 * twice - 0.169 * twice**2


_LEE_DRAG = np.polynomial.Polynomial([1.155, -0.9431, 5.079, -13.48, 11.75, -2.403, -1.435, 0.556])
_LEE_LIFT = np.polynomial.Polynomial(
    [0.01294, 0.2325, 2.103, -7.97, 59.14, -181.6, 257.3, -187.9, 69.22, -10.22]
)


@dataclass(frozen=True)
class Lee(PanelLaw):
    """Polynomials of the angle.

    C_D = 0.556 q^7 - 1.435 q^6 - 2.403 q^5 + 11.75 q^4 - 13.48 q^3 + 5.079 q^2 - 0.9431 q + 1.155,
    C_L = -10.22 q^9 + 69.22 q^8 - 187.9 q^7 + 257.3 q^6 - 181.6 q^5 + 59.14 q^4 - 7.97 q^3 + 2.103 q^2 + 0.2325 q
    + 0.01294, q in rad. C_D face on is that of a twine, so both are taken to be on the area of the twine.
    """

    name = "lee"
    title = "Lee's polynomials"
    area = "twine"
    source = (
        "C.-W. Lee et al., Physical modeling for underwater flexible systems, Ocean Engineering 32, 331, 2005"
    )
    read = "in one public code, the area inferred from the values; the paper was not opened"

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L on the area of the twine; neither solidity nor Reynolds number plays a part."""
        q, *_ = _spread(angle, solidity, reynolds)
        return _LEE_DRAG(q), _LEE_LIFT(q)
