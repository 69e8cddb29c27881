"""Moved knots against exact solutions: a shaken spring, a spun line, a towed net, the energy that supports put in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import fyke
from fyke.forces.evaluate import evaluate
from fyke.report.carried import brought_back, carried, parts_in_time
from fyke.report.histories import centre_deflection
from fyke.report.parts import Outline, parts_of
from fyke.results.audit import audit
from fyke.results.parts import by_part
from fyke.system.courses import Record, Steady, Swing
from fyke.system.motion import Motion, Move, Turn


def moving(system, *, knots=None, shifts=(), turns=()):
    """The system with its held knots, or some of them, in motion."""
    held = np.flatnonzero(system.net.fixed) if knots is None else np.asarray(knots)
    return replace(system, motion=Motion(system.net, [Move(held, tuple(shifts), tuple(turns))]))


# Courses


TABLE = Record([0.0, 0.4, 0.7, 1.5, 2.0], np.random.default_rng(2).normal(size=(5, 3)))


@pytest.mark.parametrize(
    "course",
    [
        Steady([1.0, -2.0, 0.5]),
        Steady([1.0, -2.0, 0.5], ramp=0.8),
        Swing([0.3, 0.0, 0.1], period=0.7, phase=0.4),
        Swing([0.3, 0.0, 0.1], period=0.7, phase=0.4, ramp=1.1),
        TABLE,
        replace(TABLE, ramp=0.6),
    ],
)
def test_rates_are_the_slopes_of_the_values(course):
    """Fourth-order differences; nothing has moved at time 0."""
    assert np.array_equal(course.at(0.0)[0], np.zeros(3))
    h = 1e-3
    for time in (0.1, 0.35, 0.62, 0.93, 1.3, 1.9):
        near = [course.at(time + k * h) for k in (-2, -1, 1, 2)]
        slope = (near[0] - 8.0 * near[1] + 8.0 * near[2] - near[3]) / (12.0 * h)
        assert course.at(time)[1:] == pytest.approx(slope[:2], abs=2e-6)


def test_courses_by_hand():
    assert Steady([2.0, 0.0, 0.0]).at(3.0).tolist() == [[6.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    # A ramp of T s loses T/2 of the way.
    assert Steady([2.0, 0.0, 0.0], ramp=1.0).at(3.0)[:2, 0] == pytest.approx([5.0, 2.0], rel=1e-14)
    assert Steady([2.0, 0.0, 0.0], ramp=1.0).at(0.5)[1, 0] == pytest.approx(1.0, rel=1e-14)
    assert Swing([0.1], period=4.0).at(1.0)[:, 0] == pytest.approx([0.1, 0.0, -0.1 * (np.pi / 2) ** 2])
    # A cubic is its own spline.
    times = np.array([0.0, 0.3, 1.0, 1.4, 2.0])
    cubic = Record(times, (times**3 - times)[:, None])
    assert cubic.at(0.8)[:, 0] == pytest.approx([0.8**3 - 0.8, 3 * 0.64 - 1, 4.8], rel=1e-12)
    # After its end it goes on straight.
    assert cubic.at(2.5)[:, 0] == pytest.approx([6.0 + 0.5 * 11.0, 11.0, 0.0], rel=1e-12)
    # Times count from the first one.
    later = Record(times + 7.0, (times**3 - times)[:, None])
    assert later.at(0.8) == pytest.approx(cubic.at(0.8), rel=1e-12)


def test_turns_against_rotation_matrices(framed):
    """Roll, pitch and yaw of a ship, and what differences of the places say of velocity and acceleration."""
    system = framed()
    point = np.array([0.3, -0.2, 0.1])
    angles = [Swing([0.4], 1.3, phase), Swing([0.3], 0.9), Steady([0.7], ramp=0.5)]
    for swing in angles[:1]:
        assert swing.at(0.0)[0] == 0.0
    turns = [Turn(axis, point, angle) for axis, angle in zip(np.eye(3), angles, strict=True)]
    motion = moving(system, shifts=[Steady([0.5, 0.0, 0.0])], turns=turns).motion
    time, h = 0.61, 1e-4
    x, v, a = motion.at(time)
    rotation = Rotation.from_euler("xyz", [angle.at(time)[0, 0] for angle in angles])
    assert x == pytest.approx(rotation.apply(motion.built - point) + point + [0.5 * time, 0, 0], abs=1e-14)
    before, after = motion.at(time - h)[0], motion.at(time + h)[0]
    assert v == pytest.approx((after - before) / (2 * h), abs=1e-6)
    assert a == pytest.approx((after - 2 * x + before) / h**2, abs=1e-5)


phase = 0.2


def test_bad_motions_are_refused(framed):
    system = framed()
    free = np.flatnonzero(~system.net.fixed)
    with pytest.raises(ValueError, match="is free"):
        moving(system, knots=free[:1])
    for wrong in (lambda: Record([0.0, 0.0], [[1.0], [2.0]]), lambda: Swing([1.0], period=0.0)):
        with pytest.raises(ValueError, match=r"rise|above 0"):
            wrong()
    with pytest.raises(ValueError, match="must not be zero"):
        Turn((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), Steady([1.0]))
    for explicit in (fyke.Verner(), fyke.Symplectic()):
        with pytest.raises(ValueError, match="implicit"):
            fyke.simulate(moving(system, shifts=[Steady([1.0, 0, 0])]), duration=0.1, stepper=explicit)


# A weight on a spring whose end is shaken


STIFFNESS, MASS, RETARDATION = 400.0, 0.25, 4e-3


def shaken(shift, *, damping=RETARDATION):
    """A weight on a taut spring in a vacuum, hung from a knot that moves up and down; swings about its rest."""
    diameter = (6.0 * MASS / (np.pi * 2000.0)) ** (1 / 3)
    twine = fyke.Twine(
        "spring", 1e-9, 1e-3, fyke.LinearLaw(STIFFNESS / (np.pi / 4 * 1e-6)), damping_time=damping
    )
    hung = 1.0 + MASS * 9.81 / STIFFNESS
    net = fyke.line(
        twine, [[0, 0, 0], [0, 0, -hung]], 1.0, fixed=(0,), knot_diameter=[0, diameter], knot_density=2000.0
    )
    system = fyke.make_system(net, water=fyke.Water(density=1e-12))
    return moving(system, shifts=[shift])


@pytest.mark.parametrize("ratio", [0.4, 0.9, 1.6])
@pytest.mark.parametrize("stepper", [fyke.Implicit, fyke.Newmark])
def test_transmissibility_of_a_spring(stepper, ratio):
    """|X / Y|^2 = (1 + s^2) / ((1 - r^2)^2 + s^2), s = w tau, of a damped oscillator with a moved base."""
    omega = ratio * np.sqrt(STIFFNESS / MASS)
    period, size = 2 * np.pi / omega, 5e-4
    system = shaken(Swing([0.0, 0.0, size], period))
    step = period / 300
    method = stepper(max_step=step, fixed=True, rtol=1e-9, atol=1e-12)
    run = fyke.simulate(system, duration=26 * period, every=period / 8, stepper=method)
    last = run.time > 20 * period
    height = run.position[last, 1, 2] - run.position[last, 1, 2].mean()
    amplitude = np.sqrt(2.0 * (height**2).mean())
    s = omega * RETARDATION
    exact = np.sqrt((1 + s**2) / ((1 - ratio**2) ** 2 + s**2))
    assert amplitude / size == pytest.approx(exact, rel=4e-3)
    held = size * np.sin(omega * run.time)
    assert run.position[:, 0, 2] == pytest.approx(held, abs=1e-12)
    assert run.velocity[:, 0, 2] == pytest.approx(omega * size * np.cos(omega * run.time), abs=1e-12)


@pytest.mark.parametrize("stepper", [fyke.Implicit, fyke.Newmark])
def test_second_order_in_time(stepper):
    """From rest, undamped: z = A (sin(w t) - r sin(w0 t)) / (1 - r^2), r = w / w0."""
    natural = np.sqrt(STIFFNESS / MASS)
    omega, size, end = 0.6 * natural, 5e-4, 4.0 / natural
    ratio = omega / natural
    exact = size * (np.sin(omega * end) - ratio * np.sin(natural * end)) / (1.0 - ratio**2)
    system = shaken(Swing([0.0, 0.0, size], 2 * np.pi / omega), damping=0.0)
    errors = []
    for n in (50, 100, 200):
        method = stepper(max_step=end / n, fixed=True, rtol=0.0, atol=1e-12)
        run = fyke.simulate(system, duration=end, every=end, stepper=method)
        errors.append(abs(run.position[-1, 1, 2] - run.position[0, 1, 2] - exact))
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx(2.0, abs=0.15)


def test_a_period_is_never_stepped_over():
    """A weight at rest lets steps grow; a shake that begins later must still be met."""
    times = np.linspace(0.0, 20.0, 401)
    knock = 5e-3 * np.exp(-(((times - 15.0) / 0.2) ** 2))
    record = Record(times, knock[:, None] * [0.0, 0.0, 1.0])
    run = fyke.simulate(shaken(record), duration=20.0, every=0.05, stepper=fyke.Implicit())
    exact = fyke.simulate(
        shaken(record), duration=20.0, every=0.05, stepper=fyke.Newmark(max_step=2e-3, fixed=True, rtol=1e-9)
    )
    assert np.ptp(exact.position[:, 1, 2]) > 4e-3
    assert np.abs(run.position - exact.position).max() < 0.1 * np.ptp(exact.position[:, 1, 2])


# Spun and towed


def test_spun_line_bears_the_centrifugal_force():
    """A weight on a line that turns about the held end: T = m r w^2 in the steady state, in the vacuum."""
    rate, mass = 3.0, 0.2
    diameter = (6.0 * mass / (np.pi * 2000.0)) ** (1 / 3)
    twine = fyke.Twine("line", 1e-9, 1e-3, fyke.LinearLaw(1e8), damping_time=1e-3)
    # The arm: two held knots, and the weight beyond them on the same ray.
    net = fyke.line(
        twine,
        [[0, 0, 0], [0.5, 0, 0], [1.0, 0, 0]],
        [0.5, 0.5],
        fixed=(0, 1),
        knot_diameter=[0, 0, diameter],
        knot_density=2000.0,
    )
    system = fyke.make_system(net, water=fyke.Water(density=1e-12, gravity=0.0))
    system = moving(system, turns=[Turn((0, 0, 1), (0, 0, 0), Steady([rate]))])
    stiffness = system.elements.stiffness[1]
    radius = stiffness / (stiffness - mass * rate**2)  # where k (r - 1) = m r w^2
    start = system.at_rest()
    start.position[2], start.velocity[2] = [radius, 0.0, 0.0], [0.0, rate * radius, 0.0]
    method = fyke.Newmark(max_step=2e-3, fixed=True, rtol=1e-9, atol=1e-12)
    run = fyke.simulate(system, duration=4.0, every=0.05, stepper=method, start=start)
    assert np.linalg.norm(run.position[:, 2], axis=1) == pytest.approx(radius, rel=1e-5)
    assert run.tension[1:, 1] == pytest.approx(mass * radius * rate**2, rel=1e-3)
    # Twelve radians on, the supports feel the same force, towards the weight.
    towards = [np.cos(rate * 4.0), np.sin(rate * 4.0), 0.0]
    assert run.position[-1, 2] == pytest.approx(radius * np.array(towards), abs=1e-3)
    assert run.support_reaction[-1] @ towards == pytest.approx(mass * radius * rate**2, rel=2e-3)


def test_towed_panel_is_a_panel_in_a_current(framed):
    """Galileo: the same forces and, as seen from the frame, the same shape at every time."""
    drift = np.array([-0.4, 0.1, 0.0])
    still = framed(damping_time=2e-5)
    carried = moving(
        framed(current=tuple(np.array([0.5, 0.0, 0.0]) + drift), damping_time=2e-5), shifts=[Steady(drift)]
    )
    begin = carried.at_rest()
    begin.velocity[:] = drift
    runs = [
        fyke.simulate(system, duration=1.0, every=0.1, stepper=fyke.Implicit(), start=start)
        for system, start in ((still, still.at_rest()), (carried, begin))
    ]
    seen = runs[1].position - runs[1].time[:, None, None] * drift
    assert np.abs(seen - runs[0].position).max() < 1e-9
    for name in ("tension", "hydrodynamic_force", "support_reaction", "bar_drag", "bar_lift"):
        a, b = (getattr(run, name) for run in runs)
        assert a == pytest.approx(b, abs=1e-6 * np.abs(b).max()), name


def test_towed_panel_comes_to_the_static_shape(framed):
    """From rest in still water over a ramp to 0.5 m/s upstream: the equilibrium in a current of 0.5 m/s."""
    static = fyke.solve_static(framed(damping_time=2e-5))
    system = moving(
        framed(current=(0.0, 0.0, 0.0), damping_time=2e-5), shifts=[Steady([-0.5, 0.0, 0.0], ramp=0.5)]
    )
    run = fyke.simulate(system, duration=6.0, every=0.05, settle=fyke.Settle(force=1e-6))
    assert run.outcome.name == "converged" and run.time[-1] > 0.5
    way = -0.5 * (run.time[-1] - 0.25)
    assert run.position[-1] - [way, 0, 0] == pytest.approx(static.position[-1], abs=2e-6)
    assert run.support_reaction[-1] == pytest.approx(static.support_reaction[-1], abs=2e-5)
    assert run.bar_drag[-1] == pytest.approx(static.bar_drag[-1], abs=1e-6)


# Accounts


def test_supports_pay_for_the_tow(framed):
    """In the steady tow supports put in what drag takes out; the budget closes from rest, better with short steps."""
    system = moving(
        framed(current=(0.0, 0.0, 0.0), damping_time=2e-5), shifts=[Steady([-0.5, 0.0, 0.0], ramp=0.3)]
    )
    left = []
    for step in (2.5e-3, 1e-3):
        run = fyke.simulate(
            system, duration=0.6, every=0.005, stepper=fyke.Implicit(max_step=step, fixed=True, rtol=1e-4)
        )
        accounts = audit(system, run)
        energy = accounts.energy
        left.append(abs(energy.remainder) / energy.support_work)
    assert energy.support_work > 0.0 and energy.current_work == 0.0
    assert energy.drag_dissipation == pytest.approx(energy.support_work, rel=0.3)
    assert left[1] < 0.7 * left[0] < 0.05, left
    # The frame is towed at a steady speed now: power in is force times speed.
    power = run.support_reaction[-1, 0] * 0.5
    assert power == pytest.approx(run.hydrodynamic_force[-1, 0] * 0.5, rel=1e-2)


def test_reaction_holds_the_inertia_of_what_is_held(framed):
    """All knots held and shaken in the vacuum: the supports feel the mass of the whole net."""
    system = framed(fixed="edges", water=fyke.Water(density=1e-12, gravity=0.0))
    net = replace(system.net, fixed=np.ones(system.net.knot_count, dtype=bool))
    system = fyke.make_system(net, water=fyke.Water(density=1e-12, gravity=0.0))
    swing = Swing([0.02, 0.0, 0.01], period=0.5)
    system = moving(system, shifts=[swing])
    run = fyke.simulate(system, duration=0.3, every=0.002, stepper=fyke.Implicit())
    mass = system.elements.knot_mass.sum()
    for k, time in enumerate(run.time):
        assert run.support_reaction[k] == pytest.approx(-mass * swing.at(time)[2], rel=1e-9, abs=1e-15)
    energy = audit(system, run).energy
    assert energy.support_work == pytest.approx(energy.kinetic, rel=1e-3) and energy.kinetic < -1e-4
    assert abs(energy.remainder) < 1e-3 * -energy.kinetic


def test_budget_of_a_shaken_spring():
    """The work of the shaken end is in the spring's damping and in the swing."""
    omega, size = 30.0, 5e-4
    system = shaken(Swing([0.0, 0.0, size], 2 * np.pi / omega))
    method = fyke.Newmark(max_step=2e-3, fixed=True, rtol=1e-9, atol=1e-12)
    run = fyke.simulate(system, duration=2.0, every=2e-3, stepper=method)
    energy = audit(system, run).energy
    assert energy.support_work > 0.0
    assert abs(energy.remainder) < 2e-3 * energy.support_work
    assert energy.twine_dissipation > 0.5 * energy.support_work


