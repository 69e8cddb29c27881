"""Natural modes of a net about its equilibrium: frequencies, periods and shapes of small free oscillations.

M a + K x = 0 with the stiffness of the taut bars and the mass of the knots, added mass included. A taut bar resists
every relative motion of its ends, along it by the slope of its law and across it by T/L. So K of a net has an inverse
exactly when chains of taut bars join every knot to a held one; knots that they do not reach are left out and named.
Tubes, which push and bend, and the buoyancy of what floats add to K; a strut that buckles has none of its own.

The lowest modes of large nets come from Lanczos' method on K^-1 M with one factorization of K (ARPACK, by
scipy.sparse.linalg.eigsh). Symmetric nets have modes in pairs of one frequency, of which one run may see only one;
further runs across the modes already found look for what was missed, until nothing slower is left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import LinAlgError, eigh
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import LinearOperator, eigsh
from threadpoolctl import threadpool_limits

from ..forces.bars import assemble, bar_geometry, elastic
from ..forces.inertia import mass_matrices
from ..forces.surroundings import Surroundings
from ..system.elements import Elements
from ..system.system import System
from .equilibrium import ROUNDING
from .linear import Pattern, Solve, factorizer

Array = NDArray[np.float64]
Knots = NDArray[np.int64]

# Up to so many unknowns, or when a third of all modes is asked for, all of them by a dense method are faster.
DENSE = 150
# Two frequencies are one when they differ by less than this of their size.
SAME = 1e-8
# Squares of frequencies so many times below the rounding of the stiffness are no rounding.
NOISE = 100.0


@dataclass(frozen=True)
class Modes:
    """Natural modes of a net, k of them, n knots.

    frequency: (k,) rad/s, circular, ascending; shape: (k, n, 3), motion of the knots without unit, the largest of
    them 1, zero where held or loose; loose: indices of the free knots that no chain of taut bars joins to a held
    knot. Nothing pulls those back, so they have no period and are left out of the modes.
    falling: how many of the modes are no oscillations, because the stiffness pushes the net on when it is touched, as a
    strut beyond its buckling load: their frequency is given as 0, too.
    """

    frequency: Array
    shape: Array
    loose: Knots
    falling: int = 0

    @property
    def period(self) -> Array:
        """Natural periods, (k,) s, descending; infinite where the frequency is 0."""
        with np.errstate(divide="ignore"):
            return 2.0 * np.pi / self.frequency


def modes(system: System, position: ArrayLike, *, count: int = 6) -> Modes:
    """Find the slowest small free oscillations of a net about a static equilibrium.

    position: (n, 3) m, an equilibrium, for example solve_static(system).position[-1]; that it is one is not checked.
    count: how many modes; fewer come back when the net has fewer. Where modes share a frequency, any mixture of
    their shapes is a mode as well.

    The linear system M a + K x = 0: K is dT/dL along and T/L across every taut bar, slack bars have none; M is the
    knots' mass with the added mass of knots and bars, the latter as the bars lie at the equilibrium. Left out are
    the change of the current's load as the net moves and turns, the drag, which damps, and twine damping. In water,
    then, the periods are those of the undamped net; drag may leave no oscillation at all. A frequency that is below
    the rounding of the stiffness is 0 and its period infinite.

    Raises ValueError for a count below 1, positions of another shape or not finite, a free knot without mass.
    """
    x = np.ascontiguousarray(position, dtype=float)
    _check(system, x, count)
    n = system.net.knot_count
    el, pattern, data, loose = stiffness_of(system, x)
    stiffness = pattern.matrix(data)
    mass = _mass_matrix(x - x.mean(axis=0), el, pattern)
    size = stiffness.shape[0]
    count = min(count, size)
    # Rounding of K in units of omega^2. Shifted by that much, K has an inverse however little the bars pull.
    shift = float(np.finfo(float).eps * (stiffness.diagonal() / mass.diagonal()).max(initial=0.0))
    if size <= max(DENSE, 3 * count):
        square, vectors = _all(stiffness, mass, shift, count)
    else:
        solve = inverse(stiffness, mass, shift, pattern)
        # Lanczos' short BLAS products gain nothing from threads, which would fight with those of the solves.
        with threadpool_limits(1, user_api="blas"):
            square, vectors = lowest(solve, mass, shift, count)
    shape = np.zeros((count, n, 3))
    shape[:, pattern.free] = vectors.reshape(count, len(pattern.free), 3)
    falling = int(np.count_nonzero(square < -NOISE * shift)) if el.two_way.any() else 0
    return Modes(np.sqrt(np.where(square > shift, square, 0.0)), _scaled(shape), loose, falling)


def stiffness_of(system: System, position: Array) -> tuple[Elements, Pattern, Array, Knots]:
    """Elements with loose knots held, and the stiffness of the net (N/m) as data of a pattern; the loose knots."""
    still = np.zeros_like(position)
    around = Surroundings(system.resting())
    el, _ = around.at(position, still, 0.0)
    # About the net's middle, coordinates are smallest and so is their rounding.
    x = position - position.mean(axis=0)
    t, length, along, across = _bar_stiffness(x, el)
    loose = _loose(el, el.two_way | (across > 0.0))
    # A loose knot hangs on slack bars only: holding it changes nothing else.
    free = el.free.copy()
    free[loose] = 0.0
    el = el._replace(free=free)
    pattern = Pattern.of(el, around.groups)
    data = _stiffness_data(t, along, across, el, pattern)
    # In still water: parts and buoyancy alone.
    around.assemble(x, still, 1.0, 0.0, pattern.groups, symmetric=True, data=data)
    places = pattern.start, pattern.stride, pattern.diagonal
    around.add_wetting(x, still, el, t, length, places, pattern.groups, symmetric=True, data=data)
    return el, pattern, data, loose


def _bar_stiffness(x: Array, el: Elements) -> tuple[Array, Array, Array, Array]:
    """Unit vector (m, 3) and length (m,) m of every bar, stiffness along and across it, (m,) N/m, zero where slack."""
    m = len(el.knot_a)
    t, length, f, k = np.empty((m, 3)), np.empty(m), np.empty(m), np.empty(m)
    bar_geometry(x, el, t, length)
    stretch = length - el.rest_length
    elastic(stretch, el, f, k)
    # A bar as long as unloaded but for rounding is slack, else noise would pass for a very soft net.
    taut = el.two_way | (stretch > ROUNDING * np.finfo(float).eps * np.abs(x).max(initial=0.0))
    across = np.divide(f, length, out=np.zeros(m), where=taut)
    return t, length, np.where(taut, k, 0.0), across


def _check(system: System, x: Array, count: int) -> None:
    el, net = system.elements, system.net
    if count < 1:
        raise ValueError(f"count must be at least 1, not {count}")
    if x.shape != (net.knot_count, 3):
        raise ValueError(f"position has the shape {x.shape}, the net needs ({net.knot_count}, 3)")
    if not np.all(np.isfinite(x)):
        knot = net.labels[int(np.flatnonzero(~np.isfinite(x).all(axis=1))[0])]
        raise ValueError(f"position of knot {knot} is not finite")
    massless = np.flatnonzero((el.free > 0.0) & (el.knot_mass == 0.0))
    if massless.size:
        raise ValueError(f"knot {net.labels[massless[0]]} is free and has no mass")


def _loose(el: Elements, taut: NDArray[np.bool_]) -> Knots:
    """Free knots that no chain of taut bars joins to a held one."""
    n = len(el.free)
    graph = sp.csr_matrix((np.ones(taut.sum()), (el.knot_a[taut], el.knot_b[taut])), shape=(n, n))
    part = connected_components(graph, directed=False)[1]
    return np.flatnonzero(~np.isin(part, part[el.free == 0.0]))


def _stiffness_data(t: Array, along: Array, across: Array, el: Elements, pattern: Pattern) -> Array:
    """Stiffness of the bars between free knots, N/m, as data of the pattern."""
    block = np.einsum("e,ep,eq->epq", along - across, t, t) + across[:, None, None] * np.eye(3)
    data = np.zeros(len(pattern.indices))
    still = np.zeros((len(el.free), 3))
    assemble(block, still, el, t, pattern.start, pattern.stride, data)
    return data


def _mass_matrix(x: Array, el: Elements, pattern: Pattern) -> sp.bsr_matrix:
    """Mass of the free knots, kg, one 3 x 3 block each."""
    mass = np.empty((len(x), 6))
    mass_matrices(x, el, mass)
    blocks = mass[pattern.free][:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)
    knots = np.arange(len(blocks) + 1)
    return sp.bsr_matrix((blocks, knots[:-1], knots), shape=(3 * len(blocks),) * 2)


def _all(stiffness: sp.csc_matrix, mass: sp.bsr_matrix, shift: float, count: int) -> tuple[Array, Array]:
    """Lowest eigenvalues (count,) and eigenvectors (count, size), dense."""
    size = stiffness.shape[0]
    if count == 0:
        return np.zeros(0), np.zeros((0, size))
    inertia = mass.toarray()
    whole = stiffness.toarray() + shift * inertia
    try:
        # Turned over, so that rounding is measured on the soft modes, which K hides under its stiff ones.
        turned, vectors = eigh(inertia, whole, subset_by_index=(size - count, size - 1))
    except LinAlgError:
        square, vectors = eigh(whole, inertia, subset_by_index=(0, count - 1))
        return square - shift, vectors.T
    return 1.0 / turned[::-1] - shift, vectors.T[::-1]


def inverse(stiffness: sp.csc_matrix, mass: sp.bsr_matrix, shift: float, pattern: Pattern) -> Solve:
    """Solve with K + shift M."""
    data = stiffness.data.copy()
    start, stride = pattern.diagonal[pattern.free].T[:, :, None, None]
    data[start + stride * np.arange(3)[:, None] + np.arange(3)] += shift * mass.data
    # What K hides under its rounding is to grow: there no solution fits its right side.
    return factorizer(pattern, useless=np.inf).factor(data)


def lowest(solve: Solve, mass: sp.bsr_matrix, shift: float, count: int) -> tuple[Array, Array]:
    """Lowest eigenvalues (count,) and eigenvectors (count, size), M-orthonormal, by solves with K + shift M."""
    size = mass.shape[0]
    random = np.random.default_rng(0)

    def run(number: int, known: Array) -> tuple[Array, Array]:
        """Lowest eigenpairs across the known vectors, one a row."""
        known_mass = (mass @ known.T).T

        def inverse(b: Array) -> Array:
            y: Array = solve(np.ascontiguousarray(b))
            y -= (known_mass @ y) @ known
            return y

        operator = LinearOperator((size, size), matvec=inverse, dtype=float)
        # What a run misses lies across its own start, so that every run begins elsewhere.
        start = inverse(random.standard_normal(size))
        # In shift-invert mode eigsh uses its first matrix for its size alone.
        values, vectors = eigsh(mass, number, M=mass, sigma=-shift, OPinv=operator, v0=start)
        return values, np.ascontiguousarray(vectors.T)

    values, vectors = run(count, np.zeros((0, size)))
    while True:
        value, vector = run(1, vectors)
        if value[0] + shift >= (1.0 - 2.0 * SAME) * (np.sort(values)[count - 1] + shift):
            break
        values, vectors = np.append(values, value), np.concatenate([vectors, vector])
    order = np.argsort(values, kind="stable")[:count]
    return values[order], vectors[order]


def _scaled(shapes: Array) -> Array:
    """Divide every shape by its largest knot motion, whose largest component becomes positive."""
    for shape in shapes:
        knot = shape[np.argmax(np.einsum("iq,iq->i", shape, shape))]
        shape /= np.copysign(np.linalg.norm(knot), knot[np.argmax(np.abs(knot))])  # noqa: PLW2901 a view, in place
    return shapes
