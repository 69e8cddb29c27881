"""Tension by strain of every elastic law, in the kernel, against the formula; fibres against the sources' table."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import fyke
from fyke.forces.tension import law_tension
from fyke.netting.twine import MATERIALS
from fyke.study import Found

DIAMETER = 2e-3
# As REEF3D has them (N), and of PE by Wilson 1967 as Bi et al. 2014 use it (Pa).
C1, C2 = 1160.0, 37300.0
WILSON, POWER = 345.37e6, 1.0121
STRAINS = (0.002, 0.013, 0.05, 0.2)


def tension(law, strain):
    rows = law.rows(DIAMETER)
    return law_tension(strain, rows, 0, len(rows))


def worst(law, exact, slope):
    """Largest error of tension and slope over the exact values."""
    found = np.array([tension(law, strain) for strain in STRAINS])
    return np.abs(found / [[exact(strain), slope(strain)] for strain in STRAINS] - 1.0).max()


def measure(tables):
    area = np.pi / 4.0 * DIAMETER**2
    yield Found(
        "law", worst(fyke.LinearLaw(1e9), lambda e: 1e9 * area * e, lambda e: 1e9 * area), case="linear"
    )
    yield Found(
        "law",
        worst(
            fyke.PowerLaw(WILSON, POWER),
            lambda e: DIAMETER**2 * WILSON * e**POWER,
            lambda e: DIAMETER**2 * WILSON * POWER * e ** (POWER - 1.0),
        ),
        case="power",
    )
    yield Found(
        "law",
        worst(fyke.QuadraticLaw(C1, C2), lambda e: C1 * e + C2 * e**2, lambda e: C1 + 2.0 * C2 * e),
        case="quadratic",
    )
    rows = tables["twine"]
    points = np.array([[0.01 * row["strain_twisted"], row["load"]] for row in rows])
    table = fyke.TableLaw(tuple(points[:, 0]), tuple(points[:, 1]))
    for (below, low), (above, high) in pairwise(points):
        middle = tension(table, 0.5 * (below + above))[0]
        yield Found("table", middle, 0.5 * (low + high), f"strain {0.5 * (below + above):.4f}")
    for strain, load in points[1:]:
        line = load / (points[1, 1] / points[1, 0] * strain)
        yield Found("line", 100.0 * (1.0 / line - 1.0), case=f"strain {strain:.3f}")
    for row in tables["fibres"]:
        yield Found("density", MATERIALS[row["fibre"]].density, row["density"], row["fibre"])