def test_resumes_with_the_same_bits(framed):
    system = moving(framed(damping_time=2e-5), shifts=[Swing([0.0, 0.0, 0.02], period=0.3, ramp=0.2)])
    kept = []
    whole = fyke.simulate(system, duration=0.4, every=0.05, on_checkpoint=kept.append)
    frames = [whole.frame(k) for k in range(4)]
    again = fyke.simulate(system, duration=0.4, every=0.05, resume=(kept[3], frames))
    assert again.position.tobytes() == whole.position.tobytes()
    assert again.tension.tobytes() == whole.tension.tobytes()


def test_parts_share_the_reaction():
    """Rope, netting and floats of a shaken cage: their shares, inertia included, add up to the whole."""
    system = fyke.build_system(*built_cage())
    rim = np.flatnonzero(system.net.fixed)
    system = moving(system, knots=rim, shifts=[Swing([0.05, 0.0, 0.1], period=1.5, phase=1.0)])
    run = fyke.simulate(system, duration=0.2, every=0.1)
    parts = by_part(system, run)
    whole = np.sum([part.support_reaction for part in parts], axis=0)
    assert whole == pytest.approx(run.support_reaction[-1], abs=1e-9)
    at_rest = np.sum([part.support_reaction for part in by_part(replace(system, motion=None), run)], axis=0)
    mass = system.elements.knot_mass[rim].sum() * system.motion.acceleration(run.time[-1])[rim[0]]
    assert np.linalg.norm(whole - at_rest) > np.linalg.norm(mass)


