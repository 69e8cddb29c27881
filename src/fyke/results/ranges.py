"""Where a run used its drag laws outside their ranges: which quantity, how far, at how many bars, and when."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..forces.surroundings import Surroundings
from ..netting.faces import Faces
from ..netting.net import Net
from ..solve.result import Result
from ..system.system import System
from ..water.laws import AngleLaw, BarLaw, Law, Range
from ..water.laws.law import ANGLE, GAP_REYNOLDS, REYNOLDS, SOLIDITY
from ..water.wakes import DragWake
from .water import dry_bars, dry_knots

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Moment = tuple[float, Array, Array]  # time (s); position, velocity (n, 3) m, m/s

MOST_FRAMES = 50  # of a run that are looked at
KEULEGAN_CARPENTER = "Keulegan-Carpenter number"
# Laws are of steady flow; in waves with a smaller number the wake comes back to the bar that shed it. The figure is
# from memory of DNV-RP-C205, section 6.7, which was not opened.
STEADY = Range(KEULEGAN_CARPENTER, 40.0, np.inf)
ALONG = 1e-6  # sine of the angle to the flow below which a bar lies along it and has no flow across


@dataclass(frozen=True)
class OutOfRange:
    """What lay outside.

    warnings: a sentence for every quantity of every law; counts, for summary.json: how many of "bars", "knots",
    "screens" or "wakes" (of meshes, by the drag law that they follow from), by law and quantity.
    """

    warnings: tuple[str, ...]
    counts: dict[str, dict[str, dict[str, int]]]


class Watch:
    """Takes values as they come and keeps how far each has left the ranges of one law.

    law: its name; what: the word for the things that have the values.
    """

    def __init__(self, law: str, ranges: Sequence[Range], what: str) -> None:
        self.law, self.what, self.ranges = law, what, tuple(ranges)
        self._seen: dict[str, tuple[Array, Array]] = {}
        self._worst: dict[tuple[str, bool], tuple[float, float]] = {}

    def see(self, time: float, values: Mapping[str, ArrayLike]) -> None:
        """Take the values (m,) of quantities at a time (s); NaN is not judged."""
        for one in self.ranges:
            if one.quantity not in values:
                continue
            now = np.atleast_1d(np.asarray(values[one.quantity], dtype=float))
            low, high = self._seen.get(one.quantity, (now, now))
            self._seen[one.quantity] = np.fmin(low, now), np.fmax(high, now)
            for above, size in ((True, now), (False, -now)):
                most = float(np.fmax.reduce(size, initial=-np.inf))
                if most > self._worst.get((one.quantity, above), (-np.inf, 0.0))[0]:
                    self._worst[one.quantity, above] = most, time

    def told(self, *, timed: bool) -> Iterator[tuple[str, str, int]]:
        """Yield quantity, sentence and count of all that has left its range; timed: say when it was furthest."""
        for one in self.ranges:
            if one.quantity not in self._seen:
                continue
            low, high = self._seen[one.quantity]
            sentence = one.sentence(self.law, np.where(high > one.high, high, low), self.what)
            if sentence is None:
                continue
            time = self._worst[one.quantity, bool(np.any(high > one.high))][1]
            when = f", at t = {time:.4g} s" if timed else ""
            yield one.quantity, sentence + when, int(np.count_nonzero((high > one.high) | (low < one.low)))


def moments(result: Result) -> tuple[Moment, ...]:
    """Return the frames of a run, at most MOST_FRAMES of them evenly spread, the first and the last among them."""
    count = len(result.time)
    looked_at = np.unique(np.linspace(0, count - 1, min(count, MOST_FRAMES)).round().astype(int))
    return tuple((float(result.time[i]), result.position[i], result.velocity[i]) for i in looked_at)


def out_of_range(system: System, states: Sequence[Moment]) -> OutOfRange:
    """Judge the laws of a system at some states of its net, in the water that acts there, each quantity once.

    What is in still water or above the surface is not judged: nothing acts on it. A law that splits the flow is judged
    by the speed across the bar, one of the angle by the whole speed. In waves U T / d of every bar is judged, too, U
    the largest speed of the waves there in these states and T the period, or that of the peak of their spectrum.
    """
    watches = [watch for watch in _watches(system) if watch.ranges]
    around = Surroundings(system)
    for time, position, velocity in states if watches else ():
        around.renew(position, time)
        relative = around.given(position, velocity, time)[1] - velocity
        for watch in watches:
            watch.see(time, _values(around, watch.what, time, position, relative))
    told = [(watch, *one) for watch in watches for one in watch.told(timed=len(states) > 1)]
    reach = _reach(system, states)
    told += [(reach, *one) for one in reach.told(timed=False)]
    counts: dict[str, dict[str, dict[str, int]]] = {}
    for watch, quantity, _, count in told:
        counts.setdefault(watch.what, {}).setdefault(watch.law, {})[quantity] = count
    return OutOfRange(tuple(sentence for _, _, sentence, _ in told), counts)


def _watches(system: System) -> Iterator[Watch]:
    """One for each law of bars, of knots, of screens in their place and of drag behind wakes, where they act."""
    c, (bars, knots) = system.coefficients, _by_themselves(system)
    laws: tuple[tuple[Law | None, str, bool], ...] = (
        (c.bars, "bars", bool(bars.any())),
        (c.knots, "knots", bool(knots.any())),
        (c.screens, "screens", bool(system.net.panels)),
    )
    for law, what, there in laws:
        if law is not None and there:
            yield Watch(law.name, law.ranges, what)
    if isinstance(c.wake, DragWake) and system.net.panels:
        yield Watch(c.wake.panel.name, c.wake.ranges, "wakes")


def _by_themselves(system: System) -> tuple[Flags, Flags]:
    """Bars (m,) and knots (n,) that have drag of their own: under screens only those outside the netting."""
    net = system.net
    bars, knots = np.ones(net.bar_count, dtype=bool), np.ones(net.knot_count, dtype=bool)
    for panel in net.panels if system.coefficients.screens is not None else ():
        bars[panel.bars] = False
        knots[panel.knots] = False
    return bars, knots


def _values(
    around: Surroundings, what: str, time: float, position: Array, relative: Array
) -> Mapping[str, ArrayLike]:
    """Values of "bars", "knots", "screens" or "wakes"; relative: (n, 3) m/s, the water against the knots."""
    system, (bars, knots) = around.system, _by_themselves(around.system)
    law, viscosity = system.coefficients.bars, system.water.kinematic_viscosity
    if what == "screens":
        if around.screens is None:
            return {}
        solidity, angle, reynolds = around.screens.local(position, relative)
        wet = around.screens.wet > 0.0
        return _screen_values(np.where(wet, solidity, np.nan), angle, np.where(wet, reynolds, 0.0))
    if what == "wakes":
        return {} if around.faces is None else {SOLIDITY: _solidity(around.faces, position)}
    if what == "bars":
        there = bars & ~dry_bars(system, position, time)[0]
        values = bar_values(system.net, position, relative, law, viscosity)
    else:
        there = knots & ~dry_knots(system, position, time)
        values = knot_values(system.net, relative, viscosity)
    return {quantity: _where_some(one, there) for quantity, one in values.items()}


def _solidity(faces: Faces, position: Array) -> Array:
    """Return the solidity of netting as it is stretched, (p,), with its knots at positions (n, 3) m."""
    area = np.linalg.norm(faces.vector_area(position), axis=1)
    solid = faces.solidity * faces.area
    # Faces without area, in the tip of a cone, are no netting.
    stretched = np.maximum(area, solid)
    return np.asarray(np.divide(solid, stretched, out=np.zeros_like(solid), where=solid > 0.0))


def _reach(system: System, states: Sequence[Moment]) -> Watch:
    """Return a watch that has seen U T / d of every bar, U the largest speed of the waves there in these states."""
    net, c, waves = system.net, system.coefficients, system.waves
    watch = Watch((c.screens or c.bars).name, (STEADY,), "bars")
    if waves is None or waves.named is None:
        return watch
    swing = np.zeros(net.bar_count)
    for time, position, _ in states:
        speed = np.linalg.norm(_middle(net, waves.motion(position, time).velocity), axis=1)
        swing = np.maximum(swing, speed)
    numbers = swing * waves.named.period / net.bar_diameter
    watch.see(states[-1][0], {KEULEGAN_CARPENTER: _where_some(numbers, swing)})
    return watch


def bar_values(net: Net, position: Array, relative: Array, law: BarLaw, viscosity: float) -> dict[str, Array]:
    """Return Reynolds number and angle (rad) of every bar, (m,), NaN in still water; relative: (n, 3) m/s at knots."""
    a, b = net.bars.T
    along = position[b] - position[a]
    length = np.sqrt(np.einsum("eq,eq->e", along, along))
    w = _middle(net, relative)
    speed = np.sqrt(np.einsum("eq,eq->e", w, w))
    crossed = np.cross(w, along)
    across = np.sqrt(np.einsum("eq,eq->e", crossed, crossed))
    part = np.abs(np.einsum("eq,eq->e", w, along))
    across = np.where(across > ALONG * speed * length, across / np.where(length > 0.0, length, 1.0), 0.0)
    counts = speed if isinstance(law, AngleLaw) else across
    angle = np.arctan2(across * length, part)
    return {
        REYNOLDS: _where_some(counts * net.bar_diameter / viscosity, counts),
        ANGLE: _where_some(angle, speed),
    }


def knot_values(net: Net, relative: Array, viscosity: float) -> dict[str, Array]:
    """Return the Reynolds number of every knot, (n,), NaN of a knot without diameter or in still water."""
    reynolds = np.sqrt(np.einsum("nq,nq->n", relative, relative)) * net.knot_diameter / viscosity
    return {REYNOLDS: _where_some(reynolds, reynolds)}


def _screen_values(solidity: Array, angle: Array, reynolds: Array) -> dict[str, Array]:
    moving = {REYNOLDS: reynolds, ANGLE: angle, GAP_REYNOLDS: reynolds / np.maximum(1.0 - solidity, 1e-12)}
    return {SOLIDITY: solidity} | {key: _where_some(value, reynolds) for key, value in moving.items()}


def _middle(net: Net, at_knots: Array) -> Array:
    a, b = net.bars.T
    return np.asarray(0.5 * (at_knots[a] + at_knots[b]))


def _where_some(values: Array, size: Array | Flags) -> Array:
    return np.where(size > 0, values, np.nan)
