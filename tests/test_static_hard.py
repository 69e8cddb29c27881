"""Static equilibrium of hard nets: slack, soft, stiff, held at few knots, of mixed twines; and wrong input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

import fyke
from fyke.netting.together import together
from reference import NO_FORCES, NO_WATER, thread

BAR = 0.03


def unbalanced(system: fyke.System, x: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Sum of all forces (n, 3) N on the knots by docs/theory.md, from the net alone; linear laws only."""
    net, rho = system.net, 1000.0
    a, b = net.bars.T
    d = x[b] - x[a]
    length = np.linalg.norm(d, axis=1)
    t = d / length[:, None]
    diameter = np.array([w.diameter for w in net.twines])[net.twine_of_bar]
    modulus = np.array([w.law.youngs_modulus for w in net.twines])[net.twine_of_bar]
    density = np.array([w.density for w in net.twines])[net.twine_of_bar]
    area = np.pi / 4.0 * diameter**2
    tension = modulus * area * np.maximum(length / net.rest_length - 1.0, 0.0)
    s = t @ velocity
    n = velocity - s[:, None] * t
    drag = 1.2 * np.linalg.norm(n, axis=1)[:, None] * n + 0.1 * (np.abs(s) * s)[:, None] * t
    half = 0.25 * rho * (diameter * length)[:, None] * drag
    half[:, 2] -= 0.5 * 9.81 * (density - rho) * area * net.rest_length
    out = (
        net.load
        + 0.5 * rho * np.pi / 4.0 * (net.knot_diameter**2)[:, None] * np.linalg.norm(velocity) * velocity
    )
    out[:, 2] -= 9.81 * (net.knot_density - rho) * np.pi / 6.0 * net.knot_diameter**3
    pull = tension[:, None] * t
    for ends, force in ((a, half + pull), (b, half - pull)):
        np.add.at(out, ends, force)
    out[net.fixed] = 0.0
    return out


def check(system: fyke.System, velocity: tuple[float, float, float], most: int) -> fyke.Result:
    """Converged, in so many factorizations, and balanced by the twin above up to rounding."""
    result = fyke.solve_static(system)
    assert result.outcome.ok, result.outcome
    assert result.outcome.factorizations <= most
    x = result.position[-1]
    floor = 2.2e-16 * 16.0 * system.elements.stiffness.max() * np.abs(x).max()
    assert np.abs(unbalanced(system, x, np.array(velocity))).max() <= 1e-8 + floor
    return result


def net_of(short: float, modulus: float, fixed: str, mesh: str = "diamond", meshes: int = 12) -> fyke.Net:
    side = short * meshes * BAR * (np.sqrt(2.0) if mesh == "diamond" else 1.0)
    return fyke.panel(
        fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(modulus)),
        mesh=mesh,
        meshes=(meshes, meshes),
        bar_length=BAR,
        size=(side, side),
        knot_diameter=3.5e-3,
        fixed=fixed,
    )


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    short=st.floats(0.3, 1.0),
    modulus=st.floats(np.log10(40e6), 11.0).map(lambda p: 10.0**p),
    speed=st.floats(np.log10(0.05), np.log10(5.0)).map(lambda p: 10.0**p),
    direction=st.sampled_from(["across", "along the width"]),
    fixed=st.sampled_from(["edges", "corners"]),
    mesh=st.sampled_from(["diamond", "square"]),
)
def test_framed_panels_of_the_hard_list(short, modulus, speed, direction, fixed, mesh):
    if fixed == "corners" and direction != "across":
        fixed = "edges"
    velocity = (speed, 0.0, 0.0) if direction == "across" else (0.0, speed, 0.0)
    net = net_of(short, modulus, fixed, mesh)
    check(fyke.make_system(net, current=velocity), velocity, 25)


@pytest.mark.parametrize("speed", [0.05, 0.1, 0.3])
@pytest.mark.parametrize("mesh", ["square", "diamond"])
def test_slack_bars_of_steel(speed, mesh):
    """The law of their slack is some 1e5 N, the tension of the others some 1e-3 N."""
    velocity = (speed, 0.0, 0.0)
    check(fyke.make_system(net_of(0.5, 1e11, "edges", mesh), current=velocity), velocity, 20)


