"""Places in a case file: which line a key stands on, and how to name it to the reader."""

from __future__ import annotations

import re
from collections.abc import Iterator

Path = tuple[str | int, ...]

_KEY = r"""(?:[A-Za-z0-9_-]+|"[^"\n]*"|'[^'\n]*')"""
_DOTTED = rf"{_KEY}(?:\s*\.\s*{_KEY})*"
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_DOTTED})\s*\]\]?\s*(?:#.*)?")
_ASSIGNMENT = re.compile(rf"\s*({_DOTTED})\s*=(.*)")
_STRING_OR_COMMENT = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'|#.*')
_TRIPLE = re.compile("\"\"\"|'''")
_LISTED = ("gear", "motion", "load_case")  # tables whose second step is a number
_NAMED = (
    "material",
    "twine",
    "chain",
    "tube",
    "netting",
    *_LISTED,
)  # those whose second step is that or a name


class Places:
    """The keys of one valid TOML text by line; name: what to call the text."""

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self._lines: dict[Path, int] = {}
        for path, line in _keys(text):
            self._lines.setdefault(path, line)

    def line(self, path: Path) -> int:
        """Line of a key, or of the nearest table around it; 0 when none is known."""
        for length in range(len(path), 0, -1):
            if path[:length] in self._lines:
                return self._lines[path[:length]]
        return 0

    def at(self, path: Path) -> str:
        """Name a key: "panel.toml, line 21, [netting.main] bar_length"."""
        line = self.line(path)
        words = [self.name] + [f"line {line}"] * bool(line) + [key_name(path)] * bool(path)
        return ", ".join(words)


def key_name(path: Path) -> str:
    """Name a key without its file: "[netting.main] bar_length", "[[gear]] 1, meshes, value 2"."""
    if len(path) == 1:
        return str(path[0])
    depth = 2 if path[0] in _NAMED else 1
    if path[0] in _LISTED:
        table = f"[[{path[0]}]] {int(path[1]) + 1}"
    else:
        table = "[" + ".".join(str(step) for step in path[:depth]) + "]"
    keys = ".".join(step for step in path[depth:] if isinstance(step, str))
    values = [f"value {step + 1}" for step in path[depth:] if isinstance(step, int)]
    return ", ".join([f"{table} {keys}".rstrip(), *values])


def _steps(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip("\"'") for part in re.findall(_KEY, dotted))


def _keys(text: str) -> Iterator[tuple[Path, int]]:
    table: Path = ()
    counts: dict[Path, int] = {}
    depth, in_text = 0, False
    for number, line in enumerate(text.split("\n"), 1):
        outside = depth == 0 and not in_text
        header = _HEADER.fullmatch(line.rstrip()) if outside else None
        if header:
            table = _steps(header[2])
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                table = (*table, counts[table])
            elif table[:1] in counts:
                table = (*table[:1], counts[table[:1]], *table[1:])
            yield table, number
            continue
        assignment = _ASSIGNMENT.fullmatch(line) if outside else None
        if assignment:
            yield (*table, *_steps(assignment[1])), number
        in_text ^= len(_TRIPLE.findall(line)) % 2 == 1
        bare = _STRING_OR_COMMENT.sub("", assignment[2] if assignment else line)
        depth = max(0, depth + sum(bare.count(c) for c in "[{") - sum(bare.count(c) for c in "]}"))
