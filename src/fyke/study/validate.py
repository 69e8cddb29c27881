"""Run claims and judge them: every row on its own, so that one that fails does not keep the others from the table."""

from __future__ import annotations

import importlib.util
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from math import isfinite
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Literal

from ..case import load_case
from ..case.errors import CaseError
from ..results import flow_direction, part_figures, summary
from ..solve.run import solve_case
from ..system.build import build_net, build_system
from .claims import MISSING, NONE, Claim, Found, Level, RowSpec, read_claim

Verdict = Literal["holds", "fails", "missing", "shown"]
Progress = Callable[[int, int, str], None]
# Lines of a fault that are told.
TOLD = 3


@dataclass(frozen=True)
class Judged:
    """One line of the table.

    ours, reference, tolerance: in the row's unit, None where there is none; difference: ours less the reference, over
    it where relative; reason: of the tolerance, of the gap, or what went wrong.
    """

    claim: str
    title: str
    level: Level
    case: str
    quantity: str
    unit: str
    ours: float | None
    reference: float | None
    tolerance: float | None
    relative: bool
    verdict: Verdict
    reason: str
    source: str

    @property
    def difference(self) -> float | None:
        """Ours less the reference, over the reference where the tolerance is relative."""
        if self.ours is None or self.reference is None:
            return None
        difference = self.ours - self.reference
        return difference / abs(self.reference) if self.relative and self.reference else difference


@dataclass(frozen=True)
class Report:
    """All rows, and the seconds that each claim took."""

    rows: tuple[Judged, ...]
    seconds: dict[str, float]

    @property
    def ok(self) -> bool:
        """Whether no row fails."""
        return all(row.verdict != "fails" for row in self.rows)

    def count(self, verdict: Verdict) -> int:
        """Rows of a verdict."""
        return sum(row.verdict == verdict for row in self.rows)


def validate(
    files: Sequence[Path], *, fast: bool = False, jobs: int = 1, on_progress: Progress | None = None
) -> Report:
    """Run claims, given by their files; fast: leave out those that take long; jobs: so many at a time.

    A claim that cannot be read, measured or brought to convergence is a row that fails.
    """
    wanted = [file for file in files if not fast or _is_fast(file)]
    rows: list[tuple[Judged, ...]] = []
    seconds: dict[str, float] = {}
    done = _in_processes(wanted, jobs) if jobs > 1 else ((file, *judge(file)) for file in wanted)
    for number, (file, judged, took) in enumerate(done, 1):
        rows.append(judged)
        seconds[file.stem] = took
        if on_progress is not None:
            on_progress(number, len(wanted), file.stem)
    return Report(tuple(row for some in rows for row in some), seconds)


def judge(file: Path) -> tuple[tuple[Judged, ...], float]:
    """Run one claim; return its rows and the seconds it took."""
    began = time.perf_counter()
    try:
        claim = read_claim(file)
    except CaseError as error:
        rows: tuple[Judged, ...] = (_broken(file, str(error)),)
    else:
        rows = tuple(_judged(claim))
    return rows, time.perf_counter() - began


def _is_fast(file: Path) -> bool:
    try:
        return read_claim(file).fast
    except CaseError:
        return True  # to be told as a row that fails


def _in_processes(files: Sequence[Path], jobs: int) -> Iterator[tuple[Path, tuple[Judged, ...], float]]:
    # Fresh processes: a fork of one whose kernels have started threads may hang.
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        waiting: list[Future[tuple[tuple[Judged, ...], float]]] = [pool.submit(judge, file) for file in files]
        for file, future in zip(files, waiting, strict=True):
            yield file, *future.result()


def _judged(claim: Claim) -> Iterator[Judged]:
    try:
        found = list(_measured(claim))
    except Exception as error:
        # Whatever a script raises is its own rows' fault: the others still run.
        told = str(error) if isinstance(error, CaseError) else _last_lines(error)
        for spec in claim.rows:
            yield _line(claim, spec, None, "fails", told)
        return
    for spec in claim.rows:
        own = [one for one in found if one.key == spec.key]
        if not own:
            known = ", ".join(sorted({one.key for one in found})) or "nothing"
            yield _line(
                claim, spec, None, "fails", f"nothing was measured for '{spec.key}'; there is {known}"
            )
        for one in own:
            yield _line(claim, spec, one, *_verdict(spec, one))
    for key in sorted({one.key for one in found} - {spec.key for spec in claim.rows}):
        if claim.script:
            yield _broken(claim.file, f"'{key}' was measured and no row asks for it", claim)


