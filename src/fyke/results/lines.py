"""Figures of lines: what each mooring line bears, how it leaves its ends, and how much of it lies on the sea bed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.bed import OnBed
from ..netting.net import Rope
from ..solve.result import Result
from ..system.system import System
from .audit import as_solved
from .tables import write_table

Array = NDArray[np.float64]

TABLE = "lines.csv"
ENDS = ("from", "to")


@dataclass(frozen=True)
class LineFigures:
    """What one line bears, in the last frame unless said otherwise.

    length: m, unloaded; tension_from, tension_to: N, of the bars at its beginning and at its end; horizontal_from,
    vertical_from: N, parts of tension_from, which pulls up at its beginning where vertical_from is positive;
    uplift_from: deg, of the line above level there; held_from: whether that is an anchor; horizontal_to, vertical_to,
    uplift_to, held_to: the same at its end; max_tension: N; peak_tension: N, largest of all frames; utilisation:
    largest of all frames and bars over the breaking strength of the twine, None where none is known; on_bed: m,
    unloaded, of its bars that lie on the sea bed from end to end, None without a bed.
    """

    name: str
    length: float
    tension_from: float
    horizontal_from: float
    vertical_from: float
    uplift_from: float
    held_from: bool
    tension_to: float
    horizontal_to: float
    vertical_to: float
    uplift_to: float
    held_to: bool
    max_tension: float
    peak_tension: float
    utilisation: float | None
    on_bed: float | None


def by_line(system: System, result: Result) -> tuple[LineFigures, ...]:
    """Return the figures of every line; system: the one that the result was solved with."""
    bearing = None
    ground = _ground(system, result)
    if ground is not None:
        bearing = np.zeros(system.net.knot_count, dtype=bool)
        bearing[ground.knots] = ground.force[:, 2] > 0.0
    return tuple(_line(system, result, one, bearing) for one in system.net.ropes if one.kind == "line")


def _ground(system: System, result: Result) -> OnBed | None:
    """The ground as it bears the last frame."""
    system, last = as_solved(system, result), result.frame()
    if system.bed is None:
        return None
    ground = OnBed(system, system.bed)
    ground.see(last.position, last.velocity, last.time)
    return ground


def bed_force(system: System, result: Result) -> Array | None:
    """Force (3,) N of the sea bed on the net in the last frame, None without one."""
    ground = _ground(system, result)
    return None if ground is None else ground.force.sum(axis=0)


def _line(system: System, result: Result, line: Rope, bearing: NDArray[np.bool_] | None) -> LineFigures:
    net, own = system.net, line.bars
    x, tension = result.position[-1], result.tension[-1, own]
    ends = []
    for bar, (at, next_to) in ((0, line.knots[:2]), (-1, line.knots[[-1, -2]])):
        way = x[next_to] - x[at]
        way /= max(float(np.linalg.norm(way)), np.finfo(float).tiny)
        ends.append((float(tension[bar]), float(np.hypot(way[0], way[1])), float(way[2])))
    (begin, level, up), (end, level_to, up_to) = ends
    strength = np.array([t.breaking_strength or np.inf for t in net.twines])[net.twine_of_bar[own]]
    peak = result.tension[:, own].max(axis=0)
    lies = None if bearing is None else bearing[net.bars[own]].all(axis=1)
    return LineFigures(
        name=line.name,
        length=float(net.rest_length[own].sum()),
        tension_from=begin,
        horizontal_from=begin * level,
        vertical_from=begin * up,
        uplift_from=float(np.degrees(np.arctan2(up, level))),
        held_from=bool(net.fixed[line.knots[0]]),
        tension_to=end,
        horizontal_to=end * level_to,
        vertical_to=end * up_to,
        uplift_to=float(np.degrees(np.arctan2(up_to, level_to))),
        held_to=bool(net.fixed[line.knots[-1]]),
        max_tension=float(tension.max()),
        peak_tension=float(peak.max()),
        utilisation=float(np.max(peak / strength)) if np.isfinite(strength).any() else None,
        on_bed=None if lies is None else float(net.rest_length[own][lies].sum()),
    )


def line_figures(system: System, result: Result) -> dict[str, Any]:
    """Return what summary.json tells of lines, the figures of `by_line`, and of the sea bed, its force on the net."""
    told: dict[str, Any] = {}
    lines = by_line(system, result)
    if lines:
        told["lines"] = [asdict(one) for one in lines]
    force = bed_force(system, result)
    return told if force is None else told | {"bed_force": force.tolist()}


COLUMNS = (
    *("name", "length", "tension_from", "horizontal_from", "vertical_from", "uplift_from", "held_from"),
    *("tension_to", "horizontal_to", "vertical_to", "uplift_to", "held_to"),
    *("max_tension", "peak_tension", "utilisation", "on_bed"),
)


def write_lines(lines: list[dict[str, Any]], folder: str | Path) -> Path:
    """Write the lines of a summary as lines.csv into a folder: a row each, N, m, deg."""
    path = Path(folder, TABLE)
    rows = [tuple(_cell(line[column]) for column in COLUMNS) for line in lines]
    write_table(path, COLUMNS, rows)
    return path


def _cell(value: Any) -> Any:
    if isinstance(value, bool):
        return int(value)
    return "" if value is None else repr(value) if isinstance(value, float) else value


def line_words(figures: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Say what there is of lines and the sea bed in a summary, in names and texts for a reader."""
    rows = []
    lines = figures.get("lines", ())
    if lines:
        most = max(lines, key=lambda line: float(line["peak_tension"]))
        rows.append(
            ("largest tension of a line", f"{most['peak_tension']:.4g} N, {most['name']}".rstrip(" ,"))
        )
    anchored = [
        (line[f"uplift_{end}"], line["name"]) for line in lines for end in ENDS if line[f"held_{end}"]
    ]
    if anchored:
        angle, name = max(anchored)
        rows.append(("steepest at an anchor", f"{angle:.3g}°, {name}".rstrip(" ,")))
    if any(line["on_bed"] for line in lines):
        least, most = (pick(line["on_bed"] for line in lines) for pick in (min, max))
        span = f"{least:.4g}" if least == most else f"{least:.4g} to {most:.4g}"
        rows.append(("of a line on the sea bed", f"{span} m"))
    if "bed_force" in figures:
        force, rounding = figures["bed_force"], 1e-9 * max(map(abs, figures["bed_force"]))
        told = ", ".join(f"{f if abs(f) > rounding else 0.0:.4g}" for f in force)
        rows.append(("force of the sea bed", f"[{told}] N"))
    return rows
