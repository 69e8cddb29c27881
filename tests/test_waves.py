"""Waves against computed amplitudes, the equations of the free surface, numpy's own sums, spectra and their moments."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.signal import welch

from fyke.water.waves import (
    Spreading,
    airy,
    breaking_height,
    default_gamma,
    irregular,
    jonswap,
    keulegan_carpenter,
    pierson_moskowitz,
    stokes2,
    ursell_number,
    wavenumber,
)
from fyke.water.waves.kernel import cosine_and_sine, power_of_two

G = 9.81
SPREAD = Spreading(exponent=10.0, directions=15)


def at(sea, x, time=0.0):
    """Velocity, acceleration (3,) and elevation at one point."""
    moved = sea.motion(np.array([x], dtype=float), time)
    return moved.velocity[0], moved.acceleration[0], moved.elevation[0]


def slope(f, x, h=1e-3):
    """Derivative of f by differences of fourth order."""
    return (8.0 * (f(x + h) - f(x - h)) - f(x + 2.0 * h) + f(x - 2.0 * h)) / (12.0 * h)


def submerged(count=40, low=-18.0, high=-6.0, seed=3):
    random = np.random.default_rng(seed)
    return np.column_stack([random.uniform(-50.0, 50.0, (count, 2)), random.uniform(low, high, count)])


# Dispersion


def test_wavenumber_solves_the_dispersion_relation_at_any_depth():
    depth = 12.0
    omega = np.geomspace(1e-4, 300.0, 2000)  # kh from 1e-4 to 1e5
    k = wavenumber(omega, depth, G)
    assert G * k * np.tanh(k * depth) == pytest.approx(omega**2, rel=4e-15)
    assert k[0] * depth < 2e-4 and k[-1] * depth > 1e5
    assert wavenumber(omega, math.inf, G) == pytest.approx(omega**2 / G, rel=1e-15)
    assert 2.0 * math.pi / wavenumber(2.0 * math.pi / 10.0, 60.0, G) == pytest.approx(153.826, abs=5e-4)


# The kernel


def test_sines_and_powers_are_exact_to_thirteen_digits():
    random = np.random.default_rng(1)
    turns = np.concatenate([random.uniform(-3.0, 3.0, 20_000), np.arange(-8, 9) / 8.0, [1e-9]])
    fine = 2.0 * np.longdouble("3.14159265358979323846264338327950288") * turns.astype(np.longdouble)
    found = np.array([cosine_and_sine(one) for one in turns])
    assert found[:, 0] == pytest.approx(np.cos(fine).astype(float), abs=1e-15)
    assert found[:, 1] == pytest.approx(np.sin(fine).astype(float), abs=1e-15)
    assert cosine_and_sine(1e-9)[1] == pytest.approx(2e-9 * math.pi, rel=1e-13)
    powers = random.uniform(-890.0, 60.0, 20_000)
    assert [power_of_two(y) for y in powers] == pytest.approx(np.exp2(powers), rel=1e-13)
    assert 0.0 < power_of_two(-1e300) < 1e-270


def plain_motion(sea, points, time, stretched):
    """The sum of the harmonics with numpy's cosh and sinh, as the formulas are written."""
    h, parts = sea.depth, sea.harmonics
    k = np.hypot(parts.turns_x, parts.turns_y) * 2.0 * np.pi
    omega = 2.0 * np.pi * parts.frequency
    beta = np.arctan2(parts.turns_y, parts.turns_x)
    speed = parts.velocity[2] * -np.expm1(-2.0 * k * h)
    x, y, z = points.T[:, :, None]
    theta = k * (x * np.cos(beta) + y * np.sin(beta)) - omega * time + 2.0 * np.pi * parts.phase
    eta = (parts.amplitude * np.cos(theta)).sum(axis=1)
    if stretched:
        z = (z - eta[:, None]) * h / (h + eta[:, None])
    c, s = np.cosh(k * (z + h)) / np.sinh(k * h), np.sinh(k * (z + h)) / np.sinh(k * h)
    across, down = speed * c * np.cos(theta), speed * s * np.sin(theta)
    velocity = np.stack([across * np.cos(beta), across * np.sin(beta), down], axis=2).sum(axis=1)
    rate = omega * speed * c * np.sin(theta)
    rates = np.stack([rate * np.cos(beta), rate * np.sin(beta), -omega * speed * s * np.cos(theta)], axis=2)
    return velocity, rates.sum(axis=1), eta


