"""The accounts of a run against work and energy in closed form, and against quadrature."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

import fyke
from fyke.forces.evaluate import evaluate
from fyke.results import summary, write_summary
from fyke.results.audit import audit, elastic_energy
from reference import NO_FORCES, NO_WATER, thread
from test_results_store import OUTCOME

EXACT = fyke.Verner(rtol=1e-10, atol=1e-12)


def moving(system, states):
    """Result of a motion that is laid down rather than solved."""
    return fyke.Result.from_frames(system.net, OUTCOME, 0.0, [evaluate(system, state) for state in states])


def thinned(result, n):
    """Every n-th frame of a result, the last included."""
    assert (len(result.time) - 1) % n == 0
    frames = [result.frame(k) for k in range(0, len(result.time), n)]
    return fyke.Result.from_frames(result.net, result.outcome, result.weight_in_water, frames)


def remainders(system, result, steps):
    return [abs(audit(system, thinned(result, n)).energy.remainder) for n in steps]


def order(errors):
    """Order of errors whose intervals double from one to the next."""
    return np.log2(np.array(errors[1:]) / errors[:-1])


DIAMETER, DENSITY, DRAG = 0.01, 1140.0, 0.47
WEIGHT = 140.0 * 9.81 * np.pi / 6.0 * DIAMETER**3
TERMINAL = np.sqrt(4.0 / 3.0 * 0.14 * 9.81 * DIAMETER / DRAG)


def sphere(current, velocity):
    """One free knot that falls at its terminal speed through the water, watched for two seconds."""
    net = fyke.line(
        thread(1.0), [[0.0, 0.0, 0.0]], 1.0, fixed=(), knot_diameter=DIAMETER, knot_density=DENSITY
    )
    system = fyke.make_system(
        net, current=current, coefficients=fyke.Coefficients(knots=fyke.ConstantKnot(DRAG))
    )
    start = fyke.State(0.0, net.positions, np.array([velocity]))
    result = fyke.simulate(system, duration=2.0, every=0.25, start=start, stepper=EXACT)
    return audit(system, result)


def test_sphere_at_terminal_speed_turns_the_work_of_its_weight_into_drag():
    accounts = sphere((0.0, 0.0, 0.0), (0.0, 0.0, -TERMINAL))
    energy, work = accounts.energy, WEIGHT * TERMINAL * 2.0
    assert energy.drag_dissipation == pytest.approx(work, rel=1e-9)
    assert energy.potential == pytest.approx(-work, rel=1e-9)
    assert energy.water_work == pytest.approx(-work, rel=1e-9)
    for nothing in (energy.current_work, energy.kinetic, energy.elastic, energy.twine_dissipation):
        assert abs(nothing) < 1e-9 * work
    assert abs(energy.remainder) < 1e-9 * work
    assert accounts.unbalanced_force < 1e-9 * WEIGHT and accounts.unbalanced_knot == "0"


def test_dissipation_by_drag_is_the_same_for_an_observer_who_drifts_along():
    """A rising current that holds the sphere in place pays for the drag; one across the fall pays nothing."""
    work = WEIGHT * TERMINAL * 2.0
    held = sphere((0.0, 0.0, TERMINAL), (0.0, 0.0, 0.0)).energy
    assert (held.current_work, held.drag_dissipation) == pytest.approx((work, work), rel=1e-9)
    assert abs(held.potential) < 1e-9 * work
    drifting = sphere((0.8, 0.0, 0.0), (0.8, 0.0, -TERMINAL)).energy
    assert drifting.drag_dissipation == pytest.approx(work, rel=1e-9)
    assert abs(drifting.current_work) < 1e-9 * work


# Mass between two bars that stay taut, of 2 N/m in all together 4 N/m, let go at PULL from the middle: w = 2 rad/s.
FREQUENCY, PULL = 2.0, 0.05


def mass_between_bars():
    knot = 0.1
    net = fyke.line(
        thread(2.0, density=0.0),
        [[-1.1, 0.0, 0.0], [PULL, 0.0, 0.0], [1.1, 0.0, 0.0]],
        1.0,
        knot_diameter=knot,
        knot_density=1.0 / (np.pi / 6.0 * knot**3),
    )
    return fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)


def test_undamped_mass_swaps_elastic_for_kinetic_energy():
    """In the middle of the swing 1/2 m (w A)^2 has gone from the bars to the mass."""
    system, quarter = mass_between_bars(), np.pi / 2.0 / FREQUENCY
    energy = audit(system, fyke.simulate(system, duration=quarter, every=quarter, stepper=EXACT)).energy
    peak = 0.5 * 1.0 * (FREQUENCY * PULL) ** 2
    assert (energy.kinetic, energy.elastic) == pytest.approx((peak, -peak), rel=1e-9)
    assert abs(energy.remainder) < 1e-9 * peak
    others = (energy.potential, energy.current_work, energy.drag_dissipation, energy.twine_dissipation)
    assert others == (0.0, 0.0, 0.0, 0.0) and energy.added_mass_work == 0.0


def test_what_a_coarse_step_does_to_the_energy_is_left_over():
    """Leapfrog keeps 1/2 v^2 + 1/2 w^2 x^2 (1 - (w h)^2/4) exactly, so it loses w^2 h^2/8 w^2 (A^2 - x^2)."""
    system, quarter = mass_between_bars(), np.pi / 2.0 / FREQUENCY
    for n in (16, 32):
        result = fyke.simulate(
            system, duration=quarter, every=quarter, stepper=fyke.Symplectic(max_step=quarter / n)
        )
        way = PULL**2 - result.position[-1, 1, 0] ** 2
        lost = (FREQUENCY * quarter / n) ** 2 / 8.0 * FREQUENCY**2 * way
        assert audit(system, result).energy.remainder == pytest.approx(lost, rel=1e-8)


# A mass of 1 kg on a Kelvin-Voigt bar of 100 N/m and 2 Ns/m, held taut by a dead load of 20 N.
SPRING, RETARDATION, LOAD, STRETCH = 100.0, 0.02, 20.0, 0.1


def test_twine_dissipates_what_the_damped_oscillator_does():
    knot = 0.1
    twine = replace(thread(SPRING, density=0.0), damping_time=RETARDATION)
    middle = 1.0 + LOAD / SPRING
    load = np.array([[0.0, 0.0, 0.0], [LOAD, 0.0, 0.0]])
    net = fyke.line(
        twine,
        [[0.0, 0.0, 0.0], [middle + STRETCH, 0.0, 0.0]],
        1.0,
        fixed=(0,),
        load=load,
        knot_diameter=knot,
        knot_density=1.0 / (np.pi / 6.0 * knot**3),
    )
    system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
    result = fyke.simulate(system, duration=1.0, every=1.0 / 64, stepper=EXACT)
    damper, slow = SPRING * RETARDATION, SPRING * RETARDATION / 2.0
    fast = np.sqrt(SPRING - slow**2)

    def speed(t):
        return -STRETCH * SPRING / fast * np.exp(-slow * t) * np.sin(fast * t)

    exact = quad(lambda t: damper * speed(t) ** 2, 0.0, 1.0, epsabs=1e-14)[0]
    errors = [audit(system, thinned(result, n)).energy.twine_dissipation - exact for n in (1, 2, 4)]
    assert abs(errors[0]) < 2e-3 * exact
    assert order(np.abs(errors)) == pytest.approx(2.0, abs=0.1)
    energy = audit(system, result).energy
    assert energy.remainder == pytest.approx(-errors[0], abs=1e-9)
    end = result.position[-1, 1, 0]
    assert energy.elastic == pytest.approx(
        0.5 * SPRING * ((end - 1.0) ** 2 - (middle + STRETCH - 1.0) ** 2), rel=1e-9
    )
    assert energy.potential == pytest.approx(-LOAD * (end - middle - STRETCH), rel=1e-9)
    assert energy.kinetic == pytest.approx(0.5 * speed(1.0) ** 2, rel=1e-7)


def test_elastic_energy_is_the_integral_of_the_law():
    power = fyke.Twine("power", 1140.0, 2e-3, fyke.PowerLaw(345.37e6, 1.0121))
    points = (0.0, 0.01, 0.04, 0.05), (0.0, 30.0, 60.0, 140.0)
    table = fyke.Twine("table", 1140.0, 2e-3, fyke.TableLaw(*points))
    stiff = fyke.Twine("stiff", 1140.0, 2e-3, fyke.PowerLaw(3e9, 1.7))
    laws = (
        lambda strain: 4e-6 * 345.37e6 * strain**1.0121,
        lambda strain: np.interp(strain, *points) + 8000.0 * max(strain - 0.05, 0.0),
        lambda strain: 4e-6 * 3e9 * strain**1.7,
        lambda strain: 700.0 * strain,
    )
    bars = 24
    net = fyke.line(power, np.outer(np.arange(bars + 1.0), [1.0, 0.0, 0.0]), np.linspace(0.5, 2.0, bars))
    which = np.arange(bars) % 4
    net = replace(net, twines=(power, table, stiff, thread(700.0)), twine_of_bar=which)
    strain = np.repeat([-0.2, 0.0, 0.006, 0.01, 0.047, 0.09], 4)
    energy = elastic_energy(fyke.make_system(net).elements, net.rest_length * (1.0 + strain))
    exact = [
        length * quad(laws[k], 0.0, max(s, 0.0), points=[0.01, 0.04, 0.05], epsabs=1e-13)[0]
        for length, k, s in zip(net.rest_length, which, strain, strict=True)
    ]
    assert energy == pytest.approx(exact, rel=1e-9, abs=1e-13)
    assert energy[:8].tolist() == [0.0] * 8


def test_added_mass_of_a_bar_that_turns_across_its_way():
    """A bar turns from along its way to across it: the water at it gains 1/2 C_a rho pi/4 d^2 L V^2."""
    speed, spin, half = 0.7, 3.0, 0.25
    net = fyke.line(thread(1.0, diameter=0.02), [[-half, 0.0, 0.0], [half, 0.0, 0.0]], 2.0 * half, fixed=())
    system = fyke.make_system(
        net,
        coefficients=fyke.Coefficients(
            bars=fyke.ConstantBar(0.0, 0.0),
            knots=fyke.ConstantKnot(0.0),
            added_mass_bar=1.0,
            added_mass_knot=0.0,
        ),
    )
    states = []
    for time in np.linspace(0.0, np.pi / 2.0 / spin, 33):
        along = np.array([np.cos(spin * time), np.sin(spin * time), 0.0])
        turning = spin * half * np.array([-along[1], along[0], 0.0])
        way = np.array([speed, 0.0, 0.0])
        places = np.array([way * time - half * along, way * time + half * along])
        states.append(fyke.State(time, places, np.array([way - turning, way + turning])))
    result = moving(system, states)
    exact = 0.5 * 1000.0 * np.pi / 4.0 * 0.02**2 * 2.0 * half * speed**2
    errors = [audit(system, thinned(result, n)).energy.added_mass_work - exact for n in (1, 2, 4)]
    assert abs(errors[0]) < 1e-3 * exact
    assert order(np.abs(errors)) == pytest.approx(2.0, abs=0.05)
    assert audit(system, result).energy.kinetic == pytest.approx(exact, rel=1e-9)


def test_pendulum_at_the_bottom_pulls_three_times_its_weight():
    """Let go level, m v^2 / L = 2 m g at the bottom: the inertia force is load less reaction, 2 m g upwards."""
    knot, mass = 0.02, 0.004
    pull = 3.0 * mass * 9.81
    length = 1.0 + pull / 50.0
    net = fyke.line(
        thread(50.0, density=0.0),
        [[0.0, 0.0, 0.0], [0.0, 0.0, -length]],
        1.0,
        fixed=(0,),
        knot_diameter=[0.0, knot],
        knot_density=mass / (np.pi / 6.0 * knot**3),
    )
    system = fyke.make_system(net, water=fyke.Water(density=0.0), coefficients=NO_FORCES)
    velocity = np.array([[0.0, 0.0, 0.0], [np.sqrt(2.0 * 9.81 * length), 0.0, 0.0]])
    accounts = audit(system, moving(system, [fyke.State(0.0, net.positions, velocity)]))
    assert accounts.load == pytest.approx([0.0, 0.0, -mass * 9.81])
    assert accounts.load_less_reaction == pytest.approx([0.0, 0.0, 2.0 * mass * 9.81])
    assert accounts.relative_difference == pytest.approx(2.0)
    assert (accounts.unbalanced_force, accounts.unbalanced_knot) == (pytest.approx(2.0 * mass * 9.81), "1")
    assert accounts.energy is None


def test_statics_leaves_nothing_over(framed):
    system = framed()
    accounts = audit(system, fyke.solve_static(system))
    assert accounts.energy is None
    assert accounts.unbalanced_force < 1e-8 and accounts.unbalanced_knot in system.net.labels
    assert accounts.relative_difference < 1e-8
    volume = 256 * 0.03 * np.pi / 4 * 0.0015**2 + 145 * np.pi / 6 * 0.0035**3
    assert accounts.load[2] < 0.0 and accounts.load_size > 1.0
    # The panel hangs upright and bags out evenly: across the current the loads add up to the weight in water.
    assert abs(accounts.load[1]) < 1e-9
    assert accounts.load[2] == pytest.approx(-140.0 * 9.81 * volume, rel=0.02)


def test_panel_that_drifts_while_slack_closes_to_second_order(framed):
    """Nothing snaps before 0.03 s: smooth motion, so the error of sampling falls with the interval squared."""
    system = framed(damping_time=20e-6)
    result = fyke.simulate(system, duration=0.0288, every=2e-4, stepper=fyke.Verner())
    assert not result.tension.any()
    errors = remainders(system, result, (1, 2, 4, 8))
    assert order(errors) == pytest.approx(2.0, abs=0.05)
    energy = audit(system, result).energy
    assert errors[0] < 1e-4 * energy.current_work
    # Without the added mass that turns the accounts would not close: it is far more than what is left over.
    assert abs(energy.added_mass_work) > 30.0 * errors[0]


def test_released_panel_closes_within_two_percent_through_its_snaps(framed):
    system = framed(damping_time=20e-6)
    result = fyke.simulate(system, duration=0.3, every=5e-4, stepper=fyke.Symplectic())
    energy = audit(system, result).energy
    assert result.kinetic_energy.max() > 1000.0 * result.kinetic_energy[-1]
    assert abs(energy.remainder) < 0.02 * energy.current_work
    assert 0.0 < energy.twine_dissipation < 0.05 * energy.drag_dissipation


def test_drag_never_gives_energy(framed):
    """Frame by frame, whichever way the knots move: no work is left of F.(u - v) but heat."""
    system, rng = framed(current=(0.3, -0.4, 0.2)), np.random.default_rng(2)
    still = system.at_rest()
    for _ in range(20):
        velocity = rng.normal(size=still.velocity.shape)
        states = [replace(still, time=time, velocity=velocity) for time in (0.0, 1.0)]
        assert audit(system, moving(system, states)).energy.drag_dissipation > 0.0


def test_result_of_another_net_is_refused(framed):
    result = fyke.solve_static(framed())
    with pytest.raises(ValueError, match="another net"):
        audit(framed(meshes=(4, 4), size=(0.15, 0.15)), result)


def test_summary_ends_with_the_accounts(framed, tmp_path: Path):
    system = framed(meshes=(2, 2), size=(0.075, 0.075))
    result = fyke.simulate(system, duration=0.01, every=0.005, stepper=fyke.Symplectic())
    accounts = audit(system, result)
    read = json.loads(write_summary(summary(result, audit=accounts), tmp_path).read_text("utf-8"))["audit"]
    assert read["load"] == accounts.load.tolist()
    assert read["energy"] == asdict(accounts.energy) | {"water_work": accounts.energy.water_work}
    assert read["unbalanced_knot"] == accounts.unbalanced_knot
    broken = replace(accounts, load=np.array([np.nan, 0.0, 0.0]), load_size=np.inf)
    kept = summary(result, audit=broken)["audit"]
    assert (kept["load"], kept["load_size"]) == ([None, 0.0, 0.0], None)
    assert summary(result)["audit"] is None


def test_tensions_of_an_implicit_run_carry_its_budget(framed):
    """In the middle of the motion, between steps: no heat in undamped twine, no energy in a false stretch."""
    system = framed()
    result = fyke.simulate(system, duration=0.15, every=0.0007, stepper=fyke.Implicit(rtol=1e-3))
    energy = audit(system, result).energy
    assert energy is not None
    assert energy.twine_dissipation == 0.0
    # What is left over is the ringing of the snaps that the method damps: lost, and not much.
    assert 0.0 < energy.remainder < 0.05 * energy.current_work
    # By hand for the linear law: T^2 / 2k of every bar.
    stiffness = np.pi / 4 * 1.5e-3**2 * 1e9 / 0.03
    change = (result.tension[-1] ** 2 - result.tension[0] ** 2).sum() / (2.0 * stiffness)
    assert energy.elastic == pytest.approx(change, rel=1e-9, abs=1e-15)
