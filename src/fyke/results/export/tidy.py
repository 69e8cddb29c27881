"""Tidy tables: one row for every knot, bar or moment, in csv that every program reads."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TextIO

from ...solve.result import Result
from ..fields import FRAME_FIELDS, NET_FIELDS, Field
from ..whole import replacing_folder
from .columns import Column, columns_of

KNOTS, BARS, HISTORIES, DESCRIPTION = "knots.csv", "bars.csv", "histories.csv", "columns.json"
TIME, PLACE = FRAME_FIELDS[0], FRAME_FIELDS[1]
LABEL = NET_FIELDS["labels"]
# The columns of places and velocities have the names that everyone gives them.
SHORT = {"position": "{}", "velocity": "v{}", "initial_position": "{}0"}


def write_csv(result: Result, path: str | Path) -> Path:
    """Write all frames of a result as knots.csv, bars.csv and histories.csv into a folder, and return it.

    columns.json tells unit and meaning of every column. Numbers carry all their digits, so that reading them gives
    the same float64. The folder appears whole or not at all; OSError where it cannot be written, FileExistsError where
    it is there and holds other files.
    """
    path = Path(path)
    with replacing_folder(path, (KNOTS, BARS, HISTORIES, DESCRIPTION)) as folder:
        knots = (Column(PLACE, lambda first, last: result.position[first:last]), *columns_of(result, "knot"))
        described = {
            KNOTS: _write_moments(folder / KNOTS, result, knots, "knot", result.net.labels),
            BARS: _write_moments(folder / BARS, result, columns_of(result, "bar"), "bar", None),
            HISTORIES: _write_histories(folder / HISTORIES, result),
        }
        text = json.dumps(described, indent=1, ensure_ascii=False)
        (folder / DESCRIPTION).write_text(text + "\n", encoding="utf-8")
    return path


def _names(field: Field) -> list[str]:
    if field.dimensions[-1] != "xyz":
        return [field.name]
    pattern = SHORT.get(field.name, f"{field.name}_{{}}")
    return [pattern.format(axis) for axis in "xyz"]


def _describe(fields: Sequence[Field]) -> dict[str, dict[str, str]]:
    return {
        name: {"units": field.unit, "long_name": field.long_name}
        for field in fields
        for name in _names(field)
    }


def _texts(column: Column, index: int) -> list[list[str]]:
    """All numbers of a column in one frame as texts, one list for each component."""
    values = column.values(index, index + 1)
    values = values[0] if column.moves else values
    return [list(map(repr, one)) for one in values.reshape(-1, column.components).T.tolist()]


def _write_moments(
    path: Path, result: Result, columns: Sequence[Column], key: str, labels: Sequence[str] | None
) -> dict[str, dict[str, str]]:
    """Write a row for each knot, with its label, or for each bar, with its ends, in each frame; say what is in it."""
    number = next(column for column in columns if column.name == key)
    others = [column for column in columns if column.name != key]
    still = {column.name: _texts(column, 0) for column in (number, *others) if not column.moves}
    ends = result.net.bars.T.tolist()
    if labels is None:
        who = [list(map(str, end)) for end in ends]
        named = [Field(f"knot_{end}", ("bar",), "1", f"number of the knot at end {end}") for end in "ab"]
    else:
        who, named = [[_quoted(label) for label in labels]], [LABEL]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        fields = [TIME, number.field, *named, *(column.field for column in others)]
        _header(file, fields)
        for index, time in enumerate(result.time.tolist()):
            told = [*still[key], *who]
            for column in others:
                told += still.get(column.name) or _texts(column, index)
            moment = repr(time)
            file.writelines(f"{moment},{','.join(row)}\n" for row in zip(*told, strict=True))
    return _describe(fields)


def _write_histories(path: Path, result: Result) -> dict[str, dict[str, str]]:
    largest = Field("largest_tension", ("time",), "N", "largest tension of a bar")
    whole = columns_of(result, "")
    told = [text for column in whole for text in _history(column, result)]
    told.append(list(map(repr, result.tension.max(axis=1, initial=0.0).tolist())))
    fields = [*(column.field for column in whole), largest]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        _header(file, fields)
        file.writelines(f"{','.join(row)}\n" for row in zip(*told, strict=True))
    return _describe(fields)


def _history(column: Column, result: Result) -> Iterator[list[str]]:
    values = column.values(0, len(result.time))
    for one in values.reshape(-1, column.components).T.tolist():
        yield list(map(repr, one))


def _header(file: TextIO, fields: Sequence[Field]) -> None:
    file.write(",".join(name for field in fields for name in _names(field)) + "\n")


def _quoted(text: str) -> str:
    """Quote a label where csv asks for it (RFC 4180)."""
    return '"' + text.replace('"', '""') + '"' if any(sign in text for sign in ',"\r\n') else text
