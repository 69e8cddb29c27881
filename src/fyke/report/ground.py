"""The sea bed in pictures, of results whose case has one that the net comes down to."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from ..case import CaseError, recorded_case
from ..solve.result import Result
from .space import View

Array = NDArray[np.float64]

SAND = "#E8DCC0"
NEAR = 0.05  # of the height of the net: the bed is shown when the net comes as near to it as that


@lru_cache(maxsize=8)
def _bed_of(case_text: str) -> float | None:
    if not case_text:
        return None
    try:
        case = recorded_case(case_text)
    except CaseError:
        return None
    return None if case.bed is None or case.water.depth is None else -case.water.depth


def bed_under(result: Result) -> float | None:
    """Return the z (m) of the sea bed of a result, None without one or where the net stays well above it."""
    level = _bed_of(result.case_text)
    if level is None:
        return None
    heights = np.concatenate([result.net.positions[:, 2], result.position[-1][:, 2]])
    return level if float(heights.min()) - level <= NEAR * float(np.ptp(heights)) else None


def draw_ground(ax: Axes, view: View, corners: Array, level: float) -> None:
    """Draw the sea bed at z = level (m) over the floor of a box (2, 3) m."""
    (x0, y0, _), (x1, y1, _) = corners
    floor = np.array([[x0, y0, level], [x1, y0, level], [x1, y1, level], [x0, y1, level]])
    ax.add_patch(Polygon(view.see(floor)[:, :2], facecolor=SAND, edgecolor="none", zorder=0.4, gid="sea bed"))
