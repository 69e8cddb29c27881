"""The page of a validation: every row with what it is compared with, and how much of its tolerance it takes."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from datetime import date
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from ..results.whole import replacing
from ..version import __version__
from .figures import OPTIONS
from .style import BLUE, DOUBLE_COLUMN, GREEN, ORANGE, VERMILION, styled

# Title and claims of each level, see study.text.levels_of.
Levels = Sequence[Mapping[str, Any]]

HEAD = ("quantity", "case", "ours", "reference", "difference", "tolerance", "verdict")
# Below this part of the tolerance a row is as good as exact, and drawn there.
LEAST_MISS = 1e-6
COLOURS = (BLUE, GREEN, ORANGE, VERMILION)


def write_page(path: Path, levels: Levels, *, title: str, command: str) -> None:
    """Write the page to a file that appears whole or not at all."""
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["base64"] = lambda picture: base64.b64encode(picture).decode("ascii")
    page = files(__package__)
    html = environment.from_string(page.joinpath("verdicts.html").read_text(encoding="utf-8")).render(
        title=title,
        command=command,
        version=__version__,
        today=date.today().isoformat(),
        head=HEAD,
        levels=levels,
        all_rows=as_png(misses(levels)),
        style=Markup(page.joinpath("page", "report.css").read_text(encoding="utf-8")),
    )
    with replacing(path) as part:
        part.write_text(html, encoding="utf-8")


@styled
def misses(levels: Levels) -> Figure:
    """Draw the difference of every judged row over its tolerance, a row of dots for each level."""
    figure = Figure(figsize=(DOUBLE_COLUMN, 0.5 + 0.28 * max(len(levels), 1)), layout="constrained")
    axes = figure.add_subplot()
    for place, level in enumerate(levels):
        rows = [row for claim in level["claims"] for row in claim["rows"]]
        found = np.array([row["miss"] for row in rows if row["miss"] is not None])
        spread = 0.25 * np.sin(2.4 * np.arange(len(found)))  # so that dots on one place are seen
        axes.plot(
            np.maximum(found, LEAST_MISS),
            place + spread,
            "o",
            markersize=2.5,
            color=COLOURS[place % len(COLOURS)],
            alpha=0.7,
        )
    axes.axvline(1.0, color="black", linewidth=0.8)
    axes.set_xscale("log")
    axes.set_xlim(0.5 * LEAST_MISS, 10.0)
    axes.set_yticks(range(len(levels)), [level["title"] for level in levels])
    axes.invert_yaxis()
    axes.set_xlabel("difference over tolerance; right of the line a row fails")
    return figure


@styled
def as_png(figure: Figure) -> bytes:
    """Picture of a figure, as bytes of PNG."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", **OPTIONS["png"])
    return buffer.getvalue()
