"""What `fyke check` tells of seams, ropes, floats and sinkers."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from ..case import Case
from ..netting.lattice import Corner, Side
from ..system.system import System
from .show import quantity

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
        for spec, rope in zip(
            case.ropes, (one for one in system.net.ropes if one.kind == "rope"), strict=True
        )
    ]


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
            f"{quantity(rope['length'], 'm')}, strain as built {rope['strain'] * 100:.2f} % ({state})",
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
