"""Where waves break, and numbers that say how far a theory of waves holds."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from .dispersion import wavenumber

# R. Miche, Mouvements ondulatoires de la mer en profondeur constante ou decroissante, Ann. Ponts Chaussees, 1944: a
# wave breaks at H / L = 0.142 tanh(k h).
MICHE = 0.142
# Usual limits of Stokes' second order; general knowledge, no source was opened.
LARGEST_URSELL, STEEPEST_STOKES = 26.0, 0.06
# Airy's waves have no second order: what Stokes adds to the crest, over the amplitude.
LARGEST_SECOND_ORDER = 0.1
# API RP 2MET as cited by the IADC lexicon: severe sea states have H_s / (g T_p^2 / 2 pi) of 1/16 to 1/20.
STEEPEST_SEA = 1.0 / 16.0
# E.B. Thornton, R.T. Guza 1982: in a surf zone the root mean square height is 0.42 h, 1/sqrt(2) of the significant
# one. The paper was not opened.
LARGEST_IN_DEPTH = 0.6
# Where JONSWAP is stated, of T_p / sqrt(H_s), s/m^(1/2), and the gamma up to which its normalisation was fitted;
# DNV-RP-C205 as cited by public code.
JONSWAP_RANGE, LARGEST_GAMMA = (3.6, 5.0), 7.0


def wave_length(period: float, depth: float, gravity: float) -> float:
    """Return L (m) of small waves of a period (s) in a depth (m, infinite for deep water)."""
    return 2.0 * math.pi / float(wavenumber(2.0 * math.pi / period, depth, gravity))


def breaking_height(period: float, depth: float, gravity: float) -> float:
    """Return the largest height (m) of waves of a period (s) in a depth (m): Miche, 0.142 L tanh(k h)."""
    length = wave_length(period, depth, gravity)
    return MICHE * length * math.tanh(2.0 * math.pi / length * depth)


def ursell_number(height: float, length: float, depth: float) -> float:
    """Return H L^2 / h^3; 0 in deep water."""
    return height * length**2 / depth**3


def keulegan_carpenter(speed: float, period: float, diameter: float) -> float:
    """Return U T / d of water that swings with amplitude `speed` (m/s) and period (s) about a thickness (m).

    It is about 6 times the water's path over the thickness: a few where inertia matters, hundreds to thousands at
    twines, where drag is all.
    """
    return speed * period / diameter


def second_order_crest(height: float, period: float, depth: float, gravity: float) -> float:
    """Return the elevation (m) that Stokes' second order adds to a crest: its amplitude.

    (pi H^2 / 8 L) cosh(kh) (2 + cosh 2kh) / sinh^3(kh), written with e^(-2kh) so that deep water does not overflow.
    """
    length = wave_length(period, depth, gravity)
    mirror = math.exp(-4.0 * math.pi / length * depth)
    shape = 2.0 * (1.0 + mirror) * (1.0 + 4.0 * mirror + mirror**2) / (1.0 - mirror) ** 3
    return math.pi * height**2 / (8.0 * length) * shape


def refuse_breaking(height: float, period: float, depth: float, gravity: float) -> None:
    """Raise a ValueError for waves that would break."""
    largest = breaking_height(period, depth, gravity)
    if not 0.0 < height <= largest:
        raise ValueError(
            f"waves of period {period:g} s in {_of(depth)} are between 0 and {largest:.4g} m high, where they break "
            f"(H/L = {MICHE:g} tanh kh); {height:g} m was asked for"
        )


def of_airy(height: float, period: float, depth: float, gravity: float) -> Iterator[str]:
    """Say where waves are too steep or too long for linear theory."""
    share = second_order_crest(height, period, depth, gravity) / (0.5 * height)
    if share > LARGEST_SECOND_ORDER:
        yield (
            f"Linear waves of {height:g} m and {period:g} s in {_of(depth)} are steep: the second order would add "
            f"{share * 100:.3g} % of the amplitude to the crest (warned above {LARGEST_SECOND_ORDER * 100:g} %)."
        )


def of_stokes(height: float, period: float, depth: float, gravity: float) -> Iterator[str]:
    """Say where waves are too long or too steep for Stokes' second order."""
    length = wave_length(period, depth, gravity)
    ursell = ursell_number(height, length, depth)
    if ursell > LARGEST_URSELL:
        yield (
            f"The waves are long for Stokes' second order: the Ursell number H L^2 / h^3 is {ursell:.4g}, "
            f"above its limit of {LARGEST_URSELL:g}."
        )
    if height / length > STEEPEST_STOKES:
        yield (
            f"The waves are steep for Stokes' second order: H / L is {height / length:.3g}, "
            f"above its limit of {STEEPEST_STOKES:g}."
        )


def of_sea(height: float, period: float, gamma: float, depth: float, gravity: float) -> Iterator[str]:
    """Say what is odd about an irregular sea of a significant height (m) and a peak period (s)."""
    steepness = 2.0 * np.pi * height / (gravity * period**2)
    if steepness > STEEPEST_SEA:
        yield (
            f"The sea is steep: 2 pi Hs / (g Tp^2) is {steepness:.3g}, and severe seas have "
            f"{STEEPEST_SEA:.3g} at most."
        )
    if height / depth > LARGEST_IN_DEPTH:
        yield (
            f"The sea is high for its depth: Hs / depth is {height / depth:.3g}; waves break above "
            f"about {LARGEST_IN_DEPTH:g}."
        )
    age, (low, high) = period / math.sqrt(height), JONSWAP_RANGE
    if gamma > 1.0 and not low <= age <= high:
        yield f"JONSWAP is stated for Tp / sqrt(Hs) from {low:g} to {high:g} s/m^0.5; here it is {age:.3g}."
    if gamma > LARGEST_GAMMA:
        yield f"Seas have a peak factor gamma of {LARGEST_GAMMA:g} at most; here it is {gamma:g}."


def _of(depth: float) -> str:
    return "deep water" if math.isinf(depth) else f"{depth:g} m of water"
