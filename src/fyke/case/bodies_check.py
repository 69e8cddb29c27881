"""What floats and sinkers are, and whether they float and sink."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, pi
from typing import TYPE_CHECKING

from .places import Path
from .rigging import BodiesSpec, SinkersSpec

if TYPE_CHECKING:
    from .check import Finding
    from .schema import Water

_LARGEST_BODY = 100.0  # m; a larger one is a slip of the pen
_KIND_OF_FORCE = {"sinkers": ("weight", '"5 N"', "7850.0"), "floats": ("buoyancy", '"5 N"', "200.0")}


def body_findings(path: Path, bodies: BodiesSpec, water: Water | None) -> Iterator[Finding]:
    """What floats and sinkers are, and whether they float and sink."""
    force, example, density = _KIND_OF_FORCE[bodies.kind]
    values = {
        force: bodies.force,
        "density": bodies.density,
        "mass": bodies.mass,
        "diameter": bodies.diameter,
    }
    given = [key for key, value in values.items() if value is not None]
    if given not in ([force, "density"], ["mass", "diameter"]):
        found = " and ".join(given) if given else "nothing of these"
        allowed = f"{force} (N in water) and density of each one, or mass and diameter"
        cure = f"write {force} = {example} and density = {density}, or mass and diameter"
        yield (*path, given[0] if given else force), f"{found} in {bodies.kind}", allowed, cure
        return
    if water is None:
        return
    sinks = isinstance(bodies, SinkersSpec)
    if bodies.density is not None:
        key, own = "density", bodies.density
    else:
        volume = pi / 6.0 * (bodies.diameter or 0.0) ** 3
        key, own = "mass", (bodies.mass or 0.0) / volume if volume > 0.0 else inf
    if (own <= water.density) if sinks else (own >= water.density):
        found = f"{own:g} kg/m3, which {'does not sink' if sinks else 'does not float'}"
        allowed = (
            f"{'above' if sinks else 'below'} the {water.density:g} kg/m3 of the water for {bodies.kind}"
        )
        other = "floats" if sinks else "sinkers"
        cure = f'check the units of {", ".join(given)}, or write kind = "{other}"'
        yield (*path, key), found, allowed, cure
    elif bodies.density is not None:
        yield from _of_force((*path, force), bodies, water)


def _of_force(path: Path, bodies: BodiesSpec, water: Water) -> Iterator[Finding]:
    if water.gravity == 0.0:
        found = f"{bodies.force:g} N without gravity"
        yield path, found, "[water] gravity above 0 for a force in water", "give mass and diameter instead"
        return
    try:
        diameter = bodies.sphere(water.density, water.gravity).diameter
    except (OverflowError, ZeroDivisionError):
        diameter = inf
    if not diameter <= _LARGEST_BODY:
        found = f"{bodies.force:g} N at {bodies.density:g} kg/m3, a sphere of {diameter:.3g} m"
        allowed = f"a body of at most {_LARGEST_BODY:g} m"
        yield path, found, allowed, "check its unit; the density may be too near that of the water"
