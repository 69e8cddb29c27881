"""All figures of a result, drawn and written in one go."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from ..results.compare import Comparison
from ..results.probes import Probes
from ..results.whole import replacing
from ..solve.result import Result
from . import style
from .histogram import tension_histogram
from .histories import histories
from .overlay import shape_comparison
from .plan import tension_plan
from .sections import sections
from .shapes import equilibrium_shape, initial_position
from .waves import wave_histories

__all__ = [
    "draw_all",
    "equilibrium_shape",
    "figures_of",
    "histories",
    "initial_position",
    "sections",
    "shape_comparison",
    "tension_histogram",
    "tension_plan",
    "wave_histories",
    "write_figure",
]

# No date and no version, so that the same result gives the same bytes. A PNG packed harder takes twice the time to
# write and is a tenth smaller.
OPTIONS: dict[str, dict[str, Any]] = {
    "png": {"metadata": {"Software": "fyke"}, "pil_kwargs": {"compress_level": 3}},
    "svg": {"metadata": {"Date": None, "Creator": "fyke"}},
}


def draw_all(
    result: Result,
    folder: str | Path,
    *,
    comparison: Comparison | None = None,
    current: ArrayLike | None = None,
    waves: ArrayLike | None = None,
    probes: Probes | None = None,
) -> list[Path]:
    """Draw every figure that applies to a result; write each as PNG and SVG into an existing folder.

    comparison: adds the overlay of measured positions; current: (3,) m/s, undisturbed, for the arrow of the initial
    position and the direction of drag; waves: (3,) direction in which they go, for an arrow of their own, and for drag
    where there is no current; probes: adds the waves. A result of more than one frame has histories, closed
    netting its sections. Return the files written.
    """
    figures = figures_of(result, comparison=comparison, current=current, waves=waves, probes=probes)
    return [file for name, figure in figures.items() for file in write_figure(figure, Path(folder) / name)]


def figures_of(
    result: Result,
    *,
    comparison: Comparison | None = None,
    current: ArrayLike | None = None,
    waves: ArrayLike | None = None,
    probes: Probes | None = None,
) -> dict[str, Figure]:
    """Draw every figure that applies to a result, by name; arguments are those of `draw_all`."""
    figures = {
        "initial_position": initial_position(result, current=current, waves=waves),
        "equilibrium_shape": equilibrium_shape(result),
        "tension_plan": tension_plan(result),
        "tension_histogram": tension_histogram(result),
    }
    cut = sections(result, current=current, waves=waves)
    if cut is not None:
        figures["sections"] = cut
    if len(result.time) > 1:
        flow = waves if current is None or not np.any(current) else current
        figures["histories"] = histories(result, current=flow)
    if comparison is not None:
        figures["comparison"] = shape_comparison(result, comparison)
    if probes is not None:
        figures["waves"] = wave_histories(probes)
    return figures


@style.styled
def write_figure(figure: Figure, stem: Path) -> list[Path]:
    """Write a figure as PNG and SVG under a name without ending; return both files, each there whole or not at all."""
    files = []
    for kind, options in OPTIONS.items():
        file = stem.with_name(f"{stem.name}.{kind}")
        with replacing(file) as part:
            figure.savefig(part, format=kind, **options)
        files.append(file)
    return files