@pytest.mark.parametrize("opening", [1.0, 0.7, 0.3])
def test_straight_bars_that_a_light_knot_lifts(opening):
    """One diamond mesh on its frame, with neither slack nor strain: T grows from nothing, as in a straight string."""
    size = 0.2 * np.array([np.sin(opening), np.cos(opening)])
    law = fyke.TableLaw((0.0, 0.01, 0.05, 0.2), (0.0, 5.0, 60.0, 400.0))
    net = fyke.panel(
        fyke.Twine("any", 850.0, 0.01, law),
        mesh="diamond",
        meshes=(1, 1),
        bar_length=0.1,
        size=tuple(size),
        normal=(0.0, 0.0, 1.0),
    )
    result = fyke.solve_static(fyke.make_system(net))
    assert result.outcome.ok and result.outcome.iterations <= 15
    # The knot in the middle bears half of each of its four bars and rises by h: 4 T h / l lifts what floats.
    lift = 4.0 * 0.5 * 150.0 * 9.81 * np.pi / 4.0 * 0.01**2 * 0.1
    middle = int(np.argmin(np.linalg.norm(net.positions, axis=1)))
    height = result.position[-1][middle, 2]
    pull = 5.0 / 0.01 * (np.hypot(0.1, height) / 0.1 - 1.0)
    assert 4.0 * pull * height / np.hypot(0.1, height) == pytest.approx(lift, rel=1e-6)


@settings(max_examples=20, deadline=None, derandomize=True)
@given(
    short=st.floats(0.5, 1.0),
    meshes=st.integers(3, 14),
    speed=st.floats(np.log10(0.05), np.log10(5.0)).map(lambda p: 10.0**p),
)
def test_curtains(short, meshes, speed):
    velocity = (speed, 0.0, 0.0)
    system = fyke.make_system(net_of(short, 1e9, "top", meshes=meshes), current=velocity)
    x = check(system, velocity, 40).position[-1]
    # Symmetric about the upright middle line, as panel and current are.
    start = system.net.positions
    twin = np.argmin(np.linalg.norm(start[None] - (start * [1.0, -1.0, 1.0])[:, None], axis=2), axis=1)
    assert np.abs(x[twin] * [1.0, -1.0, 1.0] - x).max() < 1e-5


@pytest.mark.parametrize("seed", [1, 3, 4, 5, 16, 18, 56])
def test_nets_on_few_knots_in_any_current_relax(seed):
    """Held at the top or at four knots, water from anywhere: on some of them the interior point does not arrive."""
    rng = np.random.default_rng(seed)
    mesh = str(rng.choice(["diamond", "square"]))
    meshes = int(rng.integers(4, 11))
    net = net_of(float(rng.uniform(0.4, 1.0)), 1e9, "top", mesh, meshes)
    if seed % 2:
        held = np.zeros(net.knot_count, dtype=bool)
        held[rng.choice(net.knot_count, 4, replace=False)] = True
        net = replace(net, fixed=held)
    direction = rng.normal(size=3) * [0.2, 1.0, 1.0]
    velocity = tuple(float(c) for c in rng.uniform(0.1, 2.0) * direction / np.linalg.norm(direction))
    check(fyke.make_system(net, current=velocity), velocity, 1000)


def energy(net: fyke.Net, x: np.ndarray) -> float:
    """Elastic energy less the work of the dead loads, J."""
    a, b = net.bars.T
    ea = np.array([w.law.youngs_modulus * w.area for w in net.twines])[net.twine_of_bar]
    stretch = np.maximum(np.linalg.norm(x[b] - x[a], axis=1) - net.rest_length, 0.0)
    return float(0.5 * (ea / net.rest_length * stretch**2).sum() - (net.load * x).sum())


