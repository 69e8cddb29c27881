"""The recorder: a run that is killed leaves a readable file with every frame appended before."""

import dataclasses
import multiprocessing
import os
import random
import time

import numpy as np
import pytest
import xarray as xr

from fyke.forces.frame import Frame
from fyke.netting.panel import panel
from fyke.results import Recorder, load
from fyke.results import recorder as recorder_module
from fyke.results.fields import FRAME_FIELDS
from fyke.solve.result import Result
from test_results_store import CASE, OUTCOME, TWINE, assert_same, make_frame, make_net


def assert_frames(result, count):
    """Check that a result holds the first `count` frames of the hand-made kind."""
    assert len(result.time) == count
    for number in range(count):
        assert_same(
            Frame(**{f.name: np.asarray(getattr(result.frame(number), f.name)) for f in FRAME_FIELDS}),
            Frame(
                **{f.name: np.asarray(getattr(make_frame(result.net, number), f.name)) for f in FRAME_FIELDS}
            ),
        )


def test_frames_can_be_read_while_the_run_goes_on(tmp_path):
    net, path = make_net(), tmp_path / "result.nc"
    with Recorder(path, net, times=5, weight_in_water=0.25, case_text=CASE) as recorder:
        assert not path.exists()
        for number in range(3):
            recorder.append(make_frame(net, number))
            so_far = load(path)
            assert_frames(so_far, number + 1)
    assert_same(so_far.net, net)
    assert so_far.outcome.name == "interrupted"
    assert so_far.outcome.time == so_far.time[-1] == 0.1 * 2
    assert so_far.weight_in_water == 0.25
    assert so_far.case_text == CASE
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


@pytest.mark.filterwarnings("error")
def test_xarray_sees_the_outputs_not_reached_as_missing(tmp_path):
    net, path = make_net(), tmp_path / "result.nc"
    with Recorder(path, net, times=5, weight_in_water=0.0) as recorder:
        recorder.append(make_frame(net, 0))
        recorder.append(make_frame(net, 1))
        with xr.open_dataset(path, engine="h5netcdf") as data:
            assert data.attrs["outcome"] == "running"
            np.testing.assert_array_equal(data.time, [0.0, 0.1, np.nan, np.nan, np.nan])
            np.testing.assert_array_equal(data.tension[1], make_frame(net, 1).tension)
            for name in (field.name for field in FRAME_FIELDS):
                assert np.isnan(data[name][2:]).all(), name


def test_finishing_leaves_the_whole_result_alone(tmp_path):
    net, path = make_net(), tmp_path / "result.nc"
    frames = [make_frame(net, number) for number in range(3)]
    result = Result.from_frames(net, OUTCOME, 0.25, frames, CASE)
    with Recorder(path, net, times=50, weight_in_water=0.25, case_text=CASE) as recorder:
        for frame in frames:
            recorder.append(frame)
        recorder.finish(result)
    assert_same(load(path), result)
    with xr.open_dataset(path, engine="h5netcdf") as data:
        assert data.sizes["time"] == 3
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


def test_a_run_of_more_outputs_than_planned_gets_more_room(tmp_path):
    net, path = make_net(), tmp_path / "result.nc"
    with Recorder(path, net, times=1, weight_in_water=0.0) as recorder:
        for number in range(19):
            recorder.append(make_frame(net, number))
    assert_frames(load(path), 19)


def test_a_net_too_large_for_all_its_outputs_at_once_takes_room_piece_by_piece(tmp_path, monkeypatch):
    net, path = make_net(), tmp_path / "result.nc"
    monkeypatch.setattr(recorder_module, "FIRST_ROOM", 20_000)
    with Recorder(path, net, times=10**9, weight_in_water=0.0) as recorder:
        for number in range(40):
            recorder.append(make_frame(net, number))
        assert path.stat().st_size < 1_000_000
    assert_frames(load(path), 40)


