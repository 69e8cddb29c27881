"""Figure of the waves of a run: elevation at the probes and velocity of the water at the first of them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from ..results.probes import Probes
from . import style
from .histories import ABOVE, BELOW, GAP, HEIGHT, LABEL, LEFT, RIGHT
from .ticks import STEPS

Array = NDArray[np.float64]

# Lines differ in colour and in dashes, so that they can be told apart in grey.
LINES = (
    (style.BLUE, "-"),
    (style.VERMILION, (0, (4.0, 1.5))),
    (style.GREEN, (0, (1.2, 1.2))),
    (style.BLACK, (0, (4.0, 1.2, 1.0, 1.2))),
)
KEY = 0.16  # in, room for the key above a diagram


@style.styled
def wave_histories(probes: Probes) -> Figure:
    """Show the elevation at the first four probes, and the velocity of the water at the first, against time.

    The velocity is that of current and waves; moments in which the probe is dry are gaps.
    """
    width, height = style.SINGLE_COLUMN, ABOVE + 2.0 * (KEY + HEIGHT) + GAP + BELOW
    figure = Figure(figsize=(width, height))
    shown = range(min(len(probes.points), len(LINES)))
    dry = ~probes.wet[:, 0]
    diagrams = (
        ("Elevation", "m", [probes.elevation[:, one] for one in shown], [f"probe {one}" for one in shown]),
        ("Velocity at\nprobe 0", "m/s", list(probes.velocity[:, 0].T), ["along x", "along y", "along z"]),
    )
    for index, (name, unit, curves, words) in enumerate(diagrams):
        bottom = height - ABOVE - (index + 1) * (KEY + HEIGHT) - index * GAP
        room = (LEFT / width, bottom / height, 1.0 - (LEFT + RIGHT) / width, HEIGHT / height)
        ax = figure.add_axes(room, sharex=figure.axes[0] if index else None, label=f"waves {index}")
        values = [np.where(dry, np.nan, one) for one in curves] if index else curves
        _draw(ax, probes.time, values, name=name, unit=unit)
        if len(values) > 1 or index:
            _key(ax, words)
        ax.yaxis.set_label_coords(-LABEL / (width - LEFT - RIGHT), 0.5)
        ax.tick_params(labelbottom=index == 1)
    figure.axes[-1].set_xlabel("Time (s)")
    if len(probes.time) > 1:
        figure.axes[-1].set_xlim(float(probes.time[0]), float(probes.time[-1]))
    return figure


def _draw(ax: Axes, time: Array, curves: list[Array], *, name: str, unit: str) -> None:
    largest = max((float(np.nanmax(np.abs(one), initial=0.0)) for one in curves), default=0.0)
    factor, prefixed = style.prefixed(largest, unit)
    for values, (colour, dashes) in zip(curves, LINES, strict=False):
        ax.plot(time, values * factor, color=colour, linestyle=dashes)
    ax.set_ylabel(f"{name} ({prefixed})")
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
    ax.grid(True)


def _key(ax: Axes, words: list[str]) -> None:
    ax.legend(
        ax.lines,
        words,
        loc="lower left",
        bbox_to_anchor=(0.0, 0.97),
        ncols=len(words),
        borderaxespad=0.0,
        borderpad=0.1,
        handlelength=1.8,
        columnspacing=1.0,
        handletextpad=0.4,
    )
