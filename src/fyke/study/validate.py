"""Run claims and judge them: every row on its own, so that one that fails does not keep the others from the table."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from math import isfinite
from multiprocessing import get_context
from pathlib import Path
from typing import Literal

from ..case.errors import CaseError
from .claims import MISSING, NONE, Claim, Found, Level, RowSpec, read_claim
from .measure import Measured, last_lines, measure, picture_of

Verdict = Literal["holds", "fails", "missing", "shown"]
Progress = Callable[[int, int, str], None]


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
    side: str = "both"

    @property
    def difference(self) -> float | None:
        """Ours less the reference, over the reference where the tolerance is relative."""
        if self.ours is None or self.reference is None:
            return None
        difference = self.ours - self.reference
        return difference / abs(self.reference) if self.relative and self.reference else difference


@dataclass(frozen=True)
class Judgement:
    """Rows of one claim, the seconds that it took, and its picture (PNG) where it has one and it was asked for."""

    rows: tuple[Judged, ...]
    seconds: float
    picture: bytes | None = None


@dataclass(frozen=True)
class Report:
    """All rows, the seconds that each claim took, and the pictures (PNG) of claims."""

    rows: tuple[Judged, ...]
    seconds: dict[str, float]
    pictures: dict[str, bytes]

    @property
    def ok(self) -> bool:
        """Whether no row fails."""
        return all(row.verdict != "fails" for row in self.rows)

    def count(self, verdict: Verdict) -> int:
        """Rows of a verdict."""
        return sum(row.verdict == verdict for row in self.rows)


def validate(
    files: Sequence[Path],
    *,
    fast: bool = False,
    jobs: int = 1,
    draw: bool = False,
    on_progress: Progress | None = None,
) -> Report:
    """Run claims, given by their files.

    fast: leave out those that take long; jobs: so many at a time; draw: draw their pictures too. A claim that cannot be
    read, measured or brought to convergence is a row that fails.
    """
    wanted = [file for file in files if not fast or _is_fast(file)]
    found: dict[Path, Judgement] = {}
    for file, judgement in _in_processes(wanted, jobs, draw) if jobs > 1 else _here(wanted, draw):
        found[file] = judgement
        if on_progress is not None:
            on_progress(len(found), len(wanted), file.stem)
    ordered = [found[file] for file in wanted]
    return Report(
        rows=tuple(row for judgement in ordered for row in judgement.rows),
        seconds={file.stem: found[file].seconds for file in wanted},
        pictures={file.stem: picture for file in wanted if (picture := found[file].picture)},
    )


def judge(file: Path, *, draw: bool = False) -> Judgement:
    """Run one claim."""
    began = time.perf_counter()
    picture = None
    try:
        claim = read_claim(file)
    except CaseError as error:
        rows: tuple[Judged, ...] = (_broken(file, str(error)),)
    else:
        measured = measure(claim)
        rows = tuple(_judged(claim, measured))
        if draw and measured.module is not None and not measured.wrong:
            try:
                picture = picture_of(measured)
            except Exception as error:
                rows += (_broken(file, f"its picture: {last_lines(error)}", claim),)
    return Judgement(rows, time.perf_counter() - began, picture)


def _is_fast(file: Path) -> bool:
    try:
        return read_claim(file).fast
    except CaseError:
        return True  # to be told as a row that fails


def _here(files: Sequence[Path], draw: bool) -> Iterator[tuple[Path, Judgement]]:
    for file in files:
        yield file, judge(file, draw=draw)


def _in_processes(files: Sequence[Path], jobs: int, draw: bool) -> Iterator[tuple[Path, Judgement]]:
    # Fresh processes: a fork of one whose kernels have started threads may hang.
    lost = []
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        waiting = {pool.submit(judge, file, draw=draw): file for file in files}
        for future in as_completed(waiting):
            if future.exception() is None:
                yield waiting[future], future.result()
            else:
                lost.append(waiting[future])
    # A process that died takes with it all that had not been judged: these have one each.
    for file in lost:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            alone = pool.submit(judge, file, draw=draw)
            error = alone.exception()
            yield file, alone.result() if error is None else Judgement((_broken(file, str(error)),), 0.0)


def _judged(claim: Claim, measured: Measured) -> Iterator[Judged]:
    found = measured.found
    for spec in claim.rows:
        own = [one for one in found if one.key == spec.key]
        if not own:
            yield _line(claim, spec, None, *_nothing(claim, spec, measured))
        for one in own:
            yield _line(claim, spec, one, *_verdict(spec, one))
    if measured.wrong and found:
        yield _broken(claim.file, measured.wrong, claim)
    for key in sorted({one.key for one in found} - {spec.key for spec in claim.rows}):
        yield _broken(claim.file, f"'{key}' was measured and no row asks for it", claim)


def _nothing(claim: Claim, spec: RowSpec, measured: Measured) -> tuple[Verdict, str]:
    """Verdict on a row for which nothing was found."""
    if measured.wrong:
        return "fails", measured.wrong
    if measured.absent:
        return "missing", measured.absent
    if spec.reference == MISSING and not (claim.script or claim.case):
        return "missing", spec.reason
    known = ", ".join(sorted({one.key for one in measured.found})) or "nothing"
    return "fails", f"nothing was measured for '{spec.key}'; there is {known}"


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
    over = one.ours - reference
    miss = {"both": abs(over), "above": -over, "below": over}[spec.side]
    return ("holds" if miss <= spec.tolerance * scale else "fails"), spec.reason


def _reference(spec: RowSpec, one: Found) -> float | None:
    return spec.reference if isinstance(spec.reference, float) else one.reference


def _line(claim: Claim, spec: RowSpec, one: Found | None, verdict: Verdict, reason: str) -> Judged:
    reference = _reference(spec, one) if one else None
    return Judged(
        claim=claim.name,
        title=claim.title,
        level=claim.level,
        case=one.case if one else "",
        quantity=spec.quantity,
        unit=spec.unit,
        ours=float(one.ours) if one else None,
        reference=None if reference is None else float(reference),
        tolerance=spec.tolerance,
        # What is shown beside another figure is told in per cent of it.
        relative=spec.relative or (verdict == "shown" and bool(reference)),
        verdict=verdict,
        reason=reason,
        source=claim.source,
        side=spec.side,
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
