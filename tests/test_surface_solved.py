"""Nets at the surface and in currents that change with depth, solved: buoyancy by hand, tangents, iterations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import fyke
from fyke.forces.wetness import wet_bar
from fyke.solve.equilibrium import Equilibrium
from fyke.water.laws.bars import ChooCasarella
from fyke.water.laws.knots import CliftGauvin
from fyke.water.laws.panels import Loland
from fyke.water.profile import PowerCurrent, TableCurrent

G, RHO = 9.81, 1000.0
SHEAR = TableCurrent([0.0, 1.0, 2.0], [[0.8, 0.1, 0.0], [0.3, -0.2, 0.0], [-0.2, 0.3, 0.0]])


def twine(density: float, diameter: float = 0.02, modulus: float = 1e9) -> fyke.Twine:
    return fyke.Twine("any", density, diameter, fyke.LinearLaw(modulus))


def floating(density: float, bars: int = 40, slack: float = 1.05, ends: float = 0.0) -> fyke.Net:
    """Rope of 10 m between its held ends at a height (m)."""
    x = np.zeros((bars + 1, 3))
    x[:, 0], x[:, 2] = np.linspace(0.0, 10.0, bars + 1), ends
    return fyke.line(twine(density), x, slack * 10.0 / bars)


def curtain(density: float = 1140.0, centre: float = -1.0, **options) -> fyke.Net:
    return fyke.panel(
        twine(density, 3e-3),
        **{
            "mesh": "diamond",
            "meshes": (8, 12),
            "bar_length": 0.1,
            "size": (1.0, 1.5),
            "knot_diameter": 8e-3,
            "centre": (0.0, 0.0, centre),
        }
        | options,
    )


def segment(s: float) -> float:
    """Part of a circle under water, its middle s radii deep: the angle of its water line, theta - sin theta."""
    angle = 2.0 * np.arccos(-np.clip(s, -1.0, 1.0))
    return (angle - np.sin(angle)) / (2.0 * np.pi)


def test_the_wet_part_of_a_bar_is_the_mean_of_segments_along_it():
    rng = np.random.default_rng(2)
    for a, b in rng.uniform(-0.03, 0.03, (20, 2)):
        mean = quad(lambda t, a=a, b=b: segment((a + t * (b - a)) / 0.01), 0.0, 1.0, epsabs=1e-12, limit=400)[
            0
        ]
        assert wet_bar(a, b, 0.01)[0] == pytest.approx(mean, abs=1e-8)
    for depth in (-0.0099, -0.004, 0.0, 0.0077):
        near = [wet_bar(depth - gap, depth + gap, 0.01)[0] for gap in (0.0, 4e-8, 6e-8, 1e-6)]
        assert near == pytest.approx([segment(depth / 0.01)] * 4, abs=1e-7)
    assert wet_bar(0.02, 0.03, 0.01) == (1.0, 0.0, 0.0)
    assert wet_bar(-0.02, -0.03, 0.01) == (0.0, 0.0, 0.0)


def test_slopes_of_the_wet_part_by_complex_step():
    """Of the closed form of the mean, its depths complex numbers: half a circle lifts its diameter a metre."""

    def immersed(s):
        square = 1.0 - s * s
        return (1 + s) / 2 + (
            np.sqrt(square) - np.sqrt(square) ** 3 / 3 + s * np.arcsin(s) - np.pi / 2
        ) / np.pi

    step, radius = 1e-30, 0.2
    for a, b in [(-0.1, 0.05), (0.15, 0.03), (-0.19, 0.19)]:
        for end in (0, 1):
            s, t = (complex(a, step * (end == 0)) / radius, complex(b, step * (end == 1)) / radius)
            want = ((immersed(t) - immersed(s)) / (t - s)).imag / step
            assert wet_bar(a, b, radius)[1 + end] == pytest.approx(want, rel=1e-10)
    part, by_a, by_b = wet_bar(0.0, 0.0, radius)
    assert part == 0.5
    assert np.pi * radius**2 * (by_a + by_b) == pytest.approx(2.0 * radius, rel=1e-14)


# Tangents


LAWS = {
    "constant": {},
    "by speed": {"bars": ChooCasarella(), "knots": CliftGauvin()},
    "screens": {"screens": Loland()},
}


@pytest.mark.parametrize("laws", LAWS.values(), ids=LAWS)
def test_the_symmetric_part_is_that_of_the_whole(laws):
    net = curtain(centre=0.004, meshes=(2, 3), size=(0.25, 0.36))
    system = fyke.make_system(
        net, current=(0.5, 0.2, 0.1), coefficients=fyke.Coefficients(**laws), surface=True
    )
    x = net.positions + 0.02 * np.random.default_rng(4).normal(size=net.positions.shape)
    s = Equilibrium(system, fyke.State(0.0, x, np.zeros_like(x)), None)
    p, whole, part = s.pattern, np.zeros(len(s.pattern.indices)), np.zeros(len(s.pattern.indices))
    for symmetric, data in ((False, whole), (True, part)):
        s.surroundings.add_wetting(
            s.x, s.u, s.el, s.b.t, s.b.length, (p.start, p.stride, p.diagonal), p.groups,
            symmetric=symmetric, data=data,
        )  # fmt: skip
    matrix = p.matrix(whole).toarray()
    assert np.abs(matrix).max() > 0.0
    assert p.matrix(part).toarray() == pytest.approx(
        0.5 * (matrix + matrix.T), abs=1e-12 * np.abs(matrix).max()
    )


# Solved


@pytest.mark.parametrize(
    ("current", "most"),
    [
        (PowerCurrent((0.7, 0, 0), 25.0, 0.5), 18),
        (TableCurrent([0.0, 5.0, 5.001], [[1, 0, 0], [1, 0, 0], [-0.3, 0.3, 0]]), 30),
        (TableCurrent(np.arange(10.0) * 1.5, [[1, 0, 0], [0.1, 0, 0]] * 5), 25),
    ],
    ids=["power", "jump of a millimetre", "to and fro"],
)
@pytest.mark.parametrize("fixed", ["edges", "top"])
def test_curtains_in_strong_shear_take_a_few_iterations(current, most, fixed):
    """Without the change of the current in the tangent the jump takes 1000 and more."""
    net = curtain(meshes=(8, 60), size=(1.0, 7.6), centre=-5.0, fixed=fixed)
    if fixed == "top":
        load = net.load.copy()
        load[net.positions[:, 2] < net.positions[:, 2].min() + 0.01, 2] = -5.0
        net = replace(net, load=load)
    outcome = fyke.solve_static(fyke.make_system(net, current=current)).outcome
    assert outcome.ok and outcome.iterations <= most


@pytest.mark.parametrize(
    ("fixed", "density", "most"),
    [
        ("edges", 500.0, 25),
        ("edges", 1140.0, 25),
        ("top", 500.0, 250),
        ("top", 950.0, 45),
        ("top", 1140.0, 30),
    ],
)
def test_panels_through_the_surface_arrive(fixed, density, most):
    """Without the wet parts in the tangent those hung by the top do not arrive in 1000 iterations."""
    net = curtain(density, centre=0.0, fixed=fixed)
    system = fyke.make_system(net, current=(0.5, 0.0, 0.0), surface=True)
    result = fyke.solve_static(system)
    assert result.outcome.ok and result.outcome.iterations <= most
    if fixed == "top" and density < RHO:
        # What hangs in the air over the water sinks no deeper than it floats.
        assert result.position[-1][:, 2].min() > -0.02


@pytest.mark.parametrize("density", [900.0, 1140.0])
def test_at_rest_an_implicit_run_ends_where_statics_does(density):
    """A rope that floats and one that hangs from the surface; steps do not shrink to nothing there."""
    system = fyke.make_system(floating(density), current=(0.0, 0.3, 0.0), surface=True)
    still = fyke.solve_static(system, tolerance=1e-9)
    run = fyke.simulate(
        system, duration=300.0, every=5.0, stepper=fyke.Implicit(), settle=fyke.Settle(force=1e-6)
    )
    assert run.outcome.ok and run.outcome.iterations < 600
    assert np.abs(run.position[-1] - still.position[-1]).max() < 1e-4


def test_a_jump_on_which_no_knot_rests_is_named(monkeypatch):
    """Layers: the force on a knot is one above the jump and another below, and none between."""
    from fyke.water.profile import LayerCurrent

    net = curtain(meshes=(12, 60), bar_length=0.2, size=(3.05, 15.27), centre=-11.0, knot_diameter=0.0)
    current = LayerCurrent([0.0, 5.0, 10.0], [[1, 0, 0], [0.4, 0.3, 0], [-0.1, 0, 0]])
    outcome = fyke.solve_static(fyke.make_system(net, current=current), max_iterations=60).outcome
    assert outcome.name == "iteration_limit" and "table of depths" in outcome.advice
