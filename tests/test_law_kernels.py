"""Laws of drag in the kernels: against the laws themselves, their tangents against differences, in every solver."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.angle_cells import angle_of, logarithm
from fyke.forces.bars import assemble, bar_geometry, water_load
from fyke.forces.drag import bar_water_force, bar_water_tangents
from fyke.forces.laws import coefficients_of_bars, coefficients_of_knots
from fyke.forces.surroundings import Surroundings
from fyke.forces.total import total_force, work_arrays
from fyke.solve.linear import Pattern
from fyke.solve.smooth import assemble_step
from fyke.system.curves import HIGHEST_REYNOLDS, LOWEST_REYNOLDS, knot_curve
from fyke.water.laws import LAWS, LEAST_REYNOLDS, AngleTable, BarTable, bars, knots

VISCOSITY, DIAMETER, KNOT, LENGTH = 1e-6, 1.5e-3, 3.5e-3, 0.03
TABLES = {
    "table": BarTable((10.0, 100.0, 1e4), (2.5, 1.6, 1.1), (0.3, 0.2, 0.05)),
    "angle-table": AngleTable(
        (10.0, 1000.0, 1e4),
        (0.0, 0.5, 1.0, np.pi / 2.0),
        ((0.1, 0.3, 0.8, 1.2), (0.05, 0.3, 0.7, 1.1), (0.05, 0.2, 0.7, 1.0)),
        ((0.0, 0.1, 0.3, 0.0), (0.0, 0.2, 0.3, 0.0), (0.0, 0.2, 0.3, 0.0)),
    ),
}
BARS = {name: TABLES.get(name) or law() for name, law in LAWS["bars"].items()}
KNOTS = {name: law() for name, law in LAWS["knots"].items()}


def flows(count=200, seed=1):
    """Velocities of water past a bar from 1 mm/s to 3 m/s, and directions of the bar."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        w, t = rng.normal(size=(2, 3))
        yield w * 10.0 ** rng.uniform(-3.0, 0.5), t / np.linalg.norm(t)


def law_at(w, t, system):
    """c_n, c_t and their slopes of a bar along t in water of this velocity past it."""
    el, laws = system.elements, system.drag_laws
    if laws is None:
        return float(el.normal_drag[0]), float(el.tangential_drag[0]), 0.0, 0.0, 0.0, 0.0
    out = np.empty((6, 1))
    coefficients_of_bars(LENGTH * np.array([[0.0, 0.0, 0.0], t]), np.array([w, w]), el, laws, out)
    return tuple(out[:, 0].tolist())


def one_bar(law):
    twine = fyke.Twine("n", density=1140.0, diameter=DIAMETER, law=fyke.LinearLaw(1e9))
    net = fyke.line(twine, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -LENGTH]]), LENGTH, fixed=(0,))
    return fyke.make_system(net, coefficients=fyke.Coefficients(bars=law))


@pytest.mark.parametrize("name", BARS)
def test_force_of_a_bar_is_that_of_its_law(name):
    law, system = BARS[name], one_bar(BARS[name])
    # Corners of a user's table and the joints of published pieces are a little rounder than they are said.
    rounder = {"table": 1e-4, "takagi": 1e-6, "white": 1e-11, "sucker-brauer": 1e-11, "ns-cheng": 1e-11}
    exact = isinstance(BARS[name], bars.ConstantBar | bars.Hoerner | AngleTable)
    allowed = 1e-13 if exact else rounder.get(name, 1e-7)
    for w, t in flows():
        cn, ct, *_ = law_at(w, t, system)
        force = 2.0 * np.array(bar_water_force(*w, *t, cn * LENGTH, ct * LENGTH))
        speed, along = np.linalg.norm(w), w @ t
        n = w - along * t
        across = np.linalg.norm(n)
        normal, tangential = law.force(speed * DIAMETER / VISCOSITY, np.arctan2(across, abs(along)))
        scale = 0.5 * 1000.0 * DIAMETER * LENGTH * speed**2
        expected = scale * (normal * n / across + tangential * np.sign(along) * t)
        assert np.abs(force - expected).max() < allowed * np.abs(expected).max()


