"""Tubes: hollow bars that pull, push and bend, of which rings, collars and frames are made.

A tube is a Twine whose law acts both ways. Its diameter is the outer one, by which the water drags, lifts and adds
mass. Filled with air it displaces all of its outline; full of water the water in it moves with it and weighs nothing
there, as in the pores of a twine. With t the thickness of the wall, D outside and d = D - 2 t inside:

    area of the wall  A = pi (D^2 - d^2) / 4        second moment  I = pi (D^4 - d^4) / 64
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from .elastic import LinearLaw
from .net import Net, Rope
from .rigging import with_rope
from .twine import Twine

Contents = Literal["air", "water"]

# A rigid tube is one of a material so many times as stiff.
RIGID = 1e4


@dataclass(frozen=True)
class TubeMaterial:
    """What a tube is made of: density (kg/m3), modulus (Pa), yield stress (Pa), and where they were read."""

    name: str
    density: float
    youngs_modulus: float
    yield_stress: float | None
    source: str


TUBE_MATERIALS: dict[str, TubeMaterial] = {
    m.name: m
    for m in (
        TubeMaterial(
            "HDPE",
            958.0,
            900e6,
            26e6,
            "Marley Pipe Systems, HDPE physical properties, 2010, an extract read: density at 23 C by ISO 1183; secant "
            "modulus in tension at 0.05 to 0.25 % strain, and yield stress, by ISO 527; it creeps to 650 MPa within "
            "an hour and 350 MPa within 1000 hours",
        ),
        TubeMaterial("steel", 7850.0, 206e9, 235e6, "textbook values of plain structural steel; grade S235"),
    )
}


@dataclass(frozen=True)
class Tube:
    """A tube.

    diameter: outer, m; wall: thickness, m; density: of the wall, kg/m3; youngs_modulus: Pa; contents: "air" or
    "water"; mass_per_length: kg/m, of the tube and what is fitted to it, the water in it apart, that of the wall when
    None; yield_stress: Pa; rigid: stiffer than its material by RIGID; material: its name. ValueError for a wall
    that leaves no room, and sizes that are not above 0.
    """

    diameter: float
    wall: float
    density: float
    youngs_modulus: float
    contents: Contents = "air"
    mass_per_length: float | None = None
    yield_stress: float | None = None
    rigid: bool = False
    material: str = ""

    def __post_init__(self) -> None:
        """Refuse what is no tube."""
        if not 0.0 < 2.0 * self.wall < self.diameter:
            raise ValueError(f"a wall of {self.wall:g} m in a tube of {self.diameter:g} m across")

    @classmethod
    def of(cls, material: str, *, diameter: float, wall: float, contents: Contents = "air") -> Tube:
        """Make a tube of one of TUBE_MATERIALS; KeyError for another name."""
        m = TUBE_MATERIALS[material]
        return cls(
            diameter,
            wall,
            m.density,
            m.youngs_modulus,
            contents,
            yield_stress=m.yield_stress,
            material=material,
        )

    @property
    def inner(self) -> float:
        """Inner diameter (m)."""
        return self.diameter - 2.0 * self.wall

    @property
    def wall_area(self) -> float:
        """Cross-section of the wall (m2)."""
        return float(np.pi / 4.0 * (self.diameter**2 - self.inner**2))

    @property
    def second_moment(self) -> float:
        """Second moment of the wall's area about an axis across the tube (m4)."""
        return float(np.pi / 64.0 * (self.diameter**4 - self.inner**4))

    @property
    def mass(self) -> float:
        """Mass per length (kg/m), the water in it apart."""
        return self.density * self.wall_area if self.mass_per_length is None else self.mass_per_length

    def twine(self, name: str) -> Twine:
        """Return the bars' twine of this name."""
        outline = np.pi / 4.0 * self.diameter**2
        modulus = self.youngs_modulus * (RIGID if self.rigid else 1.0)
        flooded = self.contents == "water"
        return Twine(
            name,
            self.mass / (self.wall_area if flooded else outline),
            self.diameter,
            LinearLaw(modulus * self.wall_area / outline),
            material=self.material,
            linear_density=self.mass if flooded else None,
            compression=True,
            bending_stiffness=modulus * self.second_moment,
            wall=self.wall,
            yield_stress=self.yield_stress,
        )


def with_tubes(
    net: Net,
    knots: ArrayLike,
    twine: Twine,
    *,
    tubes: int = 1,
    name: str,
    kind: str = "ring",
    free: bool = False,
) -> Net:
    """Return the net with tubes side by side through some of its knots, made fast at each.

    knots: (k,) of the net, in order, the last may be the first; twine: of a tube; tubes: how many; kind: "ring" or
    "collar"; free: knots that were held are no longer. Errors as of with_rope.
    """
    path = np.asarray(knots, dtype=np.int64)
    made = with_rope(net, path, twine, name=name, kind=kind)
    multiple = made.bar_multiple.copy()
    multiple[made.ropes[-1].bars] = tubes
    fixed = made.fixed.copy()
    fixed[path] &= not free
    return replace(made, bar_multiple=multiple, fixed=fixed)


def ring(
    twine: Twine,
    *,
    diameter: float,
    knots: int,
    tubes: int = 1,
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0),
    name: str = "ring",
) -> Net:
    """Lay a level ring of its own, held by nothing, its knots labelled "NAME:0", "NAME:1" ... anticlockwise from +x.

    twine: of a tube; diameter: m, through its knots; knots: 3 or more; tubes: side by side; centre: m. The bars are
    unloaded as built.
    """
    if knots < 3 or not diameter > 0.0:
        raise ValueError(f"ring '{name}' of {knots} knots and {diameter:g} m across")
    angle = 2.0 * np.pi * np.arange(knots) / knots
    level = np.zeros(knots)
    round_it = np.append(np.arange(knots), 0)
    return Net(
        positions=np.array(centre) + 0.5 * diameter * np.column_stack([np.cos(angle), np.sin(angle), level]),
        labels=tuple(f"{name}:{k}" for k in range(knots)),
        fixed=np.zeros(knots, dtype=bool),
        bars=np.column_stack([round_it[:-1], round_it[1:]]),
        rest_length=np.full(knots, diameter * np.sin(np.pi / knots)),
        twines=(twine,),
        twine_of_bar=np.zeros(knots, dtype=np.int64),
        knot_diameter=np.zeros(knots),
        knot_density=np.full(knots, twine.density),
        load=np.zeros((knots, 3)),
        ropes=(Rope(name, round_it, np.arange(knots), "ring"),),
        bar_multiple=np.full(knots, float(tubes)),
    )
