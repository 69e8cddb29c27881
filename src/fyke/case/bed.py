"""The sea bed in the case file; how deep it is stands in [water]."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ..water.bed import DAMPING, FRICTION, STIFFNESS, Bed
from .fields import Table
from .quantity import Quantity

MOST_STIFF = 1e12


class BedSpec(Table):
    """Flat ground that bears what comes down to it."""

    friction: Annotated[float, Quantity(None, 0.0, 10.0)] = Field(
        default=FRICTION, description="coefficient of Coulomb, of all that lies on it"
    )
    stiffness: Annotated[float, Quantity(None, 0.0, MOST_STIFF, open_below=True)] = Field(
        default=STIFFNESS, description="Pa per metre of sinking in, on diameter x length"
    )
    damping: Annotated[float, Quantity(None, 0.0, MOST_STIFF)] = Field(
        default=DAMPING, description="Pa s/m, of what sinks in"
    )

    def ground(self, depth: float) -> Bed:
        """Return the bed at a depth (m)."""
        return Bed(depth, self.stiffness, self.damping, self.friction)
