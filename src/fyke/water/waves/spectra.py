"""Spectra of the surface elevation of irregular seas, by angular frequency."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

# Relative width of the peak below and above it: K. Hasselmann et al., Measurements of wind-wave growth and swell decay
# during the Joint North Sea Wave Project, 1973, as cited in public code.
WIDTH_BELOW, WIDTH_ABOVE = 0.07, 0.09
# Frequencies over that of the peak at which spectra are summed: the ends leave out 2e-6 of the energy.
_LOWEST, _HIGHEST, _GRID = 0.3, 30.0, 40_001


def pierson_moskowitz(omega: ArrayLike, significant_height: float, peak_period: float) -> Array:
    """Return S (m2 s) at angular frequencies (rad/s): (5/16) Hs^2 w_p^4 w^-5 exp(-1.25 (w/w_p)^-4).

    The form with two parameters, which holds Hs for any peak period; the integral over omega is Hs^2 / 16.
    """
    peak = 2.0 * np.pi / peak_period
    x = np.asarray(omega, dtype=float) / peak
    return np.asarray(0.3125 * significant_height**2 / peak * x**-5.0 * np.exp(-1.25 * x**-4.0))


def jonswap(omega: ArrayLike, significant_height: float, peak_period: float, gamma: float) -> Array:
    """Return S (m2 s): (1 - 0.287 ln gamma) S_PM gamma^exp(-((w/w_p - 1) / sigma)^2 / 2).

    gamma: peak factor, 1 for Pierson and Moskowitz. The first factor is a fit that keeps 4 sqrt(m0) within 1 % of Hs.
    """
    x = np.asarray(omega, dtype=float) * peak_period / (2.0 * np.pi)
    width = np.where(x <= 1.0, WIDTH_BELOW, WIDTH_ABOVE)
    lift = gamma ** np.exp(-0.5 * ((x - 1.0) / width) ** 2)
    return np.asarray(
        (1.0 - 0.287 * math.log(gamma)) * pierson_moskowitz(omega, significant_height, peak_period) * lift
    )


def default_gamma(significant_height: float, peak_period: float) -> float:
    """Return the peak factor by T_p / sqrt(H_s): 5 up to 3.6, exp(5.75 - 1.15 T_p / sqrt(H_s)), 1 from 5.

    DNV-RP-C205 as cited by public code.
    """
    age = peak_period / math.sqrt(significant_height)
    if age <= 3.6:
        return 5.0
    return 1.0 if age >= 5.0 else math.exp(5.75 - 1.15 * age)


def equal_energy_frequencies(peak_period: float, gamma: float, count: int) -> Array:
    """Return angular frequencies (count,) rad/s, rising, one for each of so many equal shares of the energy.

    Each is the root of the mean square over its share, so that not only the elevation but also its rate, and with it
    the velocity at the surface of deep water, has the variance of the spectrum.
    """
    peak = 2.0 * np.pi / peak_period
    omega = np.geomspace(_LOWEST, _HIGHEST, _GRID) * peak
    energy = jonswap(omega, 1.0, peak_period, gamma)
    below, squares = _summed(energy, omega), _summed(energy * omega**2, omega)
    shares = np.interp(np.linspace(0.0, below[-1], count + 1), below, squares)
    return np.asarray(np.sqrt(np.diff(shares) * count / below[-1]))


def _summed(values: Array, omega: Array) -> Array:
    """Integral of values from the first of the frequencies to each of them, by the trapezoidal rule."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(omega))])
