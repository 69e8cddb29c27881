"""Films: what is to be seen on their pictures, how long they last, and what is said when there can be none."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.forces.frame import Frame
from fyke.report import movie
from fyke.report.movie import MovieError, Reel, Stage, at_time, write_movie

OUTCOME = fyke.Outcome("completed", "", "", "by hand", "", 1, 1, 0.0, 0.0)
SIZE = (480, 270)


def swinging(frames: int = 5, every: float = 0.25) -> fyke.Result:
    """A string of two bars, 1 m each, whose lower end moves 0.8 m to +y; only the upper bar is taut."""
    twine = fyke.Twine("main", 1140.0, 5e-2, fyke.LinearLaw(1e7))
    net = fyke.line(twine, [[0, 0, 0], [0, 0, -1.0], [0, 0, -2.0]], 1.0, fixed=(0,))
    told = []
    for k in range(frames):
        at = net.positions + np.outer([0.0, 0.4, 0.8], [0.0, 1.0, 0.0]) * k / max(frames - 1, 1)
        pull, still, rest = np.array([1.0 + k, 0.0]), np.zeros(2), np.zeros((3, 3))
        told.append(
            Frame(every * k, at, rest, pull, still, still, rest[:2], rest, np.zeros(3), np.zeros(3), 0.0, 0.0)
        )
    return fyke.Result.from_frames(net, OUTCOME, 0.0, told)


@pytest.fixture
def machinery():
    """What a film needs, on a machine that can draw without a screen."""
    for name in ("pyvista", "imageio", "imageio_ffmpeg"):
        pytest.importorskip(name, reason=f"a film needs {name}: pip install 'fyke[movie]'")


@pytest.mark.parametrize(
    ("reel", "count", "last"),
    [(Reel(), 26, 1.0), (Reel(speed=0.5), 51, 1.0), (Reel(fps=10.0, speed=3.0), 4, 0.9)],
)
def test_a_film_runs_in_real_time_unless_told_otherwise(reel, count, last):
    moments = reel.moments(swinging())
    assert len(moments) == count and moments[-1] == pytest.approx(last)
    assert np.diff(moments) == pytest.approx(reel.speed / reel.fps)


def test_between_two_outputs_a_knot_goes_straight():
    moment = at_time(swinging(), 0.375)  # half way from the second output to the third
    assert moment.time.tolist() == [0.375]
    assert moment.position[0][2] == pytest.approx([0.0, 0.3, -2.0]) and moment.tension[0][0] == pytest.approx(
        2.5
    )
    assert at_time(swinging(), 1.0).position[0][2] == pytest.approx([0.0, 0.8, -2.0])


def painted(picture: np.ndarray, colour: tuple[int, int, int], slip: int = 12) -> np.ndarray:
    """Rows and columns (k, 2) of the pixels that have a colour."""
    return np.argwhere(np.all(np.abs(picture.astype(int) - colour) <= slip, axis=2))


def test_a_picture_shows_every_bar_where_it_is_in_its_colour(machinery):
    result = swinging()
    stage = Stage(result, Reel(size=SIZE))
    first, last = stage.picture(0.0), stage.picture(1.0)
    assert first.shape == (SIZE[1], SIZE[0], 3) and first.dtype == np.uint8
    net = (slice(None), slice(int(0.1 * SIZE[0]), int(0.8 * SIZE[0])))  # without colours and scale
    grey = painted(last[net], (0x8C, 0x8C, 0x8C), 2)
    dark = painted(last[net], (68, 1, 84))  # viridis' darkest, the largest tension of the run
    pale = painted(first[net], (68, 1, 84))
    assert len(grey) > 50 and len(dark) > 50 and not len(pale)
    # The slack bar hangs below the taut one: 1 m down, seen under 20 deg, and 0.4 m to +y, 40 deg off the line of
    # sight and away from the eye, which is seen as higher.
    assert grey[:, 0].min() > dark[:, 0].max() - 5
    tall = np.cos(np.deg2rad(20.0)) - 0.4 * np.sin(np.deg2rad(40.0)) * np.sin(np.deg2rad(20.0))
    assert np.ptp(grey[:, 0]) * stage.metres == pytest.approx(tall, rel=0.03)
    stage.close()


def test_the_scale_is_as_long_as_it_says(machinery, monkeypatch):
    said = []
    real = movie._drawn

    def listening(figure):
        said.extend(text.get_text() for text in figure.findobj(match=lambda a: hasattr(a, "get_text")))
        return real(figure)

    monkeypatch.setattr(movie, "_drawn", listening)
    stage = Stage(swinging(), Reel(size=(960, 540)))
    picture = stage.picture(0.5)
    (length,) = (float(text.split()[0]) for text in said if re.fullmatch(r"[\d.]+ m", text))
    corner = picture[int(0.93 * 540) :, :480]
    columns = np.argwhere(corner.max(axis=2) < 200)[:, 1]
    assert np.ptp(columns) * stage.metres == pytest.approx(length, rel=0.02)
    assert "t = 0.50 s" in said and "Bar tension (N)" in said
    stage.close()


@pytest.mark.parametrize("ending", [".mp4", ".gif"])
def test_a_film_has_all_its_pictures(ending, machinery, tmp_path):
    import imageio.v2 as imageio

    file = write_movie(swinging(), tmp_path / f"film{ending}", Reel(fps=5.0, size=(160, 96)))
    assert [one.name for one in tmp_path.iterdir()] == [file.name]
    with imageio.get_reader(file) as film:
        pictures = [film.get_data(k) for k in range(6)]
        assert film.count_frames() == 6 if ending == ".mp4" else len(film) == 6
        if ending == ".mp4":
            assert film.get_meta_data()["fps"] == 5.0
    assert pictures[0].shape[:2] == (96, 160)
    assert np.abs(pictures[0][..., :3].astype(int) - pictures[5][..., :3]).max() > 100


def test_a_film_without_what_it_needs_says_how_to_get_it(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(MovieError, match=r"pyvista: pip install 'fyke\[movie\]'"):
        write_movie(swinging(), tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a renderer")
def test_without_a_renderer_a_film_ends_in_a_sentence(machinery, monkeypatch, tmp_path):
    # A kind of window that this VTK has no library for, in most places; where it has, there is nothing to say.
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    draws = (
        subprocess.run([sys.executable, "-c", movie.PROBE], capture_output=True, check=False).returncode == 0
    )
    movie._check_drawing.cache_clear()
    try:
        if draws:
            movie._check_drawing()
        else:
            with pytest.raises(MovieError, match="VTK can draw nothing here"):
                write_movie(swinging(2), tmp_path / "film.mp4")
    finally:
        movie._check_drawing.cache_clear()
    assert not list(tmp_path.iterdir())


def test_a_film_that_the_disk_cut_off_is_no_film(machinery, monkeypatch, tmp_path):
    monkeypatch.setattr(
        movie, "_needed", lambda name: SimpleNamespace(count_frames_and_secs=lambda file: (3, 0.1))
    )
    with pytest.raises(OSError, match="3 of 6 pictures"):
        movie._check_whole(tmp_path / "film.mp4", 6)


def call(*words: object):
    return CliRunner().invoke(app, ["movie", *map(str, words)])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("static.nc",), "fyke report"),
        (("run.nc", "-o", "film.avi"), ".mp4, .gif"),
        (("run.nc", "-o", "there.mp4"), "--overwrite"),
        (("run.nc", "--size", "wide"), "1280x720"),
        (("run.nc", "--size", "161x90"), "even"),
        (("run.nc", "--fps", "0"), "--fps"),
        (("run.nc", "--speed", "nan"), "--speed"),
        (("run.nc", "--colour", "taste"), "tension, strain"),
        (("none.nc",), "no such file"),
        (("run.nc", "-o", "no/such/film.mp4"), "The directory does not exist"),
    ],
)
def test_what_is_wrong_is_told_in_place_of_a_traceback(words, said, machinery, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fyke.save(swinging(), "run.nc")
    fyke.save(swinging(1), "static.nc")
    Path("there.mp4").write_text("a film")
    done = call(*words)
    assert done.exit_code == 2 and said in done.stderr and "Traceback" not in done.output
    assert {one.name for one in tmp_path.iterdir()} == {"run.nc", "static.nc", "there.mp4"}


def test_the_command_makes_a_film_beside_the_result(machinery, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fyke.save(swinging(3, every=0.1), "result.nc")
    done = call(".", "--size", "160x90", "--fps", "10")
    assert done.exit_code == 0, done.output
    assert Path("movie.mp4").stat().st_size > 1000
    assert "3 pictures" in done.stdout and "--speed" in done.stdout  # short: the hint how to slow it down