@pytest.mark.parametrize("name", BARS)
def test_tangents_of_a_bar_against_differences(name):
    system = one_bar(BARS[name])

    def force(d, w):
        length = np.linalg.norm(d)
        cn, ct, *_ = law_at(w, d / length, system)
        return np.array(bar_water_force(*w, *(d / length), cn * length, ct * length))

    for w, t in flows(100):
        turn, press = np.empty((3, 3)), np.empty((3, 3))
        bar_water_tangents(w, t, law_at(w, t, system), LENGTH, turn, press)
        d, h, hw = LENGTH * t, 1e-6 * LENGTH, 1e-6 * np.linalg.norm(w)
        by_place = np.column_stack([(force(d + h * e, w) - force(d - h * e, w)) / (2 * h) for e in np.eye(3)])
        by_speed = np.column_stack(
            [(force(d, w + hw * e) - force(d, w - hw * e)) / (2 * hw) for e in np.eye(3)]
        )
        assert np.abs(turn - by_place).max() < 1e-7 * np.abs(by_place).max()
        assert np.abs(press - by_speed).max() < 1e-7 * np.abs(by_speed).max()


@pytest.mark.parametrize("name", KNOTS)
def test_drag_of_a_knot_is_that_of_its_law(name, nylon):
    law = KNOTS[name]
    net = fyke.panel(
        nylon, mesh="square", meshes=(1, 1), bar_length=LENGTH, size=(LENGTH, LENGTH), knot_diameter=KNOT
    )
    system = fyke.make_system(net, coefficients=fyke.Coefficients(knots=law, bars=bars.White()))
    scale = 0.5 * 1000.0 * np.pi / 4.0 * KNOT**2
    for speed in np.geomspace(1e-3, 3.0, 60):
        h = 1e-6 * speed**2
        speeds = np.sqrt([speed**2, speed**2 - h, speed**2 + h])
        rel = np.zeros((4, 3))
        rel[:3, 1] = speeds
        drags, slopes = np.empty((2, 4))
        coefficients_of_knots(rel, system.elements, system.drag_laws, drags, slopes)
        (drag, below, above, _), slope = drags, slopes[0]
        assert drag == pytest.approx(scale * float(law.coefficients(speed * KNOT / VISCOSITY)), rel=1e-5)
        assert slope * h == pytest.approx(0.5 * (above - below), abs=1e-9 * drag)


def two_thicknesses(nylon, meshes=(5, 4)):
    """A panel of thick and thin bars that fills no whole block of the kernels, bent and in motion."""
    net = fyke.panel(
        nylon, mesh="diamond", meshes=meshes, bar_length=LENGTH, size=(0.0424 * meshes[0], 0.0424 * meshes[1]),
        knot_diameter=KNOT,
    )  # fmt: skip
    thin = replace(nylon, name="thin", diameter=0.2 * DIAMETER)
    net = replace(
        net, twines=(*net.twines, thin), twine_of_bar=np.arange(net.bar_count) % 2,
        knot_diameter=np.linspace(0.0, KNOT, net.knot_count),
    )  # fmt: skip
    rng = np.random.default_rng(0)
    x = net.positions + rng.normal(scale=3e-3, size=net.positions.shape)
    return net, x, rng.normal(scale=0.3, size=x.shape) * 10.0 ** rng.uniform(-4.0, 0.0, (len(x), 1))


def at_this_moment(system, x, v):
    """The system with the present coefficients as constants."""
    el, _ = Surroundings(system).at(x, v, 0.0)
    return replace(system, coefficients=fyke.Coefficients(), elements=el, drag_laws=None)