@pytest.mark.parametrize("stretching", ["wheeler", "none"])
@pytest.mark.parametrize("count", [1, 7, 200])
def test_a_sea_is_the_sum_of_its_components(stretching, count):
    sea = irregular(
        2.0,
        7.0,
        gamma=3.3,
        components=count,
        spreading=SPREAD,
        direction=0.6,
        depth=20.0,
        stretching=stretching,
    )
    points, time = submerged(low=-20.0), 1234.5
    moved = sea.motion(points, time)
    velocity, acceleration, eta = plain_motion(sea, points, time, stretching == "wheeler")
    assert moved.velocity == pytest.approx(velocity, abs=1e-12)
    assert moved.acceleration == pytest.approx(acceleration, abs=1e-12)
    assert moved.elevation == pytest.approx(eta, abs=1e-12)
    assert sea.elevation(points, time) == pytest.approx(eta, abs=1e-12)


def test_a_point_moves_the_same_alone_and_among_others():
    sea = irregular(2.0, 7.0, gamma=3.3, depth=20.0, spreading=SPREAD)
    points = submerged()
    alone = [at(sea, point, 5.0) for point in points]
    together = sea.motion(points, 5.0)
    assert np.array_equal(together.velocity, [one[0] for one in alone])
    assert np.array_equal(together.acceleration, [one[1] for one in alone])


def test_points_that_are_no_numbers_give_none():
    sea = airy(2.0, 8.0, depth=20.0)
    for axis in range(3):
        point = np.array([0.0, 0.0, -1.0])
        point[axis] = np.nan
        assert np.isnan(at(sea, point)[0]).any()


@pytest.mark.parametrize("make", [partial(airy, stretching="none"), stokes2])
def test_very_deep_water_does_not_overflow(make):
    deep, infinite = make(0.1, 1.0, depth=2500.0), make(0.1, 1.0)
    assert wavenumber(2.0 * math.pi, 2500.0, G) * 2500.0 > 1e4
    points = np.array([[0.0, 0.0, z] for z in (0.0, -0.1, -1.0, -10.0, -100.0, -2500.0)])
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        a, b = deep.motion(points, 0.01), infinite.motion(points, 0.01)
    assert a.velocity == pytest.approx(b.velocity, abs=1e-14)
    assert np.isfinite(a.acceleration).all() and abs(a.velocity[-1]).max() < 1e-100


def test_irregular_sea_of_very_deep_water_does_not_overflow():
    sea = irregular(0.02, 1.0, gamma=1.0, depth=9000.0)
    moved = sea.motion(submerged(low=-9000.0, high=0.0), 3.0)
    assert np.isfinite(moved.velocity).all() and np.isfinite(moved.acceleration).all()


# Equations of motion


SEAS = {
    "airy": lambda **more: airy(2.0, 8.0, direction=0.7, phase=0.3, depth=20.0, **more),
    "airy deep": lambda **more: airy(2.0, 8.0, direction=-2.0, **more),
    "irregular": lambda **more: irregular(2.0, 8.0, gamma=3.3, depth=20.0, spreading=SPREAD, **more),
}
UNSTRETCHED = {name: make(stretching="none") for name, make in SEAS.items()} | {
    "stokes2": stokes2(2.0, 8.0, direction=0.7, phase=0.3, depth=20.0)
}


@pytest.mark.parametrize("name", UNSTRETCHED)
def test_acceleration_is_the_rate_of_the_velocity(name):
    sea, points = UNSTRETCHED[name], submerged()
    rate = slope(lambda time: sea.motion(points, time).velocity, 2.2)
    assert sea.motion(points, 2.2).acceleration == pytest.approx(rate, abs=1e-9)


