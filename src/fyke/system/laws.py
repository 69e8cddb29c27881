"""The water around a net, and the laws of its forces."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..water.inertia import AddedMassLaw, ConstantAddedMass
from ..water.laws import BarLaw, KnotLaw
from ..water.laws.bars import ConstantBar
from ..water.laws.knots import ConstantKnot
from ..water.laws.panels import ScreenLaw
from ..water.wakes import TwineLaw, WakeLaw


@dataclass(frozen=True)
class Water:
    """Density (kg/m3), kinematic viscosity (m2/s), gravity (m/s2)."""

    density: float = 1000.0
    kinematic_viscosity: float = 1.0e-6
    gravity: float = 9.81


@dataclass(frozen=True)
class Coefficients:
    """Laws of drag, and added mass over that of the displaced water.

    bars: on the area d x current length, normal and tangential (both; no pi); knots: on pi/4 d_k^2; screens: of whole
    meshes on their outline, in place of the drag of bars and knots of netting; added_mass_bar: normal to the bar only;
    wake, twines: shelter behind netting and between the twines of it.
    Defaults: Bessonneau & Marichal 1998 for the bars, potential flow for the added masses (cylinder 1, sphere 1/2).
    """

    bars: BarLaw = field(default_factory=ConstantBar)
    knots: KnotLaw = field(default_factory=ConstantKnot)
    screens: ScreenLaw | None = None
    added_mass_bar: float | AddedMassLaw = 1.0
    added_mass_knot: float = 0.5
    wake: WakeLaw | None = None
    twines: TwineLaw | None = None

    @property
    def bar_mass(self) -> AddedMassLaw:
        """Law of the added mass across a bar."""
        given = self.added_mass_bar
        return given if isinstance(given, AddedMassLaw) else ConstantAddedMass(given)
