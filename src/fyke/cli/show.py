"""What the command line prints: tables of at most 80 columns on stdout, errors on stderr."""

from __future__ import annotations

import json
import sys
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.text import Text

from ..case.errors import Problem
from ..solve.outcome import Outcome

WIDTH = 80
DONE, NOT_CONVERGED, WRONG_INPUT = 0, 1, 2  # the exit codes


def stdout() -> Console:
    """Return the console of results."""
    return _console(stderr=False)


def stderr() -> Console:
    """Return the console of errors and progress."""
    return _console(stderr=True)


def _console(*, stderr: bool) -> Console:
    console = Console(stderr=stderr, markup=False, highlight=False, emoji=False)
    console.width = min(console.width, WIDTH)
    return console


def print_json(content: Mapping[str, Any]) -> None:
    """Print JSON on stdout, every number with all its digits."""
    json.dump(content, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
    sys.stdout.write("\n")


def print_rows(console: Console, title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print a title and two columns, what and how much."""
    console.print(Text(title, style="bold"))
    wide = max(len(what) for what, _ in rows)
    for what, value in rows:
        first, *more = textwrap.wrap(value, console.width - wide - 4) or [""]
        console.print(Text.assemble((f"  {what:<{wide}}  ", "dim"), first))
        for line in more:
            console.print(Text(" " * (wide + 4) + line))


def print_warnings(console: Console, warnings: Sequence[str]) -> None:
    """Print one paragraph for every warning."""
    for warning in warnings:
        console.print(Text.assemble(("warning: ", "yellow"), warning))


def print_problems(problems: Sequence[Problem]) -> None:
    """Print every problem on stderr, with a count when there are several."""
    console = stderr()
    if len(problems) > 1:
        console.print(Text(f"{len(problems)} problems:\n", style="red"))
    for number, problem in enumerate(problems):
        console.print(Text("\n" * (number > 0) + str(problem)), soft_wrap=True)


def complain(outcome: Outcome, of: str = "") -> None:
    """Print on stderr how a solve failed and what to do about it; of: the name of its load case."""
    text = f"{outcome.name}: {outcome.message}\n{outcome.advice}".rstrip()
    stderr().print(Text(f"load case {of}: {text}" if of else text))


def problems_as_json(problems: Sequence[Problem]) -> dict[str, Any]:
    """Return problems for other programs to read."""
    return {"problems": [asdict(problem) for problem in problems]}


def quantity(value: float | None, unit: str, digits: int = 4) -> str:
    """Write a number with its unit; a dash where there is none."""
    return "-" if value is None else f"{value:.{digits}g} {unit}".rstrip()


def percent(share: float) -> str:
    """Write a share in percent, two decimals; what rounds to nothing has no sign."""
    return f"{share * 100:z.2f} %"


def vector(values: Sequence[float], unit: str) -> str:
    """Write a vector with its unit; what is only rounding beside its largest component is 0."""
    rounding = 1e-9 * max(map(abs, values))
    return "[" + ", ".join(f"{value if abs(value) > rounding else 0.0:.4g}" for value in values) + f"] {unit}"
