"""Load cases of a run: each solved after the file's own water, from the shape before, in a folder of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from rich.console import Console
from rich.text import Text

from ..case import Case, CaseError, Problem, folder_of, load_cases_of
from ..results import LoadRow, load_row, worst_of
from ..solve.clock import Clock, timed
from ..solve.result import Result
from ..system.build import build_system
from ..system.system import State, System
from .folder import LOAD_CASES, LOAD_CURVES, claim
from .show import complain, stderr

NAME_WIDTH = 12
# Forces of this size (N) and more are shown in kN.
LARGE = 1e4


@dataclass(frozen=True)
class Wishes:
    """The options of a run; output: folder to write to, None for the case's name."""

    output: Path | None = None
    figures: bool = True
    overwrite: bool = False
    resume: bool = False
    quiet: bool = False
    json: bool = False

    @property
    def talk(self) -> bool:
        """Whether to print for a reader."""
        return not (self.quiet or self.json)


@dataclass(frozen=True)
class Done:
    """A case that was solved and written: its result, its summary and the pictures of it."""

    result: Result
    figures: dict[str, Any]
    pictures: list[Path]


class SolveAndWrite(Protocol):
    """What solves one case and writes all that there is of it into a folder."""

    def __call__(
        self,
        case: Case,
        system: System,
        folder: Path,
        wishes: Wishes,
        clock: Clock,
        *,
        start: State | None = None,
    ) -> Done:
        """Do it; start: of a static solve."""


def refuse_load_cases(case: Case, folder: Path) -> None:
    """Raise CaseError for a case file with load cases, which cannot be resumed as a whole."""
    if case.load_case:
        cure = (
            'resume the one that was stopped: write chosen_load_case = "NAME" in the file, and -o its folder'
        )
        where = f"--resume in {folder}"
        raise CaseError([Problem(where, "a case file with load cases", "one case that was stopped", cure)])


def claim_load_cases(case: Case, folder: Path, wishes: Wishes) -> None:
    """Make the folders of the load cases ready; CaseError where one cannot be."""
    for _, name, _ in load_cases_of(case):
        claim(folder / LOAD_CASES / folder_of(name), overwrite=wishes.overwrite)


def run_load_cases(
    case: Case, system: System, done: Done, folder: Path, wishes: Wishes, solve: SolveAndWrite
) -> list[LoadRow]:
    """Solve the load cases one after the other and return their rows; fewer when stopped by hand.

    Nothing is done after a run of the file's own water that was stopped. A static load case begins at the shape of the
    last that converged.
    """
    rows: list[LoadRow] = []
    last = done.result
    for spec, name, one in load_cases_of(case):
        if last.outcome.name == "interrupted":
            break
        if wishes.talk:
            stderr().print(Text(f"load case {len(rows) + 1} of {len(case.load_case)}: {name}", style="dim"))
        began = done.result.state() if done.result.outcome.ok else None
        with timed("forces"), Clock("starting") as clock:
            own = build_system(system.net, one)
            made = solve(one, own, folder / LOAD_CASES / folder_of(name), wishes, clock, start=began)
        last = made.result
        if last.outcome.ok:
            done = made
        else:
            complain(last.outcome, name)
        factors = {"load_factor": spec.load_factor, "material_factor": spec.material_factor}
        rows.append(load_row(name, own, last, made.figures, **factors))
    return rows


def draw_loads(rows: Sequence[LoadRow], folder: Path) -> list[Path]:
    """Draw drag and volume against the speed of the current where there are enough speeds; return the files."""
    from ..report.figures import write_figure
    from ..report.loads import load_curves

    figure = load_curves(rows)
    return [] if figure is None else write_figure(figure, folder / LOAD_CURVES)


def print_loads(console: Console, rows: Sequence[LoadRow]) -> None:
    """Print the load cases as a table of at most 80 columns, the worst one marked."""
    if not rows:
        return
    forces = [row.support_force for row in rows] + [row.tension for row in rows]
    unit, size = ("kN", 1e3) if max(forces) >= LARGE else ("N", 1.0)
    seas = any(row.wave_height is not None for row in rows)
    moored = any(row.mooring_tension is not None for row in rows)
    afloat = any(row.collar_force is not None for row in rows)
    heads: list[tuple[str, str, int]] = [
        ("load case", "", NAME_WIDTH),
        ("current", "m/s", 7),
        ("to", "deg", 4),
    ]
    heads += [("wave", "m", 5), ("period", "s", 6)] if seas else []
    heads += [("collar" if afloat else "support", unit, 7)] + ([("mooring", unit, 7)] if moored else [])
    heads += [("tension", unit, 7), ("used", "%", 5), ("volume", "%", 6), ("moved", "m", 5)]
    console.print(Text("Load cases", style="bold"))
    for which in (0, 1):
        titles = [(units if which else title, width) for title, units, width in heads]
        console.print(Text("  " + _line(titles), style="dim"))
    worst = worst_of(rows)
    for i, row in enumerate(rows):
        cells = [row.name[:NAME_WIDTH], _number(row.current, 3), _number(row.towards, 3)]
        cells += [_number(row.wave_height, 3), _number(row.wave_period, 3)] if seas else []
        cells += [_number(_over(row.collar_force if afloat else row.support_force, size))]
        cells += [_number(_over(row.mooring_tension, size))] if moored else []
        cells += [_number(row.tension / size), _number(_over(row.utilisation, 0.01), 3)]
        cells += [_number(_over(row.volume_left, 0.01), 3), _number(row.displacement, 3)]
        line = _line([(cell, head[2]) for cell, head in zip(cells, heads, strict=True)])
        end = "" if row.ok else f"  {row.outcome}"
        console.print(Text(("* " if i == worst else "  ") + line + end), soft_wrap=True)
    console.print(
        Text("* the worst; all digits, and every part, in loads.csv and loads_by_part.csv", style="dim")
    )


def _line(cells: Sequence[tuple[str, int]]) -> str:
    (first, wide), *rest = cells
    return " ".join([f"{first:<{wide}}", *(f"{text:>{width}}" for text, width in rest)]).rstrip()


def _number(value: float | None, digits: int = 4) -> str:
    return "-" if value is None else f"{value:.{digits}g}"


def _over(value: float | None, size: float) -> float | None:
    return None if value is None else value / size
