"""Implicit stepping: the static rest, Verner's motion, orders, tangent, energy, frames that do not steer the steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.bars import bar_geometry
from fyke.forces.inertia import mass_matrices
from fyke.forces.total import total_force, work_arrays
from fyke.solve.linear import Pattern
from fyke.solve.smooth import assemble_step, smooth_bars
from test_dynamic import total_energy

STEPPERS = [fyke.Implicit(), fyke.Newmark()]
TIMES = 0.05 * np.arange(1, 7)


def rms(a, b):
    """Root mean square of the coordinates' differences at the worst time (m)."""
    return np.sqrt(((a - b) ** 2).mean(axis=(1, 2))).max()


def slopes(errors):
    return np.log2(np.array(errors[:-1]) / errors[1:])


@pytest.mark.parametrize("damping_time", [0.0, 2e-5])
def test_released_panel_comes_to_the_static_rest(framed, damping_time):
    """Even without twine damping, because the method keeps nothing of the ringing."""
    system = framed(damping_time=damping_time)
    static = fyke.solve_static(system)
    result = fyke.simulate(
        system, duration=3.0, every=0.05, stepper=fyke.Implicit(), settle=fyke.Settle(force=1e-6)
    )
    assert (result.outcome.name, result.outcome.solver) == ("converged", "dynamic implicit")
    assert result.outcome.iterations < 80
    assert np.abs(result.position[-1] - static.position[-1]).max() < 1e-6
    assert np.abs(result.tension[-1] - static.tension[-1]).max() < 1e-4 * static.tension.max()
    assert np.array_equal(result.tension[-1] == 0.0, static.tension[-1] == 0.0)


@pytest.fixture(scope="module")
def verner_motion(framed):
    system = framed(damping_time=2e-5)
    return fyke.simulate(system, duration=0.3, every=0.05, stepper=fyke.Verner(rtol=1e-5, atol=1e-8))


@pytest.mark.parametrize(("step", "limit"), [(0.01, 6e-4), (0.005, 3.5e-4), (0.0025, 2.5e-4)])
def test_follows_verner_through_the_snap(framed, verner_motion, step, limit):
    result = fyke.simulate(
        framed(damping_time=2e-5), duration=0.3, every=0.05, stepper=fyke.Implicit(max_step=step, fixed=True)
    )
    assert result.outcome.iterations == pytest.approx(0.3 / step, abs=2)
    assert rms(result.position[1:], verner_motion.position[1:]) < limit


def test_second_order_on_a_panel_that_stays_taut(framed):
    """From the rest at 0.5 m/s the current jumps to 0.55 m/s: no bar goes slack, down to 1e-7 m."""
    rest = fyke.solve_static(framed(damping_time=2e-5), tolerance=1e-11)
    system = framed(current=(0.55, 0.0, 0.0), damping_time=2e-5)
    start = fyke.State(0.0, rest.position[-1], np.zeros((145, 3)))

    def end(stepper):
        return fyke.simulate(system, duration=0.08, every=0.08, stepper=stepper, start=start).position[-1]

    exact = end(fyke.Verner(rtol=1e-7, atol=1e-10))
    errors = [
        np.sqrt(((end(fyke.Implicit(max_step=h, fixed=True, rtol=1e-6, atol=1e-9)) - exact) ** 2).mean())
        for h in (1e-3, 5e-4, 2.5e-4)
    ]
    assert errors[0] < 1e-7
    assert np.all(slopes(errors) > 1.75), errors


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
def test_energy_of_a_taut_bar_in_vacuum(stepper):
    """A mass on two taut bars: Newmark keeps the energy, BDF2 loses some in every period."""
    twine = fyke.Twine("spring", 1e-9, 1e-3, fyke.LinearLaw(1e6))
    net = fyke.line(
        twine, [[-1.1, 0, 0], [0.05, 0, 0], [1.1, 0, 0]], 1.0, knot_diameter=[0, 0.05, 0], knot_density=2000.0
    )
    system = fyke.make_system(net, water=fyke.Water(density=1e-12, gravity=0.0))
    period = 2 * np.pi * np.sqrt(system.elements.knot_mass[1] / (2 * system.elements.stiffness[0]))
    exact_newton = {"max_step": period / 40, "fixed": True, "rtol": 0.0, "atol": 1e-12}
    run = fyke.simulate(system, duration=10 * period, every=period, stepper=replace(stepper, **exact_newton))
    energy = np.array([total_energy(system, run.frame(i)) for i in range(len(run.time))])
    if stepper.name == "newmark":
        assert np.ptp(energy) < 1e-5 * energy[0]
    else:
        assert np.all(np.diff(energy) < 0.0) and energy[-1] < 0.99 * energy[0]


