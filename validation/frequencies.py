"""Natural frequencies of chains and of square netting: let go in the shape of a mode, back after whole periods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, thread

MASS, SPRING, SPACING, TENSION = 0.002, 5000.0, 0.03, 2.0
PHASE, SIZE = 4.5 * np.pi, 1e-6
STEPPER = fyke.Verner(rtol=1e-10, atol=1e-13)


def masses(net):
    """Put 2 g on every knot of a net without water."""
    knot = 0.01
    knots = np.full(net.knot_count, 1.0)
    return replace(net, knot_diameter=knot * knots, knot_density=MASS / (np.pi / 6.0 * knot**3) * knots)


def taut():
    """Unloaded length of a bar that is SPACING long under TENSION, and its twine."""
    length = SPACING - TENSION / SPRING
    return length, thread(SPRING * length, density=0.0)


def mode_shape(system, i, j):
    """Net and displacement (n, 3) of a mode, of size 1."""
    length, twine = taut()
    if system == "transverse_square_net_7x7":
        side = 8 * SPACING
        net = fyke.panel(twine, mesh="square", meshes=(8, 8), bar_length=length, size=(side, side))
        row, column = np.array([label.split("-") for label in net.labels], dtype=float).T
        return net, np.outer(np.sin(np.pi * i * row / 8) * np.sin(np.pi * j * column / 8), [1.0, 0.0, 0.0])
    knots = np.arange(11.0)
    net = fyke.line(twine, np.outer(knots, [SPACING, 0.0, 0.0]), length)
    along = system == "longitudinal_chain"
    return net, np.outer(np.sin(np.pi * i * knots / 10), [1.0, 0.0, 0.0] if along else [0.0, 0.0, 1.0])


def frequency(row):
    """Angular frequency (rad/s) from where the net is at the time at which the mode should be at 4.5 pi."""
    net, shape = mode_shape(row["system"], row["i"], row["j"])
    at_rest = fyke.make_system(masses(net), water=NO_WATER, coefficients=NO_FORCES)
    start = fyke.State(0.0, net.positions + SIZE * shape, np.zeros_like(shape))
    time = PHASE / row["omega"]
    end = fyke.simulate(at_rest, duration=time, every=time, start=start, stepper=STEPPER).frame()
    modal = shape / (shape**2).sum()
    place = (modal * (end.position - net.positions)).sum()
    speed = (modal * end.velocity).sum() / row["omega"]
    # cos(w t) and -sin(w t) with w t near 4.5 pi.
    return (PHASE - np.arctan2(place, -speed)) / time, np.hypot(place, speed) / SIZE


def measure(tables):
    for row in tables["modes"]:
        case = f"{row['system'].replace('_', ' ')}, mode {row['i']:g} {row['j']:g}"
        found, size = frequency(row)
        yield Found("frequency", found, row["omega"], case)
        yield Found("size", size, case=case)
