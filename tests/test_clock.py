"""Time by part: what is inside is not counted outside, and the parts make the whole."""

from __future__ import annotations

import time

import pytest

from fyke.solve.clock import Clock, charged, timed


@charged("solving")
def wait(seconds):
    time.sleep(seconds)


def test_parts_exclude_one_another_and_make_the_whole():
    began = time.perf_counter()
    with Clock("starting", began) as clock:
        with timed("forces"):
            wait(0.02)
            with timed("writing"):
                time.sleep(0.01)
        seconds = clock.seconds
        whole = time.perf_counter() - began
    assert set(seconds) == {"starting", "forces", "solving", "writing"}
    assert seconds["solving"] >= 0.02 and seconds["writing"] >= 0.01
    assert seconds["forces"] < 0.01 and seconds["starting"] < 0.01
    assert sum(seconds.values()) == pytest.approx(whole, abs=5e-3)


def test_a_part_that_fails_is_left():
    with Clock("starting") as clock:
        with pytest.raises(RuntimeError), timed("solving"):
            raise RuntimeError
        assert set(clock.seconds) == {"starting", "solving"}
        before = clock.seconds["solving"]
        time.sleep(0.002)
        assert clock.seconds["solving"] == before


def test_without_a_clock_nothing_is_kept():
    wait(0.0)
    with Clock("starting") as clock:
        pass
    wait(0.0)
    assert "solving" not in clock.seconds
