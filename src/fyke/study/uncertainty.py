"""What uncertain inputs make of a case: the same solve at many samples, in several processes, to be taken up again.

Runs are numbered: 0 is the case itself; then for every input in turn a low and a high value, its 5 and 95 per cent
quantiles, all else as in the case (the tornado); then the samples. Each is a line of samples.csv as soon as it is done.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from math import isfinite
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case import Case, load_case
from ..case.errors import CaseError, Problem
from ..case.keys import nearest
from ..case.vary import Value, varied
from ..results import flow_direction, part_figures, summary, water_figures
from ..results.whole import replacing
from ..solve.run import solve_case
from ..system.build import build_net, build_system
from .inputs import Study

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

# Quantiles of the tornado and of the bands.
LOW, HIGH = 0.05, 0.95
DONE = "converged"
# Runs that a process takes at a time.
CHUNK = 4


@dataclass(frozen=True)
class Run:
    """One run: values of the inputs in their units, outputs in SI, NaN where it failed; outcome: how it ended."""

    number: int
    inputs: tuple[float, ...]
    outputs: tuple[float, ...]
    outcome: str


@dataclass(frozen=True)
class Spread:
    """What the samples make of one output, SI: without those that failed."""

    nominal: float
    mean: float
    deviation: float
    low: float
    median: float
    high: float


@dataclass(frozen=True)
class Ensemble:
    """All runs of a study, by number."""

    study: Study
    runs: tuple[Run, ...]

    @property
    def failed(self) -> tuple[Run, ...]:
        """Runs without outputs."""
        return tuple(run for run in self.runs if run.outcome != DONE)

    @property
    def samples(self) -> Array:
        """Outputs of the samples that did not fail, (k, outputs)."""
        return self._outputs(self.runs[1 + 2 * len(self.study.inputs) :])

    @property
    def drawn(self) -> Array:
        """Inputs of the same samples, (k, inputs)."""
        runs = [run for run in self.runs[1 + 2 * len(self.study.inputs) :] if run.outcome == DONE]
        return np.array([run.inputs for run in runs]).reshape(len(runs), -1)

    def tornado(self) -> Array:
        """Outputs with one input low and high and all else as in the case, (inputs, 2, outputs); NaN where failed."""
        k = len(self.study.inputs)
        return np.array([run.outputs for run in self.runs[1 : 1 + 2 * k]]).reshape(k, 2, -1)

    def spreads(self) -> dict[str, Spread]:
        """Mean, deviation and band of every output."""
        found = self.samples
        out = {}
        for place, name in enumerate(self.study.outputs):
            values = found[:, place] if len(found) else np.full(1, np.nan)
            low, median, high = (float(q) for q in np.quantile(values, [LOW, 0.5, HIGH]))
            deviation = float(np.std(values, ddof=1)) if len(values) > 1 else float("nan")
            out[name] = Spread(
                self.runs[0].outputs[place], float(np.mean(values)), deviation, low, median, high
            )
        return out

    def _outputs(self, runs: Sequence[Run]) -> Array:
        good = [run.outputs for run in runs if run.outcome == DONE]
        return np.array(good).reshape(len(good), len(self.study.outputs))


def propagate(
    case: Case,
    study: Study,
    file: Path,
    *,
    jobs: int = 1,
    resume: bool = False,
    on_progress: Progress | None = None,
) -> Ensemble:
    """Run a study of a case; file: samples.csv, one line for each run as it comes.

    jobs: processes; the numbers are the same for any. resume: take the runs that the file has. Where the case itself
    fails its run is the only one. Raises CaseError where the case does not allow an input at its low or high value,
    where an output is no number of the summary, and where the file is of another study.
    """
    points = _points(study)
    _checked(case, study, points)
    head = _head(case, study)
    known = _read(file, head, points) if resume else {}
    first = known.get(0) or _run(case, study, 0, points[0])
    if first.outcome != DONE:
        return Ensemble(study, (first,))
    known[0] = first
    wanted = [number for number in range(len(points)) if number not in known]
    runs = dict(known)
    with _table(file, head, [known[number] for number in sorted(known)]) as write:
        for run in _all(case, study, points, wanted, jobs):
            runs[run.number] = run
            write(run)
            if on_progress is not None:
                on_progress(len(runs), len(points))
    return Ensemble(study, tuple(runs[number] for number in range(len(points))))


def _points(study: Study) -> list[tuple[float | None, ...]]:
    """Values of the inputs of every run, None for that of the case."""
    k = len(study.inputs)
    nothing: tuple[float | None, ...] = (None,) * k
    points = [nothing]
    for place, one in enumerate(study.inputs):
        for value in one.quantile(np.array([LOW, HIGH])).tolist():
            points.append((*nothing[:place], value, *nothing[place + 1 :]))
    parts = study.points()
    drawn = np.column_stack([one.quantile(part) for one, part in zip(study.inputs, parts.T, strict=True)])
    return points + [tuple(row) for row in drawn.tolist()]


def _changes(study: Study, point: Sequence[float | None]) -> dict[str, Value]:
    pairs = zip(study.inputs, point, strict=True)
    return {one.key: one.written(value) for one, value in pairs if value is not None}


def _checked(case: Case, study: Study, points: Sequence[Sequence[float | None]]) -> None:
    """Raise CaseError where the case does not allow an input's low or high value: a fault of the study's file."""
    problems: list[Problem] = []
    for point in points[1 : 1 + 2 * len(study.inputs)]:
        changes = _changes(study, point)
        try:
            varied(case, changes)
        except CaseError as error:
            told = ", ".join(f"{key} = {value}" for key, value in changes.items())
            problems += [
                Problem(f"study, {told}", one.found, one.allowed, one.cure) for one in error.problems
            ]
    if problems:
        raise CaseError(list(dict.fromkeys(problems)))


def _all(
    case: Case, study: Study, points: Sequence[Sequence[float | None]], wanted: Sequence[int], jobs: int
) -> Iterator[Run]:
    tasks = [(number, points[number]) for number in wanted]
    if jobs == 1 or len(tasks) < 2 * jobs:
        for number, point in tasks:
            yield _run(case, study, number, point)
        return
    # Fresh processes: a fork of one whose kernels have started threads may hang.
    pool = ProcessPoolExecutor(jobs, get_context("spawn"), _begin, (case.path, case.text, study))
    with pool:
        try:
            yield from pool.map(_in_process, tasks, chunksize=CHUNK)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


_ours: dict[str, Any] = {}  # of a process of the pool: its case and study


def _begin(path: Path | None, text: str, study: Study) -> None:
    from ..case import parse_case

    _ours["case"] = load_case(path) if path and path.is_file() else parse_case(text)
    _ours["study"] = study


def _in_process(task: tuple[int, Sequence[float | None]]) -> Run:
    return _run(_ours["case"], _ours["study"], *task)


def _run(case: Case, study: Study, number: int, point: Sequence[float | None]) -> Run:
    """Solve one point; only a wrong output is raised, everything else is the run's own outcome."""
    nominal = [one.nominal for one in study.inputs]
    values = tuple(
        float("nan") if own is None and there is None else float(own if own is not None else there or 0.0)
        for own, there in zip(point, nominal, strict=True)
    )
    nothing = (float("nan"),) * len(study.outputs)
    try:
        changed = varied(case, _changes(study, point))
        system = build_system(build_net(changed), changed)
    except CaseError as error:
        return Run(
            number, values, nothing, f"not allowed: {error.problems[0].where}: {error.problems[0].found}"
        )
    result = solve_case(system, changed)
    if not result.outcome.ok:
        return Run(number, values, nothing, f"{result.outcome.name}: {result.outcome.message}")
    figures = summary(result, flow_direction=flow_direction(system))
    figures |= water_figures(system, result) | part_figures(system, result, depth=changed.water.depth)
    return Run(number, values, tuple(_output(figures, key) for key in study.outputs), DONE)


