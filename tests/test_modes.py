"""Natural modes against closed forms, against an own stiffness matrix, and against motion in time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import fyke
import fyke.solve.modes
from fyke.netting.together import together
from reference import NO_FORCES, NO_WATER, grouped, thread

NYLON = fyke.Twine("nylon", density=1140.0, diameter=1.5e-3, law=fyke.LinearLaw(1e9))
ACROSS = np.array([0.0, 1.0, 0.0])
MASS, SPRING, SPACING, TENSION = 0.002, 5000.0, 0.03, 2.0
EXACT = {
    name: np.array([r["omega_rad_s"] for r in rows])
    for name, rows in grouped("natural_frequencies", "system").items()
}


@pytest.fixture(params=["dense", "lanczos"])
def method(request, monkeypatch):
    """Both ways to the eigenvalues, whatever the size; Lanczos only where few of all modes are asked for."""
    monkeypatch.setattr(fyke.solve.modes, "DENSE", 10**6 if request.param == "dense" else 0)
    return request.param


def balls(net, mass, diameter=0.01):
    """Put a ball of this mass (kg) on every knot."""
    ones = np.ones(net.knot_count)
    return replace(net, knot_diameter=diameter * ones, knot_density=mass / (np.pi / 6 * diameter**3) * ones)


def dry(net):
    """Neither water nor gravity: dead load, elasticity and mass."""
    return fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)


def string(bars, length, tension, spring, mass):
    """Balls between equal springs (N/m) along x that pull with this tension, ends held."""
    spacing = length / bars
    rest = spacing - tension / spring
    points = np.outer(np.arange(bars + 1) * spacing, [1.0, 0.0, 0.0])
    return balls(fyke.line(thread(spring * rest, density=0.0), points, rest), mass)


def panel_at_rest(meshes=8, mesh="diamond", gravity=9.81):
    side = 0.038 * meshes
    net = fyke.panel(
        NYLON, mesh=mesh, meshes=(meshes, meshes), bar_length=0.03, size=(side, side), knot_diameter=3.5e-3
    )
    system = fyke.make_system(net, current=(0.5, 0.0, 0.0), water=fyke.Water(gravity=gravity))
    result = fyke.solve_static(system)
    assert result.outcome.ok
    return system, result.position[-1]


@pytest.fixture(scope="module")
def panel():
    return panel_at_rest()


def test_chain_has_the_published_modes(method):
    """One longitudinal family, and the transverse one twice: 27 modes, all there are."""
    net = string(10, 10 * SPACING, TENSION, SPRING, MASS)
    count = 27 if method == "dense" else 8
    found = fyke.modes(dry(net), net.positions, count=count)
    every = np.sort([*EXACT["longitudinal_chain"], *np.repeat(EXACT["transverse_chain"], 2)])
    assert found.frequency == pytest.approx(every[:count], rel=1e-8)
    assert found.period == pytest.approx(2 * np.pi / every[:count], rel=1e-8)


def test_square_net_has_the_published_modes(method):
    rest = SPACING - TENSION / SPRING
    twine = thread(SPRING * rest, density=0.0)
    net = fyke.panel(twine, mesh="square", meshes=(8, 8), bar_length=rest, size=(8 * SPACING, 8 * SPACING))
    net = balls(net, MASS)
    found = fyke.modes(dry(net), net.positions, count=14)
    published = np.sort(EXACT["transverse_square_net_7x7"])
    # (1, 4) and (4, 1) come before (3, 3) and are not in the table.
    assert found.frequency[:8] == pytest.approx(published[:8], rel=1e-8)
    assert np.abs(found.frequency / published[8] - 1.0).min() < 1e-8
    row, column = np.array([label.split("-") for label in net.labels], dtype=float).T
    first = np.outer(np.sin(np.pi * row / 8) * np.sin(np.pi * column / 8), [1.0, 0.0, 0.0])
    assert found.shape[0] == pytest.approx(first, abs=1e-9)


def test_string_of_many_balls_is_a_string():
    """c k pi / L with c^2 = tension / (mass / length); the error of n balls is (k pi / n)^2 / 24 of it."""
    length, tension, mass = 2.0, 30.0, 0.5
    exact = np.arange(1, 5) * np.pi / length * np.sqrt(tension * length / mass)
    errors = []
    for bars in (40, 80):
        net = string(bars, length, tension, 1e8, mass / bars)
        found = fyke.modes(dry(net), net.positions, count=8)
        errors.append(1.0 - found.frequency.reshape(4, 2) / exact[:, None])
    for bars, error in zip((40, 80), errors, strict=True):
        leading = (np.arange(1, 5) * np.pi / bars) ** 2 / 24
        assert error == pytest.approx(np.column_stack([leading, leading]), rel=0.01)


def test_hanging_chain_has_the_roots_of_laguerre():
    """n equal balls on light links l: omega^2 = x g / l with L_n(x) = 0 (Daniel Bernoulli's chain)."""
    n, link, gravity = 12, 0.1, 9.81
    rest = np.full(n, link)
    points = np.outer(np.arange(n + 1), [0.0, 0.0, -link])
    spring, mass = 1e5, 0.05
    rest -= mass * gravity * np.arange(n, 0, -1) / spring
    load = np.outer(np.arange(n + 1) > 0, [0.0, 0.0, -mass * gravity])
    twine = thread(1.0, density=0.0)
    net = fyke.line(twine, points, rest, fixed=(0,), load=load)
    # A stiffness EA per bar that makes every spring the same.
    twines = tuple(thread(spring * r, density=0.0) for r in rest)
    net = balls(replace(net, twines=twines, twine_of_bar=np.arange(n)), mass)
    found = fyke.modes(dry(net), net.positions, count=2 * n)
    roots = np.polynomial.laguerre.lagroots([0.0] * n + [1.0])
    assert found.frequency == pytest.approx(np.repeat(np.sqrt(roots * gravity / link), 2), rel=1e-9)


def test_added_mass_of_a_bar_counts_across_it_only():
    """One knotless point between two bars in water: it carries half of each, and the water across them."""
    tension, spring, length, diameter = 5.0, 2000.0, 0.5, 0.004
    rest = length - tension / spring
    twine = thread(spring * rest, diameter=diameter, density=1140.0)
    net = fyke.line(twine, [[0.0, 0.0, 0.0], [0.3, 0.4, 0.0], [0.6, 0.8, 0.0]], rest)
    found = fyke.modes(fyke.make_system(net), net.positions)
    volume = np.pi / 4 * diameter**2 * rest
    across = np.sqrt(2 * tension / length / ((1140.0 + 1000.0) * volume))
    along = np.sqrt(2 * spring / (1140.0 * volume))
    assert found.frequency == pytest.approx([across, across, along], rel=1e-9)
    assert found.shape[2, 1] == pytest.approx([0.6, 0.8, 0.0], abs=1e-9)


def test_stiffness_along_a_bar_is_the_slope_of_its_law():
    diameter, c1, c2, strain, mass = 1e-3, 3e8, 1.4, 0.05, 0.1
    twine = fyke.Twine("braid", 0.0, diameter, fyke.PowerLaw(c1, c2))
    net = balls(fyke.line(twine, np.outer(np.arange(3) * (1 + strain), [0.0, 1.0, 0.0]), 1.0), mass)
    found = fyke.modes(dry(net), net.positions)
    slope = diameter**2 * c1 * c2 * strain ** (c2 - 1)
    tension = diameter**2 * c1 * strain**c2
    across = np.sqrt(2 * tension / (1 + strain) / mass)
    assert found.frequency == pytest.approx([across, across, np.sqrt(2 * slope / mass)], rel=1e-9)


def own_matrices(system, x):
    """K (3n, 3n) by complex steps in the tensions, and M (n, 3, 3), with the coefficients of a system's defaults."""
    net = system.net
    a, b = net.bars.T
    twine = net.twines[0]
    ea = 1e9 * np.pi / 4 * twine.diameter**2
    taut = np.linalg.norm(x[b] - x[a], axis=1) > net.rest_length

    def pull(y):
        d = y[b] - y[a]
        length = np.sqrt((d * d).sum(axis=1))
        force = np.where(taut, ea * (length / net.rest_length - 1.0), 0.0)[:, None] * d / length[:, None]
        out = np.zeros_like(y)
        np.add.at(out, a, force)
        np.add.at(out, b, -force)
        return out.ravel()

    columns = []
    for i in range(x.size):
        step = np.zeros(x.size, dtype=complex)
        step[i] = 1e-30j
        columns.append(-pull(x + step.reshape(x.shape)).imag / 1e-30)
    volume = np.pi / 4 * twine.diameter**2 * net.rest_length
    knot = np.pi / 6 * net.knot_diameter**3
    mass = (net.knot_density + 500.0)[:, None, None] * knot[:, None, None] * np.eye(3)
    t = (x[b] - x[a]) / np.linalg.norm(x[b] - x[a], axis=1)[:, None]
    across = np.eye(3) - t[:, :, None] * t[:, None, :]
    share = 0.5 * volume[:, None, None] * (twine.density * np.eye(3) + 1000.0 * across)
    np.add.at(mass, a, share)
    np.add.at(mass, b, share)
    return np.column_stack(columns), mass


def test_modes_solve_the_equation_and_are_orthogonal(panel, method):
    """K v = omega^2 M v on the free knots, V M V diagonal, held knots still, the largest motion 1."""
    system, x = panel
    found = fyke.modes(system, x, count=10)
    stiffness, mass = own_matrices(system, x)
    assert np.abs(stiffness - stiffness.T).max() < 1e-12 * np.abs(stiffness).max()
    inertia = np.einsum("npq,knq->knp", mass, found.shape)
    left = found.shape.reshape(10, -1) @ stiffness
    right = (found.frequency**2)[:, None, None] * inertia
    free = ~system.net.fixed
    error = np.linalg.norm((left.reshape(right.shape) - right)[:, free], axis=(1, 2))
    assert np.all(error < 1e-7 * np.linalg.norm(right[:, free], axis=(1, 2)))
    gram = np.einsum("knp,lnp->kl", found.shape, inertia)
    size = np.sqrt(np.diag(gram))
    assert gram / np.outer(size, size) == pytest.approx(np.eye(10), abs=1e-8)
    assert np.all(found.shape[:, system.net.fixed] == 0.0)
    assert np.linalg.norm(found.shape, axis=2).max(axis=1) == pytest.approx(1.0, abs=1e-14)
    assert np.all(np.diff(found.frequency) >= 0.0)
    # No mode is missed: the modes of the whole matrices, solved by another routine.
    where = np.flatnonzero(np.repeat(free, 3))
    whole = np.zeros((x.size, x.size))
    for i, block in enumerate(mass):
        whole[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = block
    square = np.linalg.eigvals(
        np.linalg.solve(stiffness[np.ix_(where, where)], whole[np.ix_(where, where)])
    ).real
    assert found.frequency == pytest.approx(1.0 / np.sqrt(np.sort(square)[::-1][:10]), rel=1e-7)


def test_turning_the_net_turns_the_shapes_and_keeps_the_periods(panel):
    system, x = panel
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    first, again = fyke.modes(system, x), fyke.modes(system, x @ turn.T + [3.0, -2.0, 5.0])
    assert again.frequency == pytest.approx(first.frequency, rel=1e-8)
    stands_alone = [4, 5]
    for k in stands_alone:
        overlap = (again.shape[k] * (first.shape[k] @ turn.T)).sum() / (first.shape[k] ** 2).sum()
        assert abs(overlap) == pytest.approx(1.0, abs=1e-6)


def test_mirror_and_quarter_turn_give_pairs_of_modes():
    """Without gravity the square panel looks the same after a quarter turn, and so does the span of its pairs."""
    system, x = panel_at_rest(mesh="square", gravity=0.0)
    found = fyke.modes(system, x)
    single, pair = found.frequency[0], found.frequency[1:3]
    assert pair[1] == pytest.approx(pair[0], rel=1e-7)
    assert single < 0.99 * pair[0]
    assert pair[1] < 0.99 * found.frequency[3]
    quarter = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    centre = system.net.positions.mean(axis=0)
    turned = (system.net.positions - centre) @ quarter.T + centre
    onto = [int(np.argmin(np.linalg.norm(system.net.positions - p, axis=1))) for p in turned]
    _, mass = own_matrices(system, x)
    span = found.shape[1:3]
    inertia = np.einsum("npq,knq->knp", mass, span)
    gram = np.einsum("knp,lnp->kl", span, inertia)
    for shape in span:
        image = np.empty_like(shape)
        image[onto] = shape @ quarter.T
        part = np.linalg.solve(gram, np.einsum("np,knp->k", image, inertia))
        assert image == pytest.approx(np.einsum("k,knp->np", part, span), abs=1e-5)
        assert abs(part @ gram @ part) > 0.5 * gram[0, 0]


@pytest.mark.parametrize("count", [1, 4, 9])
def test_no_copy_of_a_frequency_is_missed(method, count):
    """Forty equal strings side by side: each of their modes is there eighty times."""
    bars = 4
    one = string(bars, 0.4, 5.0, 1000.0, 0.02)
    many = together([replace(one, positions=one.positions + 0.1 * i * ACROSS) for i in range(40)])
    found = fyke.modes(dry(many), many.positions, count=count)
    slowest = 2 * np.sqrt(5.0 / 0.1 / 0.02) * np.sin(np.pi / 2 / bars)
    assert found.frequency == pytest.approx(np.full(count, slowest), rel=1e-9)


def test_lanczos_finds_what_the_dense_method_finds(monkeypatch):
    """The slowest modes of this panel come in clusters of four, which single Lanczos runs see in part."""
    system, x = panel_at_rest(12, gravity=0.0)
    monkeypatch.setattr(fyke.solve.modes, "DENSE", 10**6)
    every = fyke.modes(system, x, count=12).frequency
    monkeypatch.setattr(fyke.solve.modes, "DENSE", 0)
    for count in (1, 4, 9, 10, 11):
        assert fyke.modes(system, x, count=count).frequency == pytest.approx(every[:count], rel=1e-8)
    again = fyke.modes(system, x, count=11), fyke.modes(system, x, count=11)
    assert np.array_equal(again[0].frequency, again[1].frequency)


def test_frequency_is_that_of_the_motion():
    """Let go in a shape, an undamped net in water swings with the mode's period."""
    twine = fyke.Twine("soft", 1140.0, 2e-3, fyke.LinearLaw(3e6))
    net = fyke.panel(twine, mesh="diamond", meshes=(4, 4), bar_length=0.03, size=(0.15, 0.15))
    net = replace(net, load=np.tile([0.02, 0.0, 0.0], (net.knot_count, 1)))
    undamped = fyke.Coefficients(bars=fyke.ConstantBar(0.0, 0.0), knots=fyke.ConstantKnot(0.0))
    system = fyke.make_system(net, coefficients=undamped)
    rest = fyke.solve_static(system, tolerance=1e-11).position[-1]
    found = fyke.modes(system, rest, count=3)
    for frequency, shape in zip(found.frequency, found.shape, strict=True):
        start = fyke.State(0.0, rest + 1e-6 * shape, np.zeros_like(rest))
        quarters = 4.5
        run = fyke.simulate(
            system,
            duration=quarters * np.pi / frequency,
            every=quarters * np.pi / frequency / 60,
            start=start,
            stepper=fyke.Verner(rtol=1e-9, atol=1e-13),
        )
        # The other modes are across M from the shape, and next to nothing anyway.
        swing = np.einsum("knp,np->k", run.position - rest, shape)
        crossed = np.flatnonzero(swing[:-1] * swing[1:] < 0.0)
        before, after = swing[crossed], swing[crossed + 1]
        times = run.time[crossed] + before / (before - after) * np.diff(run.time)[crossed]
        halves = np.diff(times)
        assert len(halves) >= 3
        assert np.pi / halves.mean() == pytest.approx(frequency, rel=1e-3)


def test_loose_knots_are_named_and_left_out():
    """A string with a slack tail, and a slack string beside it: the tail and the other string have no period."""
    taut = string(4, 0.4, 5.0, 1000.0, 0.02)
    tail = fyke.line(taut.twines[0], [[0.2, 0.3, 0.0], [0.2, 0.35, 0.0], [0.2, 0.4, 0.0]], 1.0, fixed=())
    slack = fyke.line(taut.twines[0], np.outer(np.arange(3), [0.1, 0.0, 0.0]) + ACROSS, 1.0)
    net = together([taut, balls(tail, 0.02), balls(slack, 0.02)])
    found = fyke.modes(dry(net), net.positions, count=100)
    assert found.loose.tolist() == [5, 6, 7, 9]
    assert found.frequency == pytest.approx(
        fyke.modes(dry(taut), taut.positions, count=9).frequency, rel=1e-9
    )
    assert found.shape.shape == (9, 11, 3)
    assert np.all(found.shape[:, 5:] == 0.0)


def test_net_without_tension_has_no_modes():
    """As built, every bar as long as unloaded but for rounding: nothing pulls anything back."""
    net = fyke.panel(NYLON, mesh="diamond", meshes=(5, 4), bar_length=0.03, size=(0.18, 0.192))
    system = fyke.make_system(net)
    found = fyke.modes(system, net.positions)
    assert found.frequency.shape == (0,) == found.period.shape
    assert found.shape.shape == (0, net.knot_count, 3)
    assert np.array_equal(found.loose, np.flatnonzero(~net.fixed))


@pytest.mark.parametrize("tension", [1e-6, 1e-9])
def test_hardly_taut_string_has_its_frequency(method, tension):
    """Up to 1e12 times as stiff along as across: right to what rounding leaves."""
    net = string(10, 1.0, tension, 1e4, 1e-3)
    found = fyke.modes(dry(net), net.positions, count=2)
    exact = 2 * np.sqrt(tension / 0.1 / 1e-3) * np.sin(np.pi / 20)
    assert found.frequency == pytest.approx([exact, exact], rel=2e-3 if tension < 1e-6 else 1e-5)


def test_frequency_below_rounding_is_zero(method):
    """A long string in a skew direction, 3e12 times as stiff along as across, whose slowest mode rounding hides."""
    tension, spring, spacing, bars = 1e-8, 1e6, 0.03, 400
    skew = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    rest = spacing - tension / spring
    points = np.outer(np.arange(bars + 1.0) - bars / 2, spacing * skew)
    net = balls(fyke.line(thread(spring * rest, density=0.0), points, rest), 5e-4)
    found = fyke.modes(dry(net), net.positions, count=2)
    assert found.frequency.tolist() == [0.0, 0.0]
    assert found.period.tolist() == [np.inf, np.inf]
    assert np.isfinite(found.shape).all()


def test_wrong_input_is_refused_in_words(panel):
    system, x = panel
    with pytest.raises(ValueError, match="count must be at least 1"):
        fyke.modes(system, x, count=0)
    with pytest.raises(ValueError, match=r"needs \(145, 3\)"):
        fyke.modes(system, x[:-1])
    broken = x.copy()
    broken[20, 1] = np.nan
    with pytest.raises(ValueError, match=f"knot {system.net.labels[20]} is not finite"):
        fyke.modes(system, broken)
    light = fyke.line(thread(10.0, density=0.0), np.outer(np.arange(3), [1.1, 0.0, 0.0]), 1.0)
    with pytest.raises(ValueError, match="knot 1 is free and has no mass"):
        fyke.modes(dry(light), light.positions)
