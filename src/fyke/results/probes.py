"""The motion of the water at fixed points through a run in waves."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..solve.result import Result
from ..system.system import System
from ..water.current import Current
from ..water.waves import Waves
from .tables import write_table

Array = NDArray[np.float64]

COLUMNS = ("time", "probe", "x", "y", "z", "wet", "elevation", "u", "v", "w", "ax", "ay", "az")


@dataclass(frozen=True)
class Probes:
    """What k moments and m points saw.

    time: (k,) s; points: (m, 3) m; elevation: (k, m) m of the surface above z = 0; wet: (k, m), whether the point was
    in the water; velocity: (k, m, 3) m/s, current and waves; acceleration: (k, m, 3) m/s2, of the waves. Both are 0
    where the point was dry.
    """

    time: Array
    points: Array
    elevation: Array
    wet: NDArray[np.bool_]
    velocity: Array
    acceleration: Array


def probe(current: Current, waves: Waves, times: ArrayLike, points: ArrayLike) -> Probes:
    """Ask current and waves for the motion of the water at points (m, 3) m and times (k,) s."""
    time = np.atleast_1d(np.asarray(times, dtype=float))
    place = np.atleast_2d(np.asarray(points, dtype=float))
    moved = [waves.motion(place, float(one)) for one in time]
    elevation = np.array([one.elevation for one in moved])
    wet = place[:, 2] <= elevation
    steady = np.array([current.velocity(place, float(one)) for one in time])
    velocity = (steady + [one.velocity for one in moved]) * wet[:, :, None]
    return Probes(time, place, elevation, wet, velocity, np.array([one.acceleration for one in moved]))


def probes_of(system: System, result: Result, points: ArrayLike) -> Probes | None:
    """Ask for the motion of the water at points (m, 3) m through a run; None without waves and for one moment."""
    if system.waves is None or len(result.time) < 2:
        return None
    return probe(system.current, system.waves, result.time, points)


def write_probes(probes: Probes, folder: str | Path) -> Path:
    """Write waves.csv into a folder, which is made where missing, and return it.

    time,probe,x,y,z,wet,elevation,u,v,w,ax,ay,az: s, number from 0, m, 1 in the water, m, m/s, m/s2; all points of
    a moment together. Numbers carry all their digits.
    """
    path = Path(folder, "waves.csv")
    path.parent.mkdir(parents=True, exist_ok=True)
    places, wet = probes.points.tolist(), probes.wet.astype(int).tolist()
    figures = np.concatenate(
        [probes.elevation[:, :, None], probes.velocity, probes.acceleration], axis=2
    ).tolist()
    write_table(
        path,
        COLUMNS,
        (
            (repr(time), number, *map(repr, place), wet[moment][number], *map(repr, figures[moment][number]))
            for moment, time in enumerate(probes.time.tolist())
            for number, place in enumerate(places)
        ),
    )
    return path
