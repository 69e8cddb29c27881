"""Figures of rings and collars: how they float, what they bear, how far they bend out of round.

Moments and stresses count from the shape as built: what is left in a tube that was bent straight to that shape, E d/2R
in its outermost fibre, is not in them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry
from ..forces.bending import Bending
from ..forces.evaluate import share_with_bars, water_on_bars
from ..forces.frame import Frame
from ..forces.surroundings import Surroundings
from ..forces.wetness import wet_parts
from ..netting.net import Net, Rope
from ..netting.twine import Twine
from ..solve.result import Result
from ..system.system import System
from .tables import write_table
from .water import depths

Array = NDArray[np.float64]

TABLE = "rings.csv"
TUBULAR = ("ring", "collar")


@dataclass(frozen=True)
class RingFigures:
    """What a ring or a collar is and bears, over all frames unless said otherwise.

    tubes: side by side; weight: N, in air, of all; buoyancy: N, of what is under water in the last frame, and
    largest_buoyancy of all of it; draught_least, draught_most: m, lowest point of the tubes below the surface, at the
    knots, freeboard_least: m, highest point above it, all None where none comes near the surface; axial_force: N, of
    one tube, the largest by size, negative where it is pressed; bending_moment: N m, of one tube, the largest; stress:
    Pa, the largest of both together, None of bars without a wall; utilisation: stress over the yield stress, None
    where that is not known; ovality: largest over smallest diameter, None of one that does not close; in the last
    frame from_netting, from_lines, from_others: (3,) N, force on it of netting, its weight and the water on it
    included, of lines, and of ropes, other rings, floats, sinkers and dead loads.
    """

    kind: str
    name: str
    tubes: int
    weight: float
    buoyancy: float
    largest_buoyancy: float
    draught_least: float | None
    draught_most: float | None
    freeboard_least: float | None
    axial_force: float
    bending_moment: float
    stress: float | None
    utilisation: float | None
    ovality: float | None
    from_netting: tuple[float, float, float]
    from_lines: tuple[float, float, float]
    from_others: tuple[float, float, float]


def ring_figures(system: System, result: Result) -> tuple[RingFigures, ...]:
    """Return the figures of every ring and collar; system: the one that the result was solved with."""
    rings = [rope for rope in system.net.ropes if rope.kind in TUBULAR]
    if not rings:
        return ()
    last = _Last.of(system, result.frame())
    return tuple(_figures(system, result, rope, last) for rope in rings)


def _figures(system: System, result: Result, rope: Rope, last: _Last) -> RingFigures:
    net, water = system.net, system.water
    twine, many = twine_of(net, rope), float(net.bar_multiple[rope.bars[0]])
    length = net.rest_length[rope.bars]
    lift = water.gravity * water.density * twine.fibre_area * many * length
    draught = _draughts(system, result, rope, twine)
    force, moment = result.tension[:, rope.bars], bending_moments(net, rope, result.position)
    stress = _stress(twine, rope, force, moment)
    largest = None if stress is None else float(stress.max(initial=0.0))
    used = twine.yield_stress
    from_netting, from_lines, from_others = (_three(one) for one in _forces(system, rope, last))
    return RingFigures(
        kind=rope.kind,
        name=rope.name,
        tubes=round(many),
        weight=float(water.gravity * twine.mass_per_length * many * length.sum()),
        buoyancy=float(lift @ last.wet_bars[rope.bars]),
        largest_buoyancy=float(lift.sum()),
        draught_least=None if draught is None else float(draught.min()),
        draught_most=None if draught is None else float(draught.max()),
        freeboard_least=None if draught is None else twine.diameter - float(draught.max()),
        axial_force=float(force.ravel()[np.argmax(np.abs(force))]),
        bending_moment=float(moment.max(initial=0.0)),
        stress=largest,
        utilisation=None if largest is None or used is None else largest / used,
        ovality=_ovality(net, rope, result.position),
        from_netting=from_netting,
        from_lines=from_lines,
        from_others=from_others,
    )


def twine_of(net: Net, rope: Rope) -> Twine:
    """Return what a ring is made of."""
    return net.twines[int(net.twine_of_bar[rope.bars[0]])]


def _draughts(system: System, result: Result, rope: Rope, twine: Twine) -> Array | None:
    """Lowest point of the tubes below the surface, (t, k) m, None where they never come near it."""
    knots, radius = np.unique(rope.knots), 0.5 * twine.diameter
    frames = zip(result.position, result.time, strict=True)
    deep = np.array([depths(system, x, float(time))[knots] for x, time in frames])
    if float(deep.min()) > twine.diameter + radius:
        return None
    return np.asarray(deep + radius)


def bending_moments(net: Net, rope: Rope, position: Array) -> Array:
    """Bending moment (t, p) N m in one tube at every knot between two bars, beyond that of the shape as built.

    position: (t, n, 3) m. The curvature as built stands square to the ring's own plane, and turns with it.
    """
    one = replace(net, ropes=(rope,), bar_multiple=np.ones(net.bar_count))
    bending = Bending.of(one)
    if bending is None:
        return np.zeros((len(position), 0))
    built = _curvature(net.positions[None], bending)
    now = _curvature(position, bending)
    if rope.knots[0] == rope.knots[-1]:
        upright, turned = _normal(net.positions[None], rope), _normal(position, rope)
        now = now - np.sum(built * upright[:, None], axis=2, keepdims=True) * turned[:, None]
    return np.asarray(bending.stiffness * np.linalg.norm(now, axis=2))


def _curvature(x: Array, bending: Bending) -> Array:
    """Twice the tangent of half the angle between two bars, (t, p, 3), along the axis about which they turn."""
    a, b, c = (x[:, bending.groups[:, k]] for k in range(3))
    one, other = b - a, c - b
    dot = np.sum(one * other, axis=2) + np.linalg.norm(one, axis=2) * np.linalg.norm(other, axis=2)
    return np.asarray(2.0 * np.cross(one, other) / dot[:, :, None])


def _normal(x: Array, rope: Rope) -> Array:
    """Unit vector (t, 3) square to the plane of a ring."""
    places = x[:, rope.knots] - x[:, rope.knots[:1]]
    area = np.cross(places[:, :-1], places[:, 1:]).sum(axis=1)
    return np.asarray(area / np.linalg.norm(area, axis=1, keepdims=True))


def _stress(twine: Twine, rope: Rope, force: Array, moment: Array) -> Array | None:
    """Largest stress (t, k) Pa at every knot within a ring or beam: |N|/A + M d/2I; None of no tube."""
    if twine.wall == 0.0:
        return None
    inner = twine.diameter - 2.0 * twine.wall
    area = np.pi / 4.0 * (twine.diameter**2 - inner**2)
    modulus = np.pi / 32.0 * (twine.diameter**4 - inner**4) / twine.diameter
    size = np.abs(force)
    beside = size[:, :-1], size[:, 1:]
    if rope.knots[0] == rope.knots[-1]:
        beside = size, np.roll(size, -1, axis=1)
    most = np.maximum(*beside)
    if moment.shape != most.shape:  # where held bars clamp an end there is no bending
        return np.asarray(
            size.max(axis=1, keepdims=True) / area + moment.max(axis=1, initial=0.0)[:, None] / modulus
        )
    return np.asarray(most / area + moment / modulus)


def _ovality(net: Net, rope: Rope, position: Array) -> float | None:
    """Largest over smallest diameter, each over that as built, of a ring that closes, the most of all frames."""
    if rope.knots[0] != rope.knots[-1]:
        return None
    across = [_diameters(x[:, rope.knots[:-1]]) for x in (net.positions[None], position)]
    share = across[1] / across[0]
    return float(np.max(share.max(axis=1) / share.min(axis=1)))


def _diameters(places: Array) -> Array:
    """Distance (t, k) m of every knot of a ring, (t, k, 3) m, from the one that is opposite, or from between two."""
    half = places.shape[1] // 2
    opposite = np.roll(places, -half, axis=1)
    if places.shape[1] % 2:
        opposite = 0.5 * (opposite + np.roll(places, -half - 1, axis=1))
    return np.asarray(np.linalg.norm(places - opposite, axis=2))


@dataclass(frozen=True)
class _Last:
    """What acts in the last frame: wet part of bars (m,) and knots (n,), water on bars (m, 3) N, and how they pull.

    pull: (m, 3) N, tension of every bar on its first knot; on_knots: (n, 3) N, drag of every knot and what hangs there.
    """

    wet_bars: Array
    wet_knots: Array
    on_bars: Array
    on_knots: Array
    pull: Array

    @classmethod
    def of(cls, system: System, frame: Frame) -> _Last:
        """Find it for a frame."""
        net, x, v = system.net, frame.position, frame.velocity
        around = Surroundings(system)
        around.renew(x, frame.time)
        el, u = around.at(x, v, frame.time)
        m = net.bar_count
        t, length, on_bars = np.empty((m, 3)), np.empty(m), np.empty((m, 3))
        bar_geometry(x, el, t, length)
        rel = u - v
        water_on_bars(rel, el, t, length, on_bars)
        if around.screens is not None and around.faces is not None:
            share_with_bars(around.screens.forces(x, rel), around.faces.bars, on_bars)
        wet_bars, wet_knots = np.ones(net.bar_count), np.ones(net.knot_count)
        if system.surface:
            radius = 0.5 * net.knot_diameter
            for bodies in net.bodies:
                np.maximum.at(radius, bodies.knots, 0.5 * bodies.diameter)
            wet_parts(depths(system, x, frame.time), el, 0.5 * net.bar_diameter, radius, wet_bars, wet_knots)
        on_knots = el.knot_drag[:, None] * np.linalg.norm(rel, axis=1, keepdims=True) * rel
        return cls(wet_bars, wet_knots, on_bars, on_knots, (net.bar_multiple * frame.tension)[:, None] * t)


def _forces(system: System, rope: Rope, last: _Last) -> tuple[Array, Array, Array]:
    """Force (3,) N on a ring of netting, lines, and what else there is."""
    net, water = system.net, system.water
    mine = np.zeros(net.knot_count, dtype=bool)
    mine[rope.knots] = True
    area = np.array([t.area for t in net.twines])[net.twine_of_bar]
    density = np.array([t.soaked_density(water.density) for t in net.twines])[net.twine_of_bar]
    volume = area * net.bar_multiple * net.rest_length
    own = last.on_bars.copy()
    own[:, 2] -= water.gravity * (density - water.density * last.wet_bars) * volume
    ends = [(net.bars[:, 0], last.pull + 0.5 * own), (net.bars[:, 1], 0.5 * own - last.pull)]
    on_ring = np.sum([mine[end, None] * force for end, force in ends], axis=0)
    which = np.full(net.bar_count, 2)
    for panel in net.panels:
        which[panel.bars] = 0
    for other in net.ropes:
        which[other.bars] = 1 if other.kind == "line" else 2
    which[rope.bars] = 3
    sums = np.zeros((4, 3))
    np.add.at(sums, which, on_ring)
    knots = mine.nonzero()[0]
    ball = net.knot_multiple * np.pi / 6.0 * net.knot_diameter**3
    up = water.gravity * (water.density * last.wet_knots - net.knot_density) * ball
    sums[0, 2] += float(up[knots].sum())
    hung = net.load.copy()
    hung[:, 2] += water.gravity * (
        water.density * last.wet_knots * net.at_knots("volume") - net.at_knots("mass")
    )
    sums[2] += (hung + last.on_knots)[knots].sum(axis=0)
    return sums[0], sums[1], sums[2]


def _three(vector: Array) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z


def rings_told(system: System, result: Result) -> dict[str, Any]:
    """Return what summary.json tells of rings and collars, nothing where there are none."""
    told = [one.__dict__ for one in ring_figures(system, result)]
    return {"rings": told} if told else {}


def ring_words(figures: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Say of every ring and collar in a summary how it floats and what it bears, in names and texts for a reader."""
    for one in figures.get("rings", ()):
        words = [f"bends by {one['bending_moment']:.4g} N m", f"axial {one['axial_force']:.4g} N"]
        if one["draught_most"] is not None:
            words.insert(0, f"draught {one['draught_least']:.3g} to {one['draught_most']:.3g} m")
        if one["stress"] is not None:
            share = "" if one["utilisation"] is None else f", {100.0 * one['utilisation']:.3g} % of yield"
            words.append(f"{1e-6 * one['stress']:.3g} MPa{share}")
        if one["ovality"] is not None:
            words.append(f"ovality {one['ovality']:.3f}")
        yield f"{one['kind']} {one['name']}".rstrip(), ", ".join(words)


COLUMNS = (
    *("ring", "kind", "name", "tubes", "weight", "buoyancy", "largest_buoyancy"),
    *(
        "draught_least",
        "draught_most",
        "freeboard_least",
        "axial_force",
        "bending_moment",
        "stress",
        "utilisation",
    ),
    *("ovality", "netting_x", "netting_y", "netting_z", "lines_x", "lines_y", "lines_z"),
    *("others_x", "others_y", "others_z"),
)


def write_rings(rings: list[dict[str, Any]], folder: str | Path) -> Path | None:
    """Write the rings of a summary as rings.csv into a folder, a row each in N, m, N m and Pa; nothing without any."""
    if not rings:
        return None
    path, rows = Path(folder, TABLE), []
    for number, ring in enumerate(rings):
        flat = dict(ring)
        for name in ("netting", "lines", "others"):
            flat |= {f"{name}_{axis}": v for axis, v in zip("xyz", ring[f"from_{name}"], strict=True)}
        told = (flat[column] for column in COLUMNS[1:])
        rows.append((number, *("" if v is None else repr(v) if isinstance(v, float) else v for v in told)))
    write_table(path, COLUMNS, rows)
    return path
