"""What must hold between the keys of twines and materials, and between twine and netting."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import TYPE_CHECKING, Any

from ..netting.twine import LEAD, MATERIALS, PACKING, diameter_of
from .gear import NettingSpec
from .gear_check import reference
from .keys import nearest
from .places import Path
from .twine import TableSpec, TwineSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts


def twine_findings(parts: Parts) -> Iterator[Finding]:
    """Everything that is wrong between the keys of [twine.NAME], [material.NAME] and [netting.NAME]."""
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