@pytest.mark.parametrize("name", [*SEAS, "stokes2"])
@pytest.mark.parametrize("time", [0.4, 4.0, 9.0])
def test_acceleration_is_the_rate_of_the_velocity_while_the_sea_grows(name, time):
    growing = {key: make(stretching="none", ramp=10.0) for key, make in SEAS.items()}
    growing["stokes2"] = stokes2(2.0, 8.0, depth=20.0, ramp=10.0)
    sea, points = growing[name], submerged()
    rate = slope(lambda t: sea.motion(points, t).velocity, time)
    assert sea.motion(points, time).acceleration == pytest.approx(rate, abs=1e-9)


@pytest.mark.parametrize("name", SEAS)
def test_under_wheeler_acceleration_leaves_out_the_rate_of_the_stretching(name):
    sea, still = SEAS[name](stretching="wheeler"), UNSTRETCHED[name]
    h, time, points = sea.depth, 2.2, submerged()
    x, y, z = points.T

    def unstretched(t):
        eta = sea.elevation(points, t)
        return (z - eta) / (1.0 + eta / h)

    def at_depth(depth, t):
        return still.motion(np.column_stack([x, y, depth]), t).velocity

    moved = sea.motion(points, time)
    assert moved.velocity == pytest.approx(at_depth(unstretched(time), time), abs=1e-13)
    fixed = slope(lambda t: at_depth(unstretched(time), t), time)
    assert moved.acceleration == pytest.approx(fixed, abs=1e-9)
    shear = slope(lambda d: at_depth(unstretched(time) + d, time), 0.0)
    left_out = shear * slope(unstretched, time)[:, None]
    whole = slope(lambda t: sea.motion(points, t).velocity, time)
    assert whole == pytest.approx(moved.acceleration + left_out, abs=1e-9)
    assert abs(left_out).max() > 1e-3


@pytest.mark.parametrize("name", UNSTRETCHED)
def test_flow_has_neither_divergence_nor_rotation(name):
    sea, points = UNSTRETCHED[name], submerged()
    gradient = np.stack(
        [slope(lambda d, e=e: sea.motion(points + d * e, 1.7).velocity, 0.0, 0.02) for e in np.eye(3)], axis=2
    )
    assert abs(gradient).max() > 1e-2
    assert np.trace(gradient, axis1=1, axis2=2) == pytest.approx(0.0, abs=1e-9)
    assert gradient == pytest.approx(np.swapaxes(gradient, 1, 2), abs=1e-9)


@pytest.mark.parametrize("name", [name for name in UNSTRETCHED if "deep" not in name])
def test_nothing_flows_through_the_bed(name):
    points = submerged(low=-20.0, high=-20.0)
    for sea in (UNSTRETCHED[name], *([SEAS[name]()] if name in SEAS else [])):
        on_bed, below = sea.motion(points, 3.0), sea.motion(points - [0.0, 0.0, 7.0], 3.0)
        assert on_bed.velocity[:, 2] == pytest.approx(0.0, abs=1e-15)
        assert abs(on_bed.velocity[:, 0]).max() > 0.1
        assert np.array_equal(on_bed.velocity, below.velocity)


def surface_residuals(sea, period, depth):
    """Largest residuals at the surface: of w = eta_t + u eta_x (m/s), and of the momentum along the surface (m/s2)."""
    c = 2.0 * math.pi / period / float(wavenumber(2.0 * math.pi / period, depth, G))
    times = np.linspace(0.0, period, 48, endpoint=False)
    kinematic, dynamic = [], []
    for time in times:
        origin = np.zeros((1, 3))
        eta_t = slope(lambda t: sea.elevation(np.zeros((1, 3)), t)[0], time, 1e-3 * period)
        eta_x = -eta_t / c
        origin[0, 2] = sea.elevation(origin, time)[0] - 1e-12
        (u, _, w), (u_t, _, w_t), _ = at(sea, origin[0], time)
        u_x, w_x = -u_t / c, -w_t / c  # a steady wave
        u_z, w_z = w_x, -u_x  # without rotation and divergence
        kinematic.append(abs(w - eta_t - u * eta_x))
        along = u_t + u * u_x + w * u_z
        up = w_t + u * w_x + w * w_z + G
        dynamic.append(abs(along + eta_x * up))
    return np.array([max(kinematic), max(dynamic)])


