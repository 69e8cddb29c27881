"""The keys of the case file as the models know them: which table a key stands in, and which key was meant."""

from __future__ import annotations

import difflib
import types
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo

from .by_law import LawTable
from .errors import Problem
from .fields import Table
from .places import Path
from .schema import Case
from .written import assignment

_NEAR = 0.6


@dataclass(frozen=True)
class Spot:
    """A key of the file: path, the model of the table around it, and its field, None for an unknown key."""

    path: Path
    table: type[Table]
    field: FieldInfo | None

    @property
    def key(self) -> str:
        """The last step of the path."""
        return str(self.path[-1]) if self.path else ""

    @property
    def meaning(self) -> str:
        """What the key is for, with its unit."""
        return (self.field.description if self.field else None) or "a value"

    @property
    def choices(self) -> list[str]:
        """The allowed words of a field that is a choice, or of the key that tells several tables apart."""
        if self.field is None:
            return []
        models = _models(_item(self.field.annotation))
        return _literals(self.field.annotation) or [w for model in models for w in _words(model, models)]


def follow(location: tuple[str | int, ...]) -> Spot:
    """Follow a location as pydantic gives it, where the kind or the law of a table is a step of its own."""
    path: list[str | int] = []
    here: Any = Case
    table: type[Table] = Case
    field: FieldInfo | None = None
    for step in location:
        models = _models(here)
        if len(models) > 1:
            here = next((model for model in models if step in _words(model, models)), None)
            continue
        if step == "[key]":
            continue
        path.append(step)
        if models:
            table, field = models[0], fields_of(models[0]).get(str(step))
            here = field.annotation if field else None
        else:
            inner = get_args(here)
            here = inner[-1] if get_origin(here) is dict else inner[0] if inner else None
    return Spot(tuple(path), table, field)


def fields_of(table: type[Table]) -> dict[str, FieldInfo]:
    """Return the fields of a table by the keys of the file."""
    return {field.alias or name: field for name, field in table.model_fields.items()}


def nearest(word: str, known: Iterable[str], cutoff: float = _NEAR) -> str:
    """Return the known word that is most like this one, "" when none is."""
    near = difflib.get_close_matches(word, list(known), n=1, cutoff=cutoff)
    return near[0] if near else ""


def cure_for_unknown(key: str, table: type[Table]) -> str:
    """Say which key was meant, or where this one belongs."""
    close = nearest(key, fields_of(table), cutoff=0.8)
    homes = list(dict.fromkeys(name for name, model in _tables(table) if key in fields_of(model)))
    if homes and not close and not issubclass(table, LawTable):
        return f"'{key}' belongs in {' or '.join(homes)}"
    near = close or nearest(key, fields_of(table))
    return f"did you mean '{near}'?" if near else "leave it out, or choose one of these keys"


def example(table: type[Table]) -> str:
    """Return the keys that a table must have, with values to start from."""
    keys = list(fields_of(table).items())
    needed = [(key, field) for key, field in keys if field.is_required()] or keys[:1]
    return ", ".join(assignment(key, (field.examples or ["..."])[0]) for key, field in needed)


def cure_for_missing(key: str, field: FieldInfo) -> str:
    """Say what to add, with an example."""
    models = _models(field.annotation)
    if models:
        return f"add the table [{key}] with {example(models[0])}"
    if key == "gear":
        return f"add a table [[gear]] with {example(_models(_item(field.annotation))[0])}"
    if get_origin(field.annotation) is dict:
        return f"add a table [{key}.main] with {example(_models(get_args(field.annotation)[1])[0])}"
    return f"add {assignment(key, (field.examples or ['...'])[0])}"


def _models(annotation: Any) -> list[type[Table]]:
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return [annotation]
    if get_origin(annotation) is Annotated:
        return _models(get_args(annotation)[0])
    if get_origin(annotation) in (Union, types.UnionType):
        return [model for part in get_args(annotation) for model in _models(part)]
    return []


def _literals(annotation: Any) -> list[str]:
    if get_origin(annotation) is Literal:
        return [str(word) for word in get_args(annotation)]
    if get_origin(annotation) in (Union, types.UnionType):
        return [word for part in get_args(annotation) for word in _literals(part)]
    return []


def _tag(models: list[type[Table]]) -> str:
    """Return the key that tells several tables apart: each allows words of its own for it."""
    for key in fields_of(models[0]):
        words = [_literals(fields_of(model)[key].annotation) for model in models if key in fields_of(model)]
        every = [word for some in words for word in some]
        if len(words) == len(models) and all(words) and len(set(every)) == len(every):
            return key
    raise TypeError(f"no key tells {', '.join(model.__name__ for model in models)} apart")


def _words(model: type[Table], models: list[type[Table]]) -> list[str]:
    """Return the words of one of several tables."""
    return _literals(fields_of(model)[_tag(models)].annotation)


def _item(annotation: Any) -> Any:
    """Return what a list holds, or the value itself where it is no list."""
    return get_args(annotation)[0] if get_origin(annotation) is tuple else annotation


def _tables(asked: type[Table]) -> list[tuple[str, type[Table]]]:
    """Every table of the file under the name that a reader would look for, one of whom stands in `asked`."""
    tables: list[tuple[str, type[Table]]] = []
    for key, field in fields_of(Case).items():
        inner = get_args(field.annotation)
        if get_origin(field.annotation) is dict:
            tables.append((f"[{key}.NAME]", inner[1]))
            continue
        listed = get_origin(field.annotation) is tuple
        models = _models(_item(field.annotation))
        name = f"[[{key}]]" if listed else f"[{key}]"
        for model in models:
            words = _words(model, models) if len(models) > 1 and (asked in models or not listed) else []
            tables.append((name + (f' with {_tag(models)} = "{words[0]}"' if words else ""), model))
    return tables


def unknown_keys(where: str, raw: Mapping[str, Any], known: Iterable[str]) -> list[Problem]:
    """Return a problem for every key of a table of another file than a case that it does not know."""
    names, out = sorted(known), []
    for key in sorted(set(raw) - set(names)):
        near = nearest(key, names)
        cure = f"did you mean '{near}'?" if near else "leave it out"
        out.append(Problem(f"{where}, {key}", "an unknown key", ", ".join(names), cure))
    return out
