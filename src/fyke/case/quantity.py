"""Quantity: what one number of the case file may be, as a mark on a pydantic field."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import PydanticCustomError, core_schema

from .units import Kind, UnitError, read_text

WRONG = "wrong_quantity"  # the type of the errors made here; their context holds "allowed" and "cure"


def wrong(allowed: str, cure: str) -> PydanticCustomError:
    """Return an error for a field, with what is allowed there and the nearest cure."""
    return PydanticCustomError(WRONG, "{allowed}", {"allowed": allowed, "cure": cure})


@dataclass(frozen=True)
class Quantity:
    """A number in SI, or a text with a number and a unit when kind has units, within a range.

    kind: None for a number without a unit; least and most: the range in SI; open_below: least is not allowed;
    unit_needed: a bare number is refused, where people would take it for one in another unit.
    """

    kind: Kind | None
    least: float
    most: float
    open_below: bool = False
    unit_needed: bool = False

    @property
    def allowed(self) -> str:
        """Say what is allowed, in words with units."""
        si = f" {self.kind.si}" if self.kind and self.kind.si else ""
        if self.open_below:
            span = f"above {self.least:g} and at most {self.most:g}{si}"
        else:
            span = f"from {self.least:g} to {self.most:g}{si}"
        if self.kind is None:
            return f"a number {span}"
        article = "an" if self.kind.name[0] in "aeiou" else "a"
        form = "a text" if self.unit_needed else "a number, or a text"
        return f"{article} {self.kind.name} {span}: {form} with one of {', '.join(self.kind.units)}"

    def read(self, value: Any) -> float:
        """Return the value in SI; raise a PydanticCustomError where it is not allowed."""
        number = self._number(value)
        if math.isnan(number):
            raise wrong(self.allowed, "give a number; nan means 'not a number'")
        too_low = number <= self.least if self.open_below else number < self.least
        if too_low or number > self.most:
            raise wrong(self.allowed, self._cure_for_range(number))
        return number

    def _number(self, value: Any) -> float:
        if isinstance(value, str) and self.kind is not None:
            try:
                return read_text(value, self.kind)
            except UnitError as error:
                raise wrong(self.allowed, error.cure) from None
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise wrong(self.allowed, self._cure_for_type(value))
        if self.unit_needed and self.kind is not None:
            raise wrong(self.allowed, f"say in which unit, in quotes: {_with_each_unit(value, self.kind)}")
        try:
            return float(value)
        except OverflowError:
            return math.inf

    def _cure_for_type(self, value: Any) -> str:
        if isinstance(value, bool):
            return "write a number; true and false are for switches"
        if isinstance(value, str):
            return "write a plain number, without quotes; this one has no unit"
        if isinstance(value, list):
            return "write one number, without brackets"
        return f'write a number or a text such as "{self.kind.example}"' if self.kind else "write a number"

    def _cure_for_range(self, number: float) -> str:
        if math.isinf(number):
            return "give a finite number"
        if number < 0 <= self.least:
            return (
                "leave out the minus sign" if self.least <= -number <= self.most else "give a positive number"
            )
        if number == 0:
            return "give a value above 0"
        si = self.kind.si if self.kind else ""
        return (
            f"this reads as {number:g} {si}".rstrip()
            + "; check the unit" * bool(si)
            + "; check the number" * (not si)
        )

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Validate with read()."""
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe a number in its range or, with a unit, a text."""
        low = "exclusiveMinimum" if self.open_below else "minimum"
        number = {"type": "number", low: self.least, "maximum": self.most}
        if self.kind is None:
            return number
        units = "|".join(sorted(unit.replace("/", "\\/") for unit in self.kind.units))
        text = {"type": "string", "pattern": rf"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*({units})\s*$"}
        return text if self.unit_needed else {"anyOf": [number, text]}


def _with_each_unit(value: float, kind: Kind) -> str:
    """Write a number with every unit that it may have been meant in."""
    shown = f"{value:g}" if abs(value) < 1e300 else "15"
    return " or ".join(f'"{shown} {unit}"' for unit in kind.units)
