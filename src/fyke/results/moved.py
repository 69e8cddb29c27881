"""What held knots that are moved hand to their supports by their inertia, -M a, by what it is the inertia of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry
from ..forces.frame import Frame
from ..forces.surroundings import Surroundings
from ..system.system import System

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HeldInertia:
    """Forces (.., 3) N on the supports: of every bar, both ends together, every knot alone and bodies of every kind."""

    bars: Array
    knots: Array
    bodies: list[Array]


def held_inertia(system: System, frame: Frame) -> HeldInertia:
    """Return the inertia on the supports in one frame, zero where nothing is moved; added mass included."""
    net = system.net
    bars, knots = np.zeros((net.bar_count, 3)), np.zeros((net.knot_count, 3))
    if system.motion is None:
        return HeldInertia(bars, knots, [np.zeros((len(one.knots), 3)) for one in net.bodies])
    a = system.motion.acceleration(frame.time)
    around = Surroundings(system)
    around.renew(frame.position, frame.time)
    el, _ = around.given(frame.position, frame.velocity, frame.time)
    t, length = np.empty((net.bar_count, 3)), np.empty(net.bar_count)
    bar_geometry(frame.position, el, t, length)
    area = np.array([one.area for one in net.twines])[net.twine_of_bar]
    density = np.array([one.soaked_density(system.water.density) for one in net.twines])[net.twine_of_bar]
    half = 0.5 * density * area * net.bar_multiple * net.rest_length
    own = el.knot_mass.copy()
    for end in net.bars.T:
        across = a[end] - np.einsum("eq,eq->e", a[end], t)[:, None] * t
        bars -= half[:, None] * a[end] + el.bar_added_mass[:, None] * across
        np.subtract.at(own, end, half)
    bodies = []
    for one in net.bodies:
        each = one.mass + system.coefficients.added_mass_knot * system.water.density * one.volume
        np.subtract.at(own, one.knots, each)
        bodies.append(-each * a[one.knots])
    return HeldInertia(bars, -own[:, None] * a, bodies)
