"""The accounts of a run: forces that balance, energy that went in and where it is.

Forces, at the last frame. What acts on a knot is water + weight less buoyancy + dead load + parts + tension of its
bars, and the tensions cancel in the sum over all knots, so
    sum of loads - support reaction = sum of (M a) over the free knots,
which is zero at rest and the inertia force of the net in motion, of held knots too where they are moved.

Energy, between the first and the last frame. M(x) a = F times v, summed over the knots and integrated, is
    change of (kinetic + elastic + potential) = current - drag - twine + added mass + inertia + parts + supports
                                                     - remainder  (J)
    kinetic     1/2 sum v.M v, added mass included
    elastic     sum over bars of l0 times the integral of T over strain, up to the strain of the bar
    potential   -sum (weight less buoyancy + dead load).x
    current     integral of sum F.u, F the drag and lift on a knot, u the velocity of the water there, sheltered
    drag        integral of sum F.(u - v), never negative; the work of drag and lift on the net F.v is current - drag
    twine       integral of sum (T - T_elastic) dl/dt over the taut bars
    added mass  integral of 1/2 sum v.(dM/dt) v: the added mass of a bar turns with it, and M a = F leaves this out
    inertia     integral of sum I.v, I the force of accelerating water on a knot and the buoyancy that it loses above
                the surface
    parts       integral of sum P.v, P the force of what acts besides water, bars and knots (forces.part)
    supports    integral of sum S.v over held knots that are moved, S = M a - F the force of the support on a knot
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry, borne, elastic
from ..forces.frame import Frame
from ..forces.inertia import inertia_forces, mass_matrices
from ..forces.surroundings import Surroundings
from ..forces.total import TINY_LENGTH
from ..solve.result import Result
from ..system.elements import Elements
from ..system.system import System

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EnergyBudget:
    """Energy of a net between the first and the last frame, all in J; formulas at the head of the module.

    kinetic, elastic, potential: changes; current_work, drag_dissipation, twine_dissipation, added_mass_work,
    inertia_work, parts_work, support_work: integrals of the power in the frames by the trapezoidal rule; remainder:
    what went in and is in none of these, positive where energy got lost.

    The integrals see the motion at the output times only. The remainder is therefore the numerical damping and the
    error of the method together with the error of sampling, which falls with the square of the interval between
    outputs once that resolves the motion; bars that ring between two outputs are not resolved.
    """

    kinetic: float
    elastic: float
    potential: float
    current_work: float
    drag_dissipation: float
    twine_dissipation: float
    added_mass_work: float
    inertia_work: float
    parts_work: float
    support_work: float
    remainder: float

    @property
    def water_work(self) -> float:
        """Work of the water on the net, J."""
        return self.current_work - self.drag_dissipation + self.inertia_work


@dataclass(frozen=True)
class Audit:
    """The accounts of a run.

    unbalanced_force: largest force on a free knot that nothing balances in the last frame, N; in motion it is the
    knot's M a. unbalanced_knot: the label of this knot, None where all are held. load: hydrodynamic force, weight
    less buoyancy, dead loads and parts of the whole net, (3,) N. load_size: sizes of the loads on the knots added up,
    N.
    load_less_reaction: load - support reaction, (3,) N: what the statics left unbalanced, or the inertia force of a
    net in motion. mass, added_mass: kg, of the free knots and the bars' ends there, added mass as the mean of the three
    directions; inertia_force: (3,) N, of accelerating water on the whole net and the buoyancy lost above the surface,
    in the last frame. energy: None for a single frame.
    """

    unbalanced_force: float
    unbalanced_knot: str | None
    load: Array
    load_size: float
    load_less_reaction: Array
    mass: float
    added_mass: float
    inertia_force: Array
    energy: EnergyBudget | None

    @property
    def relative_difference(self) -> float | None:
        """Size of load_less_reaction over load_size; None without any load."""
        return float(np.linalg.norm(self.load_less_reaction)) / self.load_size if self.load_size else None

    def figures(self) -> dict[str, Any]:
        """Return the accounts as plain numbers and texts, for summary.json."""
        energy = self.energy
        return {
            "unbalanced_force": self.unbalanced_force,
            "unbalanced_knot": self.unbalanced_knot,
            "load": self.load.tolist(),
            "load_size": self.load_size,
            "load_less_reaction": self.load_less_reaction.tolist(),
            "mass": self.mass,
            "added_mass": self.added_mass,
            "inertia_force": self.inertia_force.tolist(),
            "relative_difference": self.relative_difference,
            "energy": None if energy is None else asdict(energy) | {"water_work": energy.water_work},
        }


def audit(system: System, result: Result) -> Audit:
    """Make the accounts of a result from its frames; system: the one that it was solved with.

    ValueError when the result is of another net.
    """
    if result.net.labels != system.net.labels or not np.array_equal(result.net.bars, system.net.bars):
        raise ValueError("the result is of another net than the system")
    system = as_solved(system, result)
    last, el = result.frame(), system.elements
    mass, added_mass = _masses(system, last)
    load = last.water_force + el.weight + _of_parts(system, last)
    size = np.linalg.norm(forces_on_knots(system, last), axis=1) * el.free
    worst = int(np.argmax(size))
    return Audit(
        unbalanced_force=float(size[worst]),
        unbalanced_knot=system.net.labels[worst] if el.free.any() else None,
        load=load.sum(axis=0),
        load_size=float(np.linalg.norm(load, axis=1).sum()),
        load_less_reaction=load.sum(axis=0) - last.support_reaction,
        mass=mass,
        added_mass=added_mass,
        inertia_force=_of_moving_water(system, last)[1].sum(axis=0),
        energy=_energy_budget(system, result) if len(result.time) > 1 else None,
    )


def as_solved(system: System, result: Result) -> System:
    """Return the system as the solver of a result took it."""
    return system.resting() if result.outcome.solver.startswith("static") else system


def forces_on_knots(system: System, frame: Frame) -> Array:
    """Water, weight, dead load, parts and tensions on every knot, (n, 3) N; what a held knot hands to its support."""
    el = system.elements
    t, _ = _directions(frame, el)
    pull = (system.net.bar_multiple * frame.tension)[:, None] * t
    total = frame.water_force + el.weight + _of_parts(system, frame)
    np.add.at(total, el.knot_a, pull)
    np.subtract.at(total, el.knot_b, pull)
    return np.asarray(total)


def elastic_energy(el: Elements, length: Array) -> Array:
    """Elastic energy of every bar at a length (m,) m, (m,) J: the exact integral of its law, 0 where slack."""
    strain = length / el.rest_length - 1.0
    strain = np.where(el.two_way, np.abs(strain), np.maximum(strain, 0.0))
    whole = _integral(el.law_rows[:-1], np.diff(el.law_rows[:, 0]))
    # Energy over l0 at the strain where a row begins; the first row of a law begins from nothing.
    start = np.zeros(len(el.law_rows))
    begins = set(el.law_first.tolist())
    for r in range(1, len(start)):
        start[r] = 0.0 if r in begins else start[r - 1] + whole[r - 1]
    row = el.law_first.astype(np.int64)
    while True:
        beyond = np.minimum(row + 1, el.law_end - 1)
        further = (beyond > row) & (strain >= el.law_rows[beyond, 0])
        if not further.any():
            break
        row = np.where(further, beyond, row)
    above = _integral(el.law_rows[row], strain - el.law_rows[row, 0])
    return np.asarray(el.rest_length * (start[row] + above))


def _integral(rows: Array, x: Array) -> Array:
    """Integral of T (N) from the beginning of law rows (r, 5) over a strain x (r,)."""
    # Between the last row of one law and the first of the next x is below zero and the value is not used.
    beyond = np.maximum(x, 0.0)
    power = rows[:, 4] + 1.0
    return np.asarray(rows[:, 1] * x + 0.5 * rows[:, 2] * x * x + rows[:, 3] * beyond**power / power)


def _directions(frame: Frame, el: Elements) -> tuple[Array, Array]:
    """Unit vector (m, 3) and length (m,) m of every bar."""
    t, length = np.empty((len(el.rest_length), 3)), np.empty(len(el.rest_length))
    bar_geometry(frame.position, el, t, length)
    return t, length


def _viscous(el: Elements, length: Array, rate: Array) -> Array:
    """Part of the tension that the twine's damping makes, (m,) N, at a rate of elongation (m,) m/s."""
    f, slope = np.empty_like(length), np.empty_like(length)
    elastic(length - el.rest_length, el, f, slope)
    damped = borne(f + el.damping_time * slope * rate, el)
    return np.where(el.two_way | (length > el.rest_length), damped - f, 0.0)


