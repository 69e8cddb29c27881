"""Netting round an axis in the case file: cylinder, cone, frustum, and the bottom of a cage."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import hypot, pi, sqrt
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from ..netting.lattice import hung_size
from ..netting.net import Net
from ..netting.shapes import cage
from ..netting.sheet import Netting
from ..netting.twine import Twine
from .fields import Depth, HangingRatio, Length, MeshCount, Point, Table
from .gear import NettingSpec, Piece, Sheet, ratios
from .quantity import wrong

RimEdge = Literal["top", "edges", "none"]


def _one_diameter(value: Any) -> Any:
    if isinstance(value, list):
        allowed = "one diameter, m: a cylinder has two equal rims, a cone one rim and a tip"
        raise wrong(allowed, 'write kind = "frustum" for two diameters, [lower, upper], or give one number')
    return value


def _two_diameters(value: Any) -> Any:
    if not isinstance(value, list | tuple):
        allowed = "two diameters, m, of the lower and the upper rim"
        raise wrong(
            allowed, 'write diameter = [lower, upper], or kind = "cylinder" or "cone" for one diameter'
        )
    return value


OneDiameter = Annotated[Length | None, BeforeValidator(_one_diameter)]
TwoDiameters = Annotated[tuple[Length, Length], BeforeValidator(_two_diameters)]


class BottomSpec(Table):
    """Netting that closes a wall below: a disc, or a cone that hangs down."""

    meshes: MeshCount = Field(description="meshes from the rim to the middle", examples=[8])
    depth: Depth = Field(
        default=0.0, description="m, of the middle below the rim; 0: flat", examples=["0.4 m"]
    )


class RoundSpec(Piece, ABC):
    """Netting that closes round an upright axis."""

    meshes: tuple[MeshCount, MeshCount] = Field(
        description="meshes around and along the height", examples=[[32, 16]]
    )
    top: Point = Field(
        default=(0.0, 0.0, 0.0),
        description="m, centre of the upper rim, z up from still water",
        examples=[[0.0, 0.0, -0.5]],
    )
    fixed: RimEdge = Field(default="top", description="knots that are held; edges: of both rims")

    @abstractmethod
    def rims(self, netting: NettingSpec) -> tuple[tuple[float, float], float] | None:
        """Return the diameters of the lower and the upper rim and the height, m; None where they are not known."""

    @property
    def floor(self) -> BottomSpec | None:
        """Its bottom, if it may have one and has."""
        return None

    def sheets(self, netting: NettingSpec) -> tuple[Sheet, ...]:
        """Return the wall and the bottom, if there is one; none when the size is not known."""
        known = self.rims(netting)
        if known is None:
            return ()
        (low, high), height = known
        size = (0.5 * pi * (low + high), hypot(0.5 * (high - low), height))
        wall = Sheet(self.name, self.meshes, size, rims=(low, high))
        if self.floor is None:
            return (wall,)
        deep = (self.meshes[0], self.floor.meshes)
        slant = hypot(0.5 * low, self.floor.depth)
        name = f"{self.name} bottom".strip()
        return wall, Sheet(name, deep, (0.5 * pi * low, slant), rims=(0.0, low), sewn=True)

    def heights(self, netting: NettingSpec) -> tuple[float, float] | None:
        """Return z (m) of the lowest and the highest place as built, None when the size is not known."""
        known = self.rims(netting)
        if known is None:
            return None
        deep = known[1] + (self.floor.depth if self.floor else 0.0)
        return self.top[2] - deep, self.top[2]

    def lay(self, netting: NettingSpec, twine: Twine) -> Net:
        """Build it of this netting, whose twine this is."""
        known = self.rims(netting)
        if known is None:
            raise ValueError(f"{self.called} has no size")
        (low, high), height = known
        knot = netting.knot_diameter or 0.0
        return cage(
            Netting(
                twine,
                netting.mesh,
                netting.bar_length,
                knot,
                netting.knot_density,
                netting.segments,
                self.group,
            ),
            self.meshes,
            diameter=high,
            depth=height,
            lower=low,
            bottom=(self.floor.meshes, self.floor.depth) if self.floor else None,
            top=self.top,
            fixed=self.fixed,
            name=self.name,
        )


class _ByRatioSpec(RoundSpec):
    """A shape with one diameter, which hanging ratios may give as well."""

    diameter: OneDiameter = Field(
        default=None, description="m, of the upper rim, through its knots", examples=["1.75 m"]
    )
    height: Length | None = Field(default=None, description="m", examples=["1.5 m"])
    hanging_ratio: HangingRatio | None = Field(
        default=None,
        description="instead of diameter and height: E1 (diamond mesh, E2 = sqrt(1 - E1^2)) or [E1, E2], mean way "
        "round and slant height over the fully stretched ones",
        examples=[[0.6, 0.8]],
    )

    @property
    def sized(self) -> bool:
        """Whether it has either diameter and height or a hanging ratio."""
        lengths = [self.diameter, self.height]
        return None not in lengths if self.hanging_ratio is None else lengths == [None, None]

    def flat_size(self, netting: NettingSpec) -> tuple[float, float]:
        """Mean way round and slant height (m) by the hanging ratio."""
        return hung_size(
            netting.mesh, self.meshes, netting.bar_length, ratios(self.hanging_ratio or 0.0, netting.mesh)
        )


class CylinderSpec(_ByRatioSpec):
    """A cylinder of netting."""

    kind: Literal["cylinder"] = Field(description="kind of gear", examples=["cylinder"])
    bottom: BottomSpec | None = Field(
        default=None, description="netting that closes it below", examples=[{"meshes": 8, "depth": "0.4 m"}]
    )

    @property
    def floor(self) -> BottomSpec | None:
        """Its bottom."""
        return self.bottom

    def rims(self, netting: NettingSpec) -> tuple[tuple[float, float], float] | None:
        """Return the diameters of the lower and the upper rim and the height, m; None where they are not known."""
        if not self.sized:
            return None
        if self.diameter is not None and self.height is not None:
            return (self.diameter, self.diameter), self.height
        around, height = self.flat_size(netting)
        return (around / pi, around / pi), height


class ConeSpec(_ByRatioSpec):
    """A cone of netting, its tip below."""

    kind: Literal["cone"] = Field(description="kind of gear", examples=["cone"])

    def rims(self, netting: NettingSpec) -> tuple[tuple[float, float], float] | None:
        """Return the diameters of the tip, 0, and the rim and the height, m; None where they are not known."""
        if not self.sized:
            return None
        if self.diameter is not None and self.height is not None:
            return (0.0, self.diameter), self.height
        around, slant = self.flat_size(netting)
        radius = around / pi  # of the rim, whose way round is twice the mean
        return ((0.0, 2.0 * radius), sqrt(slant**2 - radius**2)) if slant > radius else None


class FrustumSpec(RoundSpec):
    """A cylinder of netting whose two rims differ."""

    kind: Literal["frustum"] = Field(description="kind of gear", examples=["frustum"])
    diameter: TwoDiameters = Field(
        description="m, of the lower and of the upper rim, through their knots", examples=[[1.0, 1.75]]
    )
    height: Length = Field(description="m", examples=["1.5 m"])
    bottom: BottomSpec | None = Field(
        default=None, description="netting that closes it below", examples=[{"meshes": 8, "depth": "0.4 m"}]
    )

    @property
    def floor(self) -> BottomSpec | None:
        """Its bottom."""
        return self.bottom

    @property
    def sized(self) -> bool:
        """Whether its keys say its size, as they must."""
        return True

    def rims(self, netting: NettingSpec) -> tuple[tuple[float, float], float] | None:
        """Return the diameters of the lower and the upper rim and the height, m."""
        return self.diameter, self.height
