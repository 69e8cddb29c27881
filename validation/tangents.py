"""Tangents of the forces: of one bar against the complex step, of whole nets and of wet parts against differences."""

from __future__ import annotations

import numpy as np

import fyke
from fyke.forces.drag import bar_water_tangents
from fyke.forces.wetness import wet_bar, wet_knot
from fyke.solve.equilibrium import Equilibrium
from fyke.study import Found
from fyke.water.current import UniformCurrent
from fyke.water.laws.bars import ChooCasarella
from fyke.water.laws.knots import CliftGauvin
from fyke.water.laws.panels import Loland
from fyke.water.profile import PowerCurrent, TableCurrent

LAWS = {
    "constant coefficients": {},
    "laws by speed": {"bars": ChooCasarella(), "knots": CliftGauvin()},
    "screens": {"screens": Loland()},
}
SHEAR = TableCurrent([0.0, 1.0, 2.0], [[0.8, 0.1, 0.0], [0.3, -0.2, 0.0], [-0.2, 0.3, 0.0]])
CURRENTS = {
    "sheared current": SHEAR,
    "uniform current": UniformCurrent((0.5, 0.2, 0.1)),
    "power current": PowerCurrent((0.7, 0, 0), 3.0, 0.3),
}
# Height of the middle of the panel (m): under water, and half out of it.
HEIGHTS = {"under water": -1.3, "at the surface": 0.004}


def complex_water(d, w, cn, ct):
    """Force of one end as the formula says it, for complex numbers: no absolute values of vectors."""
    length = np.sqrt(d @ d)
    t = d / length
    s = w @ t
    n = w - s * t
    size = s if s.real > 0 else -s
    return length * (cn * np.sqrt(n @ n) * n + ct * size * s * t)


def of_one_bar(seed):
    """Largest error of both tangents of a bar drawn at random; the force is of size 1."""
    rng = np.random.default_rng(seed)
    d, w = rng.normal(size=3), rng.normal(size=3)
    cn, ct = rng.uniform(0.1, 2.0, size=2)
    turn, press = np.empty((3, 3)), np.empty((3, 3))
    length = np.linalg.norm(d)
    bar_water_tangents(w, d / length, (cn, ct, 0.0, 0.0, 0.0, 0.0), length, turn, press)
    step = 1e-30
    by_place = [complex_water(d + 1j * step * e, w, cn, ct).imag / step for e in np.eye(3)]
    by_speed = [complex_water(d, w + 1j * step * e, cn, ct).imag / step for e in np.eye(3)]
    return max(
        np.abs(turn - np.column_stack(by_place)).max(), np.abs(press - np.column_stack(by_speed)).max()
    )


def bellied(laws, current, height):
    """A small panel of thick twine, shaken by 2 cm."""
    net = fyke.panel(
        fyke.Twine("any", 1140.0, 3e-3, fyke.LinearLaw(1e9)),
        mesh="diamond",
        meshes=(2, 3),
        bar_length=0.1,
        size=(0.25, 0.36),
        knot_diameter=8e-3,
        centre=(0.0, 0.0, height),
    )
    system = fyke.make_system(net, current=current, coefficients=fyke.Coefficients(**laws), surface=True)
    x = net.positions + 0.02 * np.random.default_rng(4).normal(size=net.positions.shape)
    return Equilibrium(system, fyke.State(0.0, x, np.zeros_like(x)), None)


def of_load(moment, step=1e-7):
    """Largest error of the tangent of the loads of water and weight over its largest entry."""
    moment.b.block[:] = 0.0
    moment.assemble()
    found = moment.pattern.matrix(moment.b.data).toarray()
    free, begin = moment.pattern.free, moment.x.copy()
    want = np.empty_like(found)
    for column in range(want.shape[1]):
        loads = []
        for way in (step, -step):
            moved = begin.copy()
            moved[free[column // 3], column % 3] += way
            moment.begin_at(moved)
            loads.append(moment.b.load[free].copy())
        want[:, column] = -((loads[0] - loads[1]) / (2.0 * step)).ravel()
    return np.abs(found - want).max() / np.abs(want).max()


def of_wet_parts(step=1e-7):
    """Largest error of the slopes of the wet part of a bar of 2 cm and of a knot of 4 cm, over 1 / thickness."""
    rng, off = np.random.default_rng(1), []
    for a, b in [*rng.uniform(-0.03, 0.03, (40, 2)), (0.004, 0.004), (0.2, -0.3)]:
        _, by_a, by_b = wet_bar(a, b, 0.01)
        off.append(by_a - (wet_bar(a + step, b, 0.01)[0] - wet_bar(a - step, b, 0.01)[0]) / (2 * step))
        off.append(by_b - (wet_bar(a, b + step, 0.01)[0] - wet_bar(a, b - step, 0.01)[0]) / (2 * step))
        off.append(
            wet_knot(a, 0.02)[1] - (wet_knot(a + step, 0.02)[0] - wet_knot(a - step, 0.02)[0]) / (2 * step)
        )
    return np.abs(off).max() * 0.02


def measure(tables):
    yield Found("bar", max(of_one_bar(seed) for seed in range(6)), case="six bars at random")
    for laws, made in LAWS.items():
        for flow, current in CURRENTS.items():
            for place, height in HEIGHTS.items():
                off = of_load(bellied(made, current, height))
                yield Found("load", off, case=f"{laws}, {flow}, {place}")
    yield Found("wetness", of_wet_parts())
