"""fyke run: from a case file to a folder with result, tables and figures."""

from __future__ import annotations

import math
import os
import sys
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from rich.text import Text

from ..case import Case, CaseError, Problem, load_case
from ..forces.evaluate import evaluate
from ..forces.frame import Frame
from ..results import (
    Comparison,
    MeasurementError,
    Recorder,
    audit,
    compare,
    load,
    save,
    save_checkpoint,
    summary,
    write_summary,
    write_tables,
)
from ..solve.dynamic import Checkpoint
from ..solve.outcome import Outcome
from ..solve.result import Result
from ..solve.run import needs_compiling, planned_frames, solve_case
from ..system.build import build_net, build_system
from ..system.system import System
from .folder import BARS, CHECKPOINT, KNOTS, RESULT, SUMMARY, claim, stopped
from .progress import progress_bar
from .show import (
    DONE,
    NOT_CONVERGED,
    WRONG_INPUT,
    print_json,
    print_problems,
    print_rows,
    print_warnings,
    quantity,
    stderr,
    stdout,
    vector,
)

Stopped = tuple[Checkpoint, list[Frame]]


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


def run_case(file: Path, wishes: Wishes) -> int:
    """Run a case file and return the exit code."""
    folder = wishes.output or Path(file.stem)
    try:
        case = load_case(file)
        if wishes.talk and needs_compiling(case):
            stderr().print("First run of this kind: compiling the kernels, some ten seconds, once.")
        system = build_system(build_net(case), case)
        if case.positions_file:
            # A fault of this file is told before the solve, and before an old result is taken away.
            compare(_as_built(case, system), case.positions_file)
        resume = stopped(folder, case) if wishes.resume else None
        if resume is None:
            claim(folder, overwrite=wishes.overwrite)
        return _run(case, system, folder, wishes, resume)
    except (CaseError, MeasurementError) as error:
        print_problems(error.problems)
    except BrokenPipeError:
        # Who read the output has gone, as `head` does; the files are written. Python would complain again at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except OSError as error:
        found, cure = error.strerror or str(error), "free the disk, or choose another folder with -o DIR"
        print_problems([Problem(f"output folder {folder}", found, "a folder that can be written", cure)])
    return WRONG_INPUT


def _run(case: Case, system: System, folder: Path, wishes: Wishes, resume: Stopped | None) -> int:
    result = _solve(case, system, folder, wishes, resume)
    comparison = compare(result, case.positions_file) if case.positions_file else None
    figures = _figures_of(case, system, result, comparison)
    write_tables(result, folder)
    write_summary(figures, folder)
    pictures = _draw(case, result, folder, comparison) if wishes.figures else []
    if wishes.json:
        print_json(figures)
    elif wishes.talk:
        _show(case, figures, pictures, folder)
    if result.outcome.ok:
        return DONE
    stderr().print(Text(f"{result.outcome.name}: {result.outcome.message}\n{result.outcome.advice}".rstrip()))
    return NOT_CONVERGED


def _solve(case: Case, system: System, folder: Path, wishes: Wishes, resume: Stopped | None) -> Result:
    """Solve a case, with every output and a checkpoint on disk as it comes, and leave the whole result in the file."""
    file, times, weight = folder / RESULT, planned_frames(case), system.weight_in_water
    keep = partial(save_checkpoint, folder / CHECKPOINT, case_sha256=case.sha256)
    frames = resume[1] if resume else ()
    with (
        Recorder(
            file, system.net, times=times, weight_in_water=weight, case_text=case.text, frames=frames
        ) as recorder,
        progress_bar(stderr(), shown=wishes.talk) as report,
    ):
        try:
            result = solve_case(
                system, case, on_frame=recorder.append, on_progress=report, on_checkpoint=keep, resume=resume
            )
        except KeyboardInterrupt:
            recorder.close()
            result = load(file) if file.is_file() else _as_built(case, system)
            save(result, file)
        else:
            recorder.finish(result)
    if result.outcome.name != "interrupted":
        (folder / CHECKPOINT).unlink(missing_ok=True)
    return result


def _as_built(case: Case, system: System) -> Result:
    """Return the net at rest as it was built, which is all there is of a run stopped before its first output."""
    frame = evaluate(system, system.at_rest())
    outcome = Outcome(
        name="interrupted",
        message="stopped before the first output; the net is shown as it was built",
        advice="run the case again",
        solver="",
        linear_solver="",
        iterations=0,
        factorizations=0,
        residual=frame.unbalanced_force,
        wall_time=0.0,
    )
    return Result.from_frames(system.net, outcome, system.weight_in_water, [frame], case.text)


