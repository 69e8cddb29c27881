"""Screens: netting that the water pushes on as on pieces of plane, in place of the drag of its bars and knots."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..netting.faces import Faces
from ..water.laws import PanelLaw
from ..water.laws.panels import ScreenLaw
from .screen_faces import ScreenArrays, add_screens, screen_forces, screen_places
from .screen_laws import in_tables
from .screen_tangents import assemble_screens, screen_tangents

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Screens:
    """The faces of a net under one law; made with Screens.of.

    wet: (p,) part of every face that is under water, 1 unless someone says otherwise; forces are multiplied by it, and
    tangents take it for constant: what it changes is in forces.wetness.
    Everywhere x: (n, 3) m, the knots; rel: (n, 3) m/s, the water against the knots.
    """

    def __init__(self, arrays: ScreenArrays, law: ScreenLaw) -> None:
        self.arrays, self.law = arrays, law
        self._form = in_tables(law.form)
        p = len(arrays.solid)
        self.wet = np.ones(p)
        self._tangents = np.zeros((p, 3, 3)), np.zeros((p, 3, 3))

    @classmethod
    def of(cls, faces: Faces, law: PanelLaw, density: float, viscosity: float) -> Screens:
        """Return the screens of faces; density: of the water, kg/m3; viscosity: kinematic, m2/s.

        TypeError for a law without a formula for kernels, which every law of water.laws.panels has.
        """
        if not isinstance(law, ScreenLaw):
            raise TypeError(f"panel law '{law.name}' has no formula for screens; derive it from ScreenLaw")
        arrays = ScreenArrays(
            corners=np.ascontiguousarray(faces.corners, dtype=np.uint32),
            share=np.ascontiguousarray(faces.share, dtype=np.float64),
            solid=faces.solidity * faces.area,
            twine=faces.diameter / viscosity,
            half_density=0.5 * density,
        )
        return cls(arrays, law)

    @property
    def count(self) -> int:
        """Number of faces, p."""
        return len(self.arrays.solid)

    def add_load(self, x: Array, rel: Array, out: Array) -> None:
        """Add the force of the water to out (n, 3) N."""
        add_screens(x, rel, self.arrays, self._form, self.wet, out)

    def forces(self, x: Array, rel: Array) -> Array:
        """Return the force of the water on every face, (p, 3) N."""
        out = np.empty((self.count, 3))
        screen_forces(x, rel, self.arrays, self._form, self.wet, out)
        return out

    def tangents(self, x: Array, rel: Array) -> tuple[Array, Array]:
        """Return dF/dN and dF/dw of every face, (p, 3, 3) Pa and N s/m; the next call writes into the same arrays.

        N: vector area; w: mean velocity of the water past the corners, by their shares.
        """
        screen_tangents(x, rel, self.arrays, self._form, self.wet, *self._tangents)
        return self._tangents

    def assemble(
        self,
        x: Array,
        rel: Array,
        c0: float,
        c1: float,
        places: tuple[Places, Places],
        *,
        symmetric: bool,
        data: Array,
    ) -> None:
        """Add c0 (-dF/dx) + c1 (-dF/dv), rel standing still with x, to the data of a sparse matrix.

        places: solve.pattern.Pattern.groups of the same faces; symmetric: add the symmetric part alone.
        """
        assemble_screens(x, self.tangents(x, rel), c0, c1, self.arrays, symmetric, places, data)

    def local(self, x: Array, rel: Array) -> tuple[Array, Array, Array]:
        """Return what the law is asked for at every face: solidity, angle (rad) and Reynolds number, each (p,).

        The solidity is the local one up to screen_faces.DENSE, and bounded beyond.
        """
        solidity, angle, reynolds = out = np.empty((3, self.count))
        screen_places(x, rel, self.arrays, out)
        return solidity, angle, reynolds