def test_pictures_go_along_with_the_frame(framed):
    """Towed by 3 m and turned by 90 degrees: the frame is drawn round its held knots; the deflection is the sag."""
    turn = Turn((0, 0, 1), (0, 0, 0), Record([0.0, 0.5, 1.0], [[0.0], [0.3], [np.pi / 2]]))
    system = moving(
        framed(), shifts=[Record([0.0, 0.5, 1.0], np.outer([0.0, 2.0, 3.0], [0, 0, 1.0]))], turns=[turn]
    )
    built, held = system.net.positions, system.net.fixed
    x = system.motion.at(1.0)[0]
    shape = built + np.array([0.0, 0.0, 3.0])
    shape[held] = x
    frames = [
        evaluate(system, system.at_rest()),
        evaluate(system, fyke.State(1.0, shape, np.zeros_like(shape))),
    ]
    outcome = fyke.solve_static(framed()).outcome
    result = fyke.Result.from_frames(system.net, outcome, 0.0, frames)
    outline = next(part for part in parts_of(carried(result).net) if isinstance(part, Outline))
    corners = built[[system.net.labels.index(one) for one in ("0-0", "16-0", "16-16", "0-16", "0-0")]]
    turned = corners @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) + [0.0, 0.0, 3.0]
    assert outline.points == pytest.approx(turned, abs=1e-12)
    assert not any(isinstance(part, Outline) for part in parts_in_time(result))
    assert centre_deflection(result) == pytest.approx([0.0, 0.0], abs=1e-12)
    assert brought_back(result).position[-1][~held] == pytest.approx(built[~held], abs=1e-12)
    still = fyke.solve_static(framed())
    assert carried(still) is still and any(isinstance(part, Outline) for part in parts_in_time(still))


def built_cage():
    """A cage with a rope and floats at its held rim."""
    case = fyke.parse_case(CAGE, "cage.toml")
    return fyke.build_net(case), case


CAGE = """
schema = 1
[current]
velocity = [0.3, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2 mm"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "0.1 m"
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [12, 4]
hanging_ratio = [1.0, 1.0]
top = [0.0, 0.0, -0.05]
fixed = "top"
[[gear]]
kind = "rope"
name = "head"
twine = "main"
along = "cage.top"
[[gear]]
kind = "floats"
name = "corks"
along = "cage.top"
buoyancy = "1 N"
density = 200.0
"""
