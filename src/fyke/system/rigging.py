"""Ropes, rings, collars, floats and sinkers of a case on its netting."""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from ..case.rigging import BodiesSpec
from ..case.schema import Case
from ..case.tubes import CollarSpec, RingSpec
from ..netting.joining import sewn
from ..netting.lattice import Corner, Side
from ..netting.net import Net, Panel
from ..netting.rigging import evenly, with_bodies, with_rope
from ..netting.tubes import ring, with_tubes

Indices = NDArray[np.int64]


def rigged(net: Net, case: Case) -> Net:
    """Return the netting of a case with its seams, ropes, rings and collars, then floats and sinkers, by the file."""
    twines, tubes = case.twines, case.tubes
    for seam in case.seams:
        net = sewn(net, *(cast("tuple[str, Side | Corner]", one.rpartition(".")[::2]) for one in seam.join))
    for rope in case.ropes:
        panel, side = _edge(net, rope.along)
        net = with_rope(net, panel.edge(side), twines[rope.twine], length=rope.length, name=rope.name)
    for part in case.tubulars:
        if part.along is not None:
            panel, side = _edge(net, part.along)
            twine = part.made(tubes).twine(part.tube)
            free = isinstance(part, CollarSpec)
            net = with_tubes(
                net, panel.edge(side), twine, tubes=part.tubes, name=part.name, kind=part.kind, free=free
            )
    for bodies in case.bodies:
        sphere = bodies.sphere(case.water.density, case.water.gravity)
        kind = bodies.kind.removesuffix("s")
        net = with_bodies(net, sphere.at(_places(net, bodies), name=bodies.name, kind=kind))
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


def _labelled(net: Net, label: str) -> int:
    """Return the knot of a label "NAME:i-j", which it may have lost to another knot in a seam.

    Of grouped netting it is the one nearest to this knot of the real netting.
    """
    name, _, place = label.rpartition(":")
    panel = next(panel for panel in net.panels if panel.name == name)
    i, j = map(int, place.split("-"))
    if panel.grouped_from:
        away = panel.flat - panel.real_place(i, j)
        return int(panel.knots[np.argmin(np.einsum("kq,kq->k", away, away))])
    return int(panel.knots[(panel.lattice.knots == (i, j)).all(axis=1)][0])


def _places(net: Net, bodies: BodiesSpec) -> Indices:
    """Return the knots at which floats or sinkers are."""
    if bodies.along is None:
        return np.array([_labelled(net, label) for label in bodies.at or ()], dtype=np.int64)
    panel, side = _edge(net, bodies.along)
    knots = panel.edge(side)
    if np.all(knots == knots[0]):
        return knots[:1]  # the tip of a cone
    axis = 0 if side in ("top", "bottom") else 1
    closed = panel.closed and axis == 0
    # As many as hang on the real edge, each at the nearest knot that there is.
    real = round((len(knots) - 1) * panel.group[axis]) + (not closed)
    return evenly(knots, bodies.count or real, closed=closed, real=real)
