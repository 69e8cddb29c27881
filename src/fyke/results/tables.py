"""Results as plain text: tables of knots and bars, and the summary."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..solve.result import Result
from .derive import bar_lengths
from .whole import replacing

KNOT_COLUMNS = ("knot", "label", "fixed", "x0", "y0", "z0", "x", "y", "z")
BAR_COLUMNS = ("bar", "knot_a", "knot_b", "rest_length", "length", "tension")


def write_tables(result: Result, folder: str | Path) -> tuple[Path, Path]:
    """Write knots.csv and bars.csv of the last frame into a folder, which is made where missing.

    knots.csv: knot,label,fixed,x0,y0,z0,x,y,z: number, label, 1 where held, initial and last position (m).
    bars.csv: bar,knot_a,knot_b,rest_length,length,tension: numbers, m, m, N; of grouped netting the lengths are
    those of the larger bars, the tension is that of one real bar. Knots and bars are counted from 0; numbers carry
    all their digits, so that reading them gives the same float64.
    """
    net, last = result.net, result.frame()
    knots = Path(folder, "knots.csv")
    bars = Path(folder, "bars.csv")
    knots.parent.mkdir(parents=True, exist_ok=True)
    places = np.hstack([net.positions, last.position]).tolist()
    fixed = net.fixed.astype(int).tolist()
    write_table(
        knots,
        KNOT_COLUMNS,
        ((i, net.labels[i], fixed[i], *map(repr, place)) for i, place in enumerate(places)),
    )
    figures = np.column_stack([net.rest_length, bar_lengths(result), last.tension]).tolist()
    write_table(
        bars,
        BAR_COLUMNS,
        ((i, *ends, *map(repr, figures[i])) for i, ends in enumerate(net.bars.tolist())),
    )
    return knots, bars


def write_summary(figures: Mapping[str, Any], folder: str | Path) -> Path:
    """Write what `summary` returned as summary.json into a folder, which is made where missing."""
    path = Path(folder, "summary.json")
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(dict(figures), indent=2, ensure_ascii=False, allow_nan=False)
    with replacing(path) as part:
        part.write_text(text + "\n", encoding="utf-8")
    return path


def write_table(path: Path, columns: tuple[str, ...], rows: Iterable[tuple[Any, ...]]) -> None:
    """Write a table with the names of its columns as CSV, whole or not at all."""
    with replacing(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows(rows)