@pytest.mark.parametrize("depth", [4.0, 20.0, math.inf])
def test_residuals_of_stokes_at_the_surface_fall_eight_times_when_the_height_is_halved(depth):
    residuals = [
        surface_residuals(stokes2(height, 6.0, depth=depth), 6.0, depth) for height in (0.2, 0.1, 0.05)
    ]
    assert residuals[0] / residuals[1] == pytest.approx(8.0, rel=0.1)
    assert residuals[1] / residuals[2] == pytest.approx(8.0, rel=0.05)


def test_stokes_waves_have_the_published_second_harmonic():
    height, period, depth = 2.0, 8.0, 12.0
    k = float(wavenumber(2.0 * math.pi / period, depth, G))
    length, kh = 2.0 * math.pi / k, k * depth
    second = (
        math.pi
        * height**2
        / (8.0 * length)
        * math.cosh(kh)
        * (2.0 + math.cosh(2.0 * kh))
        / math.sinh(kh) ** 3
    )
    u2 = 0.75 * (math.pi * height / period) * (math.pi * height / length) / math.sinh(kh) ** 4
    sea = stokes2(height, period, depth=depth)
    crest, trough = (at(sea, [0.0, 0.0, -3.0], time) for time in (0.0, period / 2.0))
    assert 0.5 * (crest[2] + trough[2]) == pytest.approx(second, rel=1e-13)
    expected = u2 * math.cosh(2.0 * k * (depth - 3.0))
    assert 0.5 * (crest[0][0] + trough[0][0]) == pytest.approx(expected, rel=1e-12)


# Surface, direction, ramp


@pytest.mark.parametrize("phase", [0.0, 0.4, math.pi])
def test_wheeler_at_the_surface_is_airy_at_still_water(phase):
    crest = airy(2.0, 8.0, phase=phase, depth=20.0)
    eta = crest.elevation(np.zeros((1, 3)), 0.0)[0]
    assert eta == pytest.approx(math.cos(phase))
    k, omega = float(wavenumber(math.pi / 4.0, 20.0, G)), math.pi / 4.0
    velocity, acceleration, _ = at(crest, [0.0, 0.0, eta - 1e-13])
    across = omega / math.tanh(k * 20.0)
    assert velocity[[0, 2]] == pytest.approx([across * math.cos(phase), omega * math.sin(phase)], abs=1e-12)
    rate = [omega * across * math.sin(phase), -(omega**2) * math.cos(phase)]
    assert acceleration[[0, 2]] == pytest.approx(rate, abs=1e-12)


def test_there_is_no_water_above_the_surface():
    for sea in (airy(2.0, 8.0), airy(2.0, 8.0, stretching="none"), stokes2(2.0, 8.0)):
        eta = sea.elevation(np.zeros((1, 3)), 0.3)[0]
        velocity, acceleration, told = at(sea, [0.0, 0.0, eta + 1e-9], 0.3)
        assert not velocity.any() and not acceleration.any() and told == pytest.approx(eta)
        assert at(sea, [0.0, 0.0, eta - 1e-9], 0.3)[0].any()


def test_without_stretching_the_motion_of_still_water_is_held_above_it():
    sea = airy(2.0, 8.0, stretching="none")
    still, above = at(sea, [0.0, 0.0, 0.0]), at(sea, [0.0, 0.0, 0.9])
    assert np.array_equal(still[0], above[0]) and np.array_equal(still[1], above[1])
    assert at(sea, [0.0, 0.0, -0.9])[0][0] < still[0][0]


@pytest.mark.parametrize("depth", [0.8, 1.0])
def test_a_bed_that_falls_dry_has_no_motion(depth):
    sea = replace(airy(2.0, 8.0, phase=math.pi, depth=20.0), depth=depth)  # a trough as deep as the water
    moved = sea.motion(np.array([[0.0, 0.0, z] for z in (-3.0, -1.0, -0.8, -0.4, 0.5)]), 0.0)
    assert not moved.velocity.any() and not moved.acceleration.any()
    assert moved.elevation == pytest.approx(-1.0)


