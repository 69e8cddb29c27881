"""Verner's pair: order conditions in exact fractions, orders measured, stability limits."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from math import prod

import numpy as np
import pytest

import fyke
from fyke.solve.verner import B5, B6, STAGES, A, C, growth, stable_step

# A rooted tree is the sorted tuple of its root's subtrees; () is the single node.
Tree = tuple


@cache
def trees(order: int) -> tuple[Tree, ...]:
    """All rooted trees with so many nodes."""
    found = set()

    def grow(left: int, largest: int, parts: tuple[Tree, ...]) -> None:
        if left == 0:
            found.add(tuple(sorted(parts)))
        for size in range(1, min(left, largest) + 1):
            for tree in trees(size):
                grow(left - size, size, (*parts, tree))

    grow(order - 1, order - 1, ())
    return tuple(sorted(found))


def nodes(tree: Tree) -> int:
    return 1 + sum(nodes(sub) for sub in tree)


def density(tree: Tree) -> int:
    return nodes(tree) * prod(density(sub) for sub in tree)


def weights(tree: Tree) -> list[Fraction]:
    """Product over the subtrees of A times their weights, one value for each stage."""
    out = [Fraction(1)] * STAGES
    for sub in tree:
        inner = weights(sub)
        out = [
            o * sum((a * w for a, w in zip(row, inner, strict=False)), Fraction(0))
            for o, row in zip(out, A, strict=True)
        ]
    return out


def error(b: tuple[Fraction, ...], tree: Tree) -> Fraction:
    return sum((x * y for x, y in zip(b, weights(tree), strict=True)), Fraction(0)) - Fraction(
        1, density(tree)
    )


def test_numbers_of_trees():
    """1, 1, 2, 4, 9, 20, 48: Butcher's count."""
    assert [len(trees(order)) for order in range(1, 8)] == [1, 1, 2, 4, 9, 20, 48]


def test_rows_add_up():
    assert [sum(row, Fraction(0)) for row in A] == list(C)


@pytest.mark.parametrize(("b", "order"), [(B6, 6), (B5, 5)])
def test_order_conditions_hold_exactly_and_no_further(b, order):
    for size in range(1, order + 1):
        assert all(error(b, tree) == 0 for tree in trees(size))
    assert any(error(b, tree) != 0 for tree in trees(order + 1))


def test_principal_error_norms():
    """2.072e-3 and 6.956e-4, with the symmetry of each tree as divisor."""

    def symmetry(tree: Tree) -> int:
        factor = 1
        for sub in set(tree):
            count = tree.count(sub)
            factor *= symmetry(sub) ** count * prod(range(1, count + 1))
        return factor

    def norm(b, order):
        return sum(float(error(b, tree) / symmetry(tree)) ** 2 for tree in trees(order)) ** 0.5

    assert norm(B6, 7) == pytest.approx(2.072e-3, rel=1e-3)
    assert norm(B5, 6) == pytest.approx(6.956e-4, rel=1e-3)


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


@pytest.mark.parametrize(
    ("zeta", "limit"),
    [(0.0, 1.307), (0.01, 2.490), (0.05, 3.059), (0.1, 3.372), (0.3, 3.945), (0.7, 3.958), (1.0, 4.065)],
)
def test_stability_limits_of_one_mode(zeta, limit):
    """Largest h omega of a mode of this damping ratio, as tabled for the DVERK pair."""
    rate = -zeta + 1j * np.sqrt(1 - zeta**2)
    inside = growth(np.linspace(0.01, limit - 1e-3, 500) * rate)
    assert np.all(inside <= 1 + 1e-9)
    assert growth(np.array([(limit + 2e-3) * rate]))[0] > 1


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
