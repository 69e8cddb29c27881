"""Figures over measured points: drag laws of spheres and cylinders by Reynolds number, panels by angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import ArrayLike, NDArray

from ..water.laws import BarLaw, KnotLaw, Law, PanelLaw, measured
from ..water.laws.law import REYNOLDS
from . import style

Array = NDArray[np.float64]
Curve = tuple[str, Array, Array]  # name, Reynolds numbers, coefficients
ByAngle = tuple[str, Array]  # name, and angles (rad), C_D and C_L, (3, k)

LEFT, BELOW, ABOVE, HEIGHT = 0.52, 0.42, 0.12, 2.0  # in
WIDTH, APART, ROOM = 2.05, 0.54, 0.12  # in: of one axes, between two, and from there to the names
LEAST, MOST, POINTS = 0.1, 1e7, 1200  # Reynolds numbers of the curves
NETTING = (30.0, 1e4)  # Reynolds numbers of twines and knots of netting, shown larger
# Okabe and Ito's colours without black, which is for what was measured, and yellow, which is lost on white paper.
COLOURS = (style.BLUE, style.VERMILION, style.GREEN, "#CC79A7", "#E69F00", "#56B4E9")
DASHES = ("solid", (0, (5.0, 1.5)), (0, (1.2, 1.2)))


@style.styled
def drag_laws(laws: Sequence[Law]) -> Figure:
    """Draw laws of knots, bars (across the flow) and panels, a row for each kind, over measured points.

    By Reynolds number on the left, larger for that of netting on the right; of panels drag and lift by the angle.
    A curve ends where the range of its law ends. A law on the area of the twine is drawn on the outline, by the
    solidity of the measured panel. ValueError when there is no law.
    """
    knots = [law for law in laws if isinstance(law, KnotLaw)]
    bars = [law for law in laws if isinstance(law, BarLaw)]
    panels = [law for law in laws if isinstance(law, PanelLaw)]
    rows = [row for row in (knots, bars, panels) if row]
    if not rows:
        raise ValueError("no law to draw")
    figure, bottoms = _sheet(len(rows))
    for row, bottom in zip(rows, bottoms, strict=True):
        both = [_axes(figure, bottom, LEFT + side * (WIDTH + APART)) for side in (0, 1)]
        if row is knots:
            _draw_knots(both, knots)
        elif row is bars:
            _draw_bars(both, bars)
        else:
            _draw_panels(both, panels)
        _key(both[1])
    return figure


@style.styled
def panel_by_angle(curves: Mapping[str, ArrayLike]) -> Figure:
    """Show drag and lift of panels of netting by the angle of the flow, over Patursson's measured panel.

    curves: by name, (3, k): angles between flow and normal (rad), C_D and C_L on the outline. ValueError for none.
    """
    if not curves:
        raise ValueError("no curve to draw")
    figure, (bottom,) = _sheet(1)
    both = [_axes(figure, bottom, LEFT + side * (WIDTH + APART)) for side in (0, 1)]
    _draw_angles(both, [(name, np.asarray(values, dtype=float)) for name, values in curves.items()])
    _key(both[1])
    return figure


def _sheet(rows: int) -> tuple[Figure, list[float]]:
    """Return a figure for so many rows of two axes, and where each row begins above its lower edge (in)."""
    each = ABOVE + HEIGHT + BELOW
    figure = Figure(figsize=(style.DOUBLE_COLUMN, rows * each))
    return figure, [(rows - number - 1) * each + BELOW for number in range(rows)]


def _key(ax: Axes) -> None:
    place = (1.0 + ROOM / WIDTH, 1.02)
    ax.legend(loc="upper left", bbox_to_anchor=place, borderaxespad=0.0, handlelength=2.2)


def _axes(figure: Figure, bottom: float, left: float) -> Axes:
    wide, high = figure.get_size_inches()
    ax = figure.add_axes((left / wide, bottom / high, WIDTH / wide, HEIGHT / high))
    ax.grid(True)
    return ax


def _look(number: int) -> dict[str, Any]:
    return {
        "color": COLOURS[number % len(COLOURS)],
        "linestyle": DASHES[number // len(COLOURS) % len(DASHES)],
    }


def _mark(ax: Axes, across: Array, up: Array, label: str, size: float) -> None:
    ax.plot(across, up, "o", color=style.BLACK, markersize=size, markeredgewidth=0.0, zorder=3, label=label)


def _stated(law: Law) -> Array:
    """Return Reynolds numbers within the range of a law, both ends among them."""
    ends = next(((one.low, one.high) for one in law.ranges if one.quantity == REYNOLDS), (LEAST, MOST))
    low, high = max(ends[0], LEAST), min(ends[1], MOST)
    return np.geomspace(low, max(high, low), POINTS)


def _by_speed(both: Sequence[Axes], points: Array, curves: Sequence[Curve], label: str, of: str) -> None:
    """Draw curves (name, Re, C_D) over points (n, 2): all of them on the left, those of netting on the right."""
    for ax, size in zip(both, (1.6, 2.4), strict=True):
        for number, (name, reynolds, drag) in enumerate(curves):
            ax.plot(reynolds, drag, label=name, **_look(number))
        _mark(ax, points[:, 0], points[:, 1], label, size)
        ax.set_xscale("log")
        ax.set_xlabel(f"Reynolds number of the {of} (-)")
        ax.set_ylabel("Drag coefficient (-)")
    both[0].set_xlim(LEAST, MOST)
    both[0].set_yscale("log")
    both[0].set_ylim(0.05, 100.0)
    both[1].set_xlim(*NETTING)
    both[1].set_ylim(0.0, 2.0)


def _draw_knots(both: Sequence[Axes], laws: Sequence[KnotLaw]) -> None:
    curves = [(law.name, re, law.coefficients(re)) for law in laws for re in [_stated(law)]]
    _by_speed(both, measured.sphere(), curves, "measured, Roos 1971", "knot")


def _draw_bars(both: Sequence[Axes], laws: Sequence[BarLaw]) -> None:
    curves = [(law.name, re, law.drag_lift(re, np.pi / 2.0)[0]) for law in laws for re in [_stated(law)]]
    _by_speed(both, measured.cylinder(), curves, "measured, cylinders", "twine")


def _draw_panels(both: Sequence[Axes], laws: Sequence[PanelLaw]) -> None:
    angles = np.radians(np.linspace(0.0, 90.0, 181))
    solidity = measured.PANEL_SOLIDITY
    curves = []
    for law in laws:
        on_outline = solidity if law.area == "twine" else 1.0
        drag, lift = law.coefficients(angles, solidity, measured.PANEL_REYNOLDS)
        curves.append((law.name, np.array([angles, on_outline * drag, on_outline * lift])))
    _draw_angles(both, curves)


def _draw_angles(both: Sequence[Axes], curves: Sequence[ByAngle]) -> None:
    """Draw drag on the left and lift on the right over the measured panel."""
    points = measured.panel().T
    for side, (ax, what) in enumerate(zip(both, ("Drag", "Lift"), strict=True), start=1):
        for number, (name, values) in enumerate(curves):
            ax.plot(np.degrees(values[0]), values[side], label=name, **_look(number))
        _mark(ax, np.degrees(points[0]), points[side], "measured, Patursson 2010", 3.4)
        ax.set_xlim(0.0, 90.0)
        ax.set_ylim(bottom=min(0.0, ax.dataLim.y0))
        ax.xaxis.set_major_locator(MultipleLocator(15.0))
        ax.set_xlabel("Angle of flow to normal (deg)")
        ax.set_ylabel(f"{what} coefficient on the outline (-)")
