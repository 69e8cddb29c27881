"""Figures by part: what each panel, rope, and set of floats or sinkers bears, weighs and hands to the supports.

Nothing is counted twice and nothing is left out: forces and weights of the parts add up to those of the whole net. A
bar is of one panel or rope, a knot of the first panel, else the first rope, that has it; floats and sinkers are parts
of their own, and what is of no part is one more. A part hands to a held knot the pull of its own bars there, half of
their weight and of the water on them, what acts on its own knots and, where held knots are moved, its inertia.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.bars import bar_geometry
from ..forces.evaluate import share_with_bars, water_on_bars
from ..forces.frame import Frame
from ..forces.surroundings import Surroundings
from ..netting.net import Bodies, Net
from ..solve.result import Result
from ..system.system import System
from .derive import drag_and_lift
from .moved import HeldInertia, held_inertia
from .rings import ring_figures
from .tables import write_table
from .volume import volume_history
from .water import flow_direction

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

TABLE = "parts.csv"
OTHERS = "other bars"


@dataclass(frozen=True)
class PartFigures:
    """What one part is and bears, in the last frame unless said otherwise.

    kind: "panel", "cylinder" ..., "rope", "float", "sinker" or "other bars"; knots, bars: how many, a bar in segments
    being one; fixed_knots: how many are held; water_force: (3,) N; drag, lift: N, along the flow and across it, None
    without a flow; weight_in_water: N, under water; support_reaction: (3,) N, of the part on the supports;
    max_tension: N, max_tension_bar: its number and max_tension_bar_label its knots, None where all are slack;
    peak_tension: N, the largest of all frames; utilisation: largest of all frames over the breaking strength of its
    twine, of a ring its stress over the yield stress, None where none is known; slack_bars: slack along their whole
    length; clearance: m, smallest height of all frames above the sea bed, None without a depth.
    """

    kind: str
    name: str
    knots: int
    bars: int
    fixed_knots: int
    water_force: tuple[float, float, float]
    drag: float | None
    lift: float | None
    weight_in_water: float
    support_reaction: tuple[float, float, float]
    max_tension: float
    max_tension_bar: int | None
    max_tension_bar_label: str | None
    peak_tension: float
    utilisation: float | None
    slack_bars: int
    clearance: float | None

    def figures(self) -> dict[str, Any]:
        """Return it as plain numbers and texts, for summary.json."""
        vectors = {"water_force": list(self.water_force), "support_reaction": list(self.support_reaction)}
        return {**self.__dict__, **vectors}


@dataclass(frozen=True)
class _Piece:
    """Bars of one part: chains (b, s), the s segments of each; knots: (k,), with those within its bars."""

    kind: str
    name: str
    knots: Indices
    chains: Indices


def _pieces(net: Net) -> list[_Piece]:
    """Return panels, ropes and what is left, which may be nothing."""
    pieces = [
        _Piece(one.shape, one.name, np.unique(net.bars[one.bars]), _once(one.bars)) for one in net.panels
    ]
    pieces += [_Piece(one.kind, one.name, np.unique(one.knots), one.bars[:, None]) for one in net.ropes]
    free, bare = np.ones(net.bar_count, dtype=bool), np.ones(net.knot_count, dtype=bool)
    for piece in pieces:
        free[piece.chains], bare[piece.knots] = False, False
    return [*pieces, _Piece(OTHERS, "", np.flatnonzero(bare), np.flatnonzero(free)[:, None])]


def _once(chains: Indices) -> Indices:
    """Bars of a panel, those along its seam once."""
    return np.asarray(chains[np.unique(chains[:, 0], return_index=True)[1]])


@dataclass(frozen=True)
class _Loads:
    """Forces (.., 3) N: water on every bar and on every knot, bodies apart, and on each of the bodies of every kind.

    pull: (m, 3), tension of every bar on its first knot.
    """

    bars: Array
    knots: Array
    bodies: list[Array]
    pull: Array


def _loads(system: System, frame: Frame) -> _Loads:
    net, x, v = system.net, frame.position, frame.velocity
    around = Surroundings(system)
    around.renew(x, frame.time)
    wetted, u = around.given(x, v, frame.time)
    el, _ = around.at(x, v, frame.time)
    t, length, on_bars = np.empty((net.bar_count, 3)), np.empty(net.bar_count), np.empty((net.bar_count, 3))
    bar_geometry(x, el, t, length)
    rel = u - v
    water_on_bars(rel, el, t, length, on_bars)
    if around.screens is not None and around.faces is not None:
        share_with_bars(around.screens.forces(x, rel), around.faces.bars, on_bars)
    own = frame.water_force.copy()
    for end in net.bars.T:
        np.subtract.at(own, end, 0.5 * on_bars)
    push = np.linalg.norm(rel, axis=1, keepdims=True) * rel
    rest = own - el.knot_drag[:, None] * push
    dry = system.elements.knot_drag
    wet = np.divide(wetted.knot_drag, dry, out=np.ones_like(dry), where=dry > 0.0)
    displaced = system.displaced.knot.copy()
    for end in net.bars.T:
        np.add.at(displaced, end, system.displaced.bar)
    bodies = [_on_bodies(one, system.water.density, wet, push, rest, displaced) for one in net.bodies]
    for one, force in zip(net.bodies, bodies, strict=True):
        np.subtract.at(own, one.knots, force)
    return _Loads(on_bars, own, bodies, (net.bar_multiple * frame.tension)[:, None] * t)


def _on_bodies(one: Bodies, density: float, wet: Array, push: Array, rest: Array, displaced: Array) -> Array:
    """Force (k, 3) N of the water on bodies: their drag, and by displacement their part of what is no drag.

    wet: (n,), part under water; push: (n, 3) m2/s2, speed times velocity of the water; rest: (n, 3) N, inertia of the
    water and lost buoyancy; displaced: (n,) kg of water, knots and ends of bars.
    """
    at = one.knots
    drag = 0.5 * density * one.drag_area * wet[at, None] * push[at]
    share = np.divide(density * one.volume, displaced[at], out=np.zeros(len(at)), where=displaced[at] > 0.0)
    return np.asarray(drag + share[:, None] * rest[at])


def by_part(system: System, result: Result, *, depth: float | None = None) -> tuple[PartFigures, ...]:
    """Return the figures of panels, ropes, bodies and what is left; system: the one that the result was solved with.

    depth: of the water, m, for the clearance.
    """
    net, frame = system.net, result.frame()
    pieces, loads = _pieces(net), _loads(system, frame)
    bar_owner, knot_owner = np.zeros(net.bar_count, dtype=np.int64), np.zeros(net.knot_count, dtype=np.int64)
    # From the last to the first, which a shared knot is of.
    for number in reversed(range(len(pieces))):
        bar_owner[pieces[number].chains], knot_owner[pieces[number].knots] = number, number
    bars, knots = _weights(system)
    up = np.array([0.0, 0.0, 1.0])
    at_knots = loads.knots + net.load - knots[:, None] * up
    from_bars = np.zeros((net.bar_count, 3))
    for end, sign in zip(net.bars.T, (1.0, -1.0), strict=True):
        from_bars += net.fixed[end, None] * (sign * loads.pull + 0.5 * loads.bars - 0.5 * bars[:, None] * up)
    inertia = held_inertia(system, frame)
    sums = {
        "water": (loads.bars, loads.knots),
        "weight": (bars[:, None], knots[:, None]),
        "support": (from_bars + inertia.bars, net.fixed[:, None] * at_knots + inertia.knots),
    }
    totals = {
        name: _summed(len(pieces), bar_owner, a) + _summed(len(pieces), knot_owner, b)
        for name, (a, b) in sums.items()
    }
    used = {(one.kind, one.name): one.utilisation for one in ring_figures(system, result)}
    told = [
        _of_piece(system, result, piece, {name: total[number] for name, total in totals.items()}, depth)
        for number, piece in enumerate(pieces)
        if piece.kind != OTHERS or piece.chains.size or piece.knots.size
    ]
    told = [replace(one, utilisation=used.get((one.kind, one.name), one.utilisation)) for one in told]
    return (*told, *_of_bodies(system, result, loads, inertia, depth))


def _summed(count: int, owner: Indices, values: Array) -> Array:
    out = np.zeros((count, values.shape[1]))
    np.add.at(out, owner, values)
    return out


def _weights(system: System) -> tuple[Array, Array]:
    """Weight less buoyancy of every bar (m,) and of every knot (n,) N, bodies and dead loads apart."""
    net, w = system.net, system.water
    area = np.array([t.area for t in net.twines])[net.twine_of_bar]
    density = np.array([t.soaked_density(w.density) for t in net.twines])[net.twine_of_bar]
    ball = net.knot_multiple * np.pi / 6.0 * net.knot_diameter**3
    bars = w.gravity * (density - w.density) * area * net.bar_multiple * net.rest_length
    return bars, w.gravity * (net.knot_density - w.density) * ball


def _of_piece(
    system: System, result: Result, piece: _Piece, totals: dict[str, Array], depth: float | None
) -> PartFigures:
    net, own = system.net, piece.chains.ravel()
    last, peak = result.tension[-1], result.tension[:, own].max(axis=0, initial=0.0)
    bar = int(own[np.argmax(last[own])]) if np.any(last[own] > 0.0) else None
    strength = np.array([t.breaking_strength or np.inf for t in net.twines])[net.twine_of_bar[own]]
    drag, lift = drag_and_lift(totals["water"], flow_direction(system))
    return PartFigures(
        kind=piece.kind,
        name=piece.name,
        knots=len(piece.knots) - _inner(piece),
        bars=len(piece.chains),
        fixed_knots=int(np.count_nonzero(net.fixed[piece.knots])),
        water_force=_three(totals["water"]),
        drag=drag,
        lift=lift,
        weight_in_water=float(totals["weight"][0]),
        support_reaction=_three(totals["support"]),
        max_tension=0.0 if bar is None else float(last[bar]),
        max_tension_bar=bar,
        max_tension_bar_label=None if bar is None else net.bar_label(bar),
        peak_tension=float(peak.max(initial=0.0)),
        utilisation=float(np.max(peak / strength)) if np.isfinite(strength).any() else None,
        slack_bars=int(
            np.count_nonzero(np.all((last <= 0.0)[piece.chains] & ~net.two_way[piece.chains], axis=1))
        ),
        clearance=_clearance(result, piece.knots, 0.0, depth),
    )


def _inner(piece: _Piece) -> int:
    """How many of a piece's knots are places within bars."""
    return len(piece.chains) * (int(piece.chains.shape[1]) - 1)


