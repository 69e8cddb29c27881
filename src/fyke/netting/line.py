"""A line of bars in a row: a chain, a string, a rope."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .net import Net
from .twine import Twine


def line(
    twine: Twine,
    points: ArrayLike,
    rest_length: ArrayLike,
    *,
    fixed: tuple[int, ...] = (0, -1),
    load: ArrayLike = 0.0,
    knot_diameter: ArrayLike = 0.0,
    knot_density: ArrayLike | None = None,
) -> Net:
    """Join points by bars in a row.

    points: (n, 3) m; rest_length: one value or (n - 1,) m; fixed: indices of the held points; load: dead load, one
    value, (3,) or (n, 3) N; knot_diameter: one value or (n,) m; knot_density: kg/m3, the twine's when left out.
    Points are labelled "0" .. "n-1".
    """
    where = np.array(points, dtype=float)
    n = len(where)
    held = np.zeros(n, dtype=bool)
    held[list(fixed)] = True
    density = twine.density if knot_density is None else knot_density
    return Net(
        positions=where,
        labels=tuple(str(i) for i in range(n)),
        fixed=held,
        bars=np.column_stack([np.arange(n - 1), np.arange(1, n)]),
        rest_length=np.broadcast_to(np.asarray(rest_length, dtype=float), n - 1).copy(),
        twines=(twine,),
        twine_of_bar=np.zeros(n - 1, dtype=np.int64),
        knot_diameter=np.broadcast_to(np.asarray(knot_diameter, dtype=float), n).copy(),
        knot_density=np.broadcast_to(np.asarray(density, dtype=float), n).copy(),
        load=np.broadcast_to(np.asarray(load, dtype=float), (n, 3)).copy(),
    )
