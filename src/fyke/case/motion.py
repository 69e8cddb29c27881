"""Motion in the case file: held knots that are towed, shaken, turned or led along a record."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PrivateAttr

from .columns import Allowed, Layout, read_columns, too_few, unsorted
from .current_file import refuse, unreadable
from .errors import CaseError, Problem
from .fields import Angle, Direction, Place, Point, Table, Time, Velocity
from .quantity import Quantity
from .units import ANGULAR_SPEED

Array = NDArray[np.float64]

AngularSpeed = Annotated[float, Quantity(ANGULAR_SPEED, -1000.0, 1000.0, unit_needed=True)]

SHIFTS, ANGLES = ("dx", "dy", "dz"), ("roll", "pitch", "yaw")
LAYOUTS = tuple(Layout(("time", *columns), 1, digits=17) for columns in (SHIFTS, SHIFTS + ANGLES, ANGLES))
ALLOWED: dict[str, Allowed] = {
    "time": ("a time from -1e11 to 1e11 s", -1e11, 1e11),
    **dict.fromkeys(SHIFTS, ("a shift from -1e6 to 1e6 m", -1e6, 1e6)),
    **dict.fromkeys(ANGLES, ("an angle from -36000 to 36000 deg", -3.6e4, 3.6e4)),
}


class RotationSpec(Table):
    """A rotation about an axis, to and fro or on and on."""

    axis: Direction | None = Field(
        default=None, description="direction of the axis; it turns right-handed", examples=[[0.0, 1.0, 0.0]]
    )
    point: Point | None = Field(
        default=None,
        description="m, through which the axis goes as built, also of a file's angles; "
        "the middle of the moved knots by default",
        examples=[[0.0, 0.0, 0.0]],
    )
    amplitude: Angle | None = Field(
        default=None, description="to either side, with a period", examples=["5 deg"]
    )
    period: Time | None = Field(
        default=None, description="s, that of the motion by default", examples=["6 s"]
    )
    phase: Angle = Field(
        default=0.0, description="of amplitude sin(2 pi t / period + phase)", examples=["90 deg"]
    )
    rate: AngularSpeed | None = Field(
        default=None, description="instead of amplitude: on and on, at this speed", examples=["10 deg/s"]
    )


class MotionSpec(Table):
    """How held knots move. A Case makes it ready."""

    of: Annotated[tuple[str, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="what is moved: NAME.EDGE, labels of knots, names of gear for all that is held of it; "
        "all held knots by default",
        examples=[["cage.top"]],
    )
    velocity: Velocity | None = Field(default=None, description="m/s, of a tow", examples=[[-0.5, 0.0, 0.0]])
    amplitude: tuple[Place, Place, Place] | None = Field(
        default=None, description="m, of a swing to and fro, with a period", examples=[[0.0, 0.0, 0.5]]
    )
    period: Time | None = Field(default=None, description="s, of the swing", examples=["6 s"])
    phase: Angle = Field(
        default=0.0, description="of amplitude sin(2 pi t / period + phase)", examples=["90 deg"]
    )
    rotation: RotationSpec | None = Field(
        default=None, description="a rotation", examples=[{"axis": [0.0, 1.0, 0.0], "amplitude": "5 deg"}]
    )
    file: str | None = Field(
        default=None,
        description="CSV file, beside the case file: columns time,dx,dy,dz (s, m), time,roll,pitch,yaw (deg) or all",
        examples=["motion.csv"],
    )
    ramp: Time | None = Field(
        default=None, description="s, over which the motion begins smoothly", examples=["2 s"]
    )
    _path: Path | None = PrivateAttr(default=None)

    def settle(self, folder: Path) -> None:
        """Take over, once, the folder that file names count from."""
        self._path = None if self.file is None else folder / self.file

    def record(self) -> MotionRecord | None:
        """Return what its file holds, None without one. CaseError where it cannot be used."""
        return None if self._path is None else read_motion(self._path)

    @property
    def described(self) -> str:
        """What it does, in words."""
        words = []
        if self.velocity is not None:
            words.append(f"velocity ({_numbers(self.velocity)}) m/s")
        if self.amplitude is not None and self.period is not None:
            words.append(f"amplitude ({_numbers(self.amplitude)}) m, period {self.period:g} s")
        words += self._turns()
        if self.file is not None:
            words.append(f"as in {Path(self.file).name}")
        if self.ramp is not None:
            words.append(f"after a ramp of {self.ramp:g} s")
        return ", ".join(words)

    def _turns(self) -> list[str]:
        turn = self.rotation
        if turn is None or turn.axis is None:
            return []
        about = f"about ({_numbers(turn.axis)})"
        if turn.rate is not None:
            return [f"turning at {np.degrees(turn.rate):.4g} deg/s {about}"]
        period = turn.period or self.period or 0.0
        return [f"turning by {np.degrees(turn.amplitude or 0.0):.4g} deg {about}, period {period:g} s"]


def _numbers(vector: tuple[float, float, float]) -> str:
    return ", ".join(f"{value:g}" for value in vector)


class MotionRecord:
    """What a file of a motion holds: times (t,) s from the first on, shifts (t, 3) m, angles (t, 3) rad or None."""

    def __init__(self, columns: tuple[str, ...], table: Array) -> None:
        self.times = table[:, 0] - table[0, 0]
        self.shifts = table[:, 1:4] if "dx" in columns else None
        self.angles = np.radians(table[:, -3:]) if "yaw" in columns else None


def read_motion(path: Path) -> MotionRecord:
    """Read a motion from a CSV file whose first row names its columns, see LAYOUTS.

    CaseError lists every fault of the file, with its row.
    """
    try:
        if not path.is_file():
            raise FileNotFoundError("there is no such file" if not path.exists() else "it is no plain file")
        stat = path.stat()
    except (OSError, ValueError) as error:
        raise CaseError([unreadable(path, error, "a CSV file")]) from None
    return _read(path, (stat.st_dev, stat.st_ino, stat.st_mtime_ns, stat.st_size))


@lru_cache(maxsize=8)
def _read(path: Path, stamp: tuple[int, ...]) -> MotionRecord:
    """Read a file once as long as its stamp is the same: a case is judged, built and shown from it."""
    faults: list[Problem] = []
    layout, rows = read_columns(path, LAYOUTS, ALLOWED, faults)
    whole = not faults
    if layout is not None:
        faults += unsorted(rows, layout)
        if whole and len({row.numbers[0] for row in rows}) < 2:
            faults += too_few(path, rows, layout)
    refuse(path, faults)
    columns = layout.columns if layout else ()
    return MotionRecord(columns, np.array([row.numbers for row in rows]))
