"""The 8 x 8 panels that several scripts solve: that of examples/panel.toml, and that of other programs."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

import fyke

BAR, SIDE = 0.03, 0.3055
CURRENT = (0.5, 0.0, 0.0)
NYLON = fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9), material="PA")


def framed(current=CURRENT, damping_time=0.0, water=None, coefficients=None, twine=NYLON, **panel):
    """The panel of the example; keywords change twine, panel and water."""
    options = {
        "mesh": "diamond",
        "meshes": (8, 8),
        "bar_length": BAR,
        "size": (SIDE, SIDE),
        "knot_diameter": 3.5e-3,
    }
    net = fyke.panel(replace(twine, damping_time=damping_time), **(options | panel))
    return fyke.make_system(net, current=current, water=water, coefficients=coefficients)


def settled(system, **given):
    """Solve statics or raise with the solver's own words."""
    result = fyke.solve_static(system, **given)
    if not result.outcome.ok:
        raise RuntimeError(f"{result.outcome.name}: {result.outcome.message}")
    return result


def mid_side(segments=1, cells=8, twine=NYLON):
    """Net whose knots sit on the mid-sides of a grid of square cells, 2 n (n + 1) of them with 4 n^2 bars, in segments.

    Returns the net and the four knots of its middle mesh.
    """
    n, p = cells, 0.9 * BAR * np.sqrt(2.0)
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(2 * n + 1), np.arange(2 * n + 1), indexing="ij"))
    there = (i + j) % 2 == 1
    i, j = i[there], j[there]
    index = np.full((2 * n + 1, 2 * n + 1), -1)
    index[i, j] = np.arange(len(i))
    ends = [
        (index[a, b], index[a + 1, b + up])
        for a, b in zip(i, j, strict=True)
        for up in (1, -1)
        if a < 2 * n and 0 <= b + up <= 2 * n
    ]
    places = np.column_stack([np.zeros(len(i)), 0.5 * p * (i - n), 0.5 * p * (j - n)])
    held = (i % (2 * n) == 0) | (j % (2 * n) == 0)
    positions, bars, count = [*places], [], len(i)
    for a, b in ends:
        inner = list(range(count, count + segments - 1))
        positions += [places[a] + (places[b] - places[a]) * k / segments for k in range(1, segments)]
        bars += list(pairwise([a, *inner, b]))
        count += segments - 1
    cut = count - len(i)
    net = replace(
        fyke.line(twine, [[0, 0, 0], [0, 0, -1.0]], 1.0),
        positions=np.array(positions),
        labels=tuple(map(str, range(count))),
        fixed=np.concatenate([held, np.zeros(cut, dtype=bool)]),
        bars=np.array(bars),
        rest_length=np.full(len(bars), BAR / segments),
        twine_of_bar=np.zeros(len(bars), dtype=np.int64),
        knot_diameter=np.concatenate([np.full(len(i), 3.5e-3), np.zeros(cut)]),
        knot_density=np.full(count, twine.density),
        load=np.zeros((count, 3)),
    )
    return net, np.flatnonzero((np.abs(i - n) + np.abs(j - n)) == 1)
