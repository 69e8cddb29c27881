"""Measured coefficients to hold laws against: a sphere, a smooth cylinder, a panel of netting."""

from __future__ import annotations

from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Of the panel: solidity, twine diameter (m), speed (m/s), and kinematic viscosity (m2/s) of fresh water at 20 deg C.
PANEL_SOLIDITY, PANEL_TWINE, PANEL_SPEED, PANEL_VISCOSITY = 0.20, 2.8e-3, 0.5, 1.002e-6
PANEL_REYNOLDS = PANEL_SPEED * PANEL_TWINE / PANEL_VISCOSITY


def sphere() -> Array:
    """Return (122, 2): Reynolds number and C_D on pi d^2 / 4; Roos and Willmarth 1971."""
    return _columns("sphere.csv")


def cylinder() -> Array:
    """Return (247, 2): Reynolds number and C_D on d l; several experiments, read off a figure."""
    return _columns("cylinder.csv")


def panel() -> Array:
    """Return (6, 3): angle between flow and normal (rad), C_D and C_L on the outline; Patursson et al. 2010."""
    table = _columns("panel.csv")
    table[:, 0] = np.radians(table[:, 0])
    return table


def _columns(name: str) -> Array:
    with (files(__name__) / name).open(encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")][1:]
    return np.loadtxt(lines, delimiter=",")
