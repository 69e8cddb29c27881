"""What must hold between the tables of a case, judged on every part that stands by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, TypeVar

from pydantic import ValidationError

from ..netting.lattice import flat_strain
from ..netting.twine import MATERIALS
from .added_mass import added_mass_file_problems, added_mass_findings
from .drag import Drag, drag_file_problems, hung_solidity
from .errors import Problem
from .fields import Table
from .gear import NettingSpec, PanelSpec
from .keys import nearest
from .places import Path
from .schema import Compare, DynamicSolve, Output, Water
from .twine import TableSpec, TwineSpec
from .water_check import current_file_problems, current_findings, sea_bed_findings
from .waves import wave_findings
from .written import written

LARGEST_STRAIN = 0.2  # of the unloaded flat panel
MOST_OUTPUTS = 1_000_000

Finding = tuple[Path, str, str, str]  # path, found, allowed, cure
Model = TypeVar("Model", bound=Table)


@dataclass(frozen=True)
class Parts:
    """The raw case file and every part of it that is valid by itself; paths start with these keys."""

    raw: dict[str, Any]
    twines: dict[str, TwineSpec]
    nettings: dict[str, NettingSpec]
    panels: dict[int, PanelSpec]
    folder: FilePath

    @classmethod
    def of(cls, raw: dict[str, Any], folder: FilePath) -> Parts:
        """Take a raw case apart; folder: where relative file names count from."""
        gear = raw.get("gear")
        panels = {i: _valid(PanelSpec, part) for i, part in enumerate(gear if isinstance(gear, list) else [])}
        return cls(
            raw,
            _named(TwineSpec, raw, "twine"),
            _named(NettingSpec, raw, "netting"),
            {i: panel for i, panel in panels.items() if panel is not None},
            folder,
        )

    @property
    def is_static(self) -> bool:
        """Whether an equilibrium is asked for, as far as can be told."""
        solve = self.raw.get("solve")
        return not isinstance(solve, dict) or solve.get("kind", "static") == "static"

    def tables(self, table: str) -> list[tuple[str, dict[str, Any]]]:
        """Twines or nettings as they were written, valid or not."""
        return [(name, part) for name, part in _items(self.raw, table) if isinstance(part, dict)]

    def panel_tables(self) -> list[tuple[int, dict[str, Any]]]:
        """Panels as they were written, valid or not."""
        gear = self.raw.get("gear")
        return [
            (i, part)
            for i, part in enumerate(gear if isinstance(gear, list) else [])
            if isinstance(part, dict)
        ]


def findings(parts: Parts) -> Iterator[Finding]:
    """Everything that is wrong between keys and tables."""
    for name, keys in parts.tables("twine"):
        yield from _twine_keys(("twine", name), keys)
    for name, keys in parts.tables("netting"):
        yield from _reference(("netting", name, "twine"), keys, "twine", parts)
    for index, keys in parts.panel_tables():
        yield from _reference(("gear", index, "netting"), keys, "netting", parts)
        yield from _panel_keys(("gear", index), keys, parts)
    yield from _panel_names(parts)
    for name, twine in parts.twines.items():
        yield from _table_law(("twine", name, "law"), twine)
    for name, netting in parts.nettings.items():
        yield from _thickness(("netting", name), netting, parts.twines.get(netting.twine))
    for index, panel in parts.panels.items():
        yield from _frame(("gear", index), panel, parts.nettings.get(panel.netting))
    yield from _outputs(parts)
    yield from _stepper(parts)
    yield from _compare(parts)
    yield from _solidities(parts)
    yield from added_mass_findings(parts.raw)
    yield from _waves(parts)
    yield from current_findings(parts)
    yield from sea_bed_findings(parts)


def file_problems(parts: Parts) -> Iterator[tuple[Path, Problem]]:
    """Every fault of the files that a case takes its laws and its current from, with the key that names the file."""
    for key, problems in (
        (("current", "file"), current_file_problems(parts)),
        (("drag", "bars", "file"), drag_file_problems(parts.raw, parts.folder)),
        (("added_mass", "bars", "file"), added_mass_file_problems(parts.raw, parts.folder)),
    ):
        for number, problem in enumerate(problems):
            yield (*key, number), problem


def _valid(model: type[Model], part: Any) -> Model | None:
    try:
        return model.model_validate(part)
    except ValidationError:
        return None


def _named(model: type[Model], raw: dict[str, Any], table: str) -> dict[str, Model]:
    specs = {name: _valid(model, part) for name, part in _items(raw, table)}
    return {name: spec for name, spec in specs.items() if spec is not None}


def _items(raw: dict[str, Any], table: str) -> list[tuple[str, Any]]:
    inner = raw.get(table)
    return list(inner.items()) if isinstance(inner, dict) else []


def _twine_keys(path: Path, keys: dict[str, Any]) -> Iterator[Finding]:
    if "law" in keys and "youngs_modulus" in keys:
        yield (*path, "law"), "both youngs_modulus and law", "one elastic law", "leave out one of the two"
    name = keys.get("material")
    if name is not None and not (isinstance(name, str) and name in MATERIALS):
        return  # what the material would give is not known
    material = MATERIALS[name] if name else None
    if material is None and "density" not in keys:
        cure = 'add density = 1140.0, or material = "PA"'
        yield (*path, "density"), "neither density nor material", "density, kg/m3", cure
    if not (material and material.youngs_modulus) and not {"law", "youngs_modulus"} & keys.keys():
        found = f"no modulus, and none is known for {name}" if name else "neither youngs_modulus nor material"
        allowed, cure = "youngs_modulus, Pa, or a law", 'add youngs_modulus = "1.0 GPa" or a law'
        yield (*path, "youngs_modulus"), found, allowed, cure


def _table_law(path: Path, twine: TwineSpec) -> Iterator[Finding]:
    law = twine.law
    if isinstance(law, TableSpec) and len(law.strain) != len(law.tension):
        found = f"{len(law.strain)} strains and {len(law.tension)} tensions"
        yield path, found, "as many tensions as strains", "give one tension (N) for every strain"


def _reference(path: Path, keys: dict[str, Any], table: str, parts: Parts) -> Iterator[Finding]:
    name = keys.get(table)
    there = [one for one, _ in _items(parts.raw, table)]
    if not isinstance(name, str) or name in there:
        return
    allowed = f"a {table} of this file: " + (", ".join(written(one) for one in there) or "there is none yet")
    near = nearest(name, there)
    cure = f'did you mean "{near}"?' if near else f"add a table [{table}.{name}] or name one that is there"
    yield path, written(name), allowed, cure


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


def _panel_keys(path: Path, keys: dict[str, Any], parts: Parts) -> Iterator[Finding]:
    if parts.is_static and keys.get("fixed") == "none":
        allowed = '"edges", "top" or "corners" for a static case'
        cure = 'nothing would hold it: write fixed = "edges", or solve with kind = "dynamic"'
        yield (*path, "fixed"), '"none"', allowed, cure
    asked = {"size", "hanging_ratio"} & keys.keys()
    if len(asked) != 1:
        found = "both size and hanging_ratio" if asked else "neither size nor hanging_ratio"
        cure = (
            "leave out one of the two" if asked else "add size = [width, height] in m, or hanging_ratio = 0.6"
        )
        yield (*path, "size"), found, "one of size and hanging_ratio", cure


def _frame(path: Path, panel: PanelSpec, netting: NettingSpec | None) -> Iterator[Finding]:
    if netting is None or (panel.given_size is None) == (panel.hanging_ratio is None):
        return
    if netting.mesh == "square" and isinstance(panel.hanging_ratio, float):
        allowed = "[E1, E2] for square mesh, width and height over the stretched ones"
        cure = f"write hanging_ratio = [{panel.hanging_ratio:g}, {panel.hanging_ratio:g}]"
        yield (*path, "hanging_ratio"), f"{panel.hanging_ratio:g}", allowed, cure
        return
    size = panel.sized_for(netting)
    strain = max(flat_strain(netting.mesh, panel.meshes, netting.bar_length, size))
    if strain > LARGEST_STRAIN:
        key = "size" if panel.given_size else "hanging_ratio"
        spread = f"{size[0]:g} m x {size[1]:g} m"
        found = f"{spread}, which strains the bars by {strain * 100:.3g} % before anything acts"
        allowed = f"a frame that the net can span: at most {LARGEST_STRAIN * 100:g} % strain"
        yield (*path, key), found, allowed, "check the units of size and bar_length and the number of meshes"


def _panel_names(parts: Parts) -> Iterator[Finding]:
    seen: dict[str, int] = {}
    for index, keys in parts.panel_tables():
        name = keys.get("name", str(index + 1))
        if not isinstance(name, str):
            continue
        if name in seen:
            found = f"{written(name)}, which is also the name of [[gear]] {seen[name] + 1}"
            yield ("gear", index, "name"), found, "a name of its own for every gear", "choose another name"
        seen.setdefault(name, index)


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
    for panel in parts.panels.values():
        netting = parts.nettings.get(panel.netting)
        twine = parts.twines.get(netting.twine) if netting else None
        if netting and twine and (panel.given_size is None) != (panel.hanging_ratio is None):
            found.add(f"{hung_solidity(panel, netting, twine.diameter):.3g}")
    if len(found) > 1:
        told = f"none, and panels of solidity {' and '.join(sorted(found))}"
        allowed = f'one solidity for the law "{drag.bars.law}" of all bars'
        cure = f'write bars = {{ law = "{drag.bars.law}", solidity = {min(found)} }} with the one that counts'
        yield ("drag", "bars"), told, allowed, cure


def _waves(parts: Parts) -> Iterator[Finding]:
    water = _valid(Water, parts.raw.get("water", {}))
    if water is not None and "waves" in parts.raw:
        yield from wave_findings(parts.raw["waves"], water.depth, water.gravity)
