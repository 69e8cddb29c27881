"""Solidity against a count of pixels; area, mass and weight of the 8 x 8 panel by hand."""

from __future__ import annotations

import numpy as np

import fyke
from fyke.forces.inertia import mass_matrices
from fyke.netting.measures import measure_net, measure_panel, solidity
from fyke.study import Found

BAR = 0.03
# By hand: 256 bars of 1.5 mm and 30 mm, 145 balls of 3.5 mm.
BARS, KNOTS, TWINE, BALL = 256, 145, 1.5e-3, 3.5e-3
BAR_VOLUME, BALL_VOLUME = np.pi / 4.0 * TWINE**2 * BAR, np.pi / 6.0 * BALL**3


def nylon(diameter):
    return fyke.Twine("main", 1140.0, diameter, fyke.LinearLaw(1e9))


def hung(mesh, ratio, diameter, knot_diameter, meshes=2):
    """Return taut netting: diamonds at E1 = ratio, squares at E1 = E2 = 1."""
    e1, e2 = (ratio, np.sqrt(1.0 - ratio**2)) if mesh == "diamond" else (1.0, 1.0)
    full = meshes * BAR * (2 if mesh == "diamond" else 1)
    return fyke.panel(
        nylon(diameter),
        mesh=mesh,
        meshes=(meshes, meshes),
        bar_length=BAR,
        size=(full * e1, full * e2),
        knot_diameter=knot_diameter,
    )


def covered(net, cell, pixels=200):
    """Part of one cell in the middle of a panel that its bars and knots cover.

    Every pixel is looked at in a random place within it, for edges that run along the pixels.
    """
    rng = np.random.default_rng(0)
    plan = net.panels[0].flat
    corners = np.stack(np.meshgrid(np.arange(pixels), np.arange(pixels), indexing="ij"), axis=-1).reshape(
        -1, 2
    )
    points = (corners + rng.uniform(size=corners.shape)) / pixels * cell
    solid = np.zeros(len(points), dtype=bool)
    for a, b in net.bars:
        along = plan[b] - plan[a]
        t = np.clip((points - plan[a]) @ along / (along @ along), 0.0, 1.0)
        solid |= np.linalg.norm(points - plan[a] - t[:, None] * along, axis=1) < net.bar_diameter[0] / 2.0
    for centre in plan:
        solid |= np.linalg.norm(points - centre, axis=1) < net.knot_diameter[0] / 2.0
    return float(solid.mean())


def solidities():
    for knot in (0.0, 0.0035, 0.006):
        for ratio in (0.4, 0.6, 0.7071, 0.85):
            net = hung("diamond", ratio, TWINE, knot)
            cell = (2.0 * BAR * ratio, 2.0 * BAR * np.sqrt(1.0 - ratio**2))
            case = f"diamonds hung at {ratio:g}, knots of {1e3 * knot:g} mm"
            yield Found("solidity", measure_panel(net, net.panels[0]).solidity, covered(net, cell), case)
    for knot in (0.0, 0.004, 0.006):
        for diameter in (0.0015, 0.003):
            net = hung("square", 1.0, diameter, knot)
            case = f"squares of {1e3 * diameter:g} mm twine, knots of {1e3 * knot:g} mm"
            yield Found(
                "solidity", measure_panel(net, net.panels[0]).solidity, covered(net, (BAR, BAR)), case
            )
    yield Found("square", solidity("square", BAR, (1.0, 1.0), TWINE))


def example():
    return fyke.panel(
        nylon(TWINE),
        mesh="diamond",
        meshes=(8, 8),
        bar_length=BAR,
        size=(0.3055, 0.3055),
        knot_diameter=BALL,
    )


def weight(net, **water):
    """Weight that the supports bear in still water (N)."""
    result = fyke.solve_static(fyke.make_system(net, water=fyke.Water(**water)), tolerance=1e-11)
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return -result.support_reaction[-1][2]


def added(net):
    """Mass that the water adds (kg): of a bar across and along, and of its two knots, with and without water."""
    line = fyke.line(nylon(TWINE), [[0, 0, 0], [BAR, 0, 0]], BAR, knot_diameter=net, fixed=())
    out = []
    for density in (1000.0, 0.0):
        mass = np.empty((2, 6))
        mass_matrices(
            line.positions, fyke.make_system(line, water=fyke.Water(density=density)).elements, mass
        )
        out.append(mass.sum(axis=0))
    return out[0] - out[1]


def measure(tables):
    yield from solidities()
    net = example()
    figures = measure_panel(net, net.panels[0])
    yield Found("twine area", figures.twine_area, BARS * TWINE * BAR)
    yield Found("rtex", figures.rtex)
    # Rtex / (a E1 E2) for the twine, and a ball for every two bars.
    per_area = (
        1140.0 * np.pi / 4.0 * TWINE**2 / (BAR * (0.3055 / 0.48) ** 2)
        + 128 * 1140.0 * BALL_VOLUME / 0.3055**2
    )
    yield Found("mass per area", figures.mass_per_area, per_area)
    volume = BARS * BAR_VOLUME + KNOTS * BALL_VOLUME
    yield Found("mass", measure_net(net).mass, 1140.0 * volume)
    yield Found("weight", weight(net), (1140.0 - 1000.0) * 9.81 * volume, "in fresh water")
    yield Found("weight", weight(net, density=1025.0), (1140.0 - 1025.0) * 9.81 * volume, "in sea water")
    yield Found("weight", weight(net, density=0.0), 1140.0 * 9.81 * volume, "in the air")
    bar, ball = added(0.0), added(BALL)
    yield Found("added", bar[1], 1000.0 * BAR_VOLUME, "a bar across itself")
    yield Found("added", ball[0] - bar[0], 2.0 * 0.5 * 1000.0 * BALL_VOLUME, "two knots")
    yield Found("along", bar[0])
