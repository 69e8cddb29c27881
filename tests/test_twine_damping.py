"""Twine damping from a loss factor: the bar's ringing, the decrement of a swing, the case file, what is said of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fyke
from fyke.cli.check import judge
from fyke.netting.twine import MATERIALS
from fyke.results.encoding import twines_from_text, twines_to_text
from reference import NO_FORCES, NO_WATER, thread

EXAMPLES = Path(__file__).parents[1] / "examples"
LOSS, MASS, SPRING, LENGTH, LOAD = 0.05, 0.2, 5e4, 0.5, 100.0


def balls(net, mass):
    diameter = 0.01 * np.ones(net.knot_count)
    return replace(net, knot_diameter=diameter, knot_density=mass / (np.pi / 6 * diameter**3))


def bar(fixed, mass=MASS, loss=LOSS, damping_time=0.0):
    """One massless bar with a ball at each end, stretched by a dead load."""
    twine = replace(
        thread(SPRING * LENGTH, density=0.0), loss_factor=loss, damping_time=damping_time, material=""
    )
    stretched = LENGTH + LOAD / SPRING
    net = fyke.line(
        twine,
        [[0, 0, 0], [stretched, 0, 0]],
        LENGTH,
        fixed=fixed,
        load=[[-LOAD, 0, 0], [LOAD, 0, 0]],
    )
    return fyke.make_system(balls(net, mass), water=NO_WATER, coefficients=NO_FORCES)


def test_a_ball_on_a_held_bar_loses_what_its_loss_factor_says():
    """omega^2 = k / m, zeta = tan(delta) / 2; e^(-zeta omega t) is left of the swing after a time t."""
    system = bar(fixed=(0,))
    frequency, zeta, periods = np.sqrt(SPRING / MASS), LOSS / 2, 5
    period = 2 * np.pi / (frequency * np.sqrt(1 - zeta**2))
    pulled = system.net.positions + np.array([[0, 0, 0], [1e-4, 0, 0]])
    start = fyke.State(0.0, pulled, np.zeros((2, 3)))
    run = fyke.simulate(
        system,
        duration=periods * period,
        every=period,
        start=start,
        stepper=fyke.Verner(rtol=1e-10, atol=1e-14),
    )
    swing = (run.position[:, 1, 0] - system.net.positions[1, 0]) / 1e-4
    # Let go at rest, the swing is back at rest after each period.
    assert swing == pytest.approx(np.exp(-zeta * frequency * period * np.arange(periods + 1)), rel=1e-6)


def test_ringing_of_a_bar_by_hand():
    """omega^2 = k (1 / m_a + 1 / m_b); a held knot counts as heavy beyond measure."""
    mass = np.array([0.2, 0.3])
    reduced = mass.prod() / mass.sum()
    for fixed, rings in (((), reduced), ((0,), 0.3), ((1,), 0.2)):
        found = bar(fixed, mass).elements.damping_time
        assert found == pytest.approx([LOSS / np.sqrt(SPRING / rings)], rel=1e-14)
    assert bar((), mass, damping_time=1e-3).elements.damping_time == pytest.approx(
        [1e-3 + LOSS / np.sqrt(SPRING / reduced)], rel=1e-14
    )


def test_bars_without_a_ringing_have_no_damping_of_their_loss():
    assert bar((0, 1)).elements.damping_time.tolist() == [0.0]
    assert bar((0,), mass=0.0).elements.damping_time.tolist() == [0.0]
    assert not bar((0, 1)).elements.damped and bar((0,)).elements.damped


def test_long_bars_damp_longer():
    """Twice the length, half the stiffness and twice the mass of the twine: the same loss at half the frequency."""
    twine = fyke.Twine("t", 1140.0, 2e-3, fyke.LinearLaw(1e9), loss_factor=LOSS)
    times = []
    for length in (0.03, 0.06):
        points = np.outer(np.arange(4) * length, [1.0, 0.0, 0.0])
        system = fyke.make_system(fyke.line(twine, points, length))
        times.append(system.elements.damping_time)
    assert times[1] == pytest.approx(2.0 * times[0], rel=1e-14)
    # A free bar between two more: 2 sqrt(E / rho) / l would be its own alone; with half a neighbour more at each end
    # the mass at a knot is twice that.
    assert times[0][1] == pytest.approx(LOSS * 0.03 / np.sqrt(2.0 * 1e9 / 1140.0), rel=1e-14)


def panel_case(twine):
    text = (EXAMPLES / "panel.toml").read_text(encoding="utf-8")
    return fyke.parse_case(text.replace('youngs_modulus = "1.0 GPa"', 'youngs_modulus = "1.0 GPa"\n' + twine))


def damping_of(case):
    return fyke.build_system(fyke.build_net(case), case).elements.damping_time


def test_nylon_left_alone_has_the_loss_of_nylon():
    case = panel_case("")
    twine = case.twines["main"]
    assert (twine.damping_time, twine.loss_factor) == (0.0, MATERIALS["PA"].loss_factor) == (0.0, 0.02)
    system = fyke.build_system(fyke.build_net(case), case)
    # Inner knots carry half of four bars, their own sphere and half of its volume of water.
    tube, ball = np.pi / 4 * 1.5e-3**2, np.pi / 6 * 3.5e-3**3
    mass = 2 * 1140.0 * tube * 0.03 + (1140.0 + 500.0) * ball
    inner = np.flatnonzero(~system.net.fixed[system.net.bars].any(axis=1))
    expected = 0.02 / np.sqrt(2 * 1e9 * tube / 0.03 / mass)
    assert system.elements.damping_time[inner] == pytest.approx(expected, rel=1e-12)
    assert 0.7e-6 < expected < 0.8e-6


@pytest.mark.parametrize(("given", "time"), [("0", 0.0), ('"20 us"', 2e-5)])
def test_what_the_case_says_comes_first(given, time):
    case = panel_case(f"damping_time = {given}")
    assert case.twines["main"].loss_factor == 0.0
    assert np.unique(damping_of(case)) == pytest.approx([time])
    assert judge(case)["panels"][0]["damping_source"] == "as given"


def test_material_without_a_source_has_no_damping_and_the_check_says_so():
    unknown = {name for name, material in MATERIALS.items() if material.loss_factor is None}
    assert unknown == {"PES", "PE", "PP", "UHMWPE", "CuZn"}
    for name in unknown:
        text = panel_case("").text.replace('"PA"', f'"{name}"')
        found = judge(fyke.parse_case(text))["panels"][0]
        assert found["damping_time"] == 0.0
        assert found["damping_source"] == f"no loss factor of {name} found"
        assert "no loss factor" in MATERIALS[name].loss_source
    plain = panel_case("").text.replace('material = "PA"\n', "")
    assert judge(fyke.parse_case(plain))["panels"][0]["damping_source"] == "none given"


def test_check_and_sources_say_how_much_and_whence():
    case = panel_case("")
    found = judge(case)["panels"][0]
    assert found["damping_source"] == "loss factor 0.02 of PA"
    assert found["damping_time"] == damping_of(case).max()
    (line,) = (s for s in fyke.build_system(fyke.build_net(case), case).sources if s.startswith("damping"))
    assert "loss factor 0.02" in line and "Woodhouse" in line and "not opened" in line
    assert "damping of twine 'thread': none" in bar((0, 1), loss=0.0).sources


def test_damping_of_the_material_hardly_shortens_the_steps():
    """zeta = tau omega / 2 of a few per cent: sqrt(1 + zeta^2) - zeta of the undamped step."""
    case = panel_case("")
    system = fyke.build_system(fyke.build_net(case), case)
    bare = panel_case("damping_time = 0")
    bare = fyke.build_system(fyke.build_net(bare), bare)
    steps = [fyke.Symplectic().stability_bound(s, s.at_rest()) for s in (system, bare)]
    zeta = system.elements.damping_time.max() / steps[1]
    assert 0.005 < zeta < 0.05
    assert steps[0] / steps[1] == pytest.approx(np.sqrt(1 + zeta**2) - zeta, rel=1e-12)


def test_the_equilibrium_does_not_depend_on_it():
    results = []
    for case in (panel_case(""), panel_case("damping_time = 0")):
        results.append(fyke.solve_static(fyke.build_system(fyke.build_net(case), case)))
    assert results[0].position.tobytes() == results[1].position.tobytes()


def test_loss_factor_goes_through_a_result_file():
    twines = (replace(thread(10.0), loss_factor=0.02), thread(20.0))
    assert twines_from_text(twines_to_text(twines)) == twines
    without = twines_to_text(twines[1:]).replace(', "loss_factor": 0.0', "")
    assert "loss_factor" not in without and twines_from_text(without) == twines[1:]
