"""Verner's pair: orders measured, stable steps of nets; validation/verner_conditions.toml has its conditions."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from fyke.solve.verner import B5, B6, STAGES, A, growth, stable_step
from verner_conditions import trees


def test_numbers_of_trees():
    """1, 1, 2, 4, 9, 20, 48: Butcher's count."""
    assert [len(trees(order)) for order in range(1, 8)] == [1, 1, 2, 4, 9, 20, 48]


def kepler(y):
    r3 = (y[0] ** 2 + y[1] ** 2) ** 1.5
    return np.array([y[2], y[3], -y[0] / r3, -y[1] / r3])


def integrate(b, steps, end=2.0):
    """Fixed steps of the tableau in extended precision on an orbit of eccentricity 0.3."""
    a = np.array(
        [[np.longdouble(x.numerator) / x.denominator for x in row] + [0] * (STAGES - len(row)) for row in A]
    )
    w = np.array([np.longdouble(x.numerator) / x.denominator for x in b])
    y = np.array([0.7, 0.0, 0.0, (1.3 / 0.7) ** 0.5], dtype=np.longdouble)
    h = np.longdouble(end) / steps
    for _ in range(steps):
        k = np.zeros((STAGES, 4), dtype=np.longdouble)
        for s in range(STAGES):
            k[s] = kepler(y + h * a[s] @ k)
        y = y + h * w @ k
    return y


@pytest.mark.parametrize(("b", "order"), [(B6, 6), (B5, 5)])
def test_orders_measured(b, order):
    exact = integrate(B6, 1280)
    errors = [float(np.abs(integrate(b, steps) - exact).max()) for steps in (40, 80, 160)]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(slopes - order) < 0.15), slopes


def test_stable_step_of_a_net():
    assert stable_step(2e4, 0.0) * 2e4 == pytest.approx(1.307, abs=1e-3)
    # The most damped mode is not the only one: no mode below it may be unstable either.
    damped = stable_step(2e4, 2e-5) * 2e4
    modes = np.linspace(0.001, 1.0, 1000)
    zeta = 0.5 * 2e-5 * 2e4 * modes
    assert np.all(growth(damped * modes * (-zeta + 1j * np.sqrt(1 - zeta**2))) <= 1 + 1e-6)
    assert stable_step(0.0, 0.0) == np.inf


def test_a_step_above_the_bound_is_reduced_with_a_warning(framed):
    system = framed()
    result = fyke.simulate(system, duration=0.002, stepper=fyke.Verner(max_step=1e-3))
    (warning,) = result.outcome.warnings
    assert "max_step 0.001 s is above the stability bound" in warning
    assert result.outcome.iterations >= 0.002 / fyke.Verner().stability_bound(system, system.at_rest())
    assert fyke.simulate(system, duration=0.002, stepper=fyke.Verner(max_step=1e-5)).outcome.warnings == ()
