"""Laws for the drag of a knot, taken as a sphere of its diameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from .joints import Curve, joined, level, log_polynomial, numbers, powers, ten_to
from .law import REYNOLDS, KnotLaw, Numbers, Range

FORMULA_READ = "in the documentation of the package fluids 1.3.1; the paper was not opened"


@dataclass(frozen=True)
class ConstantKnot(KnotLaw):
    """A C_D that nothing changes."""

    name = "constant"
    title = "Constant C_D"
    source = "given by the user"
    read = "-"
    drag: float = 1.0

    def coefficients(self, reynolds: ArrayLike) -> Numbers:
        """Return C_D."""
        return np.full_like(numbers(reynolds), self.drag)

    def derivative(self, reynolds: ArrayLike) -> Numbers:
        """Return zeros."""
        return np.zeros_like(numbers(reynolds))


@dataclass(frozen=True)
class SphereFit(KnotLaw):
    """A fit of the drag of a smooth sphere; shape: the factor of a knot that is none."""

    curve: ClassVar[Curve]
    shape: float = 1.0

    def coefficients(self, reynolds: ArrayLike) -> Numbers:
        """Return C_D of the fit times `shape`."""
        return np.asarray(self.shape * self.curve.value(numbers(reynolds)))

    def derivative(self, reynolds: ArrayLike) -> Numbers:
        """Return the slope of the fit times `shape`."""
        return np.asarray(self.shape * self.curve.slope(numbers(reynolds)))


@dataclass(frozen=True)
class SchillerNaumann(SphereFit):
    """C_D = 24 / Re (1 + 0.15 Re^0.687) up to Re = 1000, then 0.44; the jump from 0.438 is gone over."""

    name = "schiller-naumann"
    title = "Schiller and Naumann's sphere"
    source = (
        "L. Schiller, A. Naumann, Ueber die grundlegenden Berechnungen bei der Schwerkraftaufbereitung, Z. VDI 77, "
        "318-320, 1933"
    )
    read = "from memory; the paper was not opened"
    stated = (Range(REYNOLDS, 0.0, 2e5),)
    curve = joined([powers((24.0, -1.0), (3.6, -0.313)), level(0.44)], [1000.0])


def _shoulder(re: Any) -> Any:
    return 0.417 / (1.0 + 5070.0 * re**-0.94)


def _shoulder_slope(re: Any) -> Any:
    return 0.417 * 5070.0 * 0.94 * re**-1.94 / (1.0 + 5070.0 * re**-0.94) ** 2


_GAUVIN_POWERS = powers((24.0, -1.0), (24.0 * 0.152, -0.323))


@dataclass(frozen=True)
class CliftGauvin(SphereFit):
    """C_D = 24 / Re (1 + 0.152 Re^0.677) + 0.417 / (1 + 5070 Re^-0.94)."""

    name = "clift-gauvin"
    title = "Clift and Gauvin's sphere"
    source = "R. Clift, W.H. Gauvin, The motion of particles in turbulent gas streams, Proc. Chemeca 1, 14-28, 1970"
    read = FORMULA_READ
    stated = (Range(REYNOLDS, 0.0, 2e5),)
    curve = joined(
        [
            Curve(
                lambda re: _GAUVIN_POWERS.value(re) + _shoulder(re),
                lambda re: _GAUVIN_POWERS.slope(re) + _shoulder_slope(re),
            )
        ]
    )


_PER_DECADE = 1.0 / np.log(10.0)


def _slow(re: Any) -> Any:
    ln = np.log(re)
    return 24.0 / re * (1.0 + 0.1315 * np.exp(ln * (0.82 - 0.05 * _PER_DECADE * ln)))


def _slow_slope(re: Any) -> Any:
    ln = np.log(re)
    grown = 0.1315 * np.exp(ln * (0.82 - 0.05 * _PER_DECADE * ln))
    return 24.0 / re**2 * (grown * (0.82 - 0.1 * _PER_DECADE * ln) - 1.0 - grown)


@dataclass(frozen=True)
class CliftGraceWeber(SphereFit):
    """Nine pieces, w = log10 Re; 24 / Re + 3 / 16 below 0.01, 0.1 w - 0.49 from 4e5 to 1e6, where it is then held.

    The last piece is found printed with 0.19 w, which jumps from 0.09 to 0.57; with 0.1 w it goes on at 0.07. The
    pieces meet within 1 % elsewhere, and are joined within 5 % of each joint.
    """

    name = "clift-grace-weber"
    title = "Clift, Grace and Weber's standard curve"
    source = (
        "R. Clift, J.R. Grace, M.E. Weber, Bubbles, drops, and particles, Academic Press, 1978, table 5.2"
    )
    read = FORMULA_READ + "; its last piece put right"
    stated = (Range(REYNOLDS, 0.0, 1e6),)
    curve = joined(
        [
            powers((24.0, -1.0), (3.0 / 16.0, 0.0)),
            Curve(_slow, _slow_slope),
            powers((24.0, -1.0), (24.0 * 0.1935, -0.3695)),
            ten_to(log_polynomial(1.6435, -1.1242, 0.1558)),
            ten_to(log_polynomial(-2.4571, 2.5558, -0.9295, 0.1049)),
            ten_to(log_polynomial(-1.9181, 0.6370, -0.0636)),
            ten_to(log_polynomial(-4.3390, 1.5809, -0.1546)),
            log_polynomial(29.78, -5.3),
            log_polynomial(-0.49, 0.1),
            level(0.11),
        ],
        [0.01, 20.0, 260.0, 1500.0, 1.2e4, 4.4e4, 3.38e5, 4e5, 1e6],
    )
