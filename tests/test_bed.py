"""The sea bed: what it bears, how it damps and rubs, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.bed import OnBed, footprint
from fyke.netting.rigging import Sphere, with_bodies
from fyke.results.audit import audit
from fyke.water.bed import CREEP, SOFT, Bed
from fyke.water.waves import airy
from mooring import CHAIN, WATER, mooring, weight_of
from reference import NO_FORCES, thread


@pytest.mark.parametrize("statics", [True, False])
def test_tangents_are_the_differences_of_the_force(statics):
    rng = np.random.default_rng(1)
    net = fyke.line(CHAIN, rng.normal(size=(9, 3)), 1.0)
    bed = Bed(0.0, friction=0.7, laid=net.positions[:, :2] + 3e-3 if statics else None)
    system = fyke.make_system(net)
    h = SOFT * CHAIN.diameter
    x = net.positions.copy()
    x[:, :2] += rng.normal(size=(9, 2)) * 3e-3
    x[:, 2] = -np.linspace(-0.5, 3.0, 9) * h  # above, where the ground begins to bear, and below
    v = np.zeros((9, 3)) if statics else rng.normal(size=(9, 3)) * [2 * CREEP, 2 * CREEP, 3e-3]
    part = OnBed(system, bed)
    part.see(x, v, 0.0)
    by_x, by_v = part.by_x.copy(), part.by_v.copy()
    assert np.count_nonzero(part.force[:, 2]) >= 6
    for tangent, at, small in ((by_x, x, 1e-7), (by_v, v, 1e-7)):
        if statics and at is v:
            continue
        for q in range(3):
            both = []
            for sign in (1.0, -1.0):
                at[:, q] += sign * small
                part.see(x, v, 0.0)
                both.append(part.force.copy())
                at[:, q] -= sign * small
            slope = (both[0] - both[1]) / (2.0 * small)
            assert tangent[:, :, q] == pytest.approx(slope, abs=2e-4 * np.abs(tangent).max())


def test_a_rod_sinks_in_by_its_weight_over_stiffness_and_diameter():
    """p - h / 2 = w / (k d), whatever its length; steel lies in 1.7 % of its diameter deeper than the soft half."""
    steel = replace(thread(1e8, 0.03), density=7850.0)
    net = fyke.line(steel, np.outer(np.arange(5.0), [1.0, 0.0, 0.0]) - [0.0, 0.0, 50.0], 1.0, fixed=())
    net.fixed[0] = True
    bed = Bed(50.0, stiffness=1e5)
    result = fyke.solve_static(fyke.make_system(net, water=WATER, bed=bed), tolerance=1e-9)
    assert result.outcome.ok
    depth = -50.0 - result.position[-1, 2:, 2]  # the first one hangs between the anchor and the others
    assert depth[1:] == pytest.approx(weight_of(steel) / (1e5 * 0.03) + 0.5 * SOFT * 0.03, rel=1e-4)
    # The default: w = pi/4 d^2 (rho_s - rho) g.
    assert weight_of(steel) / (Bed(50.0).stiffness * 0.03**2) == pytest.approx(0.0175, abs=3e-4)


def test_bodies_stand_on_the_ground_by_their_radius():
    net = fyke.line(thread(1e5), [[0.0, 0.0, -3.0], [0.0, 0.0, -9.5]], 8.0, fixed=(0,))
    ball = Sphere(mass=30.0, diameter=0.2)
    net = with_bodies(net, ball.at([1], name="lead", kind="sinker"))
    system = fyke.make_system(net, water=WATER, bed=Bed(10.0))
    result = fyke.solve_static(system, tolerance=1e-9)
    # Weight below what sinks in by the soft part, where N = k A p^2 / (2 h).
    soft, area = SOFT * 0.2, footprint(net)[0][1]
    sink = np.sqrt(2.0 * soft * -system.elements.weight[1, 2] / (3.0e6 * area))
    assert sink < soft
    assert result.position[-1, 1, 2] == pytest.approx(-9.9 - sink, abs=1e-9)


def test_what_lies_is_borne_and_all_forces_balance():
    """Weight, ground, friction and both ends together are nothing, to 1e-10 of the weight."""
    system, result = mooring(120, CHAIN, 0.5, 110.0)
    system = replace(system, bed=replace(system.bed, laid=system.net.positions[:, :2]))
    part = OnBed(system, system.bed)
    part.see(result.position[-1], np.zeros_like(result.position[-1]), 0.0)
    ground = part.force.sum(axis=0)
    whole = weight_of(CHAIN) * 120.0
    assert ground[2] > 0.4 * whole and -ground[0] > 0.05 * ground[2]
    balance = result.support_reaction[-1] - system.elements.weight.sum(axis=0) - ground
    assert np.abs(balance).max() < 1e-10 * whole
    assert result.hydrodynamic_force[-1] == pytest.approx(np.zeros(3), abs=1e-9)


def towed(pull, duration, **more):
    """Chain that lies straight on the ground, pulled at its end by a part of mu times its weight."""
    bars = 4
    points = np.outer(np.arange(bars + 1.0), [1.0, 0.0, 0.0]) - [0.0, 0.0, 10.0]
    weight = weight_of(CHAIN) * bars
    sink = 0.5 * SOFT * CHAIN.diameter + weight_of(CHAIN) / (3e6 * CHAIN.diameter)
    load = np.zeros((bars + 1, 3))
    load[-1, 0] = pull * 0.5 * weight
    net = fyke.line(CHAIN, points - [0.0, 0.0, sink], 1.0, fixed=(), load=load)
    system = fyke.make_system(net, water=WATER, coefficients=NO_FORCES, bed=Bed(10.0, friction=0.5))
    return system, fyke.simulate(system, duration=duration, stepper=fyke.Implicit(rtol=1e-4), **more)


def test_a_chain_pulled_harder_than_its_friction_speeds_up_by_the_rest():
    """a = (F - mu W) / m: 2 mu W over 1 s; the work of friction is in the accounts of energy."""
    system, result = towed(2.0, 1.0, every=0.01)
    mass, weight = system.elements.knot_mass.sum(), weight_of(CHAIN) * 4.0
    assert result.outcome.ok
    momentum = system.elements.knot_mass @ result.velocity[-1, :, 0]
    assert momentum / mass == pytest.approx(0.5 * weight / mass, rel=0.02)
    energy = audit(system, result).energy
    assert energy.parts_work < 0.0
    assert abs(energy.remainder) < 0.05 * abs(energy.potential)


def test_a_chain_pulled_less_than_its_friction_creeps():
    """Half of mu W: friction is there at v = CREEP tan(asin(1/2)), and no faster."""
    _, result = towed(0.5, 2.0)
    assert result.velocity[-1, :, 0] == pytest.approx(CREEP * np.tan(np.arcsin(0.5)), rel=0.02)


def test_a_line_that_falls_comes_to_rest_on_the_ground():
    points = np.outer(np.arange(6.0), [1.0, 0.0, 0.1]) - [0.0, 0.0, 10.0]
    net = fyke.line(CHAIN, points, 1.01, fixed=(0,))
    system = fyke.make_system(net, water=WATER, bed=Bed(10.0))
    result = fyke.simulate(system, duration=20.0)
    assert result.outcome.ok
    assert np.abs(result.velocity[-1]).max() < 2.0 * CREEP
    assert -10.01 < result.position[-1, 1:, 2].min() < result.position[-1, 1:, 2].max() < -9.99


@pytest.mark.parametrize("stepper", [fyke.Verner(), fyke.Symplectic()])
def test_explicit_steps_refuse_a_bed(stepper):
    net = fyke.line(CHAIN, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], 1.0, fixed=(0,))
    system = fyke.make_system(net, bed=Bed(10.0))
    with pytest.raises(ValueError, match="a sea bed needs an implicit method"):
        fyke.simulate(system, duration=0.1, stepper=stepper)


def test_what_is_no_bed_is_refused():
    with pytest.raises(ValueError, match="stiffness must be above 0"):
        Bed(10.0, stiffness=0.0)


def test_a_mooring_line_in_waves_keeps_finite_forces():
    """It sways between its anchor and a buoy; energy is accounted for and nothing sinks through the ground."""
    pieces = [fyke.LinePiece(CHAIN, 30.0, 30)]
    net = fyke.with_line(
        None, (0.0, 0.0, -12.0), (23.0, 0.0, -0.3), pieces, name="m", held=(True, False), bed=-12.0
    )
    net = with_bodies(net, Sphere(mass=300.0, diameter=1.5).at([30], name="buoy", kind="float"))
    sea = airy(1.0, 6.0, depth=12.0)
    system = fyke.make_system(net, current=(0.3, 0.0, 0.0), water=WATER, waves=sea, bed=Bed(12.0))
    result = fyke.simulate(system, duration=12.0, every=0.1)
    assert result.outcome.ok
    assert result.tension.max() < 1e4 and np.ptp(result.tension[60:, -1]) > 1.0
    assert result.position[:, :, 2].min() > -12.1  # 4 cm where it falls, in steps of the default accuracy
    energy = audit(system, result).energy
    assert abs(energy.remainder) < 0.1 * abs(energy.current_work)
