"""Natural frequencies in time: F07's table and the modes of damped nets and nets in a current, by every stepper."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from reference import NO_FORCES, NO_WATER, grouped, thread

MASS, SPRING, SPACING, TENSION = 0.002, 5000.0, 0.03, 2.0
TABLE = grouped("natural_frequencies", "system")
TIGHT = {"fixed": True, "rtol": 0.0, "atol": 1e-10}


def stepper_of(name: str, step: float):
    """Stepper whose steps are all of this length (s); Verner's pair by tight tolerances."""
    return {
        "symplectic": lambda: fyke.Symplectic(max_step=step),
        "verner": lambda: fyke.Verner(rtol=1e-9, atol=1e-14),
        "implicit": lambda: fyke.Implicit(max_step=step, **TIGHT),
        "newmark": lambda: fyke.Newmark(max_step=step, **TIGHT),
    }[name]()


def period_at(name: str, frequency: float, step: float) -> float:
    """Frequency (rad/s) of the method itself for a mode of frequency omega, by the exact solution of its recursion."""
    phase = frequency * step
    if name == "symplectic":
        return 2.0 / step * np.arcsin(phase / 2.0)
    if name == "newmark":
        return 2.0 / step * np.arctan(phase / 2.0)
    # BDF2 of dy/dt = i w y: the root of (3 - 2 i w h) z^2 - 4 z + 1 near 1.
    roots = np.roots([3.0 - 2.0j * phase, -4.0, 1.0])
    return float(np.angle(roots[np.abs(roots).argmax()]) / step)


def crossings(time, swing):
    """Times (s) at which a swing goes through zero, by the straight line between outputs."""
    at = np.flatnonzero(swing[:-1] * swing[1:] < 0.0)
    return time[at] + swing[at] / (swing[at] - swing[at + 1]) * np.diff(time)[at]


def balls(net, mass=MASS, diameter=0.01):
    """Balls on the knots."""
    ones = np.ones(net.knot_count)
    return replace(net, knot_diameter=diameter * ones, knot_density=mass / (np.pi / 6 * diameter**3) * ones)


def chain(damping_time=0.0):
    """Nine balls of 2 g between ten springs along x, 2 N in each."""
    rest = SPACING - TENSION / SPRING
    twine = replace(thread(SPRING * rest, density=0.0), damping_time=damping_time)
    return balls(fyke.line(twine, np.outer(np.arange(11) * SPACING, [1.0, 0.0, 0.0]), rest))


def square_net():
    rest = SPACING - TENSION / SPRING
    side = 8 * SPACING
    twine = thread(SPRING * rest, density=0.0)
    return balls(fyke.panel(twine, mesh="square", meshes=(8, 8), bar_length=rest, size=(side, side)))


def shapes(system):
    """Net and frequency and shape (n, 3) of every mode of the table."""
    net = square_net() if "square" in system else chain()
    axis = [0.0, 0.0, 1.0] if system == "transverse_chain" else [1.0, 0.0, 0.0]
    for row in TABLE[system]:
        i, j = row["i"], row["j"]
        if "square" in system:
            down, across = np.array([label.split("-") for label in net.labels], dtype=float).T
            size = np.sin(np.pi * i * down / 8) * np.sin(np.pi * j * across / 8)
        else:
            size = np.sin(np.pi * i * np.arange(11) / 10)
        yield net, row["omega_rad_s"], np.outer(size, axis)


@pytest.mark.parametrize("name", ["symplectic", "implicit", "newmark"])
@pytest.mark.parametrize("system", TABLE)
def test_table_of_frequencies_by_zero_crossings(system, name):
    """Let go in the shape of a mode: the steppers' own frequencies, which go to the table's with the step squared.

    Verner's pair, which has no such error, is held to 1e-6 on all of the table in test_analytic_motion.py.
    """
    for net, frequency, shape in list(shapes(system))[:: 1 if name == "symplectic" else 4]:
        step = 2 * np.pi / frequency / 100
        start = fyke.State(0.0, net.positions + 1e-5 * shape, np.zeros_like(shape))
        at_rest = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
        run = fyke.simulate(
            at_rest, duration=480 * step, every=2 * step, start=start, stepper=stepper_of(name, step)
        )
        # Leapfrog takes more steps where its bound, that of the modes along the bars, is shorter.
        assert name == "symplectic" or run.outcome.iterations == pytest.approx(480, abs=1)
        step = run.time[-1] / run.outcome.iterations
        swing = np.einsum("knp,np->k", run.position - net.positions, shape)
        zero = crossings(run.time, swing)
        assert len(zero) == pytest.approx(9.6, abs=0.6)
        found = np.pi * (len(zero) - 1) / (zero[-1] - zero[0])
        assert found == pytest.approx(period_at(name, frequency, step), rel=2e-4)
        assert found == pytest.approx(frequency, rel=3e-3)


