"""The stepper that chooses: the rest and motion of the others, its plan, its changes, the same bits when resumed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.solve import auto
from fyke.solve.auto import crossing_time

FAST = (2.0, 0.0, 0.0)


def began(system, duration=2.0):
    return fyke.Auto(duration=duration).start(system, system.at_rest())


def stiffer(system, times):
    twine = replace(system.net.twines[0], law=fyke.LinearLaw(1e9 * times))
    return fyke.make_system(replace(system.net, twines=(twine,)), current=(0.5, 0.0, 0.0))


def test_released_panel_comes_to_the_static_rest(framed):
    """Without twine damping: leapfrog alone would ring on for longer, the implicit method that follows ends it."""
    system = framed()
    static = fyke.solve_static(system)
    result = fyke.simulate(
        system, duration=3.0, every=0.05, stepper=fyke.Auto(), settle=fyke.Settle(force=1e-6)
    )
    assert result.outcome.name == "converged"
    assert result.outcome.solver.startswith("dynamic auto: symplectic, because it needs 0.")
    assert "; implicit from 0." in result.outcome.solver and "\n" not in result.outcome.solver
    assert result.outcome.linear_solver and result.outcome.factorizations > 0
    assert np.abs(result.position[-1] - static.position[-1]).max() < 1e-6
    assert np.abs(result.tension[-1] - static.tension[-1]).max() < 1e-4 * static.tension.max()


def test_follows_verner_across_the_change(framed):
    """At 2 m/s the change comes at 0.08 s, when bars still swing."""
    system = framed(current=FAST, damping_time=2e-5)
    exact = fyke.simulate(system, duration=0.2, every=0.01, stepper=fyke.Verner(rtol=1e-5, atol=1e-8))
    found = fyke.simulate(system, duration=0.2, every=0.01, stepper=fyke.Auto())
    assert "implicit from 0.0" in found.outcome.solver
    rms = np.sqrt(((found.position - exact.position) ** 2).mean(axis=(1, 2)))
    assert rms.max() < 3e-4


def test_same_bits_from_every_checkpoint(framed):
    """Before the change, at it, and after it, where outputs lie within steps."""
    options = {"duration": 0.24, "every": 0.012, "stepper": fyke.Auto()}
    checkpoints = []
    whole = fyke.simulate(framed(current=FAST), on_checkpoint=checkpoints.append, **options)
    assert "implicit from" in whole.outcome.solver
    for checkpoint in checkpoints[::3]:
        frames = [whole.frame(i) for i in range(checkpoint.frames)]
        again = fyke.simulate(framed(current=FAST), resume=(checkpoint, frames), **options)
        assert again.position.tobytes() == whole.position.tobytes()
        assert again.tension.tobytes() == whole.tension.tobytes()
        assert again.outcome.solver == whole.outcome.solver
        assert (again.outcome.iterations, again.outcome.factorizations) == (
            whole.outcome.iterations,
            whole.outcome.factorizations,
        )


def test_outputs_do_not_move_the_change(framed):
    few, many = (
        fyke.simulate(framed(current=FAST), duration=0.2, every=every, stepper=fyke.Auto())
        for every in (0.2, 0.0007)
    )
    assert few.outcome.solver == many.outcome.solver and "implicit from" in few.outcome.solver


def test_the_plan_follows_the_stable_step(framed):
    """The stable step falls with the root of the modulus, and nothing else of the plan changes."""
    system = framed()
    share = began(system).share
    assert began(stiffer(system, 100.0)).share == pytest.approx(share / 10.0, rel=1e-6)
    assert (began(system).name, began(stiffer(system, 100.0)).name) == ("symplectic", "implicit")
    # What comes after rest plays no part.
    assert began(system, 20.0).share == share
    assert began(system, 1e-3).share > share


def test_crossing_time_by_hand(framed, nylon):
    system = framed()
    assert crossing_time(system, system.at_rest()) == pytest.approx(0.3055 / 0.5)
    # A ball in still water: half rho C_D A v^2 carries its weight in water.
    net = fyke.line(
        replace(nylon, density=0.0), [[0, 0, 0]], [], fixed=(), knot_diameter=0.1, knot_density=1100.0
    )
    ball = fyke.make_system(net, coefficients=fyke.Coefficients(knots=fyke.ConstantKnot(10.0)))
    speed = np.sqrt(4.0 / 3.0 * 0.1 * 9.81 * 0.1 / 10.0)
    assert crossing_time(ball, ball.at_rest()) == pytest.approx(0.1 / speed)
    still = fyke.make_system(framed().net, water=fyke.Water(gravity=0.0))
    assert crossing_time(still, still.at_rest()) == np.inf
    assert began(still).name == "implicit"


def test_implicit_hands_over_when_it_needs_more_than_planned(framed, monkeypatch):
    """A plan that expects rest after a few Newton iterations begins with them, and is wrong again and again."""
    monkeypatch.setattr(auto, "REST", 1.0)
    monkeypatch.setattr(auto, "RETURN", 0.5)
    system = framed(damping_time=2e-5)
    options = {"duration": 0.3, "every": 0.01, "stepper": fyke.Auto()}
    checkpoints = []
    whole = fyke.simulate(system, on_checkpoint=checkpoints.append, **options)
    assert whole.outcome.ok
    assert whole.outcome.solver.startswith("dynamic auto: implicit, because")
    assert "symplectic from" in whole.outcome.solver and "implicit from" in whole.outcome.solver
    exact = fyke.simulate(system, duration=0.3, every=0.01, stepper=fyke.Verner(rtol=1e-5, atol=1e-8))
    assert np.sqrt(((whole.position - exact.position) ** 2).mean(axis=(1, 2))).max() < 6e-4
    for checkpoint in checkpoints[::5]:
        frames = [whole.frame(i) for i in range(checkpoint.frames)]
        again = fyke.simulate(system, resume=(checkpoint, frames), **options)
        assert again.position.tobytes() == whole.position.tobytes()


def failing(self, end):
    return "step_too_small"


def too_large(self, end):
    raise MemoryError


@pytest.mark.parametrize("fault", [failing, too_large])
def test_a_fault_of_the_implicit_method_is_left_to_leapfrog_for_good(framed, monkeypatch, fault):
    monkeypatch.setattr("fyke.solve.implicit.ImplicitRun.advance", fault)
    system = stiffer(framed(), 100.0)
    result = fyke.simulate(system, duration=0.02, every=0.01, stepper=fyke.Auto())
    exact = fyke.simulate(system, duration=0.02, every=0.01, stepper=fyke.Symplectic())
    assert result.outcome.ok and result.outcome.solver.endswith("; symplectic from 0 s")
    assert result.position.tobytes() == exact.position.tobytes()
    # The same where it is found at the first change.
    later = fyke.simulate(framed(current=FAST), duration=0.3, every=0.01, stepper=fyke.Auto()).outcome
    assert later.ok and "; implicit from 0.0" in later.solver and later.solver.count("symplectic from") == 1


def test_max_step_holds_for_both(framed):
    run = fyke.simulate(
        framed(current=FAST), duration=0.1, every=0.1, stepper=fyke.Auto(max_step=1e-5)
    ).outcome
    assert run.iterations >= 0.1 / 1e-5
