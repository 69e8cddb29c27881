"""Statics against a convex program: under dead loads the equilibrium is the one minimum of

    sum 1/2 k s^2 - sum load . x    subject to    |x_b - x_a| <= l0 + s  for every bar,

a second-order cone program whose duals are the tensions. Clarabel solves it without any code of fyke.
"""

from __future__ import annotations

from dataclasses import replace

import clarabel
import numpy as np
import pytest
import scipy.sparse as sp

import fyke


def program_minimum(net: fyke.Net, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (n, 3) m and tensions (m,) N of the program's minimum.

    Unit of length: a bar; of force: the mean load; of elongation: the one that makes 1/2 k s^2 plain 1/2 s^2.
    """
    n, m = net.knot_count, net.bar_count
    modulus = np.array([t.law.youngs_modulus * t.area for t in net.twines])[net.twine_of_bar]
    stiffness = modulus / net.rest_length
    bar = net.rest_length.mean()
    force = np.linalg.norm(load[~net.fixed], axis=1).mean()
    elongation = np.sqrt(force * bar / stiffness) / bar
    free = np.flatnonzero(~net.fixed)
    unknown = np.full(n, -1)
    unknown[free] = np.arange(free.size)
    held = np.where(net.fixed[:, None], net.positions, 0.0) / bar
    # Rows 4 e .. 4 e + 3 are (l0 + s, x_b - x_a) = b - A z.
    rows, columns, values = [4 * np.arange(m)], [3 * free.size + np.arange(m)], [-elongation]
    for end, sign in ((net.bars[:, 0], 1.0), (net.bars[:, 1], -1.0)):
        moves = np.flatnonzero(~net.fixed[end])
        for q in range(3):
            rows.append(4 * moves + 1 + q)
            columns.append(3 * unknown[end[moves]] + q)
            values.append(np.full(moves.size, sign))
    b = np.column_stack([net.rest_length / bar, held[net.bars[:, 1]] - held[net.bars[:, 0]]])
    a = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    size = 3 * free.size + m
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-13
    # Where rounding forbids so much, what is reached is good enough to be compared.
    settings.reduced_tol_gap_abs = settings.reduced_tol_gap_rel = settings.reduced_tol_feas = 1e-9
    solution = clarabel.DefaultSolver(
        sp.diags(np.r_[np.zeros(3 * free.size), np.ones(m)], format="csc"),
        np.r_[-load[free].ravel() / force, np.zeros(m)],
        sp.csc_matrix(a, shape=(4 * m, size)),
        b.ravel(),
        [clarabel.SecondOrderConeT(4)] * m,
        settings,
    ).solve()
    assert str(solution.status) in ("Solved", "AlmostSolved")
    x = net.positions.copy()
    x[free] = bar * np.array(solution.x[: 3 * free.size]).reshape(-1, 3)
    return x, force * np.array(solution.z)[::4]


def agree(system: fyke.System, load: np.ndarray) -> None:
    """Positions within 1e-6 m, tensions within 1e-4 of the largest."""
    result = fyke.solve_static(system, tolerance=1e-11)
    assert result.outcome.ok
    x, tension = program_minimum(system.net, load)
    assert np.abs(result.position[-1] - x).max() < 1e-6
    assert tension.max() > 0.0
    assert np.abs(result.tension[-1] - tension).max() < 1e-4 * tension.max()


SQUARE = {"mesh": "square", "size": (0.216, 0.216)}
# Level, a panel held at its corners hangs like a hammock; upright in still water its minimum would be too flat for
# a program solved to 1e-13: 3e-6 m.
HAMMOCK = SQUARE | {"fixed": "corners", "normal": (0.0, 0.0, 1.0)}


@pytest.mark.parametrize("panel", [{}, SQUARE, HAMMOCK], ids=["diamond", "square", "held at its corners"])
def test_panel_in_still_water(framed, panel):
    system = framed(current=(0.0, 0.0, 0.0), **panel)
    agree(system, system.elements.weight)


@pytest.mark.parametrize(
    "panel",
    [{}, SQUARE, SQUARE | {"fixed": "corners"}, {"fixed": "top"}],
    ids=["diamond", "square", "held at its corners", "held at its top"],
)
def test_panel_in_a_current(framed, panel):
    """The water's load in fyke's own equilibrium, frozen, makes the same shape again."""
    system = framed(**panel)
    water = fyke.solve_static(system, tolerance=1e-11).water_force[-1]
    agree(system, system.elements.weight + water)


def made_of(net: fyke.Net, weight: float, mixed: bool) -> fyke.Net:
    """Net with a weight (N) on each of its lowest knots, each bar of one of three twines if mixed."""
    load = net.load.copy()
    load[net.positions[:, 2] < net.positions[:, 2].min() + 1e-9, 2] -= weight
    net = replace(net, load=load)
    if not mixed:
        return net
    soft = fyke.Twine("soft", 1140.0, 2.5e-3, fyke.LinearLaw(4e7))
    stiff = fyke.Twine("stiff", 975.0, 1e-3, fyke.LinearLaw(4e10))
    kinds = np.random.default_rng(0).integers(0, 3, net.bar_count)
    return replace(net, twines=(*net.twines, soft, stiff), twine_of_bar=kinds)


CURTAIN = {"fixed": "top"}


# A curtain of diamonds in still water would be too flat a minimum: 2e-6 m.
@pytest.mark.parametrize(
    ("panel", "current", "weight", "mixed"),
    [
        pytest.param(CURTAIN | SQUARE, (0.0, 0.0, 0.0), 0.05, False, id="square curtain in still water"),
        pytest.param(CURTAIN, (0.5, 0.0, 0.0), 0.05, False, id="curtain in a current"),
        pytest.param(CURTAIN | SQUARE, (0.3, 0.2, 0.0), 0.05, False, id="square curtain, oblique current"),
        pytest.param({}, (0.0, 0.0, 0.0), 0.0, True, id="mixed twines in still water"),
        pytest.param(SQUARE, (0.5, 0.2, 0.0), 0.0, True, id="mixed twines, square, oblique current"),
        pytest.param(SQUARE | {"fixed": "corners"}, (0.5, 0.0, 0.0), 0.0, True, id="mixed, held at corners"),
        pytest.param(CURTAIN, (1.0, 0.0, 0.0), 5.0, True, id="curtain of mixed twines, heavy weights"),
    ],
)
def test_curtains_with_weights_and_mixed_twines(framed, panel, current, weight, mixed):
    """Weights on the lowest knots; moduli from 40 MPa to 40 GPa, bar by bar at random; the water's load frozen."""
    net = made_of(framed(**panel).net, weight, mixed)
    system = fyke.make_system(net, current=current)
    water = fyke.solve_static(system, tolerance=1e-11).water_force[-1] if any(current) else 0.0
    agree(system, system.elements.weight + water)


@pytest.mark.parametrize("span", [0.5, 0.8, 0.99])
def test_hanging_chain(nylon, span):
    points = np.column_stack([np.linspace(0.0, span, 41), np.zeros(41), np.zeros(41)])
    load = np.zeros((41, 3))
    load[13] = [0.0, 2e-3, -5e-3]
    system = fyke.make_system(fyke.line(nylon, points, 0.025, knot_diameter=3.5e-3, load=load))
    agree(system, system.elements.weight)
