"""The panel that every tool of peers.py computes: its numbers, its equations, its answers.

Diamond netting on a square frame 10 % too small for it, in a current of 0.5 m/s. Knots sit on the mid-sides of an
n x n grid of square cells, 2 n (n + 1) of them with 4 n^2 bars; all knots of the outer sides are held. One set of
equations for all tools: tension k (l - l0) where positive, drag of bars on d x length, of knots as spheres, weight
less buoyancy, and an added mass equal in all directions, because not every tool knows another.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numba import njit
from numpy.typing import NDArray

import fyke

Array = NDArray[np.float64]
# Positions and velocities (n, 3) at the end, and the work to be timed that gives them.
Answer = tuple[Array, Array]
Work = Callable[[], Answer]

BAR, TWINE, KNOT = 0.03, 1.5e-3, 3.5e-3
MODULUS, NYLON, WATER, GRAVITY = 1e9, 1140.0, 1000.0, 9.81
C_NORMAL, C_TANGENTIAL, C_KNOT, C_MASS = 1.2, 0.1, 1.0, 1.0
CURRENT = np.array([0.5, 0.0, 0.0])
AREA = np.pi / 4 * TWINE**2
STIFFNESS = MODULUS * AREA / BAR
BAR_VOLUME, KNOT_VOLUME = AREA * BAR, np.pi / 6 * KNOT**3
# Drag over |w| w: of a bar's unit length, of a knot.
NORMAL, TANGENTIAL = 0.5 * WATER * C_NORMAL * TWINE, 0.5 * WATER * C_TANGENTIAL * TWINE
SPHERE = 0.5 * WATER * C_KNOT * np.pi / 4 * KNOT**2


@dataclass(frozen=True)
class Panel:
    """n knots, the free ones first, and m bars: start (n, 3) m, bars (m, 2), mass and weight (n,) kg and N, centre."""

    start: Array
    bars: NDArray[np.int64]
    free: int
    volume: Array
    centre: NDArray[np.int64]

    @property
    def mass(self) -> Array:
        """Mass with added mass, kg."""
        return (NYLON + C_MASS * WATER) * self.volume

    @property
    def weight(self) -> Array:
        """Weight less buoyancy, N."""
        return (NYLON - WATER) * GRAVITY * self.volume

    def whole(self, free: Array, rest: Array | None = None) -> Array:
        """Values of all knots (n, 3) from those of the free ones; the held ones as at the start by default."""
        return np.vstack([free.reshape(-1, 3), self.start[self.free :] if rest is None else rest])

    def state(self, y: Array) -> tuple[Array, Array]:
        """Positions and velocities (n, 3) of all knots from a solver's vector."""
        half = 3 * self.free
        return self.whole(y[:half]), self.whole(y[half:], np.zeros((len(self.start) - self.free, 3)))

    @property
    def first(self) -> Array:
        """A solver's vector of the start at rest: positions, then velocities, of the free knots."""
        return np.r_[self.start[: self.free].ravel(), np.zeros(3 * self.free)]

    def bulged(self) -> Array:
        """Start positions pushed downstream by a third of the side, so that every bar is taut."""
        x = self.start.copy()
        side = np.ptp(x[:, 1])
        depth = (1 - (2 * x[:, 1] / side) ** 2) * (1 - (2 * x[:, 2] / side) ** 2)
        x[:, 0] = 0.32 * side * depth
        return x


def make_panel(cells: int) -> Panel:
    """Panel of so many cells each way."""
    pitch = 0.9 * BAR * np.sqrt(2.0)
    places = [(i + 0.5, j) for i in range(cells) for j in range(cells + 1)]
    places += [(i, j + 0.5) for i in range(cells + 1) for j in range(cells)]
    plan = np.array(places) - cells / 2
    held = np.abs(plan).max(axis=1) > cells / 2 - 0.25
    order = np.argsort(held, kind="stable")
    number = {places[old]: new for new, old in enumerate(order)}
    bars = []
    for i in range(cells):
        for j in range(cells):
            ring = [(i + 0.5, j), (i + 1, j + 0.5), (i + 0.5, j + 1), (i, j + 0.5)]
            bars += [(number[ring[q]], number[ring[(q + 1) % 4]]) for q in range(4)]
    plan = plan[order] * pitch
    degree = np.bincount(np.ravel(bars))
    distance = np.linalg.norm(plan, axis=1)
    return Panel(
        start=np.column_stack([np.zeros(len(plan)), plan]),
        bars=np.array(bars),
        free=int(np.count_nonzero(~held)),
        volume=0.5 * degree * BAR_VOLUME + KNOT_VOLUME,
        centre=np.flatnonzero(distance < 1.01 * distance.min()),
    )


