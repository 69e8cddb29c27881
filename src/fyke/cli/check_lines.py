"""What `fyke check` tells of lines and the sea bed."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..case import Case
from ..netting.lines import weight_per_metre
from ..netting.net import Rope
from ..system.system import System
from .show import quantity


def lines_of(system: System) -> list[dict[str, Any]]:
    """Return the lines of a net, ready for JSON, as they are laid in still water.

    length: unloaded, m; twines: names, along it; weight_in_water: N, negative floats; apart: m, of its ends; begin,
    end: labels of the knots; tension_from, tension_to: N, of the bars at its ends; on_bed: m, unloaded, that lie on the
    sea bed.
    """
    return [_line(system, rope) for rope in system.net.ropes if rope.kind == "line"]


def _line(system: System, line: Rope) -> dict[str, Any]:
    net, water, x = system.net, system.water, system.net.positions
    rest, ends = net.rest_length[line.bars], net.bars[line.bars]
    length = np.linalg.norm(x[ends[:, 1]] - x[ends[:, 0]], axis=1)
    pull = np.maximum(system.elements.stiffness[line.bars] * (length - rest), 0.0)
    weight = np.array([weight_per_metre(t, water.density, water.gravity) for t in net.twines])
    low = np.zeros(len(rest), dtype=bool)
    if system.bed is not None:
        low = (x[ends, 2] <= -system.bed.depth).all(axis=1)
    return {
        "name": line.name,
        "bars": len(rest),
        "twines": list(dict.fromkeys(net.twines[which].name for which in net.twine_of_bar[line.bars])),
        "length": float(rest.sum()),
        "apart": float(np.linalg.norm(x[line.knots[-1]] - x[line.knots[0]])),
        "begin": net.labels[line.knots[0]],
        "end": net.labels[line.knots[-1]],
        "weight_in_water": float(weight[net.twine_of_bar[line.bars]] @ rest),
        "tension_from": float(pull[0]),
        "tension_to": float(pull[-1]),
        "on_bed": float(rest[low].sum()),
    }


def line_rows(line: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what is shown of a line."""
    sinks = "sinks" if line["weight_in_water"] >= 0.0 else "floats"
    ends = f"{quantity(line['tension_from'], 'N')} at its beginning, {quantity(line['tension_to'], 'N')} at its end"
    return [
        ("from, to", f"{line['begin']}, {line['end']}, {quantity(line['apart'], 'm')} apart"),
        ("length", f"{quantity(line['length'], 'm')} in {line['bars']} bars"),
        ("weight in water", f"{quantity(line['weight_in_water'], 'N')} ({sinks})"),
        ("tension as laid", ends),
        *([("on the sea bed", quantity(line["on_bed"], "m"))] if line["on_bed"] else []),
    ]


def bed_of(case: Case) -> dict[str, Any] | None:
    """Return the sea bed of a case, ready for JSON, None without one."""
    if case.bed is None or case.water.depth is None:
        return None
    return {"depth": case.water.depth, **case.bed.model_dump()}


def bed_words(bed: dict[str, Any]) -> str:
    """Say what the sea bed is."""
    return f"{bed['depth']:g} m down, friction {bed['friction']:g}, {bed['stiffness']:.3g} Pa/m"
