"""The sea bed: flat ground that bears what lies on it and rubs on what moves over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Stiffness and damping of the ground that MoorDyn takes for mooring lines, Pa/m and Pa s/m (read in its code and in
# input files of others). A rod lies in it by w / (stiffness d), w its weight per length: steel 1.7 % of its diameter.
STIFFNESS, DAMPING = 3.0e6, 3.0e5
# Friction of chain: OrcaFlex's page "Chain" says 0.4 to 0.8 depending on the sea bed. Of netting none was found.
FRICTION = 0.5
# Over the diameter: depth over which the ground begins to bear, and slip at which 0.7 of the friction is there.
SOFT = 0.1
CREEP = 1e-2  # m/s, at which 0.7 of the friction is there; steps of rtol 1e-2 chatter at 1e-3


@dataclass(frozen=True)
class Bed:
    """Flat ground at z = -depth (m).

    stiffness: Pa per metre of sinking in, on diameter x length of bars and on the disc of knots and bodies; damping:
    Pa s/m, of what sinks in; friction: coefficient of Coulomb; laid: (n, 2) m, where statics takes the knots to have
    been laid, from which friction holds them; None: friction goes by the velocity.
    """

    depth: float
    stiffness: float = STIFFNESS
    damping: float = DAMPING
    friction: float = FRICTION
    laid: Array | None = None

    def __post_init__(self) -> None:
        """Refuse what is no ground."""
        if not (
            np.isfinite(self.depth) and self.stiffness > 0.0 and self.damping >= 0.0 and self.friction >= 0.0
        ):
            raise ValueError(
                f"a bed {self.depth:g} m down of {self.stiffness:g} Pa/m, {self.damping:g} Pa s/m and friction "
                f"{self.friction:g}: the stiffness must be above 0, the others not below"
            )

    @property
    def told(self) -> str:
        """One line with the figures and where they come from."""
        usual = (self.stiffness, self.damping) == (STIFFNESS, DAMPING)
        source = "those of MoorDyn, a public code" if usual else "as given"
        return (
            f"sea bed: {self.stiffness:g} Pa/m, {self.damping:g} Pa s/m, {source}; friction {self.friction:g} "
            "(OrcaFlex's help, read: 0.4 to 0.8 of chain)"
        )
