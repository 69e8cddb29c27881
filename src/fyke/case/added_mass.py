"""Added mass in the case file: a number, or a law of the angle between bar and flow."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from pydantic import AfterValidator, Field

from ..water.inertia import (
    ADDED_MASS_LAWS,
    SPHERE,
    WATER_ITSELF,
    AddedMassLaw,
    AddedMassTable,
    ConstantAddedMass,
)
from .by_law import LawTable, by_law
from .columns import Allowed, Layout, read_columns, too_few, unsorted
from .errors import CaseError, Problem
from .fields import Coefficient, Table
from .places import Path as Place
from .quantity import Quantity, wrong
from .units import ANGLE

BY_COEFFICIENT, BY_INERTIA = Layout(("angle", "coefficient"), 1), Layout(("angle", "inertia"), 1)
_MOST = 100.0
_ALLOWED: dict[str, Allowed] = {
    "angle": ("an angle from 0 (along the bar) to 90 deg (across)", 0.0, 90.0),
    "coefficient": (f"C_a, a number from 0 to {_MOST:g}", 0.0, _MOST),
    "inertia": (f"C_m = 1 + C_a, a number from 1 to {_MOST:g}", WATER_ITSELF, _MOST),
}
_NUMBER = Quantity(None, 0.0, _MOST)
_Inertia = Annotated[float, Quantity(None, WATER_ITSELF, _MOST)]
_Angle = Annotated[float, Quantity(ANGLE, 0.0, math.radians(90.0), unit_needed=True)]
_COEFFICIENT, _INERTIA = "C_a, over the displaced mass", "C_m = 1 + C_a, instead of coefficient"


class ConstantMassSpec(LawTable):
    """A constant, as C_a or as C_m."""

    law: Literal["constant"] = Field(description="added-mass law", examples=["constant"])
    coefficient: Coefficient | None = Field(default=None, description=_COEFFICIENT, examples=[1.0])
    inertia: _Inertia | None = Field(default=None, description=_INERTIA, examples=[2.0])

    @property
    def value(self) -> float:
        """C_a."""
        return _added(self.coefficient, self.inertia)


class PotentialFlowSpec(LawTable):
    """Potential flow: C_a = 1 across a long cylinder, 0.5 of a sphere."""

    law: Literal["potential-flow"] = Field(description="added-mass law", examples=["potential-flow"])


class LeeMassSpec(LawTable):
    """C_m = 1 + sin a of Lee's group, a between bar and flow: C_a = sin a across the bar."""

    law: Literal["lee"] = Field(description="added-mass law", examples=["lee"])


def _rising(values: tuple[float, ...]) -> tuple[float, ...]:
    if any(b <= a for a, b in pairwise(values)):
        raise wrong("angles that rise from each to the next", "sort the points and keep one for each angle")
    return values


class MassTableSpec(LawTable):
    """C_a or C_m measured at some angles between bar and flow, here or in a file; straight between, held beyond."""

    law: Literal["table"] = Field(description="added-mass law", examples=["table"])
    file: str | None = Field(
        default=None,
        description="CSV file, beside the case file: columns angle,coefficient or angle,inertia, angles in deg",
        examples=["added_mass.csv"],
    )
    angle: Annotated[tuple[_Angle, ...], Field(min_length=2), AfterValidator(_rising)] | None = Field(
        default=None, description="angles between bar and flow, rising", examples=[["0 deg", "90 deg"]]
    )
    coefficient: Annotated[tuple[Coefficient, ...], Field(min_length=2)] | None = Field(
        default=None, description=f"{_COEFFICIENT}, one for every angle", examples=[[0.0, 1.0]]
    )
    inertia: Annotated[tuple[_Inertia, ...], Field(min_length=2)] | None = Field(
        default=None, description=f"{_INERTIA}, one for every angle", examples=[[1.0, 2.0]]
    )


BAR_MASSES: dict[str, type[LawTable]] = {
    "constant": ConstantMassSpec,
    "potential-flow": PotentialFlowSpec,
    "lee": LeeMassSpec,
    "table": MassTableSpec,
}
KNOT_MASSES: dict[str, type[LawTable]] = {"constant": ConstantMassSpec, "potential-flow": PotentialFlowSpec}
if TYPE_CHECKING:
    BarMassSpec: TypeAlias = float | LawTable
    KnotMassSpec: TypeAlias = float | LawTable
else:
    BarMassSpec = by_law(BAR_MASSES, ("potential-flow", "lee"), _NUMBER)
    KnotMassSpec = by_law(KNOT_MASSES, ("potential-flow",), _NUMBER)


