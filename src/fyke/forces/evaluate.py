"""From a state to a Frame: every force at one moment."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..system.system import State, System
from .bars import add_tension, bar_geometry, elastic, largest_on_free
from .compiled import OPTIONS
from .drag import bar_water_force
from .frame import Frame
from .inertia import kinetic_energy, mass_matrices

Array = NDArray[np.float64]


@njit(**OPTIONS)
def _water_on_bars(rel, el, t, length, out):
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
    """Tension of every bar, (m,) N: elastic law and twine damping, zero where slack, never negative."""
    el = system.elements
    stretch = length - el.rest_length
    f, k = np.empty_like(length), np.empty_like(length)
    elastic(stretch, el, f, k)
    v = state.velocity
    rate = np.einsum("eq,eq->e", v[el.knot_b] - v[el.knot_a], t)
    tension = np.where(stretch > 0.0, f + el.damping_time * k * rate, 0.0)
    return np.maximum(tension, 0.0)


def water_on_bars(system: System, state: State, t: Array, length: Array) -> tuple[Array, Array]:
    """Force of the water on every bar, (m, 3) N, and velocity of the undisturbed water at its middle, (m, 3) m/s."""
    el = system.elements
    u = system.current.velocity(state.position, state.time)
    force = np.empty((len(length), 3))
    _water_on_bars(u - state.velocity, el, t, length, force)
    return force, 0.5 * (u[el.knot_a] + u[el.knot_b])


def evaluate(system: System, state: State) -> Frame:
    """Work out all forces of a state; shapes and units are those of Frame."""
    el, n = system.elements, system.net.knot_count
    t, length = np.empty((system.net.bar_count, 3)), np.empty(system.net.bar_count)
    bar_geometry(state.position, el, t, length)
    tension = bar_tensions(system, state, t, length) if state.tension is None else state.tension
    on_bars, flow = water_on_bars(system, state, t, length)
    rel = system.current.velocity(state.position, state.time) - state.velocity
    water = el.knot_drag[:, None] * np.linalg.norm(rel, axis=1)[:, None] * rel
    np.add.at(water, el.knot_a, 0.5 * on_bars)
    np.add.at(water, el.knot_b, 0.5 * on_bars)
    total = water + el.weight
    add_tension(tension, el, t, total)
    speed = np.linalg.norm(flow, axis=1)
    direction = flow / np.where(speed > 0.0, speed, 1.0)[:, None]
    drag = np.einsum("eq,eq->e", on_bars, direction)
    mass = np.empty((n, 6))
    mass_matrices(state.position, el, mass)
    return Frame(
        time=state.time,
        position=state.position,
        velocity=state.velocity,
        tension=tension,
        bar_drag=drag,
        bar_lift=np.linalg.norm(on_bars - drag[:, None] * direction, axis=1),
        water_force=water,
        hydrodynamic_force=water.sum(axis=0),
        support_reaction=total[el.free == 0.0].sum(axis=0),
        kinetic_energy=float(kinetic_energy(mass, state.velocity)),
        unbalanced_force=float(largest_on_free(total, el.free)[0]),
    )
