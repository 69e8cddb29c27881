"""What every motion keeps, on random nets: momentum, spin, energy, and the same laws for every observer."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import fyke
from reference import NO_FORCES

# Vacuum with gravity, and water without the added mass of bars: a mass that turns with its bar without the gyroscopic
# terms, as M a = F has it, exchanges energy with the water.
VACUUM = {"water": fyke.Water(density=0.0), "coefficients": NO_FORCES}
WET = {"coefficients": fyke.Coefficients(added_mass_bar=0.0)}
GRAVITY = np.array([0.0, 0.0, -9.81])
TIGHT_VERNER = fyke.Verner(rtol=1e-9, atol=1e-12)
STEPPERS = [
    fyke.Symplectic(),
    TIGHT_VERNER,
    fyke.Implicit(rtol=1e-6, atol=1e-9),
    fyke.Newmark(rtol=1e-6, atol=1e-9),
]
# Steps that the rounding of another frame of reference does not change.
FIXED_STEPS = [
    fyke.Symplectic(),
    TIGHT_VERNER,
    fyke.Implicit(max_step=2e-4, fixed=True, rtol=0.0, atol=1e-12),
    fyke.Newmark(max_step=2e-4, fixed=True, rtol=0.0, atol=1e-12),
]
few = settings(max_examples=6, deadline=None, derandomize=True, phases=[Phase.generate])


@dataclass(frozen=True)
class Draw:
    """A random small panel, stretched and shaken; soft twine, so that a motion takes tens of milliseconds."""

    mesh: str
    meshes: tuple[int, int]
    modulus: float
    stretch: float
    speed: float
    seed: int

    def system(self, fixed: str = "none", damping_time: float = 0.0, **water: Any) -> fyke.System:
        twine = fyke.Twine("soft", 1140.0, 1.5e-3, fyke.LinearLaw(self.modulus), damping_time=damping_time)
        spread = np.sqrt(2.0) if self.mesh == "diamond" else 1.0
        net = fyke.panel(
            twine,
            mesh=self.mesh,
            meshes=self.meshes,
            bar_length=0.03,
            size=tuple(0.03 * spread * np.array(self.meshes)),
            knot_diameter=3.5e-3,
            fixed=fixed,
        )
        return fyke.make_system(net, **water)

    def start(self, system: fyke.System, drift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> fyke.State:
        random = np.random.default_rng(self.seed)
        free = system.elements.free[:, None]
        shape = system.net.positions.shape
        place = system.net.positions * self.stretch + random.normal(scale=2e-4, size=shape)
        speed = free * (np.array(drift) + random.normal(scale=self.speed, size=shape))
        return fyke.State(0.0, place, speed)


def draws(slow: bool = False) -> st.SearchStrategy[Draw]:
    """Slow ones stay taut for some milliseconds at least."""
    return st.builds(
        Draw,
        mesh=st.sampled_from(["diamond", "square"]),
        meshes=st.tuples(st.integers(2, 3), st.integers(2, 3)),
        modulus=st.floats(5.0, 6.0).map(lambda p: 10**p),
        stretch=st.floats(1.1, 1.2),
        speed=st.just(0.02) if slow else st.floats(0.05, 0.5),
        seed=st.integers(0, 2**31),
    )


def energies(system: fyke.System, run: fyke.Result) -> np.ndarray:
    """Kinetic, elastic (linear law) and potential energy of weight less buoyancy of every frame, J."""
    el, net = system.elements, system.net
    length = np.linalg.norm(run.position[:, net.bars[:, 1]] - run.position[:, net.bars[:, 0]], axis=2)
    stretch = np.maximum(length - net.rest_length, 0.0)
    elastic = 0.5 * (el.stiffness * stretch**2).sum(axis=1)
    return run.kinetic_energy + elastic - (el.weight * run.position).sum(axis=(1, 2))


def taut(run: fyke.Result) -> bool:
    return bool(np.all(run.tension > 0.0))


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
@few
@given(draw=draws(), drift=st.tuples(*[st.floats(-2.0, 2.0)] * 3))
def test_a_falling_net_falls_like_a_stone_and_spins_on(stepper, draw, drift):
    """Without water the centre of mass keeps to its parabola whatever the twine does, through snaps and slack.

    Forces between two knots along their bar leave no moment: leapfrog keeps the spin to rounding, Verner to its
    tolerance, and the implicit methods, whose moment is that of no single configuration, to second order.
    """
    system = draw.system(damping_time=1e-4, **VACUUM)
    start = draw.start(system, drift)
    run = fyke.simulate(system, duration=0.02, every=0.004, start=start, stepper=stepper)
    assert run.outcome.ok
    mass = system.elements.knot_mass[:, None]
    share = mass / mass.sum()
    time = run.time[:, None]
    centre, speed = (share * run.position).sum(axis=1), (share * run.velocity).sum(axis=1)
    assert centre == pytest.approx(
        centre[0] + speed[0] * time + 0.5 * GRAVITY * time**2, rel=1e-12, abs=1e-13
    )
    assert speed == pytest.approx(speed[0] + GRAVITY * time, rel=1e-11, abs=1e-11)
    arm, motion = run.position - centre[:, None], run.velocity - speed[:, None]
    spin = np.cross(arm, mass * motion).sum(axis=1)
    size = (mass[:, 0] * np.linalg.norm(arm[0], axis=1) * np.linalg.norm(motion, axis=2).max(axis=0)).sum()
    kept = {"symplectic": 1e-12, "verner": 1e-8}.get(stepper.name, 1e-3)
    assert np.abs(spin - spin[0]).max() < kept * size


@few
@given(draw=draws(slow=True))
def test_energy_of_leapfrog_swings_with_the_step_squared(draw):
    """A taut net without water: the energy swings by so much, a quarter of it at half the step, and does not drift."""
    system = draw.system(fixed="edges", **VACUUM)
    start = draw.start(system)
    step = fyke.Symplectic().stability_bound(system, start) / 4

    def run(halved: int) -> np.ndarray:
        h = step / 2**halved
        out = fyke.simulate(
            system, duration=100 * step, every=step, start=start, stepper=fyke.Symplectic(max_step=h)
        )
        assert taut(out)
        return energies(system, out)

    coarse, fine = run(0), run(1)
    swing = np.array([np.abs(e - e[0]).max() for e in (coarse, fine)])
    assert swing[0] / swing[1] == pytest.approx(4.0, rel=0.1)
    assert swing[0] < 0.05 * fine[0]
    first, last = np.split(coarse[1:], 2)
    assert abs(last.mean() - first.mean()) < 0.5 * swing[0]


@few
@given(draw=draws())
def test_verner_keeps_the_energy_within_its_tolerance(draw):
    """Through snaps and slack: a hundred times tighter, and the error falls by a factor of tens at least."""
    system = draw.system(**VACUUM)
    start = draw.start(system)

    def drift(rtol: float) -> float:
        verner = fyke.Verner(rtol=rtol, atol=1e-3 * rtol)
        e = energies(system, fyke.simulate(system, duration=0.02, every=0.002, start=start, stepper=verner))
        return float(np.abs(e - e[0]).max() / e[0])

    assert drift(1e-5) < 1e-3
    assert drift(1e-9) < 1e-5


@few
@given(draw=draws(slow=True))
def test_small_swings_lose_with_implicit_and_are_kept_by_newmark(draw):
    """About the rest of a net stretched on its frame, without water, energy above that of the rest.

    Steps that resolve the fastest mode never raise it above the start with BDF2. Steps far beyond it do
    once, in their first step, as methods with this damping are known to, and take all of it after that. Newmark keeps
    it with any step.
    """
    loose = draw.system(fixed="edges", **VACUUM)
    system = fyke.make_system(replace(loose.net, positions=loose.net.positions * draw.stretch), **VACUUM)
    rest = fyke.solve_static(system, tolerance=1e-12)
    shake = np.random.default_rng(draw.seed).normal(size=(2, *system.net.positions.shape))
    shake *= system.elements.free[:, None]
    start = fyke.State(0.0, rest.position[-1] + 2e-6 * shake[0], 2e-4 * shake[1])
    bound = fyke.Symplectic().stability_bound(system, start)
    left = {}
    for method in (fyke.Implicit, fyke.Newmark):
        for beyond in (1 / 8, 16):
            h = beyond * bound
            stepper = method(max_step=h, fixed=True, rtol=0.0, atol=1e-13)
            run = fyke.simulate(system, duration=60 * h, every=h, start=start, stepper=stepper)
            assert run.outcome.ok and taut(run)
            above = energies(system, run) - energies(system, rest)
            left[method, beyond] = above / above[0]
    assert left[fyke.Implicit, 1 / 8].max() < 1.0 + 1e-6
    assert left[fyke.Implicit, 1 / 8][-1] < 0.99
    assert left[fyke.Implicit, 16][30:] == pytest.approx(0.0, abs=1e-6)
    assert left[fyke.Newmark, 1 / 8] == pytest.approx(1.0, abs=1e-5)
    assert left[fyke.Newmark, 16] == pytest.approx(1.0, abs=1e-3)


@few
@given(draw=draws())
def test_what_implicit_gains_on_a_tumbling_net_goes_with_the_step_squared(draw):
    """Let go stretched, a free net tumbles through its own slack bars: no method of this kind keeps energy then."""
    system = draw.system(**VACUUM)
    start = draw.start(system)
    step = fyke.Symplectic().stability_bound(system, start) / 8

    def gain(h: float) -> float:
        implicit = fyke.Implicit(max_step=h, fixed=True, rtol=0.0, atol=1e-10)
        e = energies(
            system, fyke.simulate(system, duration=64 * step, every=step, start=start, stepper=implicit)
        )
        return float(max(e.max() / e[0] - 1.0, 0.0))

    assert gain(step) < 0.03
    assert gain(step / 4) < 0.005


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
@few
@given(draw=draws(), damping_time=st.sampled_from([0.0, 1e-4]))
def test_still_water_only_takes_energy(stepper, draw, damping_time):
    """From one output to the next, through snaps and slack; steps well below those of the ringing."""
    system = draw.system(fixed="top", damping_time=damping_time, **WET)
    start = draw.start(system)
    if stepper.name != "verner":
        bound = fyke.Symplectic().stability_bound(system, start)
        stepper = replace(stepper, max_step=bound / 16)
    run = fyke.simulate(system, duration=0.03, every=0.003, start=start, stepper=stepper)
    energy = energies(system, run)
    assert run.outcome.ok
    assert np.diff(energy).max() < 2e-3 * np.ptp(energy)
    assert energy[-1] < energy[0]


def moved(a: fyke.Result, b: fyke.Result) -> float:
    return float(np.abs(a.position - b.position).max())


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
@few
@given(draw=draws(), current=st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_a_net_that_drifts_with_the_current_does_what_one_in_still_water_does(stepper, draw, current):
    """Galilei: towed at -U through still water is left alone in a current U, seen from a boat that drifts at U."""
    still = draw.system()
    drifting = draw.system(current=current)
    boat = np.array(current)
    options = {"duration": 0.01, "every": 0.002, "stepper": stepper}
    towed = fyke.simulate(still, start=draw.start(still, drift=tuple(-boat)), **options)
    left = fyke.simulate(drifting, start=draw.start(drifting), **options)
    apart = np.abs(left.position - boat * left.time[:, None, None] - towed.position).max()
    # Verner scales its tolerance with the speed of the water, so that its steps differ.
    assert apart < {"verner": 1e-8}.get(stepper.name, 1e-10)
    assert left.hydrodynamic_force == pytest.approx(towed.hydrodynamic_force, rel=1e-6, abs=1e-6)


def turned(system: fyke.System, start: fyke.State, turn: np.ndarray, options: dict[str, Any]) -> fyke.Result:
    net = replace(system.net, positions=system.net.positions @ turn.T)
    current = system.current.velocity(np.zeros((1, 3)), 0.0)[0] @ turn.T
    again = fyke.make_system(net, current=tuple(float(c) for c in current))
    return fyke.simulate(
        again, start=fyke.State(0.0, start.position @ turn.T, start.velocity @ turn.T), **options
    )


@pytest.mark.parametrize("stepper", FIXED_STEPS, ids=lambda s: s.name)
@few
@given(draw=draws(), angle=st.floats(0.1, 6.0), mirror=st.booleans())
def test_turning_or_mirroring_the_start_turns_or_mirrors_the_motion(stepper, draw, angle, mirror):
    """About the vertical, which gravity leaves alone; added mass that turns with its bars included."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.diag(
        [1.0, -1.0 if mirror else 1.0, 1.0]
    )
    system = draw.system(fixed="top", current=(0.4, -0.1, 0.2))
    start = draw.start(system)
    options = {"duration": 0.01, "every": 0.002, "stepper": stepper}
    first = fyke.simulate(system, start=start, **options)
    again = turned(system, start, turn, options)
    # Snaps make rounding grow.
    assert np.abs(first.position @ turn.T - again.position).max() < 1e-8
    assert np.abs(first.tension - again.tension).max() < 1e-5 * first.tension.max()