def _of_bodies(
    system: System, result: Result, loads: _Loads, inertia: HeldInertia, depth: float | None
) -> Iterator[PartFigures]:
    net, w = system.net, system.water
    for one, force, moved in zip(net.bodies, loads.bodies, inertia.bodies, strict=True):
        each = w.gravity * (one.mass - w.density * one.volume)
        water = force.sum(axis=0)
        support = (net.fixed[one.knots, None] * (force - [0.0, 0.0, each]) + moved).sum(axis=0)
        drag, lift = drag_and_lift(water, flow_direction(system))
        yield PartFigures(
            kind=one.kind,
            name=one.name,
            knots=len(one.knots),
            bars=0,
            fixed_knots=int(np.count_nonzero(net.fixed[one.knots])),
            water_force=_three(water),
            drag=drag,
            lift=lift,
            weight_in_water=float(each * len(one.knots)),
            support_reaction=_three(support),
            max_tension=0.0,
            max_tension_bar=None,
            max_tension_bar_label=None,
            peak_tension=0.0,
            utilisation=None,
            slack_bars=0,
            clearance=_clearance(result, one.knots, 0.5 * one.diameter, depth),
        )


def _clearance(result: Result, knots: Indices, radius: float, depth: float | None) -> float | None:
    if depth is None or not len(knots):
        return None
    return float(result.position[:, knots, 2].min()) + depth - radius


