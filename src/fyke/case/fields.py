"""Fields of the case file: the values that its tables are made of, with their ranges."""

from __future__ import annotations

import re
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, PlainValidator, WithJsonSchema

from .quantity import Quantity, wrong
from .units import ANGLE, DENSITY, FORCE, LENGTH, MASS, PRESSURE, RATIO, SPEED, TIME

# The ranges are wide: they catch a wrong unit or a slip of the pen, not an unusual net.
Length = Annotated[float, Quantity(LENGTH, 0.0, 1e4, open_below=True)]
Depth = Annotated[float, Quantity(LENGTH, 0.0, 1e4)]
Place = Annotated[float, Quantity(LENGTH, -1e6, 1e6)]
Speed = Annotated[float, Quantity(SPEED, -100.0, 100.0)]
Density = Annotated[float, Quantity(DENSITY, 0.0, 1e5, open_below=True)]
Modulus = Annotated[float, Quantity(PRESSURE, 0.0, 1e13, open_below=True)]
Force = Annotated[float, Quantity(FORCE, 0.0, 1e9, open_below=True)]
Mass = Annotated[float, Quantity(MASS, 0.0, 1e9, open_below=True)]
Time = Annotated[float, Quantity(TIME, 0.0, 1e7, open_below=True)]
# A bare number would be radians, and people mean degrees.
Angle = Annotated[float, Quantity(ANGLE, -10.0, 10.0, unit_needed=True)]
Coefficient = Annotated[float, Quantity(None, 0.0, 100.0)]
Factor = Annotated[float, Quantity(None, 0.0, 100.0, open_below=True)]
Share = Annotated[float, Quantity(None, 0.0, 1.0, open_below=True)]
Tolerance = Annotated[float, Quantity(None, 0.0, 0.1, open_below=True)]
Component = Annotated[float, Quantity(None, -1e6, 1e6)]

_HANGING = Quantity(RATIO, 0.0, 2.0, open_below=True)
_BELOW_ONE = (
    "a number E1 above 0 and below 1 for diamond mesh, or [E1, E2], each above 0 and at most 2; or in %"
)
_MOST_MESHES = 20_000
_NAME = re.compile(r"[\w .-]{0,60}")


def _read_name(text: str) -> str:
    if not _NAME.fullmatch(text):
        raise wrong("at most 60 letters, digits, spaces, '.', '-' and '_'", "choose a plainer name")
    return text


def _read_count(value: Any) -> int:
    allowed = f"a whole number from 1 to {_MOST_MESHES}"
    if isinstance(value, bool) or not isinstance(value, int):
        whole = isinstance(value, float) and value.is_integer() and 1 <= value <= _MOST_MESHES
        raise wrong(
            allowed, f"write {value:.0f}, without the point" if whole else "give a whole number of meshes"
        )
    if not 1 <= value <= _MOST_MESHES:
        raise wrong(
            allowed, "give at least one mesh" if value < 1 else "split the netting into several panels"
        )
    return value


def _read_title(text: str) -> str:
    if not text.isprintable():
        raise wrong("one line of text", "leave out line breaks and control characters")
    return text


def _read_hanging(value: Any) -> float | tuple[float, float]:
    if isinstance(value, list | tuple):
        if len(value) != 2:
            raise wrong(_BELOW_ONE, "give two ratios, of the width and of the height")
        return (_HANGING.read(value[0]), _HANGING.read(value[1]))
    ratio = _HANGING.read(value)
    if ratio >= 1.0:
        raise wrong(_BELOW_ONE, "hang it at less than the stretched width, 0.5 is common")
    return ratio


def _read_normal(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if max(map(abs, vector)) < 1e-9:
        raise wrong(
            "three numbers that are not all zero", "for a panel across the x axis write [1.0, 0.0, 0.0]"
        )
    return vector


def _read_switch(value: Any) -> bool:
    if not isinstance(value, bool):
        raise wrong("true or false", "write true or false, without quotes")
    return value


def whole(least: int, most: int) -> tuple[PlainValidator, WithJsonSchema]:
    """Return the marks of a field that is a whole number in a range."""
    allowed = f"a whole number from {least} to {most}"

    def read(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            as_whole = isinstance(value, float) and value.is_integer() and least <= value <= most
            raise wrong(
                allowed, f"write {value:.0f}, without the point" if as_whole else "give a whole number"
            )
        if not least <= value <= most:
            raise wrong(allowed, f"give {least} or more" if value < least else f"give {most} or less")
        return value

    schema = {"type": "integer", "minimum": least, "maximum": most}
    return PlainValidator(read), WithJsonSchema(schema)


Name = Annotated[str, AfterValidator(_read_name)]
Title = Annotated[str, AfterValidator(_read_title)]
MeshCount = Annotated[
    int,
    PlainValidator(_read_count),
    WithJsonSchema({"type": "integer", "minimum": 1, "maximum": _MOST_MESHES}),
]
Switch = Annotated[bool, PlainValidator(_read_switch), WithJsonSchema({"type": "boolean"})]
Velocity = tuple[Speed, Speed, Speed]
Point = tuple[Place, Place, Place]
Direction = Annotated[tuple[Component, Component, Component], AfterValidator(_read_normal)]
_RATIO_SCHEMA = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": r"^\s*[0-9.]+\s*%\s*$"}]}
HangingRatio = Annotated[
    float | tuple[float, float],
    PlainValidator(_read_hanging),
    WithJsonSchema(
        {
            "anyOf": [
                *_RATIO_SCHEMA["anyOf"],
                {"type": "array", "items": _RATIO_SCHEMA, "minItems": 2, "maxItems": 2},
            ]
        }
    ),
]


class Table(BaseModel):
    """One table of the file: frozen, and no key but the known ones."""

    model_config = ConfigDict(frozen=True, extra="forbid")
