"""Twines, panels and outcome as texts and numbers that fit into the attributes of a result file."""

from __future__ import annotations

import hashlib
import json
import tomllib
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..netting.elastic import ElasticLaw, LinearLaw, PowerLaw, TableLaw
from ..netting.net import Panel
from ..netting.twine import Twine
from ..solve.outcome import Outcome

LAWS: dict[str, type[Any]] = {"linear": LinearLaw, "power": PowerLaw, "table": TableLaw}
PANEL_ARRAYS = ("knots", "bars")


def _own(noun: Any) -> dict[str, Any]:
    return {f.name: getattr(noun, f.name) for f in fields(noun)}


def _law_as_dict(law: ElasticLaw) -> dict[str, Any]:
    for kind, law_class in LAWS.items():
        if type(law) is law_class:
            return {"kind": kind, **_own(law)}
    raise ValueError(
        f"a result file holds the elastic laws {', '.join(LAWS)}, not {type(law).__name__}; "
        "write the law as a table of strain and tension"
    )


def _tuples(noun: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in noun.items()}


def twines_to_text(twines: tuple[Twine, ...]) -> str:
    """Write twines with their elastic laws as JSON; ValueError for a law that is not one of fyke's."""
    return json.dumps([_own(t) | {"law": _law_as_dict(t.law)} for t in twines], allow_nan=False)


def twines_from_text(text: str) -> tuple[Twine, ...]:
    """Read what `twines_to_text` wrote."""
    twines = []
    for noun in json.loads(text):
        law = _tuples(noun["law"])
        twines.append(Twine(**(noun | {"law": LAWS[law.pop("kind")](**law)})))
    return tuple(twines)


def panels_to_text(panels: tuple[Panel, ...]) -> str:
    """Write panels as JSON, their long arrays of numbers in runs that rise by 1: first, count, first, count ..."""
    return json.dumps(
        [
            _own(p) | {name: _runs(getattr(p, name)) for name in PANEL_ARRAYS} | {"segments": p.bars.shape[1]}
            for p in panels
        ],
        allow_nan=False,
    )


def _runs(numbers: NDArray[np.int64]) -> list[int]:
    flat = numbers.ravel()
    first = np.flatnonzero(np.diff(flat, prepend=-2) != 1)
    counts = np.diff(first, append=len(flat))
    return np.column_stack([flat[first], counts]).ravel().tolist()


def _from_runs(runs: list[int]) -> NDArray[np.int64]:
    pairs = np.array(runs, dtype=np.int64).reshape(-1, 2)
    return np.repeat(pairs[:, 0], pairs[:, 1]) + _within(pairs[:, 1])


def _within(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """0, 1 .. of every run, one after the other."""
    begin = np.cumsum(counts) - counts
    return np.asarray(np.arange(int(counts.sum())) - np.repeat(begin, counts))


def panels_from_text(text: str) -> tuple[Panel, ...]:
    """Read what `panels_to_text` wrote."""
    panels = []
    for noun in json.loads(text):
        knots, bars = (_from_runs(noun[name]) for name in PANEL_ARRAYS)
        arrays = {"knots": knots, "bars": bars.reshape(-1, noun.pop("segments"))}
        panels.append(Panel(**(_tuples(noun) | arrays)))
    return tuple(panels)


def outcome_to_attributes(outcome: Outcome) -> dict[str, Any]:
    """Name the fields of an outcome "outcome", "outcome_message", ...; the warnings become JSON."""
    values = {f"outcome_{key}": value for key, value in _own(outcome).items()}
    values["outcome_warnings"] = json.dumps(outcome.warnings)
    return {"outcome": values.pop("outcome_name")} | values


def outcome_from_attributes(attributes: dict[str, Any]) -> Outcome:
    """Read what `outcome_to_attributes` named."""
    values = {f.name: attributes[f"outcome_{f.name}"] for f in fields(Outcome) if f.name != "name"}
    values["warnings"] = tuple(json.loads(values["warnings"]))
    return Outcome(name=attributes["outcome"], **values)


def case_title(case_text: str) -> str:
    """Return the title that a case file gives itself, "" where it gives none."""
    try:
        return str(tomllib.loads(case_text).get("title", ""))
    except tomllib.TOMLDecodeError:
        return ""


def case_hash(case_text: str) -> str:
    """Return the SHA-256 of a case text in UTF-8 as hexadecimal digits, "" for a net made in Python."""
    return hashlib.sha256(case_text.encode()).hexdigest() if case_text else ""
