"""Lines of a case, laid between places and the knots of its net."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..case.lines import LaidSpec, LineSpec, MooringsSpec
from ..case.schema import Case
from ..netting.lines import End, LinePiece, length_for, with_line
from ..netting.net import Net
from ..netting.references import around, knot_at, row_of


class Way(NamedTuple):
    """One line to be laid: its ends, a knot or a place each, and whether they are held where they are places."""

    name: str
    begin: End
    end: End
    held: tuple[bool, bool] = (True, True)


def with_lines(net: Net | None, case: Case) -> Net | None:
    """Return the net of a case with its lines; None where there is neither.

    A line that is made fast to another one waits for it. ValueError for one that is made fast to nothing, which a
    checked case does not have.
    """
    waiting: list[LaidSpec] = list(case.lines)
    while waiting:
        ready = {index: ways for index, part in enumerate(waiting) if (ways := _ways(net, part, case))}
        if not ready:
            raise ValueError(f"{waiting[0].called} is made fast to nothing that is there")
        for index, ways in ready.items():
            for way in ways:
                net = _laid(net, waiting[index], way, case)
        waiting = [part for index, part in enumerate(waiting) if index not in ready]
    return net


def _ways(net: Net | None, part: LaidSpec, case: Case) -> list[Way]:
    """The lines of a part; none while the knots that it is made fast to are not there."""
    if isinstance(part, LineSpec):
        begin, end = (_end(net, one) for one in (part.begin, part.end))
        return [] if begin is None or end is None else [Way(part.name, begin, end, part.held)]
    rim = row_of(net, part.around) if net is not None and isinstance(part, MooringsSpec) else None
    if net is None or rim is None or not isinstance(part, MooringsSpec):
        return []
    x, y = net.positions[np.unique(rim), :2].mean(axis=0).tolist()
    knots = around(rim, net.positions, part.bearing, part.count)
    anchors = part.anchors((x, y), case.water.depth or 0.0)
    return [Way(*one) for one in zip(part.names(part.name), anchors, knots.tolist(), strict=True)]


def _end(net: Net | None, told: End | str) -> End | None:
    if not isinstance(told, str):
        return told
    return None if net is None else knot_at(net, told)


def _laid(net: Net | None, part: LaidSpec, way: Way, case: Case) -> Net:
    water, twines = case.water, case.twines
    bed = -water.depth if case.bed is not None and water.depth is not None else None
    if part.pretension is not None and part.twine is not None:
        first, last = (
            np.array(one) if isinstance(one, tuple) or net is None else net.positions[one]
            for one in (way.begin, way.end)
        )
        twine, count = twines[part.twine], part.segments
        length = length_for(
            part.pretension, first, last, twine, count, water=water.density, gravity=water.gravity, bed=bed
        )
        pieces = [LinePiece(twine, length, count)]
    else:
        pieces = part.made(twines)
    return with_line(
        net,
        way.begin,
        way.end,
        pieces,
        name=way.name,
        held=way.held,
        water=water.density,
        gravity=water.gravity,
        bed=bed,
    )
