"""The water at the knots of a net at one moment, and the net's elements as they are in it.

Kernels know two things of the water: its velocity at the knots, and Elements. Where currents vary, waves pass, the net
rises above the surface or laws know the speed, both are worked out anew for a shape, its motion and a time:
    velocity      shelter x current + waves;
    wetness       part of a bar or knot under the surface, which drag, added mass and buoyancy are multiplied by;
    added mass    by the angle between bar and flow, where its law knows one;
    coefficients  of drag by their laws, with slopes;
    fluid inertia rho V a + C_a rho V (a - (a.t) t) of every bar and (1 + C_a) rho V a of every knot in accelerating
                  water, added to the weight (Morison's equation of a moving body, whose own -C_a rho V dv/dt is in its
                  mass).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..system.elements import DragLaws, Elements
from ..system.system import Displaced, System
from .bars import water_load
from .compiled import OPTIONS
from .laws import coefficients_of_bars, coefficients_of_knots
from .part import parts_of
from .screens import Screens
from .shelter import Shelter
from .total import TINY_LENGTH
from .wetness import add_face_wetting, add_wetting, wet_faces, wet_parts

Array = NDArray[np.float64]
Places = NDArray[np.int64]

# Span of heights, over the shortest bar, in which the change of a current with height is found.
SPAN = 1e-5


@njit(**OPTIONS)
def add_fluid_inertia(x, acceleration, el, bar_displaced, knot_inertia, out):
    """Add the force of accelerating water to out (n, 3) N.

    acceleration: (n, 3) m/s2 of the water at the knots; bar_displaced: (m,) kg, half of a bar; knot_inertia: (n,) kg.
    """
    for i in range(x.shape[0]):
        for q in range(3):
            out[i, q] += knot_inertia[i] * acceleration[i, q]
    for e in range(bar_displaced.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        p = 0.5 * (acceleration[a, 0] + acceleration[b, 0])
        q = 0.5 * (acceleration[a, 1] + acceleration[b, 1])
        r = 0.5 * (acceleration[a, 2] + acceleration[b, 2])
        whole = bar_displaced[e] + el.bar_added_mass[e]
        along = el.bar_added_mass[e] * (p * dx + q * dy + r * dz)
        along /= max(dx * dx + dy * dy + dz * dz, TINY_LENGTH)
        for i in (a, b):
            out[i, 0] += whole * p - along * dx
            out[i, 1] += whole * q - along * dy
            out[i, 2] += whole * r - along * dz


def _by_law(x: Array, rel: Array, el: Elements, laws: DragLaws) -> Elements:
    """Coefficients of drag for water of this velocity rel (n, 3) m/s past the knots."""
    bars, knots = np.empty((6, len(el.rest_length))), np.empty((2, len(x)))
    coefficients_of_bars(x, rel, el, laws, bars)
    coefficients_of_knots(rel, el, laws, knots[0], knots[1])
    return el._replace(
        normal_drag=bars[0],
        tangential_drag=bars[1],
        drag_slopes=bars[2:],
        knot_drag=knots[0],
        knot_slopes=knots[1],
    )


class Surroundings:
    """The water around one net on its way.

    left: (n, 1), the part of the current that shelter leaves, that of the shape of the last renewal; parts: what acts
    besides water, bars and knots.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        c, net = system.coefficients, system.net
        self._radius = 0.5 * net.bar_diameter, 0.5 * net.knot_diameter
        for bodies in net.bodies:
            np.maximum.at(self._radius[1], bodies.knots, 0.5 * bodies.diameter)
        self._reach = float(max(self._radius[0].max(initial=0.0), self._radius[1].max(initial=0.0)))
        self._by_angle = not c.bar_mass.constant
        self._depth: Array | None = None
        self.faces = system.faces
        self.screens: Screens | None = None
        self._shelter: Shelter | None = None
        self.parts = parts_of(system)
        self.left = np.ones((net.knot_count, 1))
        # Velocity of the current when last asked for: made once where it is the same always and everywhere.
        self._everywhere: Array | None = None
        viscosity = system.water.kinematic_viscosity
        self._twine_radius = np.empty(0) if self.faces is None else 0.5 * self.faces.diameter
        if self.faces is not None and c.screens is not None:
            self.screens = Screens.of(self.faces, c.screens, system.water.density, viscosity)
        if self.faces is not None and (c.wake or c.twines):
            self._shelter = Shelter(self.faces, c.wake, c.twines, viscosity)

    @property
    def steady(self) -> bool:
        """Whether water and elements stay the same under the surface, whatever the net's shape and the time."""
        s = self.system
        return s.current.steady and s.current.uniform and not (s.waves or self._by_angle or self._shelter)

    @property
    def constant(self) -> bool:
        """Whether they stay the same at any speed, too."""
        return self.steady and self.system.drag_laws is None

    def near_surface(self, x: Array, rise: float) -> bool:
        """Whether knots at x (n, 3) m that rise by this much (m) come out of still water."""
        return self.system.surface and float(x[:, 2].max(initial=-np.inf)) + rise > -self._reach

    def renew(self, x: Array, time: float) -> None:
        """Find the shelter of positions x (n, 3) m, which holds until the next renewal."""
        if self._shelter is not None:
            self.left = self._shelter.factors(x, self.system.current.velocity(x, time))[:, None]

    @property
    def shelters(self) -> bool:
        """Whether netting slows the current."""
        return self._shelter is not None

    @property
    def groups(self) -> tuple[Places, ...]:
        """Knots (p, q) that act on each other besides those of the bars: of the faces, if any, then of each part."""
        parts = tuple(part.groups for part in self.parts)
        return parts if self.screens is None or self.faces is None else (self.faces.corners, *parts)

    def load(self, x: Array, rel: Array, el: Elements, t: Array, length: Array, out: Array) -> None:
        """Weight, buoyancy, water and parts on every knot into out (n, 3) N; el and rel (n, 3) m/s as `at` gives them.

        t, length: (m, 3), (m,) m, of the bars.
        """
        water_load(rel, el, t, length, out)
        if self.screens is not None:
            self.screens.add_load(x, rel, out)
        for part in self.parts:
            part.add_load(out)

    def load_of_parts(self) -> Array:
        """Force of the parts on every knot as the last `at` saw them, (n, 3) N."""
        out = np.zeros((self.system.net.knot_count, 3))
        for part in self.parts:
            part.add_load(out)
        return out

    def assemble(
        self,
        x: Array,
        rel: Array,
        c0: float,
        c1: float,
        groups: tuple[tuple[Places, Places], ...],
        *,
        symmetric: bool,
        data: Array,
    ) -> None:
        """Add c0 (-dF/dx) + c1 (-dF/dv) of screens and parts to the data of a matrix; arguments as of `load`.

        groups: of the solve.pattern.Pattern made with `groups`; symmetric: add the symmetric part alone.
        """
        if self.screens is not None:
            self.screens.assemble(x, rel, c0, c1, groups[0], symmetric=symmetric, data=data)
        for part, places in zip(self.parts, groups[len(groups) - len(self.parts) :], strict=True):
            part.assemble(c0, c1, places, symmetric=symmetric, data=data)

    def velocity(self, x: Array, time: float) -> Array:
        """Velocity of the current at knots x (n, 3) m, sheltered, waves left out, (n, 3) m/s."""
        current = self.system.current
        if self._everywhere is None or not (current.steady and current.uniform):
            self._everywhere = current.velocity(x, time)
        return self._everywhere if self._shelter is None else self.left * self._everywhere

    def shear(self, x: Array, time: float) -> Array | None:
        """Change of the current with height at knots x (n, 3) m, sheltered, (n, 3) 1/s; None where it has none."""
        if self.system.current.uniform:
            return None
        half = np.array([0.0, 0.0, 0.5 * SPAN * float(self.system.elements.rest_length.min(initial=1.0))])
        change = self.velocity(x + half, time) - self.velocity(x - half, time)
        return np.asarray(change / (2.0 * half[2]))

    def add_wetting(
        self,
        x: Array,
        rel: Array,
        el: Elements,
        t: Array,
        length: Array,
        places: tuple[Places, Places, Places],
        groups: tuple[tuple[Places, Places], ...],
        *,
        symmetric: bool,
        data: Array,
    ) -> None:
        """Add to -dF/dx what changes with the wet parts of the net as the last `at` saw it; arguments as of `load`.

        places, groups: start, stride, diagonal and groups of solve.pattern.Pattern, to which the data of the matrix
        belong; symmetric: add the symmetric part alone.
        """
        if self._depth is None:
            return
        displaced, g = self.system.displaced, self.system.water.gravity
        sizes = *self._radius, g * displaced.bar, g * displaced.knot
        add_wetting(self._depth, rel, el, sizes, (t, length), symmetric, places, data)
        if self.screens is not None:
            force, arrays = self.screens.forces(x, rel), self.screens.arrays
            add_face_wetting(
                self._depth, force, arrays, self._twine_radius, self.screens.wet, symmetric, groups[0], data
            )

    def at(self, x: Array, v: Array, time: float) -> tuple[Elements, Array]:
        """Elements, and velocity of the water at the knots (n, 3) m/s, for positions x and velocities v (n, 3).

        The elements hold the coefficients of drag of this moment, with their slopes.
        """
        el, u = self.given(x, v, time)
        laws = self.system.drag_laws
        return (el if laws is None else _by_law(x, u - v, el, laws)), u

    def given(self, x: Array, v: Array, time: float) -> tuple[Elements, Array]:
        """Return what `at` does with the laws of drag not yet asked: for kernels that ask them at every step."""
        for part in self.parts:
            part.see(x, v, time)
        system, u = self.system, self.velocity(x, time)
        waves = None if system.waves is None else system.waves.motion(x, time)
        if waves is not None:
            u = u + waves.velocity
        el = self._added_by_angle(x, u - v) if self._by_angle else system.elements
        displaced, self._depth = system.displaced, None
        if self.screens is not None:
            self.screens.wet.fill(1.0)
        if waves is not None or self.near_surface(x, 0.0):
            el, displaced = self._wetted(el, x, np.zeros(len(x)) if waves is None else waves.elevation)
        if waves is not None:
            weight = el.weight.copy()
            knot_inertia = (1.0 + system.coefficients.added_mass_knot) * displaced.knot
            add_fluid_inertia(x, waves.acceleration, el, displaced.bar, knot_inertia, weight)
            el = el._replace(weight=weight)
        return el, u

    def _added_by_angle(self, x: Array, rel: Array) -> Elements:
        """Added mass of the bars by their angle to the water that passes them; rel: (n, 3) m/s."""
        el = self.system.elements
        a, b = el.knot_a, el.knot_b
        t, w = x[b] - x[a], 0.5 * (rel[a] + rel[b])
        angle = np.arctan2(np.linalg.norm(np.cross(w, t), axis=1), np.abs(np.einsum("eq,eq->e", w, t)))
        added = self.system.coefficients.bar_mass.coefficient(angle)
        return el._replace(bar_added_mass=added * self.system.displaced.bar)

    def _wetted(self, el: Elements, x: Array, elevation: Array) -> tuple[Elements, Displaced]:
        """Drag, added mass and buoyancy of what is under water, and the water that it displaces."""
        system, whole = self.system, self.system.displaced
        depth = elevation - x[:, 2]
        if float(depth.min(initial=np.inf)) > self._reach:
            return el, whole
        self._depth = depth
        bars, knots = np.empty(len(el.rest_length)), np.empty(len(x))
        wet_parts(depth, el, *self._radius, bars, knots)
        if self.screens is not None:
            wet_faces(depth, self.screens.arrays.corners, self._twine_radius, self.screens.wet)
        displaced = Displaced(bars * whole.bar, knots * whole.knot)
        lost = whole.knot - displaced.knot
        added = system.coefficients.added_mass_knot * lost
        for end in (el.knot_a, el.knot_b):
            np.add.at(lost, end, whole.bar - displaced.bar)
        weight = el.weight.copy()
        weight[:, 2] -= system.water.gravity * lost
        wet = el._replace(
            normal_drag=bars * el.normal_drag,
            tangential_drag=bars * el.tangential_drag,
            bar_added_mass=bars * el.bar_added_mass,
            knot_drag=knots * el.knot_drag,
            knot_mass=el.knot_mass - added,
            weight=weight,
        )
        return wet, displaced