@pytest.mark.parametrize("field", FRAME_FIELDS, ids=lambda field: field.name)
def test_a_frame_with_a_number_that_is_not_finite_is_refused(tmp_path, field):
    net, path = make_net(), tmp_path / "result.nc"
    good = make_frame(net, 1)
    bad = np.array(getattr(good, field.name), dtype=float)
    where = tuple(size // 2 for size in bad.shape)
    bad[where] = np.inf
    sign = {"knot": f"knot {net.labels[net.knot_count // 2]}", "bar": f"bar {net.bar_count // 2}"}
    sign |= {"xyz": "along y"}
    with Recorder(path, net, times=3, weight_in_water=0.0) as recorder:
        recorder.append(make_frame(net, 0))
        with pytest.raises(ValueError, match=f"{field.name} is inf") as caught:
            recorder.append(dataclasses.replace(good, **{field.name: bad}))
        for dimension in field.dimensions[1:]:
            assert sign[dimension] in str(caught.value)
        assert_frames(load(path), 1)
        recorder.append(good)
    assert_frames(load(path), 2)


def test_a_frame_of_another_net_is_refused(tmp_path):
    net = make_net()
    with Recorder(tmp_path / "result.nc", net, times=3, weight_in_water=0.0) as recorder:
        with pytest.raises(ValueError, match="tension has shape"):
            recorder.append(dataclasses.replace(make_frame(net, 0), tension=np.zeros(1)))
    assert list(tmp_path.iterdir()) == []


def test_an_error_in_the_run_leaves_the_frames_before_it(tmp_path):
    net, path = make_net(), tmp_path / "result.nc"
    with pytest.raises(KeyboardInterrupt), Recorder(path, net, times=9, weight_in_water=0.0) as recorder:
        recorder.append(make_frame(net, 0))
        raise KeyboardInterrupt
    assert_frames(load(path), 1)
    with pytest.raises(ValueError, match="closed"):
        recorder.append(make_frame(net, 1))


def test_a_folder_that_cannot_be_written_is_told_before_the_run(tmp_path):
    with pytest.raises(OSError):
        Recorder(tmp_path / "missing" / "result.nc", make_net(), times=3, weight_in_water=0.0)


@pytest.mark.parametrize("torn", range(len(FRAME_FIELDS)))
def test_a_frame_torn_in_any_of_its_variables_does_not_count(tmp_path, monkeypatch, torn):
    """Stop in the midst of the write of each variable in turn, as a kill would."""
    net, path = make_net(), tmp_path / "result.nc"

    class Killed(BaseException):
        pass

    class TornFile(recorder_module.FileIO):
        writes = 0

        def write(self, data):
            done = super().write(bytes(data)[: max(1, len(data) // 2)] if TornFile.writes == torn else data)
            TornFile.writes += 1
            if TornFile.writes > torn:
                raise Killed
            return done

    recorder = Recorder(path, net, times=5, weight_in_water=0.0)
    recorder.append(make_frame(net, 0))
    recorder.append(make_frame(net, 1))
    recorder.close()
    monkeypatch.setattr(recorder_module, "FileIO", TornFile)
    recorder._file = TornFile(path, "r+")
    with pytest.raises(Killed):
        recorder.append(make_frame(net, 2))
    recorder.close()
    assert_frames(load(path), 2)


def _write_until_killed(path, net, done, room):
    recorder_module.FIRST_ROOM = room
    with Recorder(path, net, times=10**6, weight_in_water=0.0) as recorder:
        number = 0
        while True:
            recorder.append(make_frame(net, number))
            number += 1
            done.value = number


@pytest.mark.skipif(os.name == "nt", reason="needs the forkserver and SIGKILL")
@pytest.mark.parametrize(
    ("room", "pause"), [(200_000, 0.3), (64 * 2**20, 0.03)], ids=["growing all the time", "in place"]
)
def test_a_run_killed_at_any_moment_leaves_every_frame_appended_before(tmp_path, room, pause):
    """SIGKILL a writing process again and again: both readers open the file each time and find all frames."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["fyke.results", "pytest", "xarray"])
    net = panel(TWINE, mesh="diamond", meshes=(12, 12), bar_length=0.03, size=(0.5, 0.5))
    chance = random.Random(1)
    counts: list[int] = []
    # Ten times at least; on a busy machine so often that it was killed at three different moments.
    for turn in range(60):
        if turn >= 10 and len(set(counts)) > 2:
            break
        path = tmp_path / f"{turn}.nc"
        done = context.Value("q", 0, lock=False)
        child = context.Process(target=_write_until_killed, args=(path, net, done, room), daemon=True)
        child.start()
        while done.value == 0 and child.is_alive():
            time.sleep(0.001)
        time.sleep(chance.uniform(0.0, pause))
        child.kill()
        child.join()
        count = done.value
        result = load(path)
        # The last frame may be whole although the child had no time left to say so.
        assert count <= len(result.time) <= count + 1
        assert_frames(result, len(result.time))
        with xr.open_dataset(path, engine="h5netcdf") as data:
            assert int(np.isfinite(data.time).sum()) == len(result.time)
        counts.append(count)
        path.unlink()
    assert len(set(counts)) > 2