def _output(figures: Mapping[str, Any], key: str) -> float:
    """Return the number at a dotted key of the summary, entries of lists from 1; CaseError where there is none."""
    value: Any = figures
    for step in key.split("."):
        if isinstance(value, Mapping) and step in value:
            value = value[step]
        elif isinstance(value, list) and step.isdecimal() and 1 <= int(step) <= len(value):
            value = value[int(step) - 1]
        else:
            raise CaseError([_no_output(figures, key)])
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise CaseError([_no_output(figures, key)])
    return float(value)


def _no_output(figures: Mapping[str, Any], key: str) -> Problem:
    there = [
        name
        for name, value in figures.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    ]
    near = nearest(key, there)
    cure = f"did you mean '{near}'?" if near else "take one of these; lists by number, as support_reaction.1"
    return Problem("study, outputs", f"no number '{key}' in the summary", ", ".join(there), cure)


def _head(case: Case, study: Study) -> list[str]:
    """Lines above the runs: of which case and study they are, and the names of the columns."""
    units = [f"{one.key} ({one.unit})" if one.unit else one.key for one in study.inputs]
    columns = ["run", *units, *study.outputs, "outcome"]
    return [f"# case {case.sha256}", f"# study {study.sha256}", _line(columns)]


def _line(cells: Sequence[object]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="").writerow(cells)
    return out.getvalue()


@contextmanager
def _table(file: Path, head: Sequence[str], known: Sequence[Run]) -> Iterator[Callable[[Run], None]]:
    """Hand out a function that adds a run to samples.csv, whole lines at a time; what is known is put there first."""
    with replacing(file) as part:
        part.write_text("\n".join([*head, *(_row(run) for run in known)]) + "\n", encoding="utf-8")
    with file.open("a", encoding="utf-8") as lines:

        def write(run: Run) -> None:
            lines.write(_row(run) + "\n")
            lines.flush()

        yield write


def _row(run: Run) -> str:
    return _line([run.number, *(repr(x) for x in run.inputs), *(repr(x) for x in run.outputs), run.outcome])


def _read(file: Path, head: Sequence[str], points: Sequence[Sequence[float | None]]) -> dict[int, Run]:
    """Runs that a file has of this very study; a last line that is not whole does not count."""
    try:
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        cure = "run it without --resume"
        raise CaseError(
            [Problem(str(file), error.strerror or str(error), "the runs of a study", cure)]
        ) from None
    lines = text[: text.rfind("\n") + 1].splitlines()
    if lines[: len(head)] != list(head):
        allowed = "runs of this case and this study, unchanged"
        raise CaseError(
            [Problem(str(file), "runs of another case or study", allowed, "run it with --overwrite")]
        )
    inputs = len(points[0])
    runs = {}
    for cells in csv.reader(lines[len(head) :]):
        number, values, outcome = int(cells[0]), [float(one) for one in cells[1:-1]], cells[-1]
        runs[number] = Run(number, tuple(values[:inputs]), tuple(values[inputs:]), outcome)
    return runs
