"""The study behind the live page, without a browser: the same numbers as a run, refusals, pins, motion, saving."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

import fyke
from reference import panel_case

live = pytest.importorskip("fyke.live.study", reason="the extra 'view' is not installed")
from fyke.live.knobs import knobs_of  # noqa: E402
from fyke.live.server import AddressError, free_port, serve  # noqa: E402

CASE = panel_case(4, 0.15, knots='knot_diameter = "3.5 mm"')


def solved(text: str) -> fyke.Result:
    case = fyke.parse_case(text)
    net = fyke.build_net(case)
    return fyke.solve_static(fyke.build_system(net, case))


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"current.speed": 1.25}, CASE.replace("0.5, 0.0", "1.25, 0.0")),
        (
            {"current.direction": 30.0},
            CASE.replace("[0.5, 0.0, 0.0]", f"[{0.5 * np.sqrt(0.75)}, 0.25, 0.0]"),
        ),
        ({"netting.main.bar_length": 33.0}, CASE.replace("30 mm", "33 mm")),
        (
            {"twine.main.diameter": 2.0, "twine.main.modulus": 0.3},
            CASE.replace("1.5 mm", "2 mm").replace("1.0 G", "0.3 G"),
        ),
        ({"gear.0.width": 120.0}, CASE.replace("[0.15, 0.15]", "[0.12, 0.15]")),
    ],
)
def test_a_turned_knob_gives_what_a_run_of_that_case_gives(changes, text):
    study = live.Study(CASE)
    study.turn(changes)
    expected = solved(text)
    velocity = fyke.parse_case(text).current.velocity
    assert study.numbers.drag == pytest.approx(
        float(expected.hydrodynamic_force[-1] @ velocity / np.linalg.norm(velocity)), abs=1e-6
    )
    assert study.numbers.largest_tension == pytest.approx(float(expected.tension.max()), abs=1e-6)
    assert np.abs(study.result.position - expected.position).max() < 1e-6


def test_waves_act_in_motion_only_and_the_page_says_so():
    sea = "[waves]\nkind = 'airy'\nheight = 0.3\nperiod = 2.0\n"
    dynamic = CASE + sea + "[solve]\nkind = 'dynamic'\nduration = 1\n"
    still, waved = live.Study(CASE), live.Study(dynamic)
    assert still.waves_note == "" and "static" in live.Study(CASE + sea).waves_note
    assert "airy, 0.3 m, 2 s" in waved.waves_note and "without them" in waved.waves_note
    assert waved.numbers.drag == pytest.approx(still.numbers.drag, abs=1e-6)
    waved.reset()
    waved.advance(0.1)
    # 0.47 m/s of a crest come on top of 0.5 m/s of current.
    assert np.linalg.norm(waved.result.water_velocity[-1], axis=1).max() > 0.8


@pytest.mark.parametrize(
    "more", ["[drag]\nkind = 'screens'\n", "[shelter]\nwake = 'loland'\ntwines = 'cheng'\n"]
)
def test_screens_and_shelter_are_found_anew_with_every_turn(more):
    study = live.Study(CASE + more)
    study.turn({"current.speed": 0.8})
    expected = solved(CASE.replace("0.5, 0.0", "0.8, 0.0") + more)
    assert np.abs(study.result.position - expected.position).max() < 1e-6
    assert study.numbers.drag == pytest.approx(float(expected.hydrodynamic_force[-1, 0]), abs=1e-6)
    study.reset()
    study.advance(0.05)
    assert np.isfinite(study.result.position).all()


def test_what_makes_no_net_is_refused_and_changes_nothing():
    study = live.Study(CASE)
    before = study.result
    with pytest.raises(live.RefusedError, match="allowed"):
        study.turn({"netting.main.bar_length": -3.0})
    assert study.result is before
    assert study.values["netting.main.bar_length"] == pytest.approx(30.0)
    study.turn({"current.speed": 0.6})
    assert study.numbers.drag > 0.0


def test_a_pinned_knot_stays_where_it_was_drawn_and_goes_back_when_released():
    study = live.Study(CASE)
    free = int(np.argmax(study.result.position[-1][:, 0]))
    before = study.result.position[-1].copy()
    place = before[free] + [-0.02, 0.0, 0.0]
    study.pin(free, place)
    assert np.abs(study.result.position[-1][free] - place).max() < 1e-15
    assert study.result.outcome.ok
    study.turn({"current.speed": 0.7})
    assert np.abs(study.result.position[-1][free] - place).max() < 1e-15
    study.turn({"current.speed": 0.5})
    study.release(free)
    assert np.abs(study.result.position[-1] - before).max() < 1e-7


def test_motion_from_flat_ends_in_the_equilibrium():
    study = live.Study(CASE)
    rest = study.result.position[-1].copy()
    study.reset()
    assert np.array_equal(study.result.position[-1], study.result.net.positions)
    for _ in range(60):
        study.advance(1.0 / 30.0)
    assert np.abs(study.result.position[-1] - rest).max() < 2e-4
    study.pause()
    study.turn({"current.speed": 0.5})
    assert np.abs(study.result.position[-1] - rest).max() < 1e-7


def test_the_saved_case_is_the_net_that_was_seen():
    study = live.Study(CASE)
    study.turn({"current.speed": 0.83, "netting.main.bar_length": 31.5})
    study.pin(20)
    text = study.case_text()
    assert f"#   {study.result.net.labels[20]} at" in text
    assert tomllib.loads(text)["current"]["velocity"] == pytest.approx([0.83, 0.0, 0.0])
    study.release(20)
    assert np.abs(solved(text).position - study.result.position).max() < 1e-6


def test_a_ray_finds_the_knot_it_passes():
    study = live.Study(CASE)
    knot = 17
    place = study.result.position[-1][knot]
    eye = np.array([3.0, 0.4, 0.2])
    assert study.nearest_knot(eye, place - eye) == knot
    assert study.nearest_knot(eye, eye - place) is None


def test_every_knob_has_a_unit_and_its_value_within_its_range():
    for knob in knobs_of(fyke.parse_case(CASE)):
        assert knob.low <= knob.value <= knob.high, knob
        assert knob.unit or "ratio" in knob.key
        assert 0.0 < knob.step < knob.high - knob.low


def test_no_other_host_without_the_flag(tmp_path):
    with pytest.raises(AddressError, match="--open-to-network"):
        serve(CASE, tmp_path / "net.toml", host="0.0.0.0")


def test_the_next_free_port_is_taken():
    import socket

    with socket.socket() as busy:
        busy.bind(("127.0.0.1", 0))
        busy.listen()
        port = busy.getsockname()[1]
        assert free_port("127.0.0.1", port) > port
