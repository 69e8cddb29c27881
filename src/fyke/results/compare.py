"""Measured knot positions laid over a result."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from heapq import nsmallest
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..case.errors import Problem
from ..netting.net import Net
from ..solve.result import Result

Array = NDArray[np.float64]
BY_LABEL = ("knot", "x", "y", "z")
BY_PLACE = ("x0", "y0", "z0", "x", "y", "z")
ROW_AND_COLUMN = re.compile(r"(\d+)-(\d+)$")


class MeasurementError(ValueError):
    """Measured positions cannot be used; problems: all that was found wrong."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n\n".join(str(problem) for problem in problems))


@dataclass(frozen=True)
class Comparison:
    """Measured against computed positions of k knots in the last frame.

    knots: (k,) indices of the knots; labels: k texts; measured, computed: (k, 3) m; distance: (k,) m, between
    the two; rms: root of the mean square of the distances (m); largest: the largest distance (m), at the knot
    largest_label.
    """

    knots: NDArray[np.int64]
    labels: tuple[str, ...]
    measured: Array
    computed: Array
    distance: Array
    rms: float
    largest: float
    largest_label: str


@dataclass(frozen=True)
class _Row:
    """A row of the file: where it is, the knot's label ("" when given by place), and its numbers."""

    where: str
    label: str
    numbers: tuple[float, ...]


def compare(result: Result, path: str | Path) -> Comparison:
    """Compare the last frame of a result with measured positions in a CSV file.

    Columns are either knot,x,y,z with the knot's label, or x0,y0,z0,x,y,z with the place (m) that the knot
    has before anything acts, of which the nearest knot is taken if it lies within half the shortest bar.
    MeasurementError lists every fault of the file.
    """
    problems: list[Problem] = []
    rows = _read(Path(path), problems)
    found = list(_match(rows, result.net, problems))
    if problems:
        raise MeasurementError(problems)
    knots = np.array([knot for knot, _ in found], dtype=np.int64)
    measured = np.array([row.numbers[-3:] for _, row in found])
    computed = result.position[-1][knots]
    distance = np.asarray(np.linalg.norm(computed - measured, axis=1))
    labels = tuple(result.net.labels[knot] for knot in knots)
    worst = int(np.argmax(distance))
    rms = float(np.sqrt(np.mean(distance**2)))
    return Comparison(knots, labels, measured, computed, distance, rms, float(distance[worst]), labels[worst])


def _read(path: Path, problems: list[Problem]) -> list[_Row]:
    """Read the rows whose numbers can be used; add a problem for every other."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        cure = "check the name of the file and save it as UTF-8"
        problems.append(Problem(str(path), f"it cannot be read: {error}", "a CSV file in UTF-8", cure))
        return []
    table = csv.reader(lines)
    columns = tuple(name.strip() for name in next(table, []))
    if columns not in (BY_LABEL, BY_PLACE):
        found = ",".join(columns) or "no names of columns"
        allowed = f"{','.join(BY_LABEL)} or {','.join(BY_PLACE)}"
        cure = "name the columns so in the first row, with commas between them; lengths are in m"
        problems.append(Problem(f"{path}, row 1", found, allowed, cure))
        return []
    rows = []
    for cells in table:
        texts = [cell.strip() for cell in cells]
        if any(texts):
            row = _read_row(f"{path}, row {table.line_num}", columns, texts, problems)
            rows += [row] if row else []
    if not rows and not problems:
        where, cure = f"{path}, row 2", "add the measured positions"
        problems.append(Problem(where, "the end of the file", "one row per measured knot", cure))
    return rows


def _read_row(where: str, columns: tuple[str, ...], texts: list[str], problems: list[Problem]) -> _Row | None:
    if len(texts) != len(columns):
        cure = f"give one value for each of {','.join(columns)}, with decimal points"
        problems.append(Problem(where, f"{len(texts)} values", f"{len(columns)} values", cure))
        return None
    cells = dict(zip(columns, texts, strict=True))
    label = cells.pop("knot", "")
    numbers = []
    for column, text in cells.items():
        try:
            numbers.append(float(text))
        except ValueError:
            numbers.append(math.nan)
        if not math.isfinite(numbers[-1]):
            cure = "correct the number, or leave out the row of a knot that was not measured"
            problems.append(Problem(f"{where}, column {column}", repr(text), "a finite number (m)", cure))
    return _Row(where, label, tuple(numbers)) if all(map(math.isfinite, numbers)) else None


def _match(rows: list[_Row], net: Net, problems: list[Problem]) -> Iterator[tuple[int, _Row]]:
    """Yield the knot of every row; add a problem for a row without a knot and for a knot met before."""
    by_place = bool(rows) and len(rows[0].numbers) == len(BY_PLACE)
    knots = _by_place(rows, net, problems) if by_place else _by_label(rows, net, problems)
    met: dict[int, str] = {}
    for knot, row in knots:
        if knot in met:
            found = f"knot {net.labels[knot]} again, after {met[knot]}"
            problems.append(Problem(row.where, found, "every knot once", "keep one of the two rows"))
        else:
            met[knot] = row.where
            yield knot, row


def _by_label(rows: list[_Row], net: Net, problems: list[Problem]) -> Iterator[tuple[int, _Row]]:
    knots = {label: knot for knot, label in enumerate(net.labels)}
    for row in rows:
        if row.label in knots:
            yield knots[row.label], row
        else:
            cure = f"did you mean {' or '.join(map(repr, _near(row.label, net.labels)))}?"
            problems.append(Problem(row.where, f"the knot {row.label!r}", "the label of a knot", cure))


def _near(label: str, labels: tuple[str, ...]) -> list[str]:
    """Return the three labels nearest to a wrong one: in row and column, or else in spelling."""
    wanted = ROW_AND_COLUMN.search(label)
    there = {other: found for other in labels if (found := ROW_AND_COLUMN.search(other))}
    if wanted is None or not there:
        return get_close_matches(label, labels, n=3, cutoff=0.0)

    def steps(other: str) -> int:
        pairs = zip(wanted.groups(), there[other].groups(), strict=True)
        return sum(abs(int(a) - int(b)) for a, b in pairs)

    return nsmallest(3, there, key=steps)


def _by_place(rows: list[_Row], net: Net, problems: list[Problem]) -> Iterator[tuple[int, _Row]]:
    from scipy.spatial import cKDTree

    reach = min([float(np.min(net.rest_length, initial=np.inf)), *(p.bar_length for p in net.panels)]) / 2.0
    distances, nearest = cKDTree(net.positions).query([row.numbers[:3] for row in rows])
    for row, knot, distance in zip(rows, nearest.tolist(), distances.tolist(), strict=True):
        if distance <= reach:
            yield knot, row
        else:
            place = ",".join(f"{number:g}" for number in row.numbers[:3])
            found = f"{place}, which is {distance:.4g} m from the nearest knot, {net.labels[knot]}"
            allowed = f"the initial place of a knot within {reach:.4g} m, half the shortest bar"
            problems.append(Problem(row.where, found, allowed, "check axes, origin and unit of x0,y0,z0"))
