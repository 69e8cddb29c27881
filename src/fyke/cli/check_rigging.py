"""What `fyke check` tells of seams, ropes, rings, collars, floats and sinkers."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from ..case import Case
from ..netting.lattice import Corner, Side
from ..netting.net import Rope
from ..netting.twine import Twine
from ..system.system import System
from .show import percent, quantity

ROUNDING = 1e-9  # of a strain


def seams_of(case: Case) -> list[dict[str, Any]]:
    """Return the seams of a case, ready for JSON; knots: of either edge, each once."""
    sheets = {sheet.name: (netting, sheet) for netting, sheet in case.sheets}
    out = []
    for seam in case.seams:
        knots = []
        for edge in seam.join:
            name, _, side = edge.rpartition(".")
            netting, sheet = sheets[name]
            knots.append(sheet.edge(cast("Side | Corner", side), netting.mesh)[0])
        out.append({"name": seam.name, "join": list(seam.join), "knots": knots, "take_up": seam.take_up})
    return out


def seam_rows(seam: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what is shown of a seam."""
    take_up = seam["take_up"]
    return [
        *((edge, f"{count} knots") for edge, count in zip(seam["join"], seam["knots"], strict=True)),
        *([("take-up", f"{take_up:.4g}")] if take_up is not None else []),
    ]


def ropes_of(case: Case, system: System) -> list[dict[str, Any]]:
    """Return the ropes of a case, ready for JSON.

    length: unloaded, m; built: m, of the edge it follows; strain: of the rope as built, negative slack; stiffness: EA,
    N, the secant at a strain of 1 %; weight_in_water: N, negative floats.
    """
    return [
        _rope(system, rope.knots, rope.bars) | {"name": spec.name, "twine": spec.twine, "along": spec.along}
        for spec, rope in zip(case.ropes, _of_kind(system, "rope"), strict=True)
    ]


def tubes_of(case: Case, system: System) -> list[dict[str, Any]]:
    """Return the rings and collars of a case, ready for JSON.

    tubes: side by side; diameter, wall: m, of each; length: m, of each; radius: m, of the circle as long as it where it
    closes, None where it does not; bent_stress: Pa, where a straight tube was bent to this; mass: kg, weight: N, in
    air, buoyancy: N, under water, of all; weight_in_water: N, negative floats; axial_stiffness: EA, N, and
    bending_stiffness: EI, N m2, of each.
    """
    specs = {part.name: part for part in case.tubulars}
    made = [rope for rope in system.net.ropes if rope.kind in ("ring", "collar")]
    return [
        _tube(system, rope) | {"tube": specs[rope.name].tube, "along": specs[rope.name].along}
        for rope in made
    ]


def _tube(system: System, rope: Rope) -> dict[str, Any]:
    net, water = system.net, system.water
    twine, many = net.twines[net.twine_of_bar[rope.bars[0]]], float(net.bar_multiple[rope.bars[0]])
    length = float(net.rest_length[rope.bars].sum())
    mass, volume = twine.mass_per_length * length * many, twine.fibre_area * length * many
    return {
        "name": rope.name,
        "kind": rope.kind,
        "tubes": round(many),
        "bars": len(rope.bars),
        "diameter": twine.diameter,
        "wall": twine.wall,
        "length": length,
        "radius": 0.5 * length / np.pi if rope.knots[0] == rope.knots[-1] else None,
        "bent_stress": _bent(twine, length) if rope.knots[0] == rope.knots[-1] else None,
        "flooded": twine.linear_density is not None,
        "mass": mass,
        "weight": water.gravity * mass,
        "buoyancy": water.gravity * water.density * volume,
        "weight_in_water": water.gravity * (mass - water.density * volume),
        "axial_stiffness": float(system.elements.stiffness[rope.bars[0]] * net.rest_length[rope.bars[0]])
        / many,
        "bending_stiffness": twine.bending_stiffness,
    }


def _bent(twine: Twine, length: float) -> float:
    """Stress (Pa) in the outermost fibre of a straight tube that is bent to a circle of this length (m), E d/2R."""
    inner = twine.diameter - 2.0 * twine.wall
    second_moment = np.pi / 64.0 * (twine.diameter**4 - inner**4)
    return float(twine.bending_stiffness / second_moment * np.pi * twine.diameter / length)


