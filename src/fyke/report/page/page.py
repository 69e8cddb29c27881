"""One HTML file with everything that a reader of a result may ask, which opens without a network."""

from __future__ import annotations

import base64
import io
import json
from dataclasses import dataclass
from datetime import date
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...case.schema import Case
from ...results import flow_direction, mean_current, probes_of
from ...results.compare import Comparison
from ...results.whole import replacing
from ...solve.result import Result
from ...system.system import System
from ..figures import OPTIONS, figures_of
from ..histories import curves
from ..style import SINGLE_COLUMN, styled
from . import words
from .lines import LINE_COLUMNS, line_table
from .loads import load_columns, load_table
from .packing import STEPS, deflated, kept_frames, scene

Array = NDArray[np.float64]

# Bars that a browser still turns at ease; beyond, the page has the printed picture only.
MOST_BARS = 60_000
TITLES = {
    "initial_position": "The net before anything acts",
    "equilibrium_shape": "Shape and bar tensions in the last frame",
    "tension_plan": "Bar tensions on the netting laid flat",
    "tension_histogram": "How many bars bear how much",
    "sections": "Closed netting in sections, as built and in the last frame",
    "histories": "Deflection, drag, largest tension and kinetic energy against time",
    "comparison": "Measured and computed positions",
    "waves": "Elevation of the surface, and velocity of the water at the first probe",
}


@dataclass(frozen=True)
class Origin:
    """Where a result comes from: its file, and the case and system behind it, None where they are not known."""

    file: Path
    case: Case | None = None
    system: System | None = None
    sources: tuple[str, ...] = ()


def write_report(
    result: Result,
    file: str | Path,
    *,
    figures: dict[str, Any],
    origin: Origin,
    comparison: Comparison | None = None,
) -> Path:
    """Write the report of a result to a file that appears whole or not at all.

    figures: the summary of the result, its warnings those of case and run; comparison: against measured positions.
    OSError where the file cannot be written.
    """
    html = render(result, figures=figures, origin=origin, comparison=comparison)
    path = Path(file)
    with replacing(path) as part:
        part.write_text(html, encoding="utf-8")
    return path


def render(
    result: Result, *, figures: dict[str, Any], origin: Origin, comparison: Comparison | None = None
) -> str:
    """Return the report as HTML text."""
    system = origin.system
    spatial = result.net.bar_count <= MOST_BARS
    flow = None if system is None else flow_direction(system)
    data = {"scene": scene(result) if spatial else None, "histories": _histories(result, flow)}
    kept = kept_frames(result)
    step = np.ptp(result.position[kept].reshape(-1, 3), axis=0).max() / STEPS
    html: str = _template("report.html").render(
        title=figures["title"] or origin.file.stem,
        figures=figures,
        plain=words.PLAIN[figures["outcome"]],
        good=result.outcome.ok,
        numbers=words.key_numbers(figures),
        accounts=words.account_words(figures),
        energy=words.energy_rows(figures),
        panels=[(p.name, words.panel_rows(result, p)) for p in result.net.panels],
        part_columns=words.PART_COLUMNS,
        part_table=words.part_table(figures),
        line_columns=LINE_COLUMNS,
        line_table=line_table(figures),
        ring_columns=words.RING_COLUMNS,
        ring_table=words.ring_table(figures),
        load_columns=load_columns(figures),
        load_table=load_table(figures),
        supports=words.support_rows(result, origin.system),
        comparison=comparison,
        pictures=_pictures(result, origin, comparison),
        sources=origin.sources,
        case_text=result.case_text,
        versions=words.versions(),
        frames=(len(kept), len(result.time)),
        rounding=f"{1e3 * step:.1g} mm",
        most_bars=MOST_BARS,
        spatial=spatial,
        file=origin.file,
        today=date.today().isoformat(),
        data=Markup(json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")),
        plotly=_plotly(),
        style=_asset("report.css"),
        script=_asset("report.js"),
    )
    return html


def _template(name: str) -> Any:
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.from_string(files(__package__).joinpath(name).read_text(encoding="utf-8"))


def _asset(name: str) -> Markup:
    return Markup(files(__package__).joinpath(name).read_text(encoding="utf-8"))


def _plotly() -> str:
    """plotly.js, deflated."""
    code = files("plotly").joinpath("package_data", "plotly.min.js").read_bytes()
    return deflated(np.frombuffer(code, dtype=np.uint8))


def _histories(result: Result, flow: Array | None) -> list[dict[str, Any]]:
    if len(result.time) < 2:
        return []
    return [
        {"name": name, "unit": unit, "time": result.time.tolist(), "values": values.tolist()}
        for name, values, unit in curves(result, flow)
    ]


def _pictures(result: Result, origin: Origin, comparison: Comparison | None) -> list[dict[str, Any]]:
    """Name, caption, both forms of every figure, and whether it is made for the whole width of a page."""
    water: dict[str, Any] = {}
    if origin.system is not None and origin.case is not None:
        waves = origin.system.waves
        water = {
            "current": mean_current(origin.system),
            "waves": None if waves is None else waves.direction,
            "probes": probes_of(origin.system, result, origin.case.output.probes),
        }
    made = figures_of(result, comparison=comparison, **water)
    return [
        {
            "name": name,
            "title": TITLES[name],
            "broad": figure.get_figwidth() > SINGLE_COLUMN,
            **{kind: _data_uri(figure, kind) for kind in OPTIONS},
        }
        for name, figure in made.items()
    ]


@styled
def _data_uri(figure: Figure, kind: str) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, **OPTIONS[kind])
    mime = {"png": "image/png", "svg": "image/svg+xml"}[kind]
    return f"data:{mime};base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"
