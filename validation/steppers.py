"""Orders in time of every stepper, on a sinking sphere and on an undamped oscillation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fyke
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, draw_orders, orders, thread
from sinking import cylinder, sinking_errors, sphere, time_scale

# Order of each, and steps in a time scale, or in a period.
STEPPERS = {
    "verner": (fyke.Verner, 6, (8, 16, 32)),
    "leapfrog": (fyke.Symplectic, 2, (32, 64, 128)),
    "implicit": (fyke.Implicit, 2, (40, 80, 160)),
    "newmark": (fyke.Newmark, 2, (40, 80, 160)),
}
# Angular frequency sqrt(2 k / m) of the mass below (rad/s), and how far it is pulled at the start (m).
FREQUENCY, PULL = 2.0, 0.05
PERIOD = 2.0 * np.pi / FREQUENCY
ERRORS = {}


def with_steps(method, h):
    """Stepper whose steps are all h (s): nothing is rejected and max_step is always reached."""
    if method is fyke.Verner:
        return fyke.Verner(1e9, 1e9, max_step=h)
    if method is fyke.Symplectic:
        return fyke.Symplectic(max_step=h)
    return replace(method(), max_step=h, fixed=True, rtol=1e-9, atol=1e-12)


def on_sphere(method, steps):
    """Largest error of speed and depth within two time scales of a sphere let go."""
    speed = np.sqrt(4.0 / 3.0 * 0.14 * 9.81 * 0.01 / 0.47)
    tau = time_scale(speed, 1140.0, 0.5)
    run = fyke.simulate(
        sphere(0.01, 1140.0), duration=2 * tau, every=tau, stepper=with_steps(method, tau / steps)
    )
    return sinking_errors(run, speed, tau).max()


def on_bar(steps, added_mass):
    """The same by leapfrog of a level bar, whose added mass is of one direction."""
    speed = np.sqrt(np.pi / 2.0 * 3e-3 * 0.14 * 9.81 / 1.2)
    tau = time_scale(speed, 1140.0, added_mass)
    stepper = fyke.Symplectic(max_step=tau / steps)
    run = fyke.simulate(cylinder(3e-3, 1140.0, added_mass), duration=2 * tau, every=tau / 10, stepper=stepper)
    return sinking_errors(run, speed, tau).max()


def mass_between_springs():
    """1 kg between two massless bars of 2 N/m that stay taut, let go at PULL from the middle."""
    knot = 0.1
    net = fyke.line(
        thread(2.0, density=0.0),
        [[-1.1, 0.0, 0.0], [PULL, 0.0, 0.0], [1.1, 0.0, 0.0]],
        1.0,
        knot_diameter=knot,
        knot_density=1.0 / (np.pi / 6.0 * knot**3),
    )
    return fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)


def oscillation(stepper):
    return fyke.simulate(mass_between_springs(), duration=2 * PERIOD, every=PERIOD / 8, stepper=stepper)


def on_springs(method, steps):
    """Largest error of place and speed over the swing within two periods."""
    run = oscillation(with_steps(method, PERIOD / steps))
    phase = FREQUENCY * run.time
    place = np.abs(run.position[:, 1, 0] / PULL - np.cos(phase)).max()
    return max(place, np.abs(run.velocity[:, 1, 0] / (PULL * FREQUENCY) + np.sin(phase)).max())


def measure(tables):
    for name, (method, order, steps) in STEPPERS.items():
        for problem, error in (("a sinking sphere", on_sphere), ("an oscillation", on_springs)):
            found = [error(method, one) for one in steps]
            ERRORS[f"{name}, {problem}"] = (steps, found)
            yield Found("order", orders(found)[-1], order, f"{name}, {problem}")
    for added_mass in (0.0, 1.0):
        slope = orders([on_bar(steps, added_mass) for steps in (80, 160, 320)])[-1]
        yield Found("order", slope, 2, f"leapfrog, a sinking bar, added mass {added_mass:g}")
    # The exact solution of x(n+1) - 2 x(n) + x(n-1) = -(w h)^2 x(n): sin(w' h / 2) = w h / 2.
    h = PERIOD / 16
    run = oscillation(fyke.Symplectic(max_step=h))
    slower = 2.0 / h * np.arcsin(FREQUENCY * h / 2.0)
    yield Found("leapfrog", np.abs(run.position[:, 1, 0] - PULL * np.cos(slower * run.time)).max())


def picture(found):
    return draw_orders(ERRORS, 2, by="steps in a time scale or period", what="largest error")
