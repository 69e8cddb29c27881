"""Gear in the case file: netting, what every part has, and the flat panel."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from math import pi, sin, sqrt
from typing import Annotated, Literal, cast

import numpy as np
from pydantic import Field, PrivateAttr

from ..netting.cutting import Taper
from ..netting.hexagon import Hexagon
from ..netting.lattice import Corner, Edge, Lattice, Mesh, Side, flat_strain, hung_size, lattice, taut_ratios
from ..netting.net import Net
from ..netting.panel import panel, panel_axes
from ..netting.twine import Twine
from .fields import Density, Direction, HangingRatio, Length, MeshCount, Name, Point, Table, whole

MOST_SEGMENTS = 50
MOST_GROUPED = 1000  # real meshes along an axis that one stands for
LARGEST_STRAIN = 0.2  # of unloaded bars in the net as built


class NettingSpec(Table):
    """One kind of netting: a twine tied into meshes."""

    twine: Name = Field(description="name of a [twine.NAME]", examples=["main"])
    mesh_name: Literal["diamond", "square", "hexagonal"] = Field(
        alias="mesh", description="shape of the meshes", examples=["diamond"]
    )
    bar_length: Length = Field(
        description="m, knot centre to knot centre, unloaded; of hexagons the slanted bars",
        examples=["30 mm"],
    )
    long_bar: Length | None = Field(
        default=None, description="m, of hexagons, knot centre to knot centre, unloaded", examples=["45 mm"]
    )
    orientation: Literal["T0", "T90"] = Field(
        default="T0", description="long bars of hexagons along the height (T0) or the width (T90)"
    )
    knot_diameter: Length | None = Field(
        default=None, description="m; leave out for knotless netting", examples=["3.5 mm"]
    )
    knot_density: Density | None = Field(
        default=None, description="kg/m3, the twine's by default", examples=[1140.0]
    )
    segments: Annotated[int, *whole(1, MOST_SEGMENTS)] = Field(
        default=1, description="straight pieces that a bar is cut into, so that it can bow", examples=[2]
    )
    group: Annotated[int, *whole(1, MOST_GROUPED)] | None = Field(
        default=None,
        description="one mesh is laid for so many real ones along width and along height; 1 by default",
        examples=[4],
    )

    @property
    def mesh(self) -> Mesh:
        """The kind of mesh, as functions of netting.lattice take it; long bars that are not given as the others."""
        if self.mesh_name == "hexagonal":
            return Hexagon((self.long_bar or self.bar_length) / self.bar_length, self.orientation == "T90")
        return self.mesh_name


@dataclass(frozen=True)
class Sheet:
    """One sheet of netting of a piece of gear, as it is built.

    name: of the panel in the net; meshes: along width and height; size: m, width and height laid flat, the mean ones;
    rims: diameters (m) of the lower and the upper rim of one that closes round an axis; sides: meshes and length (m)
    along x and along y of one that goes round a box; both None for a flat one; sewn: its upper rim, or the whole edge
    of a flat one, has the knots of another sheet; taper: how its sides are cut, meshes and size being those of the
    wide end.
    """

    name: str
    meshes: tuple[int, int]
    size: tuple[float, float]
    rims: tuple[float, float] | None = None
    sides: tuple[tuple[int, float], tuple[int, float]] | None = None
    sewn: bool = False
    taper: Taper | None = None

    @property
    def closed(self) -> bool:
        """Whether it closes round."""
        return self.rims is not None or self.sides is not None

    @property
    def edges(self) -> tuple[Side | Corner, ...]:
        """Its edges; netting that closes round has no left and right, that of a box has corners."""
        if self.sides is not None:
            return ("top", "bottom", "corner1", "corner2", "corner3", "corner4")
        return ("top", "bottom") if self.rims else ("top", "bottom", "left", "right")

    @property
    def tip(self) -> bool:
        """Whether its lowest row is one knot."""
        return self.rims is not None and self.rims[0] == 0.0

    def lattice(self, mesh: Mesh) -> Lattice:
        """Return the lattice of its meshes."""
        return lattice(mesh, self.meshes, self.taper)

    def area(self, mesh: Mesh) -> float:
        """Return the area within its outline, laid flat (m2)."""
        whole = self.size[0] * self.size[1]
        if self.taper is None or isinstance(mesh, Hexagon):
            return whole
        return whole * self.taper.area(mesh, self.last(mesh))

    def strain(self, netting: NettingSpec) -> float:
        """Strain of the longest bars as built, from knot to knot where it is widest; negative where all are slack."""
        if self.sides is not None:
            sides = (((count, self.meshes[1]), (length, self.size[1])) for count, length in self.sides)
            return max(max(flat_strain(netting.mesh, n, netting.bar_length, size)) for n, size in sides)
        width = self.size[0]
        if self.rims is not None:
            columns = self.last(netting.mesh)[0] + 1
            chord = pi if isinstance(netting.mesh, Hexagon) else columns * sin(pi / columns)
            width = chord * max(self.rims)  # columns of hexagons lie unevenly: the circle is the most
        return max(flat_strain(netting.mesh, self.meshes, netting.bar_length, (width, self.size[1])))

    def edge(self, side: Side | Corner, mesh: Mesh) -> tuple[int, float]:
        """Return how many knots an edge has, and how long (m) it is from knot to knot; of hexagons at most."""
        if self.sides is not None:
            if side in ("top", "bottom"):
                return self.meshes[0], self.size[0]
            column = self.lattice(mesh).knots[:, 0] == 0
            return int(np.count_nonzero(column)), self.size[1]
        if self.taper is not None:
            grid = self.lattice(mesh)
            places = grid.knots[grid.edge(cast(Side, side))] * (
                np.array(self.size) / np.array(grid.intervals)
            )
            return len(places), float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
        if self.rims is None:
            along = 0 if side in ("top", "bottom") else 1
            if isinstance(mesh, Hexagon):
                return mesh.knots_along(self.meshes, along, last=side in ("top", "right")), self.size[along]
            return self.meshes[along] + 1, self.size[along]
        diameter, around = self.rims[1 if side == "top" else 0], self.meshes[0]
        return (around, around * diameter * sin(pi / around)) if diameter else (1, 0.0)

    def last(self, mesh: Mesh) -> tuple[int, int]:
        """Return the largest column and row of its own knots."""
        steps = 2 if mesh == "diamond" else 1
        i, j = (
            mesh.last(self.meshes)
            if isinstance(mesh, Hexagon)
            else (steps * self.meshes[0], steps * self.meshes[1])
        )
        return i - self.closed, j - self.sewn

    def has(self, i: int, j: int, mesh: Mesh) -> bool:
        """Whether it has a knot i-j of its own."""
        if self.taper is not None:
            return bool((self.lattice(mesh).knots == (i, j)).all(axis=1).any())
        last = self.last(mesh)
        if self.sewn and not self.closed and not (0 < i <= last[0] - 1 and 0 < j <= last[1]):
            return False
        knot = mesh.has(i, j) if isinstance(mesh, Hexagon) else mesh == "square" or (i + j) % 2 == 0
        return i <= last[0] and j <= last[1] and knot and not (self.tip and j == 0 and i > 0)


def ratios(hanging: float | tuple[float, float], mesh: Mesh) -> tuple[float, float]:
    """Return E1 and E2; one number is E1 of netting whose bars are just taut, of diamonds where none can be."""
    if isinstance(hanging, tuple):
        return hanging
    return taut_ratios(mesh, hanging) or (hanging, sqrt(1.0 - hanging**2))


class Part(Table):
    """What every [[gear]] has."""

    kind: str
    given_name: Name | None = Field(
        default=None,
        alias="name",
        description='name in labels; "1", "2" ... by default when there are several',
    )
    _name: str = PrivateAttr(default="")

    @property
    def name(self) -> str:
        """Name as given; by default "" for the only gear and "1", "2" ... among several."""
        return self._name

    @property
    def called(self) -> str:
        """Kind and name, for messages."""
        return f"{self.kind} '{self.name}'" if self.name else f"the {self.kind}"

    def call(self, default_name: str) -> None:
        """Fill in the name, once, when the whole case is known."""
        self._name = default_name if self.given_name is None else self.given_name


class Piece(Part):
    """Gear that is netting."""

    netting: Name = Field(description="name of a [netting.NAME]", examples=["main"])
    given_group: Annotated[int, *whole(1, MOST_GROUPED)] | None = Field(
        default=None,
        alias="group",
        description="one mesh is laid for so many real ones along width and along height; that of the netting by "
        "default",
        examples=[4],
    )
    _group: int = PrivateAttr(default=1)

    @property
    def group(self) -> int:
        """Real meshes along an axis that one mesh is laid for."""
        return self._group

    def gather(self, group: int) -> None:
        """Fill in the group, once, when the whole case is known."""
        self._group = group

    def settle(self, netting: NettingSpec) -> None:
        """Fill in what follows from the netting, once, when the whole case is known."""

    @property
    @abstractmethod
    def sized(self) -> bool:
        """Whether its keys say its size once."""

    @abstractmethod
    def sheets(self, netting: NettingSpec) -> tuple[Sheet, ...]:
        """Return its sheets, none when its size is not known."""

    @abstractmethod
    def heights(self, netting: NettingSpec) -> tuple[float, float] | None:
        """Return z (m) of its lowest and its highest place as built, None when its size is not known."""

    @abstractmethod
    def lay(self, netting: NettingSpec, twine: Twine) -> Net:
        """Build it of this netting, whose twine this is."""


class FlatSpec(Piece):
    """A flat panel of netting on a frame."""

    meshes: tuple[MeshCount, MeshCount] = Field(
        description="meshes along the width and along the height", examples=[[8, 8]]
    )
    given_size: tuple[Length, Length] | None = Field(
        default=None,
        alias="size",
        description="m, width and height of the frame; of one that is cut, at its wide end",
        examples=[[0.3055, 0.3055]],
    )
    hanging_ratio: HangingRatio | None = Field(
        default=None,
        description="instead of size: E1 (bars just taut; diamonds E2 = sqrt(1 - E1^2)) or [E1, E2], width and height "
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

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the frame (m), as given or from the hanging ratio."""
        return self._size

    @property
    def wide(self) -> tuple[int, int]:
        """Meshes along the width, at its wide end, and along the height."""
        return self.meshes

    def taper(self, netting: NettingSpec) -> Taper | None:
        """Return how its sides are cut, None where they are straight. ValueError for cuts that cannot be."""
        return None

    def settle(self, netting: NettingSpec) -> None:
        """Fill in the size."""
        self._size = self.sized_for(netting)

    @property
    def sized(self) -> bool:
        """Whether it has either a size or a hanging ratio."""
        return (self.given_size is None) != (self.hanging_ratio is None)

    def sheets(self, netting: NettingSpec) -> tuple[Sheet, ...]:
        """Return the one sheet."""
        if not self.sized:
            return ()
        return (Sheet(self.name, self.wide, self.sized_for(netting), taper=self.taper(netting)),)

    def heights(self, netting: NettingSpec) -> tuple[float, float] | None:
        """Return z (m) of its lowest and its highest corner."""
        if not self.sized:
            return None
        axes = panel_axes(np.array(self.normal))
        half = float(0.5 * np.abs(axes[:, 2]) @ np.array(self.sized_for(netting)))
        return self.centre[2] - half, self.centre[2] + half

    def lay(self, netting: NettingSpec, twine: Twine) -> Net:
        """Build it."""
        return panel(
            twine,
            mesh=netting.mesh,
            meshes=self.wide,
            bar_length=netting.bar_length,
            size=self.size,
            knot_diameter=netting.knot_diameter or 0.0,
            knot_density=netting.knot_density,
            segments=netting.segments,
            group=self.group,
            centre=self.centre,
            normal=self.normal,
            taper=self.taper(netting),
            fixed=self.fixed,
            name=self.name,
        )

    def sized_for(self, netting: NettingSpec) -> tuple[float, float]:
        """Return width and height (m) of the frame when hung with this netting."""
        if self.given_size is not None:
            return self.given_size
        return hung_size(
            netting.mesh, self.wide, netting.bar_length, ratios(self.hanging_ratio or 0.0, netting.mesh)
        )


class PanelSpec(FlatSpec):
    """A rectangular panel of netting on a frame."""

    kind: Literal["panel"] = Field(description="kind of gear", examples=["panel"])
