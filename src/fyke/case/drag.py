"""Drag laws in the case file: every law of fyke.water.laws by its word, its parameters as keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast, get_type_hints

from pydantic import Field, create_model

from ..netting.lattice import hanging_ratios
from ..netting.measures import solidity
from ..water.laws import LAWS, AngleTable, BarLaw, BarTable, KnotLaw, Law
from ..water.laws.bars import ConstantBar
from ..water.laws.knots import ConstantKnot
from ..water.laws.panels import ScreenLaw
from .by_law import LawTable, by_law
from .drag_table import BY_ANGLE, BY_SPEED, read_drag_table
from .errors import CaseError, Problem
from .fields import Coefficient, Factor, Share, Table
from .gear import NettingSpec, Sheet

# Laws that are nothing but the user's numbers, which are therefore asked for.
_GIVEN = (ConstantBar, ConstantKnot)
_COLUMNS: Mapping[type[Law], str] = {
    BarTable: ",".join(BY_SPEED.columns),
    AngleTable: ",".join(BY_ANGLE.columns),
}
# How a parameter of a law is written: its type, or None for that of the law; meaning; example.
_PARAMETERS: Mapping[str, tuple[Any, str, Any]] = {
    "normal": (Coefficient, "C_n of the flow across the bar, on diameter x length", 1.2),
    "tangential": (Coefficient, "C_t of the flow along the bar, on diameter x length", 0.1),
    "solidity": (Share | None, "solid over outline area of the netting, as hung by default", 0.2),
    "across": (Factor, "C_n of the flow across the bar, on diameter x length", 1.1),
    "friction": (Coefficient, "C_D along the flow on top of it, on diameter x length", 0.02),
    "drag": (Coefficient, "C_D of a sphere, on pi d^2 / 4", 1.0),
    "shape": (Factor, "drag of a knot over that of a sphere of its diameter", 1.2),
    "series": (None, "which published set of coefficients", "sheet"),
}
_OF_THE_NETTING = "solidity"  # a parameter that is that of the netting where it is left out


def needs_file(law: type[Law]) -> bool:
    """Whether a law is a table of numbers, which a file holds."""
    return law in _COLUMNS


def _key(law: type[Law], name: str, default: Any) -> tuple[Any, Any]:
    """Return type and field of a parameter."""
    kind, meaning, example = _PARAMETERS[name]
    if name == _OF_THE_NETTING:
        default = None
    elif law in _GIVEN:
        default = MISSING
    told: dict[str, Any] = {"description": meaning, "examples": [example]}
    return kind or get_type_hints(law)[name], Field(
        **told, **({} if default is MISSING else {"default": default})
    )


def _table_of(law: type[Law]) -> type[LawTable]:
    """Make the table of a law from its parameters, so that what a law has can be written."""
    word = Field(description="drag law", examples=[law.name])
    keys: dict[str, Any] = {"law": (Literal[law.name], word)}
    if needs_file(law):
        what = f"CSV file, beside the case file: columns {_COLUMNS[law]}"
        keys["file"] = (str, Field(description=what, examples=["drag.csv"]))
    else:
        parameters = fields(law)  # type: ignore[arg-type] # every law is a dataclass, which its type does not say
        keys |= {one.name: _key(law, one.name, one.default) for one in parameters}
    told = f"{law.title}. Source: {law.source}."
    return create_model(f"{law.__name__}Spec", __base__=LawTable, __doc__=told, **keys)


TABLES: Mapping[str, Mapping[str, type[LawTable]]] = MappingProxyType(
    {kind: {word: _table_of(law) for word, law in laws.items()} for kind, laws in LAWS.items()}
)
if TYPE_CHECKING:
    # Made from the laws while the program runs, and so unknown to a reader of types.
    BarDragSpec: TypeAlias = LawTable
    KnotDragSpec: TypeAlias = LawTable
    PanelDragSpec: TypeAlias = LawTable
else:
    BarDragSpec, KnotDragSpec, PanelDragSpec = (
        by_law(TABLES[kind], (word for word, law in LAWS[kind].items() if law not in (*_GIVEN, *_COLUMNS)))
        for kind in ("bars", "knots", "panels")
    )

_BARS, _KNOTS = {"law": "constant", "normal": 1.2, "tangential": 0.1}, {"law": "constant", "drag": 1.0}
_SCREENS = "kristiansen-faltinsen"  # nearest to Patursson's panel of all, see docs/laws.md


class Drag(Table):
    """Laws of the drag of bars and knots, or of whole meshes of netting as pieces of screen."""

    kind: Literal["bars", "screens"] = Field(
        default="bars",
        description="whether the drag of netting is that of its bars and knots, or of its meshes as screens",
    )
    bars: BarDragSpec = Field(
        default=TABLES["bars"]["constant"].model_validate(_BARS), description="drag law of the bars"
    )
    knots: KnotDragSpec = Field(
        default=TABLES["knots"]["constant"].model_validate(_KNOTS), description="drag law of the knots"
    )
    screens: PanelDragSpec | None = Field(
        default=None,
        description=f'drag law of meshes with kind = "screens", {_SCREENS} by default',
        examples=[_SCREENS],
    )

    def bar_law(self, *, solidity: float, folder: Path) -> BarLaw:
        """Return the law of the bars.

        solidity: of the netting as hung, for a law that needs it and does not say it; folder: of the case file.
        CaseError for a file that cannot be used.
        """
        law = LAWS["bars"][self.bars.law]
        given = self.bars.parameters()
        if needs_file(law):
            return read_table(law, folder / given["file"])
        if _OF_THE_NETTING in type(self.bars).model_fields:
            given.setdefault(_OF_THE_NETTING, solidity)
        return cast(BarLaw, law(**given))

    def knot_law(self) -> KnotLaw:
        """Return the law of the knots."""
        return cast(KnotLaw, LAWS["knots"][self.knots.law](**self.knots.parameters()))

    def panel_law(self) -> ScreenLaw | None:
        """Return the law of the meshes as screens; None where bars and knots have the drag."""
        if self.kind == "bars":
            return None
        if self.screens is None:
            return cast(ScreenLaw, LAWS["panels"][_SCREENS]())
        return cast(ScreenLaw, LAWS["panels"][self.screens.law](**self.screens.parameters()))

    @property
    def takes_solidity(self) -> bool:
        """Whether the law of the bars takes the solidity of the netting as hung."""
        left_out = type(self.bars).model_fields.keys() - self.bars.parameters().keys()
        return self.kind == "bars" and _OF_THE_NETTING in left_out


def read_table(law: type[Law], file: Path) -> BarTable | AngleTable:
    """Read the table of a law; CaseError lists every fault of the file."""
    table = read_drag_table(file)
    if type(table) is not law:
        found = f'columns {_COLUMNS[type(table)]}, of law = "{table.name}"'
        allowed = f'columns {_COLUMNS[law]} for law = "{law.name}"'
        raise CaseError(
            [Problem(str(file), found, allowed, f'write law = "{table.name}", or name another file')]
        )
    return table


def drag_file_problems(raw: dict[str, Any], folder: Path) -> Iterator[Problem]:
    """Yield every fault of the file that [drag] bars name, if it names one; raw: the case file."""
    table = raw.get("drag")
    bars = table.get("bars") if isinstance(table, dict) else None
    if not isinstance(bars, dict) or not isinstance(bars.get("file"), str):
        return
    law = next((one for one in _COLUMNS if one.name == bars.get("law")), None)
    if law is not None:
        try:
            read_table(law, folder / bars["file"])
        except CaseError as error:
            yield from error.problems


def hung_solidity(sheet: Sheet, netting: NettingSpec, diameter: float) -> float:
    """Return the solidity of a sheet of netting as it is hung; diameter: of its twine (m)."""
    ratios = hanging_ratios(netting.mesh, sheet.meshes, netting.bar_length, sheet.size)
    return solidity(netting.mesh, netting.bar_length, ratios, diameter, netting.knot_diameter or 0.0)
