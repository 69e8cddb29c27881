"""Several nets as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .net import Net


def together(parts: Sequence[Net]) -> Net:
    """Put nets, at least one, side by side into one Net; they share no knots and keep their labels."""
    if len(parts) == 1:
        return parts[0]
    knots = np.cumsum([0, *(p.knot_count for p in parts)])
    bars = np.cumsum([0, *(p.bar_count for p in parts)])
    twines = list(dict.fromkeys(t for p in parts for t in p.twines))
    panels = tuple(
        replace(
            panel,
            knots=panel.knots + k,
            bars=panel.bars + b,
        )
        for p, k, b in zip(parts, knots, bars, strict=False)
        for panel in p.panels
    )
    which = [np.array([twines.index(t) for t in p.twines], dtype=np.int64)[p.twine_of_bar] for p in parts]
    return Net(
        positions=np.concatenate([p.positions for p in parts]),
        labels=tuple(label for p in parts for label in p.labels),
        fixed=np.concatenate([p.fixed for p in parts]),
        bars=np.concatenate([p.bars + k for p, k in zip(parts, knots, strict=False)]),
        rest_length=np.concatenate([p.rest_length for p in parts]),
        twines=tuple(twines),
        twine_of_bar=np.concatenate(which),
        knot_diameter=np.concatenate([p.knot_diameter for p in parts]),
        knot_density=np.concatenate([p.knot_density for p in parts]),
        load=np.concatenate([p.load for p in parts]),
        panels=panels,
        ropes=tuple(
            replace(rope, knots=rope.knots + k, bars=rope.bars + b)
            for p, k, b in zip(parts, knots, bars, strict=False)
            for rope in p.ropes
        ),
        bodies=tuple(
            replace(one, knots=one.knots + k) for p, k in zip(parts, knots, strict=False) for one in p.bodies
        ),
        bar_multiple=np.concatenate([p.bar_multiple for p in parts]),
        knot_multiple=np.concatenate([p.knot_multiple for p in parts]),
    )
