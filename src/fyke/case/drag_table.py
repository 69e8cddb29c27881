"""A user's own drag coefficients, read from a CSV file."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..water.laws import AngleTable, BarTable
from .columns import Allowed, Layout, Row, read_columns, too_few, unsorted
from .errors import CaseError, Problem

BY_SPEED = Layout(("reynolds", "normal", "tangential"), 1)
BY_ANGLE = Layout(("reynolds", "angle", "drag", "lift"), 2)
_COEFFICIENT = ("a number from 0 to 1e9", 0.0, 1e9)
_ALLOWED: dict[str, Allowed] = {
    "reynolds": ("a number from 1e-6 to 1e9", 1e-6, 1e9),
    "angle": ("an angle from 0 (along the bar) to 90 deg (across)", 0.0, 90.0),
    "normal": _COEFFICIENT,
    "tangential": _COEFFICIENT,
    "drag": _COEFFICIENT,
    "lift": ("a number from -1e9 to 1e9", -1e9, 1e9),
}


def read_drag_table(path: str | Path) -> BarTable | AngleTable:
    """Read coefficients of a bar on d l from a CSV file whose first row names its columns.

    reynolds,normal,tangential: C_n and C_t, one row for each Reynolds number, rising; or reynolds,angle,drag,lift:
    C_D and C_L for every angle (deg, 90 across the bar) at every Reynolds number, both rising, the angle faster.
    CaseError lists every fault of the file, with its row.
    """
    problems: list[Problem] = []
    layout, rows = read_columns(Path(path), (BY_SPEED, BY_ANGLE), _ALLOWED, problems)
    whole = not problems  # a row with a fault would also be missed as a gap
    if layout is not None:
        problems += unsorted(rows, layout)
    if layout is not None and whole:
        problems += too_few(Path(path), rows, layout)
        problems += _gaps(path, rows) if layout is BY_ANGLE else ()
    if problems:
        raise CaseError(problems)
    if layout is BY_SPEED:
        reynolds, normal, tangential = zip(*(row.numbers for row in rows), strict=True)
        return BarTable(reynolds, normal, tangential)
    steps = tuple(dict.fromkeys(row.numbers[0] for row in rows))
    angles = tuple(math.radians(one) for one in dict.fromkeys(row.numbers[1] for row in rows))
    grid = np.array([row.numbers[2:] for row in rows]).reshape(len(steps), len(angles), 2)
    drag, lift = (tuple(map(tuple, grid[:, :, which].tolist())) for which in (0, 1))
    return AngleTable(steps, angles, drag, lift)


def _gaps(path: str | Path, rows: list[Row]) -> Iterator[Problem]:
    """Yield a problem for every Reynolds number without all the angles."""
    seen = {row.numbers[:2] for row in rows}
    angles = sorted({angle for _, angle in seen})
    for step in sorted({reynolds for reynolds, _ in seen}):
        missing = [f"{angle:.10g}" for angle in angles if (step, angle) not in seen]
        if missing:
            found = f"no row for reynolds {step:.10g} at angle {', '.join(missing)}"
            cure = "add the rows, or leave these angles out everywhere"
            yield Problem(str(path), found, "every angle at every Reynolds number", cure)
