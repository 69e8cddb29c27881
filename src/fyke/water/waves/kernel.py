"""The kernel that adds up harmonics at points, with sines, cosines and powers of two that the compiler vectorises.

Library sines are called one number at a time. Those here are polynomials without a branch: phases come in turns, so
that taking whole and half turns off is exact. Errors, measured over 1e5 numbers: 5e-16 of the amplitude for sine and
cosine, 2e-16 relative for powers of two.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit, types
from numba.extending import intrinsic

# As the kernels of forces: NaN and infinity keep their meaning, other relaxations let the compiler vectorise sums.
OPTIONS: dict[str, Any] = {
    "cache": True,
    "fastmath": {"contract", "arcp", "nsz", "reassoc"},
    "error_model": "numpy",
    "nogil": True,
}

# Chebyshev interpolation in 40 digits, lowest power first: sin(2 pi f) / f and cos(2 pi f) of f^2 in [0, 1/16], and
# 2^f of f in [-1/2, 1/2].
SINE = (
    6.283185307179585,
    -41.341702240398284,
    81.60524927557977,
    -76.70585968962867,
    42.05868995395094,
    -15.09450614073429,
    3.817365633469135,
    -0.6925067010720717,
)
COSINE = (
    1.0,
    -19.739208802178705,
    64.93939402266395,
    -85.45681720598061,
    60.24464131316041,
    -26.426254066690255,
    7.903462492085097,
    -1.7132184107005932,
    0.2719458494999813,
)
POWER = (
    1.0,
    0.6931471805599453,
    0.24022650695910158,
    0.055504108664821625,
    0.009618129107587256,
    0.001333355814640647,
    0.00015403530463724353,
    1.5252733841556773e-05,
    1.3215432535912375e-06,
    1.0178057087733941e-07,
    7.074194297288521e-09,
    4.4558179083360645e-10,
)
LEAST_POWER = -900.0  # 2^-900 is nothing here, and its inverse is still finite
_BIAS, _MANTISSA = 1023, 52  # of the exponent of a float64


def _bits_of_power(context, exponent):
    """2^n of an int64: its bits, as a float64."""

    def code(context, builder, signature, arguments):
        whole = arguments[0].type
        bits = builder.shl(builder.add(arguments[0], whole(_BIAS)), whole(_MANTISSA))
        return builder.bitcast(bits, context.get_value_type(types.float64))

    return types.float64(types.int64), code


_whole_power_of_two: Any = intrinsic(_bits_of_power)


@njit(inline="always", **OPTIONS)
def cosine_and_sine(turns):
    """Cosine and sine of an angle in turns; half turns are taken off, and change the sign of both."""
    half = np.rint(2.0 * turns)
    f = turns - 0.5 * half
    sign = 1.0 - 2.0 * abs(half - 2.0 * np.rint(0.5 * half))
    g = f * f
    s = SINE[4] + g * (SINE[5] + g * (SINE[6] + g * SINE[7]))
    s = f * (SINE[0] + g * (SINE[1] + g * (SINE[2] + g * (SINE[3] + g * s))))
    c = COSINE[5] + g * (COSINE[6] + g * (COSINE[7] + g * COSINE[8]))
    c = COSINE[0] + g * (COSINE[1] + g * (COSINE[2] + g * (COSINE[3] + g * (COSINE[4] + g * c))))
    return sign * c, sign * s


@njit(inline="always", **OPTIONS)
def power_of_two(y):
    """2^y of y up to 1000; 2^LEAST_POWER below it."""
    y = max(y, LEAST_POWER)
    whole = np.rint(y)
    f = y - whole
    p = POWER[8] + f * (POWER[9] + f * (POWER[10] + f * POWER[11]))
    p = POWER[4] + f * (POWER[5] + f * (POWER[6] + f * (POWER[7] + f * p)))
    p = POWER[0] + f * (POWER[1] + f * (POWER[2] + f * (POWER[3] + f * p)))
    # By way of 32 bits: not every processor turns four float64 into int64 at once.
    return p * _whole_power_of_two(np.int64(np.int32(whole)))


@njit(**OPTIONS)
def _phases(x, y, sea, turns, cosine, sine):
    """Put cosines and sines of the phases at x, y into arrays (c,); return the elevation (m)."""
    turns_x, turns_y, amplitude = sea.turns_x, sea.turns_y, sea.amplitude
    eta = 0.0
    for j in range(turns.shape[0]):
        cosine[j], sine[j] = cosine_and_sine(turns_x[j] * x + turns_y[j] * y + turns[j])
        eta += amplitude[j] * cosine[j]
    return eta


@njit(**OPTIONS)
def _motion_at(z, sea, cosine, sine):
    """Velocity and acceleration at a depth, by the phases: six components."""
    decay, mirror = sea.decay, sea.mirror
    u, v, w = sea.velocity[0], sea.velocity[1], sea.velocity[2]
    du, dv, dw = sea.acceleration[0], sea.acceleration[1], sea.acceleration[2]
    ux = uy = uz = ax = ay = az = 0.0
    for j in range(cosine.shape[0]):
        down = power_of_two(decay[j] * z)
        up = mirror[j] / down
        across = (down + up) * cosine[j]
        turned = (down + up) * sine[j]
        ux += u[j] * across
        uy += v[j] * across
        uz += w[j] * ((down - up) * sine[j])
        ax += du[j] * turned
        ay += dv[j] * turned
        az -= dw[j] * ((down - up) * cosine[j])
    return ux, uy, uz, ax, ay, az


@njit(**OPTIONS)
def motion_of(points, sea, turns, surface, growth, velocity, acceleration, elevation):
    """Motion at points (n, 3) m into velocity (n, 3) m/s, acceleration (n, 3) m/s2 and elevation (n,) m.

    sea: Harmonics; turns: (c,) phases at x = y = 0; surface: depth and its inverse, how far depths follow the surface
    (1 Wheeler, 0 not), highest depth (m); growth: factor and its derivative in time (1/s).
    """
    depth, inverse_depth, follow, highest = surface
    factor, slope = growth
    cosine, sine = np.empty(turns.shape[0]), np.empty(turns.shape[0])
    for i in range(points.shape[0]):
        z = points[i, 2]
        z = max(z, -depth)
        eta = factor * _phases(points[i, 0], points[i, 1], sea, turns, cosine, sine)
        elevation[i] = eta
        if z > eta or eta <= -depth:
            velocity[i, :] = 0.0
            acceleration[i, :] = 0.0
            continue
        z = (z - follow * eta) / (1.0 + follow * eta * inverse_depth)
        z = min(z, highest)
        ux, uy, uz, ax, ay, az = _motion_at(z, sea, cosine, sine)
        velocity[i, 0], velocity[i, 1], velocity[i, 2] = factor * ux, factor * uy, factor * uz
        acceleration[i, 0] = factor * ax + slope * ux
        acceleration[i, 1] = factor * ay + slope * uy
        acceleration[i, 2] = factor * az + slope * uz


@njit(**OPTIONS)
def elevation_of(points, sea, turns, factor, elevation):
    """Elevation (n,) m of the surface at the x and y of points (n, 3) m, times a factor; else as `motion_of`."""
    turns_x, turns_y, amplitude = sea.turns_x, sea.turns_y, sea.amplitude
    for i in range(points.shape[0]):
        x, y, eta = points[i, 0], points[i, 1], 0.0
        for j in range(turns.shape[0]):
            eta += amplitude[j] * cosine_and_sine(turns_x[j] * x + turns_y[j] * y + turns[j])[0]
        elevation[i] = factor * eta
