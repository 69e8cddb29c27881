"""The table of lines on the report page."""

from __future__ import annotations

from typing import Any

from .words import number

LINE_COLUMNS = (
    *("Line", "Length (m)", "From: tension (N)", "level, up (N)", "above level (°)"),
    *(
        "To: tension (N)",
        "level, up (N)",
        "above level (°)",
        "Largest in the run (N)",
        "Of strength",
        "On the bed (m)",
    ),
)


def line_table(figures: dict[str, Any]) -> list[list[tuple[str, Any]]]:
    """Text and exact value of every cell under LINE_COLUMNS, a row for each line; empty without any."""
    return [_row(line) for line in figures.get("lines", ())]


def _row(line: dict[str, Any]) -> list[tuple[str, Any]]:
    used, lies = line["utilisation"], line["on_bed"]
    ends = []
    for end in ("from", "to"):
        pull, level, up = (line[f"{what}_{end}"] for what in ("tension", "horizontal", "vertical"))
        anchor = ", anchor" if line[f"held_{end}"] else ""
        ends += [(number(pull) + anchor, pull), (f"{number(level)}, {number(up)}", None)]
        ends.append((f"{line[f'uplift_{end}']:z.1f}", line[f"uplift_{end}"]))
    return [
        (line["name"] or "–", None),
        (number(line["length"]), line["length"]),
        *ends,
        (number(line["peak_tension"]), line["peak_tension"]),
        ("–" if used is None else number(100.0 * used, "%"), used),
        ("–" if lies is None else number(lies), lies),
    ]
