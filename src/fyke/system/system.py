"""System and State: what the forces and solvers work on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..netting.faces import Faces
from ..netting.net import Net
from ..water.bed import Bed
from ..water.current import Current
from ..water.waves import Waves
from .elements import DragLaws, Elements
from .laws import Coefficients, Water
from .motion import Motion

Array = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """Time (s), position (n, 3) m, velocity (n, 3) m/s.

    tension: (m,) N where a method knows it better than the elastic law does from positions that it does not resolve to
    the nanometre, of all real bars that a bar stands for together; None to take the law.
    """

    time: float
    position: Array
    velocity: Array
    tension: Array | None = None


@dataclass(frozen=True)
class Displaced:
    """Mass of the water that a net displaces: bar: (m,) kg, half of a bar, for each end; knot: (n,) kg, of a knot."""

    bar: Array
    knot: Array


@dataclass(frozen=True)
class System:
    """A net in water, frozen: the net, the water around it and the arrays of the kernels.

    weight_in_water: weight less buoyancy of bars and knots, N, positive when it sinks; drag_laws: None where all
    coefficients of drag are constant; surface: what rises above the surface is dry, else water is everywhere; faces:
    the meshes of its netting where screens or shelter ask for them, else None; bed: the ground that bears knots, None
    for water without one; motion: of held knots that move, None where all rest; sources: one line for each law, with
    what it says and where it comes from; case_text: the case file behind it, "" when made in Python.
    """

    net: Net
    current: Current
    elements: Elements
    weight_in_water: float
    water: Water
    coefficients: Coefficients
    displaced: Displaced
    drag_laws: DragLaws | None = None
    waves: Waves | None = None
    surface: bool = False
    faces: Faces | None = None
    bed: Bed | None = None
    motion: Motion | None = None
    sources: tuple[str, ...] = ()
    case_text: str = ""

    def resting(self) -> System:
        """Return the system as statics takes it: no waves, no motion, friction from where the net was laid."""
        bed = self.bed and replace(self.bed, laid=self.net.positions[:, :2])
        return replace(self, waves=None, motion=None, bed=bed)

    def at_rest(self) -> State:
        """Return the state that the net was built in, at time 0, at rest but for held knots that move."""
        state = State(0.0, self.net.positions.copy(), np.zeros_like(self.net.positions))
        if self.motion is not None:
            self.motion.carry(state.position, state.velocity, 0.0)
        return state
