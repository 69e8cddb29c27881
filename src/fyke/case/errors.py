"""What is wrong with a case: where, what was found, what is allowed, and the nearest cure."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

_WIDTH = 80


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong, in words.

    where: file, line, table and key; found: as written; allowed: with units; cure: what to write instead.
    """

    where: str
    found: str
    allowed: str
    cure: str

    def __str__(self) -> str:
        rows = (("found", self.found), ("allowed", self.allowed), ("cure", self.cure))
        lines = textwrap.wrap(self.where, _WIDTH)
        for label, words in rows:
            lines += textwrap.wrap(
                words, _WIDTH, initial_indent=f"  {label:<9}", subsequent_indent=" " * 11
            ) or [f"  {label}"]
        return "\n".join(lines)


class CaseError(ValueError):
    """A case that cannot be used; problems: all that was found wrong, in the order of the file."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__(self.problems)

    def __str__(self) -> str:
        return "\n\n".join(str(problem) for problem in self.problems)