def fyke_system(panel: Panel) -> fyke.System:
    """Put the panel into fyke, with the masses of the other tools."""
    n, m = len(panel.start), len(panel.bars)
    net = fyke.Net(
        positions=panel.start,
        labels=tuple(str(i) for i in range(n)),
        fixed=np.arange(n) >= panel.free,
        bars=panel.bars,
        rest_length=np.full(m, BAR),
        twines=(fyke.Twine("main", NYLON, TWINE, fyke.LinearLaw(MODULUS)),),
        twine_of_bar=np.zeros(m, dtype=np.int64),
        knot_diameter=np.full(n, KNOT),
        knot_density=np.full(n, NYLON),
        load=np.zeros((n, 3)),
    )
    system = fyke.make_system(net, current=tuple(CURRENT))
    elements = system.elements._replace(bar_added_mass=np.zeros(m), knot_mass=panel.mass)
    return replace(system, elements=elements)


@njit(error_model="numpy")
def add_forces(x, v, bars, k, out):
    """Tension of stiffness k and drag of the bars and drag of the knots onto out (n, 3) N."""
    for i in range(len(x)):
        w0, w1, w2 = CURRENT[0] - v[i, 0], CURRENT[1] - v[i, 1], CURRENT[2] - v[i, 2]
        c = SPHERE * np.sqrt(w0 * w0 + w1 * w1 + w2 * w2)
        out[i, 0] += c * w0
        out[i, 1] += c * w1
        out[i, 2] += c * w2
    for e in range(len(bars)):
        a, b = bars[e, 0], bars[e, 1]
        d0, d1, d2 = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        length = np.sqrt(d0 * d0 + d1 * d1 + d2 * d2)
        t0, t1, t2 = d0 / length, d1 / length, d2 / length
        w0 = CURRENT[0] - 0.5 * (v[a, 0] + v[b, 0])
        w1 = CURRENT[1] - 0.5 * (v[a, 1] + v[b, 1])
        w2 = CURRENT[2] - 0.5 * (v[a, 2] + v[b, 2])
        s = w0 * t0 + w1 * t1 + w2 * t2
        w0, w1, w2 = w0 - s * t0, w1 - s * t1, w2 - s * t2
        c = 0.5 * NORMAL * length * np.sqrt(w0 * w0 + w1 * w1 + w2 * w2)
        s = 0.5 * TANGENTIAL * length * abs(s) * s
        pull = max(0.0, k * (length - BAR))
        f0, f1, f2 = c * w0 + s * t0, c * w1 + s * t1, c * w2 + s * t2
        out[a, 0] += f0 + pull * t0
        out[a, 1] += f1 + pull * t1
        out[a, 2] += f2 + pull * t2
        out[b, 0] += f0 - pull * t0
        out[b, 1] += f1 - pull * t1
        out[b, 2] += f2 - pull * t2


@njit(error_model="numpy")
def derivative(y, dy, arrays, bars, mass, weight, k):
    """Velocities and accelerations of the free knots into dy; arrays: x, v, force (n, 3), with the held knots set."""
    x, v, force = arrays
    free = y.size // 6
    half = 3 * free
    for i in range(len(x)):
        force[i, 0], force[i, 1], force[i, 2] = 0.0, 0.0, -weight[i]
    for i in range(free):
        for q in range(3):
            x[i, q], v[i, q] = y[3 * i + q], y[half + 3 * i + q]
    add_forces(x, v, bars, k, force)
    for i in range(free):
        for q in range(3):
            dy[3 * i + q] = v[i, q]
            dy[half + 3 * i + q] = force[i, q] / mass[i]


def compiled_rate(panel: Panel, stiffness: float = STIFFNESS) -> Callable[[Array, Array], None]:
    """Compiled right-hand side, rate(y, dy)."""
    x, v, force = panel.start.copy(), np.zeros_like(panel.start), np.zeros_like(panel.start)
    rest = ((x, v, force), panel.bars, panel.mass, panel.weight, stiffness)

    def rate(y: Array, dy: Array) -> None:
        derivative(y, dy, *rest)

    rate(panel.first, np.zeros(6 * panel.free))
    return rate


