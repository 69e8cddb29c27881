"""VTKHDF: one file of all frames for ParaView and VTK, laid out as the VTKHDF specification 2.0 says.

An unstructured grid of one part in which every bar is a line cell. Points and values of all frames follow one
another; the group Steps holds where each frame begins. What does not change with time is in the file once: the
offsets of all frames point to it. https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ...solve.result import Result
from ...version import __version__
from ..encoding import case_title
from ..whole import replacing, reserve
from .columns import Column, Values, blocks, columns_of

VERSION = (2, 0)
VTK_LINE = 3  # the number of a line in VTK's vtkCellType.h
STRUCTURE = 2**17  # bytes of names, attributes and headers
FLOAT, INTEGER = np.dtype("<f8"), np.dtype("<i8")


def write_vtkhdf(result: Result, path: str | Path) -> Path:
    """Write all frames of a result to one VTKHDF file, which appears whole or not at all, and return it.

    Point data and cell data have the names and SI units of a result file, units and meaning as attributes of the
    arrays; field data holds the forces and energies of the whole net and the labels of the knots. Everything is
    float64 or int64. OSError where the file cannot be written.
    """
    path = Path(path)
    with replacing(path) as part:
        reserve(part, _size(result))
        try:
            with h5py.File(part, "w") as file:
                _write(file, result)
        except RuntimeError as error:  # how h5py tells of a disk that ran full while a file is closed
            raise OSError(str(error)) from error
    return path


def _size(result: Result) -> int:
    """Return about how many bytes the file takes, rather too many."""
    net, frames = result.net, len(result.time)
    rows = (("knot", net.knot_count), ("bar", net.bar_count), ("", 1))
    told = [(column, count) for where, count in rows for column in columns_of(result, where)]
    numbers = sum((frames if column.moves else 1) * column.components * count for column, count in told)
    offsets = frames * (len(told) + 8)
    texts = 64 * net.knot_count + len(result.case_text)
    return 8 * (numbers + offsets + 3 * frames * net.knot_count + 4 * net.bar_count) + texts + STRUCTURE


def _write(file: Any, result: Result) -> None:
    file.attrs["title"] = case_title(result.case_text)
    file.attrs["source"] = f"fyke {__version__}"
    file.attrs["case"] = result.case_text
    root = file.create_group("VTKHDF", track_order=True)
    root.attrs["Version"] = np.array(VERSION, dtype=INTEGER)
    root.attrs.create("Type", b"UnstructuredGrid", dtype="S16")
    _write_topology(root, result)
    steps = root.create_group("Steps", track_order=True)
    frames = len(result.time)
    steps.attrs["NSteps"] = frames
    steps.create_dataset("Values", data=result.time, dtype=FLOAT)
    _offsets(steps, "PartOffsets", frames, 0)
    steps.create_dataset("NumberOfParts", data=np.ones(frames, dtype=INTEGER))
    _offsets(steps, "PointOffsets", frames, result.net.knot_count)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        steps.create_dataset(name, data=np.zeros((frames, 1), dtype=INTEGER))
    _write_columns(root, steps, "Point", columns_of(result, "knot"), result, result.net.knot_count)
    _write_columns(root, steps, "Cell", columns_of(result, "bar"), result, result.net.bar_count)
    _write_whole(root, steps, result)


def _write_topology(root: Any, result: Result) -> None:
    net = result.net
    m = net.bar_count
    for name, count in (("Points", net.knot_count), ("Cells", m), ("ConnectivityIds", 2 * m)):
        root.create_dataset(f"NumberOf{name}", data=np.array([count], dtype=INTEGER))
    points = root.create_dataset("Points", data=result.position.reshape(-1, 3), dtype=FLOAT)
    points.attrs["units"] = "m"
    root.create_dataset("Connectivity", data=net.bars.reshape(-1), dtype=INTEGER)
    root.create_dataset("Offsets", data=2 * np.arange(m + 1), dtype=INTEGER)
    root.create_dataset("Types", data=np.full(m, VTK_LINE, dtype=np.uint8))


def _offsets(group: Any, name: str, frames: int, step: int) -> None:
    """Say where the values of every frame begin: all at 0 (step 0), or one behind another."""
    group.create_dataset(name, data=step * np.arange(frames), dtype=INTEGER)


def _write_columns(
    root: Any, steps: Any, kind: str, columns: Sequence[Column], result: Result, rows: int
) -> None:
    data, offsets = root.create_group(f"{kind}Data"), steps.create_group(f"{kind}DataOffsets")
    frames = len(result.time)
    for column in columns:
        tail = (3,) if column.components == 3 else ()
        sample: Values = column.values(0, 1)
        dtype = INTEGER if sample.dtype.kind == "i" else FLOAT
        array = data.create_dataset(
            column.name, shape=((frames if column.moves else 1) * rows, *tail), dtype=dtype
        )
        array.attrs["units"], array.attrs["long_name"] = column.field.unit, column.field.long_name
        _offsets(offsets, column.name, frames, rows if column.moves else 0)
        if not column.moves:
            array[...] = sample
            continue
        for first, last in blocks(result, rows):
            array[first * rows : last * rows] = column.values(first, last).reshape(-1, *tail)


def _write_whole(root: Any, steps: Any, result: Result) -> None:
    """Field data: one tuple a frame of what the whole net has, and all labels in every frame."""
    frames, labels = len(result.time), result.net.labels
    data, offsets = root.create_group("FieldData"), steps.create_group("FieldDataOffsets")
    sizes = steps.create_group("FieldDataSizes")
    for column in columns_of(result, ""):
        array = data.create_dataset(column.name, data=column.values(0, frames), dtype=FLOAT)
        array.attrs["units"], array.attrs["long_name"] = column.field.unit, column.field.long_name
        _offsets(offsets, column.name, frames, 1)
        sizes.create_dataset(column.name, data=np.tile([column.components, 1], (frames, 1)), dtype=INTEGER)
    # VTK's reader takes no texts but those marked as ASCII.
    texts = np.array([label.encode() for label in labels], dtype=object)
    data.create_dataset("knot_label", data=texts, dtype=h5py.string_dtype("ascii"))
    _offsets(offsets, "knot_label", frames, 0)
    sizes.create_dataset("knot_label", data=np.tile([1, len(labels)], (frames, 1)), dtype=INTEGER)