def test_energy_never_grows_without_a_current(framed):
    system = framed(current=(0.0, 0.0, 0.0), coefficients=fyke.Coefficients(added_mass_bar=0.0))
    rng = np.random.default_rng(5)
    free = system.elements.free[:, None]
    x = np.where(free > 0, system.net.positions * 1.15, system.net.positions)
    start = fyke.State(0.0, x, free * rng.normal(scale=0.1, size=(145, 3)))
    run = fyke.simulate(system, duration=0.3, every=0.01, stepper=fyke.Implicit(), start=start)
    elastic = 0.5 * (run.tension**2 / system.elements.stiffness).sum(axis=1)
    energy = run.kinetic_energy + elastic - (system.elements.weight * run.position).sum(axis=(1, 2))
    assert run.outcome.ok
    assert np.diff(energy).max() < 1e-3 * np.ptp(energy)
    assert energy[-1] < energy[0]


def test_frames_do_not_steer_the_steps(framed):
    """Asked times are interpolated, so the motion is the same bits for any output interval."""
    few, many = (
        fyke.simulate(framed(), duration=0.4, every=every, stepper=fyke.Implicit()) for every in (0.4, 0.003)
    )
    assert few.position[-1].tobytes() == many.position[-1].tobytes()
    assert few.outcome.iterations == many.outcome.iterations
    # A frame between two steps has tensions like its neighbours, not those of a false stretch of its chords.
    assert many.tension[40:].max() < 3.0 * verner_peak(framed)


def verner_peak(framed):
    run = fyke.simulate(framed(damping_time=2e-5), duration=0.3, every=0.001, stepper=fyke.Symplectic())
    return run.tension.max()


def test_step_matrix_against_differences(framed):
    """cm M + c1 C + c0 K of taut bars against central differences of the whole force in x and in v."""
    system = framed(meshes=(3, 2), size=(0.127, 0.085), coefficients=fyke.Coefficients(added_mass_bar=0.7))
    el = system.elements
    rng = np.random.default_rng(0)
    x = system.net.positions * 1.2 + rng.normal(scale=1e-3, size=system.net.positions.shape)
    v = rng.normal(scale=0.3, size=x.shape)
    u = system.current.velocity(x, 0.0)
    m, n = system.net.bar_count, len(x)
    t, length, mass = np.empty((m, 3)), np.empty(m), np.empty((n, 6))
    bar_geometry(x, el, t, length)
    taut = length > el.rest_length
    tension = np.maximum(el.stiffness * (length - el.rest_length), 0.0)
    mass_matrices(x, el, mass)
    pattern = Pattern.of(el)
    rel, g = work_arrays(n)

    def force(x, v):
        out = np.empty_like(x)
        total_force(x, v, u, el, rel, g, out)
        return out[pattern.free].ravel()

    def matrix(c0, c1, cm, symmetric=False):
        data = np.empty(len(pattern.indices))
        along = np.where(taut, el.stiffness, 0.0)
        assemble_step(
            u - v, el, t, length, tension, along, c0, c1, cm, mass, symmetric,
            pattern.start, pattern.stride, pattern.diagonal, data,
        )  # fmt: skip
        return pattern.matrix(data).toarray()

    def difference(which, step):
        columns = []
        for knot in pattern.free:
            for q in range(3):
                ahead, behind = [x.copy(), v.copy()], [x.copy(), v.copy()]
                ahead[which][knot, q] += step
                behind[which][knot, q] -= step
                columns.append(-(force(*ahead) - force(*behind)) / (2 * step))
        return np.column_stack(columns)

    for exact, found in (
        (difference(0, 1e-7), matrix(1.0, 0.0, 0.0)),
        (difference(1, 1e-5), matrix(0.0, 1.0, 0.0)),
    ):
        assert np.abs(exact - found).max() < 1e-6 * np.abs(exact).max()
    whole = matrix(1.0, 2.0, 3.0)
    assert np.abs(whole - whole.T).max() > 0.1
    assert matrix(1.0, 2.0, 3.0, symmetric=True) == pytest.approx(
        0.5 * (whole + whole.T), rel=1e-12, abs=1e-12
    )
    a = rng.normal(size=(len(pattern.free), 3))
    full = [
        np.array([[k[0], k[3], k[4]], [k[3], k[1], k[5]], [k[4], k[5], k[2]]]) for k in mass[pattern.free]
    ]
    product = np.concatenate([k @ b for k, b in zip(full, a, strict=True)])
    assert matrix(0.0, 0.0, 2.0) @ a.ravel() == pytest.approx(2.0 * product, rel=1e-12)


