"""Model purse seines of three fibres sinking: ratios of their mean speeds.

The paper's abstract gives neither mesh nor twine. A strip of netting stands for the seine: a line of bars with its
mass, weight and displaced water, and the drag of its whole twine. What is not known is the netting's volume; it was
worked out by hand from the ratio of the first two fibres, as if the speed went with the root of the weight, and the
third is a prediction.
"""

from __future__ import annotations

from functools import cache

import numpy as np

import fyke
from fyke.study import Found

# The seine: corkline and depth (m), weight of the sinkers in water (N), density of lead (kg/m3).
LENGTH, DEPTH, SINKERS, LEAD = 4.20, 0.85, 0.060 * 9.81, 11340.0
# Assumed: volume of the netting's fibre (m3), part of the outline that twine covers, bars of the strip.
VOLUME, SOLIDITY, BARS = 4.0e-5, 0.07, 17
FIBRES = {"PES": 1380.0, "PA": 1140.0, "PP": 910.0}
# The leadline is down where this part of the depth is reached; the last of it is reached ever more slowly.
DOWN = 0.95


@cache
def sinking_speed(fibre):
    """Mean speed (m/s) of the leadline from the surface, where the netting lies in folds."""
    bar = DEPTH / BARS
    diameter = np.sqrt(4.0 * VOLUME / (np.pi * DEPTH))
    more = SOLIDITY * LENGTH / diameter  # all its twine over the one bar that stands for it
    fold = np.arange(BARS + 1) % 2 * 0.95 * bar
    points = np.column_stack([fold, np.zeros(BARS + 1), -2e-3 * np.arange(BARS + 1)])
    lead = np.zeros(BARS + 1)
    lead[-1] = (6.0 / np.pi * SINKERS / (9.81 * (LEAD - 1000.0))) ** (1.0 / 3.0)
    net = fyke.line(
        fyke.Twine("strip", FIBRES[fibre], diameter, fyke.LinearLaw(1e7), damping_time=1e-2),
        points,
        bar,
        fixed=(0,),
        knot_diameter=lead,
        knot_density=LEAD,
    )
    # Sixteen balls of the lead meet more water than the one that stands for them.
    coefficients = fyke.Coefficients(
        bars=fyke.ConstantBar(1.2 * more, 0.1 * more), knots=fyke.ConstantKnot(0.47 * 16.0 ** (1.0 / 3.0))
    )
    run = fyke.simulate(
        fyke.make_system(net, coefficients=coefficients), duration=20.0, every=0.05, stepper=fyke.Implicit()
    )
    if not run.outcome.ok:
        raise RuntimeError(f"{fibre}: {run.outcome.message}")
    depth = -run.position[:, -1, 2]
    first = np.argmax(depth > DOWN * DEPTH)
    if not first:
        raise RuntimeError(f"{fibre}: the leadline came down to {depth.max():.2f} m only")
    return (
        DOWN * DEPTH / np.interp(DOWN * DEPTH, depth[first - 1 : first + 1], run.time[first - 1 : first + 1])
    )


def measure(tables):
    speeds = {row["seine"].split("-")[0]: 0.01 * row["mean_sinking_speed"] for row in tables["seines"]}
    for fibre, speed in speeds.items():
        yield Found("speed", sinking_speed(fibre), speed, fibre)
    for key, one, other in (("fitted", "PES", "PA"), ("ratio", "PP", "PA")):
        yield Found(
            key, sinking_speed(one) / sinking_speed(other), speeds[one] / speeds[other], f"{one} over {other}"
        )