class AddedMass(Table):
    """Added mass over the mass of the displaced water, C_a."""

    bars: BarMassSpec = Field(default=1.0, description="of bars, across the bar only: C_a or a law")
    knots: KnotMassSpec = Field(default=0.5, description="of knots, in every direction: C_a or a law")

    def bar_law(self, *, folder: Path) -> AddedMassLaw:
        """Return the law of the bars; folder: of the case file. CaseError for a file that cannot be used."""
        bars = self.bars
        if isinstance(bars, float):
            return ConstantAddedMass(bars)
        if isinstance(bars, ConstantMassSpec):
            return ConstantAddedMass(bars.value)
        if isinstance(bars, MassTableSpec):
            return _table(bars, folder)
        return ADDED_MASS_LAWS[bars.law]()

    def knot_coefficient(self) -> float:
        """Return C_a of the knots."""
        knots = self.knots
        if isinstance(knots, float):
            return knots
        return knots.value if isinstance(knots, ConstantMassSpec) else SPHERE


def _added(coefficient: float | None, inertia: float | None) -> float:
    if coefficient is not None:
        return coefficient
    return 0.0 if inertia is None else inertia - WATER_ITSELF


def _table(spec: MassTableSpec, folder: Path) -> AddedMassTable:
    if spec.file is not None:
        return read_added_mass_table(folder / spec.file)
    values = spec.coefficient if spec.inertia is None else spec.inertia
    less = 0.0 if spec.inertia is None else WATER_ITSELF
    return AddedMassTable(spec.angle or (), tuple(value - less for value in values or ()))


def read_added_mass_table(path: str | Path) -> AddedMassTable:
    """Read C_a, or C_m = 1 + C_a, by the angle (deg) between bar and flow: angle,coefficient or angle,inertia.

    CaseError lists every fault of the file, with its row.
    """
    problems: list[Problem] = []
    layout, rows = read_columns(Path(path), (BY_COEFFICIENT, BY_INERTIA), _ALLOWED, problems)
    whole = not problems  # a row with a fault would also be missed
    if layout is not None:
        problems += unsorted(rows, layout)
    if layout is not None and whole:
        problems += too_few(Path(path), rows, layout)
    if problems:
        raise CaseError(problems)
    less = WATER_ITSELF if layout is BY_INERTIA else 0.0
    angles, values = zip(*(row.numbers for row in rows), strict=True)
    return AddedMassTable(tuple(map(math.radians, angles)), tuple(value - less for value in values))


def added_mass_findings(raw: dict[str, Any]) -> Iterator[tuple[Place, str, str, str]]:
    """Yield path, found, allowed and cure of all that is wrong between the keys of [added_mass]; raw: the case file."""
    table = raw.get("added_mass")
    for key, value in table.items() if isinstance(table, dict) else ():
        keys = {"law": value} if isinstance(value, str) else value
        if isinstance(keys, dict) and keys.get("law") in ("constant", "table"):
            yield from _between_keys(("added_mass", key), keys)


def _between_keys(path: Place, keys: dict[str, Any]) -> Iterator[tuple[Place, str, str, str]]:
    here = [key for key in ("coefficient", "inertia") if key in keys]
    if "file" in keys and keys["law"] == "table":
        doubled = [key for key in ("angle", *here) if key in keys]
        if doubled:
            found = f"both file and {' and '.join(doubled)}"
            yield path, found, "a file, or the numbers here", "leave out one of the two"
        return
    if len(here) != 1:
        found = "both coefficient and inertia" if here else "neither coefficient nor inertia"
        cure = "leave out one of the two" if here else "add coefficient, or inertia where you know C_m"
        yield path, found, "one of coefficient (C_a) and inertia (C_m = 1 + C_a)", cure
    if keys["law"] != "table":
        return
    if "angle" not in keys:
        cure = 'add angle = ["0 deg", "90 deg"] or file = "added_mass.csv"'
        yield path, "neither angle nor file", "the angles of the table, or a file", cure
    columns = [keys[key] for key in ("angle", *here) if isinstance(keys.get(key), list)]
    if len({len(column) for column in columns}) > 1:
        found = f"{len(columns[0])} angles and {len(columns[1])} values"
        yield path, found, "as many values as angles", "give one value for every angle"


def added_mass_file_problems(raw: dict[str, Any], folder: Path) -> Iterator[Problem]:
    """Yield every fault of the file that [added_mass] bars name, if it names one."""
    table = raw.get("added_mass")
    bars = table.get("bars") if isinstance(table, dict) else None
    file = bars.get("file") if isinstance(bars, dict) and bars.get("law") == "table" else None
    if isinstance(file, str):
        try:
            read_added_mass_table(folder / file)
        except CaseError as error:
            yield from error.problems
