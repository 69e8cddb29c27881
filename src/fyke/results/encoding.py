"""Twines, panels and outcome as texts and numbers that fit into the attributes of a result file."""

from __future__ import annotations

import hashlib
import json
import tomllib
from dataclasses import fields
from typing import Any

import numpy as np

from ..netting.elastic import ElasticLaw, LinearLaw, PowerLaw, TableLaw
from ..netting.net import Panel
from ..netting.twine import Twine
from ..solve.outcome import Outcome

LAWS: dict[str, type[Any]] = {"linear": LinearLaw, "power": PowerLaw, "table": TableLaw}
PANEL_ARRAYS = ("centre", "axes")


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
    """Write panels as JSON."""
    return json.dumps(
        [_own(p) | {name: getattr(p, name).tolist() for name in PANEL_ARRAYS} for p in panels],
        allow_nan=False,
    )


def panels_from_text(text: str) -> tuple[Panel, ...]:
    """Read what `panels_to_text` wrote."""
    return tuple(
        Panel(**(_tuples(noun) | {name: np.array(noun[name], dtype=float) for name in PANEL_ARRAYS}))
        for noun in json.loads(text)
    )


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
