"""A long closed tube of diamond netting under a pressure from within.

fyke has no pressure: that on every face is put on its corners as dead load, and renewed on the shape found until it
holds. One end of the tube is held, open and as wide as the tube is to be; the pressure on the other is on its rim.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.netting.faces import faces_of
from fyke.netting.shapes import frustum
from fyke.netting.sheet import Netting
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, thread

ROWS = 4
# Rounds of renewing, and the change of a place over the radius at which they end; nylon's stiffness for bars that do
# not stretch, at which they are 1e-6 longer.
ROUNDS, STILL, STIFF = 200, 1e-9, 1e8
# The angle to begin at (deg), far from the one to be found.
START = 40.0


def tube(row):
    """A tube that settled, and its net."""
    around, bar, begin = int(row["around"]), row["l0"], np.radians(START)
    twine = thread(min(row["EA"], STIFF))
    height = 2.0 * ROWS * bar * np.cos(begin)
    diameters = (2.0 * around * bar * np.sin(begin) / np.pi, 2.0 * row["radius"])
    net = frustum(Netting(twine, "diamond", bar), (around, ROWS), diameters=diameters, height=height)
    faces, points = faces_of(net), net.positions
    rim = np.unique(net.panels[0].edge("bottom"))
    outwards = np.sign(
        np.einsum("pq,pq->", faces.vector_area(points)[:, :2], points[faces.corners].mean(axis=1)[:, :2])
    )
    state = None
    for _ in range(ROUNDS):
        each = outwards * row["pressure"] * faces.vector_area(points)
        load = np.zeros_like(points)
        for corner, share in zip(faces.corners.T, faces.share.T, strict=True):
            np.add.at(load, corner, share[:, None] * each)
        radius = np.hypot(*points[rim, :2].T).mean()
        load[rim, 2] -= row["pressure"] * np.pi * radius**2 / len(rim)
        system = fyke.make_system(replace(net, load=load), water=NO_WATER, coefficients=NO_FORCES)
        result = fyke.solve_static(system, start=state, tolerance=1e-6)
        if not result.outcome.ok:
            raise RuntimeError(result.outcome.message)
        state = result.state()
        moved = np.abs(result.position[-1] - points).max()
        points = 0.5 * (points + result.position[-1])
        if moved < STILL * row["radius"]:
            return result, net
    raise RuntimeError(f"the pressure still changes by {moved:.1e} m after {ROUNDS} rounds")


def measure(tables):
    for row in tables["tubes"]:
        result, net = tube(row)
        x, tension = result.position[-1], result.tension[-1]
        a, b = net.bars.T
        d = x[b] - x[a]
        # Bars halfway between the two ends.
        middle = np.abs(0.5 * (x[a, 2] + x[b, 2]) - 0.5 * x[:, 2].min()) < np.ptp(x[:, 2]) / ROWS
        angle = np.degrees(np.arctan2(np.hypot(d[:, 0], d[:, 1]), np.abs(d[:, 2])))
        bars = "bars that do not stretch" if row["EA"] > STIFF else f"bars of {row['EA']:g} N"
        case = f"{row['around']:g} meshes around, {bars}"
        yield Found("angle", angle[middle].mean(), row["angle"], case)
        yield Found("tension", tension[middle].mean(), row["tension"], case)
        yield Found("radius", np.hypot(*x[np.unique(net.bars[middle]), :2].T).mean(), row["radius"], case)
        yield Found("bar", np.linalg.norm(d, axis=1)[middle].mean(), row["bar"], case)
        yield Found("axial", -result.support_reaction[-1][2], row["axial"], case)
