"""Twines, parts of the net and outcome as texts and numbers that fit into the attributes of a result file."""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..netting.elastic import ElasticLaw, LinearLaw, PowerLaw, QuadraticLaw, TableLaw
from ..netting.net import Bodies, Panel, Rope
from ..netting.twine import Twine
from ..solve.outcome import Outcome

LAWS: dict[str, type[Any]] = {
    "linear": LinearLaw,
    "power": PowerLaw,
    "quadratic": QuadraticLaw,
    "table": TableLaw,
}
# Parts of a net, by the attribute of the file and of Net that holds them.
PARTS = ("panels", "ropes", "bodies")
Part = Panel | Rope | Bodies
P = TypeVar("P", bound=Part)


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


def parts_to_text(parts: Sequence[Part]) -> str:
    """Write panels, ropes or bodies as JSON, their arrays as runs that rise by 1: first, count, first, count ..."""
    return json.dumps(
        [
            {
                key: _runs(value) if isinstance(value, np.ndarray) else value
                for key, value in _own(one).items()
            }
            for one in parts
        ],
        allow_nan=False,
    )


def parts_from_text(kind: Callable[..., P], text: str) -> tuple[P, ...]:
    """Read what `parts_to_text` wrote of parts of a kind."""
    return tuple(kind(**{key: _value(value) for key, value in noun.items()}) for noun in json.loads(text))


def _value(told: Any) -> Any:
    if isinstance(told, dict):
        return _from_runs(told)
    return tuple(told) if isinstance(told, list) else told


def _runs(numbers: NDArray[np.int64]) -> dict[str, list[int]]:
    flat = numbers.ravel()
    first = np.flatnonzero(np.diff(flat, prepend=-2) != 1)
    counts = np.diff(first, append=len(flat))
    return {"shape": list(numbers.shape), "runs": np.column_stack([flat[first], counts]).ravel().tolist()}


def _from_runs(told: dict[str, list[int]]) -> NDArray[np.int64]:
    first, counts = np.array(told["runs"], dtype=np.int64).reshape(-1, 2).T
    begin = np.cumsum(counts) - counts
    within = np.arange(int(counts.sum())) - np.repeat(begin, counts)
    return np.asarray(np.repeat(first, counts) + within).reshape(told["shape"])


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
