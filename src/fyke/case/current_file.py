"""A current that was measured or computed elsewhere, read from a CSV or netCDF file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..water import SeriesCurrent
from .columns import Allowed, Layout, Row, read_columns, unsorted
from .errors import CaseError, Problem

Array = NDArray[np.float64]

# Times may be seconds since some date: they keep all their digits.
LAYOUTS = tuple(
    Layout((*places, *parts), len(places), digits=17)
    for places in (("time",), ("time", "depth"))
    for parts in (("u", "v", "w"), ("u", "v"))
)
NETCDF = (".nc", ".nc4", ".cdf")
MOST_PROBLEMS = 20  # of one file that are told one by one
# What a number may be: words, lowest, highest. They catch a wrong unit or a mark for a missing value.
ALLOWED: dict[str, Allowed] = {
    "time": ("a time from -1e11 to 1e11 s", -1e11, 1e11),
    "depth": ("a depth below still water from 0 to 1e4 m, counted downwards", 0.0, 1e4),
    **dict.fromkeys("uvw", ("a velocity from -100 to 100 m/s", -100.0, 100.0)),
}


def read_current(path: str | Path, bed: float | None = None) -> SeriesCurrent:
    """Read velocities at times and depths; times as in the file (s), depths in m below still water.

    A CSV file names its columns in the first row: time,u,v,w or time,depth,u,v,w in s, m and m/s, w left out where it
    is 0; the times rise and, at each, the same depths. A netCDF file has the variables time, u, v and, where they are
    needed, depth and w, each with its units. bed: depth of the sea bed (m), None where it is not known.
    CaseError lists every fault of the file, with its row.
    """
    file = Path(path)
    try:
        if not file.is_file():
            raise FileNotFoundError("there is no such file" if not file.exists() else "it is no plain file")
        stat = file.stat()
    except (OSError, ValueError) as error:
        raise CaseError([unreadable(file, error, "a CSV or netCDF file")]) from None
    return _read(file, bed, (stat.st_dev, stat.st_ino, stat.st_mtime_ns, stat.st_size))


@lru_cache(maxsize=4)
def _read(file: Path, bed: float | None, stamp: tuple[int, ...]) -> SeriesCurrent:
    """Read a file once as long as its stamp is the same: a case is judged, built and shown from it."""
    if file.suffix.lower() in NETCDF:
        from .current_netcdf import read_netcdf

        times, depths, velocities = read_netcdf(file, bed)
    else:
        times, depths, velocities = _read_csv(file, bed)
    return SeriesCurrent(times, depths, velocities)


def unreadable(file: Path, error: Exception, allowed: str) -> Problem:
    """Return the problem of a file that cannot be opened or taken apart."""
    lines = str(getattr(error, "strerror", None) or error).strip().splitlines()
    reason = lines[0] if lines else type(error).__name__
    cure = "check the name; it counts from the folder of the case file"
    return Problem(str(file), f"it cannot be read: {reason}", allowed, cure)


def refuse(file: Path, problems: Iterable[Problem]) -> None:
    """Raise CaseError with the first problems and how many more there are; nothing without one."""
    found = list(problems)
    more = len(found) - MOST_PROBLEMS
    if more > 0:
        last = Problem(str(file), f"{more} more like these", "none of them", "correct these first")
        found = [*found[:MOST_PROBLEMS], last]
    if found:
        raise CaseError(found)


def too_deep(where: str, depth: float, bed: float) -> Problem:
    """Return the problem of a depth (m) below the sea bed (m)."""
    cure = "leave it out, or check [water] depth"
    return Problem(where, f"{depth:.10g} m", f"a depth down to the sea bed at {bed:g} m", cure)


def _read_csv(file: Path, bed: float | None) -> tuple[Array, Array, Array]:
    faults: list[Problem] = []
    layout, rows = read_columns(file, LAYOUTS, ALLOWED, faults)
    whole = not faults  # a row with a fault would also be missed as a gap
    if layout is not None:
        faults += unsorted(rows, layout)
        if whole and not rows:
            faults.append(Problem(str(file), "no row of numbers", "one or more", "add the velocities"))
        if whole and layout.places > 1:
            faults += _gaps(file, rows)
        if layout.places > 1:
            faults += _below(rows, bed)
    refuse(file, faults)
    return _grid(np.array([row.numbers for row in rows]), layout.places if layout else 1)


def _gaps(file: Path, rows: list[Row]) -> Iterator[Problem]:
    """Yield a problem for every time without all the depths."""
    there: dict[float, set[float]] = {}
    for time, depth in (row.numbers[:2] for row in rows):
        there.setdefault(time, set()).add(depth)
    depths = set().union(*there.values())
    for time, some in there.items():
        if len(some) < len(depths):
            missing = ", ".join(f"{depth:.10g}" for depth in sorted(depths - some)[:5])
            found = f"no row for time {time:.10g} s at depth {missing} m"
            cure = "add the rows, or leave these depths out everywhere"
            yield Problem(str(file), found, "every depth at every time", cure)


def _below(rows: list[Row], bed: float | None) -> Iterator[Problem]:
    """Yield a problem for the first row with each depth below the sea bed."""
    seen: set[float] = set()
    for row in rows:
        depth = row.numbers[1]
        if bed is not None and depth > bed and depth not in seen:
            seen.add(depth)
            yield too_deep(f"{row.where}, column depth", depth, bed)


def _grid(table: Array, keys: int) -> tuple[Array, Array, Array]:
    """Return times (t,), depths (k,) and velocities (t, k, 3) of a table without gaps, sorted."""
    times = np.unique(table[:, 0])
    depths = np.unique(table[:, 1]) if keys == 2 else np.zeros(1)
    velocities = np.zeros((len(times), len(depths), 3))
    velocities[..., : table.shape[1] - keys] = table[:, keys:].reshape(len(times), len(depths), -1)
    return times, depths, velocities
