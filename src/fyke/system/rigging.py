"""Ropes, rings, collars and lines, floats and sinkers of a case on its netting."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, sin
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ..case.lines import MooringsSpec
from ..case.rigging import BodiesSpec
from ..case.schema import Case
from ..case.tubes import CollarSpec, RingSpec
from ..netting.joining import once, sewn
from ..netting.lattice import Corner, Side
from ..netting.net import Net, Panel
from ..netting.references import knot_at, real_step, row_of
from ..netting.rigging import evenly, with_bodies, with_rope
from ..netting.tubes import ring, with_tubes
from .lines import with_lines

Indices = NDArray[np.int64]


def rigged(netting: Net | None, case: Case) -> Net:
    """Return the netting of a case, if any, with its ropes, rings and collars, lines, then floats and sinkers.

    ValueError for a case without netting, rings and lines, which a checked case has.
    """
    net = with_lines(_roped(netting, case), case)
    if net is None:
        raise ValueError("the case has neither netting nor lines")
    for bodies in case.bodies:
        sphere = bodies.sphere(case.water.density, case.water.gravity)
        kind = bodies.kind.removesuffix("s")
        net = with_bodies(net, sphere.at(_places(net, bodies, case), name=bodies.name, kind=kind))
    return net


def _roped(net: Net | None, case: Case) -> Net | None:
    """Return the netting of a case with its seams, then its ropes, rings and collars."""
    if net is None:
        return None
    twines, tubes = case.twines, case.tubes
    for seam in case.seams:
        net = sewn(net, *(cast("tuple[str, Side | Corner]", one.rpartition(".")[::2]) for one in seam.join))
    for rope in case.ropes:
        panel, side = _edge(net, rope.along)
        length = rope.length or _real_length(net, panel, side)
        net = with_rope(net, once(panel.edge(side)), twines[rope.twine], length=length, name=rope.name)
    for part in case.tubulars:
        if part.along is not None:
            panel, side = _edge(net, part.along)
            twine = part.made(tubes).twine(part.tube)
            free = isinstance(part, CollarSpec)
            net = with_tubes(
                net,
                once(panel.edge(side)),
                twine,
                tubes=part.tubes,
                name=part.name,
                kind=part.kind,
                free=free,
            )
    return net


def free_rings(case: Case) -> list[Net]:
    """Return the rings of a case that follow no edge, as nets of their own."""
    tubes = case.tubes
    return [
        ring(
            part.made(tubes).twine(part.tube),
            diameter=part.diameter,
            knots=part.knots,
            tubes=part.tubes,
            centre=part.centre,
            name=part.name,
        )
        for part in case.tubulars
        if isinstance(part, RingSpec) and part.diameter and part.knots and part.centre
    ]


def _edge(net: Net, along: str) -> tuple[Panel, Side | Corner]:
    """Return the netting and the edge of it that NAME.EDGE says."""
    name, _, side = along.rpartition(".")
    return next(panel for panel in net.panels if panel.name == name), cast("Side | Corner", side)


def _real_length(net: Net, panel: Panel, side: Side | Corner) -> float:
    """Return the length (m) of an edge as it is built with the real meshes: round an axis, chords of their number."""
    built = float(np.linalg.norm(np.diff(net.positions[panel.edge(side)], axis=0), axis=1).sum())
    few, many = panel.meshes[0], panel.real_meshes[0]
    if few == many or not panel.closed or panel.folds or side not in ("top", "bottom"):
        return built
    return built * (many * sin(pi / many)) / (few * sin(pi / few))


def _places(net: Net, bodies: BodiesSpec, case: Case) -> Indices:
    """Return the knots at which floats or sinkers are."""
    if bodies.along is None:
        return np.array(list(_labelled(net, bodies, case)), dtype=np.int64)
    row = row_of(net, bodies.along)
    if row is None:
        raise ValueError(f"{bodies.called} hang on {bodies.along}, which is not there")
    if np.all(row == row[0]):
        return row[:1]  # the tip of a cone
    closed = bool(row[0] == row[-1])
    # As many as hang on the real edge, each at the nearest knot that there is.
    real = round((len(row) - 1) * real_step(net, bodies.along)) + (not closed)
    length = float(np.linalg.norm(np.diff(net.positions[row], axis=0), axis=1).sum())
    return evenly(row, min(bodies.many(real, length, closed=closed), real), closed=closed, real=real)


def _labelled(net: Net, bodies: BodiesSpec, case: Case) -> Iterator[int]:
    """Yield the knots of their labels, one in every line where moorings are named."""
    moorings = {part.name: part.names(part.name) for part in case.lines if isinstance(part, MooringsSpec)}
    for label in bodies.at or ():
        name, _, place = label.rpartition(":")
        for one in [f"{line}:{place}" for line in moorings.get(name, ())] or [label]:
            knot = knot_at(net, one)
            if knot is None:
                raise ValueError(f"{bodies.called} hang at {one}, which is not there")
            yield knot
