"""Figure of a dynamic run against time: deflection, drag, largest tension and kinetic energy."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator
from numpy.typing import ArrayLike, NDArray

from ..results.volume import volume_history
from ..solve.result import Result
from . import style
from .carried import way
from .ticks import STEPS

Array = NDArray[np.float64]

LEFT, RIGHT, BELOW, ABOVE, GAP, HEIGHT = 0.7, 0.12, 0.38, 0.08, 0.12, 0.85  # in
LABEL = 0.36  # in, from an axis to its label
ENERGY = "Kinetic energy"
# Kinetic energies that span less than this have no room for the labels of a logarithmic axis.
SPAN = 30.0


@style.styled
def histories(result: Result, *, current: ArrayLike | None = None) -> Figure:
    """Show centre deflection, drag, largest tension and kinetic energy of a run against time, one over another.

    current: (3,) of any length, the direction in which drag is counted; the horizontal direction of the last frame's
    force of the water when left out. Kinetic energy has a logarithmic axis where
    it spans SPAN or more, and is left out of a run that never moves.
    ValueError for a result with one frame.
    """
    if len(result.time) < 2:
        raise ValueError(
            "a history needs two frames at least; this result has one, as that of a static solve"
        )
    shown = [one for one in curves(result, current) if one[0] != ENERGY or np.any(one[1] > 0.0)]
    count = len(shown)
    width, height = style.SINGLE_COLUMN, ABOVE + count * HEIGHT + (count - 1) * GAP + BELOW
    figure = Figure(figsize=(width, height))
    for index in range(count):
        bottom = height - ABOVE - HEIGHT - index * (HEIGHT + GAP)
        room = (LEFT / width, bottom / height, 1.0 - (LEFT + RIGHT) / width, HEIGHT / height)
        ax = figure.add_axes(room, sharex=figure.axes[0] if index else None, label=f"history {index}")
        name, values, unit = shown[index]
        if name == ENERGY:
            draw_energy(ax, result.time, values)
        else:
            draw_history(ax, result.time, values, name=name.replace(" ", "\n"), unit=unit)
        ax.yaxis.set_label_coords(-LABEL / (width - LEFT - RIGHT), 0.5)
        ax.tick_params(labelbottom=index == count - 1)
    figure.axes[-1].set_xlabel("Time (s)")
    figure.axes[-1].set_xlim(float(result.time[0]), float(result.time[-1]))
    return figure


def curves(result: Result, current: ArrayLike | None) -> list[tuple[str, Array, str]]:
    """Name, values (k,) and unit of what is followed through a run, a sack's volume too; current as for `histories`."""
    volumes = volume_history(result)
    sack = [] if volumes is None else [("Enclosed volume", volumes[1], "m³")]
    return [
        ("Centre deflection", centre_deflection(result), "m"),
        ("Drag", drag(result, current), "N"),
        ("Largest tension", result.tension.max(axis=1, initial=0.0), "N"),
        *sack,
        (ENERGY, result.kinetic_energy, "J"),
    ]


def draw_history(ax: Axes, time: Array, values: Array, *, name: str, unit: str) -> None:
    """Draw values (k,) in SI against time (k,) s, with a prefix to the unit that keeps the numbers short."""
    factor, prefixed = style.prefixed(float(np.max(np.abs(values))), unit)
    ax.plot(time, values * factor, color=style.BLUE)
    ax.set_ylabel(f"{name} ({prefixed})")
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
    ax.grid(True)


def draw_energy(ax: Axes, time: Array, energy: Array) -> None:
    """Draw kinetic energy (k,) J, on a logarithmic axis where it spans SPAN or more; moments of rest are gaps there."""
    some = energy[energy > 0.0]
    if len(some) and some.max() < SPAN * some.min():
        draw_history(ax, time, energy, name="Kinetic\nenergy", unit="J")
        return
    ax.plot(time, np.where(energy > 0.0, energy, np.nan), color=style.BLUE)
    ax.set_yscale("log")
    ax.set_ylabel("Kinetic\nenergy (J)")
    ax.yaxis.set_major_locator(LogLocator(numticks=5))
    ax.grid(True)


def centre_deflection(result: Result) -> Array:
    """Distance (k,) m of the free knot nearest the middle of the net from its place as built among the held knots.

    The middle is the mean of the initial positions; a net without free knots shows that of a fixed one.
    """
    net = result.net
    away = np.linalg.norm(net.positions - net.positions.mean(axis=0), axis=1)
    if not net.fixed.all():
        away[net.fixed] = np.inf
    centre = int(np.argmin(away))
    return np.asarray(
        np.linalg.norm(result.position[:, centre] - net.positions[centre] - way(result), axis=1)
    )


def drag(result: Result, current: ArrayLike | None) -> Array:
    """Force of the water (k,) N along the current (3,), or along the horizontal part of its last value."""
    if current is not None and np.any(current):
        along = np.asarray(current, dtype=float)
    else:
        along = result.hydrodynamic_force[-1] * [1.0, 1.0, 0.0]
    size = float(np.linalg.norm(along))
    unit = along / size if size > 0.0 else np.array([1.0, 0.0, 0.0])
    return np.asarray(result.hydrodynamic_force @ unit)
