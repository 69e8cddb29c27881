"""Dynamics: the same rest as statics, energy, output times, failures as values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.evaluate import evaluate
from fyke.solve.dynamic import output_times

STEPPERS = [fyke.Verner(), fyke.Symplectic()]


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
def test_released_panel_comes_to_the_static_rest(framed, stepper):
    """Released flat and at rest, 20 us of twine damping, until nothing is out of balance by more than 1e-6 N."""
    system = framed(damping_time=2e-5)
    static = fyke.solve_static(system)
    result = fyke.simulate(system, duration=3.0, every=0.02, stepper=stepper, settle=fyke.Settle(force=1e-6))
    assert result.outcome.name == "converged"
    assert result.unbalanced_force[-1] < 1e-6
    assert np.abs(result.position[-1] - static.position[-1]).max() < 1e-6
    assert np.abs(result.tension[-1] - static.tension[-1]).max() < 1e-4 * static.tension.max()


def test_leapfrog_comes_to_rest_without_twine_damping(framed):
    """A step too near to the stability bound keeps an undamped panel ringing for ever, with ten times the tension."""
    system = framed()
    static = fyke.solve_static(system)
    end = fyke.simulate(system, duration=2.5, every=2.5, stepper=fyke.Symplectic()).frame()
    assert np.abs(end.position - static.position[-1]).max() < 1e-6
    assert end.tension.max() == pytest.approx(static.tension.max(), rel=0.01)


def total_energy(system, frame):
    """Kinetic, elastic (linear law) and potential energy of weight less buoyancy, J."""
    el = system.elements
    ends = frame.position[system.net.bars]
    stretch = np.maximum(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - el.rest_length, 0.0)
    elastic = 0.5 * (el.stiffness * stretch**2).sum()
    return frame.kinetic_energy + elastic - (el.weight * frame.position).sum()


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
def test_energy_never_grows_without_a_current(framed, stepper):
    """A stretched and pushed panel in still water only loses energy.

    The added mass is that of the knots alone: a mass that turns with its bar without the gyroscopic terms, as
    M a = F has it, exchanges energy with the water.
    """
    system = framed(current=(0.0, 0.0, 0.0), coefficients=fyke.Coefficients(added_mass_bar=0.0))
    rng = np.random.default_rng(5)
    free = system.elements.free[:, None]
    x = system.net.positions * 1.15 + free * rng.normal(scale=1e-3, size=(145, 3))
    x = np.where(free > 0, x, system.net.positions)
    start = fyke.State(0.0, x, free * rng.normal(scale=0.1, size=(145, 3)))
    result = fyke.simulate(system, duration=0.05, every=1e-3, stepper=stepper, start=start)
    energy = np.array([total_energy(system, result.frame(i)) for i in range(len(result.time))])
    above_rest = energy - total_energy(system, fyke.solve_static(system).frame())
    assert above_rest[-1] < 0.2 * above_rest[0]
    assert np.diff(energy).max() < 1e-6 * above_rest[0]


def test_momentum_of_a_free_net_without_water(framed):
    """A floating panel in vacuum and without gravity keeps its momentum and its moment of momentum."""
    system = framed(fixed="none", current=(0.0, 0.0, 0.0), water=fyke.Water(density=1e-9, gravity=0.0))
    rng = np.random.default_rng(2)
    x = system.net.positions * 1.15
    start = fyke.State(0.0, x, rng.normal(scale=0.5, size=x.shape))
    end = fyke.simulate(system, duration=0.02, stepper=fyke.Symplectic(), start=start).frame()
    mass = system.elements.knot_mass[:, None]
    assert np.abs((mass * (end.velocity - start.velocity)).sum(axis=0)).max() < 1e-10
    spin = np.cross(end.position, mass * end.velocity).sum(axis=0) - np.cross(x, mass * start.velocity).sum(
        axis=0
    )
    assert np.abs(spin).max() < 1e-10


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
def test_frames_come_at_the_asked_times(framed, stepper):
    seen = []
    result = fyke.simulate(framed(), duration=0.0105, every=0.002, stepper=stepper, on_frame=seen.append)
    assert result.time == pytest.approx([0, 0.002, 0.004, 0.006, 0.008, 0.01, 0.0105], abs=1e-15)
    assert [f.time for f in seen] == result.time.tolist()
    assert result.outcome.name == "completed" and result.outcome.ok
    assert result.frame(2).position is not result.frame(3).position


def test_output_times():
    assert output_times(1.0, 0.25).tolist() == [0, 0.25, 0.5, 0.75, 1.0]
    assert output_times(1.0, 0.4).tolist() == [0, 0.4, 0.8, 1.0]
    assert len(output_times(2.0, None)) == 101
    assert output_times(0.5, 0.5).tolist() == [0, 0.5]


def test_frames_at_the_asked_times_lie_on_the_same_motion(framed):
    """What lies between the frames does not depend on how many are asked for."""
    system = framed(damping_time=2e-5)
    few = fyke.simulate(system, duration=0.02, every=0.02, stepper=fyke.Verner(rtol=1e-8, atol=1e-11))
    many = fyke.simulate(system, duration=0.02, every=0.0007, stepper=fyke.Verner(rtol=1e-8, atol=1e-11))
    assert np.abs(few.position[-1] - many.position[-1]).max() < 1e-9


def test_not_settled_is_said(framed):
    outcome = fyke.simulate(framed(), duration=0.01, settle=fyke.Settle(force=1e-9, energy=1e-12)).outcome
    assert outcome.name == "not_settled" and not outcome.ok
    assert "unbalanced force" in outcome.message and "damping_time" in outcome.advice


def test_a_fault_names_time_and_knot_and_keeps_the_last_frames(framed):
    system = framed()
    broken = replace(system, elements=system.elements._replace(stiffness=system.elements.stiffness * np.nan))
    start = fyke.State(0.0, system.net.positions * 1.2, np.zeros((145, 3)))
    for stepper in STEPPERS:
        result = fyke.simulate(broken, duration=0.01, stepper=stepper, start=start)
        assert result.outcome.name == "not_finite"
        assert "after t = 0 s" in result.outcome.message and "knot " in result.outcome.message
        assert np.all(np.isfinite(result.position))


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
def test_ctrl_c_keeps_the_frames_so_far(framed, stepper):
    calls = []

    def progress(fraction, text):
        calls.append((fraction, text))
        if fraction > 0.3:
            raise KeyboardInterrupt

    result = fyke.simulate(framed(), duration=0.2, every=0.01, stepper=stepper, on_progress=progress)
    assert result.outcome.name == "interrupted" and not result.outcome.ok
    assert 0.3 < result.time[-1] / 0.2 < 0.6
    assert result.time[-1] == result.outcome.time
    assert "t = " in calls[0][1]


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
def test_same_input_same_bits(framed, stepper):
    a, b = (fyke.simulate(framed(), duration=0.02, stepper=stepper) for _ in range(2))
    assert a.position.tobytes() == b.position.tobytes()


def test_ctrl_c_before_the_first_frame(framed):
    def stop(frame):
        if not seen:
            seen.append(frame)
            raise KeyboardInterrupt

    seen = []
    result = fyke.simulate(framed(), duration=0.2, on_frame=stop)
    assert result.outcome.name == "interrupted"
    assert result.time.tolist() == [0.0]


def test_strain_beyond_thirty_percent_is_told(framed):
    """A modulus of 1 MPa lets the bars stretch far beyond any measured law."""
    system = framed(size=(0.34, 0.34), current=(3.0, 0.0, 0.0))
    soft = fyke.Twine("rubber", 1140.0, 1.5e-3, fyke.LinearLaw(1e6))
    system = fyke.make_system(replace(system.net, twines=(soft,)), current=(3.0, 0.0, 0.0))
    result = fyke.solve_static(system)
    (warning,) = result.outcome.warnings
    ends = result.position[-1][system.net.bars]
    strain = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max() / 0.03 - 1.0
    assert f"reaches {100 * strain:.0f} %" in warning and "above 30 %" in warning
    assert fyke.solve_static(framed()).outcome.warnings == ()


def test_held_knots_stay(framed):
    system = framed()
    result = fyke.simulate(system, duration=0.05, stepper=fyke.Symplectic())
    held = system.net.fixed
    assert np.array_equal(result.position[-1][held], system.net.positions[held])
    assert np.all(result.velocity[:, held] == 0.0)


def test_leapfrog_keeps_its_energy_at_the_stable_step(nylon):
    """A taut square net without water, whose highest frequency is 2 sqrt(k/m)."""
    net = fyke.panel(nylon, mesh="square", meshes=(6, 6), bar_length=0.03, size=(0.182, 0.182), fixed="edges")
    system = fyke.make_system(net, water=fyke.Water(density=1e-9, gravity=0.0))
    bound = fyke.Symplectic().stability_bound(system, system.at_rest())
    mass = system.elements.knot_mass.max()
    assert bound == pytest.approx(2.0 / (2.0 * np.sqrt(system.elements.stiffness[0] / mass)), rel=0.08)
    rng = np.random.default_rng(0)
    start = fyke.State(
        0.0, net.positions, system.elements.free[:, None] * rng.normal(scale=1e-4, size=(49, 3))
    )
    energy = [total_energy(system, evaluate(system, start))]
    end = fyke.simulate(system, duration=2000 * bound, stepper=fyke.Symplectic(), start=start).frame()
    assert total_energy(system, end) == pytest.approx(energy[0], rel=1e-2)


def test_a_knot_without_mass_is_named(nylon):
    weightless = replace(nylon, density=0.0)
    net = fyke.line(weightless, [[0, 0, 0], [0.03, 0, 0], [0.06, 0, 0]], 0.03)
    outcome = fyke.simulate(
        fyke.make_system(net, coefficients=fyke.Coefficients(added_mass_bar=0.0)), duration=0.01
    ).outcome
    assert outcome.name == "singular" and "knot 1 is free and has no mass" in outcome.message


def test_held_knots_need_no_mass(nylon):
    """A weightless line with a ball in its middle, swinging in still water."""
    net = fyke.line(
        replace(nylon, density=0.0), [[-1.1, 0, 0], [0.05, 0, 0], [1.1, 0, 0]], 1.0, knot_diameter=[0, 0.1, 0],
        knot_density=1000.0,
    )  # fmt: skip
    for stepper in STEPPERS:
        assert fyke.simulate(fyke.make_system(net), duration=0.01, stepper=stepper).outcome.ok


def test_tolerances_of_verner_must_be_reachable():
    with pytest.raises(ValueError, match="atol 0 must be above 0"):
        fyke.Verner(atol=0.0)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"duration": 0.0}, "duration must be a number of seconds above 0, not 0"),
        ({"duration": np.nan}, "duration must be a number of seconds above 0, not nan"),
        ({"duration": np.inf}, "duration must be a number of seconds above 0, not inf"),
        ({"duration": 1.0, "every": -0.1}, "every must be a number of seconds above 0, not -0.1"),
        ({"duration": 1.0, "every": 2.0}, "every 2 s is longer than the duration of 1 s"),
        ({"duration": 1.0, "every": 1e-8}, r"makes 1e\+08 frames"),
        ({"duration": 1.0, "stepper": fyke.Verner(max_step=2.0)}, "at most the duration of 1 s, not 2 s"),
        ({"duration": 1.0, "stepper": fyke.Auto(max_step=-1e-3)}, "max_step must be above 0"),
    ],
)
def test_times_that_contradict_each_other_are_refused(framed, options, words):
    with pytest.raises(ValueError, match=words):
        fyke.simulate(framed(), **options)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (fyke.Settle, "needs force"),
        (lambda: fyke.Settle(force=0.0), "force of Settle must be above 0"),
        (lambda: fyke.Settle(energy=np.nan), "energy of Settle must be above 0"),
        (lambda: fyke.Auto(rtol=-1e-3), "rtol -0.001 must not be below 0"),
        (lambda: fyke.Auto(atol=0.0), "atol 0 must be above 0"),
    ],
)
def test_limits_that_nothing_meets_are_refused(make, words):
    with pytest.raises(ValueError, match=words):
        make()


@pytest.mark.parametrize("stepper", [fyke.Implicit(atol=1e-17, rtol=0.0), fyke.Verner(max_step=1e-14)])
def test_a_step_at_its_floor_ends_the_run_with_the_last_good_state(framed, stepper):
    """From a state in motion: what was reached between two outputs is the last frame."""
    start = fyke.simulate(framed(), duration=0.05, stepper=fyke.Symplectic()).state()
    start = replace(start, tension=None)
    result = fyke.simulate(framed(), duration=0.01, stepper=stepper, start=start)
    outcome = result.outcome
    assert outcome.name == "step_too_small" and not outcome.ok
    assert "the step fell to" in outcome.message and "fastest knot" in outcome.message
    assert "loosen rtol and atol" in outcome.advice
    assert result.time[-1] == outcome.time
    assert all(np.all(np.isfinite(getattr(result, name))) for name in ("position", "velocity", "tension"))
