"""A case with some of its values changed, as a study of many cases does."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from typing import Any

from .errors import CaseError, Problem
from .keys import nearest
from .load import checked
from .schema import Case

Value = float | str


def varied(case: Case, changes: Mapping[str, Value], *, where: str = "case") -> Case:
    """Return the case with other values at some keys, checked like any case.

    changes: by dotted key, tables of a list by their number from 1 or their name, values of a list by their number
    from 1: "twine.main.youngs_modulus", "gear.1.size.2", "gear.cage.top.3". A key that the file leaves out may be
    given. Raises CaseError for a key that leads nowhere and for values that the case file does not allow.
    """
    raw = tomllib.loads(case.text.removeprefix("\ufeff"))
    for key, value in changes.items():
        table, last = _around(raw, key, where)
        table[last] = value
    told = "".join(f"\n# with {key} = {value!r}" for key, value in changes.items())
    return checked(raw, case.text + told + "\n", where, path=case.path)


def value_at(case: Case, key: str, *, where: str = "case") -> Any:
    """Return the value that the file has at a key, None where it leaves it out; CaseError as of `varied`."""
    table, last = _around(tomllib.loads(case.text.removeprefix("\ufeff")), key, where)
    return table.get(last) if isinstance(table, dict) else table[last]


def _around(raw: dict[str, Any], key: str, where: str) -> tuple[Any, Any]:
    """Return the table or list around a key, and the key or place in it."""
    steps = _steps(raw, key)
    inner: Any = raw
    for number, step in enumerate(steps):
        place = _place(inner, step)
        last = number == len(steps) - 1
        if place is None or (not last and isinstance(inner, dict) and place not in inner):
            raise CaseError([_nowhere(inner, key, step, where)])
        if last:
            return inner, place
        inner = inner[place]
    raise CaseError([_nowhere(raw, key, key, where)])


def _steps(raw: dict[str, Any], key: str) -> list[str]:
    """Steps of a key; names of twines and the like may hold points, so that the longest known name counts."""
    steps, left = [], key.split(".")
    inner: Any = raw
    while left:
        taken = next(
            (n for n in range(len(left), 1, -1) if isinstance(inner, dict) and ".".join(left[:n]) in inner), 1
        )
        steps.append(".".join(left[:taken]))
        left = left[taken:]
        place = _place(inner, steps[-1])
        known = place is not None and (isinstance(inner, list) or place in inner)
        inner = inner[place] if known else {}
    return steps


def _place(inner: Any, step: str) -> str | int | None:
    """Return where a step leads in a table or list, None where it cannot lead."""
    if isinstance(inner, dict):
        return step
    if not isinstance(inner, list):
        return None
    if step.isdecimal():
        return int(step) - 1 if 1 <= int(step) <= len(inner) else None
    named = [n for n, one in enumerate(inner) if isinstance(one, dict) and one.get("name") == step]
    return named[0] if named else None


def _nowhere(inner: Any, key: str, step: str, where: str) -> Problem:
    if isinstance(inner, dict):
        there = list(inner)
    elif isinstance(inner, list):
        there = [str(number) for number in range(1, len(inner) + 1)]
        there += [one["name"] for one in inner if isinstance(one, dict) and "name" in one]
    else:
        there = []
    near = nearest(step, there)
    cure = f"did you mean '{near}'?" if near else "name a key of the case file, as in twine.main.diameter"
    allowed = f"{', '.join(there)}" if there else "a key that ends here"
    return Problem(f"{where}, {key}", f"no '{step}'", allowed, cure)