def _elastic_length(el: Elements, frame: Frame, pull: Array) -> Array:
    """Length (m,) m at which the elastic law alone makes the elastic part of a frame's pull (m,) N.

    An implicit method knows tensions better than the law does from its positions, which stretch stiff bars falsely.
    """
    t, length = _directions(frame, el)
    rate = np.einsum("eq,eq->e", frame.velocity[el.knot_b] - frame.velocity[el.knot_a], t)
    tension = borne(pull - _viscous(el, length, rate), el)
    # A tube that pushes stores what it would pulled as hard.
    tension = np.abs(tension)
    row = el.law_first.astype(np.int64)
    last = el.law_end.astype(np.int64) - 1
    while np.any(further := (row < last) & (tension >= el.law_rows[np.minimum(row + 1, last), 1])):
        row = np.where(further, row + 1, row)
    strain, base, slope, coefficient, exponent = el.law_rows[row].T
    above = np.maximum(tension - base, 0.0)
    curved = np.where(coefficient > 0.0, coefficient, 1.0)
    power = (above / curved) ** (1.0 / exponent)
    # Straight, or with a square on top (netting.elastic); written without a difference of near numbers.
    root = np.sqrt(slope**2 + 4.0 * coefficient * above)
    sloping = 2.0 * above / np.where(slope > 0.0, slope + root, 1.0)
    return np.asarray(el.rest_length * (1.0 + strain + np.where(slope > 0.0, sloping, power)))


