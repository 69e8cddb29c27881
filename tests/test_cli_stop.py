"""Runs that are stopped, and the progress bar."""

import io
import json
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray
from rich.console import Console
from typer.testing import CliRunner

from fyke.cli.app import app
from fyke.cli.progress import progress_bar
from fyke.results import load

PANEL = Path(__file__).parents[1] / "examples" / "panel.toml"
LONG = 'kind = "dynamic"\nduration = 1000\n[output]\nevery = 0.002'


@pytest.fixture
def running(tmp_path):
    """A dynamic run that takes hours, in another process, with a few outputs on disk."""
    text = PANEL.read_text().replace("[8, 8]", "[2, 2]").replace("0.3055", "0.076")
    (tmp_path / "long.toml").write_text(text.replace('kind = "static"', LONG))
    # Who runs the tests in the background has Ctrl-C ignored, and so have all their processes.
    heed = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    command = [sys.executable, "-c", f"{heed}; from fyke.cli import main; main()", "run", "long.toml"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    file = tmp_path / "long" / "result.nc"
    until = time.monotonic() + 60
    while time.monotonic() < until and process.poll() is None:
        if file.exists() and len(load(file).time) > 3:
            break
        time.sleep(0.05)
    yield process, tmp_path / "long"
    if process.poll() is None:
        process.kill()
    process.wait()
    process.stderr.close()


def test_interrupted_run_saves_what_it_has(running):
    process, folder = running
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=120) == 1
    told = process.stderr.read()
    assert "interrupted" in told and "Traceback" not in told
    assert json.loads((folder / "summary.json").read_text())["outcome"] == "interrupted"
    assert (folder / "knots.csv").exists() and (folder / "bars.csv").exists()
    result = load(folder / "result.nc")
    assert result.outcome.name == "interrupted" and len(result.time) > 3


def test_killed_run_leaves_a_readable_file(running):
    process, folder = running
    process.kill()
    process.wait()
    result = load(folder / "result.nc")
    assert result.outcome.name == "interrupted" and len(result.time) > 3
    with xarray.open_dataset(folder / "result.nc") as data:
        assert data.position.sel(time=result.time[-1]).notnull().all()


def test_progress_is_drawn_on_a_terminal_with_the_time_left():
    screen = io.StringIO()
    console = Console(file=screen, force_terminal=True, width=80)
    with progress_bar(console, shown=True) as report:
        report(0.25, "t = 1 s")
    assert "25%" in screen.getvalue() and "t = 1 s" in screen.getvalue() and ":" in screen.getvalue()


@pytest.mark.parametrize(("terminal", "shown"), [(False, True), (True, False)])
def test_progress_is_off_elsewhere_and_when_not_wanted(terminal, shown):
    screen = io.StringIO()
    with progress_bar(Console(file=screen, force_terminal=terminal, width=80), shown=shown) as report:
        report(0.25, "t = 1 s")
    assert screen.getvalue().strip() == ""


def test_run_stopped_before_its_first_output_keeps_the_net_as_built(tmp_path, monkeypatch):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("fyke.cli.run.solve_case", stopped)
    done = CliRunner().invoke(app, ["run", str(PANEL), "-o", str(tmp_path / "out"), "--no-figures"])
    assert done.exit_code == 1 and "interrupted" in done.stderr
    result = load(tmp_path / "out" / "result.nc")
    assert result.outcome.name == "interrupted"
    assert (result.position[-1] == result.net.positions).all()


FLOOR = {
    "implicit": 'stepper = "implicit"\nmax_step = 1e-12',
    "verner": 'stepper = "verner"\nmax_step = 1e-15',
}


@pytest.mark.parametrize("stepper", FLOOR)
def test_a_step_at_its_floor_is_told_and_the_last_good_state_saved(tmp_path, stepper):
    text = PANEL.read_text().replace('kind = "static"', f'kind = "dynamic"\nduration = 1\n{FLOOR[stepper]}')
    (tmp_path / "floor.toml").write_text(text)
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["run", str(tmp_path / "floor.toml"), "-o", str(out), "--no-figures"])
    assert done.exit_code == 1
    assert (
        "step_too_small: the step fell to" in " ".join(done.stderr.split()) and "loosen rtol" in done.stderr
    )
    assert json.loads((out / "summary.json").read_text())["outcome"] == "step_too_small"
    result = load(out / "result.nc")
    assert result.outcome.name == "step_too_small"
    assert (result.position[-1] == result.net.positions).all()


@pytest.mark.parametrize(("kind", "size"), [("static", 3_000), ("static", 60_000), ("dynamic", 200_000)])
def test_a_full_disk_is_told_in_one_sentence(tmp_path, kind, size):
    """No file may grow beyond so many bytes, which stops a write as a full disk does."""
    (tmp_path / "full.toml").write_text(
        PANEL.read_text().replace('kind = "static"', 'kind = "dynamic"\nduration = 0.1')
        if kind == "dynamic"
        else PANEL.read_text()
    )
    command = [sys.executable, "-m", "fyke", "run", "full.toml", "--no-figures"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)),
    )
    assert done.returncode == 1, done.stderr
    assert "File too large" in done.stderr and "Traceback" not in done.stderr
    assert "free the disk" in done.stderr
    assert not list((tmp_path / "full").glob(".*.part"))


def test_more_outputs_than_memory_are_refused_before_anything_is_touched(tmp_path):
    """A million outputs of 10 000 knots and 20 000 bars, some 1.5 MB each."""
    text = PANEL.read_text().replace("[8, 8]", "[70, 70]").replace("0.3055", "2.67")
    text = text.replace('kind = "static"', 'kind = "dynamic"\nduration = 1000\n[output]\nevery = 0.001')
    (tmp_path / "many.toml").write_text(text)
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["run", str(tmp_path / "many.toml"), "-o", str(out)])
    assert done.exit_code == 2 and not out.exists()
    told = " ".join(done.stderr.split())
    assert "1,000,001 outputs of this net, which take" in told and "GB of" in told and "larger every" in told
