"""What the scripts of lines share."""

from __future__ import annotations

import numpy as np

import fyke

# Neither water nor gravity, and forces of the water switched off: what is left is dead load and elasticity.
NO_WATER = fyke.Water(density=0.0, gravity=0.0)
NO_FORCES = fyke.Coefficients(
    bars=fyke.ConstantBar(0.0, 0.0), knots=fyke.ConstantKnot(0.0), added_mass_bar=0.0, added_mass_knot=0.0
)


def thread(ea: float, diameter: float = 1e-3, density: float = 1000.0) -> fyke.Twine:
    """Twine of tensile stiffness EA (N)."""
    return fyke.Twine("thread", density, diameter, fyke.LinearLaw(ea / (np.pi / 4.0 * diameter**2)))


def towards(a, b):
    """Unit vector from a to b."""
    return (b - a) / np.linalg.norm(b - a)
