"""Equilibrium of the panel by each tool: a function sets it up and hands back the work to be timed."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from peer_panel import (
    BAR,
    CURRENT,
    SPHERE,
    STIFFNESS,
    Answer,
    Array,
    Panel,
    Work,
    bar_forces,
    fyke_system,
    relax,
    tangents,
    unbalanced,
)

import fyke

AS_BUILT, BULGED = "start as built", "start bulged by hand"


def fyke_static(panel: Panel) -> Work:
    system = fyke_system(panel)
    fyke.solve_static(system, max_iterations=12)

    def work() -> Answer:
        frame = fyke.solve_static(system).frame()
        return frame.position, frame.velocity

    return work


def relaxation(panel: Panel, keep: float, tolerance: float) -> Work:
    def work(most: int = 10**7) -> Answer:
        x = panel.start.copy()
        relax(x, panel.free, panel.bars, panel.weight, keep, tolerance, most)
        return x, np.zeros_like(x)

    work(1)
    return work


def scipy_static(panel: Panel, method: str, start: str) -> Work:
    """General solvers of equations, from the panel as built or from a bulge drawn by hand; exact Jacobian if asked."""
    from scipy.optimize import least_squares, root

    begin = panel.start if start == AS_BUILT else panel.bulged()
    still = np.zeros_like(begin)
    unbalanced(panel, begin)

    def force(q: Array) -> Array:
        return unbalanced(panel, panel.whole(q))[: panel.free].ravel()

    def jacobian(q: Array) -> sp.csc_matrix:
        return tangents(panel, panel.whole(q), still)[0]

    def work() -> Answer:
        q = begin[: panel.free].ravel()
        if method == "least_squares":
            tight = dict.fromkeys(("ftol", "xtol", "gtol"), 1e-15)
            dense = panel.free < 500
            slope = (lambda p: jacobian(p).toarray()) if dense else jacobian
            how = "exact" if dense else "lsmr"
            q = least_squares(force, q, jac=slope, tr_solver=how, max_nfev=2000, **tight).x
        elif method == "hybr":
            q = root(force, q, jac=lambda p: jacobian(p).toarray(), options={"xtol": 1e-13}).x
        else:
            q = root(force, q, method="df-sane", options={"fatol": 1e-6, "ftol": 0.0, "maxfev": 1_000_000}).x
        return panel.whole(q), still

    return work


def cone_program(panel: Panel, most: int) -> Work:
    """Clarabel: equilibrium under a dead load is a convex program; the water's load is frozen and renewed."""
    import clarabel

    m, free = len(panel.bars), panel.free
    load = np.outer(panel.weight, [0.0, 0.0, -1.0])
    unit = 1e-3
    stretch = np.sqrt(unit * BAR / STIFFNESS) / BAR
    ends = sp.coo_matrix(
        (np.r_[-np.ones(m), np.ones(m)], (np.tile(np.arange(m), 2), panel.bars.T.ravel())),
        shape=(m, len(panel.start)),
    ).tocsr()
    # Rows (l0 + s, x_b - x_a) of each bar, lengths in bars; s in units that make its energy 1/2 s^2.
    elongation = sp.kron(sp.identity(m), sp.csr_matrix([[1.0], [0.0], [0.0], [0.0]])) * -stretch
    motion = sp.kron(-ends[:, :free], sp.csr_matrix(np.vstack([np.zeros(3), np.eye(3)])))
    matrix = sp.hstack([motion, elongation]).tocsc()
    b = np.column_stack([np.ones(m), ends[:, free:] @ panel.start[free:] / BAR]).ravel()
    energy = sp.diags(np.r_[np.zeros(3 * free), np.ones(m)], format="csc")
    settings = clarabel.DefaultSettings()
    settings.verbose = False

    def work() -> Answer:
        x, still = panel.start, np.zeros_like(panel.start)
        for _ in range(most):
            drag = bar_forces(x[panel.bars[:, 1]] - x[panel.bars[:, 0]], np.tile(CURRENT, (m, 1)))[1]
            total = load + abs(ends).T @ drag + SPHERE * np.linalg.norm(CURRENT) * CURRENT
            cost = np.r_[-total[:free].ravel() / unit, np.zeros(m)]
            cones = [clarabel.SecondOrderConeT(4)] * m
            q = np.array(clarabel.DefaultSolver(energy, cost, matrix, b, cones, settings).solve().x)
            x = panel.whole(q[: 3 * free] * BAR)
        return x, still

    return work
