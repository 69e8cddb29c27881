"""The 8 x 8 panel with its bars cut into segments: how its sag and tension settle."""

from __future__ import annotations

import numpy as np

import fyke
from fyke.study import Found
from lines import draw_orders
from panels import CURRENT, framed, mid_side, settled

SEGMENTS = (1, 2, 4, 8, 16)
ERRORS = {}


def cut(segments):
    """Sag (m) of the middle mesh and largest tension (N)."""
    net, middle = mid_side(segments)
    result = settled(fyke.make_system(net, current=CURRENT))
    return result.position[-1][middle, 0].mean(), result.tension[-1].max()


def measure(tables):
    known = {int(row["segments"]): row for row in tables["segments"]}
    sags = []
    for segments in SEGMENTS:
        sag, tension = cut(segments)
        sags.append(sag)
        if segments in known:
            yield Found("sag", sag, known[segments]["sag"], f"{segments} a bar")
            yield Found("tension", tension, known[segments]["tension"], f"{segments} a bar")
        else:
            yield Found("shown", sag, case=f"{segments} a bar")
    steps = np.abs(np.diff(sags))
    ERRORS["change of the sag with twice as many segments (m)"] = (SEGMENTS[:-1], steps)
    yield Found("order", np.log2(steps[-2] / steps[-1]))
    yield Found("share", 100.0 * (sags[0] / sags[-1] - 1.0))
    for segments in (1, 2, 4):
        result = settled(framed(segments=segments))
        yield Found("drag", result.hydrodynamic_force[-1][0], case=f"{segments} a bar")


def picture(found):
    return draw_orders(ERRORS, 2, by="segments a bar", what="change of the sag (m)")
