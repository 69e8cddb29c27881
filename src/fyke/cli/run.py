"""fyke run: from a case file to a folder with result, tables and figures."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from ..case import Case, CaseError, Problem, load_case
from ..forces.evaluate import evaluate
from ..forces.frame import Frame
from ..forces.team import threads_allowed
from ..results import (
    Comparison,
    MeasurementError,
    Probes,
    Recorder,
    audit,
    compare,
    flow_direction,
    line_figures,
    load,
    load_figures,
    mean_current,
    moments,
    out_of_range,
    part_figures,
    probes_of,
    rings_told,
    save,
    save_checkpoint,
    summary,
    water_figures,
    write_lines,
    write_loads,
    write_parts,
    write_probes,
    write_rings,
    write_summary,
    write_tables,
)
from ..results.lines import line_words
from ..results.parts import part_words
from ..results.periods import period_figures, period_words
from ..results.rings import ring_words
from ..results.water import water_words
from ..solve.clock import Clock, timed
from ..solve.dynamic import Checkpoint
from ..solve.outcome import Outcome
from ..solve.result import Result
from ..solve.run import needs_compiling, planned_frames, solve_case
from ..system.build import build_net, build_system
from ..system.hanging import hanging
from ..system.system import State, System
from .account import account_rows
from .folder import (
    BARS,
    CHECKPOINT,
    KNOTS,
    LINES,
    PARTS,
    RESULT,
    RINGS,
    SUMMARY,
    WAVES,
    claim,
    make_sure_of_room,
    stopped,
)
from .load_cases import (
    Done,
    Wishes,
    claim_load_cases,
    draw_loads,
    print_loads,
    refuse_load_cases,
    run_load_cases,
)
from .progress import progress_bar
from .show import (
    DONE,
    NOT_CONVERGED,
    WRONG_INPUT,
    complain,
    print_json,
    print_problems,
    print_rows,
    print_warnings,
    quantity,
    stderr,
    stdout,
    vector,
)

# Parts of the time below this (s) are kept in summary.json and not shown.
LEAST_SHOWN = 1e-3

Stopped = tuple[Checkpoint, list[Frame]]


def run_case(file: Path, wishes: Wishes, began: float | None = None) -> int:
    """Run a case file and return the exit code; began: time.perf_counter() at the start of the command."""
    folder = wishes.output or Path(file.stem)
    with Clock("starting", began) as clock:
        try:
            with timed("building"):
                case, system, resume = _prepare(file, folder, wishes)
        except (CaseError, MeasurementError) as error:
            print_problems(error.problems)
            return WRONG_INPUT
        try:
            return _run(case, system, folder, wishes, resume, clock)
        except BrokenPipeError:
            # Who read the output has gone, as `head` does; the files are written. Python would complain at its end.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return DONE
        except OSError as error:
            print_problems([_cannot_write(folder, error)])
            return NOT_CONVERGED


def _prepare(file: Path, folder: Path, wishes: Wishes) -> tuple[Case, System, Stopped | None]:
    """Read and build a case and make its folder ready; CaseError and MeasurementError for a wrong input."""
    case = load_case(file)
    _check_threads()
    if wishes.talk and needs_compiling(case):
        stderr().print("First run of this kind: compiling the kernels, some ten seconds, once.")
    system = build_system(build_net(case), case)
    if case.positions_file:
        # A fault of this file is told before the solve, and before an old result is taken away.
        compare(_as_built(case, system), case.positions_file)
    if wishes.resume:
        refuse_load_cases(case, folder)
    resume = stopped(folder, case) if wishes.resume else None
    if resume is None:
        make_sure_of_room(folder, system.net, planned_frames(case))
        claim(folder, overwrite=wishes.overwrite)
    claim_load_cases(case, folder, wishes)
    return case, system, resume


def _check_threads() -> None:
    try:
        threads_allowed()
    except ValueError:
        found, cure = os.environ["FYKE_THREADS"], "set it to the number of threads wanted, or unset it"
        raise CaseError(
            [Problem("environment variable FYKE_THREADS", found, "a whole number above 0", cure)]
        ) from None


def _cannot_write(folder: Path, error: OSError) -> Problem:
    found = error.strerror or str(error)
    cure = "free the disk, or choose another folder with -o DIR; what was written before is still there"
    return Problem(f"output folder {folder}", found, "a disk with room for the result", cure)


def _run(
    case: Case, system: System, folder: Path, wishes: Wishes, resume: Stopped | None, clock: Clock
) -> int:
    done = _solve_and_write(case, system, folder, wishes, clock, resume=resume)
    figures, rows = done.figures, run_load_cases(case, system, done, folder, wishes, _solve_and_write)
    if rows:
        write_loads(rows, folder)
        done.pictures.extend(draw_loads(rows, folder) if wishes.figures else ())
        figures |= load_figures(rows) | {"time_by_part": clock.seconds}
        write_summary(figures, folder)
    if wishes.json:
        print_json(figures)
    elif wishes.talk:
        _show(case, figures, done.pictures, folder)
        print_loads(stdout(), rows)
    if not done.result.outcome.ok:
        complain(done.result.outcome)
    fine = done.result.outcome.ok and len(rows) == len(case.load_case) and all(row.ok for row in rows)
    return DONE if fine else NOT_CONVERGED


def _solve_and_write(
    case: Case,
    system: System,
    folder: Path,
    wishes: Wishes,
    clock: Clock,
    *,
    resume: Stopped | None = None,
    start: State | None = None,
) -> Done:
    """Solve one case and write all that there is of it; start: of a static solve."""
    with timed("forces"):
        result = _solve(case, system, folder, wishes, resume, start)
    with timed("accounts"):
        comparison = compare(result, case.positions_file) if case.positions_file else None
        figures = _figures_of(case, system, result, comparison)
        probes = probes_of(system, result, case.output.probes)
    with timed("writing"):
        write_tables(result, folder)
        write_parts(figures["parts"], folder)
        if "lines" in figures:
            write_lines(figures["lines"], folder)
        write_rings(figures.get("rings", []), folder)
        write_summary(figures, folder)
        if probes is not None:
            write_probes(probes, folder)
    with timed("figures"):
        pictures = _draw(system, result, folder, comparison, probes) if wishes.figures else []
    figures["time_by_part"] = clock.seconds
    write_summary(figures, folder)
    return Done(result, figures, pictures)


def _solve(
    case: Case, system: System, folder: Path, wishes: Wishes, resume: Stopped | None, start: State | None
) -> Result:
    """Solve a case, with every output and a checkpoint on disk as it comes, and leave the whole result in the file."""
    file, times, weight = folder / RESULT, planned_frames(case), system.weight_in_water
    frames = resume[1] if resume else ()

    def append(frame: Frame) -> None:
        with timed("writing"):
            recorder.append(frame)

    def keep(checkpoint: Checkpoint) -> None:
        with timed("writing"):
            save_checkpoint(folder / CHECKPOINT, checkpoint, case_sha256=case.sha256)

    with (
        Recorder(
            file, system.net, times=times, weight_in_water=weight, case_text=case.text, frames=frames
        ) as recorder,
        progress_bar(stderr(), shown=wishes.talk) as report,
    ):
        try:
            result = solve_case(
                system,
                case,
                on_frame=append,
                on_progress=report,
                on_checkpoint=keep,
                resume=resume,
                start=start,
            )
        except KeyboardInterrupt:
            recorder.close()
            result = load(file) if file.is_file() else _as_built(case, system)
            save(result, file)
        else:
            with timed("writing"):
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
        flow_direction=flow_direction(system),
        audit=audit(system, result),
    )
    figures |= water_figures(system, result) | part_figures(system, result, depth=case.water.depth)
    figures |= line_figures(system, result) | rings_told(system, result)
    if case.output.periods is not None and case.solve.kind == "static":
        figures |= period_figures(system, result, case.output.periods)
    figures["damping_time"] = float(system.elements.damping_time.max(initial=0.0))
    outside = out_of_range(system, moments(result))
    held = hanging(system, static=case.solve.kind == "static")
    figures["warnings"] = list(
        dict.fromkeys([*case.warnings, *held, *result.outcome.warnings, *outside.warnings])
    )
    figures["out_of_range"] = outside.counts
    if comparison is not None:
        figures["measured_knots"] = len(comparison.labels)
        figures["measured_rms"] = comparison.rms
        figures["measured_largest"] = comparison.largest
        figures["measured_largest_knot"] = comparison.largest_label
    return figures


def _draw(
    system: System, result: Result, folder: Path, comparison: Comparison | None, probes: Probes | None
) -> list[Path]:
    from ..report.figures import draw_all

    return draw_all(
        result,
        folder,
        comparison=comparison,
        current=mean_current(system),
        waves=None if system.waves is None else system.waves.direction,
        probes=probes,
    )


def _show(case: Case, figures: dict[str, Any], pictures: list[Path], folder: Path) -> None:
    console = stdout()
    print_rows(console, case.title or folder.name, _rows(figures))
    print_warnings(console, figures["warnings"])
    tables = ", ".join(
        [KNOTS, BARS, PARTS, *(one for one in (RINGS, LINES, WAVES) if (folder / one).is_file())]
    )
    files = [("result", f"{RESULT}, {SUMMARY}"), ("tables", tables)]
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
        *(
            [
                (
                    "for real ones",
                    f"{figures['real_knots']}, {figures['real_bars']}; tensions are of one real bar",
                )
            ]
            if figures["group"] > 1.0
            else []
        ),
        ("largest tension", quantity(figures["max_tension"], "N") + where),
        ("slack bars", f"{figures['slack_bars']} of {figures['bars']}"),
        ("drag, lift", f"{quantity(figures['drag'], 'N')}, {quantity(figures['lift'], 'N')}"),
        ("weight in water", quantity(figures["weight_in_water"], "N")),
        ("force on supports", vector(figures["support_reaction"], "N")),
        ("largest displacement", quantity(figures["max_displacement"], "m")),
        *(
            row
            for told in (water_words, part_words, period_words, line_words, ring_words)
            for row in told(figures)
        ),
        *account_rows(figures),
        ("solver", methods),
        *_work_rows(figures),
        ("time of the solve", quantity(figures["wall_time"], "s", 3)),
        ("time by part", _parts(figures["time_by_part"])),
    ]
    if "measured_rms" in figures:
        apart = f"RMS {figures['measured_rms']:.3g} m over {figures['measured_knots']} knots"
        worst = f"largest {figures['measured_largest']:.3g} m at {figures['measured_largest_knot']}"
        rows.append(("against measured", f"{apart}, {worst}"))
    return rows


def _work_rows(figures: dict[str, Any]) -> list[tuple[str, str]]:
    factors = f"{figures['factorizations']} factorizations"
    if figures["time"] is None:
        return [("iterations", f"{figures['iterations']}, {factors}")]
    return [
        ("simulated time", quantity(figures["time"], "s")),
        ("steps", f"{figures['iterations']} accepted, {figures['rejected']} rejected, {factors}"),
    ]


def _parts(seconds: dict[str, float]) -> str:
    return ", ".join(f"{part} {quantity(one, 's', 2)}" for part, one in seconds.items() if one >= LEAST_SHOWN)
