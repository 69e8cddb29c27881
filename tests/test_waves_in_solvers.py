"""Nets in waves and changing currents: Morison by hand, motion against closed forms, every solver alike."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.evaluate import evaluate
from fyke.results.audit import audit
from fyke.solve import held_water
from fyke.water.current import RampedCurrent, UniformCurrent
from fyke.water.waves import airy, irregular
from reference import thread

RHO, G = 1000.0, 9.81
# Long and low waves in deep water: what is second order in their slope stays below 2 %.
SWELL = airy(0.01, 4.0, gravity=G)


def hung(meshes=(3, 3), top=-0.1):
    """A panel that hangs from its upper edge, across the waves."""
    twine = fyke.Twine("n", 1140.0, 3e-3, fyke.LinearLaw(1e7), damping_time=1e-3)
    width, height = 0.036 * meshes[0], 0.045 * meshes[1]
    return fyke.panel(
        twine,
        mesh="diamond",
        meshes=meshes,
        bar_length=0.03,
        size=(width, height),
        knot_diameter=6e-3,
        centre=(0.0, 0.0, top - 0.5 * height),
        fixed="top",
    )


def held_bar(direction, waves, current=(0.0, 0.0, 0.0), **coefficients):
    """A bar of 0.1 m that is held at both ends, 1 m below the surface."""
    t = np.array(direction) / np.linalg.norm(direction)
    ends = np.array([0.3, 0.2, -1.0]) + np.outer([-0.05, 0.05], t)
    net = fyke.line(thread(1e3, 3e-3, 1140.0), ends, 0.1, fixed=(0, 1))
    law = fyke.Coefficients(bars=fyke.ConstantBar(1.1, 0.2), **coefficients)
    return fyke.make_system(net, current=current, waves=waves, coefficients=law), t


@pytest.mark.parametrize("direction", [(0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.3, -0.5)])
@pytest.mark.parametrize("time", [0.0, 0.3, 1.1])
def test_force_on_a_held_bar_is_morisons(direction, time):
    """Drag of current and waves together, and rho V (a + C_a a_n), a at the two ends in equal parts."""
    waves = airy(0.4, 2.5, direction=0.4, depth=6.0)
    system, t = held_bar(direction, waves, (0.3, -0.1, 0.0), added_mass_bar=0.8)
    frame = evaluate(system, fyke.State(time, system.net.positions, np.zeros((2, 3))))
    motion = waves.motion(system.net.positions, time)
    w = motion.velocity.mean(axis=0) + np.array([0.3, -0.1, 0.0])
    a = motion.acceleration.mean(axis=0)
    n, s = w - (w @ t) * t, w @ t
    drag = 0.5 * RHO * 3e-3 * 0.1 * (1.1 * np.linalg.norm(n) * n + 0.2 * abs(s) * s * t)
    displaced = RHO * np.pi / 4.0 * 3e-3**2 * 0.1
    inertia = displaced * (a + 0.8 * (a - (a @ t) * t))
    assert frame.hydrodynamic_force == pytest.approx(drag + inertia, rel=1e-9, abs=1e-12)
    assert frame.water_velocity[0] == pytest.approx(w, rel=1e-12)
    assert audit(system, fyke.Result.from_frames(system.net, _done(), 0.0, [frame])).inertia_force == (
        pytest.approx(inertia, rel=1e-9, abs=1e-12)
    )


def _done():
    return fyke.Outcome("completed", "", "", "", "", 0, 0, 0.0, 0.0)


@pytest.mark.parametrize(("density", "ratio"), [(1000.0, 1.0), (2000.0, 1.5 / 2.5), (500.0, 1.5)])
@pytest.mark.parametrize("stepper", [fyke.Implicit(rtol=1e-5, atol=1e-8), fyke.Verner()])
def test_a_free_sphere_moves_by_its_inertia(density, ratio, stepper):
    """(m + C_a rho V) a = (1 + C_a) rho V du/dt without drag and weight: amplitudes in the ratio of the masses."""
    net = fyke.line(thread(1.0), [[0.0, 0.0, -0.5]], 1.0, fixed=(), knot_diameter=0.05, knot_density=density)
    still = fyke.Coefficients(knots=fyke.ConstantKnot(0.0), added_mass_knot=0.5)
    system = fyke.make_system(net, waves=SWELL, coefficients=still)
    system = replace(system, elements=system.elements._replace(weight=np.zeros((1, 3))))
    # Begun with the velocity that belongs to the swing about a place that does not drift.
    begin = fyke.State(0.0, net.positions, ratio * SWELL.motion(net.positions, 0.0).velocity)
    result = fyke.simulate(system, duration=4.0, every=0.25, start=begin, stepper=stepper)
    water = np.array([SWELL.motion(net.positions, t).velocity[0] for t in result.time])
    size = np.abs(water).max()
    assert np.abs(result.velocity[:, 0] - ratio * water).max() < 0.02 * size


def test_a_bar_turned_by_added_mass_of_lee_has_its_sine():
    """C_a = sin(a) across the bar in water that comes at the angle a."""
    from fyke.water.inertia import LeeAddedMass

    waves = airy(0.4, 2.5, depth=6.0)
    system, t = held_bar((1.0, 0.3, -0.5), waves, (5.0, 0.0, 0.0), added_mass_bar=LeeAddedMass())
    plain, _ = held_bar((1.0, 0.3, -0.5), waves, (5.0, 0.0, 0.0), added_mass_bar=0.0)
    state = fyke.State(0.3, system.net.positions, np.zeros((2, 3)))
    more = evaluate(system, state).hydrodynamic_force - evaluate(plain, state).hydrodynamic_force
    motion = waves.motion(system.net.positions, 0.3)
    a, w = motion.acceleration.mean(axis=0), motion.velocity.mean(axis=0) + np.array([5.0, 0.0, 0.0])
    sine = np.linalg.norm(np.cross(w, t)) / np.linalg.norm(w)
    displaced = RHO * np.pi / 4.0 * 3e-3**2 * 0.1
    assert more == pytest.approx(displaced * sine * (a - (a @ t) * t), rel=1e-6)


def test_every_stepper_goes_the_same_way_in_waves():
    """Implicit at fine steps, leapfrog and Verner's pair in waves and current, wet all over: 1 mm of 135 mm."""
    system = fyke.make_system(hung(), current=(0.2, 0.0, 0.0), waves=airy(0.1, 1.5, depth=3.0))
    runs = [
        fyke.simulate(system, duration=1.0, every=0.1, stepper=stepper)
        for stepper in (fyke.Verner(), fyke.Symplectic(), fyke.Implicit(rtol=1e-4, atol=1e-8))
    ]
    for run, allowed in zip(runs[1:], (2e-4, 1e-3), strict=True):
        assert np.sqrt(((run.position - runs[0].position) ** 2).sum(axis=2).mean()) < allowed


