"""fyke validate: run every claim of a folder and say which hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.text import Text

from ..case import CaseError, Problem
from ..case.keys import nearest
from ..report.verdicts import write_page
from ..results import finite_or_none
from ..results.whole import replacing
from ..study.claims import LEVELS, claims_in
from ..study.text import alike, levels_of, markdown, summary_line, worst_of
from ..study.validate import Judged, Report, validate
from ..version import __version__
from .progress import progress_bar
from .show import DONE, NOT_CONVERGED, WRONG_INPUT, print_json, print_problems, stderr, stdout

COLOURS = {"holds": "green", "fails": "red", "missing": "yellow", "shown": "dim"}
# Columns of the table on a terminal: what it is about, and the widths of the numbers.
NUMBERS = 12


@dataclass(frozen=True)
class Wishes:
    """Options of the command.

    only: names of claims, all when empty; jobs: so many at a time; every: print every row instead of the worst of those
    alike.
    """

    only: tuple[str, ...]
    fast: bool
    jobs: int
    every: bool
    json: bool
    write: bool


def validate_folder(folder: Path, wishes: Wishes) -> int:
    """Run the claims of a folder, write what was found there and return the exit code."""
    try:
        files = _chosen(claims_in(folder), wishes.only)
    except CaseError as error:
        print_problems(error.problems)
        return WRONG_INPUT
    with progress_bar(stderr(), shown=not wishes.json, doing="validating") as show:
        report = validate(
            files,
            fast=wishes.fast,
            jobs=wishes.jobs,
            draw=wishes.write and not wishes.only,
            on_progress=lambda done, of, name: show(done / of, name),
        )
    written = _write(folder, report, wishes) if wishes.write and not wishes.only else []
    if wishes.json:
        print_json(
            {
                "ok": report.ok,
                "rows": [finite_or_none(asdict(row)) for row in report.rows],
                "seconds": report.seconds,
            }
        )
    else:
        _show(stdout(), report, written, every=wishes.every)
    return DONE if report.ok else NOT_CONVERGED


def _chosen(files: list[Path], only: tuple[str, ...]) -> list[Path]:
    names = {file.stem: file for file in files}
    problems = []
    for name in only:
        if name not in names:
            near = nearest(name, list(names))
            cure = f"did you mean '{near}'?" if near else "take one of these"
            problems.append(Problem("--only", f"'{name}'", ", ".join(names), cure))
    if problems:
        raise CaseError(problems)
    return [names[name] for name in only] or files


def _write(folder: Path, report: Report, wishes: Wishes) -> list[Path]:
    """Write the page, and REPORT.md where the whole set was run."""
    command = "fyke validate --fast" if wishes.fast else "fyke validate"
    text, page = folder / "REPORT.md", folder / "report.html"
    write_page(page, levels_of(report), title=summary_line(report), command=command)
    if wishes.fast:
        return [page]
    with replacing(text) as part:
        part.write_text(markdown(report, version=__version__, command=command), encoding="utf-8")
    return [text, page]


def _show(console: Console, report: Report, written: list[Path], *, every: bool) -> None:
    for level, title in LEVELS.items():
        rows = [row for row in report.rows if row.level == level]
        if rows:
            console.print(Text(title, style="bold"))
            console.print(Text(_line(("ours", "reference", "off", "allowed")), style="dim"))
            for some in [[row] for row in rows] if every else alike(rows):
                _show_rows(console, some)
    console.print(Text(f"\n{summary_line(report)}."))
    slowest = max(report.seconds, key=lambda name: report.seconds[name], default="")
    if slowest:
        whole = sum(report.seconds.values())
        told = f"{whole:.0f} s of work, {report.seconds[slowest]:.0f} s of it {slowest}"
        console.print(Text(told, style="dim"))
    for path in written:
        console.print(Text(f"wrote {path}", style="dim"), soft_wrap=True)


def _show_rows(console: Console, rows: list[Judged]) -> None:
    """Print the first of rows that are alike."""
    row = rows[0]
    where = worst_of(rows)
    what = f"{row.claim}, {row.quantity}{f' ({row.unit})' if row.unit else ''}{f', {where}' if where else ''}"
    console.print(Text(f"  {what}", overflow="ellipsis", no_wrap=True))
    percent = 100.0 if row.relative else 1.0
    off = (None if value is None else percent * value for value in (row.difference, row.tolerance))
    numbers = ["" if value is None else f"{value:.6g}" for value in (row.ours, row.reference)]
    numbers += ["" if value is None else f"{value:+.2g}" for value in off]
    numbers = [
        number + " %" if place > 1 and row.relative and number else number
        for place, number in enumerate(numbers)
    ]
    numbers[3] = numbers[3].removeprefix("+")
    console.print(Text(_line(numbers)), Text(row.verdict, style=COLOURS[row.verdict]))
    if row.verdict == "fails":
        console.print(Text(" ".join(row.reason.split()), style="dim"))


def _line(numbers: Sequence[str]) -> str:
    return " " * 6 + "".join(f"{number:>{NUMBERS}} " for number in numbers)
