"""Currents against exact integrals, turned axes and values worked out by hand."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from fyke.water import (
    LayerCurrent,
    PowerCurrent,
    RampedCurrent,
    SeriesCurrent,
    TableCurrent,
    UniformCurrent,
)
from fyke.water.current import at_full_strength
from fyke.water.ramp import ramp

DEPTHS = [0.0, 5.0, 12.0]
VECTORS = [[0.6, 0.0, 0.0], [0.3, 0.3, 0.0], [-0.1, 0.2, 0.05]]
# Two times, 0 and 10 s, and two depths, 0 and 4 m.
SERIES = SeriesCurrent(
    [0.0, 10.0], [0.0, 4.0], [[[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [[3.0, 0.0, 1.0], [0.0, 6.0, 0.0]]]
)
EVERY = [
    UniformCurrent((0.5, 0.1, 0.0)),
    PowerCurrent((0.5, 0.1, 0.0), 20.0, 0.143),
    LayerCurrent(DEPTHS, VECTORS),
    TableCurrent(DEPTHS, VECTORS),
    SERIES,
    SeriesCurrent([0.0, 10.0], [0.0], [[[1.0, 0.0, 0.0]], [[3.0, 0.0, 1.0]]]),
    RampedCurrent(TableCurrent(DEPTHS, VECTORS), 10.0),
]


def at(*heights):
    """Points at these heights z (m), spread over x and y."""
    points = np.zeros((len(heights), 3))
    points[:, 0], points[:, 1] = np.arange(len(heights)), -7.0
    points[:, 2] = heights
    return points


@pytest.mark.parametrize("current", EVERY, ids=lambda c: type(c).__name__)
def test_shape_order_and_flags_are_those_of_the_interface(current):
    points = at(*np.linspace(1.0, -25.0, 50))
    velocity = current.velocity(points, 3.0)
    assert velocity.shape == (50, 3) and velocity.dtype == np.float64 and velocity.flags.c_contiguous
    varies = np.ptp(velocity, axis=0).max() > 0.0
    assert varies != current.uniform
    assert (np.abs(velocity - current.velocity(points, 8.0)).max() > 0.0) != current.steady
    # The answer is the caller's own: writing into it changes nothing.
    before = velocity.copy()
    velocity[:] = 9.0
    assert np.array_equal(current.velocity(points, 3.0), before)
    assert current.velocity(np.zeros((0, 3)), 3.0).shape == (0, 3)


@pytest.mark.parametrize("exponent", [0.0, 1.0 / 7.0, 0.5, 1.0, 2.0])
def test_power_law_has_its_exact_transport_and_momentum(exponent):
    """Integral over the depth of U^p is h U_0^p / (1 + p a), here by Gauss points in t = (1 + z/h)^(1/8)."""
    depth, speed = 23.0, 0.7
    node, weight = leggauss(60)
    t, w = 0.5 * (node + 1.0), 0.5 * weight
    current = PowerCurrent((speed, 0.0, 0.0), depth, exponent)
    u = current.velocity(at(*(depth * (t**8 - 1.0))), 0.0)[:, 0]
    for power in (1, 2, 3):
        integral = float(np.sum(w * 8.0 * t**7 * u**power) * depth)
        assert integral == pytest.approx(depth * speed**power / (1.0 + power * exponent), rel=1e-12)


def test_power_law_at_the_surface_above_it_and_at_the_bed():
    current = PowerCurrent((0.7, -0.2, 0.0), 20.0, 1.0 / 7.0)
    surface, above, middle, bed, below = current.velocity(at(0.0, 3.0, -10.0, -20.0, -21.0), 0.0)
    assert np.array_equal(surface, [0.7, -0.2, 0.0]) and np.array_equal(above, surface)
    assert middle == pytest.approx(np.array([0.7, -0.2, 0.0]) * 0.5 ** (1.0 / 7.0), rel=1e-14)
    assert not bed.any() and not below.any()


def test_layers_hold_from_a_depth_down_to_the_next():
    heights = (2.0, 0.0, -4.999, -5.0, -11.999, -12.0, -500.0)
    velocity = LayerCurrent(DEPTHS, VECTORS).velocity(at(*heights), 0.0)
    assert np.array_equal(velocity, np.array(VECTORS)[[0, 0, 0, 1, 1, 2, 2]])
    # A first depth below the surface: its layer reaches up.
    deep = LayerCurrent([3.0, 6.0], VECTORS[:2]).velocity(at(0.0, -2.0, -7.0), 0.0)
    assert np.array_equal(deep, np.array(VECTORS)[[0, 0, 1]])


def test_table_is_straight_between_and_held_beyond():
    heights = (2.0, 0.0, -5.0, -12.0, -30.0, -2.5, -6.75)
    velocity = TableCurrent(DEPTHS, VECTORS).velocity(at(*heights), 0.0)
    assert np.array_equal(velocity[:5], np.array(VECTORS)[[0, 0, 1, 2, 2]])
    # 2.5 m is half way to 5 m, 6.75 m a quarter of the way from 5 m to 12 m.
    assert velocity[5] == pytest.approx([0.45, 0.15, 0.0], abs=1e-15)
    assert velocity[6] == pytest.approx([0.2, 0.275, 0.0125], abs=1e-15)


def test_table_and_layers_of_a_linear_shear_have_its_transport():
    """Straight shear: a table of two points is exact; layers at the middles are exact in the mean."""
    edges = np.linspace(0.0, 10.0, 21)
    middles = 0.5 * (edges[1:] + edges[:-1])
    shear = np.outer(1.0 - 0.08 * middles, [1.0, 0.0, 0.0])
    fine = at(*-(np.arange(4000) + 0.5) / 400.0)
    two = TableCurrent([0.0, 10.0], [[1.0, 0.0, 0.0], [0.2, 0.0, 0.0]]).velocity(fine, 0.0)
    assert two[:, 0] == pytest.approx(1.0 + 0.08 * fine[:, 2], abs=1e-15)
    layers = LayerCurrent(edges[:-1], shear).velocity(fine, 0.0)
    assert layers[:, 0].mean() == pytest.approx(0.6, abs=1e-12)


@pytest.mark.parametrize("kind", [LayerCurrent, TableCurrent])
def test_turned_table_gives_turned_velocities(kind):
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    points = at(*np.linspace(1.0, -20.0, 40))
    plain = kind(DEPTHS, VECTORS).velocity(points, 0.0)
    turned = kind(DEPTHS, np.array(VECTORS) @ turn.T).velocity(points @ turn.T, 0.0)
    assert np.array_equal(turned, plain @ turn.T)


def test_series_by_hand():
    # At 2.5 s a quarter of the second table has come: (1.5, 0, 0.25) at the surface, (0, 3, 0) 4 m deep.
    top, quarter, bottom, above = SERIES.velocity(at(0.0, -1.0, -9.0, 1.0), 2.5)
    assert top == pytest.approx([1.5, 0.0, 0.25]) and np.array_equal(above, top)
    assert quarter == pytest.approx([1.125, 0.75, 0.1875]) and bottom == pytest.approx([0.0, 3.0, 0.0])
    first, last = (SERIES.velocity(at(0.0), time) for time in (0.0, 10.0))
    assert np.array_equal(first, [[1.0, 0.0, 0.0]]) and np.array_equal(last, [[3.0, 0.0, 1.0]])
    assert np.array_equal(SERIES.velocity(at(0.0), -5.0), first)
    assert np.array_equal(SERIES.velocity(at(0.0), 99.0), last)


def test_series_of_one_time_is_steady_and_of_one_depth_uniform():
    one = SeriesCurrent([3.0], DEPTHS, [VECTORS])
    assert one.steady and not one.uniform
    points = at(*np.linspace(0.0, -15.0, 9))
    assert np.array_equal(one.velocity(points, 77.0), TableCurrent(DEPTHS, VECTORS).velocity(points, 0.0))
    tide = SeriesCurrent([0.0, 4.0], [2.0], [[[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]])
    assert tide.uniform and not tide.steady
    assert np.array_equal(tide.velocity(at(0.0, -90.0), 1.0), [[0.75, 0.25, 0.0]] * 2)


def test_ramp_by_hand_and_with_a_series():
    # x = 1/4: (1/64) (10 - 15/4 + 6/16) = 6.625 / 64; half way 1/2; the two sides are mirror images.
    assert (ramp(0.0, 8.0), ramp(2.0, 8.0), ramp(4.0, 8.0), ramp(8.0, 8.0)) == (0.0, 0.103515625, 0.5, 1.0)
    assert ramp(-1.0, 8.0) == 0.0 and ramp(1e9, 8.0) == 1.0
    assert ramp(1.7, 8.0) + ramp(6.3, 8.0) == pytest.approx(1.0, abs=1e-15)
    ramped = RampedCurrent(SERIES, 5.0)
    assert np.array_equal(ramped.velocity(at(0.0), 2.5), 0.5 * SERIES.velocity(at(0.0), 2.5))
    assert not ramped.velocity(at(0.0), 0.0).any() and not ramped.steady
    assert at_full_strength(ramped) is SERIES and at_full_strength(SERIES) is SERIES


def test_ramp_has_zero_slope_and_curvature_at_both_ends():
    """Its departure from either end is of third order: eight times smaller at half the distance, less a little."""
    for departure in (lambda t: ramp(t, 1.0), lambda t: 1.0 - ramp(1.0 - t, 1.0)):
        assert np.log2(departure(2e-3) / departure(1e-3)) == pytest.approx(3.0, abs=0.01)
    times = np.linspace(0.0, 1.0, 2001)
    slope = np.diff([ramp(t, 1.0) for t in times]) / np.diff(times)
    assert slope.min() >= 0.0 and slope.max() == pytest.approx(1.875, rel=1e-6)


@pytest.mark.parametrize(
    "make",
    [
        lambda: TableCurrent([0.0, 5.0, 5.0], VECTORS),
        lambda: TableCurrent([5.0, 0.0, 7.0], VECTORS),
        lambda: TableCurrent([0.0, np.nan, 7.0], VECTORS),
        lambda: TableCurrent([], np.zeros((0, 3))),
        lambda: TableCurrent(DEPTHS, VECTORS[:2]),
        lambda: LayerCurrent(DEPTHS, [[0.0, np.inf, 0.0]] * 3),
        lambda: SeriesCurrent([1.0, 0.0], DEPTHS, [VECTORS, VECTORS]),
        lambda: SeriesCurrent([0.0, 1.0], DEPTHS, VECTORS),
        lambda: PowerCurrent((1.0, 0.0, 0.0), 0.0, 0.1),
        lambda: PowerCurrent((1.0, 0.0, 0.0), 20.0, -0.1),
        lambda: RampedCurrent(SERIES, 0.0),
    ],
)
def test_what_makes_no_current_is_refused(make):
    with pytest.raises(ValueError, match=r"current|power law"):
        make()
