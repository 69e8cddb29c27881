"""Motion against closed forms: sinking from rest, small oscillations, and the orders of the steppers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from reference import NO_FORCES, NO_WATER, grouped, table, thread

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


def test_sphere_sinks_from_rest():
    rows = table("sphere_fall")
    result = fyke.simulate(sphere(0.01, 1140.0), duration=1.0, every=0.1, stepper=EXACT)
    assert result.time == pytest.approx([r["time_s"] for r in rows], abs=1e-12)
    assert -result.velocity[:, 0, 2] == pytest.approx([r["speed_m_s"] for r in rows], abs=1e-6)
    assert -result.position[:, 0, 2] == pytest.approx([r["depth_m"] for r in rows], abs=1e-6)


@pytest.mark.parametrize(
    "row", table("terminal_speeds"), ids=lambda r: f"{r['body']} {r['diameter_m']} m {r['density_kg_m3']:g}"
)
def test_speed_of_sinking(row):
    """From rest to the terminal speed, which 12 time scales bring within 1e-10; what is light rises."""
    is_sphere = row["body"] == "sphere"
    body = (sphere if is_sphere else cylinder)(row["diameter_m"], row["density_kg_m3"])
    speed = row["speed_m_s"]
    tau = time_scale(speed, row["density_kg_m3"], 0.5 if is_sphere else 1.0)
    exact = fyke.simulate(body, duration=12 * tau, every=tau, stepper=EXACT)
    assert sinking_errors(exact, speed, tau).max() < 1e-6
    leapfrog = fyke.simulate(body, duration=12 * tau, every=tau, stepper=fyke.Symplectic(max_step=tau / 50))
    for result in (exact, leapfrog):
        assert -result.velocity[-1, :, 2] == pytest.approx(speed, rel=1e-6)
        assert np.abs(result.position[-1, :, :2] - result.position[0, :, :2]).max() < 1e-12


def with_steps(method, h):
    """Stepper whose steps are all h (s): nothing is rejected and max_step is always reached."""
    return fyke.Verner(1e9, 1e9, max_step=h) if method is fyke.Verner else method(max_step=h)


def slopes(errors):
    errors = np.array(errors)
    return np.log2(errors[:-1] / errors[1:])


@pytest.mark.parametrize(
    ("method", "order", "steps"), [(fyke.Symplectic, 2, (16, 32, 64)), (fyke.Verner, 6, (8, 16, 32))]
)
def test_order_on_a_sinking_sphere(method, order, steps):
    speed = np.sqrt(4.0 / 3.0 * 0.14 * 9.81 * 0.01 / 0.47)
    tau = time_scale(speed, 1140.0, 0.5)
    errors = [
        sinking_errors(
            fyke.simulate(
                sphere(0.01, 1140.0), duration=3 * tau, every=tau, stepper=with_steps(method, tau / n)
            ),
            speed,
            tau,
        )
        for n in steps
    ]
    assert slopes(errors) == pytest.approx(order, abs=0.25)


@pytest.mark.parametrize("added_mass", [0.0, 1.0])
def test_leapfrog_is_of_second_order_on_a_sinking_bar(added_mass):
    speed = np.sqrt(np.pi / 2.0 * 3e-3 * 0.14 * 9.81 / 1.2)
    tau = time_scale(speed, 1140.0, added_mass)
    body = cylinder(3e-3, 1140.0, added_mass)
    errors = [
        sinking_errors(
            fyke.simulate(body, duration=2 * tau, every=tau / 10, stepper=fyke.Symplectic(max_step=tau / n)),
            speed,
            tau,
        )
        for n in (80, 160, 320)
    ]
    assert slopes(errors) == pytest.approx(2.0, abs=0.25)


# Angular frequency sqrt(2 k / m) of the mass below (rad/s), and how far it is pulled at the start (m).
FREQUENCY, PULL = 2.0, 0.05


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
    period = 2.0 * np.pi / FREQUENCY
    return fyke.simulate(mass_between_springs(), duration=2 * period, every=period / 8, stepper=stepper)


@pytest.mark.parametrize(("method", "order"), [(fyke.Symplectic, 2), (fyke.Verner, 6)])
def test_order_on_an_oscillation(method, order):
    errors = []
    for n in (16, 32, 64):
        result = oscillation(with_steps(method, 2.0 * np.pi / FREQUENCY / n))
        phase = FREQUENCY * result.time
        errors.append(
            [
                np.abs(result.position[:, 1, 0] - PULL * np.cos(phase)).max(),
                np.abs(result.velocity[:, 1, 0] + PULL * FREQUENCY * np.sin(phase)).max(),
            ]
        )
    assert slopes(errors) == pytest.approx(order, abs=0.1)


def test_leapfrog_has_the_frequency_that_theory_gives_it():
    """sin(w' h / 2) = w h / 2: the exact solution of the recursion x(n+1) - 2 x(n) + x(n-1) = -(w h)^2 x(n)."""
    h = 2.0 * np.pi / FREQUENCY / 16
    result = oscillation(fyke.Symplectic(max_step=h))
    slower = 2.0 / h * np.arcsin(FREQUENCY * h / 2.0)
    assert np.abs(result.position[:, 1, 0] - PULL * np.cos(slower * result.time)).max() < 1e-12


def test_error_estimate_of_the_pair_is_of_order_five():
    """The estimate of one step goes as h^6, the order 5 solution's: a tolerance 64 times tighter, twice the steps."""
    steps, errors = [], []
    for power in (4, 5, 6):
        tolerance = 64.0**-power
        result = fyke.simulate(
            mass_between_springs(),
            duration=20 * np.pi,
            every=20 * np.pi,
            stepper=fyke.Verner(tolerance, tolerance),
        )
        steps.append(result.outcome.iterations)
        errors.append(abs(result.position[-1, 1, 0] - PULL))
    assert np.array(steps[1:]) / steps[:-1] == pytest.approx(2.0, rel=0.02)
    assert np.all(np.array(errors) < 64.0 ** -np.array([4, 5, 6]))


MASS, SPRING, SPACING, TENSION = 0.002, 5000.0, 0.03, 2.0
MODES = grouped("natural_frequencies", "system")


def masses(net):
    """Put 2 g on every knot of a net without water."""
    knot = 0.01
    knots = np.full(net.knot_count, 1.0)
    return replace(net, knot_diameter=knot * knots, knot_density=MASS / (np.pi / 6.0 * knot**3) * knots)


def taut():
    """Unloaded length of a bar that is SPACING long under TENSION, and its twine."""
    length = SPACING - TENSION / SPRING
    return length, thread(SPRING * length, density=0.0)


def mode_shape(system, i, j):
    """Net and displacement (n, 3) of a mode, of size 1."""
    length, twine = taut()
    if system == "transverse_square_net_7x7":
        side = 8 * SPACING
        net = fyke.panel(twine, mesh="square", meshes=(8, 8), bar_length=length, size=(side, side))
        row, column = np.array([label.split("-") for label in net.labels], dtype=float).T
        return net, np.outer(np.sin(np.pi * i * row / 8) * np.sin(np.pi * j * column / 8), [1.0, 0.0, 0.0])
    knots = np.arange(11.0)
    net = fyke.line(twine, np.outer(knots, [SPACING, 0.0, 0.0]), length)
    along = system == "longitudinal_chain"
    return net, np.outer(np.sin(np.pi * i * knots / 10), [1.0, 0.0, 0.0] if along else [0.0, 0.0, 1.0])


@pytest.mark.parametrize("system", MODES)
def test_natural_frequencies(system):
    """Let go in the shape of a mode, the net passes its place at full speed after two and a quarter periods."""
    for row in MODES[system]:
        net, shape = mode_shape(system, row["i"], row["j"])
        frequency, size = row["omega_rad_s"], 1e-6
        at_rest = fyke.make_system(masses(net), water=NO_WATER, coefficients=NO_FORCES)
        start = fyke.State(0.0, net.positions + size * shape, np.zeros_like(shape))
        phase = 4.5 * np.pi
        end = fyke.simulate(
            at_rest,
            duration=phase / frequency,
            every=phase / frequency,
            start=start,
            stepper=fyke.Verner(rtol=1e-10, atol=1e-13),
        ).frame()
        modal = shape / (shape**2).sum()
        place = (modal * (end.position - net.positions)).sum() / size
        speed = (modal * end.velocity).sum() / (size * frequency)
        assert speed == pytest.approx(-1.0, abs=1e-6), row
        assert abs(place) / phase < 1e-6, row
