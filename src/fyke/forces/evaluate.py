"""From a state to a Frame: every force at one moment."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..system.system import State, System
from .bars import add_tension, bar_geometry, borne, elastic, largest_on_free
from .compiled import OPTIONS
from .drag import bar_water_force
from .frame import Frame
from .inertia import inertia_forces, kinetic_energy, mass_matrices
from .surroundings import Surroundings

Array = NDArray[np.float64]


@njit(**OPTIONS)
def water_on_bars(rel, el, t, length, out):
    """Force of the water on every bar, both ends together, into out (m, 3) N; rel: (n, 3) relative velocity m/s."""
    for e in range(length.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        out[e, 0], out[e, 1], out[e, 2] = bar_water_force(
            0.5 * (rel[a, 0] + rel[b, 0]),
            0.5 * (rel[a, 1] + rel[b, 1]),
            0.5 * (rel[a, 2] + rel[b, 2]),
            t[e, 0],
            t[e, 1],
            t[e, 2],
            2.0 * el.normal_drag[e] * length[e],
            2.0 * el.tangential_drag[e] * length[e],
        )


def bar_tensions(system: System, state: State, t: Array, length: Array) -> Array:
    """Tension of every bar, (m,) N: elastic law and twine damping, zero where slack, negative in tubes that push."""
    el = system.elements
    stretch = length - el.rest_length
    f, k = np.empty_like(length), np.empty_like(length)
    elastic(stretch, el, f, k)
    v = state.velocity
    rate = np.einsum("eq,eq->e", v[el.knot_b] - v[el.knot_a], t)
    bears = el.two_way | (stretch > 0.0)
    return borne(np.where(bears, f + el.damping_time * k * rate, 0.0), el)


def share_with_bars(forces: Array, sides: NDArray[np.int64], out: Array) -> None:
    """Add the forces of faces (p, 3) N in equal parts to the bars along their sides (p, 4), -1 for none."""
    share = forces / np.maximum((sides >= 0).sum(axis=1), 1)[:, None]
    for side in sides.T:
        np.add.at(out, side[side >= 0], share[side >= 0])


def evaluate(system: System, state: State) -> Frame:
    """Work out all forces of a state; shapes and units are those of Frame."""
    n, m = system.net.knot_count, system.net.bar_count
    surroundings = Surroundings(system)
    surroundings.renew(state.position, state.time)
    el, u = surroundings.at(state.position, state.velocity, state.time)
    t, length = np.empty((m, 3)), np.empty(m)
    bar_geometry(state.position, el, t, length)
    tension = bar_tensions(system, state, t, length) if state.tension is None else state.tension
    rel, on_bars, total = u - state.velocity, np.empty((m, 3)), np.empty((n, 3))
    water_on_bars(rel, el, t, length, on_bars)
    surroundings.load(state.position, rel, el, t, length, total)
    if surroundings.screens is not None and surroundings.faces is not None:
        share_with_bars(surroundings.screens.forces(state.position, rel), surroundings.faces.bars, on_bars)
    water = total - system.elements.weight
    if surroundings.parts:
        water -= surroundings.load_of_parts()
    add_tension(tension, el, t, total)
    flow = 0.5 * (u[el.knot_a] + u[el.knot_b])
    past = flow if system.motion is None else flow - system.motion.tow
    speed = np.linalg.norm(past, axis=1)
    direction = past / np.where(speed > 0.0, speed, 1.0)[:, None]
    drag = np.einsum("eq,eq->e", on_bars, direction)
    mass = np.empty((n, 6))
    mass_matrices(state.position, el, mass)
    held = total[el.free == 0.0]
    if system.motion is not None:
        inertia = np.empty((n, 3))
        inertia_forces(mass, system.motion.acceleration(state.time), inertia)
        held = held - inertia[el.free == 0.0]
    return Frame(
        time=state.time,
        position=state.position,
        velocity=state.velocity,
        tension=tension / system.net.bar_multiple,
        bar_drag=drag,
        bar_lift=np.linalg.norm(on_bars - drag[:, None] * direction, axis=1),
        water_velocity=flow,
        water_force=water,
        hydrodynamic_force=water.sum(axis=0),
        support_reaction=held.sum(axis=0),
        kinetic_energy=float(kinetic_energy(mass, state.velocity)),
        unbalanced_force=float(largest_on_free(total, el.free)[0]),
    )
