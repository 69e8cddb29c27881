"""The error estimate of Verner's pair; validation/ has motion against closed forms, and the steppers' orders."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from steppers import PULL, mass_between_springs


def test_error_estimate_of_the_pair_is_of_order_five():
    """The estimate of one step goes as h^6, the order 5 solution's: a tolerance 64 times tighter, twice the steps."""
    steps, errors = [], []
    for power in (4, 5, 6):
        tolerance = 64.0**-power
        result = fyke.simulate(
            mass_between_springs(),
            duration=20 * np.pi,
            every=20 * np.pi,
            stepper=fyke.Verner(tolerance, tolerance),
        )
        steps.append(result.outcome.iterations)
        errors.append(abs(result.position[-1, 1, 0] - PULL))
    assert np.array(steps[1:]) / steps[:-1] == pytest.approx(2.0, rel=0.02)
    assert np.all(np.array(errors) < 64.0 ** -np.array([4, 5, 6]))
