"""The table of load cases on the page."""

from __future__ import annotations

from typing import Any

from .words import number

Cell = tuple[str, Any]
# Heads of the columns that may be empty, and the keys of the summary that fill them.
_SEA = (
    ("Wave height (m)", "wave_height"),
    ("Wave period (s)", "wave_period"),
    ("Waves towards", "waves_towards"),
)
_MOORED = (("Largest mooring tension (N)", "mooring_tension"),)
_AFLOAT = (("Netting on collar (N)", "collar_force"),)


def load_columns(figures: dict[str, Any]) -> list[str]:
    """Heads of the columns; those of waves and moorings only where there are some."""
    cases = figures.get("load_cases", [])
    return [
        "Load case",
        "Current (m/s)",
        "Towards",
        *(name for name, _ in _there(cases, _SEA)),
        "Force on supports (N)",
        *(name for name, _ in _there(cases, _AFLOAT)),
        *(name for name, _ in _there(cases, _MOORED)),
        "Largest tension (N)",
        "Of breaking strength",
        "Volume left",
        "Largest displacement (m)",
    ]


def load_table(figures: dict[str, Any]) -> list[tuple[bool, list[Cell]]]:
    """Whether it is the worst, and text and exact value of every cell under load_columns, for each load case."""
    cases, worst = figures.get("load_cases", []), figures.get("worst_load_case")
    return [(one["name"] == worst, _row(one, cases)) for one in cases]


def _row(one: dict[str, Any], cases: list[dict[str, Any]]) -> list[Cell]:
    name = one["name"] + ("" if one["ok"] else f": {one['outcome'].replace('_', ' ')}")
    units = {"waves_towards": "°"}
    used, left = one["utilisation"], one["volume_left"]
    return [
        (name, None),
        (number(one["current"]), one["current"]),
        (number(one["towards"], "°", 4), one["towards"]),
        *((number(one.get(key), units.get(key, "")), one.get(key)) for _, key in _there(cases, _SEA)),
        (number(one["support_force"]), one["support_force"]),
        *((number(one.get(key)), one.get(key)) for _, key in _there(cases, _AFLOAT)),
        *((number(one[key]) + _of(one["mooring_part"]), one[key]) for _, key in _there(cases, _MOORED)),
        (number(one["tension"]) + _of(one["tension_part"]), one["tension"]),
        ("–" if used is None else number(100.0 * used, "%", 3) + _of(one["utilisation_part"]), used),
        ("–" if left is None else number(100.0 * left, "%", 4), left),
        (number(one["displacement"]), one["displacement"]),
    ]


def _of(part: str) -> str:
    return f", {part}" if part else ""


def _there(cases: list[dict[str, Any]], columns: tuple[tuple[str, str], ...]) -> list[tuple[str, str]]:
    return [(name, key) for name, key in columns if any(one.get(key) is not None for one in cases)]
