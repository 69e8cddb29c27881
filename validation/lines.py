"""What the scripts of lines share, and the tests that go on from them."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import fyke
from fyke.report.style import DOUBLE_COLUMN, styled

# Neither water nor gravity, and forces of the water switched off: what is left is dead load and elasticity.
NO_WATER = fyke.Water(density=0.0, gravity=0.0)
NO_FORCES = fyke.Coefficients(
    bars=fyke.ConstantBar(0.0, 0.0), knots=fyke.ConstantKnot(0.0), added_mass_bar=0.0, added_mass_knot=0.0
)

# Tensile stiffness over tension that stands for "does not stretch": strain 1e-7, far below the errors of the cut.
STIFF = 1e7


def thread(ea: float, diameter: float = 1e-3, density: float = 1000.0) -> fyke.Twine:
    """Twine of tensile stiffness EA (N)."""
    return fyke.Twine("thread", density, diameter, fyke.LinearLaw(ea / (np.pi / 4.0 * diameter**2)))


def towards(a, b):
    """Unit vector from a to b."""
    return (b - a) / np.linalg.norm(b - a)


def orders(errors):
    """Slopes between runs with twice as many bars, or half the step, each."""
    errors = np.array(errors)
    return np.log2(errors[:-1] / errors[1:])


@styled
def draw_orders(curves, order, *, by, what):
    """Errors by steps or bars on double logarithmic axes, a line each, over the slope of an order.

    curves: {name: (counts, errors)}.
    """
    figure = Figure(figsize=(DOUBLE_COLUMN, 3.2), layout="constrained")
    axes = figure.add_subplot()
    for name, (counts, errors) in curves.items():
        axes.loglog(counts, errors, "o-", markersize=3, linewidth=1, label=name)
    counts, errors = (np.array(one) for one in max(curves.values(), key=lambda curve: curve[1][0]))
    axes.loglog(
        counts, 2.0 * errors[0] * (counts[0] / counts) ** order, "k--", linewidth=0.8, label=f"order {order}"
    )
    axes.set_xlabel(by)
    axes.set_ylabel(what)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure
