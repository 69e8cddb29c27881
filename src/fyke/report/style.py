"""One style for every figure: widths, type sizes, colours, and the prefix of a unit.

A figure is made for the column of a journal and is never scaled afterwards: 86 mm for one column, 178 mm for two,
type of 7 to 8 points. Lines and markers take their colours from the palette of Okabe and Ito (Color universal
design, 2008), tensions from viridis, the darker the tauter, without the palest tenth that is lost on white paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
from matplotlib.colors import ListedColormap, to_rgb

P = ParamSpec("P")
R = TypeVar("R")

SINGLE_COLUMN = 86 / 25.4  # in
DOUBLE_COLUMN = 178 / 25.4  # in
RESOLUTION = 300  # dots per inch
TYPE, SMALL_TYPE = 7.5, 7.0  # points

BLACK, BLUE, VERMILION, GREEN, ORANGE = "#000000", "#0072B2", "#D55E00", "#009E73", "#E69F00"
PURPLE, SKY, NAVY = "#CC79A7", "#56B4E9", "#08306B"
GRID_GREY, SLACK_GREY, FRAME_GREY = "#D9D9D9", "#8C8C8C", "#595959"
SLACK_DASHES = (0, (2.0, 1.4))
TENSION_COLOURS = ListedColormap(mpl.colormaps["viridis_r"](np.linspace(0.1, 1.0, 256)), name="fyke tension")

STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": TYPE,
    "axes.labelsize": TYPE,
    "axes.titlesize": TYPE,
    "xtick.labelsize": SMALL_TYPE,
    "ytick.labelsize": SMALL_TYPE,
    "legend.fontsize": SMALL_TYPE,
    "legend.frameon": False,
    "axes.linewidth": 0.6,
    "axes.labelpad": 2.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.major.pad": 2.0,
    "ytick.major.pad": 2.0,
    "lines.linewidth": 1.1,
    "grid.color": GRID_GREY,
    "grid.linewidth": 0.4,
    "hatch.linewidth": 0.5,
    "savefig.dpi": RESOLUTION,
    "svg.hashsalt": "fyke",
}


def rgb(colour: str) -> tuple[float, float, float]:
    """Return red, green and blue, 0 to 1, of a colour by name or number."""
    return to_rgb(colour)


@contextmanager
def house_style() -> Iterator[None]:
    """Set matplotlib's defaults and this style for a while; the caller's own settings come back untouched."""
    with mpl.rc_context():
        mpl.rcdefaults()
        settings: Any = mpl.rcParams
        settings.update(STYLE)
        yield


def styled(draw: Callable[P, R]) -> Callable[P, R]:
    """Make a function draw in the house style, whatever the caller's settings are."""

    @wraps(draw)
    def in_style(*args: P.args, **kwargs: P.kwargs) -> R:
        with house_style():
            return draw(*args, **kwargs)

    return in_style


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """Return factor and unit that write values up to `largest` (SI) in few digits: 0.004, "N" gives 1000, "mN".

    A prefix would be squared or cubed with its unit, so m² and m³ stay as they are.
    """
    if unit.endswith(("²", "³")):
        return 1.0, unit
    for limit, factor, prefix in ((1e6, 1e-6, "M"), (1e3, 1e-3, "k"), (0.1, 1.0, ""), (1e-4, 1e3, "m")):
        if largest >= limit:
            return factor, prefix + unit
    return (1e6, "µ" + unit) if largest > 0.0 else (1.0, unit)
