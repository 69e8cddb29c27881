"""What the comparisons with computed solutions share: their tables, a twine of given stiffness, and emptiness."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

import fyke

# Neither water nor gravity, and forces of the water switched off: what is left is dead load and elasticity.
NO_WATER = fyke.Water(density=0.0, gravity=0.0)
NO_FORCES = fyke.Coefficients(0.0, 0.0, 0.0, 0.0, 0.0)

Row = dict[str, str | float]


def table(name: str) -> list[Row]:
    """Rows of tests/data/NAME.csv, numbers as numbers; an empty cell stays an empty text."""
    text = (Path(__file__).parent / "data" / f"{name}.csv").read_text(encoding="utf-8")
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


def thread(ea: float, diameter: float = 1e-3, density: float = 1000.0) -> fyke.Twine:
    """Twine of tensile stiffness EA (N)."""
    return fyke.Twine("thread", density, diameter, fyke.LinearLaw(ea / (np.pi / 4.0 * diameter**2)))