def _figures_of(case: Case, system: System, result: Result, comparison: Comparison | None) -> dict[str, Any]:
    figures = summary(
        result,
        title=case.title,
        case_sha256=case.sha256,
        current_direction=case.current.velocity,
        audit=audit(system, result),
    )
    figures["damping_time"] = float(system.elements.damping_time.max(initial=0.0))
    figures["warnings"] = list(dict.fromkeys([*case.warnings, *result.outcome.warnings]))
    if comparison is not None:
        figures["measured_knots"] = len(comparison.labels)
        figures["measured_rms"] = comparison.rms
        figures["measured_largest"] = comparison.largest
        figures["measured_largest_knot"] = comparison.largest_label
    return figures


def _draw(case: Case, result: Result, folder: Path, comparison: Comparison | None) -> list[Path]:
    from ..report.figures import draw_all

    return draw_all(result, folder, comparison=comparison, current=case.current.velocity)


def _show(case: Case, figures: dict[str, Any], pictures: list[Path], folder: Path) -> None:
    console = stdout()
    print_rows(console, case.title or folder.name, _rows(figures))
    print_warnings(console, figures["warnings"])
    files = [("result", f"{RESULT}, {SUMMARY}"), ("tables", f"{KNOTS}, {BARS}")]
    if pictures:
        names = dict.fromkeys(picture.stem for picture in pictures)
        kinds = dict.fromkeys(picture.suffix[1:] for picture in pictures)
        files.append(("figures", f"{', '.join(names)} ({', '.join(kinds)})"))
    print_rows(console, f"Written to {folder}", files)


def _rows(figures: dict[str, Any]) -> list[tuple[str, str]]:
    bar = figures["max_tension_bar"]
    where = "" if bar is None else f" in bar {bar}, from {figures['max_tension_bar_label']}"
    methods = ", ".join(filter(None, (figures["solver"], figures["linear_solver"])))
    rows = [
        ("outcome", f"{figures['outcome']}: {figures['message']}"),
        ("knots, bars", f"{figures['knots']}, {figures['bars']}"),
        ("largest tension", quantity(figures["max_tension"], "N") + where),
        ("slack bars", f"{figures['slack_bars']} of {figures['bars']}"),
        ("drag, lift", f"{quantity(figures['drag'], 'N')}, {quantity(figures['lift'], 'N')}"),
        ("weight in water", quantity(figures["weight_in_water"], "N")),
        ("force on supports", vector(figures["support_reaction"], "N")),
        ("largest displacement", quantity(figures["max_displacement"], "m")),
        *_account_rows(figures["audit"]),
        ("iterations", f"{figures['iterations']} ({methods})"),
        ("time", quantity(figures["wall_time"], "s", 3)),
    ]
    if figures["time"] is not None:
        rows.insert(-1, ("simulated time", quantity(figures["time"], "s")))
    if "measured_rms" in figures:
        apart = f"RMS {figures['measured_rms']:.3g} m over {figures['measured_knots']} knots"
        worst = f"largest {figures['measured_largest']:.3g} m at {figures['measured_largest_knot']}"
        rows.append(("against measured", f"{apart}, {worst}"))
    return rows


def _account_rows(accounts: dict[str, Any]) -> list[tuple[str, str]]:
    energy, knot = accounts["energy"], accounts["unbalanced_knot"]
    where = "" if knot is None else f", at knot {knot}"
    left = f"{math.hypot(*accounts['load_less_reaction']):.2g} of {quantity(accounts['load_size'], 'N')}"
    rows = [
        ("unbalanced force", quantity(accounts["unbalanced_force"], "N", 2) + where),
        ("load less reaction", left if energy is None else f"{left}, the inertia of the net"),
    ]
    if energy is not None:
        taken = {
            "current": energy["current_work"],
            "weight and loads": -energy["potential"],
            "turning added mass": energy["added_mass_work"],
        }
        given = {
            "drag": energy["drag_dissipation"],
            "twine": energy["twine_dissipation"],
            "stored": energy["kinetic"] + energy["elastic"],
            "left over": energy["remainder"],
        }
        for what, shares in (("energy in", taken), ("energy out", given)):
            rows.append((what, ", ".join(f"{name} {quantity(one, 'J', 3)}" for name, one in shares.items())))
    return rows
