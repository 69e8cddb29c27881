"""Tubes as beams: bars that push and bend, against exact solutions of the elastic rod."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import fyke
import fyke.solve.modes
from beams import LENGTH, STIFFNESS, cantilever, in_vacuum, shape, tube
from fyke.forces.bending import Bending
from fyke.netting.lines import LinePiece, with_line
from fyke.netting.rigging import with_rope
from fyke.netting.shapes import frustum
from fyke.netting.sheet import Netting
from fyke.netting.tubes import Tube, ring
from fyke.results.audit import audit
from fyke.results.derive import summary
from fyke.solve.equilibrium import Equilibrium
from fyke.solve.pattern import Pattern
from fyke.solve.relaxation import relax

# Bending of three knots.


def energy(x, b):
    """2 B tan^2(phi/2) of three knots x (3, 3), by the angle; complex numbers carry slopes."""
    one, other = x[1] - x[0], x[2] - x[1]
    cosine = (one @ other) / np.sqrt((one @ one) * (other @ other))
    return 2.0 * b * np.tan(0.5 * np.arccos(cosine)) ** 2


@pytest.fixture
def bent():
    """Two places of bending in a row of four knots in space, far from straight, of unequal bars."""
    x = np.array([[0.0, 0.0, 0.0], [1.0, 0.3, -0.2], [1.4, 1.2, 0.5], [0.7, 1.5, 1.6]])
    return Bending(np.array([[0, 1, 2], [1, 2, 3]]), np.array([2.0, 0.7])), x


def test_force_of_bending_is_the_slope_of_its_energy(bent):
    bending, x = bent
    force = np.zeros((4, 3))
    bending.see(x, x, 0.0)
    bending.add_load(force)
    for i in range(4):
        for q in range(3):
            moved = x.astype(complex)
            moved[i, q] += 1e-30j
            slope = sum(energy(moved[k : k + 3], b) for k, b in enumerate(bending.stiffness)).imag / 1e-30
            assert force[i, q] == pytest.approx(-slope, rel=1e-12, abs=1e-13)
    assert bending.energy(x) == pytest.approx(sum(energy(x[k : k + 3], b) for k, b in enumerate((2.0, 0.7))))
    assert force.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-14)
    assert np.cross(x, force).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-14)


def test_tangent_of_bending_is_the_slope_of_its_force(bent):
    bending, x = bent
    el = in_vacuum(fyke.line(tube(), x, 1.0, fixed=())).elements
    pattern = Pattern.of(el, (bending.groups,))
    data = np.zeros(len(pattern.indices))
    bending.see(x, x, 0.0)
    bending.assemble(2.0, 5.0, pattern.groups[0], symmetric=False, data=data)
    tangent = pattern.matrix(data).toarray()
    step = 1e-6
    for column in range(12):
        forces = []
        for sign in (1.0, -1.0):
            moved, out = x.copy(), np.zeros((4, 3))
            moved.flat[column] += sign * step
            bending.see(moved, moved, 0.0)
            bending.add_load(out)
            forces.append(out.ravel())
        slope = -(forces[0] - forces[1]) / (2.0 * step)
        assert tangent[:, column] == pytest.approx(2.0 * slope, abs=2e-8)


def test_half_of_each_bar_bends():
    """Bars of 1 and 3 m with a moment at the knot between them: angle M (l1 + l2)/(2 EI), small."""
    net = fyke.line(tube(), [[0, 0, 0], [1, 0, 0], [4, 0, 0]], [1.0, 3.0], fixed=())
    net = replace(net, bars=net.bars[:0], rest_length=net.rest_length[:0], twine_of_bar=net.twine_of_bar[:0])
    bending = Bending.of(with_rope(net, [0, 1, 2], tube(), name="t"))
    angle = 1e-4
    x = np.array([[0, 0, 0], [1, 0, 0], [1 + 3 * np.cos(angle), 0, 3 * np.sin(angle)]])
    assert bending.moments(x) == pytest.approx([STIFFNESS * angle / 2.0], rel=1e-7)


# Statics.


def test_a_strut_bears_less_than_its_buckling_load_straight():
    load = 0.9 * np.pi**2 * STIFFNESS / (4.0 * LENGTH**2)
    result = fyke.solve_static(cantilever(20, (0.0, 0.0, 1.0), (0.0, 0.0, -load)), tolerance=1e-9)
    assert result.outcome.ok
    assert result.position[-1][:, :2] == pytest.approx(np.zeros((22, 2)), abs=1e-12)
    assert result.frame().tension[1:] == pytest.approx(np.full(20, -load), abs=1e-7)
    assert result.frame().support_reaction == pytest.approx([0.0, 0.0, -load], abs=1e-7)


def test_a_strut_between_strings_pushes_them_apart():
    """A straight tube across a taut string square: 45 degrees everywhere, so each string pulls F/sqrt 2."""
    corners = [[0, 0, 1], [-1, 0, 0], [1, 0, 0], [0, 0, -1]]
    string = fyke.Twine("string", 1000.0, 1e-3, fyke.LinearLaw(1e4 / (np.pi / 4.0 * 1e-6)))
    load = np.zeros((4, 3))
    load[3, 2] = -10.0
    net = fyke.line(string, corners, 1.0, fixed=(0,), load=load)
    net = replace(net, bars=net.bars[:0], rest_length=net.rest_length[:0], twine_of_bar=net.twine_of_bar[:0])
    net = with_rope(net, [0, 1, 3], string, name="left")
    net = with_rope(net, [0, 2, 3], string, name="right")
    result = fyke.solve_static(
        in_vacuum(with_rope(net, [1, 2], tube(axial=1e9), name="strut")), tolerance=1e-8
    )
    assert result.outcome.ok, result.outcome
    x, tension = result.position[-1], result.frame().tension
    half, drop = x[2, 0], 0.5 * (x[0, 2] - x[3, 2])
    assert tension[4] == pytest.approx(-10.0 * half / drop, rel=1e-7)
    assert tension[:4] == pytest.approx(np.full(4, 5.0 * np.hypot(half, drop) / drop), rel=1e-7)
    figures = summary(result)
    assert figures["slack_bars"] == 0
    assert figures["max_tension_bar"] < 4


def test_a_warm_start_with_tubes_is_there_at_once():
    system = cantilever(20, load=(0.3, 0.0, -1.0))
    first = fyke.solve_static(system, tolerance=1e-8)
    again = fyke.solve_static(system, tolerance=1e-8, start=first.state())
    assert again.outcome.ok and again.outcome.iterations <= 2
    assert again.position[-1] == pytest.approx(first.position[-1], abs=1e-9)


def test_net_with_tubes_is_refused_by_explicit_steppers():
    system = cantilever(4, load=(0.0, 0.0, -1e-3))
    for stepper in (fyke.Verner(), fyke.Symplectic()):
        with pytest.raises(ValueError, match="tubes need an implicit method"):
            fyke.simulate(system, duration=0.1, stepper=stepper)
    assert fyke.simulate(system, duration=0.01, every=0.01).outcome.ok


# Vibration.


@pytest.mark.parametrize("dense", [0, 10**6])
def test_modes_say_that_a_strut_beyond_its_buckling_load_does_not_stay(dense, monkeypatch):
    monkeypatch.setattr(fyke.solve.modes, "DENSE", dense)
    critical = np.pi**2 * STIFFNESS / (4.0 * LENGTH**2)
    system = cantilever(16, (0.0, 0.0, 1.0), (0.0, 0.0, -1.2 * critical))
    straight = system.net.positions.copy()
    straight[:, 2] *= 1.0 - 1.2 * critical / 1e7
    modes = fyke.modes(system, straight, count=4)
    assert modes.falling == 2
    assert modes.frequency[:2] == pytest.approx([0.0, 0.0]) and modes.frequency[2] > 0.0


def test_statics_leaves_a_strut_that_is_straight_beyond_its_buckling_load():
    """Newton's method stays straight, since nothing pushes it aside; what buckles is the elastica by 1.2 times P_cr."""
    critical = np.pi**2 * STIFFNESS / (4.0 * LENGTH**2)
    k2 = brentq(lambda k2: (2.0 * ellipk(k2) / np.pi) ** 2 - 1.2, 0.01, 0.9)
    result = fyke.solve_static(cantilever(40, (0.0, 0.0, 1.0), (0.0, 0.0, -1.2 * critical)), tolerance=1e-8)
    assert result.outcome.ok and result.outcome.warnings == (), result.outcome
    assert "not stable" in result.outcome.message
    tip = result.position[-1][-1] / LENGTH
    assert np.hypot(tip[0], tip[1]) == pytest.approx(2.0 * np.sqrt(k2) / ellipk(k2), abs=2e-3)
    assert tip[2] == pytest.approx(2.0 * ellipe(k2) / ellipk(k2) - 1.0, abs=2e-3)
    below = fyke.solve_static(cantilever(40, (0.0, 0.0, 1.0), (0.0, 0.0, -0.97 * critical)), tolerance=1e-8)
    assert "not stable" not in below.outcome.message and below.outcome.warnings == ()


@pytest.mark.parametrize("stepper", [fyke.Implicit(rtol=0.0, atol=2e-8), fyke.Newmark(rtol=0.0, atol=2e-8)])
def test_a_free_swinging_beam_keeps_its_period(stepper):
    system = cantilever(12)
    modes = fyke.modes(system, system.net.positions, count=2)
    period = modes.period[0]
    start = system.at_rest()
    up = modes.shape[0] if abs(modes.shape[0, -1, 2]) > 0.5 else modes.shape[1]
    start.velocity[:] = 1e-3 * up
    # Nothing but the mode itself, small: its motion is 1e-3 sin(omega t)/omega.
    result = fyke.simulate(system, duration=2.25 * period, every=0.05 * period, stepper=stepper, start=start)
    assert result.outcome.ok, result.outcome
    tip = result.position[:, -1] @ up[-1]
    exact = tip[0] + 1e-3 * (up[-1] @ up[-1]) * np.sin(modes.frequency[0] * result.time) / modes.frequency[0]
    assert tip == pytest.approx(exact, abs=0.02 * np.ptp(exact))


# Afloat.


def afloat(n, part, radius=2.0, diameter=0.1, current=0.0, stiffness=1e5):
    """A level ring of a density part of the water's, held in its place by four soft threads on the surface."""
    area = np.pi / 4.0 * diameter**2
    law = fyke.LinearLaw(1e7 / area)
    pipe = fyke.Twine("pipe", part * 1000.0, diameter, law, compression=True, bending_stiffness=stiffness)
    net = ring(pipe, diameter=2.0 * radius, knots=n)
    soft = fyke.Twine("soft", 1000.0, 1e-6, fyke.LinearLaw(1.0 / (np.pi / 4.0 * 1e-12)))
    for k in range(4):
        angle = 0.5 * np.pi * k
        anchor = (3.0 * radius * np.cos(angle), 3.0 * radius * np.sin(angle), 0.0)
        net = with_line(
            net, anchor, k * n // 4, [LinePiece(soft, 1.8 * radius, 1)], name=f"m{k}", held=(True, False)
        )
    water = fyke.Coefficients(knots=fyke.ConstantKnot(0.0))
    return fyke.make_system(net, current=(current, 0.0, 0.0), coefficients=water, surface=True)


