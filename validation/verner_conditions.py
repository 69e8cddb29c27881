"""Order conditions of Verner's pair in exact fractions, its error norms and its limits of stability."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from math import prod

import numpy as np

from fyke.solve import verner
from fyke.study import Found

# A rooted tree is the sorted tuple of its root's subtrees; () is the single node.
Tree = tuple
# Largest h omega of a mode of this damping ratio, as tabled for the DVERK pair.
LIMITS = {0.0: 1.307, 0.01: 2.490, 0.05: 3.059, 0.1: 3.372, 0.3: 3.945, 0.7: 3.958, 1.0: 4.065}


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


def symmetry(tree: Tree) -> int:
    factor = 1
    for sub in set(tree):
        count = tree.count(sub)
        factor *= symmetry(sub) ** count * prod(range(1, count + 1))
    return factor


def weights(tree: Tree) -> list[Fraction]:
    """Product over the subtrees of A times their weights, one value for each stage."""
    out = [Fraction(1)] * verner.STAGES
    for sub in tree:
        inner = weights(sub)
        out = [
            o * sum((a * w for a, w in zip(row, inner, strict=False)), Fraction(0))
            for o, row in zip(out, verner.A, strict=True)
        ]
    return out


def error(b: tuple[Fraction, ...], tree: Tree) -> Fraction:
    return sum((x * y for x, y in zip(b, weights(tree), strict=True)), Fraction(0)) - Fraction(
        1, density(tree)
    )


def holding(b, order):
    """How many conditions of so many orders hold exactly."""
    return sum(error(b, tree) == 0 for size in range(1, order + 1) for tree in trees(size))


def norm(b, order):
    """Norm of the errors of the first order that does not hold, with the symmetry of each tree as divisor."""
    return sum(float(error(b, tree) / symmetry(tree)) ** 2 for tree in trees(order)) ** 0.5


def limit(zeta):
    """Largest h omega at which a mode of this damping ratio does not grow."""
    steps = np.arange(1, 50_001) * 1e-4
    inside = verner.growth(steps * (-zeta + 1j * np.sqrt(1 - zeta**2))) <= 1 + 1e-9
    return steps[np.argmin(inside) - 1]


def measure(tables):
    rows = sum(sum(row, Fraction(0)) == c for row, c in zip(verner.A, verner.C, strict=True))
    yield Found("rows", rows)
    for name, b, order, conditions, size in (
        ("order 6", verner.B6, 6, 37, 2.072e-3),
        ("order 5", verner.B5, 5, 17, 6.956e-4),
    ):
        yield Found("conditions", holding(b, order), conditions, case=name)
        yield Found("norm", norm(b, order + 1), size, case=name)
    for zeta, tabled in LIMITS.items():
        yield Found("limit", limit(zeta), tabled, case=f"damping ratio {zeta:g}")