def test_large_nets_are_solved_by_a_symmetric_matrix_to_the_exact_equations(framed):
    """A stretched panel in a current, one step of Newton's tightest: M a = F(x, v), the water's turning included."""
    side = 24 * 0.03 * np.sqrt(2.0)
    system = framed(meshes=(24, 24), size=(side, side))
    x = 1.001 * system.net.positions
    start = fyke.State(0.0, x, np.zeros_like(x))
    run = fyke.Implicit(max_step=0.05, fixed=True, rtol=0.0, atol=1e-12).start(system, start)
    assert run.newton.symmetric and run.linear_solver != "rslab LU"
    assert run.advance(1.0) == "ok" and run.count.steps == 1
    rel, g = work_arrays(len(x))
    force, mass = np.empty_like(x), np.empty((len(x), 6))
    total_force(run.x, run.v, run.u, system.elements, rel, g, force)
    mass_matrices(run.x, system.elements, mass)
    full = mass[:, [[0, 3, 4], [3, 1, 5], [4, 5, 2]]]
    left = (force - np.einsum("ipq,iq->ip", full, run.a))[run.newton.pattern.free]
    assert run.count.factorizations < 15
    assert np.abs(left).max() < 1e-6 * np.abs(force[run.newton.pattern.free]).max()


def test_smoothed_complementarity_by_hand():
    """T = 3, w = 1, g = 1, mu = 0: w - T + g = -1, T + w - |T - w| = 2 w, p = 1."""
    p, r, c = (np.empty(1) for _ in range(3))
    phi, worst = smooth_bars(
        np.array([3.0]), np.array([1.0]), np.array([1.0]), 0.0, np.zeros(1, dtype=bool), p, r, c
    )
    assert (phi, worst, p[0], r[0], c[0]) == (2.0, 1.0, 1.0, -1.0, -2.0)


def test_a_step_that_cannot_be_found_is_named(framed):
    system = framed()
    broken = replace(system, elements=system.elements._replace(stiffness=system.elements.stiffness * np.nan))
    outcome = fyke.simulate(broken, duration=0.01, stepper=fyke.Implicit()).outcome
    assert outcome.name in ("step_too_small", "not_finite") and not outcome.ok


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"fixed": True}, "max_step"),
        ({"rtol": 0.0, "atol": 0.0}, "above 0"),
        ({"rtol": -1e-2}, "rtol -0.01"),
        ({"atol": float("nan")}, "atol nan"),
        ({"max_step": 0.0}, "max_step 0"),
        ({"max_step": -1e-3}, "max_step -0.001"),
    ],
)
@pytest.mark.parametrize("stepper", [fyke.Implicit, fyke.Newmark])
def test_options_that_contradict_each_other_are_refused(stepper, options, said):
    with pytest.raises(ValueError, match=said):
        stepper(**options)


def test_variable_steps_keep_the_second_order_on_a_sinking_sphere():
    """Steps that grow and shrink by a half, in turns: the exact z falls apart by the square of the step."""
    twine = fyke.Twine("none", 1000.0, 1e-6, fyke.LinearLaw(1e3))
    net = fyke.line(twine, [[0, 0, 0]], [], fixed=(), knot_diameter=0.01, knot_density=1140.0)
    system = fyke.make_system(net, coefficients=fyke.Coefficients(knots=fyke.ConstantKnot(0.47)))
    speed = np.sqrt(4 / 3 * 0.14 * 9.81 * 0.01 / 0.47)
    tau = speed * (1.14 + 0.5) / (0.14 * 9.81)
    errors = []
    for n in (20, 40, 80):
        run = fyke.Implicit(max_step=tau, fixed=True, rtol=1e-8).start(system, system.at_rest())
        while run.time < 2.0 * tau:
            run.step = tau / n * (1.0 if run.count.steps % 2 else 1.5)
            assert run.advance(10.0) == "ok"
        errors.append(abs(run.x[0, 2] + speed * tau * np.log(np.cosh(run.time / tau))))
    assert slopes(errors) == pytest.approx(2.0, abs=0.15)