def test_every_stepper_goes_the_same_way_through_the_surface():
    """The upper half of the panel is dry in the troughs."""
    system = fyke.make_system(hung(top=0.05), current=(0.2, 0.0, 0.0), waves=airy(0.1, 1.5, depth=3.0))
    runs = [
        fyke.simulate(system, duration=0.6, every=0.1, stepper=stepper)
        for stepper in (fyke.Verner(), fyke.Symplectic(), fyke.Implicit(rtol=1e-4, atol=1e-8))
    ]
    for run, allowed in zip(runs[1:], (5e-4, 1.5e-3), strict=True):
        assert np.sqrt(((run.position - runs[0].position) ** 2).sum(axis=2).mean()) < allowed


def test_held_water_is_second_order_in_its_spans(monkeypatch):
    """Half the span, a quarter of the error, with steps so fine that the span is all that errs."""
    system = fyke.make_system(hung((2, 2)), waves=airy(0.1, 1.5, depth=3.0))

    def run(span):
        monkeypatch.setattr(held_water, "VARIES", span)
        monkeypatch.setattr(held_water, "LONGEST", span)
        fine = fyke.Verner(rtol=1e-9, atol=1e-10)
        return fyke.simulate(system, duration=0.4, every=0.4, stepper=fine).position[-1]

    best = run(1e-3)
    errors = [np.abs(run(span) - best).max() for span in (0.04, 0.02, 0.01)]
    assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 1.8


@pytest.mark.parametrize("stepper", [fyke.Implicit(), fyke.Symplectic(), fyke.Verner(), fyke.Auto()])
def test_a_run_in_waves_is_taken_up_to_the_same_bits(stepper):
    waves = irregular(0.1, 1.5, components=20, gamma=3.3, depth=3.0)
    system = fyke.make_system(hung((2, 2)), current=(0.2, 0.0, 0.0), waves=waves)
    kept = []
    whole = fyke.simulate(system, duration=0.3, every=0.05, stepper=stepper, on_checkpoint=kept.append)
    part = (kept[3], [whole.frame(k) for k in range(4)])
    again = fyke.simulate(system, duration=0.3, every=0.05, stepper=stepper, resume=part)
    assert np.array_equal(again.position, whole.position)
    assert np.array_equal(again.velocity, whole.velocity)


def test_a_current_that_has_risen_is_the_steady_one():
    """After the ramp and a while of rest the net hangs as statics says for the full current."""
    twine = fyke.Twine("n", 1140.0, 3e-3, fyke.LinearLaw(1e7), damping_time=5e-3)
    net = replace(hung((2, 2)), twines=(twine,))
    full = UniformCurrent((0.3, 0.1, 0.0))
    still = fyke.solve_static(fyke.make_system(net, current=full))
    system = fyke.make_system(net, current=RampedCurrent(full, 1.0))
    for stepper in (fyke.Implicit(), fyke.Symplectic()):
        settle = fyke.Settle(force=1e-5)
        run = fyke.simulate(system, duration=20.0, every=0.5, stepper=stepper, settle=settle)
        # At rest before it began is not at rest: nothing acts at time 0 but weight.
        assert run.time[-1] > 1.0
        assert np.abs(run.position[-1] - still.position[-1]).max() < 1e-4


def test_energy_in_waves_adds_up():
    """What waves and current give is in drag, twine, motion and stretch: the remainder is small and falls."""
    system = fyke.make_system(hung((2, 2)), current=(0.2, 0.0, 0.0), waves=airy(0.1, 1.5, depth=3.0))
    parts = []
    for every in (4e-3, 2e-3):
        run = fyke.simulate(system, duration=0.6, every=every, stepper=fyke.Symplectic())
        energy = audit(system, run).energy
        parts.append(abs(energy.remainder) / energy.drag_dissipation)
        assert energy.inertia_work != 0.0
    assert parts[1] < 0.02
    assert parts[1] < parts[0] * 1.2


def test_auto_begins_implicitly_in_waves():
    """In water that never stands still the net never comes to rest, by which the plan for steady water counts."""
    system = fyke.make_system(hung((6, 6)), waves=airy(0.1, 1.5, depth=3.0))
    run = fyke.Auto(duration=1.0).start(system, system.at_rest())
    assert run.story() == "implicit, in water that keeps changing"
