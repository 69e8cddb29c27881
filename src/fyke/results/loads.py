"""Load cases side by side: what the current and the sea of each did to the same gear, in one table.

The columns are of the kinds that assessments after NS 9415 ask for; the standard itself was not read.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..solve.result import Result
from ..system.system import System
from .tables import write_table
from .water import mean_current, water_figures

TABLE, PARTS_TABLE = "loads.csv", "loads_by_part.csv"
# Kinds of parts that are moorings.
MOORINGS = ("line", "mooring")


@dataclass(frozen=True)
class PartLoad:
    """What one part bore in one load case, the largest of all frames.

    tension: N; utilisation: tension times both factors over the breaking strength, None where none is known; drag,
    lift: N, in the last frame, None without a flow; support: N, size of its force on its supports in the last frame.
    """

    kind: str
    name: str
    tension: float
    utilisation: float | None
    drag: float | None
    lift: float | None
    support: float

    @property
    def called(self) -> str:
        """Kind and name."""
        return f"{self.kind} {self.name}".rstrip()


@dataclass(frozen=True)
class LoadRow:
    """One load case. Forces are as they were solved: the factors count in the utilisation alone.

    outcome: how the solve ended; current: m/s, mean over the net as built, towards: deg from +x turning to +y, None
    in still water; wave_height (m, significant of an irregular sea), wave_period (s, of its peak), waves_towards
    (deg): None without waves; support_force: N, largest of all frames; drag: N, in the last frame; tension: N,
    largest of all parts and frames, in tension_part; mooring_tension: that of moorings alone, None without them;
    collar_force: N, size of the force of the netting on the collar, the largest of several, in the last frame, None
    without one; utilisation: the largest of all parts, in utilisation_part; volume_left: share of the volume as
    built in the worst frame, None of netting that encloses none; displacement: m, largest of a knot from where it
    was built; clearance: m, least above the sea bed, None without a depth; parts: those with bars.
    """

    name: str
    outcome: str
    ok: bool
    current: float
    towards: float | None
    wave_height: float | None
    wave_period: float | None
    waves_towards: float | None
    load_factor: float
    material_factor: float
    support_force: float
    drag: float | None
    tension: float
    tension_part: str
    mooring_tension: float | None
    mooring_part: str
    collar_force: float | None
    utilisation: float | None
    utilisation_part: str
    volume_left: float | None
    displacement: float
    clearance: float | None
    parts: tuple[PartLoad, ...]


def load_row(
    name: str,
    system: System,
    result: Result,
    figures: dict[str, Any],
    *,
    load_factor: float = 1.0,
    material_factor: float = 1.0,
) -> LoadRow:
    """Return the row of one load case; figures: its summary with the figures of its parts (results.part_figures)."""
    factor = load_factor * material_factor
    parts = tuple(_part(part, factor) for part in figures["parts"])
    borne = [part for part in parts if part.tension > 0.0]
    most = max(borne, key=lambda part: part.tension, default=None)
    moored = [part for part in parts if part.kind in MOORINGS]
    line = max(moored, key=lambda part: part.tension, default=None)
    used = [part for part in parts if part.utilisation is not None]
    worst = max(used, key=lambda part: part.utilisation or 0.0, default=None)
    flow = mean_current(system)
    volume = figures.get("volume_smallest")
    return LoadRow(
        name=name,
        outcome=result.outcome.name,
        ok=result.outcome.ok,
        current=float(np.linalg.norm(flow)),
        towards=_degrees(flow.tolist()) if flow.any() else None,
        **_sea(water_figures(system, result).get("waves")),
        load_factor=load_factor,
        material_factor=material_factor,
        support_force=float(np.linalg.norm(result.support_reaction, axis=1).max()),
        drag=figures["drag"],
        tension=most.tension if most else 0.0,
        tension_part=most.called if most else "",
        mooring_tension=line.tension if line else None,
        mooring_part=line.called if line else "",
        collar_force=_on_collars(figures),
        utilisation=worst.utilisation if worst else None,
        utilisation_part=worst.called if worst else "",
        volume_left=None if volume is None else volume / figures["volume_unloaded"],
        displacement=max(float(_moved(result, k)) for k in range(len(result.time))),
        clearance=figures.get("clearance"),
        parts=tuple(part for part in parts if part.kind not in ("float", "sinker")),
    )


def worst_of(rows: Sequence[LoadRow]) -> int | None:
    """Return which row is the worst: by utilisation where any is known, else by the force on the supports.

    None where no row came to its end.
    """
    there = [i for i, row in enumerate(rows) if row.ok]
    known = [i for i in there if rows[i].utilisation is not None]
    if known:
        return max(known, key=lambda i: rows[i].utilisation or 0.0)
    return max(there, key=lambda i: rows[i].support_force, default=None)


def load_figures(rows: Sequence[LoadRow]) -> dict[str, Any]:
    """Return what summary.json tells of the load cases: load_cases, a table each, and worst_load_case, its name."""
    worst = worst_of(rows)
    return {
        "load_cases": [asdict(row) | {"parts": [asdict(part) for part in row.parts]} for row in rows],
        "worst_load_case": None if worst is None else rows[worst].name,
    }


_OWN = [name for name in LoadRow.__dataclass_fields__ if name not in ("parts", "ok")]
COLUMNS = ("load_case", *_OWN[1:], "worst")
PART_COLUMNS = ("load_case", *PartLoad.__dataclass_fields__)


def write_loads(rows: Sequence[LoadRow], folder: str | Path) -> tuple[Path, Path]:
    """Write loads.csv, a row for each load case, and loads_by_part.csv, a row for each of its parts, into a folder.

    SI units, angles in degrees, empty where there is nothing; worst is 1 in the row of the worst and 0 in the others.
    """
    worst = worst_of(rows)
    whole = ((*(_cell(getattr(row, name)) for name in _OWN), int(i == worst)) for i, row in enumerate(rows))
    single = (
        (row.name, *(_cell(getattr(part, name)) for name in PART_COLUMNS[1:]))
        for row in rows
        for part in row.parts
    )
    loads, by_part = Path(folder, TABLE), Path(folder, PARTS_TABLE)
    write_table(loads, COLUMNS, whole)
    write_table(by_part, PART_COLUMNS, single)
    return loads, by_part


def _part(part: dict[str, Any], factor: float) -> PartLoad:
    used = part["utilisation"]
    return PartLoad(
        kind=part["kind"],
        name=part["name"],
        tension=part["peak_tension"],
        utilisation=None if used is None else factor * used,
        drag=part["drag"],
        lift=part["lift"],
        support=math.hypot(*part["support_reaction"]),
    )


def _sea(waves: dict[str, Any] | None) -> dict[str, float | None]:
    if waves is None:
        return {"wave_height": None, "wave_period": None, "waves_towards": None}
    return {
        "wave_height": waves.get("height", waves.get("significant_height")),
        "wave_period": waves.get("period", waves.get("peak_period")),
        "waves_towards": _degrees(waves["direction"]),
    }


def _on_collars(figures: dict[str, Any]) -> float | None:
    """Size (N) of the force of the netting on the collar, the largest of several; None without one."""
    sizes = [math.hypot(*one["from_netting"]) for one in figures.get("rings", ()) if one["kind"] == "collar"]
    return max(sizes, default=None)


def _degrees(vector: Sequence[float]) -> float:
    """Direction of a vector in the horizontal plane, deg from +x turning to +y."""
    return math.degrees(math.atan2(vector[1], vector[0]))


def _moved(result: Result, frame: int) -> float:
    return float(np.linalg.norm(result.position[frame] - result.net.positions, axis=1).max())


def _cell(value: object) -> object:
    return "" if value is None else repr(value) if isinstance(value, float) else value