def _masses(system: System, frame: Frame) -> tuple[float, float]:
    """Mass and added mass (kg) of the free knots with what hangs on them."""
    el, c = system.elements, system.coefficients
    entries = np.empty((len(el.free), 6))
    mass_matrices(frame.position, el, entries)
    whole = entries[:, :3].mean(axis=1)
    own = el.knot_mass - c.added_mass_knot * system.displaced.knot
    return float(own @ el.free), float((whole - own) @ el.free)


def _of_parts(system: System, frame: Frame) -> Array:
    """Force of what acts besides water, bars and knots, (n, 3) N."""
    surroundings = Surroundings(system)
    if surroundings.parts:
        surroundings.at(frame.position, frame.velocity, frame.time)
    return surroundings.load_of_parts()


def _of_moving_water(system: System, frame: Frame) -> tuple[Array, Array]:
    """Velocity of the water at the knots (n, 3) m/s, and the force of its acceleration and lost buoyancy (n, 3) N."""
    surroundings = Surroundings(system)
    surroundings.renew(frame.position, frame.time)
    el, u = surroundings.given(frame.position, frame.velocity, frame.time)
    return u, el.weight - system.elements.weight


def _powers(system: System, frame: Frame) -> tuple[float, ...]:
    """Power (W) of current, drag, twine, turning added mass, fluid inertia, parts and supports in one frame."""
    el, v = system.elements, frame.velocity
    u, inertia = _of_moving_water(system, frame)
    force = frame.water_force - inertia
    t, length = _directions(frame, el)
    va, vb = v[el.knot_a], v[el.knot_b]
    rate = np.einsum("eq,eq->e", vb - va, t)
    viscous = _viscous(el, length, rate)
    turn = (vb - va - rate[:, None] * t) / np.maximum(length, TINY_LENGTH)[:, None]
    # 1/2 v.(dM/dt) v with M = m (I - t t^T) is -m (v.dt/dt)(v.t), at each end.
    turning = sum(np.einsum("eq,eq->e", w, turn) * np.einsum("eq,eq->e", w, t) for w in (va, vb))
    return (
        float(np.sum(force * u)),
        float(np.sum(force * (u - v))),
        float(viscous @ rate),
        -float(np.sum(el.bar_added_mass * turning)),
        float(np.sum(inertia * v)),
        float(np.sum(_of_parts(system, frame) * v)),
        _support_power(system, frame),
    )


def _support_power(system: System, frame: Frame) -> float:
    """Power (W) of the supports that are moved, in one frame."""
    if system.motion is None:
        return 0.0
    around, held = Surroundings(system), ~system.elements.free.astype(bool)
    el, _ = around.given(frame.position, frame.velocity, frame.time)
    mass, inertia = np.empty((len(held), 6)), np.empty_like(frame.position)
    mass_matrices(frame.position, el, mass)
    inertia_forces(mass, system.motion.acceleration(frame.time), inertia)
    push = inertia - forces_on_knots(system, frame)
    return float(np.sum(push[held] * frame.velocity[held]))


def _energy_budget(system: System, result: Result) -> EnergyBudget:
    el = system.elements
    first, last = result.frame(0), result.frame()
    powers = np.array([_powers(system, result.frame(k)) for k in range(len(result.time))])
    current, drag, twine, turning, inertia, parts, support = np.trapezoid(
        powers, result.time, axis=0
    ).tolist()
    kinetic = float(last.kinetic_energy - first.kinetic_energy)
    stored = [
        elastic_energy(el, _elastic_length(el, frame, system.net.bar_multiple * frame.tension))
        for frame in (first, last)
    ]
    stretching = float(np.sum(stored[1] - stored[0]))
    potential = -float(np.sum(el.weight * (last.position - first.position)))
    return EnergyBudget(
        kinetic=kinetic,
        elastic=stretching,
        potential=potential,
        current_work=current,
        drag_dissipation=drag,
        twine_dissipation=twine,
        added_mass_work=turning,
        inertia_work=inertia,
        parts_work=parts,
        support_work=support,
        remainder=current
        + turning
        + inertia
        + parts
        + support
        - drag
        - twine
        - kinetic
        - stretching
        - potential,
    )