def deep(part):
    """Radii that the middle of a level tube lies under water when this part of its circle is wet."""
    return brentq(
        lambda s: 0.5 + (s * np.sqrt(1 - s * s) + np.arcsin(s)) / np.pi - part, -1.0, 1.0, xtol=1e-14
    )


@pytest.mark.parametrize("part", [0.2, 0.5, 0.9])
def test_a_floating_ring_dives_by_the_segment_of_its_density(part):
    result = fyke.solve_static(afloat(16, part), tolerance=1e-6)
    assert result.outcome.ok and result.outcome.iterations < 20, result.outcome
    assert result.position[-1][:16, 2] == pytest.approx(np.full(16, -0.05 * deep(part)), abs=1e-6)


@pytest.mark.parametrize("part", [0.3, 0.5])
def test_heave_of_a_floating_ring(part):
    """omega^2 = rho g b/(m + a) a metre of tube, b the width of its water line, a the water moved with its wet part.

    Heave, pitch and roll of a ring have the same frequency; the buoyancy of a bar acts half at each end, which makes
    pitch and roll softer by the cosine of half a bar's turn.
    """
    system = afloat(24, part)
    level = fyke.solve_static(system, tolerance=1e-7).position[-1]
    modes = fyke.modes(system, level, count=12)
    width, area = 0.1 * np.sqrt(1.0 - deep(part) ** 2), np.pi / 4.0 * 0.01
    exact = np.sqrt(1000.0 * 9.81 * width / (2.0 * part * 1000.0 * area))
    up = np.abs(modes.shape[:, :24, 2]).max(axis=1) > 0.9
    tilt = np.cos(np.pi / 24) * exact
    assert modes.frequency[up][:3] == pytest.approx([tilt, tilt, exact], rel=1e-4)


def test_a_ring_let_go_above_its_draught_heaves_with_its_period():
    """Without drag; the water line of a tube half under water changes with the square of the motion alone."""
    system = afloat(16, 0.5)
    system = replace(
        system, elements=system.elements._replace(normal_drag=np.zeros(20), tangential_drag=np.zeros(20))
    )
    period = 2.0 * np.pi * np.sqrt(2.0 * 500.0 * np.pi / 4.0 * 0.01 / (1000.0 * 9.81 * 0.1))
    start = fyke.solve_static(system, tolerance=1e-7).state()
    start = fyke.State(0.0, start.position.copy(), start.velocity.copy())
    start.position[:16, 2] += 5e-4
    run = fyke.simulate(
        system,
        duration=1.5 * period,
        every=0.5 * period,
        start=start,
        stepper=fyke.Implicit(rtol=0.0, atol=1e-8),
    )
    assert run.outcome.ok, run.outcome
    assert run.position[:, :16, 2].mean(axis=1) == pytest.approx(
        5e-4 * np.array([1.0, -1.0, 1.0, -1.0]), abs=2e-5
    )


