"""The layout of a result file: netCDF-4, every array in one piece at a place that never moves.

Contiguous arrays of fixed size, allocated when the file is laid out, let a run write its outputs straight
into their places afterwards, without a change to any of the structures by which the file is read.
"""

from __future__ import annotations

import errno
import os
import platform
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from io import FileIO
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np
from numpy.typing import NDArray

from ..netting.net import Net
from ..version import __version__
from .encoding import PARTS, case_hash, case_title, parts_to_text, twines_to_text
from .fields import AXES, FRAME_FIELDS, NET_FIELDS, SCHEMA, WEIGHT, Field

Array = NDArray[np.float64]
FLOAT = np.dtype("<f8")
# Sizes in a file, generous: of a knot with its label, of a bar, and of everything else, twines and panels included.
BYTES_OF_KNOT, BYTES_OF_BAR, BYTES_BESIDES = 140, 50, 100_000
RUNNING = {"outcome": "running"}


@dataclass(frozen=True)
class Content:
    """What a result file says besides its frames: the net, its weight in water (N), the case, the outcome.

    outcome: attributes "outcome" and "outcome_..." .
    """

    net: Net
    weight_in_water: float
    case_text: str
    outcome: Mapping[str, Any]


def frame_shape(field: Field, net: Net) -> tuple[int, ...]:
    """Return the shape of a frame's variable at one time."""
    sizes = {"knot": net.knot_count, "bar": net.bar_count, "xyz": 3}
    return tuple(sizes[name] for name in field.dimensions[1:])


def frame_bytes(net: Net) -> int:
    """Return the size of one frame in memory and in a file."""
    return FLOAT.itemsize * sum(int(np.prod(frame_shape(field, net))) for field in FRAME_FIELDS)


def check_finite(field: Field, values: Array, net: Net, time: Array | None = None) -> None:
    """Raise ValueError that names variable, knot or bar, axis and time if a value is NaN or infinite.

    values: shaped as the field says, without the time axis when `time` is None.
    """
    if np.isfinite(values).all():
        return
    where = np.argwhere(~np.isfinite(values))[0]
    dimensions = field.dimensions if time is not None else tuple(d for d in field.dimensions if d != "time")
    place = []
    for dimension, index in zip(dimensions, where, strict=True):
        if dimension == "knot":
            place.append(f"of knot {net.labels[index]}")
        elif dimension == "bar":
            place.append(f"of bar {index} ({net.bar_label(index)})")
        elif dimension == "xyz":
            place.append(f"along {'xyz'[index]}")
        elif dimension == "time" and time is not None and field.name != "time":
            place.append(f"at {time[index]:g} s")
    value = np.asarray(values)[tuple(where)]
    raise ValueError(
        " ".join([f"{field.name} is {value},", "which no result file may hold:", field.name, *place])
    )


def _attributes(content: Content) -> dict[str, Any]:
    now = datetime.now(UTC).isoformat(timespec="seconds")
    return {
        "Conventions": "CF-1.11",
        "title": case_title(content.case_text),
        "source": f"fyke {__version__}, lumped-mass simulation of netting in water",
        "history": f"{now} written by fyke {__version__}",
        "comment": "SI units: outcome_residual in N, outcome_wall_time and outcome_time in s. "
        "An output of which the time is missing (NaN) was not reached.",
        "fyke_result_schema": SCHEMA,
        "fyke_version": __version__,
        "python_version": platform.python_version(),
        "numpy_version": np.__version__,
        "case": content.case_text,
        "case_sha256": case_hash(content.case_text),
        "twines": twines_to_text(content.net.twines),
        **{name: parts_to_text(getattr(content.net, name)) for name in PARTS},
        **content.outcome,
    }


def _add(file: Any, field: Field, **how: Any) -> Any:
    variable = file.create_variable(field.name, field.dimensions, **how)
    variable.attrs["units"] = field.unit
    variable.attrs["long_name"] = field.long_name
    if "knot" in field.dimensions and field.name != "knot_label":
        variable.attrs["coordinates"] = "knot_label"
    return variable


