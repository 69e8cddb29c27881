"""Tables of numbers from a CSV file whose first row names its columns; every fault is told with its row."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from .errors import Problem

Allowed = tuple[str, float, float]  # what a column may hold: words, lowest, highest


@dataclass(frozen=True)
class Row:
    """The numbers of a row, and where it stands in the file."""

    where: str
    numbers: tuple[float, ...]


@dataclass(frozen=True)
class Layout:
    """Columns that a file may have.

    places: how many of them, from the left, say where; they rise, the last fastest; digits: how many significant ones
    the places keep, closer ones would make a step of no width.
    """

    columns: tuple[str, ...]
    places: int
    digits: int = 9


def read_columns(
    path: Path, layouts: Sequence[Layout], allowed: Mapping[str, Allowed], problems: list[Problem]
) -> tuple[Layout | None, list[Row]]:
    """Read a file in one of some layouts; faults are added to problems and their rows left out.

    None for a file that cannot be read or has other columns.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:  # the latter of names and of bytes that are no UTF-8
        cure = "check the name of the file and save it as UTF-8"
        problems.append(Problem(str(path), f"it cannot be read: {error}", "a CSV file in UTF-8", cure))
        return None, []
    cells = [
        (f"{path}, row {number}", [cell.strip() for cell in next(csv.reader([line]))])
        for number, line in enumerate(lines, 1)
        if line.strip(" ,\t") and not line.startswith("#")
    ]
    where, names = cells[0] if cells else (f"{path}, row 1", [])
    layout = next((one for one in layouts if one.columns == tuple(names)), None)
    if layout is None:
        found = ",".join(names) or "no names of columns"
        cure = "name the columns so in the first row, with commas between them"
        words = " or ".join(",".join(one.columns) for one in layouts)
        problems.append(Problem(where, found, words, cure))
        return None, []
    rows = []
    for where, texts in cells[1:]:
        faults = list(_faults(where, layout.columns, texts, allowed))
        problems += faults
        if not faults:
            places = (float(f"{float(text):.{layout.digits}g}") for text in texts[: layout.places])
            rows.append(Row(where, (*places, *map(float, texts[layout.places :]))))
    return layout, rows


def _faults(
    where: str, columns: tuple[str, ...], texts: list[str], allowed: Mapping[str, Allowed]
) -> Iterator[Problem]:
    if len(texts) != len(columns):
        cure = f"give one value for each of {','.join(columns)}, with decimal points"
        yield Problem(where, f"{len(texts)} values", f"{len(columns)} values", cure)
        return
    for column, text in zip(columns, texts, strict=True):
        words, low, high = allowed[column]
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:  # also true of a value that is not a number
            cure = "correct the number, or leave out the row"
            yield Problem(f"{where}, column {column}", repr(text) if text else "an empty cell", words, cure)


def unsorted(rows: list[Row], layout: Layout) -> Iterator[Problem]:
    """Yield a problem for every row whose places do not rise."""
    names = layout.columns[: layout.places]
    allowed = f"rows by rising {names[0]}" + "".join(f" and, faster, rising {name}" for name in names[1:])
    seen: set[tuple[float, ...]] = set()
    last: tuple[float, ...] = ()
    for row in rows:
        place = row.numbers[: layout.places]
        if place <= last or place in seen:
            cure = "keep one row for each" if place in seen else "sort the rows"
            yield Problem(row.where, f"{_written(names, place)} after {_written(names, last)}", allowed, cure)
        seen.add(place)
        last = place


def _written(names: tuple[str, ...], place: tuple[float, ...]) -> str:
    return ", ".join(f"{name} {value:.10g}" for name, value in zip(names, place, strict=True))


def too_few(path: Path, rows: list[Row], layout: Layout) -> Iterator[Problem]:
    """Yield a problem for every place of which a table has fewer than two values."""
    cure = "add what was measured at others"
    if not rows:
        yield Problem(str(path), "no row of numbers", "two or more", cure)
    names = layout.columns[: layout.places]
    for name, values in zip(names, zip(*(row.numbers for row in rows), strict=True), strict=False):
        if len(set(values)) < 2:
            yield Problem(str(path), f"one value of {name}, {values[0]:.10g}", "two or more", cure)
