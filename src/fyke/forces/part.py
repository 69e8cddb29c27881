"""Part: a force on knots besides those of bars, knots and screens, as the implicit methods and statics ask for it.

What has such a force is data of the System; parts_of makes of it what acts.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..system.system import System
from .bed import OnBed
from .bending import Bending

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Part(Protocol):
    """Something that acts on knots.

    groups: (p, q) knots that act on each other, those of the blocks in its tangents; q = 1 for forces on one knot each.
    """

    @property
    def groups(self) -> Places:
        """Knots (p, q) that act on each other."""

    def see(self, x: Array, v: Array, time: float) -> None:
        """Take up positions x (n, 3) m, z = 0 still water, velocities v (n, 3) m/s and a time (s)."""

    def add_load(self, out: Array) -> None:
        """Add the force on the knots as it was last seen to out (n, 3) N."""

    def assemble(
        self, c0: float, c1: float, places: tuple[Places, Places], *, symmetric: bool, data: Array
    ) -> None:
        """Add c0 (-dF/dx) + c1 (-dF/dv) as it was last seen to the data of a sparse matrix.

        places: start (p, q, q) and stride (p, q) of the blocks of the groups, rows before columns, as in
        solve.pattern.Pattern; symmetric: add the symmetric part alone.
        """


def parts_of(system: System) -> tuple[Part, ...]:
    """Return what acts on the knots of a system besides bars, knots and screens."""
    bending = Bending.of(system.net)
    return (
        *(() if system.bed is None else (OnBed(system, system.bed),)),
        *(() if bending is None else (bending,)),
    )


def only_implicit(system: System) -> str:
    """Say what of a system only statics and implicit methods can do, "" where there is nothing."""
    if system.coefficients.screens is not None:
        return "screens need"
    if system.motion is not None:
        return "knots that are moved need"
    if system.bed is not None:
        return "a sea bed needs"
    if system.elements.two_way.any():
        return "tubes need"
    if Bending.of(system.net) is not None:
        return "ropes that resist bending need"
    return ""