def _add_net(file: Any, net: Net) -> None:
    for attribute, field in NET_FIELDS.items():
        value = getattr(net, attribute)
        if attribute == "labels":
            _add(file, field, data=np.array(value, dtype=object), dtype=h5py.string_dtype())
        elif attribute == "fixed":
            flags = _add(file, field, data=np.asarray(value, dtype=np.int8))
            flags.attrs["flag_values"] = np.array([0, 1], dtype=np.int8)
            flags.attrs["flag_meanings"] = "free fixed"
        elif attribute in ("bars", "twine_of_bar"):
            _add(file, field, data=np.asarray(value, dtype="<i8"))
        else:
            values = np.asarray(value, dtype=FLOAT)
            check_finite(field, values, net)
            _add(file, field, data=values)


def _upper_size(content: Content, count: int) -> int:
    """Bytes that a file for `count` frames takes at most."""
    net = content.net
    texts = len(content.case_text) + sum(len(str(value)) for value in content.outcome.values())
    return (
        count * frame_bytes(net)
        + BYTES_OF_KNOT * net.knot_count
        + BYTES_OF_BAR * net.bar_count
        + 4 * texts
        + BYTES_BESIDES
    )


def _reserve(path: Path, size: int) -> None:
    """Raise OSError where the disk has no room for so many bytes: HDF5 crashes Python when a write fails."""
    with path.open("wb") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size)
        elif shutil.disk_usage(path.parent).free < size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))


def lay_out(path: Path, content: Content, count: int) -> None:
    """Write a result file at `path` with room for `count` frames, at least one, all still missing (NaN).

    ValueError if the net holds a number that is not finite; OSError where the disk has no room.
    """
    net = content.net
    _reserve(path, _upper_size(content, count))
    with h5netcdf.File(str(path), "w") as file:
        file.dimensions = {"time": count, "knot": net.knot_count, "bar": net.bar_count, "xyz": 3, "end": 2}
        file.attrs.update(_attributes(content))
        _add(file, AXES, data=np.array(["x", "y", "z"], dtype=object), dtype=h5py.string_dtype())
        _add_net(file, net)
        weight = np.asarray(content.weight_in_water, dtype=FLOAT)
        check_finite(WEIGHT, weight, net)
        _add(file, WEIGHT, data=weight)
        for field in FRAME_FIELDS:
            variable = _add(file, field, dtype=FLOAT, fillvalue=np.nan)
            # Writing anything at all makes HDF5 take the whole place on the disk and fill it with NaN.
            variable[count - 1] = np.full(frame_shape(field, net), np.nan)


def frame_offsets(path: Path) -> dict[str, int]:
    """Return the byte at which the array of every frame variable begins in a laid-out file.

    An array without elements, as the tensions of a net without bars, has no place and is given as 0.
    """
    with h5py.File(str(path), "r") as file:
        return {field.name: int(file[field.name].id.get_offset() or 0) for field in FRAME_FIELDS}


def read_frames(file: FileIO, offsets: Mapping[str, int], count: int, net: Net) -> dict[str, Array]:
    """Read the first `count` frames back, every variable with the time axis in front."""
    values = {}
    for field in FRAME_FIELDS:
        shape = (count, *frame_shape(field, net))
        file.seek(offsets[field.name])
        values[field.name] = np.fromfile(file, FLOAT, int(np.prod(shape))).reshape(shape)
    return values


def write_frames(file: FileIO, offsets: Mapping[str, int], first: int, values: Mapping[str, Array]) -> None:
    """Write frames, the first of them number `first`, into their places in a laid-out file.

    values: every frame variable with the time axis in front. The times come last: until they are there, a
    reader takes the frames for missing.
    """
    for field in reversed(FRAME_FIELDS):
        block = np.ascontiguousarray(values[field.name], dtype=FLOAT)
        file.seek(offsets[field.name] + first * block[:1].nbytes)
        rest = block.reshape(-1).view(np.uint8).data
        while rest:
            rest = rest[file.write(rest) :]
