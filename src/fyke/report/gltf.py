"""glTF: the net as solid bodies for Blender and other programs for pictures, in one binary file.

True size in metres, bars as tubes of their twine's diameter in the colour of a quantity, knots as balls. glTF 2.0
counts y upwards and colours in linear light. https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from ..results.encoding import case_title
from ..results.whole import replacing
from ..solve.result import Result
from ..version import __version__
from .carried import carried
from .colours import Colouring, linear
from .parts import Bars, Knots, Outline, parts_of
from .solids import Solid, balls, threads, tubes
from .style import BLUE

Array = NDArray[np.float64]

# Beyond, a tube for each bar makes files of more than some 50 MB, and bars become lines.
TUBES_UP_TO = 100_000
MARK = 2.0  # diameter of a marked knot over that of the thickest bar
FLOAT, SHORT, INTEGER = 5126, 5123, 5125  # numbers of the component types in glTF
LINES, TRIANGLES = 1, 4
POINTS_BUFFER, CORNERS_BUFFER = 34962, 34963
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def write_gltf(result: Result, path: str | Path, *, colour: str = "tension") -> Path:
    """Write the last frame of a result to a .glb file, which appears whole or not at all, and return it.

    colour: key of a quantity. Every part of the net is an object of its own. QuantityError for a quantity without
    values, OSError where the file cannot be written.
    """
    path = Path(path)
    last = len(result.time) - 1
    colouring = Colouring.of(result, colour)
    file = _File()
    for name, solid in _solids(result, last, colouring):
        file.add(name, solid)
    scale = {"name": colouring.quantity.name, "unit": colouring.quantity.unit, "darkest": colouring.largest}
    told = {"title": case_title(result.case_text), "time": float(result.time[last]), "colour": scale}
    with replacing(path) as part:
        part.write_bytes(file.packed(told))
    return path


def _solids(result: Result, index: int, colouring: Colouring) -> Iterator[tuple[str, Solid]]:
    """Yield every part of the net and the balls of its knots, with names."""
    net, position = result.net, result.position[index]
    thickest = float(np.max(net.bar_diameter, initial=0.0)) or 1e-3
    for part in parts_of(carried(result, index).net):
        if isinstance(part, Outline):
            ends = part.points[:-1], part.points[1:]
            radius = np.full(len(ends[0]), 0.5 * part.width * thickest)
            yield part.name, tubes(*ends, radius, _plain(part.colour, len(radius)))
        elif isinstance(part, Bars):
            start, end = position[net.bars[part.bars]].transpose(1, 0, 2)
            if part.colour is None:
                colours = colouring.colours(result, index)[part.bars]
            else:
                colours = _plain(part.colour, len(part.bars))
            if len(part.bars) > TUBES_UP_TO:
                yield _name(part), threads(start, end, colours)
            else:
                yield _name(part), tubes(start, end, 0.5 * net.bar_diameter[part.bars], colours)
        else:
            radius = np.full(len(part.knots), 0.5 * (part.diameter or MARK * part.size * thickest))
            yield _name(part), balls(position[part.knots], radius, _plain(part.colour, len(radius)))
    tied = np.flatnonzero(net.knot_diameter > 0.0)
    if 0 < len(tied) <= TUBES_UP_TO:
        yield "knot", balls(position[tied], 0.5 * net.knot_diameter[tied], _plain(BLUE, len(tied)))


def _name(part: Bars | Knots) -> str:
    return f"{part.name} {part.own}".rstrip()


def _plain(colour: str, count: int) -> Array:
    return np.tile(to_rgb(colour), (count, 1))


def _upright(vectors: Array) -> NDArray[np.float32]:
    """Turn vectors (p, 3) with z upwards into those with y upwards."""
    return np.column_stack([vectors[:, 0], vectors[:, 2], -vectors[:, 1]]).astype("<f4")


class _File:
    """A glTF file in the making: its JSON and the arrays that this points to."""

    def __init__(self) -> None:
        self._binary = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._meshes: list[dict[str, Any]] = []

    def add(self, name: str, solid: Solid) -> None:
        """Add a solid as an object of this name."""
        if not len(solid.corners):
            return
        points = _upright(solid.points)
        ends = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
        colours = np.rint(65535.0 * linear(solid.colours))
        four = np.column_stack([colours, np.full(len(colours), 65535.0)]).astype("<u2")
        attributes = {
            "POSITION": self._array(points, FLOAT, "VEC3", POINTS_BUFFER, **ends),
            "COLOR_0": self._array(four, SHORT, "VEC4", POINTS_BUFFER, normalized=True),
        }
        lines = solid.corners.shape[1] == 2
        if not lines:
            attributes["NORMAL"] = self._array(_upright(solid.normals), FLOAT, "VEC3", POINTS_BUFFER)
        corners = solid.corners.reshape(-1).astype("<u4")
        primitive = {
            "attributes": attributes,
            "indices": self._array(corners, INTEGER, "SCALAR", CORNERS_BUFFER),
            "mode": LINES if lines else TRIANGLES,
            "material": 0,
        }
        self._meshes.append({"name": name, "primitives": [primitive]})

    def _array(self, values: NDArray[Any], kind: int, shape: str, target: int, **more: Any) -> int:
        """Put an array at the end and return the number of its accessor. All arrays are of 4 bytes or multiples."""
        data = np.ascontiguousarray(values).tobytes()
        view = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data), "target": target}
        self._binary += data
        self._views.append(view)
        number = len(self._views) - 1
        self._accessors.append(
            {"bufferView": number, "componentType": kind, "count": len(values), "type": shape, **more}
        )
        return number

    def packed(self, told: dict[str, Any]) -> bytes:
        """Return the whole file; told: what else it says of itself."""
        numbers = range(len(self._meshes))
        surface = {"metallicFactor": 0.0, "roughnessFactor": 0.8}
        content = {
            "asset": {"version": "2.0", "generator": f"fyke {__version__}", "extras": told},
            "scene": 0,
            "scenes": [{"nodes": list(numbers)}],
            "nodes": [{"name": self._meshes[k]["name"], "mesh": k} for k in numbers],
            "meshes": self._meshes,
            "materials": [{"name": "twine", "doubleSided": True, "pbrMetallicRoughness": surface}],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self._binary)
        head = struct.pack("<4sII", b"glTF", 2, size)
        chunks = (
            struct.pack("<II", len(text), JSON_CHUNK),
            text,
            struct.pack("<II", len(self._binary), BINARY_CHUNK),
        )
        return b"".join([head, *chunks, self._binary])
