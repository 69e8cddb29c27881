"""Drag of a long cylinder across the flow, on d l, as curves of Re = d V / nu."""

from __future__ import annotations

from typing import Any

import numpy as np

from .joints import BAND, Curve, joined, level, log_polynomial, powers

_GAMMA_LESS_HALF = 0.077215665  # Euler's constant less 1/2, of the Lamb-Oseen expansion


def _lamb(re: Any) -> Any:
    s = np.log(8.0 / re) - _GAMMA_LESS_HALF
    return 8.0 * np.pi / (re * s) * (1.0 - 0.87 / s**2)


def _lamb_slope(re: Any) -> Any:
    s = np.log(8.0 / re) - _GAMMA_LESS_HALF
    return 8.0 * np.pi / re**2 * (-1.0 / s + 1.0 / s**2 + 0.87 / s**3 - 2.61 / s**4)


CHOO_CASARELLA = joined(
    [
        Curve(_lamb, _lamb_slope),
        powers((1.45, 0.0), (8.55, -0.9)),
        powers((1.1, 0.0), (4.0, -0.5)),
        powers((3.41e-6 * 5.78e5, 0.0), (-3.41e-6, 1.0)),
        Curve(
            lambda re: 0.401 * (1.0 - np.exp(-re / 5.99e5)), lambda re: 0.401 / 5.99e5 * np.exp(-re / 5.99e5)
        ),
    ],
    [1.0, 30.0, 2.33e5, 4.92e5],
)

TAKAGI = joined([powers((10.0**0.7, -0.3)), level(1.2)], [200.0])

WHITE = joined([powers((1.0, 0.0), (10.0, -2.0 / 3.0))])


def _hollow(re: Any) -> Any:
    return 4e-4 * re / (1.0 + 3.64e-7 * re**2)


def _hollow_slope(re: Any) -> Any:
    return 4e-4 * (1.0 - 3.64e-7 * re**2) / (1.0 + 3.64e-7 * re**2) ** 2


_BRAUER_POWERS = powers((6.8, -0.89), (1.96, -0.5), (1.18, 0.0))
SUCKER_BRAUER = joined(
    [
        Curve(
            lambda re: _BRAUER_POWERS.value(re) - _hollow(re),
            lambda re: _BRAUER_POWERS.slope(re) - _hollow_slope(re),
        )
    ]
)


def _cheng(re: Any) -> Any:
    return 11.0 * re**-0.75 - 0.9 * np.expm1(-1000.0 / re) - 1.2 * np.expm1(-((re / 4500.0) ** 0.7))


def _cheng_slope(re: Any) -> Any:
    wide = (re / 4500.0) ** 0.7
    return -8.25 * re**-1.75 - 900.0 / re**2 * np.exp(-1000.0 / re) + 0.84 * wide / re * np.exp(-wide)


CHENG = joined([Curve(_cheng, _cheng_slope)])

KF_LOW, KF_HIGH = 10.0**1.5, 1e4  # between them the polynomial holds
_KF_TOP = 7.0
# What continues it below is not Kristiansen and Faltinsen's. The joints lie outside their range by one band, so that
# within it the polynomial is as published; the cap of 7 is met where the power law itself reaches it.
_KF_POLYNOMIAL = log_polynomial(
    -78.46675, 254.73873, -327.8864, 223.64577, -87.92234, 20.00769, -2.44894, 0.12479
)
KRISTIANSEN_FALTINSEN = joined(
    [
        level(_KF_TOP),
        powers((1.45, 0.0), (8.55, -0.9)),
        _KF_POLYNOMIAL,
        level(float(_KF_POLYNOMIAL.value(KF_HIGH))),
    ],
    [(8.55 / (_KF_TOP - 1.45)) ** (1.0 / 0.9), KF_LOW / BAND, KF_HIGH * BAND],
)