def test_spectrum_of_a_struck_chain_has_the_table_s_lines():
    """One ball struck along the chain: the nine lines of the spectrum, and nothing above them."""
    net = chain()
    system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
    speed = np.zeros((11, 3))
    speed[1, 0] = 1e-3
    lines = np.array([row["omega_rad_s"] for row in TABLE["longitudinal_chain"]])
    every, count = 2.5e-4, 4096
    run = fyke.simulate(
        system,
        duration=every * count,
        every=every,
        start=fyke.State(0.0, net.positions, speed),
        stepper=fyke.Symplectic(max_step=every / 16),
    )
    window = np.hanning(count)
    spectrum = np.abs(np.fft.rfft(window * (run.position[:count, 1, 0] - net.positions[1, 0])))
    omega = 2 * np.pi * np.fft.rfftfreq(count, every)
    inner = spectrum[1:-1]
    peaks = (
        np.flatnonzero((inner > spectrum[:-2]) & (inner > spectrum[2:]) & (inner > 1e-3 * inner.max())) + 1
    )
    assert omega[peaks] == pytest.approx(lines, abs=1.1 * omega[1])


def test_twine_damping_damps_every_mode_along_a_chain_by_its_frequency():
    """C = tau K along the chain: each mode swings at w sqrt(1 - zeta^2), zeta = tau w / 2, e^(-zeta w t) of it left."""
    damping_time = 5e-5
    net = chain(damping_time)
    system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
    found = fyke.modes(system, net.positions, count=27).frequency
    for _, frequency, shape in list(shapes("longitudinal_chain"))[::4]:
        assert np.abs(found / frequency - 1.0).min() < 1e-8
        zeta = damping_time * frequency / 2
        period = 2 * np.pi / (frequency * np.sqrt(1 - zeta**2))
        start = fyke.State(0.0, net.positions + 1e-6 * shape, np.zeros_like(shape))
        run = fyke.simulate(
            system, duration=3 * period, every=period, start=start, stepper=stepper_of("verner", 0.0)
        )
        swing = np.einsum("knp,np->k", run.position - net.positions, shape) / (1e-6 * (shape**2).sum())
        assert swing == pytest.approx(np.exp(-zeta * frequency * run.time), rel=1e-5)


@pytest.mark.parametrize("name", ["symplectic", "verner", "implicit", "newmark"])
def test_a_ball_in_a_current_swings_at_its_mode_damped_by_the_drag(name):
    """m x'' + c x' + k x = 0, c = rho C_D pi/4 d^2 U along the current and half of it across, m with added mass."""
    diameter, speed, mass = 0.03, 0.5, 0.1
    rest = 0.5 - 5.0 / 200.0
    points = [[0.0, -0.5, 0.0], [0.0, 0.0, 0.0], [0.0, 0.5, 0.0]]
    net = balls(fyke.line(thread(200.0 * rest, density=0.0), points, rest), mass, diameter)
    drag = 0.5 * 1000.0 * np.pi / 4 * diameter**2
    # A dead load against the force of the water keeps the springs straight, so that all is known by hand.
    load = np.zeros((3, 3))
    load[1, 0] = -drag * speed**2
    system = fyke.make_system(
        replace(net, load=load),
        current=(speed, 0.0, 0.0),
        water=fyke.Water(gravity=0.0),
        coefficients=fyke.Coefficients(
            bars=fyke.ConstantBar(0.0, 0.0),
            knots=fyke.ConstantKnot(1.0),
            added_mass_bar=0.0,
            added_mass_knot=0.5,
        ),
    )
    rest_position = fyke.solve_static(system, tolerance=1e-12).position[-1]
    assert np.abs(rest_position - net.positions).max() < 1e-9
    moved = mass + 0.5 * 1000.0 * np.pi / 6 * diameter**3
    across, along = np.sqrt(2 * 5.0 / 0.5 / moved), np.sqrt(2 * 200.0 / moved)
    assert fyke.modes(system, rest_position).frequency == pytest.approx([across, across, along], rel=1e-6)
    for axis, frequency, damping in (
        (0, across, 2 * drag * speed),
        (1, along, drag * speed),
        (2, across, drag * speed),
    ):
        decay = damping / (2 * moved)
        assert 0.01 < decay / frequency < 0.5
        damped = np.sqrt(frequency**2 - decay**2)
        step = 2 * np.pi / frequency / 800
        start = rest_position.copy()
        start[1, axis] += 1e-5
        run = fyke.simulate(
            system,
            duration=2 * np.pi / damped,
            every=2 * np.pi / damped / 8,
            start=fyke.State(0.0, start, np.zeros((3, 3))),
            stepper=stepper_of(name, step),
        )
        t = run.time
        exact = np.exp(-decay * t) * (np.cos(damped * t) + decay / damped * np.sin(damped * t))
        assert (run.position[:, 1, axis] - rest_position[1, axis]) / 1e-5 == pytest.approx(exact, abs=2e-3)