@pytest.mark.parametrize("name", ["airy", "irregular"])
def test_waves_turned_with_the_axes_are_the_same(name):
    angle = 0.9
    turn = np.array(
        [[math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0, 0, 1.0]]
    )
    make = {
        "airy": lambda beta: airy(2.0, 8.0, direction=beta, depth=20.0),
        "irregular": lambda beta: irregular(
            2.0, 8.0, gamma=2.0, spreading=SPREAD, direction=beta, depth=20.0
        ),
    }[name]
    points = submerged()
    a, b = make(0.2).motion(points, 3.0), make(0.2 + angle).motion(points @ turn.T, 3.0)
    assert b.velocity == pytest.approx(a.velocity @ turn.T, abs=1e-12)
    assert b.acceleration == pytest.approx(a.acceleration @ turn.T, abs=1e-12)
    assert make(0.2).direction == pytest.approx((math.cos(0.2), math.sin(0.2), 0.0))


def test_waves_go_where_their_direction_points():
    sea = airy(2.0, 8.0, direction=math.pi / 2.0, depth=20.0)
    c = float(2.0 * math.pi / 8.0 / wavenumber(2.0 * math.pi / 8.0, 20.0, G))
    for time in (1.0, 5.0):
        assert at(sea, [7.0, c * time, -2.0], time)[2] == pytest.approx(1.0)
    assert at(sea, [0.0, 0.0, -2.0])[0][1] > 0.5  # the water goes with the crest


def test_the_sea_grows_from_rest():
    grown, growing = airy(2.0, 8.0, depth=20.0), airy(2.0, 8.0, depth=20.0, ramp=10.0)
    points = submerged()
    start = growing.motion(points, 0.0)
    assert not start.velocity.any() and not start.acceleration.any() and not start.elevation.any()
    assert growing.elevation(points, 5.0) == pytest.approx(0.5 * grown.elevation(points, 5.0), rel=1e-14)
    for time in (10.0, 25.0):
        assert np.array_equal(
            growing.motion(points, time).acceleration, grown.motion(points, time).acceleration
        )


# Irregular seas


@pytest.mark.parametrize(
    ("gamma", "share"), [(1.0, 1.000), (2.0, 0.999), (3.3, 1.001), (5.0, 1.000), (7.0, 0.991)]
)
def test_spectra_hold_the_significant_height(gamma, share):
    omega = np.geomspace(0.1, 40.0, 200_001)
    m0 = np.trapezoid(jonswap(omega, 2.0, 8.0, gamma), omega)
    assert 4.0 * math.sqrt(m0) / 2.0 == pytest.approx(share, abs=6e-4)
    assert omega[jonswap(omega, 2.0, 8.0, gamma).argmax()] == pytest.approx(2.0 * math.pi / 8.0, rel=1e-3)


def test_pierson_moskowitz_is_jonswap_without_a_peak_factor():
    omega = np.linspace(0.3, 5.0, 50)
    assert jonswap(omega, 3.0, 9.0, 1.0) == pytest.approx(pierson_moskowitz(omega, 3.0, 9.0), rel=1e-15)
    # At the peak S = (5/16) Hs^2 / w_p e^-1.25, and JONSWAP's is (1 - 0.287 ln gamma) gamma times that.
    peak = 2.0 * math.pi / 9.0
    assert pierson_moskowitz(peak, 3.0, 9.0) == pytest.approx(
        0.3125 * 9.0 / peak * math.exp(-1.25), rel=1e-14
    )
    assert jonswap(peak, 3.0, 9.0, 3.3) / pierson_moskowitz(peak, 3.0, 9.0) == pytest.approx(
        2.16923, rel=1e-5
    )


@pytest.mark.parametrize(
    ("age", "gamma"), [(3.0, 5.0), (3.6, 5.0), (4.0, math.exp(1.15)), (5.0, 1.0), (9.0, 1.0)]
)
def test_default_peak_factor(age, gamma):
    assert default_gamma(4.0, 2.0 * age) == pytest.approx(gamma, rel=1e-12)


