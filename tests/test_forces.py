"""Forces: tangents against differences, invariances, energy, laws against hand-made numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.bars import assemble, bar_geometry
from fyke.forces.evaluate import evaluate
from fyke.forces.inertia import invert_masses, largest_frequency, mass_matrices
from fyke.forces.tension import law_tension
from fyke.forces.total import total_force, work_arrays
from fyke.solve.linear import Pattern


def force_on_knots(system, x, v):
    rel, g = work_arrays(len(x))
    out = np.empty_like(x)
    total_force(x, v, system.current.velocity(x, 0.0), system.elements, rel, g, out)
    return out


def shaken(system, seed=0, size=3e-3):
    rng = np.random.default_rng(seed)
    x = system.net.positions + rng.normal(scale=size, size=system.net.positions.shape)
    return x, rng.normal(scale=0.3, size=x.shape)


def test_assembled_tangent_against_differences(framed):
    """Central differences of the whole force at rest, on a panel with taut and slack bars."""
    system = framed(meshes=(3, 2), size=(0.127, 0.085))
    el = system.elements
    x, _ = shaken(system)
    v = np.zeros_like(x)
    u = system.current.velocity(x, 0.0)
    m = system.net.bar_count
    t, length = np.empty((m, 3)), np.empty(m)
    bar_geometry(x, el, t, length)
    stretch = length - el.rest_length
    assert 0 < np.count_nonzero(stretch > 0) < m
    tension = np.maximum(el.stiffness * stretch, 0.0)
    along = np.where(stretch > 0, el.stiffness, 0.0)
    across = tension / length
    outer = t[:, :, None] * t[:, None, :]
    block = along[:, None, None] * outer + across[:, None, None] * (np.eye(3) - outer)
    pattern = Pattern.of(el)
    data = np.empty(len(pattern.indices))
    assemble(block, u, el, t, pattern.start, pattern.stride, data)
    tangent = pattern.matrix(data).toarray()
    columns = []
    for knot in pattern.free:
        for q in range(3):
            ahead, behind = x.copy(), x.copy()
            ahead[knot, q] += 1e-7
            behind[knot, q] -= 1e-7
            change = force_on_knots(system, ahead, v) - force_on_knots(system, behind, v)
            columns.append(-change[pattern.free].ravel() / 2e-7)
    expected = np.column_stack(columns)
    assert np.abs(tangent - expected).max() < 1e-6 * np.abs(expected).max()


def test_forces_turn_with_the_problem(framed, nylon):
    system = framed(water=fyke.Water(gravity=0.0), damping_time=1e-4)
    rng = np.random.default_rng(1)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    x, v = shaken(system)
    turned = fyke.make_system(system.net, current=tuple(0.5 * turn[:, 0]), water=fyke.Water(gravity=0.0))
    turned = replace(turned, elements=system.elements)
    a = force_on_knots(system, x, v)
    b = force_on_knots(turned, x @ turn.T + 7.0, v @ turn.T)
    assert np.abs(a @ turn.T - b).max() < 1e-9 * np.abs(a).max()


def test_tension_is_action_and_reaction(framed):
    """Without water and weight the forces of the bars add up to nothing, and so do their moments."""
    system = framed(
        current=(0.0, 0.0, 0.0),
        water=fyke.Water(density=1e-12, gravity=0.0),
        damping_time=1e-4,
    )
    x, v = shaken(system)
    force = force_on_knots(system, x, v)
    assert np.abs(force).max() > 1.0
    assert np.abs(force.sum(axis=0)).max() < 1e-11 * np.abs(force).sum()
    assert np.abs(np.cross(x, force).sum(axis=0)).max() < 1e-11 * np.abs(force).sum()


def test_compiled_force_against_plain_numpy(framed):
    """The hot loop against the equations written out once more, slack bars, damping and all."""
    system = framed(damping_time=2e-5)
    el, net = system.elements, system.net
    x, v = shaken(system)
    u = system.current.velocity(x, 0.0)
    a, b = net.bars.T
    d = x[b] - x[a]
    length = np.linalg.norm(d, axis=1)
    t = d / length[:, None]
    k = 1e9 * np.pi / 4 * 1.5e-3**2 / 0.03
    rate = ((v[b] - v[a]) * t).sum(axis=1)
    tension = np.where(length > 0.03, np.maximum(k * (length - 0.03 + 2e-5 * rate), 0.0), 0.0)
    w = 0.5 * ((u - v)[a] + (u - v)[b])
    s = (w * t).sum(axis=1)
    n = w - s[:, None] * t
    water = (0.5 * 1000.0 * 1.5e-3 * length)[:, None] * (
        1.2 * np.linalg.norm(n, axis=1)[:, None] * n + 0.1 * (np.abs(s) * s)[:, None] * t
    )
    rel = u - v
    force = 0.5 * 1000.0 * np.pi / 4 * 3.5e-3**2 * np.linalg.norm(rel, axis=1)[:, None] * rel
    force += el.weight
    np.add.at(force, a, tension[:, None] * t + 0.5 * water)
    np.add.at(force, b, -tension[:, None] * t + 0.5 * water)
    assert np.abs(force_on_knots(system, x, v) - force).max() < 1e-12 * np.abs(force).max()
    frame = evaluate(system, fyke.State(0.0, x, v))
    assert np.abs(frame.tension - tension).max() < 1e-12 * tension.max()
    assert frame.unbalanced_force == pytest.approx(np.linalg.norm(force[~net.fixed], axis=1).max(), rel=1e-12)


def test_damping_never_makes_a_bar_push(framed):
    system = framed(damping_time=1.0)
    x, v = shaken(system)
    frame = evaluate(system, fyke.State(0.0, x, v))
    assert frame.tension.min() == 0.0
    stretch = np.linalg.norm(x[system.net.bars[:, 1]] - x[system.net.bars[:, 0]], axis=1) - 0.03
    assert np.all(frame.tension[stretch <= 0] == 0.0)
    assert np.any(frame.tension[stretch > 0] == 0.0)


def rows_tension(law, strain, diameter=2e-3):
    rows = law.rows(diameter)
    return law_tension(strain, rows, 0, len(rows))


def test_elastic_laws_by_hand():
    tension, slope = rows_tension(fyke.LinearLaw(1e9), 0.02)
    assert tension == pytest.approx(1e9 * np.pi * 1e-6 * 0.02, rel=1e-14)
    assert slope == pytest.approx(1e9 * np.pi * 1e-6, rel=1e-14)
    tension, slope = rows_tension(fyke.PowerLaw(345.37e6, 1.0121), 0.05)
    assert tension == pytest.approx(4e-6 * 345.37e6 * 0.05**1.0121, rel=1e-13)
    assert slope == pytest.approx(4e-6 * 345.37e6 * 1.0121 * 0.05**0.0121, rel=1e-12)
    # Twisted nylon twine of 4.17 lb at 2.9 % and 8.33 lb at 4.8 %: straight between the measured points.
    table = fyke.TableLaw((0.0, 0.029, 0.048, 0.068), (0.0, 18.5491, 37.0537, 55.6028))
    assert rows_tension(table, 0.029)[0] == pytest.approx(18.5491, rel=1e-14)
    assert rows_tension(table, 0.0385)[0] == pytest.approx(0.5 * (18.5491 + 37.0537), rel=1e-12)
    assert rows_tension(table, 0.088)[0] == pytest.approx(55.6028 + (55.6028 - 37.0537), rel=1e-12)


def test_laws_in_the_hot_loop(framed, nylon):
    """A power law of exponent one and a table of one straight piece are the linear law."""
    stiff = np.pi / 4 * 1e9
    twins = (
        fyke.PowerLaw(stiff, 1.0),
        fyke.TableLaw((0.0, 0.1, 1.0), (0.0, *(np.array([0.1, 1.0]) * stiff * 2.25e-6))),
    )
    system = framed(damping_time=1e-5)
    x, v = shaken(system)
    reference = force_on_knots(system, x, v)
    for law in twins:
        net = replace(system.net, twines=(replace(system.net.twines[0], law=law),))
        twin = fyke.make_system(net, current=(0.5, 0.0, 0.0))
        assert not twin.elements.linear
        assert np.abs(force_on_knots(twin, x, v) - reference).max() < 1e-9 * np.abs(reference).max()


def test_added_mass_turns_with_the_bar(nylon):
    """A bar drags water along only across itself: C_a rho pi/4 d^2 l, half to each end; a sphere half its volume."""
    net = fyke.line(nylon, [[0, 0, 0], [0.03, 0, 0]], 0.03, knot_diameter=4e-3, fixed=())
    system = fyke.make_system(net)
    mass = np.empty((2, 6))
    mass_matrices(net.positions, system.elements, mass)
    bar, ball = np.pi / 4 * 1.5e-3**2 * 0.03, np.pi / 6 * 4e-3**3
    own = 0.5 * 1140 * bar + (1140 + 500) * ball
    assert mass[0] == pytest.approx([own, own + 500 * bar, own + 500 * bar, 0, 0, 0], rel=1e-12)
    turned = fyke.make_system(replace(net, positions=np.array([[0, 0, 0], [0.03, 0.03, 0]]) / np.sqrt(2)))
    mass_matrices(turned.net.positions, turned.elements, mass)
    assert mass[0, 3] == pytest.approx(-0.5 * 500 * bar, rel=1e-12)
    inverse = mass.copy()
    invert_masses(inverse, np.ones(2))
    full = [
        np.array([[m[0], m[3], m[4]], [m[3], m[1], m[5]], [m[4], m[5], m[2]]]) for m in (mass[0], inverse[0])
    ]
    assert np.abs(full[0] @ full[1] - np.eye(3)).max() < 1e-14


def test_frequency_bound_is_tight_and_never_below(framed):
    """Against the eigenvalues of the stiffness of all bars taut and the full mass matrix."""
    for mesh, size in (("diamond", (0.14, 0.14)), ("square", (0.12, 0.12)), ("diamond", (0.19, 0.07))):
        system = framed(mesh=mesh, meshes=(4, 4), size=size)
        el, x = system.elements, system.net.positions
        n = len(x)
        mass = np.empty((n, 6))
        mass_matrices(x, el, mass)
        full = np.zeros((3 * n, 3 * n))
        for i, m in enumerate(mass):
            full[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = [
                [m[0], m[3], m[4]],
                [m[3], m[1], m[5]],
                [m[4], m[5], m[2]],
            ]
        stiffness = np.zeros_like(full)
        for (a, b), k in zip(system.net.bars, el.stiffness, strict=True):
            t = (x[b] - x[a]) / np.linalg.norm(x[b] - x[a])
            row = np.zeros(3 * n)
            row[3 * a : 3 * a + 3], row[3 * b : 3 * b + 3] = -t, t
            stiffness += k * np.outer(row, row)
        keep = np.repeat(el.free > 0, 3)
        values = np.linalg.eigvals(np.linalg.solve(full[np.ix_(keep, keep)], stiffness[np.ix_(keep, keep)]))
        exact = np.sqrt(values.real.max())
        invert_masses(mass, el.free)
        bound = largest_frequency(x, el.stiffness, mass, el)
        assert exact <= bound <= 1.45 * exact, mesh


def test_knots_that_coincide_make_no_nan(nylon):
    net = fyke.line(nylon, [[0, 0, 0], [0, 0, 0], [0.03, 0, 0]], 0.03)
    frame = evaluate(
        fyke.make_system(net, current=(0.5, 0, 0)), fyke.State(0.0, net.positions, np.zeros((3, 3)))
    )
    assert np.all(np.isfinite(frame.water_force)) and frame.tension.tolist() == [0.0, 0.0]
