"""Drag and lift of one bar by its angle to the flow."""

from __future__ import annotations

import numpy as np

import fyke
from fyke.forces.evaluate import evaluate
from fyke.study import Found
from lines import thread

DENSITY, SPEED, DIAMETER, LENGTH = 1025.0, 0.7, 2e-3, 0.03


def forces(degrees):
    """Drag, lift, and the force as a vector, of a bar that rises downstream, over 1/2 rho U^2 d l."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    net = fyke.line(thread(1e3, DIAMETER), [[0.0, 0.0, 0.0], [LENGTH * c, 0.0, LENGTH * s]], LENGTH)
    system = fyke.make_system(net, current=(SPEED, 0.0, 0.0), water=fyke.Water(DENSITY))
    frame = evaluate(system, system.at_rest())
    scale = 0.5 * DENSITY * SPEED**2 * DIAMETER * LENGTH
    return frame.bar_drag[0] / scale, frame.bar_lift[0] / scale, frame.hydrodynamic_force / scale


def measure(tables):
    for row in tables["bars"]:
        case = f"{row['alpha']:g} deg"
        drag, lift, force = forces(row["alpha"])
        yield Found("drag", drag, row["CD"], case)
        yield Found("lift", lift, row["CL"], case)
        # It rises downstream: the normal that points downstream points down.
        yield Found("upwards", force[2], -row["CL"], case)
        yield Found("across", force[1], case=case)
