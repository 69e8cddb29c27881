"""Turns what pydantic found wrong into problems in plain words."""

from __future__ import annotations

from collections.abc import Callable

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from .errors import Problem
from .keys import Spot, cure_for_missing, cure_for_unknown, fields_of, follow, nearest
from .places import Path, Places
from .quantity import WRONG
from .written import assignment, written

_FEW = 6  # words that are worth telling twice

# Tables of which there may be several, and what each is.
LISTED = {"gear": "panel", "load_case": "load case", "motion": "motion"}

Words = tuple[str, str, str]  # found, allowed, cure


def explain(error: ValidationError, places: Places) -> tuple[dict[Path, Problem], set[Path]]:
    """Return the problems by path, and the keys that misspelled ones were most likely meant to be."""
    details = [(detail, follow(detail["loc"])) for detail in error.errors(include_url=False)]
    meant = {
        (*spot.path[:-1], nearest(spot.key, fields_of(spot.table)))
        for detail, spot in details
        if detail["type"] == "extra_forbidden"
    }
    problems = {}
    for detail, spot in details:
        kind = detail["type"]
        misspelled = kind == "missing" and spot.path in meant
        if not misspelled and not _follows_from_another(detail):
            path = (*spot.path, _tag(detail)) if kind == "union_tag_invalid" else spot.path
            problems[path] = Problem(places.at(path), *_WORDS.get(kind, _other)(detail, spot))
    return problems, meant


def _follows_from_another(detail: ErrorDetails) -> bool:
    """Whether a table or list counts as too short only because its items were refused."""
    return detail["type"] == "too_short" and len(detail["input"]) >= detail["ctx"]["min_length"]


def _wrong(detail: ErrorDetails, spot: Spot) -> Words:
    return written(detail["input"]), detail["ctx"]["allowed"], detail["ctx"]["cure"]


def _unknown(detail: ErrorDetails, spot: Spot) -> Words:
    found = f"unknown key: {assignment(spot.key, detail['input'])}"
    return found, "the keys " + ", ".join(fields_of(spot.table)), cure_for_unknown(spot.key, spot.table)


def _missing(detail: ErrorDetails, spot: Spot) -> Words:
    if spot.field is None or isinstance(spot.path[-1], int):
        return _list(detail, spot)
    return "nothing", f"{spot.key}, {spot.meaning}", cure_for_missing(spot.key, spot.field)


def _choice(detail: ErrorDetails, spot: Spot) -> Words:
    return _one_of(detail["input"], spot.choices)


def _kind(detail: ErrorDetails, spot: Spot) -> Words:
    table, tag = detail["input"], _tag(detail)
    if tag not in table:
        return written(table), _alternatives(spot.choices), f'say which {tag}: {tag} = "{spot.choices[0]}"'
    return _one_of(table[tag], spot.choices)


def _tag(detail: ErrorDetails) -> str:
    """Return the key by which several tables are told apart."""
    return str(detail["ctx"]["discriminator"]).strip("'")


def _one_of(value: object, choices: list[str]) -> Words:
    near = nearest(value, choices) if isinstance(value, str) else ""
    few = _alternatives(choices) if len(choices) <= _FEW else "one of these"
    cure = f'did you mean "{near}"?' if near else f"choose {few}"
    return written(value), _alternatives(choices), cure


def _alternatives(choices: list[str]) -> str:
    return " or ".join(f'"{choice}"' for choice in choices)


def _table(detail: ErrorDetails, spot: Spot) -> Words:
    dotted = ".".join(str(step) for step in spot.path)
    name = f"[[{spot.path[0]}]]" if spot.path[0] in LISTED else f"[{dotted}]"
    return (
        written(detail["input"]),
        f"a table: {spot.meaning}",
        f"write {name} and its keys on lines of their own",
    )


def _list(detail: ErrorDetails, spot: Spot) -> Words:
    value = detail["input"]
    if spot.path[0] in LISTED and len(spot.path) == 1:
        name, what = f"[[{spot.path[0]}]]", LISTED[str(spot.path[0])]
        return written(value), f"one table {name} for every {what}", f"write {name}, with double brackets"
    samples = spot.field.examples if spot.field else None
    name = next((str(step) for step in reversed(spot.path) if isinstance(step, str)), "")
    cure = f"write for example {assignment(name, samples[0])}" if samples else "give all values in one list"
    return written(value), f"a list: {spot.meaning}", cure


def _text(detail: ErrorDetails, spot: Spot) -> Words:
    value = written(detail["input"])
    return value, f"a text: {spot.meaning}", f'put quotes round it: "{value}"'


def _other(detail: ErrorDetails, spot: Spot) -> Words:
    return written(detail["input"]), spot.meaning, detail["msg"]


_WORDS: dict[str, Callable[[ErrorDetails, Spot], Words]] = {
    WRONG: _wrong,
    "extra_forbidden": _unknown,
    "missing": _missing,
    "literal_error": _choice,
    "union_tag_invalid": _kind,
    "union_tag_not_found": _kind,
    "dict_type": _table,
    "model_type": _table,
    "model_attributes_type": _table,
    "tuple_type": _list,
    "too_long": _list,
    "too_short": _list,
    "string_type": _text,
}
