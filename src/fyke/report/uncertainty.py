"""Figures of a study of uncertainty: how far each output spreads, and which input it comes from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .style import BLACK, BLUE, DOUBLE_COLUMN, FRAME_GREY, ORANGE, styled

Array = NDArray[np.float64]

# Heights of one bar and of what surrounds the bars, in.
BAR, AROUND = 0.22, 0.85
COLUMNS = 3


def _axes(count: int, height: float) -> tuple[Figure, list[Axes]]:
    rows = -(-count // COLUMNS)
    columns = min(count, COLUMNS)
    width = DOUBLE_COLUMN * columns / COLUMNS if columns < COLUMNS else DOUBLE_COLUMN
    figure = Figure(figsize=(max(width, DOUBLE_COLUMN / 2), rows * height), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    for spare in grid.ravel()[count:]:
        spare.set_axis_off()
    return figure, list(grid.ravel()[:count])


@styled
def tornado(inputs: Sequence[str], outputs: Mapping[str, str], nominal: Array, found: Array) -> Figure:
    """Draw each output with one input at its 5 and 95 per cent quantile, all else as in the case.

    outputs: name and unit; nominal: (outputs,); found: (inputs, 2, outputs), NaN where a run failed.
    """
    figure, all_axes = _axes(len(outputs), AROUND + BAR * len(inputs))
    for place, (axes, (name, unit)) in enumerate(zip(all_axes, outputs.items(), strict=True)):
        span = found[:, :, place]
        order = np.argsort(np.nan_to_num(np.ptp(span, axis=1)))
        for row, which in enumerate(order.tolist()):
            for value, colour, word in zip(span[which], (BLUE, ORANGE), ("5 %", "95 %"), strict=True):
                label = f"input at its {word} quantile" if row == 0 else None
                axes.barh(
                    row, value - nominal[place], left=nominal[place], height=0.7, color=colour, label=label
                )
        axes.axvline(nominal[place], color=BLACK, linewidth=0.8)
        axes.set_yticks(range(len(inputs)), [inputs[which] for which in order.tolist()])
        axes.set_xlabel(f"{name} ({unit})" if unit else name)
        if place == 0:
            figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    return figure


@styled
def bands(outputs: Mapping[str, str], nominal: Array, samples: Array) -> Figure:
    """Draw how many samples lie below each value of an output, its 5 to 95 per cent band, and the case itself.

    outputs: name and unit; nominal: (outputs,); samples: (k, outputs).
    """
    figure, all_axes = _axes(len(outputs), 2.0)
    part = (np.arange(len(samples)) + 0.5) / len(samples)
    for place, (axes, (name, unit)) in enumerate(zip(all_axes, outputs.items(), strict=True)):
        values = np.sort(samples[:, place])
        low, high = np.quantile(values, [0.05, 0.95])
        axes.axvspan(low, high, color=FRAME_GREY, alpha=0.18, linewidth=0.0, label="5 to 95 % band")
        axes.plot(values, 100.0 * part, color=BLUE, label="samples below (%)")
        axes.axvline(nominal[place], color=BLACK, linewidth=0.8, label="the case")
        axes.set_xlabel(f"{name} ({unit})" if unit else name)
        axes.set_ylim(0.0, 100.0)
        if place % COLUMNS == 0:
            axes.set_ylabel("samples below (%)")
        if place == 0:
            figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=3)
    return figure