def _bent_words(stress: float) -> str:
    return f"{quantity(1e-6 * stress, 'MPa')} at first, where it was straight before; not in the results"


def tube_rows(tube: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what is shown of a ring or a collar."""
    many = f"{tube['tubes']} tubes" if tube["tubes"] > 1 else "one tube"
    filled = "full of water" if tube["flooded"] else "full of air"
    round_ = "" if tube["radius"] is None else f", {quantity(2.0 * tube['radius'], 'm')} across"
    stiff = f"EA {quantity(tube['axial_stiffness'], 'N')}, EI {quantity(tube['bending_stiffness'], 'N m2')}"
    return [
        ("along", f"{tube['along'] or 'no edge'}, {tube['bars']} bars"),
        ("tubes", f"{many}, {tube['diameter'] * 1e3:.4g} x {tube['wall'] * 1e3:.4g} mm, {filled}"),
        ("length", quantity(tube["length"], "m") + round_),
        ("of each", stiff),
        *([] if tube["bent_stress"] is None else [("bent to this", _bent_words(tube["bent_stress"]))]),
        (
            "weight in air",
            f"{quantity(tube['weight'], 'N')}, lifts at most {quantity(tube['buoyancy'], 'N')}",
        ),
        ("weight in water", _weight(tube["weight_in_water"])),
    ]


def _of_kind(system: System, kind: str) -> list[Rope]:
    return [rope for rope in system.net.ropes if rope.kind == kind]


def _rope(system: System, knots: Any, bars: Any) -> dict[str, Any]:
    net, water = system.net, system.water
    rest, twine = net.rest_length[bars], net.twines[net.twine_of_bar[bars[0]]]
    length = float(rest.sum())
    built = float(np.linalg.norm(np.diff(net.positions[knots], axis=0), axis=1).sum())
    return {
        "bars": len(bars),
        "diameter": twine.diameter,
        "length": length,
        "built": built,
        "strain": built / length - 1.0,
        "stiffness": float(system.elements.stiffness[bars[0]] * rest[0]),
        "weight_in_water": water.gravity
        * (twine.soaked_density(water.density) - water.density)
        * twine.area
        * length,
    }


def bodies_of(case: Case, system: System) -> list[dict[str, Any]]:
    """Return the floats and sinkers of a case, ready for JSON; weight_in_water: N of each one, negative floats."""
    water, out = system.water, []
    for spec, bodies in zip(case.bodies, system.net.bodies, strict=True):
        each = water.gravity * (bodies.mass - water.density * bodies.volume)
        out.append(
            {
                "name": bodies.name,
                "kind": spec.kind,
                "where": spec.along if spec.along is not None else list(spec.at or ()),
                "count": len(bodies.knots),
                "mass": bodies.mass,
                "diameter": bodies.diameter,
                "weight_in_water": each,
                "total_weight": each * len(bodies.knots),
                "drag_area": bodies.drag_area,
            }
        )
    return out


def rope_rows(rope: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what is shown of a rope."""
    state = "slack" if rope["strain"] < -ROUNDING else "taut"
    return [
        ("along", f"{rope['along']}, {rope['bars']} bars"),
        (
            "length",
            f"{quantity(rope['length'], 'm')}, strain as built {percent(rope['strain'])} ({state})",
        ),
        ("diameter", quantity(rope["diameter"] * 1e3, "mm")),
        ("EA", quantity(rope["stiffness"], "N")),
        ("weight in water", _weight(rope["weight_in_water"])),
    ]


def body_rows(bodies: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what is shown of floats or sinkers."""
    where = bodies["where"]
    return [
        ("at", where if isinstance(where, str) else ", ".join(where)),
        ("count", f"{bodies['count']}"),
        ("each", f"{quantity(bodies['mass'], 'kg')}, {quantity(bodies['diameter'] * 1e3, 'mm')} across"),
        ("weight in water", f"{_weight(bodies['weight_in_water'])} each"),
        ("all together", _weight(bodies["total_weight"])),
    ]


def _weight(value: float) -> str:
    return f"{quantity(value, 'N')} ({'sinks' if value >= 0.0 else 'floats'})"
