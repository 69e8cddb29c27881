"""A smooth start: the factor by which the water's motion is taken while a run begins."""

from __future__ import annotations


def ramp(time: float, duration: float) -> float:
    """Factor from 0 at time 0 to 1 from `duration` on, both in s.

    x^3 (10 - 15 x + 6 x^2) of x = time / duration: slope and curvature are zero at both ends, so that neither the
    velocity nor the acceleration of the water has a jump or a kink. It is 1/2 half way, and its largest slope, there,
    is 1.875 / duration.
    """
    x = min(max(time / duration, 0.0), 1.0)
    return x**3 * (10.0 + x * (-15.0 + 6.0 * x))
