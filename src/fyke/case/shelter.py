"""[shelter] of the case file: what netting does to the current behind it and between its own twines."""

from __future__ import annotations

import difflib
from typing import Annotated, Any

from pydantic import Field, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from ..water.wakes import TWINES, WAKES, GivenWake, TwineLaw, WakeLaw
from .fields import Table
from .quantity import Quantity, wrong
from .units import RATIO

OFF = "off"
_FACTOR = Quantity(RATIO, 0.0, 1.0)
_WAKE_WORDS = (OFF, *(name for name in WAKES if name != GivenWake.name))
_TWINE_WORDS = (OFF, *TWINES)


def _listed(words: tuple[str, ...]) -> str:
    return " or ".join(f'"{word}"' for word in words)


def _read_word(value: str, words: tuple[str, ...], allowed: str) -> str:
    if value in words:
        return value
    near = difflib.get_close_matches(value.lower(), words, n=1)
    raise wrong(allowed, f'did you mean "{near[0]}"?' if near else f"choose {_listed(words)}")


def _read_wake(value: Any) -> str | float:
    allowed = f"{_listed(_WAKE_WORDS)}, or the factor that is left of the current, from 0 to 1"
    if isinstance(value, str) and value.strip()[:1].isalpha():
        return _read_word(value, _WAKE_WORDS, allowed)
    if isinstance(value, bool):
        raise wrong(allowed, f"choose {_listed(_WAKE_WORDS[1:])}" if value else f'write "{OFF}"')
    try:
        return _FACTOR.read(value)
    except PydanticCustomError as error:
        raise wrong(allowed, str((error.context or {})["cure"])) from None


def _read_twines(value: Any) -> str:
    allowed = _listed(_TWINE_WORDS)
    if isinstance(value, str):
        return _read_word(value, _TWINE_WORDS, allowed)
    raise wrong(allowed, f"choose {allowed}, in quotes")


Wake = Annotated[
    str | float,
    PlainValidator(_read_wake),
    WithJsonSchema(
        {
            "anyOf": [
                {"enum": list(_WAKE_WORDS)},
                {"type": "number", "minimum": 0.0, "maximum": 1.0},
                {"type": "string", "pattern": r"^\s*[0-9.]+\s*%\s*$"},
            ]
        }
    ),
]
Twines = Annotated[str, PlainValidator(_read_twines), WithJsonSchema({"enum": list(_TWINE_WORDS)})]


class ShelterSpec(Table):
    """What netting leaves of the current; both are off unless asked for."""

    wake: Wake = Field(
        default=OFF,
        description="behind netting: a law, or the factor left of the current",
        examples=["loland"],
    )
    twines: Twines = Field(default=OFF, description="between the twines of a panel", examples=["cheng"])

    def wake_law(self) -> WakeLaw | None:
        """Return the law of the wakes, None when off."""
        if isinstance(self.wake, float):
            return GivenWake(self.wake)
        return None if self.wake == OFF else WAKES[self.wake]()

    def twine_law(self) -> TwineLaw | None:
        """Return the law of shelter between twines, None when off."""
        return None if self.twines == OFF else TWINES[self.twines]()
