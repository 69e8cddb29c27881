"""VTU: VTK's XML file of one unstructured grid, one for each frame, with a PVD file that tells their times.

Every bar is a line cell. The arrays follow the XML as raw bytes, each with its length in front, as VTK's file
formats document for appended data. https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from ...solve.result import Result
from ...version import __version__
from ..whole import replacing, replacing_folder
from .columns import columns_of
from .vtkhdf import VTK_LINE

TYPES = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8"), "u": ("UInt8", "<u1")}
COLLECTION = "frames.pvd"


def write_vtu(result: Result, path: str | Path) -> Path:
    """Write a result of one frame to a VTU file, one of several to a folder of them with frames.pvd to open; return it.

    Names and SI units are those of a result file; numbers are float64 and int64. File and folder appear whole or not
    at all. OSError where they cannot be written, FileExistsError where a folder of that name holds other files.
    """
    path = Path(path)
    if len(result.time) == 1:
        with replacing(path) as part:
            _write_frame(result, 0, part)
        return path
    names = [f"frame_{k:0{len(str(len(result.time) - 1))}d}.vtu" for k in range(len(result.time))]
    with replacing_folder(path, ("*.vtu", COLLECTION)) as folder:
        for index, name in enumerate(names):
            _write_frame(result, index, folder / name)
        (folder / COLLECTION).write_text(_collection(result, names), encoding="utf-8")
    return path


def _collection(result: Result, names: list[str]) -> str:
    sets = [
        f'  <DataSet timestep="{time!r}" part="0" file={quoteattr(name)}/>'
        for time, name in zip(result.time.tolist(), names, strict=True)
    ]
    head = '<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">'
    return "\n".join(
        ['<?xml version="1.0"?>', head, " <Collection>", *sets, " </Collection>", "</VTKFile>\n"]
    )


class _Appended:
    """Arrays that follow the XML, and the elements that stand for them in it."""

    def __init__(self) -> None:
        self.arrays: list[NDArray[Any]] = []
        self._size = 0

    def element(self, name: str, values: NDArray[Any], more: str = "", *, kind: str = "") -> str:
        """Take an array up and return its element; kind: "String" for bytes of texts that end with 0."""
        named, dtype = TYPES[values.dtype.kind]
        components = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
        offset, values = self._size, np.ascontiguousarray(values, dtype=dtype)
        self.arrays.append(values)
        self._size += 8 + values.nbytes
        return (
            f'<DataArray type="{kind or named}" Name={quoteattr(name)}{components}{more} format="appended" '
            f'offset="{offset}"/>'
        )

    def write(self, file: BinaryIO) -> None:
        """Write all arrays, each behind its length in bytes."""
        for values in self.arrays:
            file.write(np.uint64(values.nbytes).astype("<u8").tobytes())
            file.write(values.reshape(-1).view(np.uint8).data)


def _write_frame(result: Result, index: int, path: Path) -> None:
    appended = _Appended()
    lines = "\n".join(_xml(result, index, appended))
    with path.open("wb") as file:
        file.write(lines.encode())
        file.write(b'\n <AppendedData encoding="raw">\n_')
        appended.write(file)
        file.write(b"\n </AppendedData>\n</VTKFile>\n")


def _xml(result: Result, index: int, appended: _Appended) -> Iterator[str]:
    net = result.net
    m = net.bar_count
    yield '<?xml version="1.0"?>'
    yield f"<!-- fyke {__version__}; SI units: m, N, s, kg, J -->"
    yield '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
    yield " <UnstructuredGrid>"
    yield "  <FieldData>"
    yield appended.element("TimeValue", result.time[index : index + 1], ' NumberOfTuples="1"')
    for column in columns_of(result, ""):
        values = column.values(index, index + 1).reshape(1, -1)
        yield appended.element(column.name, values, ' NumberOfTuples="1"')
    labels = np.frombuffer("".join(f"{label}\0" for label in net.labels).encode(), dtype=np.uint8)
    yield appended.element("knot_label", labels, f' NumberOfTuples="{len(net.labels)}"', kind="String")
    yield "  </FieldData>"
    yield f'  <Piece NumberOfPoints="{net.knot_count}" NumberOfCells="{m}">'
    for kind, where in (("PointData", "knot"), ("CellData", "bar")):
        yield f"   <{kind}>"
        for column in columns_of(result, where):
            values = column.values(index, index + 1)
            yield appended.element(column.name, values[0] if column.moves else values)
        yield f"   </{kind}>"
    yield f"   <Points>{appended.element('Points', result.position[index])}</Points>"
    yield "   <Cells>"
    yield appended.element("connectivity", net.bars.reshape(-1))
    yield appended.element("offsets", 2 * np.arange(1, m + 1))
    yield appended.element("types", np.full(m, VTK_LINE, dtype=np.uint8))
    yield "   </Cells>\n  </Piece>\n </UnstructuredGrid>"
