"""Colours of bars by a quantity, for pictures in space: the scale of a whole run, slack bars grey."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import ArrayLike, NDArray

from ..solve.result import Result
from .parts import coloured_bars
from .quantities import QUANTITIES, BarQuantity, quantities
from .style import SLACK_GREY, TENSION_COLOURS

Array = NDArray[np.float64]

PALETTE = TENSION_COLOURS(np.linspace(0.0, 1.0, 256))[:, :3]
GREY = np.array(to_rgb(SLACK_GREY))


class QuantityError(ValueError):
    """Bars cannot be coloured by what was asked for; the message says what is there."""


@dataclass(frozen=True)
class Colouring:
    """A quantity and the value that has the darkest colour, from 0: the largest of the bars that it colours."""

    quantity: BarQuantity
    largest: float

    @classmethod
    def of(cls, result: Result, key: str) -> Colouring:
        """Make the colouring of all frames of a result; QuantityError for a key that has no values."""
        there = [one.key for one in quantities(result)]
        if key not in there:
            why = "no water passes them" if key in QUANTITIES else "there is no such quantity"
            raise QuantityError(f"bars cannot be coloured by {key!r}, {why}; choose {', '.join(there)}")
        quantity, frames, shown = QUANTITIES[key], range(len(result.time)), coloured_bars(result.net)
        largest = max(float(np.max(quantity.values(result, k)[shown], initial=0.0)) for k in frames)
        return cls(quantity, largest if largest > 0.0 else 1.0)

    def colours(self, result: Result, index: int) -> Array:
        """Return the colour of every bar in a frame, (m, 3) of sRGB between 0 and 1."""
        share = np.clip(self.quantity.values(result, index) / self.largest, 0.0, 1.0)
        colours = PALETTE[np.rint(share * (len(PALETTE) - 1)).astype(int)]
        colours[result.tension[index] <= 0.0] = GREY
        return np.asarray(colours)


def linear(colours: ArrayLike) -> Array:
    """Turn sRGB between 0 and 1 into the linear light that renderers count in (IEC 61966-2-1)."""
    c = np.asarray(colours, dtype=float)
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
