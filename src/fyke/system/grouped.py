"""The system of a panel with grouped meshes: larger meshes on the same frame that behave like the many.

n x n meshes in one: a bar n times as long has the stiffness EA of n bars side by side, their drag n d, and the weight,
buoyancy and mass of n^2 bars; a knot has the drag area, weight and mass of n^2 knots. A face has the solidity and the
twine of those it stands for.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..netting.faces import Faces, faces_of
from ..netting.grouping import Grid, carry, nearest
from ..netting.net import Net
from .elements import Elements
from .system import Displaced, System

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def grouped(system: System, fine: Grid, coarse: Grid) -> System:
    """Return the system with the meshes of the coarse grid in place of the fine grid's, which is the system's own.

    Masses and loads of a net that varies from knot to knot are those of the nearest knots. The coarse net holds
    places, bars and labels; what its bars and knots are made of is in the elements alone.
    """
    net, el = system.net, system.elements
    knots = nearest(fine.knots, coarse.knots)
    bars = np.empty(len(coarse.lattice.bars), dtype=np.int64)
    longer = np.empty(len(bars))
    many = np.array(fine.lattice.intervals) / np.array(coarse.lattice.intervals)
    for which in (0, 1):
        own = fine.bars[which][nearest(fine.directions[which], coarse.directions[which])]
        bars[coarse.bars[which]] = own
        longer[coarse.bars[which]] = _longer(net, fine, many, which)
    side = float(np.sqrt(many.prod()))
    a, b = coarse.lattice.bars.T
    elements = Elements(
        knot_a=np.ascontiguousarray(a, dtype=np.uint32),
        knot_b=np.ascontiguousarray(b, dtype=np.uint32),
        rest_length=longer * el.rest_length[bars],
        stiffness=side / longer * el.stiffness[bars],
        damping_time=el.damping_time[bars],
        normal_drag=side * el.normal_drag[bars],
        tangential_drag=side * el.tangential_drag[bars],
        bar_added_mass=side * longer * el.bar_added_mass[bars],
        law_rows=el.law_rows * np.array([1.0, side, side, side, 1.0]),
        law_first=el.law_first[bars],
        law_end=el.law_end[bars],
        linear=el.linear,
        damped=el.damped,
        knot_drag=side**2 * el.knot_drag[knots],
        knot_mass=side**2 * el.knot_mass[knots],
        weight=side**2 * el.weight[knots],
        free=el.free[knots],
        drag_slopes=el.drag_slopes,
        knot_slopes=el.knot_slopes,
        two_way=el.two_way[bars],
    )
    displaced = Displaced(side * longer * system.displaced.bar[bars], side**2 * system.displaced.knot[knots])
    small = _net(net, fine, coarse, knots, bars, elements)
    return replace(
        system,
        net=small,
        elements=elements,
        displaced=displaced,
        drag_laws=system.drag_laws and system.drag_laws.of(bars, knots),
        motion=None,
        faces=None if system.faces is None else _faces(small, system.faces),
        sources=(),
        case_text="",
    )


def _faces(net: Net, fine: Faces) -> Faces:
    """Faces of the coarse net; the bars and twines of it are not what makes their solidity."""
    faces = faces_of(net)
    ones = np.ones(faces.count)
    return replace(faces, solidity=fine.solidity.mean() * ones, diameter=fine.diameter[0] * ones)


def _longer(net: Net, fine: Grid, many: Array, which: int) -> float:
    """How many times as long the bars of a direction become, so that flat netting keeps its strain."""
    if fine.mesh == "square":
        return float(many[which])
    spacing = np.array(net.panels[0].size) / np.array(fine.lattice.intervals)
    return float(np.linalg.norm(many * spacing) / np.linalg.norm(spacing))


def _net(net: Net, fine: Grid, coarse: Grid, knots: Indices, bars: Indices, elements: Elements) -> Net:
    panel = net.panels[0]
    n, m = len(knots), len(bars)
    return replace(
        net,
        positions=carry(net.positions, fine.knots, coarse.knots, 1),
        labels=tuple(f"{i}-{j}" for i, j in coarse.lattice.knots.tolist()),
        fixed=elements.free == 0.0,
        bars=coarse.lattice.bars,
        rest_length=elements.rest_length,
        twine_of_bar=net.twine_of_bar[bars],
        knot_diameter=net.knot_diameter[knots],
        knot_density=net.knot_density[knots],
        load=net.load[knots],
        bodies=(),
        panels=(replace(panel, meshes=coarse.meshes, knots=np.arange(n), bars=np.arange(m)[:, None]),),
    )
