"""Where tick marks stand, and how their numbers are written."""

from __future__ import annotations

from itertools import count

import numpy as np
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from . import style

Array = NDArray[np.float64]

MOST = 6  # steps along an axis
STEPS = [1, 2, 2.5, 5, 10]
CHARACTER = 0.62, 0.9  # width and height of a digit, in type sizes
APART = 4.0, 2.0  # points between numbers, sideways and up


def round_values(limits: Array, along: Array) -> Array:
    """Return round values within limits (2,), one at least, whose numbers keep apart on paper.

    along: (2,) points to the right and up, on paper, for one unit of the value.
    """
    low, high = limits
    for bins in range(MOST, 0, -1):
        values, step = _at_most(low, high, bins)
        if len(values) and (len(values) == 1 or _apart(values, step * along)):
            return values
    values = next(found for bins in count(1) if len(found := _at_most(low, high, bins)[0]))
    return values[[np.abs(values - (low + high) / 2.0).argmin()]]


def text_size(characters: int, size: float = style.SMALL_TYPE) -> Array:
    """Width and height (points) of so many digits."""
    return np.array([CHARACTER[0] * characters, CHARACTER[1]]) * size


def _apart(values: Array, step: Array) -> bool:
    """Whether the numbers of values keep apart that follow one another by a step (2,) on paper (points)."""
    widest = max(len(number(value)) for value in values)
    return bool(np.any(np.abs(step) >= text_size(widest) + APART))


def _at_most(low: float, high: float, bins: int) -> tuple[Array, float]:
    """Values at a round step that cuts the limits into so many parts, and the step."""
    values = np.asarray(MaxNLocator(bins, steps=STEPS).tick_values(low, high))
    step = float(values[1] - values[0])
    inside = values[(values >= low) & (values <= high)]
    return np.round(inside / step) * step + 0.0, step


def number(value: float) -> str:
    """Write a number in as few digits as it needs, with a minus sign as wide as a plus."""
    return f"{value:.6g}".replace("-", "−")
