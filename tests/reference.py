"""What the comparisons with computed solutions share: their tables, a twine of given stiffness, and emptiness."""

from __future__ import annotations

import csv
from pathlib import Path

from fyke.study.claims import Row, read_claim
from lines import NO_FORCES, NO_WATER, thread

__all__ = ["NO_FORCES", "NO_WATER", "VALIDATION", "grouped", "panel_case", "rows_of_claim", "table", "thread"]

VALIDATION = Path(__file__).parents[1] / "validation"


def table(name: str) -> list[Row]:
    """Rows of validation/data/NAME.csv, numbers as numbers; an empty cell stays an empty text."""
    text = (VALIDATION / "data" / f"{name}.csv").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return [{key: _number(cell) for key, cell in row.items()} for row in csv.DictReader(lines)]


def grouped(name: str, key: str = "case") -> dict[str, list[Row]]:
    """Rows of a table by the text in one column."""
    out: dict[str, list[Row]] = {}
    for row in table(name):
        out.setdefault(str(row[key]), []).append(row)
    return out


def _number(cell: str) -> str | float:
    try:
        return float(cell)
    except ValueError:
        return cell


def rows_of_claim(name: str, table: str) -> list[Row]:
    """Rows of a table of validation/NAME.toml, by the names of its columns without their units."""
    return read_claim(VALIDATION / f"{name}.toml").tables()[table]


def panel_case(meshes: int, side: float, *, title: str = "", knots: str = "", more: str = "") -> str:
    """Case file of a diamond panel on a square frame of so many meshes and a side (m); knots: of the netting table."""
    return f"""
schema = 1
title = "{title}"
[current]
velocity = [0.5, 0.0, 0.0]
[twine.main]
density = 1140.0
diameter = "1.5 mm"
youngs_modulus = "1.0 GPa"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "30 mm"
{knots}
[[gear]]
kind = "panel"
netting = "main"
meshes = [{meshes}, {meshes}]
size = [{side}, {side}]
{more}
"""