@pytest.mark.parametrize("meshes", [(1, 1), (2, 3), (12, 13)])
@pytest.mark.parametrize("name", BARS)
def test_explicit_kernels_have_the_coefficients_of_the_others(name, meshes, nylon):
    """Eight bars at once by vectors, and one after the other with slopes: the law is told twice in the kernels."""
    net, x, v = two_thicknesses(nylon, meshes)
    law = fyke.Coefficients(bars=BARS[name], knots=knots.CliftGauvin())
    system = fyke.make_system(net, current=(0.5, 0.1, 0.0), coefficients=law)
    frozen = at_this_moment(system, x, v)
    forces, leaps = [], []
    for one in (system, frozen):
        out = np.full_like(x, np.nan)
        total_force(
            x, v, one.current.velocity(x, 0.0), one.elements, *work_arrays(len(x)), out, one.drag_laws
        )
        forces.append(out)
        run = fyke.Symplectic(max_step=1e-10).start(one, fyke.State(0.0, x, v))
        assert run.advance(1e-10) == "ok"
        leaps.append((run.state.velocity - v) / 1e-10)
    assert np.abs(forces[0] - forces[1]).max() < 1e-13 * np.abs(forces[1]).max()
    free = system.elements.free > 0.0
    if free.any():
        # The drag of the mean velocity is taken with the area at the reference, which differs.
        assert np.abs(leaps[0] - leaps[1])[free].max() < 2e-6 * np.abs(leaps[1][free]).max()


@pytest.mark.parametrize("name", ["choo-casarella", "hoerner", "angle-table"])
def test_still_water_and_a_lost_net(name, nylon):
    """No force but weight where nothing moves; NaN stays NaN; speeds beyond all tables are finite."""
    net, x, _ = two_thicknesses(nylon)
    law = fyke.Coefficients(bars=BARS[name], knots=knots.CliftGauvin())
    system = fyke.make_system(net, coefficients=law)
    el, laws = system.elements._replace(stiffness=np.zeros(net.bar_count)), system.drag_laws
    found, still = np.empty_like(x), np.zeros_like(x)
    total_force(x, still, still, el, *work_arrays(len(x)), found, laws)
    assert np.array_equal(found, el.weight)
    total_force(x, still, np.full_like(x, np.nan), el, *work_arrays(len(x)), found, laws)
    assert np.isnan(found).all()
    for speed in (1e-200, 1e-12, 1e8):
        total_force(x, still, np.full_like(x, speed), el, *work_arrays(len(x)), found, laws)
        assert np.isfinite(found).all()
        bars_too, knots_too = np.empty((6, net.bar_count)), np.empty((2, len(x)))
        coefficients_of_bars(x, np.full_like(x, speed), el, laws, bars_too)
        coefficients_of_knots(np.full_like(x, speed), el, laws, *knots_too)
        assert np.isfinite(bars_too).all() and np.isfinite(knots_too).all()


@pytest.mark.parametrize("law", [knots.SchillerNaumann(), knots.CliftGauvin(), knots.CliftGraceWeber()])
def test_curves_meet_their_law_at_any_speed_and_are_held_beyond(law):
    reference, curve = knot_curve(law)
    re = np.geomspace(0.1 * LOWEST_REYNOLDS, 10.0 * HIGHEST_REYNOLDS, 40_001)
    re = re[abs(re / LEAST_REYNOLDS - 1.0) > 1e-2]  # a corner, where laws themselves begin to be held
    system, ones, none = one_bar(bars.White()), np.ones_like(re), np.zeros(0)
    laws = system.drag_laws._replace(knots=curve, knot_reynolds=ones, knot_share=ones, bar_reynolds=none)
    drag, slope = np.empty((2, len(re)))
    el = system.elements._replace(knot_drag=reference * ones)
    coefficients_of_knots(re[:, None] * [0.6, 0.0, 0.8], el, laws, drag, slope)
    within = np.clip(re, LOWEST_REYNOLDS, HIGHEST_REYNOLDS)
    assert drag == pytest.approx(law.coefficients(within), rel=2e-6)
    held = (re < LOWEST_REYNOLDS) | (re > HIGHEST_REYNOLDS)
    assert np.all(slope[held] == 0.0) and held.any()
    assert 2.0 * re * slope == pytest.approx(np.where(held, 0.0, law.derivative(within)), rel=2e-3, abs=1e-7)


