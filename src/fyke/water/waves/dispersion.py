"""The wavenumber of small waves of a given frequency over a level bed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

# From the start below, three steps of Newton leave nothing but rounding at any depth; one more is for safety.
_STEPS = 4


def wavenumber(omega: ArrayLike, depth: float, gravity: float) -> Array:
    """Return k (1/m) that solves omega^2 = g k tanh(k h), of the shape of omega.

    omega: angular frequency, rad/s, above 0; depth: h, m, infinite for deep water; gravity: m/s2. Newton's method from
    k = (omega^2 / g) / sqrt(tanh(omega^2 h / g)), which is exact in deep and in shallow water.
    """
    deep = np.square(np.asarray(omega, dtype=float)) / gravity
    if math.isinf(depth):
        return np.asarray(deep)
    k = deep / np.sqrt(np.tanh(deep * depth))
    for _ in range(_STEPS):
        t = np.tanh(k * depth)
        k = k - (k * t - deep) / (t + k * depth * (1.0 - t * t))
    return np.asarray(k)
