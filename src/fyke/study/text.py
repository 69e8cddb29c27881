"""The rows of a validation as text: numbers with their units, and the Markdown of REPORT.md."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .claims import LEVELS
from .validate import Judged, Report, Verdict

HEAD = ("case", "quantity", "ours", "reference", "difference", "tolerance", "verdict")
MEANING: dict[Verdict, str] = {
    "holds": "the difference is within the tolerance",
    "fails": "it is not, or the row could not be measured",
    "missing": "the measurement exists somewhere and is not in the data",
    "shown": "nothing to compare with; the number is shown",
}


def cells(row: Judged) -> tuple[str, ...]:
    """Write a row under HEAD; texts are empty where there is nothing."""
    case = f"{row.title}: {row.case}" if row.case else row.title
    return (
        case,
        row.quantity,
        _number(row.ours, row.unit),
        _number(row.reference, row.unit),
        _difference(row),
        _tolerance(row),
        row.verdict,
    )


def table_cells(report: Report) -> list[tuple[str, list[dict[str, Any]]]]:
    """Return title and rows of every level that has some: cells, verdict, reason, source, miss.

    miss: size of the difference over the tolerance, None where there is none.
    """
    return [
        (title, [_told(row) for row in rows])
        for level, title in LEVELS.items()
        if (rows := [row for row in report.rows if row.level == level])
    ]


def _told(row: Judged) -> dict[str, Any]:
    judged = (
        row.tolerance
        and row.side == "both"
        and row.difference is not None
        and row.verdict in {"holds", "fails"}
    )
    return {
        "claim": row.claim,
        "cells": cells(row),
        "verdict": row.verdict,
        "reason": " ".join(row.reason.split()),
        "source": row.source,
        "miss": abs(row.difference or 0.0) / (row.tolerance or 1.0) if judged else None,
    }


def summary_line(report: Report) -> str:
    """Say in one sentence how the rows came out."""
    told = [f"{report.count('holds')} of {len(report.rows)} rows hold", f"{report.count('fails')} fail"]
    told += [f"{report.count('missing')} lack the measurement", f"{report.count('shown')} are shown only"]
    return ", ".join(told)


def markdown(report: Report, *, version: str, command: str) -> str:
    """Return REPORT.md: what was run, a table for each level, and the reason of every tolerance."""
    lines = [
        "# Validation report",
        "",
        f"Made by `{command}` with fyke {version}. {summary_line(report)}.",
        "",
        *(f"- *{verdict}*: {meaning}." for verdict, meaning in MEANING.items()),
    ]
    for level, title in LEVELS.items():
        rows = [row for row in report.rows if row.level == level]
        if rows:
            lines += ["", f"## {title}", "", *_table(rows), "", *_reasons(rows)]
    return "\n".join(lines) + "\n"


def _table(rows: list[Judged]) -> Iterator[str]:
    yield "| " + " | ".join(HEAD) + " |"
    yield "|" + "---|" * len(HEAD)
    for row in rows:
        yield "| " + " | ".join(cell.replace("|", "\\|") for cell in cells(row)) + " |"


def _reasons(rows: list[Judged]) -> Iterator[str]:
    """Source of every claim once, and the reason of every row's tolerance or what went wrong, each once."""
    for title in dict.fromkeys(row.title for row in rows):
        mine = [row for row in rows if row.title == title]
        yield f"- {title}. Against: {mine[0].source}."
        for quantity, reason in dict.fromkeys((row.quantity, row.reason) for row in mine):
            told = " ".join(reason.split())
            yield f"    - {quantity}: {told}"


def _number(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:.6g} {unit}".rstrip()


def _difference(row: Judged) -> str:
    if row.difference is None:
        return ""
    if row.relative:
        return f"{100.0 * row.difference:+.2g} %"
    return f"{row.difference:+.2g} {row.unit}".rstrip()


def _tolerance(row: Judged) -> str:
    if row.tolerance is None or row.verdict in {"missing", "shown"}:
        return ""
    sides = {"both": "", "above": "at least ", "below": "at most "}
    told = f"{100.0 * row.tolerance:.2g} %" if row.relative else f"{row.tolerance:.2g} {row.unit}".rstrip()
    return sides[row.side] + ("it" if row.side != "both" and not row.tolerance else told)
