"""Laws of shelter: what netting leaves of the current behind it and between its own twines, as a factor r from 0 to 1.

The angle is that between a panel's normal and the current, 0 face on (rad); the solidity is that of the netting as it
is stretched. In series the factors multiply.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from .laws.joints import numbers
from .laws.law import Law, Numbers, PanelLaw, Range
from .laws.panels import Loland

_CHENG = (
    "H. Cheng, L. Li, K.G. Aarsaether, M.C. Ong, Typical hydrodynamic models for aquaculture nets: a comparative study "
    "under pure current conditions, Aquacultural Engineering 90, 102070, 2020"
)
_CHENG_READ = "in the documentation and code of HydroModules, which agree; the paper was not opened"


def current_left(deficit: Numbers, cosine: Numbers, lean: float, rest: float) -> Numbers:
    """Return r = max(0, 1 - deficit / (lean cos q + rest)), the one form of all wake laws."""
    return np.maximum(0.0, 1.0 - deficit / (lean * cosine + rest))


class WakeLaw(Law, ABC):
    """A law of the current behind a panel of netting.

    lean, rest: how the deficit grows as the panel leans, see current_left; a law without the angle has 0 and 1.
    """

    area = "current"
    lean: ClassVar[float] = 0.0
    rest: ClassVar[float] = 1.0

    @abstractmethod
    def deficit(self, solidity: ArrayLike, reynolds: ArrayLike = 0.0) -> Numbers:
        """Return 1 - r where lean cos q + rest is 1; reynolds: d V / nu of the twine, which some panel laws ask for."""

    def factor(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Numbers:
        """Return r, never below 0."""
        cosine = np.abs(np.cos(numbers(angle)))
        return current_left(self.deficit(solidity, reynolds), cosine, self.lean, self.rest) + 0.0 * cosine


@dataclass(frozen=True)
class GivenWake(WakeLaw):
    """r = left, whatever the netting; left: 0 to 1, ValueError outside."""

    name = "factor"
    title = "A factor of your own"
    source = "given by the user"
    read = "-"
    left: float = 1.0

    def __post_init__(self) -> None:
        """Check the factor."""
        if not 0.0 <= self.left <= 1.0:
            raise ValueError(f"the factor of a wake is {self.left}, from 0 to 1 was expected")

    def deficit(self, solidity: ArrayLike, reynolds: ArrayLike = 0.0) -> Numbers:
        """Return 1 - left."""
        return 1.0 - self.left + 0.0 * (numbers(solidity) + numbers(reynolds))


@dataclass(frozen=True)
class DragWake(WakeLaw):
    """A wake by C_D, the drag coefficient of the panel face on, by the law `panel`."""

    panel: PanelLaw = field(default_factory=Loland)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the panel law holds."""
        return self.panel.ranges

    def face_on(self, solidity: ArrayLike, reynolds: ArrayLike) -> Numbers:
        """Return C_D at angle 0."""
        return self.panel.coefficients(0.0, solidity, reynolds)[0]


@dataclass(frozen=True)
class LolandWake(DragWake):
    """r = 1 - 0.46 C_D."""

    name = "loland"
    title = "Loeland's wake"
    source = Loland.source
    read = "in two public codes that agree; the thesis was not opened"

    def deficit(self, solidity: ArrayLike, reynolds: ArrayLike = 0.0) -> Numbers:
        """Return 0.46 C_D."""
        return 0.46 * self.face_on(solidity, reynolds)


@dataclass(frozen=True)
class MomentumWake(DragWake):
    """r = sqrt(1 - C_D), and 0 from C_D = 1 on.

    The drag 1/2 rho C_D A U^2 is the loss of momentum rho A u (U - r U) of the water that passes at u = (U + r U) / 2.
    """

    name = "momentum"
    title = "Momentum theory of a screen"
    source = "derived: balance of momentum and energy along a stream tube, as for an actuator disc"
    read = "-"

    def deficit(self, solidity: ArrayLike, reynolds: ArrayLike = 0.0) -> Numbers:
        """Return 1 - sqrt(1 - C_D)."""
        return 1.0 - np.sqrt(np.maximum(0.0, 1.0 - self.face_on(solidity, reynolds)))


@dataclass(frozen=True)
class ChengWake(WakeLaw):
    """r = max(0, (cos q + 0.05 - 0.38 Sn) / (cos q + 0.05)).

    Above Sn = 0.05 / 0.38 = 0.13 nothing is left behind netting that is nearly edge on: cos q < 0.38 Sn - 0.05.
    """

    name = "cheng"
    title = "Cheng's wake"
    source = _CHENG
    read = _CHENG_READ
    lean = 1.0
    rest = 0.05

    def deficit(self, solidity: ArrayLike, reynolds: ArrayLike = 0.0) -> Numbers:
        """Return 0.38 Sn."""
        return 0.38 * numbers(solidity) + 0.0 * numbers(reynolds)


class TwineLaw(Law, ABC):
    """A law of the current at the twines of a panel that lie in each other's wakes."""

    area = "current"

    @abstractmethod
    def factor(self, angle: ArrayLike, solidity: ArrayLike) -> Numbers:
        """Return r, 1 face on."""


@dataclass(frozen=True)
class ChengTwines(TwineLaw):
    """r = r_w(q, Sn) / r_w(0, Sn) with Cheng's wake r_w, not below 1 / sqrt 8.

    The coefficient of a twine face on is that of a twine among others, so only what the angle adds counts. The floor is
    by the same source: edge on, the drag without shelter is at most 8 times too large, and drag goes with r^2.
    """

    name = "cheng"
    title = "Cheng's wake over its value face on"
    source = _CHENG
    read = _CHENG_READ + "; that a ratio of it acts on twines is fyke's own step"
    least: ClassVar[float] = 8.0**-0.5

    def factor(self, angle: ArrayLike, solidity: ArrayLike) -> Numbers:
        """Return r, from 1 / sqrt 8 to 1."""
        wake = ChengWake()
        return np.maximum(self.least, wake.factor(angle, solidity) / wake.factor(0.0, solidity))


WAKES: Mapping[str, type[WakeLaw]] = MappingProxyType(
    {law.name: law for law in (LolandWake, MomentumWake, ChengWake, GivenWake)}
)
TWINES: Mapping[str, type[TwineLaw]] = MappingProxyType({ChengTwines.name: ChengTwines})
