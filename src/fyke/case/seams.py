"""Seams in the case file: edges of netting joined knot by knot."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from .fields import Factor
from .gear import Part
from .quantity import wrong

_PAIR = re.compile(r"\s*(\d{1,6})\s*:\s*(\d{1,6})\s*")


def _as_ratio(value: Any) -> Any:
    """Take "3:2" for 1.5."""
    match = _PAIR.fullmatch(value) if isinstance(value, str) else None
    if match and int(match[2]):
        return int(match[1]) / int(match[2])
    if isinstance(value, str):
        raise wrong(
            "meshes of the first edge over those of the second, 1.5 or 3:2", 'write take_up = 1.5, or "3:2"'
        )
    return value


_SCHEMA = WithJsonSchema(
    {
        "anyOf": [
            {"type": "number", "exclusiveMinimum": 0.0, "maximum": 100.0},
            {"type": "string", "pattern": r"^\s*\d{1,6}\s*:\s*\d{1,6}\s*$"},
            {"type": "null"},
        ]
    }
)


class SeamSpec(Part):
    """A seam: two edges of netting joined knot by knot."""

    kind: Literal["seam"] = Field(description="kind of gear", examples=["seam"])
    join: tuple[str, str] = Field(
        description="the two edges, each NAME.EDGE of gear that is netting; where they lie apart, knots go to the "
        "place of the first, or of the one with fewer meshes",
        examples=[["wing.left", "square.right"]],
    )
    take_up: Annotated[Factor | None, BeforeValidator(_as_ratio), _SCHEMA] = Field(
        default=None,
        description="meshes of the first edge over those of the second, taken up evenly; equal counts without it",
        examples=[1.5],
    )
