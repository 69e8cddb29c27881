"""Rows of knots that a case file may point into by "NAME:k": ropes and lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from ..netting.references import IN_ROW
from .gear import NettingSpec, Sheet
from .keys import nearest
from .lines import LaidSpec, MooringsSpec
from .places import Path
from .rigging import RopeSpec
from .tubes import RingSpec, TubularSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts

Sheets = Mapping[str, tuple[Sheet, NettingSpec]]


def rows_of(parts: Parts, sheets: Sheets) -> dict[str, int]:
    """Return the number of the last knot of every rope and line that is good by itself, by name.

    Moorings are there as "NAME 1", "NAME 2" ..., and as NAME for all of them.
    """
    rows = {}
    along: dict[int, RopeSpec | TubularSpec] = {**parts.ropes, **parts.tubulars}
    for index, rope in along.items():
        if isinstance(rope, RingSpec) and rope.free and rope.knots is not None:
            rows[parts.name_of(index)] = rope.knots
        name, _, side = (rope.along or "").rpartition(".")
        sheet, netting = sheets.get(name, (None, None))
        if sheet is not None and netting is not None and side in sheet.edges:
            rows[parts.name_of(index)] = sheet.edge(side, netting.mesh)[0] - (not sheet.closed)
    for index, line in parts.lines.items():
        name = parts.name_of(index)
        rows |= dict.fromkeys(lines_of(line, name), line.bars)
        rows[name] = line.bars
    return rows


def length_of(parts: Parts, name: str) -> float:
    """Unloaded length (m) of the line of a name, 0 where it is not known."""
    for index, line in parts.lines.items():
        if name in (parts.name_of(index), *lines_of(line, parts.name_of(index))):
            return sum(piece.length for piece in line.asked)
    return 0.0


def lines_of(part: LaidSpec, name: str) -> list[str]:
    """Names of the lines of a part of a name."""
    return part.names(name) if isinstance(part, MooringsSpec) else [name]


def in_row_findings(path: Path, what: str, label: str, rows: Mapping[str, int]) -> Iterator[Finding]:
    """What is wrong with a label "NAME:k"; what: who hangs there."""
    match = IN_ROW.fullmatch(label)
    if match is None:
        return
    found = f"{written(label)} of {what}"
    if match[1] not in rows:
        near = nearest(match[1], rows) or next(iter(rows), "NAME")
        allowed = '"NAME:k", the k-th knot of a rope or line, NAME one of '
        allowed += ", ".join(written(one) for one in rows) or "those of [[gear]], which has none"
        yield path, found, allowed, f'did you mean "{near}:{match[2]}"? netting has labels "NAME:0-0"'
    elif int(match[2]) > rows[match[1]]:
        last = rows[match[1]]
        yield path, found, f"a knot of '{match[1]}': 0 to {last}", f'write "{match[1]}:{last}" for its end'
