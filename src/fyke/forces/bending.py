"""Bending of tubes: what two bars in a row do to each other when the one is not in line with the other.

Bars e1 from knot a to b and e2 from b to c, with unit vectors t1, t2 and the angle phi between them, c = t1.t2. With
the curvature of discrete elastic rods over the half of each bar next to b, l = (l1 + l2)/2 unloaded,
    kappa = 2 tan(phi/2) / l,   E = 1/2 EI kappa^2 l = B 2 tan^2(phi/2) = 2 B (1 - c)/(1 + c),   B = EI/l.
The tangent of half the angle rather than the angle or 1 - c: E has no end as a bar folds back on the next, so that
nothing gets over it, and is a ratio of plain numbers in c. M. Bergou, M. Wardetzky, S. Robinson, B. Audoly, E.
Grinspun, Discrete elastic rods, ACM Trans. Graph. 27(3), 63, 2008, known, not opened. A tube is straight when nothing
bends it, and twists freely. Of a plane ring that makes no difference: 1/2 EI kappa^2 less 1/2 EI (kappa - 1/R)^2
is, but for a constant, EI/R times the sum of all angles, which is the same in every shape of it.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..netting.net import Net
from .compiled import OPTIONS

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Bending:
    """Bending at every knot between two bars of a tube; one of the parts of forces.part.

    groups: (p, 3) knots before, at and after the place; stiffness: (p,) N m, B of the formula.
    """

    def __init__(self, groups: Places, stiffness: Array) -> None:
        self.groups, self.stiffness = groups, stiffness
        self._x = np.zeros((0, 3))

    @classmethod
    def of(cls, net: Net) -> Bending | None:
        """Return the bending of the ropes of a net that are tubes, None where none is.

        Half of each bar bends: 1/B = l1/(2 EI1) + l2/(2 EI2). Where one has no EI there is a hinge; one between two
        held knots is a clamp, in which nothing bends.
        """
        each = net.bar_multiple * np.array([t.bending_stiffness for t in net.twines])[net.twine_of_bar]
        half = np.divide(0.5 * net.rest_length, each, out=np.full(net.bar_count, np.inf), where=each > 0.0)
        half[net.fixed[net.bars].all(axis=1) & (each > 0.0)] = 0.0
        knots, softness = [], []
        for rope in net.ropes:
            path, bars = rope.knots, rope.bars
            if path[0] == path[-1] and len(bars) > 1:
                path, bars = np.append(path, path[1]), np.append(bars, bars[0])
            knots.append(np.column_stack([path[:-2], path[1:-1], path[2:]]))
            softness.append(half[bars[:-1]] + half[bars[1:]])
        if not knots:
            return None
        places, soft = np.concatenate(knots), np.concatenate(softness)
        bends = np.isfinite(soft) & (soft > 0.0)
        return cls(np.ascontiguousarray(places[bends]), 1.0 / soft[bends]) if bends.any() else None

    def see(self, x: Array, v: Array, time: float) -> None:
        """Take up positions x (n, 3) m."""
        self._x = x

    def add_load(self, out: Array) -> None:
        """Add the force on the knots to out (n, 3) N."""
        add_bending(self._x, self.groups, self.stiffness, out)

    def assemble(
        self, c0: float, c1: float, places: tuple[Places, Places], *, symmetric: bool, data: Array
    ) -> None:
        """Add c0 (-dF/dx), which is symmetric, to the data of a sparse matrix; arguments as of forces.part.Part."""
        assemble_bending(self._x, self.groups, c0 * self.stiffness, *places, data)

    def moments(self, x: Array) -> Array:
        """Bending moment EI kappa at every place, (p,) N m, of a net at x (n, 3) m."""
        one, other = x[self.groups[:, 1]] - x[self.groups[:, 0]], x[self.groups[:, 2]] - x[self.groups[:, 1]]
        sine = np.linalg.norm(np.cross(one, other), axis=1)
        half = 0.5 * np.arctan2(sine, np.einsum("pq,pq->p", one, other))
        return np.asarray(self.stiffness * 2.0 * np.tan(half))

    def energy(self, x: Array) -> float:
        """Energy of bending (J) of a net at x (n, 3) m."""
        return float(np.sum(0.5 * self.moments(x) ** 2 / self.stiffness))


@njit(**OPTIONS)
def _directions(x, a, b, out):
    """Unit vector from knot a to b into out (3,); returns one over their distance (1/m)."""
    square = 0.0
    for q in range(3):
        out[q] = x[b, q] - x[a, q]
        square += out[q] * out[q]
    inverse = 1.0 / np.sqrt(square)
    for q in range(3):
        out[q] *= inverse
    return inverse


@njit(**OPTIONS)
def add_bending(x, knots, stiffness, out):
    """Add -dE/dx of every place to out (n, 3) N; knots: (p, 3), stiffness: (p,) N m."""
    t, s = np.zeros(3), np.zeros(3)
    for i in range(knots.shape[0]):
        a, b, c = knots[i, 0], knots[i, 1], knots[i, 2]
        inverse_1, inverse_2 = _directions(x, a, b, t), _directions(x, b, c, s)
        cosine = t[0] * s[0] + t[1] * s[1] + t[2] * s[2]
        # -dE/dc of 2 B (1 - c)/(1 + c).
        push = 4.0 * stiffness[i] / (1.0 + cosine) ** 2
        for q in range(3):
            by_1 = push * inverse_1 * (s[q] - cosine * t[q])
            by_2 = push * inverse_2 * (t[q] - cosine * s[q])
            out[a, q] -= by_1
            out[b, q] += by_1 - by_2
            out[c, q] += by_2


@njit(**OPTIONS)
def assemble_bending(x, knots, stiffness, start, stride, data):
    """Add d2E/dx2 of every place to the data of a sparse matrix.

    By the bars e1, e2, with p1 = t2 - c t1, p2 = t1 - c t2 and the slopes c_1 = p1/l1, c_2 = p2/l2:
    d2c/de1de1 = -(t1 p1^T + p1 t1^T + c (I - t1 t1^T))/l1^2, d2c/de1de2 = (I - t2 t2^T - t1 p2^T)/(l1 l2).
    start: (p, 3, 3) and stride: (p, 3) of the blocks, rows before columns, as in solve.pattern.
    """
    t, s = np.zeros(3), np.zeros(3)
    h = np.zeros((2, 2, 3, 3))
    # Share of e1 and e2 in the motion of each knot.
    sign = ((-1.0, 0.0), (1.0, -1.0), (0.0, 1.0))
    for i in range(knots.shape[0]):
        u, w = _directions(x, knots[i, 0], knots[i, 1], t), _directions(x, knots[i, 1], knots[i, 2], s)
        c = t[0] * s[0] + t[1] * s[1] + t[2] * s[2]
        first = -4.0 * stiffness[i] / (1.0 + c) ** 2
        second = -2.0 * first / (1.0 + c)
        for p in range(3):
            for q in range(3):
                one = 1.0 if p == q else 0.0
                p1, q1, p2, q2 = s[p] - c * t[p], s[q] - c * t[q], t[p] - c * s[p], t[q] - c * s[q]
                h[0, 0, p, q] = (
                    u * u * (second * p1 * q1 - first * (t[p] * q1 + p1 * t[q] + c * (one - t[p] * t[q])))
                )
                h[1, 1, p, q] = (
                    w * w * (second * p2 * q2 - first * (s[p] * q2 + p2 * s[q] + c * (one - s[p] * s[q])))
                )
                h[0, 1, p, q] = u * w * (second * p1 * q2 + first * (one - s[p] * s[q] - t[p] * q2))
                h[1, 0, q, p] = h[0, 1, p, q]
        for row in range(3):
            for column in range(3):
                place = start[i, row, column]
                if place < 0:
                    continue
                for q in range(3):
                    for p in range(3):
                        value = 0.0
                        for k in range(2):
                            for m in range(2):
                                value += sign[row][k] * sign[column][m] * h[k, m, p, q]
                        data[place + q * stride[i, column] + p] += value
