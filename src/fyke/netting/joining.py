"""Pieces of netting joined knot by knot along their edges, and lines made fast to them."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .lattice import Corner, Side
from .net import Net, Panel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def joined(net: Net, stays: ArrayLike, goes: ArrayLike, shared: ArrayLike = 1.0) -> Net:
    """Return the net in which every knot of `goes` has become the knot of `stays` at the same place of the list.

    stays, goes: (k,) knots of the net; shared: (k,) or one for all, how many real knots become one with others in
    each pair: of grouped netting as many as Panel.real_along says of the edge. Bars, panels, ropes and bodies of a
    knot that goes are those of the one that stays, which keeps its place and takes the larger diameter; it is held
    when one of the two was. ValueError when the lists differ in length or a knot goes to two places.
    """
    keep, leave = np.asarray(stays, dtype=np.int64), np.asarray(goes, dtype=np.int64)
    if len(keep) != len(leave):
        raise ValueError(f"{len(keep)} knots cannot be joined to {len(leave)}, one by one")
    target = np.arange(net.knot_count)
    for a, b in zip(keep.tolist(), leave.tolist(), strict=True):
        if target[b] not in (b, a):
            raise ValueError(f"knot {net.labels[b]} is joined to two knots")
        target[b] = a
    while not np.array_equal(target, target[target]):
        target = target[target]
    left = np.flatnonzero(target == np.arange(net.knot_count))
    place = np.empty(net.knot_count, dtype=np.int64)
    place[left] = np.arange(len(left))
    place = place[target]
    fixed, thick = np.zeros(len(left), dtype=bool), np.zeros(len(left))
    np.logical_or.at(fixed, place, net.fixed)
    np.maximum.at(thick, place, net.knot_diameter)
    many = np.zeros(len(left))
    np.add.at(many, place, net.knot_multiple)
    np.subtract.at(many, place[leave], np.broadcast_to(np.asarray(shared, dtype=float), leave.shape))
    load = np.zeros((len(left), 3))
    np.add.at(load, place, net.load)
    return replace(
        net,
        positions=net.positions[left],
        labels=tuple(net.labels[i] for i in left),
        fixed=fixed,
        bars=place[net.bars],
        knot_diameter=thick,
        knot_density=net.knot_density[left],
        load=load,
        knot_multiple=many,
        panels=tuple(replace(one, knots=place[one.knots]) for one in net.panels),
        ropes=tuple(replace(one, knots=place[one.knots]) for one in net.ropes),
        bodies=tuple(replace(one, knots=place[one.knots]) for one in net.bodies),
    )


def with_shared_bars(net: Net) -> Net:
    """Return the net in which panels that share two neighbouring knots share the bar between them as well.

    The bar is that of the first such panel, all its segments; the others and the places within them go. ValueError for
    panels whose bars have different numbers of segments.
    """
    if len({panel.bars.shape[1] for panel in net.panels}) > 1:
        raise ValueError("panels whose bars are cut into different numbers of segments share no bars")
    worn = np.zeros(net.knot_count, dtype=np.int64)
    for panel in net.panels:
        there = np.zeros(net.knot_count, dtype=np.int64)
        there[panel.knots] = 1
        worn += there
    places = [_between(panel, worn > 1) for panel in net.panels]
    ends = np.sort(
        np.concatenate([p.knots[p.lattice.bars[at]] for p, at in zip(net.panels, places, strict=True)])
    )
    every = np.concatenate([panel.bars[at] for panel, at in zip(net.panels, places, strict=True)])
    _, first, which = np.unique(
        ends[:, 0] * net.knot_count + ends[:, 1], return_index=True, return_inverse=True
    )
    own = every[first[which]]
    if np.array_equal(own, every):
        return net
    turned = net.bars[own[:, 0], 0] != net.bars[every[:, 0], 0]
    own[turned] = own[turned, ::-1]
    bars = [panel.bars.copy() for panel in net.panels]
    for table, at, found in zip(
        bars, places, np.split(own, np.cumsum([len(at) for at in places])[:-1]), strict=True
    ):
        table[at] = found
    # Of the real bars that two stand for along the seam, one is shared.
    # Those along the seam of one panel are in it twice.
    different, once = np.unique(every[:, 0], return_index=True)
    alike, summed = np.bincount(which[once]), np.bincount(which[once], net.bar_multiple[different])
    many = net.bar_multiple.copy()
    many[every[first]] = (summed - (alike - 1))[:, None]
    panels = tuple(replace(panel, bars=table) for panel, table in zip(net.panels, bars, strict=True))
    return _without(replace(net, panels=panels, bar_multiple=many), np.setdiff1d(every, own))


def _between(panel: Panel, shared: NDArray[np.bool_]) -> Indices:
    """Lattice bars of a panel between two knots that it shares with others."""
    return np.flatnonzero(shared[panel.knots[panel.lattice.bars]].all(axis=1))


def _without(net: Net, bars: Indices) -> Net:
    """Return the net without some of its bars, and without the knots that nothing else ties."""
    stays = np.ones(net.bar_count, dtype=bool)
    stays[bars] = False
    ties, loose = (np.bincount(each.ravel(), minlength=net.knot_count) for each in (net.bars, net.bars[bars]))
    tied = (ties == 0) | (ties > loose)
    knot, bar = np.cumsum(tied) - 1, np.cumsum(stays) - 1
    return replace(
        net,
        positions=net.positions[tied],
        labels=tuple(label for label, stay in zip(net.labels, tied.tolist(), strict=True) if stay),
        fixed=net.fixed[tied],
        bars=knot[net.bars[stays]],
        rest_length=net.rest_length[stays],
        twine_of_bar=net.twine_of_bar[stays],
        knot_diameter=net.knot_diameter[tied],
        knot_density=net.knot_density[tied],
        load=net.load[tied],
        bar_multiple=net.bar_multiple[stays],
        knot_multiple=net.knot_multiple[tied],
        panels=tuple(replace(one, knots=knot[one.knots], bars=bar[one.bars]) for one in net.panels),
        ropes=tuple(replace(one, knots=knot[one.knots], bars=bar[one.bars]) for one in net.ropes),
        bodies=tuple(replace(one, knots=knot[one.knots]) for one in net.bodies),
    )


def seam(one: Indices, other: Indices, *, closed: bool = False) -> tuple[Indices, Indices]:
    """Pair the knots of two edges so that the edge with more meshes is taken up evenly on the one with fewer.

    one, other: (a,), (b,) knots in order in the same direction; closed: the last of each is the first. Returns the
    knots that stay, of the edge with fewer, and those that go, each of the other edge once.
    """
    few, many = (one, other) if len(one) <= len(other) else (other, one)
    if closed:
        few, many = few[:-1], many[:-1]
        place = np.floor(np.arange(len(many)) * len(few) / len(many) + 0.5).astype(np.int64) % len(few)
    else:
        place = np.floor(np.linspace(0.0, len(few) - 1.0, len(many)) + 0.5).astype(np.int64)
    return few[place], many


def stitches(
    net: Net, one: tuple[str, Side | Corner], other: tuple[str, Side | Corner]
) -> tuple[Indices, Indices]:
    """Pair the knots of two edges of panels, each the name of a panel and an edge of it, for a seam.

    Knots are paired in the direction, and on edges that close round from the knot, in which the edges lie nearest to
    each other. Returns the knots that stay, those of the first edge unless the second has fewer, and those that go.
    ValueError when one edge closes round and the other does not.
    """
    panels = {panel.name: panel for panel in net.panels}
    rounds = [panels[name].closed and side in ("top", "bottom") for name, side in (one, other)]
    if rounds[0] != rounds[1]:
        raise ValueError(f"{one[0]}.{one[1]} and {other[0]}.{other[1]}: one closes round, the other does not")
    first, second = (once(panels[name].edge(cast(Side, side))) for name, side in (one, other))
    x = net.positions
    tries = []
    for way in (second, second[::-1]):
        turned = way
        if rounds[0]:
            start = int(np.argmin(np.linalg.norm(x[way[:-1]] - x[first[0]], axis=1)))
            turned = np.append(np.roll(way[:-1], -start), way[start])
        pair = seam(first, turned, closed=rounds[0])
        tries.append((float(np.sum((x[pair[0]] - x[pair[1]]) ** 2)), pair))
    # Of two that lie as near, the edges as they run.
    return tries[1][1] if tries[1][0] < (1.0 - 1e-9) * tries[0][0] else tries[0][1]


def once(knots: Indices) -> Indices:
    """Return the knots along an edge, neighbours that have become one once; a closed edge still ends as it begins."""
    return np.asarray(knots[np.concatenate([[True], np.diff(knots) != 0])])


def sewn(net: Net, one: tuple[str, Side | Corner], other: tuple[str, Side | Corner]) -> Net:
    """Return the net with two edges of panels, each the name of a panel and an edge of it, joined knot by knot."""
    stays, goes = stitches(net, one, other)
    apart = stays != goes
    # Every real knot of the edge that goes becomes one with another.
    panels, real = {panel.name: panel for panel in net.panels}, np.ones(net.knot_count)
    for name, side in (one, other):
        real[panels[name].edge(side)] = panels[name].real_along(side)
    return joined(net, stays[apart], goes[apart], real[goes[apart]])
