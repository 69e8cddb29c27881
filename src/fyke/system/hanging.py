"""What holds and what carries a net: parts that hang on nothing, and collars that sink under what hangs on them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..netting.net import Net, Rope
from .system import System

Indices = NDArray[np.int64]

MOST_STRAIN = 0.2  # of a line as built; ropes break at a few tens of percent


def hanging(system: System, *, static: bool) -> tuple[str, ...]:
    """Return a sentence for what nothing holds, in a static case, for lines too short, and for collars that sink.

    Moorings, which are lines that end at a held knot, load a collar by how they are set and are left out of its load.
    """
    held = _held_by_nothing(system.net) if static else ()
    return (*held, *_too_short(system.net), *_sinking(system))


def _too_short(net: Net) -> Iterator[str]:
    for line in (rope for rope in net.ropes if rope.kind == "line"):
        length = float(net.rest_length[line.bars].sum())
        apart = float(np.linalg.norm(net.positions[line.knots[-1]] - net.positions[line.knots[0]]))
        if apart > (1.0 + MOST_STRAIN) * length:
            yield (
                f"Line '{line.name}' of {length:.4g} m is too short as built: its ends lie {apart:.4g} m apart, a "
                f"strain of {(apart / length - 1.0) * 100.0:.1f} %; make it longer, or bring its ends nearer."
            )


def _held_by_nothing(net: Net) -> Iterator[str]:
    group = _groups(net.knot_count, net.bars)
    loose = np.setdiff1d(group, group[net.fixed])
    for one in loose:
        there = group == one
        names = _names(net, there)
        knots = int(np.count_nonzero(there))
        yield (
            f"Nothing holds {names or 'a part of the net'}: none of its {knots} knots is fixed or moored, so that it "
            "may drift away and a static case cannot be solved; hold an edge, or add an anchor with lines."
        )


def _names(net: Net, there: NDArray[np.bool_]) -> str:
    """Name the panels and rows of bars whose knots are all among those there (n,)."""
    parts = [(panel.shape, panel.name, panel.knots) for panel in net.panels]
    parts += [(rope.kind, rope.name, rope.knots) for rope in net.ropes]
    names = [
        f"{kind} '{name}'" if name else f"the {kind}" for kind, name, knots in parts if there[knots].all()
    ]
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _groups(knots: int, bars: Indices) -> Indices:
    """Return a number (n,) for each of so many knots, the same for those that bars (k, 2) join."""
    joined = coo_array((np.ones(len(bars)), (bars[:, 0], bars[:, 1])), shape=(knots, knots))
    return np.asarray(connected_components(joined, directed=False)[1], dtype=np.int64)


def _sinking(system: System) -> Iterator[str]:
    net = system.net
    collars = [rope for rope in net.ropes if rope.kind == "collar"]
    if not collars:
        return
    mooring = _mooring_bars(net)
    moored = np.zeros(net.knot_count, dtype=bool)
    moored[net.bars[mooring]] = True
    moored[net.bars[~mooring]] = False
    group = _groups(net.knot_count, net.bars[~mooring])
    for one in dict.fromkeys(int(group[collar.knots[0]]) for collar in collars):
        there = (group == one) & ~moored
        mine = [collar for collar in collars if group[collar.knots[0]] == one]
        in_water = -float(system.elements.weight[there, 2].sum())
        if in_water > 0.0 and not net.fixed[there].any():
            yield _sinks(
                [collar.name for collar in mine], sum(_lift(system, collar) for collar in mine), in_water
            )


def _sinks(names: list[str], lift: float, in_water: float) -> str:
    it = "it" if len(names) == 1 else "they"
    called = " and ".join(f"'{name}'" for name in names)
    who, lifts = (f"Collar {called} sinks", "lifts") if it == "it" else (f"Collars {called} sink", "lift")
    with_it = (
        f"{it} weigh{'s' * (it == 'it')} {in_water + lift:.4g} N with all that hangs below, moorings apart"
    )
    return f"{who}: {with_it}, and {lifts} at most {lift:.4g} N."


def _mooring_bars(net: Net) -> NDArray[np.bool_]:
    """Return which bars (m,) are of lines that lead to held knots and not through other parts of the net."""
    lines = np.zeros(net.bar_count, dtype=bool)
    for rope in net.ropes:
        lines[rope.bars] |= rope.kind == "line"
    ends = net.bars[lines]
    shared = np.isin(ends, net.bars[~lines])
    # Where a line meets other parts of the net it ends, each at a place of its own.
    ends[shared] = net.knot_count + np.arange(np.count_nonzero(shared))
    group = _groups(net.knot_count + int(np.count_nonzero(shared)), ends)
    held = group[: net.knot_count][net.fixed]
    lines[lines] = np.isin(group[ends[:, 0]], held)
    return lines


def _lift(system: System, rope: Rope) -> float:
    """Buoyancy (N) of all tubes of a collar under water."""
    net, water = system.net, system.water
    twine = net.twines[net.twine_of_bar[rope.bars[0]]]
    length = float((net.rest_length * net.bar_multiple)[rope.bars].sum())
    return float(water.gravity * water.density * twine.fibre_area * length)
