"""Mooring chain as a twine: a bar that weighs, stretches and displaces as much as its links do.

Mass, stiffness and volume over the square of the bar diameter are those of the page "Chain" of the online help of
OrcaFlex, which was read; where that has them from was not followed up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .elastic import LinearLaw
from .twine import Twine


@dataclass(frozen=True)
class Links:
    """A kind of chain by the diameter d of the bar that its links are bent from.

    outline: diameter of a rod of the same volume over d; mass: kg/m over d^2; stiffness: EA, N over d^2.
    """

    outline: float
    mass: float
    stiffness: float


STUDLESS = Links(outline=1.80, mass=19.9e3, stiffness=0.854e11)
STUDDED = Links(outline=1.89, mass=21.9e3, stiffness=1.01e11)


def chain(
    bar_diameter: float, *, stud: bool = False, name: str = "chain", breaking_strength: float | None = None
) -> Twine:
    """Return chain as a twine whose diameter is that of a rod of the same volume, 1.8 d for studless links.

    bar_diameter: d, m, of the steel that its links are bent from; stud: links with a stud across; breaking_strength:
    N, from the maker's table, which goes by grade. Weight, buoyancy and stiffness are those of the links. Drag and
    added mass go by the rod: the same page gives 2.4 across and 1.15 along for studless links on d, which are 1.33
    and 0.64 on 1.8 d.
    """
    links = STUDDED if stud else STUDLESS
    diameter = links.outline * bar_diameter
    area = np.pi * diameter**2 / 4.0
    return Twine(
        name,
        density=float(links.mass * bar_diameter**2 / area),
        diameter=diameter,
        law=LinearLaw(float(links.stiffness * bar_diameter**2 / area)),
        breaking_strength=breaking_strength,
    )
