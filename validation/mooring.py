"""A mooring line that lies in part on the ground, with and without friction, against the touching catenary."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import fsolve

import fyke
from fyke.study import Found
from fyke.water.bed import Bed
from lines import NO_FORCES, thread

WATER = fyke.Water(density=1025.0, gravity=9.81)
CHAIN = fyke.chain(0.022)
# As heavy as this chain, and soft enough for what lies to slip by much more than the ground gives.
SOFT_CHAIN = replace(CHAIN, law=thread(4e5, CHAIN.diameter).law)
LENGTH, DEPTH = 120.0, 20.0  # m
# Twine, friction and span (m).
CASES = {
    "chain, no friction": (CHAIN, 0.0, 113.0),
    "soft chain, friction 0.6": (SOFT_CHAIN, 0.6, 113.0),
    "soft chain, friction 0.6, pulled further": (SOFT_CHAIN, 0.6, 118.0),
}


def weight_of(twine):
    """Weight in water of a metre (N)."""
    return WATER.gravity * (twine.density - WATER.density) * twine.area


def mooring(segments, twine, friction, span):
    """A line from an anchor on the ground to a fairlead at the surface: system and result."""
    pieces = [fyke.LinePiece(twine, LENGTH, segments)]
    net = fyke.with_line(
        None, (0.0, 0.0, -DEPTH), (span, 0.0, 0.0), pieces, name="m", bed=-DEPTH, water=WATER.density
    )
    bed = Bed(DEPTH, stiffness=3e9, friction=friction)
    system = fyke.make_system(net, water=WATER, coefficients=NO_FORCES, bed=bed)
    result = fyke.solve_static(system, tolerance=1e-6)
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return system, result


def touching_catenary(span, twine, friction):
    """Pull (N) along and up at the fairlead, and at the anchor: J. Jonkman's form of an elastic line, as in MoorPy."""
    w, ea = weight_of(twine), twine.law.rows(twine.diameter)[0, 2]

    def gap(f):
        h, v = f
        lying = LENGTH - v / w
        x = lying + h / w * np.arcsinh(v / h) + h * LENGTH / ea
        if friction:
            free = lying - h / (friction * w)
            x += friction * w / (2.0 * ea) * (-(lying**2) + free * max(free, 0.0))
        return [x - span, h / w * (np.sqrt(1.0 + (v / h) ** 2) - 1.0) + v**2 / (2.0 * ea * w) - DEPTH]

    h, v = fsolve(gap, [w * DEPTH, 2.0 * w * DEPTH], xtol=1e-12)
    return h, v, max(h - friction * w * (LENGTH - v / w), 0.0)


def pulls(segments, twine, friction, span):
    """The same of bars, of which each bears half its weight at its ends."""
    _, result = mooring(segments, twine, friction, span)
    t, x = result.tension[-1], result.position[-1]
    half = 0.5 * weight_of(twine) * LENGTH / segments
    along = (x[-1] - x[-2]) / np.linalg.norm(x[-1] - x[-2])
    return t[-1] * along[0], t[-1] * along[2] + half, t[0]


def measure(tables):
    for case, (twine, friction, span) in CASES.items():
        exact = touching_catenary(span, twine, friction)
        coarse, fine = (np.array(pulls(n, twine, friction, span)) for n in (60, 240))
        yield Found("along", fine[0], exact[0], case)
        yield Found("up", fine[1], exact[1], case)
        yield Found("anchor", (fine[2] - exact[2]) / exact[0], case=case)
        yield Found("nearer", np.abs(coarse - exact).max() / np.abs(fine - exact).max(), case=case)
