"""The mid-side panel of other programs, with the drag on the unloaded length of its bars as they take it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.study import Found
from panels import BAR, CURRENT, mid_side, settled


def nominal(system, rounds=8):
    """Solve with each bar's coefficient put up by l0 / l until it holds; on slack bars near the frame that is 10 %."""
    first = system.elements
    for _ in range(rounds):
        result = settled(system, tolerance=1e-10)
        ends = result.position[-1][system.net.bars]
        ratio = BAR / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        elements = first._replace(
            normal_drag=first.normal_drag * ratio, tangential_drag=first.tangential_drag * ratio
        )
        system = replace(system, elements=elements)
    return result


def measure(tables):
    net, middle = mid_side()
    result = nominal(fyke.make_system(net, current=CURRENT))
    yield Found("knots", net.knot_count)
    yield Found("bars", net.bar_count)
    yield Found("sag", result.position[-1][middle, 0].mean())
    yield Found("largest sag", result.position[-1][:, 0].max())
    yield Found("drag", result.hydrodynamic_force[-1][0])
    yield Found("tension", result.tension[-1].max())
    yield Found("slack", np.count_nonzero(result.tension[-1] == 0.0))
