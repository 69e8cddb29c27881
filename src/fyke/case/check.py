"""What must hold between the tables of a case, judged on every part that stands by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from ..netting.twine import MATERIALS, Material
from .added_mass import added_mass_file_problems, added_mass_findings
from .drag import Drag, drag_file_problems, hung_solidity
from .errors import Problem
from .fields import Table
from .gear import NettingSpec, Part, Piece, Sheet
from .gear_check import gear_findings, has_bottom
from .grouping import gather, grouping_findings
from .line_check import line_findings
from .lines import ChainSpec, LaidSpec
from .load_case import load_case_file_problems, load_case_findings
from .motion_check import motion_file_problems, motion_findings
from .places import Path
from .rigging import BodiesSpec, RopeSpec
from .schema import Compare, DynamicSolve, Gear, Output, Water
from .seams import SeamSpec
from .tube_check import tube_findings
from .tubes import TubeSpec, TubularSpec
from .twine import MaterialSpec, TwineSpec
from .twine_check import twine_findings
from .water_check import bed_findings, current_file_problems, current_findings, sea_bed_findings
from .waves import wave_findings
from .written import written

RIGGING = {"seam", "rope", "ring", "collar", "line", "moorings", "sinkers", "floats"}  # not netting
MOST_OUTPUTS = 1_000_000

Finding = tuple[Path, str, str, str]  # path, found, allowed, cure
Model = TypeVar("Model", bound=Table)
_GEAR: TypeAdapter[Part] = TypeAdapter(Gear)


@dataclass(frozen=True)
class Parts:
    """The raw case file and every part of it that is valid by itself; paths start with these keys."""

    raw: dict[str, Any]
    materials: dict[str, Material]
    twines: dict[str, TwineSpec]
    tubes: dict[str, TubeSpec]
    nettings: dict[str, NettingSpec]
    chains: dict[str, ChainSpec]
    gear: dict[int, Part]
    folder: FilePath

    @classmethod
    def of(cls, raw: dict[str, Any], folder: FilePath) -> Parts:
        """Take a raw case apart; folder: where relative file names count from."""
        gear = raw.get("gear")
        parts = {i: _part(one) for i, one in enumerate(gear if isinstance(gear, list) else [])}
        own = {name: spec.material(name) for name, spec in _named(MaterialSpec, raw, "material").items()}
        twines = _named(TwineSpec, raw, "twine")
        for twine in twines.values():
            twine.settle(MATERIALS | own)
        made = cls(
            raw,
            MATERIALS | own,
            {name: twine for name, twine in twines.items() if twine.resolved_diameter is not None},
            _named(TubeSpec, raw, "tube"),
            _named(NettingSpec, raw, "netting"),
            _named(ChainSpec, raw, "chain"),
            {i: part for i, part in parts.items() if part is not None},
            folder,
        )
        gather(made)
        return made

    @property
    def is_static(self) -> bool:
        """Whether an equilibrium is asked for, as far as can be told."""
        solve = self.raw.get("solve")
        return not isinstance(solve, dict) or solve.get("kind", "static") == "static"

    @property
    def pieces(self) -> dict[int, Piece]:
        """Gear that is netting, by its place in the file."""
        return {i: part for i, part in self.gear.items() if isinstance(part, Piece)}

    @property
    def seams(self) -> dict[int, SeamSpec]:
        """Gear that is seams, by its place in the file."""
        return {i: part for i, part in self.gear.items() if isinstance(part, SeamSpec)}

    @property
    def ropes(self) -> dict[int, RopeSpec]:
        """Gear that is ropes, by its place in the file."""
        return {i: part for i, part in self.gear.items() if isinstance(part, RopeSpec)}

    @property
    def lines(self) -> dict[int, LaidSpec]:
        """Gear that is lines and moorings, by its place in the file."""
        return {i: part for i, part in self.gear.items() if isinstance(part, LaidSpec)}

    @property
    def tubulars(self) -> dict[int, TubularSpec]:
        """Gear that is made of tubes, by its place in the file."""
        return {i: part for i, part in self.gear.items() if isinstance(part, TubularSpec)}

    @property
    def bodies(self) -> dict[int, BodiesSpec]:
        """Gear that is floats and sinkers, by its place in the file."""
        return {i: part for i, part in self.gear.items() if isinstance(part, BodiesSpec)}

    @property
    def netting_names(self) -> list[str]:
        """Names of everything that is netting and of what may be, valid or not, bottoms included."""
        names = []
        for index, keys in self.gear_tables():
            if not RIGGING & {keys.get("kind") if isinstance(keys.get("kind"), str) else ""}:
                names += self.names_of(index, keys)
        return names

    def names_of(self, index: int, keys: dict[str, Any]) -> list[str]:
        """Name of a part of these keys, and that of its bottom."""
        name = self.name_of(index)
        return [name, f"{name} bottom".strip()] if has_bottom(keys) else [name]

    def name_of(self, index: int, sheet: Sheet | None = None) -> str:
        """Name that a part of the gear will have, or the bottom of one, a sheet that is sewn to another."""
        tables = dict(self.gear_tables())
        name = tables[index].get("name", str(index + 1) if len(tables) > 1 else "")
        return f"{name} bottom".strip() if sheet is not None and sheet.sewn else str(name)

    def items(self, table: str) -> list[tuple[str, Any]]:
        """Twines or nettings by name, whatever they are."""
        return _items(self.raw, table)

    def tables(self, table: str) -> list[tuple[str, dict[str, Any]]]:
        """Twines or nettings as they were written, valid or not."""
        return [(name, part) for name, part in _items(self.raw, table) if isinstance(part, dict)]

    def gear_tables(self) -> list[tuple[int, dict[str, Any]]]:
        """Parts of the gear as they were written, valid or not."""
        gear = self.raw.get("gear")
        return [
            (i, part)
            for i, part in enumerate(gear if isinstance(gear, list) else [])
            if isinstance(part, dict)
        ]


def findings(parts: Parts) -> Iterator[Finding]:
    """Everything that is wrong between keys and tables."""
    yield from twine_findings(parts)
    yield from tube_findings(parts)
    water = _valid(Water, parts.raw.get("water", {}))
    yield from gear_findings(parts, water)
    yield from line_findings(parts, water)
    yield from bed_findings(parts, water)
    yield from grouping_findings(parts)
    yield from _outputs(parts)
    yield from _stepper(parts)
    yield from _compare(parts)
    yield from _solidities(parts)
    yield from added_mass_findings(parts.raw)
    if water is not None and "waves" in parts.raw:
        yield from wave_findings(parts.raw["waves"], water.depth, water.gravity)
    yield from current_findings(parts)
    yield from sea_bed_findings(parts)
    yield from _load_cases(parts)
    yield from motion_findings(parts, _valid(DynamicSolve, parts.raw.get("solve")))


def file_problems(parts: Parts) -> Iterator[tuple[Path, Problem]]:
    """Every fault of the files that a case takes its laws and its current from, with the key that names the file."""
    for key, problems in (
        (("current", "file"), current_file_problems(parts)),
        (("drag", "bars", "file"), drag_file_problems(parts.raw, parts.folder)),
        (("added_mass", "bars", "file"), added_mass_file_problems(parts.raw, parts.folder)),
    ):
        for number, problem in enumerate(problems):
            yield (*key, number), problem
    yield from load_case_file_problems(parts)
    yield from motion_file_problems(parts)


def _valid(model: type[Model], part: Any) -> Model | None:
    try:
        return model.model_validate(part)
    except ValidationError:
        return None


def _part(part: Any) -> Part | None:
    try:
        return _GEAR.validate_python(part)
    except ValidationError:
        return None


def _named(model: type[Model], raw: dict[str, Any], table: str) -> dict[str, Model]:
    specs = {name: _valid(model, part) for name, part in _items(raw, table)}
    return {name: spec for name, spec in specs.items() if spec is not None}


def _items(raw: dict[str, Any], table: str) -> list[tuple[str, Any]]:
    inner = raw.get(table)
    return list(inner.items()) if isinstance(inner, dict) else []


def _outputs(parts: Parts) -> Iterator[Finding]:
    solve = _valid(DynamicSolve, parts.raw.get("solve"))
    output = _valid(Output, parts.raw.get("output"))
    if not (solve and output and output.every):
        return
    where, found = ("output", "every"), f"{output.every:g} s"
    if solve.duration / output.every > MOST_OUTPUTS:
        found += f", which makes {solve.duration / output.every:.3g} outputs"
        allowed = f"at most {MOST_OUTPUTS:,} outputs over the duration of {solve.duration:g} s"
        yield where, found, allowed, f"write every = {solve.duration / 1000:g} or more"
    elif output.every > solve.duration:
        allowed = f"at most the duration of {solve.duration:g} s"
        yield where, found, allowed, "make every smaller or the duration longer, or leave every out"


# Keys of [solve] that steppers have no use for.
_WITHOUT = {"symplectic": ("rtol", "atol")}
_EXPLICIT = ("verner", "symplectic")


def _stepper(parts: Parts) -> Iterator[Finding]:
    solve = _valid(DynamicSolve, parts.raw.get("solve"))
    if solve is None:
        return
    for key in _WITHOUT.get(solve.stepper, ()):
        if getattr(solve, key) is not None:
            found = f'{key} with stepper = "{solve.stepper}", which has no error control'
            cure = f'leave {key} out; max_step shortens its steps, stepper = "verner" keeps to {key}'
            yield ("solve", key), found, "rtol and atol with auto, implicit, newmark and verner only", cure
    drag = parts.raw.get("drag")
    if solve.stepper in _EXPLICIT and isinstance(drag, dict) and drag.get("kind") == "screens":
        found = f'"{solve.stepper}" with screens, which explicit steps do not know'
        allowed = '"auto", "implicit" or "newmark" with [drag] kind = "screens"'
        yield ("solve", "stepper"), found, allowed, 'write stepper = "implicit", or leave it out'
    if solve.stepper in _EXPLICIT and "bed" in parts.raw:
        found = f'"{solve.stepper}" with a sea bed, which explicit steps do not know'
        allowed = '"auto", "implicit" or "newmark" with [bed]'
        yield ("solve", "stepper"), found, allowed, 'write stepper = "implicit", or leave it out'
    if solve.max_step is not None and solve.max_step > solve.duration:
        allowed = f"at most the duration of {solve.duration:g} s"
        yield (
            ("solve", "max_step"),
            f"{solve.max_step:g} s",
            allowed,
            "leave max_step out, or check its unit",
        )


def _compare(parts: Parts) -> Iterator[Finding]:
    compare = _valid(Compare, parts.raw.get("compare"))
    if compare is None:
        return
    file = parts.folder / compare.positions
    try:
        with file.open("rb"):
            return
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        cure = "check the name; it counts from the folder of the case file"
        yield (
            ("compare", "positions"),
            f"{written(compare.positions)}: {reason}",
            "a CSV file that can be read",
            cure,
        )


def _solidities(parts: Parts) -> Iterator[Finding]:
    drag = _valid(Drag, parts.raw.get("drag", {}))
    if drag is None or not drag.takes_solidity:
        return
    found = set()
    for piece in parts.pieces.values():
        netting = parts.nettings.get(piece.netting)
        twine = parts.twines.get(netting.twine) if netting else None
        if netting and twine:
            found |= {f"{hung_solidity(one, netting, twine.diameter):.3g}" for one in piece.sheets(netting)}
    if len(found) > 1:
        told = f"none, and netting of solidity {' and '.join(sorted(found))}"
        allowed = f'one solidity for the law "{drag.bars.law}" of all bars'
        cure = f'write bars = {{ law = "{drag.bars.law}", solidity = {min(found)} }} with the one that counts'
        yield ("drag", "bars"), told, allowed, cure


def _load_cases(parts: Parts) -> Iterator[Finding]:
    water = _valid(Water, parts.raw.get("water", {}))
    depth, gravity = (None, None) if water is None else (water.depth, water.gravity)
    yield from load_case_findings(parts, depth, gravity)