def unbalanced(panel: Panel, x: Array) -> Array:
    """Force (n, 3) N on every knot of a net at rest."""
    out = np.zeros_like(x)
    out[:, 2] = -panel.weight
    add_forces(x, np.zeros_like(x), panel.bars, STIFFNESS, out)
    return out


def bar_forces(d: Array, w: Array) -> tuple[Array, Array]:
    """Tension and half the drag of bars d (m, 3) in water of relative velocity w, as vectors; also for complex d, w."""
    length = np.sqrt((d * d).sum(axis=1, keepdims=True))
    t = d / length
    tension = np.where(length.real > BAR, STIFFNESS * (length - BAR), 0.0) * t
    s = (w * t).sum(axis=1, keepdims=True)
    across = w - s * t
    normal = NORMAL * np.sqrt((across * across).sum(axis=1, keepdims=True)) * across
    return tension, 0.5 * length * (normal + TANGENTIAL * np.sign(s.real) * s * s * t)


def tangents(panel: Panel, x: Array, v: Array) -> tuple[sp.csc_matrix, sp.csc_matrix]:
    """Derivatives of the forces on the free knots by their positions and velocities, by the complex step."""
    n, (a, b) = len(x), panel.bars.T
    d, w = x[b] - x[a], CURRENT - 0.5 * (v[a] + v[b])
    pull, push, by_flow = (np.zeros((len(a), 3, 3)) for _ in range(3))
    ball = np.zeros((n, 3, 3))
    for q in range(3):
        step = 1e-30j * np.eye(3)[q]
        tension, drag = bar_forces(d + step, w + 0j)
        pull[:, :, q], push[:, :, q] = tension.imag / 1e-30, drag.imag / 1e-30
        by_flow[:, :, q] = bar_forces(d + 0j, w + step)[1].imag / 1e-30
        u = CURRENT - v + step
        ball[:, :, q] = (SPHERE * np.sqrt((u * u).sum(axis=1, keepdims=True)) * u).imag / 1e-30
    knots = np.arange(n)
    here, there = np.r_[a, a, b, b], np.r_[b, a, a, b]
    by_x = np.concatenate([pull + push, -pull - push, pull - push, push - pull])
    by_v = np.concatenate([np.tile(-0.5 * by_flow, (4, 1, 1)), -ball])

    def matrix(block: Array, row: Array, column: Array) -> sp.csc_matrix:
        i = np.broadcast_to(3 * row[:, None, None] + np.arange(3)[:, None], block.shape)
        j = np.broadcast_to(3 * column[:, None, None] + np.arange(3), block.shape)
        full = sp.coo_matrix((block.ravel(), (i.ravel(), j.ravel())), shape=(3 * n, 3 * n)).tocsc()
        return full[: 3 * panel.free, : 3 * panel.free]

    return matrix(by_x, here, there), matrix(by_v, np.r_[here, knots], np.r_[there, knots])


def answers(panel: Panel, x: Array, v: Array) -> dict[str, float]:
    """Sag of the middle (m), drag (N), largest tension (N), by the same formulas for every tool."""
    a, b = panel.bars.T
    u = CURRENT - v
    drag = 2.0 * bar_forces(x[b] - x[a], 0.5 * (u[a] + u[b]))[1][:, 0].sum()
    drag += (SPHERE * np.linalg.norm(u, axis=1) * u[:, 0]).sum()
    length = np.linalg.norm(x[b] - x[a], axis=1)
    return {
        "sag": float(x[panel.centre, 0].mean()),
        "drag": float(drag),
        "tension": float(max(0.0, STIFFNESS * (length.max() - BAR))),
    }


@njit(error_model="numpy")
def relax(x, free, bars, weight, keep, tolerance, most):
    """Dynamic relaxation in place: damped fictitious motion until no free knot is pulled by more than tolerance N."""
    motion, force = np.zeros((free, 3)), np.zeros_like(x)
    still = np.zeros_like(x)
    inverse = 0.5 / STIFFNESS
    for iteration in range(most):
        force[:] = 0.0
        force[:, 2] = -weight
        add_forces(x, still, bars, STIFFNESS, force)
        worst = 0.0
        for i in range(free):
            for q in range(3):
                worst = max(worst, abs(force[i, q]))
                motion[i, q] = keep * motion[i, q] + inverse * force[i, q]
                x[i, q] += motion[i, q]
        if worst < tolerance:
            return iteration
    return most
