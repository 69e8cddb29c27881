"""Claims: what fyke says it can do, each with what it is compared with, how closely it must agree, and why.

A claim is a TOML file of a folder; what it measures is a case file, whose summary is asked by key, or a script beside
it with a function measure(tables) that yields Found, and picture(found) where there is something to draw; or nothing,
where all its rows are missing. Tables are CSV files with the unit of a column at the end of its name.
"""

from __future__ import annotations

import csv
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from pathlib import Path
from typing import Any, Literal

from ..case.errors import CaseError, Problem
from ..case.keys import nearest, unknown_keys

Level = Literal["unit", "exact", "order", "codes", "experiments", "sensitivity", "paper"]
LEVELS: dict[Level, str] = {
    "unit": "Laws and tangents",
    "exact": "Exact solutions",
    "order": "Order of convergence",
    "codes": "Independent codes",
    "experiments": "Experiments",
    "sensitivity": "Sensitivity",
    "paper": "Claims of the original paper",
}
# References that are no number: each of the script's values brings its own; a measurement that nobody has; and none,
# for figures that are shown and not judged.
FOUND, MISSING, NONE = "found", "missing", "none"
WORDS = (FOUND, MISSING, NONE)

_KEYS = {"title", "level", "source", "fast", "script", "case", "needs", "data", "row"}
_NEEDED = ("title", "level", "source", "row")
_ROW_KEYS = {"quantity", "key", "unit", "reference", "tolerance", "relative", "side", "reason"}
# Which side of the reference a value may be on, and how far beyond it is in the tolerance.
SIDES = ("both", "above", "below")
_TABLE_KEYS = {"file", "columns"}

Row = dict[str, float | str]
Tables = Mapping[str, Sequence[Row]]


@dataclass(frozen=True)
class Found:
    """One measured value: of which row (key), of which case within it, and the reference where the row has none."""

    key: str
    ours: float
    reference: float | None = None
    case: str = ""


@dataclass(frozen=True)
class RowSpec:
    """One quantity of a claim: reference a number or one of WORDS; tolerance absolute, or over the reference; side."""

    quantity: str
    key: str
    unit: str
    reference: float | str
    tolerance: float | None
    relative: bool
    reason: str
    side: str = "both"


@dataclass(frozen=True)
class TableSpec:
    """A CSV file and the unit of each column that is used: "text" for one that is no number, "1" for one without unit.

    A cell of a unit that ends in "?" may be empty, which reads as nan.
    """

    file: str
    columns: dict[str, str]


@dataclass(frozen=True)
class Claim:
    """One file of claims.

    fast: cheap enough for a run at every change; script, case: what is measured, one of them, or neither where every
    row is missing; needs: names of packages without which its rows are missing.
    """

    file: Path
    title: str
    level: Level
    source: str
    rows: tuple[RowSpec, ...]
    fast: bool = True
    script: str | None = None
    case: str | None = None
    needs: tuple[str, ...] = ()
    data: tuple[tuple[str, TableSpec], ...] = ()

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.file.stem

    def tables(self) -> dict[str, list[Row]]:
        """Read the tables; CaseError with all that is wrong with them."""
        out: dict[str, list[Row]] = {}
        problems: list[Problem] = []
        for name, spec in self.data:
            try:
                out[name] = _table(self.file.parent / spec.file, spec)
            except CaseError as error:
                problems += error.problems
        if problems:
            raise CaseError(problems)
        return out


def claims_in(folder: Path) -> list[Path]:
    """Files of claims of a folder by name; CaseError where there are none."""
    files = sorted(folder.glob("*.toml")) if folder.is_dir() else []
    if not files:
        found = "no claim (*.toml)" if folder.is_dir() else "no such folder"
        cure = "run it in a checkout of fyke, or name the folder: fyke validate FOLDER"
        raise CaseError([Problem(str(folder), found, "a folder of claims, as validation/ is", cure)])
    return files


def read_claim(file: Path) -> Claim:
    """Read one claim. CaseError with all that is wrong with it."""
    try:
        raw = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise CaseError([Problem(str(file), str(error), "a claim in TOML", "correct the file")]) from None
    problems: list[Problem] = [*unknown_keys(str(file), raw, _KEYS), *_ill_formed(str(file), raw)]
    if problems:
        raise CaseError(problems)
    for key in _NEEDED:
        if not raw.get(key):
            problems.append(
                Problem(f"{file}, {key}", "nothing", f"a claim has {', '.join(_NEEDED)}", f"give {key}")
            )
    if raw.get("level", "unit") not in LEVELS:
        near = nearest(str(raw["level"]), list(LEVELS))
        problems.append(
            Problem(
                f"{file}, level", repr(raw["level"]), ", ".join(LEVELS), f"write {near or 'one of these'}"
            )
        )
    rows, data = raw.get("row", []), raw.get("data", {})
    specs = [_row(f"{file}, row {number}", one, problems) for number, one in enumerate(rows, 1)]
    nothing = all(spec and spec.reference == MISSING for spec in specs)
    if ("script" in raw and "case" in raw) or not ("script" in raw or "case" in raw or nothing):
        found = "both" if "script" in raw else "neither"
        problems.append(Problem(str(file), f"{found} of script and case", "one of them", "give one"))
    for name, one in data.items():
        problems += unknown_keys(f"{file}, data.{name}", one, _TABLE_KEYS)
        if not ("file" in one and "columns" in one):
            problems.append(Problem(f"{file}, data.{name}", "a part of it", "file and columns", "give both"))
    if problems:
        raise CaseError(problems)
    return Claim(
        file=file,
        title=raw["title"],
        level=raw["level"],
        source=raw["source"],
        rows=tuple(spec for spec in specs if spec),
        fast=bool(raw.get("fast", True)),
        script=raw.get("script"),
        case=raw.get("case"),
        needs=tuple(raw.get("needs", ())),
        data=tuple((name, TableSpec(one["file"], one["columns"])) for name, one in data.items()),
    )


