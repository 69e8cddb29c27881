"""Threads of explicit dynamics: the same bits for any number of them, and runs beside each other."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fyke
from fyke.cli.load_cases import Wishes
from fyke.cli.run import run_case
from fyke.forces.around import HERE_ROWS, WATER, knots_in_order
from fyke.forces.around import renumbered as renumbered_elements
from fyke.forces.team import run_team, threads_allowed, threads_for

DURATION = 0.002
EXAMPLE = Path(__file__).parent.parent / "examples" / "panel.toml"


def moved(system, threads):
    run = fyke.Symplectic().start(system, system.at_rest())
    run.threads = threads
    while run.state.time < DURATION:
        assert run.advance(DURATION) == "ok"
    return np.concatenate([run.state.position, run.state.velocity])


@pytest.mark.parametrize("law", [fyke.LinearLaw(1e9), fyke.PowerLaw(345e6, 1.0121)])
def test_any_number_of_threads_finds_the_same_bits(framed, law):
    system = framed(meshes=(20, 20), size=(0.76, 0.76))
    twine = replace(system.net.twines[0], law=law, damping_time=2e-5)
    system = fyke.make_system(replace(system.net, twines=(twine,)), current=(0.5, 0.0, 0.0))
    alone = moved(system, 1)
    for threads in (2, 3):
        assert np.array_equal(moved(system, threads), alone)


def renumbered(net, rng):
    order = rng.permutation(net.knot_count)
    return replace(
        net,
        positions=net.positions[order],
        bars=np.argsort(order)[net.bars],
        fixed=net.fixed[order],
        knot_diameter=net.knot_diameter[order],
        knot_density=net.knot_density[order],
        load=net.load[order],
        labels=tuple(np.asarray(net.labels)[order]),
    )


def test_numbering_of_knots_does_not_matter(framed):
    """Shuffled knots are put in order by their places; the motion is the same but for rounding."""
    system = framed(meshes=(12, 12), size=(0.46, 0.46))
    net = system.net
    order = np.random.default_rng(3).permutation(net.knot_count)
    shuffled = renumbered(net, np.random.default_rng(3))
    other = fyke.make_system(shuffled, current=(0.5, 0.0, 0.0))
    n = net.knot_count
    found, expected = moved(other, 1), moved(system, 1)
    assert np.abs(found[:n] - expected[:n][order]).max() < 1e-12
    assert np.abs(expected[:n] - net.positions).max() > 1e-6


def test_shuffled_knots_are_put_back_in_order(framed):
    """Every bar leads one column or row further, or to a neighbour row: a few ways, as on the panel as it was built."""
    net = framed(meshes=(12, 12), size=(0.46, 0.46)).net
    system = fyke.make_system(renumbered(net, np.random.default_rng(3)))
    order = knots_in_order(system.elements, system.net.positions)
    el = renumbered_elements(system.elements, order)
    ways = np.unique(np.abs(el.knot_a.astype(int) - el.knot_b.astype(int)))
    assert len(ways) == len(np.unique(np.abs(np.diff(net.bars, axis=1))))
    built = fyke.make_system(net).elements
    assert np.array_equal(knots_in_order(built, net.positions), np.arange(net.knot_count))


def shaken(system, rng):
    """Positions, velocities and velocities of the water about the built net, (n, 3) each."""
    shape = system.net.positions.shape
    x = system.net.positions + rng.normal(scale=3e-3, size=shape)
    return x, rng.normal(scale=1e-3, size=shape), rng.normal(scale=0.5, size=shape)


def accelerations(el, x, v, u):
    """Equation of motion of linear, damped bars in plain numpy, bar by bar."""
    force, mass = np.zeros_like(x), el.knot_mass[:, None, None] * np.eye(3)
    drag = el.knot_drag[:, None] * np.linalg.norm(u - v, axis=1)[:, None] * (u - v)
    force += el.weight + drag
    for e, (a, b) in enumerate(zip(el.knot_a.tolist(), el.knot_b.tolist(), strict=True)):
        length = np.linalg.norm(x[b] - x[a])
        t = (x[b] - x[a]) / length
        w = 0.5 * (u[a] + u[b] - v[a] - v[b])
        normal = w - (w @ t) * t
        water = length * el.normal_drag[e] * np.linalg.norm(normal) * normal
        water += length * el.tangential_drag[e] * abs(w @ t) * (w @ t) * t
        stretch = length - el.rest_length[e]
        pull = (
            el.stiffness[e] * (stretch + el.damping_time[e] * ((v[b] - v[a]) @ t)) if stretch > 0.0 else 0.0
        )
        for knot, sign in ((a, 1.0), (b, -1.0)):
            force[knot] += water + sign * max(pull, 0.0) * t
            mass[knot] += el.bar_added_mass[e] * (np.eye(3) - np.outer(t, t))
    free = el.free > 0.0
    found = np.zeros_like(x)
    found[free] = np.linalg.solve(mass[free], force[free][:, :, None])[:, :, 0]
    return found


@pytest.mark.parametrize("meshes", [(8, 8), (20, 3), (12, 12), (24, 24)])
@pytest.mark.parametrize("shuffled", [False, True])
def test_first_kick_against_the_equation_of_motion(framed, meshes, shuffled):
    """In one block and in several, by shifts and looked up, in water that moves differently everywhere."""
    rng = np.random.default_rng(5)
    system = framed(meshes=meshes, size=(0.038 * meshes[0], 0.038 * meshes[1]), damping_time=2e-5)
    if shuffled:
        # In no rows either, so that nothing puts them in order and neighbours are looked up.
        net = renumbered(system.net, rng)
        net = replace(net, positions=net.positions + rng.normal(scale=1e-3, size=net.positions.shape))
        system = fyke.make_system(net, current=(0.5, 0.0, 0.0))
    x, v, u = shaken(system, rng)
    run = fyke.Symplectic().start(system, system.at_rest())
    for row, values in ((0, x), (3, v), (WATER, u)):
        run.write(row, values)
    h = 1e-10
    run.leap(h, 0, False)
    found = (run.read(HERE_ROWS + 3) - v) / (0.5 * h)
    expected = accelerations(system.elements, x, v, u)
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


def test_runs_beside_each_other(framed):
    system = framed(meshes=(20, 20), size=(0.76, 0.76))
    alone, found = moved(system, 1), []
    runs = [threading.Thread(target=lambda: found.append(moved(system, 2))) for _ in range(2)]
    for run in runs:
        run.start()
    for run in runs:
        run.join()
    assert len(found) == 2
    assert all(np.array_equal(one, alone) for one in found)


def test_a_fault_of_one_thread_stops_the_others():
    def kernel(rank, team, signal):
        if rank == 1:
            raise RuntimeError("broken")
        while signal[16] == 0:
            pass

    with pytest.raises(RuntimeError, match="broken"):
        run_team(2, kernel)


def test_number_of_threads(monkeypatch):
    monkeypatch.setenv("FYKE_THREADS", "3")
    assert threads_allowed() == 3
    assert (threads_for(100), threads_for(10**6)) == (1, 3)


@pytest.mark.parametrize("wrong", ["two", "0", "-1", "1.5"])
def test_number_of_threads_that_is_none(monkeypatch, framed, wrong):
    monkeypatch.setenv("FYKE_THREADS", wrong)
    with pytest.raises(ValueError, match=f"FYKE_THREADS is '{wrong}'; it must be a whole number above 0"):
        fyke.Symplectic().start((system := framed()), system.at_rest())


def test_command_tells_a_number_of_threads_that_is_none(monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("FYKE_THREADS", "two")
    assert run_case(EXAMPLE, Wishes(output=tmp_path / "out")) == 2
    told = capsys.readouterr().err
    assert "FYKE_THREADS" in told
    assert "a whole number above 0" in told
    assert not (tmp_path / "out").exists()
