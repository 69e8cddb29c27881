"""Statics against a convex program.

Under dead loads the equilibrium is the one minimum of

    sum 1/2 k s^2 - sum load . x    subject to    |x_b - x_a| <= l0 + s  for every bar,

a second-order cone program whose duals are the tensions. Clarabel solves it without any code of fyke.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

import fyke
from fyke.study import Found
from panels import NYLON, framed, settled

SQUARE = {"mesh": "square", "size": (0.216, 0.216)}
# Level, a panel held at its corners hangs like a hammock; upright in still water its minimum would be too flat for
# a program solved to 1e-13: 3e-6 m. So would be a curtain of diamonds: 2e-6 m.
HAMMOCK = SQUARE | {"fixed": "corners", "normal": (0.0, 0.0, 1.0)}
CURTAIN = {"fixed": "top"}
STILL, FLOW, OBLIQUE = (0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.3, 0.2, 0.0)
# Panel, current (m/s), weight on each of the lowest knots (N), and whether three twines of 40 MPa to 40 GPa are mixed.
CASES = {
    "diamonds in still water": ({}, STILL, 0.0, False),
    "squares in still water": (SQUARE, STILL, 0.0, False),
    "hammock held at its corners": (HAMMOCK, STILL, 0.0, False),
    "diamonds in a current": ({}, FLOW, 0.0, False),
    "squares in a current": (SQUARE, FLOW, 0.0, False),
    "squares held at their corners in a current": (SQUARE | {"fixed": "corners"}, FLOW, 0.0, False),
    "diamonds held at their top in a current": (CURTAIN, FLOW, 0.0, False),
    "square curtain with weights in still water": (CURTAIN | SQUARE, STILL, 0.05, False),
    "curtain with weights in a current": (CURTAIN, FLOW, 0.05, False),
    "square curtain with weights, oblique current": (CURTAIN | SQUARE, OBLIQUE, 0.05, False),
    "mixed twines in still water": ({}, STILL, 0.0, True),
    "mixed twines, squares, oblique current": (SQUARE, (0.5, 0.2, 0.0), 0.0, True),
    "mixed twines, held at the corners": (SQUARE | {"fixed": "corners"}, FLOW, 0.0, True),
    "curtain of mixed twines, heavy weights": (CURTAIN, (1.0, 0.0, 0.0), 5.0, True),
}
SPANS = (0.5, 0.8, 0.99)


def program_minimum(net: fyke.Net, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (n, 3) m and tensions (m,) N of the program's minimum.

    Unit of length: a bar; of force: the mean load; of elongation: the one that makes 1/2 k s^2 plain 1/2 s^2.
    """
    import clarabel

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


def chain(span: float) -> fyke.System:
    """A chain that sags between two ends so far apart, pushed aside at one knot."""
    points = np.column_stack([np.linspace(0.0, span, 41), np.zeros(41), np.zeros(41)])
    load = np.zeros((41, 3))
    load[13] = [0.0, 2e-3, -5e-3]
    return fyke.make_system(fyke.line(NYLON, points, 0.025, knot_diameter=3.5e-3, load=load))


def systems():
    for name, (panel, current, weight, mixed) in CASES.items():
        yield name, fyke.make_system(made_of(framed(**panel).net, weight, mixed), current=current)
    for span in SPANS:
        yield f"chain over {span:g} of its length", chain(span)


def measure(tables):
    for name, system in systems():
        result = settled(system, tolerance=1e-11)
        # The water's load in fyke's own equilibrium, frozen, is to make the same shape again.
        x, tension = program_minimum(system.net, system.elements.weight + result.water_force[-1])
        largest = tension.max()
        if not largest > 0.0:
            raise RuntimeError(f"{name}: the program has no tension")
        yield Found("place", np.abs(result.position[-1] - x).max(), case=name)
        yield Found("tension", np.abs(result.tension[-1] - tension).max() / largest, case=name)
