"""Irregular seas: many Airy waves with phases drawn at random, and their spread of directions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import limits
from .dispersion import wavenumber
from .regular import GRAVITY
from .sea import Named, Stretching, Waves, harmonics, heading
from .spectra import equal_energy_frequencies

Array = NDArray[np.float64]

JONSWAP = (
    "K. Hasselmann et al., Measurements of wind-wave growth and swell decay during the Joint North Sea Wave Project, "
    "1973, not opened; in the form of DNV-RP-C205 as cited in public codes"
)
PIERSON_MOSKOWITZ = (
    "W.J. Pierson, L. Moskowitz, A proposed spectral form for fully developed wind seas, J. Geophysical Research 69, "
    "5181-5190, 1964, not opened; in the form of DNV-RP-C205 as cited in public codes"
)


@dataclass(frozen=True)
class Spreading:
    """Energy by direction as cos^2s((beta - beta_0) / 2), s the exponent, in so many directions of equal energy.

    M.S. Longuet-Higgins, D.E. Cartwright, N.D. Smith 1963, general knowledge; the first moment |mean of e^(i beta)| is
    s / (s + 1).
    """

    exponent: float
    directions: int

    def angles(self, count: int) -> Array:
        """Return angles (count,) rad off the mean direction, rising, one for each of so many equal shares of energy.

        b = sin^2(beta / 2) has the distribution Beta(1/2, s + 1/2). An angle is that of the mean b of its share, so
        that the moment is s / (s + 1) but for the share in the middle, which goes straight on.
        """
        from scipy.special import betainc, betaincinv

        a, c = 0.5, self.exponent + 0.5
        edges = np.linspace(-1.0, 1.0, count + 1)  # energy within +-beta, with the sign of beta
        sums = np.sign(edges) * a / (a + c) * betainc(a + 1.0, c, betaincinv(a, c, np.abs(edges)))
        middles = (2.0 * np.arange(count) + 1.0 - count) / count
        return np.asarray(np.sign(middles) * 2.0 * np.arcsin(np.sqrt(np.diff(sums) * 0.5 * count)))


def irregular(
    significant_height: float,
    peak_period: float,
    *,
    gamma: float,
    components: int = 200,
    seed: int = 1,
    spreading: Spreading | None = None,
    direction: float = 0.0,
    depth: float = math.inf,
    gravity: float = GRAVITY,
    stretching: Stretching = "wheeler",
    ramp: float = 0.0,
) -> Waves:
    """Return a sea with the JONSWAP spectrum of a peak factor gamma, 1 for Pierson and Moskowitz; m, s, rad.

    Every component has the same energy, Hs^2 / (16 components), so that 4 sqrt(m0) is Hs to the last digit; its
    frequency is that of its share of the spectrum. Such frequencies have no common measure, so that the record does not
    repeat, and they are dense where the energy is. Phases are uniform, from PCG64 with the seed.

    With spreading every component has one direction, in turn all of them within every so many neighbouring
    frequencies, in an order drawn with the same seed. Components of one frequency never run in two directions, whose
    pattern would stand still: Latham et al., Proc. R. Soc. A 472, 20160290, 2016 (abstract read), find such seas the
    most ergodic. ValueError for a significant height beyond breaking.
    """
    limits.refuse_breaking(significant_height, peak_period, depth, gravity)
    omega = equal_energy_frequencies(peak_period, gamma, components)
    random = np.random.Generator(np.random.PCG64(seed))
    phase = random.uniform(0.0, 2.0 * np.pi, components)
    angle = np.zeros(components) if spreading is None else _dealt(spreading, components, random)
    amplitude = significant_height / math.sqrt(8.0 * components)
    parts = harmonics(
        wavenumber=wavenumber(omega, depth, gravity),
        omega=omega,
        direction=direction + angle,
        phase=phase,
        amplitude=amplitude,
        speed=amplitude * omega,
        depth=depth,
    )
    told = tuple(limits.of_sea(significant_height, peak_period, gamma, depth, gravity))
    kind, source = ("jonswap", JONSWAP) if gamma > 1.0 else ("pierson-moskowitz", PIERSON_MOSKOWITZ)
    named = Named(kind, significant_height, peak_period, False, source)
    return Waves(parts, heading(direction), depth, stretching, ramp, told, named)


def _dealt(spreading: Spreading, components: int, random: np.random.Generator) -> Array:
    """Directions (components,) rad: all of them, in random order, to every so many components in a row.

    What is left at the end gets as many directions as it has components, so that the mean direction stays exact.
    """
    hands = [
        random.permutation(spreading.angles(min(spreading.directions, components - first)))
        for first in range(0, components, spreading.directions)
    ]
    return np.concatenate(hands)
