"""What must hold between the tables of a case, judged on every part that stands by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import hypot
from pathlib import Path as FilePath
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from ..netting.twine import LEAD, MATERIALS, PACKING, Material, diameter_of
from .added_mass import added_mass_file_problems, added_mass_findings
from .drag import Drag, drag_file_problems, hung_solidity
from .errors import Problem
from .fields import Table
from .gear import NettingSpec, Part, Piece, Sheet
from .gear_check import gear_findings, has_bottom, reference
from .grouping import grouping_findings
from .keys import nearest
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
from .twine import MaterialSpec, TableSpec, TwineSpec
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
        return cls(
            raw,
            MATERIALS | own,
            {name: twine for name, twine in twines.items() if twine.resolved_diameter is not None},
            _named(TubeSpec, raw, "tube"),
            _named(NettingSpec, raw, "netting"),
            _named(ChainSpec, raw, "chain"),
            {i: part for i, part in parts.items() if part is not None},
            folder,
        )

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
    for name, keys in parts.tables("twine"):
        yield from _twine_keys(("twine", name), keys, parts)
        yield from _thickness_keys(("twine", name), keys)
    for name, keys in parts.tables("netting"):
        there = [one for one, _ in parts.items("twine")]
        yield from reference(("netting", name, "twine"), keys, "twine", there)
        yield from _long_bar(("netting", name, "long_bar"), keys)
    for name, _ in parts.tables("material"):
        if name in MATERIALS:
            allowed = "a name of its own: " + ", ".join(MATERIALS) + " are there already"
            yield (
                ("material", name),
                written(name),
                allowed,
                f"write [material.{name}-mine], say, or use {name}",
            )
    for name, twine in parts.twines.items():
        yield from _fibre(("twine", name), twine)
        yield from _table_law(("twine", name, "law"), twine)
    for name, netting in parts.nettings.items():
        yield from _thickness(("netting", name), netting, parts.twines.get(netting.twine))
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


def _twine_keys(path: Path, keys: dict[str, Any], parts: Parts) -> Iterator[Finding]:
    if "law" in keys and "youngs_modulus" in keys:
        yield (*path, "law"), "both youngs_modulus and law", "one elastic law", "leave out one of the two"
    name = keys.get("material")
    if name is not None and not (isinstance(name, str) and name in parts.materials):
        there = [*MATERIALS, *(own for own, _ in parts.tables("material"))]
        if isinstance(name, str) and name not in there:
            allowed, near = " or ".join(written(one) for one in there), nearest(name, there)
            cure = (
                f'did you mean "{near}"?' if near else f"choose {allowed}, or add a table [material.{name}]"
            )
            yield (*path, "material"), written(name), allowed, cure
        return  # what the material would give is not known
    material = parts.materials[name] if name else None
    if material is None and "density" not in keys:
        cure = 'add density = 1140.0, or material = "PA"'
        yield (*path, "density"), "neither density nor material", "density, kg/m3", cure
    if not (material and material.youngs_modulus) and not {"law", "youngs_modulus"} & keys.keys():
        found = f"no modulus, and none is known for {name}" if name else "neither youngs_modulus nor material"
        allowed, cure = "youngs_modulus, Pa, or a law", 'add youngs_modulus = "1.0 GPa" or a law'
        yield (*path, "youngs_modulus"), found, allowed, cure


def _long_bar(path: Path, keys: dict[str, Any]) -> Iterator[Finding]:
    if keys.get("mesh") == "hexagonal" and "long_bar" not in keys:
        allowed = "long_bar, m: hexagons have four bars of bar_length and two of long_bar"
        yield path, "nothing", allowed, 'add long_bar = "45 mm"'
    if keys.get("mesh") in ("diamond", "square") and "long_bar" in keys:
        found = f"long_bar with {keys['mesh']} mesh"
        yield path, found, "long_bar of hexagonal mesh", 'leave it out, or write mesh = "hexagonal"'


def _thickness_keys(path: Path, keys: dict[str, Any]) -> Iterator[Finding]:
    """What is wrong with the keys that say how thick a twine is."""
    if not {"diameter", "rtex"} & keys.keys():
        cure = 'add diameter = "1.5 mm", or rtex = "2000 tex"'
        yield (*path, "diameter"), "nothing", "diameter, m, or rtex, the mass per length", cure
    if "packing" in keys and ("diameter" in keys or "rtex" not in keys):
        found = "both packing and diameter" if "diameter" in keys else "packing without rtex"
        allowed = "packing with rtex alone, where it makes the diameter"
        yield (*path, "packing"), found, allowed, "leave out packing" + " or diameter" * ("rtex" in keys)


def _fibre(path: Path, twine: TwineSpec) -> Iterator[Finding]:
    """What is wrong with a twine that is said to hold more fibre than there is room for."""
    density, diameter = twine.resolved_density, twine.given_diameter
    if twine.lead and diameter is not None and diameter <= diameter_of(twine.lead, LEAD, 1.0):
        least = diameter_of(twine.lead, LEAD, 1.0)
        found = f"{twine.lead * 1e3:g} g/m of lead in a diameter of {diameter * 1e3:g} mm"
        allowed = f"above {least * 1e3:.4g} mm, which the lead alone fills"
        yield (*path, "lead"), found, allowed, "check the units of lead and diameter"
        return
    if density is None or diameter is None or twine.rtex is None:
        return
    solid = hypot(diameter_of(twine.rtex, density, 1.0), diameter_of(twine.lead or 0.0, LEAD, 1.0))
    if solid > diameter * (1.0 + 1e-9):
        found = f"{twine.rtex * 1e6:g} tex in a diameter of {diameter * 1e3:g} mm"
        allowed = f"at least {solid * 1e3:.4g} mm, which fibre of {density:g} kg/m3 fills without pores"
        cure = (
            f"check the units; a packing of {PACKING:g} makes {diameter_of(twine.rtex, density) * 1e3:.4g} mm"
        )
        yield (*path, "rtex"), found, allowed, cure


def _table_law(path: Path, twine: TwineSpec) -> Iterator[Finding]:
    law = twine.law
    if isinstance(law, TableSpec) and len(law.strain) != len(law.tension):
        found = f"{len(law.strain)} strains and {len(law.tension)} tensions"
        yield path, found, "as many tensions as strains", "give one tension (N) for every strain"


def _thickness(path: Path, netting: NettingSpec, twine: TwineSpec | None) -> Iterator[Finding]:
    bar = netting.bar_length
    if twine and twine.diameter >= bar:
        found = f"{bar * 1e3:g} mm, and its twine is {twine.diameter * 1e3:g} mm thick"
        allowed = "a bar length (knot centre to knot centre) above the diameter of the twine"
        yield (
            (*path, "bar_length"),
            found,
            allowed,
            "check the units of bar_length and of the twine's diameter",
        )
    if netting.knot_diameter and netting.knot_diameter >= bar:
        allowed = f"less than the bar length of {bar * 1e3:g} mm"
        cure = "check the unit; neighbouring knots would overlap"
        yield (*path, "knot_diameter"), f"{netting.knot_diameter * 1e3:g} mm", allowed, cure


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
