"""Frame: everything known of a net at one moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """The state of a net and the forces on it at one time.

    time: s; position, velocity: (n, 3) m, m/s; tension: (m,) N, of one real bar: one of grouped netting pulls with
    Net.bar_multiple times as much; 0 where slack, below 0 where a tube pushes; bar_drag: (m,) N, force of the water on
    a bar, all that it stands for, along the water's own velocity there, as seen from what is towed; bar_lift: (m,)
    N, size of the part across it; water_velocity: (m, 3) m/s, of the water at the middle of a bar, waves and shelter
    included; water_force: (n, 3) N, all that moving water does, gathered at the knots, half of every bar and all of a
    knot's own, and the buoyancy that is lost above the surface; hydrodynamic_force: (3,) N, their sum;
    support_reaction: (3,) N, force of the net on its supports, the inertia of held knots that are moved included;
    kinetic_energy: J, added mass included; unbalanced_force: N, largest on a free knot.
    """

    time: float
    position: Array
    velocity: Array
    tension: Array
    bar_drag: Array
    bar_lift: Array
    water_velocity: Array
    water_force: Array
    hydrodynamic_force: Array
    support_reaction: Array
    kinetic_energy: float
    unbalanced_force: float