@pytest.mark.parametrize("weight", [1.0, 1e3])
def test_rope_and_fine_twine_in_one_net_under_heavy_weights(weight):
    """EA of 1e6 N beside 1e2 N; a point load of up to 1e3 N hangs on the rope, hundredths of a newton on the twine."""
    rope, fine = thread(1e6, diameter=0.02), thread(1e2)
    net = net_of(0.9, 1e9, "top", "square", 4)
    i, j = np.array([[int(part) for part in label.split("-")] for label in net.labels]).T
    a, b = net.bars.T
    on_rope = (i[a] == 2) & (i[b] == 2)
    load = np.zeros_like(net.positions)
    load[:, 2] = -0.01
    load[(i == 2) & (j == 0)] = [0.1 * weight, 0.0, -weight]
    net = replace(net, twines=(rope, fine), twine_of_bar=np.where(on_rope, 0, 1), load=load)
    system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
    result = fyke.solve_static(system)
    assert result.outcome.ok, result.outcome
    x = result.position[-1]
    # By hand: the four rope bars are stretched by at most EA and carry the weight but for what the twine takes.
    assert result.tension[-1][on_rope].max() == pytest.approx(np.hypot(0.1 * weight, weight), rel=0.1)
    assert np.abs(result.support_reaction[-1] - load.sum(axis=0)).max() < 1e-6
    rng = np.random.default_rng(1)
    lowest = energy(net, x)
    for size in (1e-2, 1e-4, 1e-6):
        for _ in range(20):
            moved = x + np.where(net.fixed[:, None], 0.0, rng.normal(scale=size, size=x.shape))
            assert energy(net, moved) >= lowest - 1e-12 * max(abs(lowest), 1.0)


def test_energy_is_the_least_that_another_minimiser_finds():
    """SciPy's L-BFGS-B, from fyke's start, on the energy of a soft net of two twines."""
    net = net_of(0.9, 1e9, "corners", "square", 4)
    load = np.zeros_like(net.positions)
    load[:, 0], load[:, 2] = 0.05, -0.02
    which = (np.arange(net.bar_count) % 3 == 0).astype(np.int64)
    net = replace(net, twines=(thread(1e2), thread(5.0)), twine_of_bar=which, load=load)
    system = fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)
    x = fyke.solve_static(system).position[-1]
    free = ~net.fixed

    def place(z: np.ndarray) -> np.ndarray:
        out = net.positions.copy()
        out[free] = z.reshape(-1, 3)
        return out

    rng = np.random.default_rng(2)
    start = (net.positions + rng.normal(scale=1e-3, size=x.shape))[free].ravel()
    found = minimize(
        lambda z: energy(net, place(z)), start, method="L-BFGS-B",
        options={"maxiter": 4000, "maxfun": 400_000, "ftol": 1e-15, "gtol": 1e-9},
    )  # fmt: skip
    assert energy(net, x) <= found.fun
    assert found.fun - energy(net, x) < 1e-5 * abs(found.fun)
    assert np.abs(place(found.x) - x).max() < 2e-3


def test_floating_parts_are_listed(framed):
    net = framed().net
    parts = [net_of(0.9, 1e9, "none", meshes=n) for n in (2, 3, 4, 5)]
    outcome = fyke.solve_static(fyke.make_system(together([net, *parts]))).outcome
    assert outcome.name == "singular" and outcome.iterations == 0
    # Largest first: 5 meshes have 61 knots, 4 have 41, 3 have 25, 2 have 13.
    assert (
        "knots 0-0 .. 10-10 (61), knots 0-0 .. 8-8 (41), knots 0-0 .. 6-6 (25) and 1 more part are held by nothing"
        in outcome.message
    )


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"tolerance": 0.0}, "tolerance is 0.0"),
        ({"tolerance": float("nan")}, "tolerance is nan"),
        ({"max_iterations": 0}, "max_iterations is 0"),
    ],
)
def test_options_that_cannot_be_meant_are_refused(framed, options, text):
    with pytest.raises(ValueError, match=text):
        fyke.solve_static(framed(), **options)


def test_a_start_of_another_net_or_without_numbers_is_refused(framed):
    system = framed()
    rest = system.at_rest()
    with pytest.raises(ValueError, match=r"position has the shape \(144, 3\), the net's is \(145, 3\)"):
        fyke.solve_static(system, start=replace(rest, position=rest.position[1:]))
    with pytest.raises(ValueError, match=r"tension has the shape \(3,\), the net's is \(256,\)"):
        fyke.solve_static(system, start=replace(rest, tension=np.ones(3)))
    lost = rest.position.copy()
    lost[72, 1] = np.nan
    with pytest.raises(ValueError, match=f"position at {system.net.labels[72]} is not a number"):
        fyke.solve_static(system, start=replace(rest, position=lost))


def test_held_knots_stay_whatever_the_start(framed):
    system = framed()
    moved = replace(system.at_rest(), position=system.net.positions * 1.3)
    x = fyke.solve_static(system, start=moved).position[-1]
    held = system.net.fixed
    assert np.array_equal(x[held], system.net.positions[held])
    assert np.abs(x - fyke.solve_static(system).position[-1]).max() < 1e-6
