"""Gear in the case file: netting and the panels made of it."""

from __future__ import annotations

from math import sqrt
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PrivateAttr

from ..netting.lattice import Edge, MeshKind, hung_size
from .fields import Density, Direction, HangingRatio, Length, MeshCount, Name, Point, Table
from .quantity import wrong


def _refuse_hexagonal(value: Any) -> Any:
    if value == "hexagonal":
        raise wrong('"diamond" or "square"', "hexagonal mesh is not built yet; choose one of these two")
    return value


class NettingSpec(Table):
    """One kind of netting: a twine tied into meshes."""

    twine: Name = Field(description="name of a [twine.NAME]", examples=["main"])
    mesh: Annotated[MeshKind, BeforeValidator(_refuse_hexagonal)] = Field(
        description="shape of the meshes", examples=["diamond"]
    )
    bar_length: Length = Field(description="m, knot centre to knot centre, unloaded", examples=["30 mm"])
    knot_diameter: Length | None = Field(
        default=None, description="m; leave out for knotless netting", examples=["3.5 mm"]
    )
    knot_density: Density | None = Field(
        default=None, description="kg/m3, the twine's by default", examples=[1140.0]
    )


class PanelSpec(Table):
    """A rectangular panel of netting on a frame."""

    kind: Literal["panel"] = Field(description="kind of gear", examples=["panel"])
    given_name: Name | None = Field(
        default=None,
        alias="name",
        description='name in labels; "1", "2" ... by default when there are several',
    )
    netting: Name = Field(description="name of a [netting.NAME]", examples=["main"])
    meshes: tuple[MeshCount, MeshCount] = Field(
        description="meshes along the width and along the height", examples=[[8, 8]]
    )
    given_size: tuple[Length, Length] | None = Field(
        default=None,
        alias="size",
        description="m, width and height of the frame",
        examples=[[0.3055, 0.3055]],
    )
    hanging_ratio: HangingRatio | None = Field(
        default=None,
        description="instead of size: E1 (diamond mesh, E2 = sqrt(1 - E1^2)) or [E1, E2], width and height "
        "over the fully stretched ones",
        examples=[0.6],
    )
    centre: Point = Field(
        default=(0.0, 0.0, 0.0), description="m, z up from still water", examples=[[0.0, 0.0, -0.5]]
    )
    normal: Direction = Field(
        default=(1.0, 0.0, 0.0), description="direction across the panel; its width axis is horizontal"
    )
    fixed: Edge = Field(default="edges", description="knots that are held")
    _size: tuple[float, float] = PrivateAttr(default=(0.0, 0.0))
    _name: str = PrivateAttr(default="")

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the frame (m), as given or from the hanging ratio."""
        return self._size

    @property
    def name(self) -> str:
        """Name as given; by default "" for the only gear and "1", "2" ... among several."""
        return self._name

    def settle(self, default_name: str, netting: NettingSpec) -> None:
        """Fill in name and size, once, when the whole case is known."""
        self._name = default_name if self.given_name is None else self.given_name
        self._size = self.sized_for(netting)

    def sized_for(self, netting: NettingSpec) -> tuple[float, float]:
        """Return width and height (m) of the frame when hung with this netting."""
        if self.given_size is not None:
            return self.given_size
        ratio = self.hanging_ratio or 0.0
        pair = ratio if isinstance(ratio, tuple) else (ratio, sqrt(1.0 - ratio**2))
        return hung_size(netting.mesh, self.meshes, netting.bar_length, pair)
