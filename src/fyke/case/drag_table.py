"""A user's own drag coefficients, read from a CSV file."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..water.laws import AngleTable, BarTable
from .errors import CaseError, Problem

BY_SPEED = ("reynolds", "normal", "tangential")
BY_ANGLE = ("reynolds", "angle", "drag", "lift")
# What a column may hold: words, lowest, highest.
_ALLOWED = {
    "reynolds": ("a number from 1e-6 to 1e9", 1e-6, 1e9),
    "angle": ("an angle from 0 (along the bar) to 90 deg (across)", 0.0, 90.0),
    "lift": ("a number from -1e9 to 1e9", -1e9, 1e9),
}
_DIGITS = 9  # of Reynolds numbers and angles; closer ones would make a step of no width
_COEFFICIENT = ("a number from 0 to 1e9", 0.0, 1e9)


@dataclass(frozen=True)
class _Row:
    """The numbers of a row, and where it stands in the file."""

    where: str
    numbers: tuple[float, ...]


def read_drag_table(path: str | Path) -> BarTable | AngleTable:
    """Read coefficients of a bar on d l from a CSV file whose first row names its columns.

    reynolds,normal,tangential: C_n and C_t, one row for each Reynolds number, rising; or reynolds,angle,drag,lift:
    C_D and C_L for every angle (deg, 90 across the bar) at every Reynolds number, both rising, the angle faster.
    CaseError lists every fault of the file, with its row.
    """
    problems: list[Problem] = []
    columns, rows = _read(Path(path), problems)
    keys = 2 if columns == BY_ANGLE else 1
    whole = not problems  # a row with a fault would also be missed as a gap
    problems += _unsorted(rows, keys)
    if whole:
        problems += _gaps(path, rows, keys)
    if problems:
        raise CaseError(problems)
    if columns == BY_SPEED:
        reynolds, normal, tangential = zip(*(row.numbers for row in rows), strict=True)
        return BarTable(reynolds, normal, tangential)
    steps = tuple(dict.fromkeys(row.numbers[0] for row in rows))
    angles = tuple(math.radians(one) for one in dict.fromkeys(row.numbers[1] for row in rows))
    grid = np.array([row.numbers[2:] for row in rows]).reshape(len(steps), len(angles), 2)
    drag, lift = (tuple(map(tuple, grid[:, :, which].tolist())) for which in (0, 1))
    return AngleTable(steps, angles, drag, lift)


def _read(path: Path, problems: list[Problem]) -> tuple[tuple[str, ...], list[_Row]]:
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        cure = "check the name of the file and save it as UTF-8"
        problems.append(Problem(str(path), f"it cannot be read: {error}", "a CSV file in UTF-8", cure))
        return (), []
    cells = [
        (f"{path}, row {number}", [cell.strip() for cell in next(csv.reader([line]))])
        for number, line in enumerate(lines, 1)
        if line.strip(" ,\t") and not line.startswith("#")
    ]
    where, names = cells[0] if cells else (f"{path}, row 1", [])
    columns = tuple(names)
    if columns not in (BY_SPEED, BY_ANGLE):
        found = ",".join(columns) or "no names of columns"
        cure = "name the columns so in the first row, with commas between them"
        allowed = f"{','.join(BY_SPEED)} or {','.join(BY_ANGLE)}"
        problems.append(Problem(where, found, allowed, cure))
        return (), []
    rows = []
    for where, texts in cells[1:]:
        faults = list(_faults(where, columns, texts))
        problems += faults
        if not faults:
            keys = sum(column in BY_ANGLE[:2] for column in columns)
            places = (float(f"{float(text):.{_DIGITS}g}") for text in texts[:keys])
            rows.append(_Row(where, (*places, *map(float, texts[keys:]))))
    return columns, rows


def _faults(where: str, columns: tuple[str, ...], texts: list[str]) -> Iterator[Problem]:
    if len(texts) != len(columns):
        cure = f"give one value for each of {','.join(columns)}, with decimal points"
        yield Problem(where, f"{len(texts)} values", f"{len(columns)} values", cure)
        return
    for column, text in zip(columns, texts, strict=True):
        words, low, high = _ALLOWED.get(column, _COEFFICIENT)
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:  # also true of a value that is not a number
            cure = "correct the number, or leave out the row"
            yield Problem(f"{where}, column {column}", repr(text) if text else "an empty cell", words, cure)


def _unsorted(rows: list[_Row], keys: int) -> Iterator[Problem]:
    """Yield a problem for every row whose first numbers, `keys` of them, do not rise."""
    allowed = "rows with rising Reynolds numbers" + (" and, faster, rising angles" if keys == 2 else "")
    seen: set[tuple[float, ...]] = set()
    last: tuple[float, ...] = ()
    for row in rows:
        place = row.numbers[:keys]
        if place <= last or place in seen:
            cure = "keep one row for each" if place in seen else "sort the rows"
            yield Problem(row.where, f"{_written(place)} after {_written(last)}", allowed, cure)
        seen.add(place)
        last = place


def _written(place: tuple[float, ...]) -> str:
    return ", ".join(f"{name} {value:.10g}" for name, value in zip(BY_ANGLE, place, strict=False))


def _gaps(path: str | Path, rows: list[_Row], keys: int) -> Iterator[Problem]:
    """Yield a problem for a table that is too short, and for every Reynolds number without all the angles."""
    for name, values in zip(BY_ANGLE[:keys], zip(*(row.numbers for row in rows), strict=True), strict=False):
        if len(set(values)) < 2:
            found = f"one value of {name}, {values[0]:.10g}"
            yield Problem(str(path), found, "two or more", "add the measured coefficients")
    if not rows:
        yield Problem(str(path), "no row of numbers", "two or more", "add the measured coefficients")
    if keys == 1:
        return
    seen = {row.numbers[:2] for row in rows}
    angles = sorted({angle for _, angle in seen})
    for step in sorted({reynolds for reynolds, _ in seen}):
        missing = [f"{angle:.10g}" for angle in angles if (step, angle) not in seen]
        if missing:
            found = f"no row for reynolds {step:.10g} at angle {', '.join(missing)}"
            cure = "add the rows, or leave these angles out everywhere"
            yield Problem(str(path), found, "every angle at every Reynolds number", cure)