def test_a_rigid_ring_keeps_its_shape():
    """A flexible ring in a current and the same one made rigid: it moves as before, and hardly bends."""
    flexible = Tube.of("HDPE", diameter=0.1, wall=0.006)
    bends = []
    for rigid in (False, True):
        twine = replace(flexible, rigid=rigid).twine("pipe")
        net = ring(twine, diameter=4.0, knots=24)
        rope = fyke.Twine("rope", 1000.0, 0.01, fyke.LinearLaw(1e8))
        net = with_line(net, (-20.0, 0.0, 0.0), 12, [LinePiece(rope, 18.0, 4)], name="m", held=(True, False))
        result = fyke.solve_static(
            fyke.make_system(net, current=(1.0, 0.0, 0.0), surface=True), tolerance=1e-5
        )
        assert result.outcome.ok, result.outcome
        x = result.position[-1][:24]
        across = np.linalg.norm(x[:12] - x[12:], axis=1)
        bends.append(np.ptp(across) / 4.0)
    assert bends[0] > 1e-2 and bends[1] < 1e-4


def test_energy_of_a_swinging_beam_is_in_the_accounts():
    """Nothing acts but the beam itself: what motion loses is in bending and stretching."""
    system = cantilever(12)
    modes = fyke.modes(system, system.net.positions, count=2)
    start = system.at_rest()
    start.velocity[:] = 0.05 * modes.shape[0]
    run = fyke.simulate(
        system,
        duration=0.25 * modes.period[0],
        every=0.005 * modes.period[0],
        stepper=fyke.Newmark(rtol=0.0, atol=1e-7),
        start=start,
    )
    energy = audit(system, run).energy
    bending = Bending.of(system.net)
    stored = bending.energy(run.position[-1]) - bending.energy(run.position[0])
    assert energy.kinetic < 0.0 and stored > -0.9 * energy.kinetic
    assert energy.parts_work == pytest.approx(-stored, rel=2e-3)
    assert abs(energy.remainder) < 5e-3 * stored


def test_relaxation_in_time_knows_tubes():
    """The second way of statics, alone, on a beam that bends far."""
    system = cantilever(20, load=(0.0, 0.0, -2.0 * STIFFNESS / LENGTH**2))
    s = Equilibrium(system, system.at_rest(), None)
    assert relax(s, lambda: s.residual <= max(1e-8, s.floor), 1000, lambda: None) == "there"
    assert s.x + s.origin == pytest.approx(shape(system), abs=1e-6)


@pytest.mark.parametrize("speed", [0.0, 0.5, 1.0])
def test_model_cage_on_a_floating_collar_finds_its_equilibrium(speed):
    """A cage as that of the examples with its rim on an HDPE tube afloat, on four soft lines, in up to 1 m/s."""
    twine = fyke.Twine("twine", 1140.0, 4.44e-3, fyke.LinearLaw(40e6))
    netting = Netting(twine, "square", 0.0859)
    net = frustum(netting, (64, 18), diameters=(1.75, 1.75), height=1.5, fixed="none")
    rim, load = net.panels[0].edge("top"), np.zeros_like(net.positions)
    load[net.panels[0].edge("bottom")[:-1:4], 2] = -5.15
    net = replace(net, load=load)
    collar = Tube.of("HDPE", diameter=0.063, wall=0.0036).twine("collar")
    net = with_rope(net, rim, collar, name="collar", kind="collar")
    soft = fyke.Twine("soft", 1100.0, 4e-3, fyke.LinearLaw(2e7))
    count = len(rim) - 1
    for k in range(4):
        knot = int(rim[(2 * k + 1) * count // 8])
        anchor = tuple(5.0 / 0.875 * net.positions[knot])
        net = with_line(net, anchor, knot, [LinePiece(soft, 4.125, 8)], name=f"m{k}", held=(True, False))
    laws = fyke.Coefficients(bars=fyke.ConstantBar(2.203, 0.184))
    system = fyke.make_system(net, current=(speed, 0.0, 0.0), coefficients=laws, surface=True)
    result = fyke.solve_static(system, tolerance=1e-6)
    assert result.outcome.ok and result.outcome.iterations < 40, result.outcome
    frame, x = result.frame(), result.position[-1]
    assert frame.support_reaction[:2] == pytest.approx(frame.hydrodynamic_force[:2], abs=1e-4)
    assert np.abs(x[rim, 2]).max() < 0.02
    if speed > 0.0:
        assert x[rim, 0].mean() > 0.5 and np.ptp(x[rim, 0]) > np.ptp(x[rim, 1]) + 2e-3
    # The other half of the cage is the mirror image.
    mirrored = x[rim] * [1.0, -1.0, 1.0]
    assert x[rim[::-1]] == pytest.approx(mirrored, abs=1e-4)
