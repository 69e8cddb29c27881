"""Weight and buoyancy at the surface: a hanging bar partly in water, a floating rope, a floating ball."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

import fyke
from fyke.study import Found

G, RHO, DIAMETER, RADIUS = 9.81, 1000.0, 0.02, 0.1


def settled(net, **given):
    result = fyke.solve_static(fyke.make_system(net, surface=True, **given))
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return result


def rope(density):
    return fyke.Twine("rope", density, DIAMETER, fyke.LinearLaw(1e9))


def segment(s):
    """Part of a circle under water, its middle s radii deep: the angle of its water line, theta - sin theta."""
    angle = 2.0 * np.arccos(-np.clip(s, -1.0, 1.0))
    return (angle - np.sin(angle)) / (2.0 * np.pi)


def measure(tables):
    volume = np.pi / 4.0 * DIAMETER**2
    for above, wet in ((0.3, 0.7), (0.5, 0.5), (-0.2, 1.0), (1.5, 0.0)):
        hanging = fyke.line(rope(1300.0), [[0, 0, above], [0, 0, above - 1.0]], 1.0, fixed=(0,))
        pull = -settled(hanging).support_reaction[-1, 2]
        yield Found("weight", pull, G * volume * (1300.0 - wet * RHO), f"{wet:g} of it in the water")
    for density in (250.0, 500.0, 900.0):
        x = np.zeros((41, 3))
        x[:, 0] = np.linspace(0.0, 10.0, 41)
        middle = settled(fyke.line(rope(density), x, 1.05 * 10.0 / 40), current=(0.0, 0.3, 0.0)).position[-1][
            20, 2
        ]
        deep = brentq(lambda s, part=density / RHO: segment(s) - part, -1.0, 1.0, xtol=1e-14)
        yield Found("rope", middle, -0.5 * DIAMETER * deep, f"rope of {density:g} kg/m3")
    ball = fyke.line(
        fyke.Twine("thin", RHO, 1e-5, fyke.LinearLaw(1e9)),
        [[0, 0, -1.0], [0, 0, 0.3]],
        2.0,
        fixed=(0,),
        knot_diameter=[0.0, 2.0 * RADIUS],
        knot_density=[RHO, 0.7 * RHO],
    )
    under = RADIUS - settled(ball).position[-1][1, 2]
    yield Found("ball", under**2 * (3.0 * RADIUS - under) / (4.0 * RADIUS**3))
