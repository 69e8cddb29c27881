"""A sphere and a level bar sinking from rest: v = v_t tanh(t / tau), z = v_t tau ln cosh(t / tau)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.study import Found
from lines import thread

EXACT = fyke.Verner(rtol=1e-10, atol=1e-12)
SPHERE = fyke.Coefficients(
    bars=fyke.ConstantBar(0.0, 0.0), knots=fyke.ConstantKnot(0.47), added_mass_bar=0.0, added_mass_knot=0.5
)
CYLINDER = fyke.Coefficients(
    bars=fyke.ConstantBar(1.2, 0.1), knots=fyke.ConstantKnot(0.0), added_mass_bar=1.0
)


def sphere(diameter, density):
    """One free knot and no bar."""
    net = fyke.line(
        thread(1.0), [[0.0, 0.0, 0.0]], 1.0, fixed=(), knot_diameter=diameter, knot_density=density
    )
    return fyke.make_system(net, coefficients=SPHERE)


def cylinder(diameter, density, added_mass=1.0):
    """Two free knots and the bar between them, lying level."""
    net = fyke.line(thread(0.1, diameter, density), [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], 0.1, fixed=())
    return fyke.make_system(net, coefficients=replace(CYLINDER, added_mass_bar=added_mass))


def time_scale(speed, density, added_mass):
    """Return tau (s) of v = vt tanh(t / tau)."""
    return abs(speed) * (density / 1000.0 + added_mass) / (abs(density / 1000.0 - 1.0) * 9.81)


def sinking_errors(result, speed, tau):
    """Largest error of speed over vt, and of depth over vt tau, against tanh and ln cosh of t / tau."""
    t = result.time / tau
    down, depth = -result.velocity[..., 2].T / speed, -result.position[..., 2].T / (speed * tau)
    return np.array([np.abs(down - np.tanh(t)).max(), np.abs(depth - np.log(np.cosh(t))).max()])


def measure(tables):
    rows = tables["fall"]
    fall = fyke.simulate(sphere(0.01, 1140.0), duration=1.0, every=0.1, stepper=EXACT)
    for row, velocity, position in zip(rows, fall.velocity[:, 0, 2], fall.position[:, 0, 2], strict=True):
        case = f"sphere of 10 mm, {row['time']:g} s"
        yield Found("speed", -velocity, row["speed"], case)
        yield Found("depth", -position, row["depth"], case)
    for row in tables["terminal"]:
        is_sphere = row["body"] == "sphere"
        body = (sphere if is_sphere else cylinder)(row["diameter"], row["density"])
        tau = time_scale(row["speed"], row["density"], 0.5 if is_sphere else 1.0)
        case = f"{row['body'].replace('_', ' ')}, {1e3 * row['diameter']:g} mm, {row['density']:g} kg/m3"
        # From rest to the terminal speed, which 12 time scales bring within 1e-10.
        run = fyke.simulate(body, duration=12 * tau, every=tau, stepper=EXACT)
        yield Found("motion", sinking_errors(run, row["speed"], tau).max(), case=case)
        yield Found("terminal", -run.velocity[-1, 0, 2], row["speed"], case)
        leap = fyke.simulate(body, duration=12 * tau, every=tau, stepper=fyke.Symplectic(max_step=tau / 50))
        yield Found("terminal", -leap.velocity[-1, 0, 2], row["speed"], f"{case}, leapfrog")