def _ill_formed(where: str, raw: dict[str, Any]) -> list[Problem]:
    """Keys whose values are of no use as what they are."""
    words = {"title", "level", "source", "script", "case"}
    shapes = {
        "a text": [key for key in words if not isinstance(raw.get(key, ""), str)],
        "true or false": [key for key in ("fast",) if not isinstance(raw.get(key, True), bool)],
        "a list of texts": [key for key in ("needs",) if not _is_list(raw.get(key, []), str)],
        "tables, [[row]]": [key for key in ("row",) if not _is_list(raw.get(key, []), dict)],
        "tables with file and columns, [data.NAME]": [
            key for key in ("data",) if not _are_tables(raw.get(key, {}))
        ],
    }
    return [
        Problem(f"{where}, {key}", repr(raw[key])[:60], allowed, f"write {allowed}")
        for allowed, keys in shapes.items()
        for key in sorted(keys)
    ]


def _is_list(value: Any, of: type) -> bool:
    return isinstance(value, list) and all(isinstance(one, of) for one in value)


def _are_tables(value: Any) -> bool:
    return isinstance(value, dict) and all(
        isinstance(one, dict)
        and isinstance(one.get("file", ""), str)
        and isinstance(one.get("columns", {}), dict)
        and all(isinstance(unit, str) for unit in one.get("columns", {}).values())
        for one in value.values()
    )


def _row(where: str, raw: dict[str, Any], problems: list[Problem]) -> RowSpec | None:
    """Read one row, or add to the problems what is wrong with it."""
    wrong = unknown_keys(where, raw, _ROW_KEYS)
    for key in ("quantity", "key", "unit"):
        if not isinstance(raw.get(key), str):
            wrong.append(Problem(f"{where}, {key}", repr(raw.get(key)), "a text", f"give {key}"))
    reference = raw.get("reference", FOUND)
    is_number = isinstance(reference, int | float) and isfinite(reference)
    if not is_number and reference not in WORDS:
        wrong.append(
            Problem(f"{where}, reference", repr(reference), f"a number or {', '.join(WORDS)}", "give one")
        )
    if str(raw.get("side", "both")) not in SIDES:
        wrong.append(Problem(f"{where}, side", repr(raw["side"]), ", ".join(SIDES), "write one of these"))
    judged = reference not in (MISSING, NONE)
    given = [key for key in ("tolerance", "relative") if key in raw]
    if judged and len(given) != 1:
        found = "both tolerance and relative" if given else "no tolerance"
        wrong.append(
            Problem(
                where, found, "tolerance (in the row's unit) or relative (over the reference)", "give one"
            )
        )
    for key in given:
        if not (isinstance(raw[key], int | float) and isfinite(raw[key]) and raw[key] >= 0.0):
            wrong.append(Problem(f"{where}, {key}", repr(raw[key]), "a number from 0", "correct it"))
    if not str(raw.get("reason", "")).strip():
        allowed = "why this is close enough, or why there is nothing to compare with"
        wrong.append(Problem(f"{where}, reason", "no reason", allowed, "say where the tolerance comes from"))
    problems += wrong
    if wrong:
        return None
    return RowSpec(
        quantity=raw["quantity"],
        key=raw["key"],
        unit=raw["unit"],
        reference=reference if isinstance(reference, str) else float(reference),
        tolerance=float(raw[given[0]]) if given else None,
        relative="relative" in raw,
        reason=raw["reason"],
        side=raw.get("side", "both"),
    )


def _table(file: Path, spec: TableSpec) -> list[Row]:
    """Rows of a CSV file by the names of the columns without their units."""
    try:
        lines = [line for line in file.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    except (OSError, ValueError) as error:
        raise CaseError([Problem(str(file), str(error), "a CSV file", "check the name")]) from None
    rows = list(csv.DictReader(lines))
    there = list(rows[0]) if rows else []
    problems, columns = [], {}
    for name, unit in spec.columns.items():
        plain, own = unit in {"text", "1", "1?"}, unit.rstrip("?")
        wanted = name if plain else f"{name}_{own.replace('/', '_')}"
        same = [wanted, wanted if plain else f"{name}_{own.replace('/', '_per_')}"]
        if any(one in there for one in same):
            columns[name] = next(one for one in same if one in there)
            continue
        other = [one for one in there if one == name or one.startswith(f"{name}_")]
        found = f"column {other[0]}" if other else f"no column {wanted}"
        allowed = f"a column {wanted}" if plain else f"{name} in {unit}, a column {wanted}"
        problems.append(
            Problem(str(file), found, allowed, "correct the unit" if other else "correct the file")
        )
    if problems:
        raise CaseError(problems)
    return [
        {name: _value(file, number, row[column], spec.columns[name]) for name, column in columns.items()}
        for number, row in enumerate(rows, 1)
    ]


def _value(file: Path, number: int, text: str | None, unit: str) -> float | str:
    if unit == "text":
        return text or ""
    if unit.endswith("?") and not text:
        return nan
    try:
        return float(text or "")
    except ValueError:
        found = repr(text) if text else "nothing"
        raise CaseError(
            [Problem(f"{file}, row {number}", found, f"a number ({unit})", "correct the file")]
        ) from None