@few
@given(draw=draws(slow=True))
def test_leapfrog_goes_the_way_back(draw):
    """Without water and damping, turning all speeds round leads back to the start to rounding, whatever the step."""
    system = draw.system(fixed="edges", **VACUUM)
    start = draw.start(system)
    options = {"duration": 0.02, "every": 0.02, "stepper": fyke.Symplectic(max_step=2e-4)}
    there = fyke.simulate(system, start=start, **options).frame()
    back = fyke.simulate(system, start=fyke.State(0.0, there.position, -there.velocity), **options).frame()
    assert np.abs(there.position - start.position).max() > 1e-5
    assert np.abs(back.position - start.position).max() < 1e-12
    assert np.abs(back.velocity + start.velocity).max() < 1e-9


@few
@given(draw=draws(slow=True), damping_time=st.sampled_from([0.0, 2e-4]))
def test_all_steppers_give_one_motion_as_their_steps_shrink(draw, damping_time):
    """A taut panel in a current against Verner's pair: the error is small, and four times smaller at half the step."""
    system = draw.system(fixed="edges", damping_time=damping_time, current=(0.5, 0.1, 0.0))
    start = draw.start(system)
    duration = 0.01
    options = {"duration": duration, "every": duration, "start": start}
    exact = fyke.simulate(system, stepper=TIGHT_VERNER, **options)
    assert taut(exact)
    path = moved(exact, replace(exact, position=start.position[None]))
    for stepper in (fyke.Implicit, fyke.Newmark):
        errors = [
            moved(
                fyke.simulate(
                    system, stepper=stepper(max_step=h, fixed=True, rtol=0.0, atol=1e-13), **options
                ),
                exact,
            )
            for h in (duration / 100, duration / 200)
        ]
        assert errors[0] < 0.2 * path
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)
    errors = [
        moved(fyke.simulate(system, stepper=fyke.Symplectic(max_step=h), **options), exact)
        for h in (duration / 100, duration / 800)
    ]
    # Of first order only where the water does not move along one line, see theory.
    assert errors[0] < 0.05 * path
    assert errors[1] < errors[0] / 6
