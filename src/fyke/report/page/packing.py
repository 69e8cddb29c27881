"""Frames of a result as small integers that a page carries in itself.

Every kept frame holds positions and one value of each quantity per bar, as whole steps of 1/65535 of their range, and
differences from frame to frame, deflated. The page says how coarse a step is; the exact numbers are in the result file.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...solve.result import Result
from ..carried import parts_in_time
from ..parts import Bars, Knots, Outline
from ..quantities import BarQuantity, quantities
from ..space import AZIMUTH, ELEVATION

Array = NDArray[np.float64]

# Knots times frames that a page carries, which keeps it below 8 MB, and frames that a slider still tells apart.
MOST_KNOT_FRAMES, MOST_FRAMES = 150_000, 200
STEPS = 65535


def kept_frames(result: Result) -> NDArray[np.int64]:
    """Indices of the frames that a page shows: all, or so many at even intervals, first and last among them."""
    count = len(result.time)
    room = max(2, min(MOST_FRAMES, MOST_KNOT_FRAMES // max(result.net.knot_count, 1)))
    if count <= room:
        return np.arange(count)
    return np.unique(np.linspace(0, count - 1, room).round().astype(np.int64))


def deflated(values: NDArray[Any]) -> str:
    """Pack an array's bytes, little-endian, into base64 text; undone by atob and DecompressionStream("deflate")."""
    small = values.astype(values.dtype.newbyteorder("<"), copy=False)
    return base64.b64encode(zlib.compress(small.tobytes(), 6)).decode("ascii")


@dataclass(frozen=True)
class Packed:
    """Values (k, ...) in whole steps: low + step x (sum of the differences), modulo 65536; both per last axis."""

    text: str
    low: list[float]
    step: list[float]

    @classmethod
    def of(cls, values: Array, low: Array, high: Array) -> Packed:
        """Pack values between low and high, numbers or one for each entry of the last axis."""
        low, high = np.atleast_1d(low), np.atleast_1d(high)
        step = np.where(high > low, (high - low) / STEPS, 1.0)
        whole = np.rint((values - low) / step).astype(np.uint16)
        whole[1:] -= whole[:-1].copy()
        return cls(deflated(whole), low.tolist(), step.tolist())

    def as_json(self) -> dict[str, Any]:
        """Return it for the page."""
        return {"data": self.text, "low": self.low, "step": self.step}


def scene(result: Result) -> dict[str, Any]:
    """Return what the page draws in space: parts, kept frames, quantities of the bars; lengths in m."""
    kept = kept_frames(result)
    net = result.net
    shape = result.position[kept]
    points = [shape.reshape(-1, 3), *(p.points for p in parts_in_time(result) if isinstance(p, Outline))]
    low, high = np.concatenate(points).min(axis=0), np.concatenate(points).max(axis=0)
    return {
        "time": result.time[kept].tolist(),
        "frames": len(result.time),
        "knots": list(net.labels),
        "fixed": deflated(net.fixed.astype(np.uint8)),
        "bars": deflated(net.bars.astype(np.uint32)),
        "box": [low.tolist(), high.tolist()],
        "position": Packed.of(shape, low, high).as_json(),
        "quantities": [_quantity(result, kept, q) for q in quantities(result)],
        "parts": [_part(part) for part in parts_in_time(result)],
        "eye": [AZIMUTH, ELEVATION],
    }


def _quantity(result: Result, kept: NDArray[np.int64], quantity: BarQuantity) -> dict[str, Any]:
    values = np.array([quantity.values(result, int(k)) for k in kept])
    high = float(values.max(initial=0.0)) or 1.0
    packed = Packed.of(*_signed(values[:, :, None], high))
    about = {"key": quantity.key, "name": quantity.name, "unit": quantity.unit, "high": high}
    return about | packed.as_json()


def _signed(values: Array, high: float) -> tuple[Array, Array, Array]:
    """Return values to pack and the ends of their range, so that they keep their signs and 0 stays 0.

    Zero lies on a step, and what is smaller than a step becomes one: a bar that bears little is not slack.
    """
    least = min(float(values.min(initial=0.0)), 0.0)
    below = min(int(np.ceil(STEPS * -least / (high - least))), STEPS - 1)
    step = max(high / (STEPS - below), -least / below if below else 0.0)
    step = float(
        np.nextafter(np.float32(step), np.float32(np.inf))
    )  # few digits, so that multiples are exact
    away = np.sign(values) * np.maximum(np.abs(values), step)
    return away, np.array([-below * step]), np.array([(STEPS - below) * step])


def _part(part: Bars | Knots | Outline) -> dict[str, Any]:
    about: dict[str, Any] = {"name": part.name, "colour": part.colour}
    if isinstance(part, Outline):
        return about | {"kind": "outline", "points": part.points.tolist(), "width": part.width}
    about["own"] = part.own
    if isinstance(part, Bars):
        about |= {"kind": "bars", "bars": deflated(part.bars.astype(np.uint32)), "width": part.width}
        return about | {"diameter": part.diameter}
    knots = deflated(part.knots.astype(np.uint32))
    return about | {"kind": "knots", "knots": knots, "marker": part.marker, "size": part.size}
