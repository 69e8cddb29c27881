"""fyke movie: a film of a dynamic run."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from ..case import Problem
from ..results import ResultError
from .export import opened, taken, unwritten, whole
from .progress import progress_bar
from .show import DONE, WRONG_INPUT, print_problems, print_warnings, stderr, stdout

SHORTEST = 2.0  # s of a film in real time, below which a slower one is worth a hint
SMALLEST, LARGEST = 16, 8192  # pixels of a side


@dataclass(frozen=True)
class Film:
    """The options of the command."""

    output: Path | None
    fps: float
    speed: float
    size: str
    colour: str
    overwrite: bool


def film_result(file: Path, film: Film) -> int:
    """Make a film of a result, given as its file or the folder of its run, and return the exit code."""
    from ..report.colours import QuantityError
    from ..report.movie import MovieError, Reel, write_movie

    problems = _wrong(film)
    if problems:
        print_problems(problems)
        return WRONG_INPUT
    wide, tall = _sides(film.size)
    reel = Reel(film.fps, film.speed, (wide, tall), film.colour)
    target = film.output
    try:
        source, result = opened(file)
        moments = reel.moments(result)
        target = film.output or source.with_name("movie.mp4")
        problem = taken(target, source, overwrite=film.overwrite)
        if problem is not None:
            print_problems([problem])
            return WRONG_INPUT
        with progress_bar(stderr(), shown=True, doing="filming") as report:
            write_movie(
                result,
                target,
                reel,
                on_progress=lambda share: report(share, f"{len(moments)} pictures"),
            )
    except (ResultError, MovieError, QuantityError) as error:
        stderr().print(str(error), soft_wrap=True)
        return WRONG_INPUT
    except OSError as error:
        print_problems([unwritten(target or file, error)])
        return WRONG_INPUT
    lasts = len(moments) / film.fps
    hints = [f"the film lasts {lasts:.2g} s: --speed {film.speed * lasts / 10:.1g} makes some 10 s of it"]
    print_warnings(stdout(), whole(result) + (hints if lasts < SHORTEST else []))
    size = target.stat().st_size / 1e6
    text = (
        f"{target}: {len(moments)} pictures, {lasts:.3g} s at {film.speed:g} times real time, {size:.2g} MB"
    )
    stdout().print(text, soft_wrap=True)
    return DONE


def _sides(size: str) -> tuple[int, ...]:
    """Width and height in pixels, nothing where the text does not say so."""
    found = re.fullmatch(r"(\d{2,4})x(\d{2,4})", size)
    sides = tuple(map(int, found.groups())) if found else ()
    return sides if all(SMALLEST <= side <= LARGEST for side in sides) else ()


def _wrong(film: Film) -> list[Problem]:
    problems = []
    for name, value in (("--fps", film.fps), ("--speed", film.speed)):
        if not 0.0 < value < float("inf"):
            problems.append(Problem(name, f"{value:g}", "a number above 0", "give one, as 25 or 0.5"))
    if not _sides(film.size):
        allowed = f"width x height in pixels, each from {SMALLEST} to {LARGEST}"
        problems.append(Problem("--size", film.size, allowed, "write it as 1280x720"))
    return problems
