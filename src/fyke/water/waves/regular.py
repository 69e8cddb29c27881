"""Regular waves: Airy's linear ones, and Stokes' of second order."""

from __future__ import annotations

import math

from . import limits
from .dispersion import wavenumber
from .sea import Named, Stretching, Waves, harmonics, heading

GRAVITY = 9.81  # m/s2, as in a case file
AIRY = "G.B. Airy, Tides and waves, 1845; read in public codes that agree"
STOKES = "G.G. Stokes, On the theory of oscillatory waves, 1847; textbook formulas, the paper was not opened"


def airy(
    height: float,
    period: float,
    *,
    direction: float = 0.0,
    phase: float = 0.0,
    depth: float = math.inf,
    gravity: float = GRAVITY,
    stretching: Stretching = "wheeler",
    ramp: float = 0.0,
) -> Waves:
    """Return linear waves of a height (m) and a period (s) that go in a direction (rad, from +x turning to +y).

    With the phase theta = k x' - omega t + phase (rad), omega^2 = g k tanh kh:
        eta = (H/2) cos theta, u = (pi H/T) cosh k(z+h)/sinh kh cos theta, w = (pi H/T) sinh k(z+h)/sinh kh sin theta.
    G.B. Airy, Tides and waves, 1845; checked against computed amplitudes. ValueError for waves that break.
    """
    limits.refuse_breaking(height, period, depth, gravity)
    omega = 2.0 * math.pi / period
    one = harmonics(
        wavenumber=wavenumber(omega, depth, gravity),
        omega=omega,
        direction=direction,
        phase=phase,
        amplitude=0.5 * height,
        speed=0.5 * height * omega,
        depth=depth,
    )
    told = tuple(limits.of_airy(height, period, depth, gravity))
    named = Named("airy", height, period, True, AIRY)
    return Waves(one, heading(direction), depth, stretching, ramp, told, named)


def stokes2(
    height: float,
    period: float,
    *,
    direction: float = 0.0,
    phase: float = 0.0,
    depth: float = math.inf,
    gravity: float = GRAVITY,
    ramp: float = 0.0,
) -> Waves:
    """Return waves of Stokes' second order; arguments are those of `airy`.

    To those of Airy come, at twice the phase,
        eta_2 = (pi H^2 / 8 L) cosh kh (2 + cosh 2kh) / sinh^3 kh cos 2 theta,
        u_2 = (3/4) (pi H/T) (pi H/L) cosh 2k(z+h) / sinh^4 kh cos 2 theta, and w_2 with sinh and sin.
    The formulas hold up to the surface as they stand, without stretching. G.G. Stokes, On the theory of oscillatory
    waves, 1847; the residuals at the surface fall 8 times when the height is halved. ValueError for waves that break.
    """
    limits.refuse_breaking(height, period, depth, gravity)
    omega = 2.0 * math.pi / period
    k = float(wavenumber(omega, depth, gravity))
    mirror = math.exp(-2.0 * k * depth)
    # U_2 cosh 2k(z+h) / sinh 2kh: sinh 2kh / sinh^4 kh is 8 M (1 + M) / (1 - M)^3.
    steep = 0.75 * (0.5 * height * omega) * (0.5 * k * height)
    second = steep * 8.0 * mirror * (1.0 + mirror) / (1.0 - mirror) ** 3
    crest = limits.second_order_crest(height, period, depth, gravity)
    both = harmonics(
        wavenumber=[k, 2.0 * k],
        omega=[omega, 2.0 * omega],
        direction=direction,
        phase=[phase, 2.0 * phase],
        amplitude=[0.5 * height, crest],
        speed=[0.5 * height * omega, second],
        depth=depth,
    )
    told = tuple(limits.of_stokes(height, period, depth, gravity))
    named = Named("stokes2", height, period, True, STOKES)
    return Waves(both, heading(direction), depth, "formula", ramp, told, named)
