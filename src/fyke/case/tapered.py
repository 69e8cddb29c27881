"""Flat netting cut to shape in the case file: trapezoid and triangle."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from ..netting.cutting import Taper, cuts_of, lost, repeated, spread
from .fields import MeshCount
from .gear import FlatSpec, NettingSpec
from .quantity import wrong

Cuts = tuple[str, str]  # of the left and the right side, from the wide end on


def _one_rate(value: Any) -> str:
    try:
        cuts_of(value)
    except (ValueError, AttributeError, TypeError):
        allowed = "a cutting rate: AN, AB, or counts of N, T and B such as 1N2B or 1T1B"
        raise wrong(
            allowed, 'write cut = "1N2B", or cut = ["AN", "1N2B"] for the left and the right side'
        ) from None
    return str(value)


def _two_rates(value: Any) -> tuple[str, str]:
    both = value if isinstance(value, list | tuple) and len(value) == 2 else (value, value)
    return _one_rate(both[0]), _one_rate(both[1])


Rates = Annotated[tuple[str, str] | None, BeforeValidator(_two_rates)]


class TaperedSpec(FlatSpec, ABC):
    """Flat netting whose sides are cut."""

    @abstractmethod
    def cuts(self, netting: NettingSpec) -> Cuts:
        """Return all cuts of both sides. ValueError, in words, for cuts that cannot be."""

    @abstractmethod
    def ends(self) -> tuple[int, int]:
        """Return the meshes along the wide and along the narrow end, as far as they are given; -1: not."""

    @property
    @abstractmethod
    def narrows_down(self) -> bool:
        """Whether its lower end is the narrow one."""

    @property
    def wide(self) -> tuple[int, int]:
        """Meshes along the wide end and along the height."""
        return self.ends()[0], self.meshes[1]

    def narrow(self, netting: NettingSpec) -> int:
        """Return the meshes that the cuts leave along the narrow end. ValueError for cuts that cannot be."""
        return self.wide[0] - sum(lost(one, netting.mesh_name) for one in self.cuts(netting))

    def taper(self, netting: NettingSpec) -> Taper | None:
        """Return how its sides are cut. ValueError for cuts that cannot be."""
        return Taper(*self.cuts(netting), "bottom" if self.narrows_down else "top")

    def even(self, netting: NettingSpec) -> Cuts:
        """Return cuts as even as can be, the left side taking the odd mesh."""
        wide, narrow = self.ends()
        left = (wide - narrow + 1) // 2
        both = (left, wide - narrow - left)
        first, second = (spread(one, self.meshes[1], netting.mesh_name) for one in both)
        return first, second


class TrapezoidSpec(TaperedSpec):
    """A panel narrower at one end, its sides cut at a rate."""

    kind: Literal["trapezoid"] = Field(description="kind of gear", examples=["trapezoid"])
    meshes: tuple[MeshCount, MeshCount] = Field(
        description="meshes along the upper edge and along the height", examples=[[40, 20]]
    )
    lower: MeshCount | None = Field(
        default=None,
        description="meshes along the lower edge; with cut alone the cuts say it, narrowing downwards",
        examples=[20],
    )
    cut: Rates = Field(
        default=None,
        description="cutting rate of both sides, or of the left and the right one; even cuts without it",
        examples=["1N2B"],
    )

    @property
    def narrows_down(self) -> bool:
        """Whether its lower end is the narrow one."""
        return self.lower is None or self.lower <= self.meshes[0]

    def ends(self) -> tuple[int, int]:
        """Return the meshes along the wide and along the narrow end, as far as they are given; -1: not."""
        if self.lower is None:
            return self.meshes[0], -1
        return max(self.meshes[0], self.lower), min(self.meshes[0], self.lower)

    def cuts(self, netting: NettingSpec) -> Cuts:
        """Return all cuts of both sides. ValueError, in words, for cuts that cannot be."""
        if self.cut is None:
            return self.even(netting)
        first, second = (repeated(cuts_of(rate), self.meshes[1], netting.mesh_name) for rate in self.cut)
        return first, second


class TriangleSpec(TaperedSpec):
    """A panel that runs to a point."""

    kind: Literal["triangle"] = Field(description="kind of gear", examples=["triangle"])
    meshes: tuple[MeshCount, MeshCount] = Field(
        description="meshes along the edge and along the height", examples=[[20, 20]]
    )
    point: Literal["down", "up"] = Field(default="down", description="which way it points")

    @property
    def narrows_down(self) -> bool:
        """Whether its lower end is the narrow one."""
        return self.point == "down"

    def ends(self) -> tuple[int, int]:
        """Return the meshes along the wide and along the narrow end."""
        return self.meshes[0], 0

    def cuts(self, netting: NettingSpec) -> Cuts:
        """Return all cuts of both sides. ValueError, in words, for cuts that cannot be."""
        return self.even(netting)
