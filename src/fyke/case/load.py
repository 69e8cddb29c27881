"""Reads a case file and makes it safe: either a whole Case or everything that is wrong with it."""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path as FilePath
from typing import Any

from pydantic import ValidationError

from .check import Parts, file_problems, findings
from .errors import CaseError, Problem
from .explain import explain
from .load_case import LoadCaseSpec, choosing, chosen
from .oddities import warnings
from .places import Path, Places
from .schema import Case
from .sewing import sewing_findings
from .written import written

_WHERE_IN_TOML = re.compile(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", re.DOTALL)
_CURES = (
    ("Expected newline or end of document", 'put a value with a unit in quotes, such as "30 mm"'),
    ("Expected '='", "write key = value"),
    ("Invalid value", 'put texts and values with a unit in quotes, such as "30 mm"'),
    ("Cannot overwrite", "this key or table is there already; leave out one of the two"),
    ("Cannot declare", "this table is there already; leave out one of the two"),
    ("Unclosed array", "close the list with ]"),
    ("Unterminated string", "close the text with a quote"),
    ("Illegal character", "texts in quotes end on the line they start on"),
    ("Expected ']", "close the table's name with ]"),
)


def load_case(path: str | os.PathLike[str]) -> Case:
    """Read and check a case file.

    Raises CaseError with every problem found: a file that cannot be read, broken TOML, wrong keys, units and
    values, and what does not fit together.
    """
    file = FilePath(path)
    try:
        text = file.read_bytes().decode()
    except UnicodeDecodeError as error:
        found = f"byte {error.object[error.start]:#04x} at position {error.start}"
        raise CaseError([Problem(str(file), found, "text in UTF-8", "save the file as UTF-8")]) from None
    except (OSError, ValueError) as error:
        raise CaseError([_unreadable(file, error)]) from None
    return parse_case(text, str(file), path=file)


def parse_case(text: str, where: str = "case", *, path: FilePath | None = None) -> Case:
    """Check the text of a case; where: what to call it in messages; path: the file it came from.

    Raises CaseError with every problem found.
    """
    raw = chosen(_toml(text, where))
    places = Places(where, text)
    problems: dict[Path, Problem] = {}
    meant: set[Path] = set()
    case = None
    context: dict[str, Any] = {"text": text, "path": path}
    try:
        case = Case.model_validate(raw, context=context)
    except ValidationError as error:
        problems, meant = explain(error, places)
    parts = Parts.of(raw, path.parent if path else FilePath())
    for key, *words in findings(parts):
        if key not in meant:
            problems.setdefault(key, Problem(places.at(key), *words))
    problems |= file_problems(parts)
    if case is not None and not problems:
        problems |= {key: Problem(places.at(key), *words) for key, *words in sewing_findings(case)}
    if problems or case is None:
        raise CaseError([problems[key] for key in sorted(problems, key=places.line)])
    return Case.model_validate(raw, context={**context, "warnings": warnings(case)})


def recorded_case(text: str) -> Case:
    """Take up the case that a result carries: it was good when it ran, but files that it names may be gone.

    Raises CaseError for a text that this version of fyke does not take.
    """
    context: dict[str, Any] = {"text": text}
    raw = chosen(_toml(text, "case of the result"))
    try:
        case = Case.model_validate(raw, context=context)
    except ValidationError as error:
        problems, _ = explain(error, Places("case of the result", text))
        raise CaseError(list(problems.values())) from None
    return Case.model_validate(raw, context={**context, "warnings": warnings(case)})


def load_cases_of(case: Case) -> tuple[tuple[LoadCaseSpec, str, Case], ...]:
    """Return the load cases of a case file: what the file says of each, its name, and the case that it makes.

    Raises CaseError where a file that one names is gone.
    """
    where = str(case.path or "case")
    named = [(spec, spec.given_name or str(number)) for number, spec in enumerate(case.load_case, 1)]
    return tuple(
        (spec, name, parse_case(choosing(case.text, name), where, path=case.path)) for spec, name in named
    )


def _unreadable(file: FilePath, error: OSError | ValueError) -> Problem:
    found = "a folder" if file.is_dir() else getattr(error, "strerror", None) or str(error)
    cure = "check the name and the folder"
    near = [] if file.is_dir() or file.exists() else sorted(file.parent.glob("*.toml"))
    if near:
        cure += "; there is " + ", ".join(one.name for one in near[:5])
    elif file.is_dir():
        cure = "name a case file in this folder"
    elif isinstance(error, PermissionError):
        cure = "give yourself the right to read it"
    return Problem(str(file), found, "a case file (TOML) that can be read", cure)


def _toml(text: str, where: str) -> dict[str, Any]:
    allowed = "TOML: tables [name], keys and values, texts in quotes"
    try:
        text.encode()
        return tomllib.loads(text.removeprefix("\ufeff"))
    except UnicodeEncodeError as error:
        found = f"a half character (surrogate) at position {error.start}"
        problem = Problem(where, found, "text that UTF-8 can hold", "leave this character out")
    except RecursionError:
        problem = Problem(where, "lists or tables nested too deeply", allowed, "close the open brackets")
    except ValueError as error:
        problem = _broken(str(error), text, where, allowed)
    raise CaseError([problem])


def _broken(message: str, text: str, where: str, allowed: str) -> Problem:
    match = _WHERE_IN_TOML.fullmatch(message)
    if match is None:
        return Problem(where, message, allowed, "shorten the value")
    lines = text.removeprefix("\ufeff").replace("\r\n", "\n").split("\n")
    line, column = int(match[2] or len(lines)), int(match[3] or len(lines[-1]) + 1)
    cure = next((cure for start, cure in _CURES if match[1].startswith(start)), "correct this line")
    found = f"{match[1]}: {written(lines[line - 1].strip())[1:-1]}"
    return Problem(f"{where}, line {line}, column {column}", found, allowed, cure)
