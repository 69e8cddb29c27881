"""A run that was stopped and taken up again gives the bits of one that was not."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import fyke
from fyke.results import CheckpointError, load, load_checkpoint, save_checkpoint

CASE = (Path(__file__).parent.parent / "examples" / "panel_release.toml").read_text()
STEPPERS = [fyke.Implicit(), fyke.Newmark(), fyke.Verner(), fyke.Symplectic(), fyke.Auto()]
ARRAYS = ("time", "position", "velocity", "tension", "water_force", "kinetic_energy", "unbalanced_force")


@pytest.mark.parametrize("stepper", STEPPERS, ids=lambda s: s.name)
@pytest.mark.parametrize("stop", [1, 4, 9])
def test_same_bits_from_any_checkpoint(framed, stepper, stop, tmp_path):
    options = {"duration": 0.1, "every": 0.01, "stepper": stepper}
    checkpoints = []
    whole = fyke.simulate(
        framed(damping_time=2e-5),
        on_checkpoint=lambda c: (
            save_checkpoint(tmp_path / f"{c.frames}.npz", c, case_sha256="abc") or checkpoints.append(c)
        ),
        **options,
    )
    assert [c.frames for c in checkpoints] == list(range(1, 12))
    checkpoint = load_checkpoint(tmp_path / f"{stop}.npz", case_sha256="abc")
    frames = [whole.frame(i) for i in range(stop)]
    again = fyke.simulate(framed(damping_time=2e-5), resume=(checkpoint, frames), **options)
    for name in ARRAYS:
        assert getattr(again, name).tobytes() == getattr(whole, name).tobytes(), name
    assert again.outcome.iterations == whole.outcome.iterations
    assert again.outcome.factorizations == whole.outcome.factorizations


def fyke_run(folder, *options):
    command = [sys.executable, "-m", "fyke", "run", "case.toml", "-o", "out", "--no-figures", *options]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.parametrize("stepper", ["implicit", "verner"])
def test_a_killed_run_goes_on_with_the_same_bits(tmp_path, stepper):
    text = CASE.replace('stepper = "symplectic"', f'stepper = "{stepper}"').replace(
        "every = 0.01", "every = 0.001"
    )
    text = text.replace("duration = 2.0", "duration = 0.3").replace("settle_force", "# settle_force")
    (tmp_path / "case.toml").write_text(text)
    whole = fyke_run(tmp_path)
    assert whole.wait(120) == 0, whole.stderr.read()
    assert not (tmp_path / "out" / "checkpoint.npz").exists()
    expected = load(tmp_path / "out" / "result.nc")
    shutil.rmtree(tmp_path / "out")
    killed = fyke_run(tmp_path)
    while killed.poll() is None and not _frames(tmp_path / "out") > 20:
        time.sleep(0.002)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert 20 < _frames(tmp_path / "out") < 301
    resumed = fyke_run(tmp_path, "--resume")
    assert resumed.wait(120) == 0, resumed.stderr.read()
    found = load(tmp_path / "out" / "result.nc")
    for name in ARRAYS:
        assert getattr(found, name).tobytes() == getattr(expected, name).tobytes(), name
    assert found.outcome.name == "completed"


def _frames(folder):
    """Outputs that the last checkpoint knows of."""
    try:
        with np.load(folder / "checkpoint.npz") as file:
            return int(file["frames"])
    except FileNotFoundError:
        return 0


def test_what_cannot_be_resumed_is_said(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    process = fyke_run(tmp_path, "--resume")
    _, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "there is no checkpoint" in " ".join(said.split()) and "Traceback" not in said
    (tmp_path / "case.toml").write_text(CASE.split("[solve]")[0])
    process = fyke_run(tmp_path, "--resume")
    _, said = process.communicate(timeout=60)
    assert process.returncode == 2 and "a static case" in said


def test_damaged_and_foreign_checkpoints(framed, tmp_path):
    path = tmp_path / "checkpoint.npz"
    kept = []
    fyke.simulate(framed(), duration=0.001, every=0.001, on_checkpoint=kept.append)
    save_checkpoint(path, kept[-1], case_sha256="abc")
    with pytest.raises(CheckpointError, match="another case"):
        load_checkpoint(path, case_sha256="abd")
    whole = path.read_bytes()
    for end in (0, 10, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:end])
        with pytest.raises(CheckpointError, match="cannot be read"):
            load_checkpoint(path, case_sha256="abc")
