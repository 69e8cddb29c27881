"""Load cases in the case file: the same gear in several currents and seas, one [[load_case]] each."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from .current import Current
from .errors import Problem
from .fields import Factor, Name, Table
from .places import Path
from .waves import WavesSpec, wave_findings
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts

CHOSEN, CASES = "chosen_load_case", "load_case"
# Tables of the file that a load case may put its own in place of.
OWN = ("current", "waves")
_NOT_IN_FOLDERS = re.compile(r"[^\w-]+")


class LoadCaseSpec(Table):
    """One load case: its own current and waves in place of those of the file."""

    given_name: Name | None = Field(
        default=None,
        alias="name",
        description="name, its number in the file by default",
        examples=["50 years"],
    )
    current: Current | None = Field(
        default=None, description="the current, with the keys of [current]; that of the file by default"
    )
    waves: WavesSpec | None = Field(
        default=None, description="the waves, with the keys of [waves]; those of the file by default"
    )
    load_factor: Annotated[Factor, Field(examples=[1.3])] = Field(
        default=1.0, description="factor on loads, in the utilisation of breaking strengths alone"
    )
    material_factor: Annotated[Factor, Field(examples=[1.5])] = Field(
        default=1.0, description="factor that strengths are divided by, in the utilisation alone"
    )


def called(raw: dict[str, Any], number: int) -> str:
    """Name of a load case as it stands in the file; number: its place, from 1."""
    name = raw.get("name")
    return name if isinstance(name, str) and name else str(number)


def folder_of(name: str) -> str:
    """Name of the folder of a load case: letters, digits, "-" and "_" alone."""
    return _NOT_IN_FOLDERS.sub("_", name)


def tables(raw: dict[str, Any]) -> list[tuple[int, dict[str, Any]]]:
    """Load cases as they were written, valid or not, by their place in the file."""
    cases = raw.get(CASES)
    return [
        (i, one) for i, one in enumerate(cases if isinstance(cases, list) else []) if isinstance(one, dict)
    ]


def chosen(raw: dict[str, Any]) -> dict[str, Any]:
    """Return the file with the tables of the load case that it chooses in place of its own, and no load cases.

    A file that chooses none, or one that is not there, comes back as it is.
    """
    for i, one in tables(raw):
        if raw.get(CHOSEN) == called(one, i + 1):
            rest = {key: value for key, value in raw.items() if key not in (CHOSEN, CASES)}
            rest |= {key: one[key] for key in OWN if key in one}
            title = raw.get("title", "")
            return rest | ({"title": f"{title}: {raw[CHOSEN]}"} if isinstance(title, str) and title else {})
    return raw


def choosing(text: str, name: str) -> str:
    """Return the text of a case file that chooses a load case of it."""
    return f'{CHOSEN} = "{name}"\n' + text.removeprefix("\ufeff")


def load_case_findings(parts: Parts, depth: float | None, gravity: float | None) -> Iterator[Finding]:
    """What is wrong between the keys of load cases, and between them and the rest of the file.

    depth: m, None for deep water; gravity: m/s2, None where the file says none that is good.
    """
    from .water_check import current_findings

    names: dict[str, int] = {}
    for i, one in tables(parts.raw):
        name = called(one, i + 1)
        first = names.setdefault(folder_of(name).casefold(), i)
        if first != i:
            found = (
                f"{written(name)}, and load case {first + 1} has this name or one that makes the same folder"
            )
            yield (
                (CASES, i, "name"),
                found,
                "a name of its own for every load case",
                f'write name = "{name}-{i + 1}"',
            )
        own = replace(parts, raw={**parts.raw, **{key: one[key] for key in OWN if key in one}})
        if "current" in one:
            yield from _within(i, current_findings(own))
        if "waves" in one and gravity is not None:
            yield from _within(i, wave_findings(one["waves"], depth, gravity))
    choice = parts.raw.get(CHOSEN)
    if choice is not None and chosen(parts.raw) is parts.raw:
        there = [written(called(one, i + 1)) for i, one in tables(parts.raw)]
        allowed = "the name of a load case: " + ", ".join(there) if there else "a file with [[load_case]]"
        yield (CHOSEN,), written(choice), allowed, f"leave {CHOSEN} out to run them all"


def load_case_file_problems(parts: Parts) -> Iterator[tuple[Path, Problem]]:
    """Every fault of the files that load cases take their currents from."""
    from .water_check import current_file_problems

    for i, one in tables(parts.raw):
        if isinstance(one.get("current"), dict):
            own = replace(parts, raw={**parts.raw, "current": one["current"]})
            for number, problem in enumerate(current_file_problems(own)):
                yield (CASES, i, "current", "file", number), problem


def _within(number: int, findings: Iterator[Finding]) -> Iterator[Finding]:
    """Findings of tables of the file as those of the load case that has them instead."""
    for path, *words in findings:
        at = (CASES, number, *path) if path[0] in OWN else path
        found, allowed, cure = words
        yield at, found, allowed, cure
