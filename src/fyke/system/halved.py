"""The system of a net with half as many meshes each way, which behaves like the real one (netting.halving).

A coarse bar has the stiffness and drag of the bars that lie side by side in it; weight, mass and drag of knots and of
what hangs there go to the coarse knots near by, so that nothing is lost.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..netting.faces import Faces, faces_of
from ..netting.halving import Halved
from ..netting.net import Net
from .elements import Elements
from .system import Displaced, System

Array = NDArray[np.float64]


def halved_system(system: System, small: Halved) -> System:
    """Return the system on the coarse net, which has places, bars and labels; what they are made of is in Elements."""
    el, bars, times, beside = system.elements, small.bars, small.times, small.beside
    share = small.share(system.net)
    a, b = small.ends.T
    rows, first, end = _laws(el, bars, beside)
    elements = el._replace(
        knot_a=np.ascontiguousarray(a, dtype=np.uint32),
        knot_b=np.ascontiguousarray(b, dtype=np.uint32),
        rest_length=times * el.rest_length[bars],
        stiffness=beside / times * el.stiffness[bars],
        damping_time=el.damping_time[bars],
        normal_drag=beside * el.normal_drag[bars],
        tangential_drag=beside * el.tangential_drag[bars],
        bar_added_mass=beside * times * el.bar_added_mass[bars],
        law_rows=rows,
        law_first=first,
        law_end=end,
        knot_drag=share @ el.knot_drag,
        knot_mass=share @ el.knot_mass,
        weight=np.ascontiguousarray(share @ el.weight),
        free=el.free[small.knots],
        two_way=el.two_way[bars],
    )
    net = _net(system.net, small, elements)
    displaced = Displaced(beside * times * system.displaced.bar[bars], share @ system.displaced.knot)
    return replace(
        system,
        net=net,
        elements=elements,
        displaced=displaced,
        drag_laws=system.drag_laws and system.drag_laws.of(bars, small.knots),
        faces=None if system.faces is None else _faces(net, system.faces),
        sources=(),
        case_text="",
    )


def _laws(
    el: Elements, bars: NDArray[np.int64], beside: Array
) -> tuple[Array, NDArray[np.int32], NDArray[np.int32]]:
    """Rows of the laws for every number of bars side by side, and where those of each coarse bar begin and end."""
    numbers, which = np.unique(beside, return_inverse=True)
    rows = np.concatenate([el.law_rows * np.array([1.0, one, one, one, 1.0]) for one in numbers])
    offset = (which.ravel() * len(el.law_rows)).astype(np.int32)
    return rows, el.law_first[bars] + offset, el.law_end[bars] + offset


def _net(net: Net, small: Halved, elements: Elements) -> Net:
    knots, bars = small.knots, small.bars
    return replace(
        net,
        positions=net.positions[knots],
        labels=tuple(net.labels[knot] for knot in knots.tolist()),
        fixed=net.fixed[knots],
        bars=small.ends,
        rest_length=elements.rest_length,
        twine_of_bar=net.twine_of_bar[bars],
        knot_diameter=net.knot_diameter[knots],
        knot_density=net.knot_density[knots],
        load=net.load[knots],
        bar_multiple=net.bar_multiple[bars],
        knot_multiple=net.knot_multiple[knots],
        panels=tuple(
            replace(one.panel, meshes=one.coarse.meshes, knots=one.knots, bars=one.bars[:, None])
            for one in small.sheets
        ),
        ropes=small.ropes,
        bodies=(),
    )


def _faces(net: Net, fine: Faces) -> Faces:
    """Faces of the coarse net; the bars and twines of it are not what makes their solidity."""
    faces = faces_of(net)
    solidity, diameter = np.empty(faces.count), np.empty(faces.count)
    for panel in np.unique(faces.panel):
        own, real = faces.panel == panel, fine.panel == panel
        solidity[own], diameter[own] = fine.solidity[real].mean(), fine.diameter[real][0]
    return replace(faces, solidity=solidity, diameter=diameter)
