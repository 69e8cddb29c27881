"""Threads of explicit dynamics: the same bits for any number of them, and runs beside each other."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces.team import run_team, threads_allowed, threads_for

DURATION = 0.002


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


def test_numbering_of_knots_does_not_matter(framed):
    """Neighbours of shuffled knots have to be looked up; the motion is the same but for rounding."""
    system = framed(meshes=(12, 12), size=(0.46, 0.46))
    net = system.net
    order = np.random.default_rng(3).permutation(net.knot_count)
    place = np.argsort(order)
    shuffled = replace(
        net,
        positions=net.positions[order],
        bars=place[net.bars],
        fixed=net.fixed[order],
        knot_diameter=net.knot_diameter[order],
        knot_density=net.knot_density[order],
        load=net.load[order],
        labels=tuple(np.asarray(net.labels)[order]),
    )
    other = fyke.make_system(shuffled, current=(0.5, 0.0, 0.0))
    n = net.knot_count
    found, expected = moved(other, 1), moved(system, 1)
    assert np.abs(found[:n] - expected[:n][order]).max() < 1e-12
    assert np.abs(expected[:n] - net.positions).max() > 1e-6


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