def _three(vector: Array) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z


def part_figures(system: System, result: Result, *, depth: float | None = None) -> dict[str, Any]:
    """Return what summary.json tells of the parts, and of a sack its volume; depth: of the water, m.

    parts: a list of the figures of `by_part`; volume, volume_unloaded: m3, of the last frame and as built, and
    volume_smallest of all frames, of netting that encloses one; clearance: m, the smallest of all parts and frames.
    """
    parts = by_part(system, result, depth=depth)
    told: dict[str, Any] = {"parts": [part.figures() for part in parts]}
    volumes = volume_history(result)
    if volumes is not None:
        built, frames = volumes
        told |= {
            "volume": float(frames[-1]),
            "volume_unloaded": built,
            "volume_smallest": float(frames.min()),
        }
    # Lines come down to their anchors anyway.
    heights = [part.clearance for part in parts if part.clearance is not None and part.kind != "line"]
    return told | ({"clearance": min(heights)} if heights else {})


def part_words(figures: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Say what there is of volume, clearance and utilisation in a summary, in names and texts for a reader."""
    rows = []
    if "volume" in figures:
        now, built, least = (figures[k] for k in ("volume", "volume_unloaded", "volume_smallest"))
        change = f"{100.0 * abs(1.0 - now / built):.3g} % {'gained' if now > built else 'lost'}"
        words = f"{now:.4g} of {built:.4g} m³, {change}"
        rows.append(("volume", words + (f", {least:.4g} m³ at least" if least < now else "")))
    if "clearance" in figures:
        height = figures["clearance"]
        words = f"{height:.4g} m" if height > 0.0 else f"none, it reaches {-height:.2g} m into it"
        rows.append(("clearance to the sea bed", words))
    used = [part for part in figures.get("parts", ()) if part["utilisation"] is not None]
    if used:
        most = max(used, key=lambda part: float(part["utilisation"]))
        where = f"{most['kind']} {most['name']}".rstrip()
        rows.append(("largest use of strength", f"{100.0 * most['utilisation']:.3g} %, {where}"))
    return rows


COLUMNS = (
    "part",
    *("kind", "name", "knots", "bars", "fixed_knots", "drag", "lift", "water_x", "water_y", "water_z"),
    *("weight_in_water", "support_x", "support_y", "support_z", "max_tension", "max_tension_bar"),
    *("peak_tension", "utilisation", "slack_bars", "clearance"),
)


def write_parts(parts: list[dict[str, Any]], folder: str | Path) -> Path:
    """Write the parts of a summary as parts.csv into a folder: a row each, N and m, empty where there is nothing."""
    path = Path(folder, TABLE)
    rows = []
    for number, part in enumerate(parts):
        flat = dict(part)
        for name, key in (("water", "water_force"), ("support", "support_reaction")):
            flat |= {f"{name}_{axis}": value for axis, value in zip("xyz", part[key], strict=True)}
        values = (flat[column] for column in COLUMNS[1:])
        told = ("" if v is None else repr(v) if isinstance(v, float) else v for v in values)
        rows.append((number, *told))
    write_table(path, COLUMNS, rows)
    return path