def test_logarithm_and_angle_of_kernels():
    """Against the mathematical library, over all that a flow can be."""
    rng = np.random.default_rng(0)
    for x in 10.0 ** rng.uniform(-100.0, 300.0, 500):
        assert logarithm(x) == pytest.approx(np.log(x), rel=3e-16, abs=3e-16)
    for n, s in 10.0 ** rng.uniform(-20.0, 20.0, (500, 2)):
        assert angle_of(n, s) == pytest.approx(np.arctan2(n, s), rel=4e-16)


@pytest.mark.parametrize("name", ["choo-casarella", "hoerner", "angle-table"])
def test_assembled_tangents_against_differences(name, nylon):
    """Position and velocity, bars and knots under laws, on a bent panel."""
    net = fyke.panel(
        nylon, mesh="diamond", meshes=(3, 2), bar_length=LENGTH, size=(0.127, 0.085), knot_diameter=KNOT
    )
    law = fyke.Coefficients(bars=BARS[name], knots=knots.CliftGauvin())
    system = fyke.make_system(net, current=(0.5, 0.1, 0.0), coefficients=law)
    m = net.bar_count
    x = net.positions + np.random.default_rng(0).normal(scale=3e-3, size=net.positions.shape)
    v = np.random.default_rng(1).normal(scale=0.2, size=x.shape)
    surroundings = Surroundings(system)
    el, u = surroundings.at(x, v, 0.0)

    def load(x, v):
        t, length, out = np.empty((m, 3)), np.empty(m), np.empty_like(x)
        bar_geometry(x, el, t, length)
        water_load(u - v, surroundings.at(x, v, 0.0)[0], t, length, out)
        return out

    t, length = np.empty((m, 3)), np.empty(m)
    bar_geometry(x, el, t, length)
    pattern = Pattern.of(el)
    data = np.empty(len(pattern.indices))
    places = pattern.start, pattern.stride
    by_place, by_speed = np.empty((2, 3 * len(pattern.free), 3 * len(pattern.free)))
    for k, knot in enumerate(pattern.free):
        for q in range(3):
            step = np.zeros_like(x)
            step[knot, q] = 1e-7
            column = 3 * k + q
            change = load(x + step, v) - load(x - step, v)
            by_place[:, column] = -change[pattern.free].ravel() / 2e-7
            change = load(x, v + step) - load(x, v - step)
            by_speed[:, column] = -change[pattern.free].ravel() / 2e-7
    assemble(np.zeros((m, 3, 3)), u - v, el, t, *places, data)
    found = pattern.matrix(data).toarray()
    assert np.abs(found - by_place).max() < 1e-6 * np.abs(by_place).max()
    zero, mass = np.zeros(m), np.zeros((net.knot_count, 6))
    assemble_step(
        u - v, el, t, length, zero, zero, 0.0, 1.0, 0.0, mass, False, *places, pattern.diagonal, data
    )
    found = pattern.matrix(data).toarray()
    assert np.abs(found - by_speed).max() < 1e-6 * np.abs(by_speed).max()


@pytest.mark.parametrize("name", ["choo-casarella", "takagi", "hoerner", "angle-table"])
def test_every_solver_comes_to_the_same_rest(name, nylon):
    """Statics, implicit, leapfrog and Verner under one law: 1e-6 of the net's size."""
    twine = fyke.Twine("n", density=1140.0, diameter=DIAMETER, law=fyke.LinearLaw(2e7), damping_time=2e-3)
    net = fyke.panel(
        twine, mesh="diamond", meshes=(3, 3), bar_length=LENGTH, size=(0.12, 0.12), knot_diameter=KNOT
    )
    law = fyke.Coefficients(bars=BARS[name], knots=knots.SchillerNaumann())
    system = fyke.make_system(net, current=(0.5, 0.1, 0.0), coefficients=law)
    still = fyke.solve_static(system)
    assert still.outcome.ok
    assert still.outcome.factorizations < 25
    for stepper in (fyke.Implicit(), fyke.Symplectic(), fyke.Verner()):
        settle = fyke.Settle(force=1e-6)
        moved = fyke.simulate(system, duration=6.0, stepper=stepper, settle=settle)
        assert moved.outcome.name == "converged", (stepper.name, moved.outcome.message)
        assert np.abs(moved.position[-1] - still.position[-1]).max() < 2e-6