@pytest.mark.parametrize("gamma", [1.0, 3.3, 7.0])
def test_components_have_the_moments_of_the_spectrum(gamma):
    parts = irregular(2.0, 8.0, gamma=gamma).harmonics
    omega = np.geomspace(0.3, 30.0, 100_001) * 2.0 * math.pi / 8.0
    spectrum = jonswap(omega, 2.0, 8.0, gamma)
    m2 = np.trapezoid(spectrum * omega**2, omega) / np.trapezoid(spectrum, omega)
    energy = 0.5 * parts.amplitude**2
    assert 4.0 * math.sqrt(energy.sum()) == pytest.approx(2.0, rel=1e-13)
    found = (energy * (2.0 * np.pi * parts.frequency) ** 2).sum() / energy.sum()
    assert found == pytest.approx(m2, rel=1e-6)


def test_the_same_seed_gives_the_same_sea():
    points = submerged()

    def motion(seed):
        return irregular(2.0, 8.0, gamma=3.3, seed=seed, spreading=SPREAD).motion(points, 3.0).velocity

    assert np.array_equal(motion(5), motion(5))
    assert abs(motion(5) - motion(6)).max() > 0.1


def test_directions_are_dealt_to_neighbouring_frequencies_in_random_order():
    def hands(seed):
        parts = irregular(2.0, 8.0, gamma=3.3, seed=seed, spreading=SPREAD, components=150).harmonics
        return np.arctan2(parts.turns_y, parts.turns_x).reshape(10, 15)

    dealt, all_of_them = hands(1), SPREAD.angles(15)
    assert np.sort(dealt, axis=1) == pytest.approx(np.tile(all_of_them, (10, 1)), abs=1e-12)
    assert len({tuple(np.argsort(hand)) for hand in dealt}) == 10
    assert np.array_equal(dealt, hands(1)) and not np.array_equal(dealt, hands(2))


def test_the_record_does_not_repeat_within_three_hours():
    frequency = irregular(2.0, 10.0, gamma=3.3).harmonics.frequency
    later = np.arange(200.0, 10_800.0)
    likeness = np.abs(np.cos(2.0 * np.pi * np.outer(later, frequency)).mean(axis=1))
    assert likeness.max() < 0.25  # equal steps of frequency come back to 1


def record(sea, times):
    points = np.zeros((1, 3))
    return np.array([sea.elevation(points, time)[0] for time in times])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_record_has_its_significant_height_and_peak_period(seed):
    height, period, step = 2.0, 8.0, 0.8
    eta = record(
        irregular(height, period, gamma=3.3, seed=seed, depth=40.0), np.arange(0.0, 6.0 * 3600.0, step)
    )
    assert 4.0 * eta.std() == pytest.approx(height, rel=0.02)
    # Young's estimate of the peak, the mean frequency weighted with S^4: of JONSWAP itself its period is 0.9 % short.
    f, spectrum = welch(eta, 1.0 / step, nperseg=640)
    found = (spectrum**4).sum() / (f * spectrum**4).sum()
    assert found == pytest.approx(period, rel=0.02)


@pytest.mark.parametrize("direction", [0.0, 2.5])
def test_a_spread_sea_has_its_mean_direction_and_spreading(direction):
    s = 10.0
    sea = irregular(2.0, 8.0, gamma=3.3, spreading=Spreading(s, 15), direction=direction, components=200)
    parts = sea.harmonics
    turned = np.exp(1j * (np.arctan2(parts.turns_y, parts.turns_x) - direction))
    assert np.angle(turned.mean()) == pytest.approx(0.0, abs=1e-12)
    assert abs(turned.mean()) == pytest.approx(s / (s + 1.0), rel=1e-3)
    assert abs((turned**2).mean()) == pytest.approx(s * (s - 1.0) / ((s + 1.0) * (s + 2.0)), rel=0.02)
    assert len(np.unique(np.round(np.angle(turned), 9))) <= 15 + 5


