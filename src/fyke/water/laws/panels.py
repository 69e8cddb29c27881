"""Laws for a plane panel of netting as a whole (screen models), q the angle between its normal and the flow.

Every formula is written once, as a plain function that the compiled kernels of screens take in too: of c = cos q,
s = sin q, the solidity Sn and the Reynolds number Re = d V / nu of the undisturbed speed. It returns C_D and
C_L / (c s) on the outline of the panel; without c s, which turns with the flow, there is nothing to divide by face on.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import cylinder
from .joints import joined, numbers, powers
from .law import GAP_REYNOLDS, SOLIDITY, Numbers, Pair, PanelLaw, Range

Row = tuple[float, ...]

_LOELAND_RANGE = (Range(SOLIDITY, 0.13, 0.317),)


def polynomial(row: Row, x: Any) -> Any:
    """Return the sum of row[k] x^k."""
    total = row[-1] + 0.0 * x
    for k in range(len(row) - 2, -1, -1):
        total = total * x + row[k]
    return total


def at(curve: Any, re: Any) -> Any:
    """Return what a curve of the Reynolds number is there; kernels read a table of it instead."""
    return curve.value(re)


def blunt(x: Any, width: float) -> Any:
    """Return x >= 0 without its edge at 0: even powers of x up to width, where two derivatives meet; 0 stays 0."""
    t = x / width
    return width * t * t * (15.0 - 10.0 * t * t + 3.0 * t * t * t * t) / 8.0 if x.real < width else x


def upheld(x: Any, width: float) -> Any:
    """Return x >= 0, but no less than 3/8 of width: even powers of x up to width, where two derivatives meet."""
    t = x / width
    return width * (3.0 + 6.0 * t * t - t * t * t * t) / 8.0 if x.real < width else x


def _spread(*values: ArrayLike) -> list[Numbers]:
    return [numbers(one) for one in np.broadcast_arrays(*values)]


class ScreenLaw(PanelLaw):
    """A panel law whose formula is also that of the kernels."""

    @property
    @abstractmethod
    def form(self) -> tuple[Any, ...]:
        """What the formula is given: a NamedTuple, whose type says in FORMULAS which formula it is."""

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L on `area`; reynolds: d V / nu with the undisturbed speed and the twine diameter."""
        q, sn, re = _spread(angle, solidity, reynolds)
        cosine, sine = np.cos(q), np.sin(q)
        drag, lift = FORMULAS[type(self.form)](self.form, cosine, sine, sn, re)
        return drag, lift * sine * cosine


class BySolidity(NamedTuple):
    """C_D = friction + drag(Sn) c, C_L = lift(Sn) 2 c s; drag, lift: coefficients of powers of Sn from the 0th."""

    friction: float
    drag: Row
    lift: Row


def by_solidity(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s)."""
    return law.friction + polynomial(law.drag, sn) * c, 2.0 * polynomial(law.lift, sn)


@dataclass(frozen=True)
class Aarsnes(ScreenLaw):
    """C_D = 0.04 + (-0.04 + Sn - 1.24 Sn^2 + 13.7 Sn^3) cos q, C_L = (0.57 Sn - 3.54 Sn^2 + 10.1 Sn^3) sin 2q."""

    name = "aarsnes"
    title = "Aarsnes, Rudi and Loeland's screen"
    source = (
        "J.V. Aarsnes, H. Rudi, G. Loeland, Current forces on cage, net deflection, Engineering for offshore fish "
        "farming, 137-152, 1990"
    )
    read = "in three public codes that agree, the range from memory; the paper was not opened"
    stated = _LOELAND_RANGE

    @property
    def form(self) -> BySolidity:
        """Friction and both polynomials."""
        return BySolidity(0.04, (-0.04, 1.0, -1.24, 13.7), (0.0, 0.57, -3.54, 10.1))


@dataclass(frozen=True)
class Loland(ScreenLaw):
    """C_D = 0.04 + (-0.04 + 0.33 Sn + 6.54 Sn^2 - 4.88 Sn^3) cos q, C_L = (-0.05 Sn + 2.3 Sn^2 - 1.76 Sn^3) sin 2q."""

    name = "loland"
    title = "Loeland's screen"
    source = (
        "G. Loeland, Current forces on and flow through fish farms, thesis, Norwegian Inst. Technology, 1991"
    )
    read = "in two public codes that agree, the range from memory; the thesis was not opened"
    stated = _LOELAND_RANGE

    @property
    def form(self) -> BySolidity:
        """Friction and both polynomials."""
        return BySolidity(0.04, (-0.04, 0.33, 6.54, -4.88), (0.0, -0.05, 2.3, -1.76))


# (a1, a3, a5), (b2, b4, b6); each a sums to 1, so that C_D face on is that of the cylinders.
_SERIES = {
    "simple": ((0.9, 0.1, 0.0), (1.0, 0.1, 0.0)),
    "sheet": ((0.97252, 0.01387, 0.01361), (1.45, 0.05369, 0.000367)),
    "quasi-static": ((0.972, 0.0129, 0.0151), (1.2044, 0.1466, 0.135)),
}


class BySeries(NamedTuple):
    """Series of cos kq, k = 1, 3, 5, and of sin kq, k = 2, 4, 6; curve: drag of a twine at Re / (1 - Sn)."""

    drag: tuple[float, float, float]
    lift: tuple[float, float, float]
    curve: Any


def by_series(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s); cos kq / c and sin kq / (c s) are polynomials of (2 c)^2."""
    a1, a3, a5 = law.drag
    b2, b4, b6 = law.lift
    faster = 1.0 / (1.0 - sn)
    face_on = 0.5 * at(law.curve, re * faster) * sn * (2.0 - sn) * faster * faster
    normal = 0.5 * face_on
    lift = (normal - np.pi * normal / (8.0 + normal)) * np.sqrt(0.5)
    four = 4.0 * c * c
    odd = a1 + a3 * (four - 3.0) + a5 * ((four - 5.0) * four + 5.0)
    even = b2 + b4 * (four - 2.0) + b6 * (four - 1.0) * (four - 3.0)
    return face_on * odd * c, 2.0 * lift * even


