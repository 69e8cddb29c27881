"""The rows of a validation as text: numbers with their units, rows that are alike together, and REPORT.md."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

from .claims import LEVELS
from .validate import Judged, Report, Verdict

HEAD = ("quantity", "case", "ours", "reference", "difference", "tolerance", "verdict")
MEANING: dict[Verdict, str] = {
    "holds": "the difference is within the tolerance",
    "fails": "it is not, or the row could not be measured",
    "missing": "the measurement, or the program to compare with, is not there",
    "shown": "nothing to be judged by; the number is shown, beside another one where there is one",
}
# Verdicts by which a claim of several is known, the first that there is.
WORST: tuple[Verdict, ...] = ("fails", "holds", "missing")
# So many rows of one quantity that hold are told one by one in REPORT.md; of more of them only the worst is.
TOLD = 6


def cells(row: Judged) -> tuple[str, ...]:
    """Write a row under HEAD; texts are empty where there is nothing."""
    return (
        row.quantity,
        row.case,
        _number(row.ours, row.unit),
        _number(row.reference, row.unit),
        _difference(row),
        _tolerance(row),
        row.verdict,
    )


def alike(rows: Sequence[Judged]) -> list[list[Judged]]:
    """Rows of one quantity of one claim together, the furthest off first; rows that fail stay alone."""
    together: dict[tuple[str, str, str], list[Judged]] = {}
    for row in rows:
        alone = row.case if row.verdict == "fails" else ""
        together.setdefault((row.claim, row.quantity, alone), []).append(row)
    return [sorted(some, key=_size, reverse=True) for some in together.values()]


def worst_of(rows: Sequence[Judged]) -> str:
    """Say which case the first of rows that are alike is."""
    if len(rows) == 1:
        return rows[0].case
    return f"{'largest' if rows[0].difference is None else 'worst'} of {len(rows)}: {rows[0].case}"


def _size(row: Judged) -> float:
    """How far off a row is, or how large where there is nothing to be off from."""
    return abs((row.ours if row.difference is None else row.difference) or 0.0)


def by_claim(report: Report) -> list[tuple[str, list[list[Judged]]]]:
    """Title of every level that has rows, and the rows of each of its claims."""
    out = []
    for level, title in LEVELS.items():
        rows = [row for row in report.rows if row.level == level]
        if rows:
            out.append((title, [list(some) for _, some in groupby(rows, key=lambda row: row.claim)]))
    return out


def levels_of(report: Report) -> list[dict[str, Any]]:
    """Return what the page shows: title and claims of every level.

    Of a claim: title, source, verdicts in words, the verdict that gives it its colour, picture, and rows: cells,
    verdict, reason and miss, the size of the difference over the tolerance, None where there is none.
    """
    return [
        {
            "title": title,
            "claims": [
                {
                    "title": rows[0].title,
                    "source": rows[0].source,
                    "verdicts": verdicts(rows),
                    "colour": next(
                        (one for one in WORST if any(row.verdict == one for row in rows)), "shown"
                    ),
                    "picture": report.pictures.get(rows[0].claim),
                    "rows": [_told(row) for row in rows],
                }
                for rows in claims
            ],
        }
        for title, claims in by_claim(report)
    ]


def _told(row: Judged) -> dict[str, Any]:
    judged = row.verdict in {"holds", "fails"} and row.side == "both"
    judged = judged and bool(row.tolerance) and row.difference is not None
    return {
        "cells": cells(row),
        "verdict": row.verdict,
        "reason": " ".join(row.reason.split()),
        "miss": abs(row.difference or 0.0) / (row.tolerance or 1.0) if judged else None,
    }


def verdicts(rows: Sequence[Judged]) -> str:
    """Say how many rows of each verdict there are."""
    counts = {one: sum(row.verdict == one for row in rows) for one in MEANING}
    words = {"holds": "hold", "fails": "fail"}
    return ", ".join(f"{count} {words.get(one, one)}" for one, count in counts.items() if count)


def summary_line(report: Report) -> str:
    """Say in one sentence how the rows came out."""
    told = [f"{report.count('holds')} of {len(report.rows)} rows hold", f"{report.count('fails')} fail"]
    told += [f"{report.count('missing')} lack the measurement", f"{report.count('shown')} are shown only"]
    return ", ".join(told)


def markdown(report: Report, *, version: str, command: str) -> str:
    """Return REPORT.md: what was run, and of every claim its source, a table, and the reason of every tolerance."""
    lines = [
        "# Validation report",
        "",
        f"Made by `{command}` with fyke {version}. {summary_line(report)}.",
        f"Of more than {TOLD} rows of one quantity that all hold the worst stands here; `{command} --all` prints"
        " every one.",
        "",
        *(f"- *{verdict}*: {meaning}." for verdict, meaning in MEANING.items()),
    ]
    for title, claims in by_claim(report):
        lines += ["", f"## {title}"]
        for rows in claims:
            lines += ["", f"### {rows[0].title}", "", f"Against: {rows[0].source}. {verdicts(rows)}.", ""]
            lines += [*_table(rows), "", *_reasons(rows)]
    return "\n".join(lines) + "\n"


def _table(rows: list[Judged]) -> Iterator[str]:
    yield "| " + " | ".join(HEAD) + " |"
    yield "|" + "---|" * len(HEAD)
    for some in alike(rows):
        many = len(some) > TOLD and all(row.verdict == "holds" for row in some)
        for row in some[:1] if many else [row for row in rows if row in some]:
            told = list(cells(row))
            told[1] = worst_of(some) if many else row.case
            yield "| " + " | ".join(cell.replace("|", "\\|") for cell in told) + " |"


def _reasons(rows: list[Judged]) -> Iterator[str]:
    """Tell the reason of every row's tolerance or what went wrong, each once."""
    for quantity, reason in dict.fromkeys((row.quantity, " ".join(row.reason.split())) for row in rows):
        yield f"- {quantity}: {reason}."


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
    if row.side != "both":
        return "at least that" if row.side == "above" else "at most that"
    return f"{100.0 * row.tolerance:.2g} %" if row.relative else f"{row.tolerance:.2g} {row.unit}".rstrip()
