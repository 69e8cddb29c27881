"""A towed net as it is seen from the carriage that tows it: held at rest in water that comes towards it.

All forces of the water depend on velocities against each other alone, so that the equilibrium of a steady tow is that
of the same net at rest in the current less the velocity of the tow (Galileo).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..water.current import RelativeCurrent
from .courses import Steady
from .motion import Motion
from .system import System


def seen_from_the_carriage(system: System) -> System:
    """Return the system with its steady tow made a current against it, other moves kept; itself without a tow.

    ValueError where held knots are towed at different velocities, or some are not, so that nothing comes to rest.
    """
    motion = system.motion
    if motion is None or not motion.tows:
        return system
    speeds = np.zeros((system.net.knot_count, 3))
    for move in motion.moves:
        for shift in move.shifts:
            if isinstance(shift, Steady):
                speeds[move.knots] += shift.rate
    held = speeds[system.net.fixed]
    if np.ptp(held, axis=0).any():
        raise ValueError(
            "held knots are towed at different velocities, or only some of them: there is no equilibrium"
        )
    rest = [
        replace(move, shifts=tuple(one for one in move.shifts if not isinstance(one, Steady)))
        for move in motion.moves
    ]
    rest = [move for move in rest if move.courses]
    return replace(
        system,
        current=RelativeCurrent(system.current, tuple(held[0].tolist())),
        motion=Motion(system.net, rest) if rest else None,
    )
