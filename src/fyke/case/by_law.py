"""Values of the case file that are a law: a table told apart by its key `law`, the word alone, or a plain number."""

from __future__ import annotations

import functools
import operator
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, ValidatorFunctionWrapHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import PydanticCustomError, core_schema

from .fields import Table
from .quantity import Quantity, wrong


class LawTable(Table):
    """A law and its parameters."""

    law: str

    def parameters(self) -> dict[str, Any]:
        """Return the parameters that are given or have a default, by their keys."""
        given = {key: getattr(self, key) for key in type(self).model_fields if key != "law"}
        return {key: value for key, value in given.items() if value is not None}


def by_law(models: Mapping[str, type[LawTable]], alone: Iterable[str], number: Quantity | None = None) -> Any:
    """Return the type of a field that takes one of several tables, told apart by their word, or a number.

    alone: the words that say all there is to say, so that the word may stand for the table.
    """
    union = functools.reduce(operator.or_, models.values())
    return Annotated[union, _Short(tuple(alone), number)]


@dataclass(frozen=True)
class _Short:
    """A mark: a word stands for the table of this law; words: those that say all; number: the other value."""

    words: tuple[str, ...]
    number: Quantity | None

    def read(self, value: Any, tables: ValidatorFunctionWrapHandler) -> Any:
        """Return the table, or the number."""
        if isinstance(value, str) and not (self.number and _is_number(value)):
            return tables({"law": value})
        if isinstance(value, dict | Table):
            return tables(value)
        if self.number:
            return self._number(value, self.number)
        example = self.words[0]
        raise wrong(
            "the word of a law, or a table with it and its parameters",
            f'write for example "{example}" or {{ law = "{example}" }}; fyke laws lists them',
        )

    def _number(self, value: Any, number: Quantity) -> float:
        try:
            return number.read(value)
        except PydanticCustomError as error:
            cure = (error.context or {})["cure"]
            raise wrong(f"{number.allowed}, or a law: {', '.join(self.words)}", cure) from None

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Validate with read(), and tables by their law."""
        # Beside other marks on a field the discriminator would act on what read() takes, not on the tables alone.
        tables = handler.generate_schema(Annotated[source, Field(discriminator="law")])
        return core_schema.no_info_wrap_validator_function(
            self.read, tables, serialization=core_schema.plain_serializer_function_ser_schema(_plain)
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the words and, where it may be one, the number beside the tables."""
        others: list[JsonSchemaValue] = [{"enum": list(self.words)}]
        if self.number:
            low = "exclusiveMinimum" if self.number.open_below else "minimum"
            others.append({"type": "number", low: self.number.least, "maximum": self.number.most})
        return {"anyOf": [*others, handler(schema)]}


def _plain(value: Any) -> Any:
    return value.model_dump() if isinstance(value, Table) else value


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
