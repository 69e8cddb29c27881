"""A panel of netting with fewer meshes on the same frame, from the panel itself: the net of a nested start.

What its bars and knots stand for follows from netting.multiples, as of a panel that is laid with grouped meshes. What
varies from knot to knot and from bar to bar is that of the nearest ones.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .grouping import Grid, carry, nearest
from .multiples import bar_multiples, knot_multiples, real_indices
from .net import Net

Array = NDArray[np.float64]


def coarser(net: Net, fine: Grid, coarse: Grid) -> Net:
    """Return the net with the meshes of the coarse grid in place of the fine grid's, which is the net's own.

    Floats and sinkers go to the nearest knots, as many as there are.
    """
    panel = net.panels[0]
    knots = nearest(fine.knots, coarse.knots)
    bars = np.empty(len(coarse.lattice.bars), dtype=np.int64)
    for which in (0, 1):
        own = fine.bars[which][nearest(fine.directions[which], coarse.directions[which])]
        bars[coarse.bars[which]] = own
    real = panel.real_meshes
    many, had = ((real[0] / meshes[0], real[1] / meshes[1]) for meshes in (coarse.meshes, fine.meshes))
    side_by_side, longer = bar_multiples(coarse.lattice, fine.mesh, many, panel.size, closed=False)
    _, long_already = bar_multiples(fine.lattice, fine.mesh, had, panel.size, closed=False)
    stands_for = knot_multiples(coarse.lattice, many, closed=False, tip=False)
    share = stands_for / net.knot_multiple[knots]
    lead = panel.name + ":" if panel.name else ""
    places = real_indices(coarse.knots.at, fine.mesh, many)
    to = nearest(coarse.knots, fine.knots)
    return replace(
        net,
        positions=carry(net.positions, fine.knots, coarse.knots, 1),
        labels=tuple(f"{lead}{i}-{j}" for i, j in places.tolist()),
        fixed=net.fixed[knots],
        bars=coarse.lattice.bars,
        rest_length=net.rest_length[bars] * longer / long_already[bars],
        twine_of_bar=net.twine_of_bar[bars],
        knot_diameter=net.knot_diameter[knots],
        knot_density=net.knot_density[knots],
        load=net.load[knots] * share[:, None],
        bodies=tuple(replace(one, knots=to[one.knots]) for one in net.bodies),
        panels=(
            replace(
                panel,
                meshes=coarse.meshes,
                knots=np.arange(len(knots)),
                bars=np.arange(len(bars))[:, None],
                grouped_from=real,
            ),
        ),
        bar_multiple=side_by_side,
        knot_multiple=stands_for,
    )
