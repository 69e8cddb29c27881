"""What must hold between the keys of tubes, and of the rings and collars that are made of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..netting.tubes import TUBE_MATERIALS
from .keys import nearest
from .places import Path
from .tubes import RingSpec, TubularSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts

_EXPLICIT = ("verner", "symplectic")
_OF_ITS_OWN = ("diameter", "centre", "knots")  # keys of a ring that follows no edge


def tube_findings(parts: Parts) -> Iterator[Finding]:
    """Everything that is wrong between the keys of [tube.NAME]."""
    for name, keys in parts.tables("tube"):
        yield from _material(("tube", name), keys, parts)
    for name, tube in parts.tubes.items():
        if 2.0 * tube.wall >= tube.diameter:
            found = f"{tube.wall * 1e3:g} mm in a tube of {tube.diameter * 1e3:g} mm"
            allowed = f"less than half the diameter, {tube.diameter * 500.0:g} mm"
            yield ("tube", name, "wall"), found, allowed, "check the units of wall and diameter"
    solve = parts.raw.get("solve")
    stepper = solve.get("stepper") if isinstance(solve, dict) else None
    if parts.tubulars and stepper in _EXPLICIT:
        found = f'"{stepper}" with rings or collars, which explicit steps do not know'
        allowed = '"auto", "implicit" or "newmark" with tubes'
        yield ("solve", "stepper"), found, allowed, 'write stepper = "implicit", or leave it out'


def _material(path: Path, keys: dict[str, Any], parts: Parts) -> Iterator[Finding]:
    own = [name for name, _ in parts.tables("material")]
    there = list(dict.fromkeys([*TUBE_MATERIALS, *own]))
    name = keys.get("material")
    if name is not None and name not in there:
        if isinstance(name, str):
            near = nearest(name, there)
            choice = " or ".join(written(one) for one in there)
            cure = f'did you mean "{near}"?' if near else f"choose {choice}, or add a table [material.{name}]"
            yield (*path, "material"), written(name), choice, cure
        return
    given = TUBE_MATERIALS.get(name or "")
    known = {"density": given and given.density, "youngs_modulus": given and given.youngs_modulus}
    if name in own and name in parts.materials:
        known = {key: getattr(parts.materials[name], key) for key in known}
    elif name in own:
        return  # wrong itself, and told
    for key, example in (("density", "958.0"), ("youngs_modulus", '"900 MPa"')):
        if key not in keys and known[key] is None:
            found = f"nothing, and none is known for {name}" if name else f"neither {key} nor material"
            yield (*path, key), found, f"{key} of the wall", f'add {key} = {example}, or material = "HDPE"'


def tubular_findings(path: Path, part: TubularSpec, name: str) -> Iterator[Finding]:
    """What is wrong with the keys of a ring or a collar; name: that it will have."""
    if not isinstance(part, RingSpec):
        return
    called = f"ring '{name}'"
    given = [key for key in _OF_ITS_OWN if getattr(part, key) is not None]
    allowed = "along an edge, or a ring of its own by diameter, centre and knots"
    if part.along is not None and given:
        found = f"{' and '.join(given)} beside along in {called}"
        yield (*path, given[0]), found, allowed, f"leave out {' and '.join(given)}, or along"
    elif part.along is None and len(given) < len(_OF_ITS_OWN):
        found = f"{' and '.join(given) or 'nothing of these'} in {called}"
        missing = {"diameter": '"25 m"', "centre": "[0.0, 0.0, -15.0]", "knots": "48"}
        add = ", ".join(f"{key} = {missing[key]}" for key in _OF_ITS_OWN if key not in given)
        cure = f"add {add}" if given else f'add along = "NAME.bottom", or {add}'
        yield (*path, "along" if not given else given[0]), found, allowed, cure