def _verdict(spec: RowSpec, one: Found) -> tuple[Verdict, str]:
    """Judge one value."""
    if not isfinite(one.ours):
        return "fails", f"{one.ours} was found"
    if spec.reference in {MISSING, NONE}:
        return ("missing" if spec.reference == MISSING else "shown"), spec.reason
    reference = _reference(spec, one)
    if reference is None or spec.tolerance is None:
        return "fails", "the script gives no reference for this row"
    scale = abs(reference) if spec.relative else 1.0
    if spec.relative and reference == 0.0:
        return "fails", "a relative tolerance on a reference of 0"
    return ("holds" if abs(one.ours - reference) <= spec.tolerance * scale else "fails"), spec.reason


def _reference(spec: RowSpec, one: Found) -> float | None:
    return spec.reference if isinstance(spec.reference, float) else one.reference


def _line(claim: Claim, spec: RowSpec, one: Found | None, verdict: Verdict, reason: str) -> Judged:
    return Judged(
        claim=claim.name,
        title=claim.title,
        level=claim.level,
        case=one.case if one else "",
        quantity=spec.quantity,
        unit=spec.unit,
        ours=one.ours if one else None,
        reference=_reference(spec, one) if one else None,
        tolerance=spec.tolerance,
        relative=spec.relative,
        verdict=verdict,
        reason=reason,
        source=claim.source,
    )


def _broken(file: Path, told: str, claim: Claim | None = None) -> Judged:
    """Row of a claim that cannot be judged."""
    return Judged(
        claim=file.stem,
        title=claim.title if claim else file.stem,
        level=claim.level if claim else "unit",
        case="",
        quantity="the claim itself",
        unit="",
        ours=None,
        reference=None,
        tolerance=None,
        relative=False,
        verdict="fails",
        reason=told,
        source=claim.source if claim else "",
    )


def _measured(claim: Claim) -> Iterable[Found]:
    """Measure what a claim is about."""
    tables = claim.tables()
    if claim.script is None:
        return _of_case(claim)
    file = claim.file.parent / claim.script
    spec = importlib.util.spec_from_file_location(f"fyke_validation_{file.stem}", file)
    if spec is None or spec.loader is None or not file.is_file():
        raise FileNotFoundError(f"no script {file}")
    module = importlib.util.module_from_spec(spec)
    with _beside(file.parent):
        spec.loader.exec_module(module)
    measured: Iterable[Found] = module.measure(tables)
    return measured


@contextmanager
def _beside(folder: Path) -> Iterator[None]:
    """Let a script import what lies beside it."""
    sys.path.insert(0, str(folder.resolve()))
    try:
        yield
    finally:
        sys.path.remove(str(folder.resolve()))


def _of_case(claim: Claim) -> Iterator[Found]:
    """Values of the summary of a case, by the rows' keys."""
    case = load_case(claim.file.parent / str(claim.case))
    system = build_system(build_net(case), case)
    result = solve_case(system, case)
    if not result.outcome.ok:
        raise RuntimeError(f"{result.outcome.name}: {result.outcome.message}")
    figures = summary(result, flow_direction=flow_direction(system)) | part_figures(
        system, result, depth=case.water.depth
    )
    for spec in claim.rows:
        yield Found(spec.key, float(_by_key(figures, spec.key)))


def _by_key(figures: dict[str, Any], key: str) -> Any:
    """Return the value at a dotted key, list entries by number."""
    value: Any = figures
    for part in key.split("."):
        value = value[int(part)] if isinstance(value, list) else value[part]
    return value


def _last_lines(error: BaseException) -> str:
    lines = "".join(traceback.format_exception_only(error)).strip().splitlines()
    place = traceback.extract_tb(error.__traceback__)
    where = f" ({Path(place[-1].filename).name}, line {place[-1].lineno})" if place else ""
    return " ".join(lines[-TOLD:]) + where