def test_a_spread_sea_moves_the_water_as_its_moments_say():
    s, points = 10.0, np.array([[0.0, 0.0, -3.0]])
    sea = irregular(2.0, 8.0, gamma=3.3, spreading=Spreading(s, 15), direction=0.5)
    moved = [sea.motion(points, time) for time in np.arange(0.0, 4.0 * 3600.0, 1.3)]
    eta = np.array([one.elevation[0] for one in moved])
    u, v, _ = np.array([one.velocity[0] for one in moved]).T
    assert math.atan2((eta * v).mean(), (eta * u).mean()) == pytest.approx(0.5, abs=0.02)
    along, across = u * math.cos(0.5) + v * math.sin(0.5), v * math.cos(0.5) - u * math.sin(0.5)
    second = ((along**2).mean() - (across**2).mean()) / ((along**2).mean() + (across**2).mean())
    assert second == pytest.approx(s * (s - 1.0) / ((s + 1.0) * (s + 2.0)), rel=0.05)


def test_a_sea_of_one_component_is_an_airy_wave():
    sea = irregular(1.0, 8.0, gamma=3.3, components=1, direction=0.4, depth=20.0)
    parts = sea.harmonics
    same = airy(
        2.0 * parts.amplitude[0],
        1.0 / parts.frequency[0],
        direction=0.4,
        phase=2.0 * math.pi * parts.phase[0],
        depth=20.0,
    )
    points = submerged(low=-20.0, high=2.0)
    a, b = sea.motion(points, 3.3), same.motion(points, 3.3)
    assert a.velocity == pytest.approx(b.velocity, abs=1e-14)
    assert a.acceleration == pytest.approx(b.acceleration, abs=1e-14)


# Limits


def test_waves_that_break_are_refused_with_the_largest_height():
    # Deep water: 0.142 g T^2 / (2 pi) = 14.19 m at 8 s.
    assert breaking_height(8.0, math.inf, G) == pytest.approx(0.142 * G * 64.0 / (2.0 * math.pi), rel=1e-14)
    assert breaking_height(60.0, 2.0, G) == pytest.approx(0.142 * 2.0 * math.pi * 2.0, rel=1e-3)
    for make in (airy, stokes2, lambda h, t, **more: irregular(h, t, gamma=1.0, **more)):
        with pytest.raises(ValueError, match=r"0 and 14\.19 m.*H/L = 0\.142"):
            make(14.3, 8.0)
        make(14.1, 8.0)
        with pytest.raises(ValueError, match="between 0"):
            make(-1.0, 8.0)


@pytest.mark.parametrize(
    ("sea", "words"),
    [
        (airy(1.0, 8.0), ()),
        (airy(8.0, 8.0), ("12.6 %", "above 10 %")),
        (stokes2(2.0, 8.0), ()),
        (stokes2(1.5, 12.0, depth=3.0), ("Ursell number", "above its limit of 26")),
        (stokes2(7.0, 8.0), ("H / L is 0.0701", "0.06")),
        (irregular(2.0, 7.0, gamma=2.0), ()),
        (irregular(6.0, 7.0, gamma=1.0), ("0.0784", "0.0625")),
        (irregular(2.0, 8.0, gamma=2.0, depth=3.0), ("0.667", "0.6", "Tp / sqrt(Hs)", "5.66")),
        (irregular(3.0, 7.0, gamma=8.0), ("7 at most", "8")),
    ],
)
def test_warnings_have_the_number_and_the_limit(sea, words):
    told = " ".join(sea.warnings)
    assert all(word in told for word in words)
    assert bool(sea.warnings) == bool(words)


def test_numbers_of_waves():
    assert ursell_number(2.0, 100.0, 10.0) == pytest.approx(20.0)
    assert ursell_number(2.0, 100.0, math.inf) == 0.0
    assert keulegan_carpenter(0.8, 8.0, 2e-3) == pytest.approx(3200.0)


def test_waves_say_what_they_are():
    assert (airy(1.0, 8.0).named.kind, stokes2(1.0, 8.0).named.kind) == ("airy", "stokes2")
    sea, grown = irregular(2.0, 8.0, gamma=3.3).named, irregular(2.0, 8.0, gamma=1.0).named
    assert (sea.kind, sea.height, sea.period, sea.regular) == ("jonswap", 2.0, 8.0, False)
    assert grown.kind == "pierson-moskowitz" and "Pierson" in grown.source
