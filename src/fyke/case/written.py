"""Values as they would stand in a TOML file, for messages."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_LONGEST = 60
_MOST_ITEMS = 9


def written(value: Any) -> str:
    """Return a value as it would stand in the file, cut short."""
    words = _whole(value)
    return words if len(words) <= _LONGEST else words[: _LONGEST - 4] + " ..."


def assignment(key: str, value: Any) -> str:
    """Return "key = value"."""
    return f"{key} = {written(value)}"


def _whole(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + "".join(c if c.isprintable() else ascii(c)[1:-1] for c in value) + '"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_whole(inner) for inner in value[:_MOST_ITEMS]) + "]"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{k} = {_whole(v)}" for k, v in list(value.items())[:_MOST_ITEMS]) + " }"
    if isinstance(value, int) and abs(value) >= 10**_LONGEST:
        return "a number of more than 60 digits"
    return str(value)