@dataclass(frozen=True)
class KristiansenFaltinsen(ScreenLaw):
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

    @property
    def form(self) -> BySeries:
        """The chosen series and the cylinder."""
        return BySeries(*_SERIES[self.series], cylinder.KRISTIANSEN_FALTINSEN)


class ByPressure(NamedTuple):
    """A pressure that goes with c^2; face_on: coefficients of powers of Sn; curve: drag of a twine at Re / (1 - Sn)."""

    face_on: Row
    curve: Any


def by_pressure(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s)."""
    face_on = polynomial(law.face_on, sn) * at(law.curve, re / (1.0 - sn))
    return face_on * c * c * c, face_on * c


@dataclass(frozen=True)
class Balash(ScreenLaw):
    """C_D face on = (0.12 - 0.74 Sn + 8.03 Sn^2) (1 + 10 Re'^(-2/3)), Re' = Re / (1 - Sn).

    The angle is not the paper's: that part of the public code is faulty, and here the pressure on the panel goes with
    cos^2 q, so that C_D = C_D0 cos^3 q and C_L = C_D0 cos^2 q sin q. The term for knots, faulty too, is left out.
    """

    name = "balash"
    title = "Balash's screen"
    source = "C. Balash et al., Aquacultural Engineering 41, 14-21, 2009"
    read = "face on in one public code, the angle by cross-flow; the paper was not opened"

    @property
    def form(self) -> ByPressure:
        """The polynomial and the cylinder."""
        return ByPressure((0.12, -0.74, 8.03), cylinder.WHITE)


class ByTwoSpeeds(NamedTuple):
    """c_n = normal (Re / (2 Sn))^-0.07 Sn across the panel, c_t = along Re^0.14 Sn along it; curve: x^-0.07."""

    normal: float
    along: float
    curve: Any


def by_two_speeds(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s)."""
    power = at(law.curve, re)
    normal = law.normal * power / at(law.curve, 2.0 * sn) * sn
    along = law.along / (power * power) * sn
    return normal * c * c * c + along * s * s * s, normal * c - along * s


_FRIDMAN_POWER = joined([powers((1.0, -0.07))])


@dataclass(frozen=True)
class Fridman(ScreenLaw):
    """A coefficient across and one along the panel, each on its own speed squared.

    c_n = 3 (Re / (2 Sn))^-0.07 Sn, c_t = 0.1 Re^0.14 Sn, powers held below 1e-6 as all curves are;
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

    @property
    def form(self) -> ByTwoSpeeds:
        """Both factors and the power."""
        return ByTwoSpeeds(3.0, 0.1, _FRIDMAN_POWER)


class ByAngle(NamedTuple):
    """C_D by powers of c, C_L by powers of sin 2q from the first, whatever the netting."""

    drag: Row
    lift: Row


def by_angle(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s)."""
    return polynomial(law.drag, c), 2.0 * polynomial(law.lift, 2.0 * c * s)


@dataclass(frozen=True)
class Bi(ScreenLaw):
    """C_D = 0.04 + 0.4921 cos q + 0.1873 cos^2 q, C_L = 0.4159 sin 2q - 0.169 sin^2 2q: one netting, nothing else."""

    name = "bi"
    title = "Bi's fit to one netting"
    source = "C.-W. Bi et al., 2014, as coded in HydroModules"
    read = "in one public code; the paper was not opened"

    @property
    def form(self) -> ByAngle:
        """Both polynomials."""
        return ByAngle((0.04, 0.4921, 0.1873), (0.4159, -0.169))


# Of sin q and cos q: within 3 deg of face on and of along, Lee's screens leave Lee's polynomials, which have lift there
# though no side is before another, and a drag with an edge.
LEE_WIDTH = 0.05


class ByTwine(NamedTuple):
    """C_D and C_L on the area of the twine by powers of q in rad."""

    drag: Row
    lift: Row


def by_twine(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s) on the outline, smooth face on and along the flow within LEE_WIDTH."""
    q = 2.0 * np.arctan(blunt(s, LEE_WIDTH) / (1.0 + c))
    lift = polynomial(law.lift, q) / (upheld(s, LEE_WIDTH) * upheld(c, LEE_WIDTH))
    return sn * polynomial(law.drag, q), sn * lift


@dataclass(frozen=True)
class Lee(ScreenLaw):
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

    @property
    def form(self) -> ByTwine:
        """Both polynomials."""
        return ByTwine(
            (1.155, -0.9431, 5.079, -13.48, 11.75, -2.403, -1.435, 0.556),
            (0.01294, 0.2325, 2.103, -7.97, 59.14, -181.6, 257.3, -187.9, 69.22, -10.22),
        )

    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L on the area of the twine, as published; neither solidity nor Reynolds number counts."""
        q, *_ = _spread(angle, solidity, reynolds)
        return polynomial(self.form.drag, q), polynomial(self.form.lift, q)


FORMULAS: Mapping[type, Callable[..., Any]] = MappingProxyType(
    {
        BySolidity: by_solidity,
        BySeries: by_series,
        ByPressure: by_pressure,
        ByTwoSpeeds: by_two_speeds,
        ByAngle: by_angle,
        ByTwine: by_twine,
    }
)
