"""Cages with four walls in the case file."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, PrivateAttr

from ..netting.lattice import hung_size
from ..netting.net import Net
from ..netting.shapes import box
from ..netting.sheet import Netting
from ..netting.twine import Twine
from .fields import HangingRatio, Length, MeshCount, Point
from .gear import NettingSpec, Piece, Sheet, ratios
from .shapes import RimEdge


class BoxSpec(Piece):
    """A cage with four upright walls and a flat bottom, its sides along x and y."""

    kind: Literal["box"] = Field(description="kind of gear", examples=["box"])
    meshes: tuple[MeshCount, MeshCount, MeshCount] = Field(
        description="meshes along x, along y and along the depth", examples=[[24, 24, 16]]
    )
    given_size: tuple[Length, Length, Length] | None = Field(
        default=None, alias="size", description="m, along x, along y and deep", examples=[[1.2, 1.2, 1.0]]
    )
    hanging_ratio: HangingRatio | None = Field(
        default=None,
        description="instead of size: E1 (bars of the walls just taut) or [E1, E2] of the walls; the bottom is hung at "
        "E1 both ways",
        examples=[0.6],
    )
    bottom: bool = Field(default=True, description="whether netting closes it below")
    top: Point = Field(
        default=(0.0, 0.0, 0.0),
        description="m, middle of the upper rim, z up from still water",
        examples=[[0.0, 0.0, -0.5]],
    )
    fixed: RimEdge = Field(default="top", description="knots that are held; edges: of both rims")
    _size: tuple[float, float, float] = PrivateAttr(default=(0.0, 0.0, 0.0))

    @property
    def size(self) -> tuple[float, float, float]:
        """Length along x and y and depth (m), as given or from the hanging ratio."""
        return self._size

    def settle(self, netting: NettingSpec) -> None:
        """Fill in the size."""
        self._size = self.sized_for(netting)

    @property
    def sized(self) -> bool:
        """Whether it has either a size or a hanging ratio."""
        return (self.given_size is None) != (self.hanging_ratio is None)

    def sized_for(self, netting: NettingSpec) -> tuple[float, float, float]:
        """Return length along x and y and depth (m) when hung with this netting."""
        if self.given_size is not None:
            return self.given_size
        hung = ratios(self.hanging_ratio or 0.0, netting.mesh)
        x, y, z = self.meshes
        (along_x, deep), (along_y, _) = (
            hung_size(netting.mesh, (one, z), netting.bar_length, hung) for one in (x, y)
        )
        return along_x, along_y, deep

    def sheets(self, netting: NettingSpec) -> tuple[Sheet, ...]:
        """Return the walls and the bottom, if there is one; none when the size is not known."""
        if not self.sized:
            return ()
        (nx, ny, nz), (lx, ly, lz) = self.meshes, self.sized_for(netting)
        sides = ((nx, lx), (ny, ly))
        walls = Sheet(self.name, (2 * (nx + ny), nz), (2.0 * (lx + ly), lz), sides=sides)
        if not self.bottom:
            return (walls,)
        return walls, Sheet(f"{self.name} bottom".strip(), (nx, ny), (lx, ly), sewn=True)

    def heights(self, netting: NettingSpec) -> tuple[float, float] | None:
        """Return z (m) of its bottom and its upper rim, None when its size is not known."""
        return (self.top[2] - self.sized_for(netting)[2], self.top[2]) if self.sized else None

    def lay(self, netting: NettingSpec, twine: Twine) -> Net:
        """Build it of this netting, whose twine this is."""
        knot = netting.knot_diameter or 0.0
        return box(
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
            size=self.sized_for(netting),
            bottom=self.bottom,
            top=self.top,
            fixed=self.fixed,
            name=self.name,
        )
