"""Where a run used its drag laws outside their ranges: which quantity, how far, at how many bars, and when."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..case.schema import Case
from ..netting.net import Net
from ..solve.result import Result
from ..water.laws import AngleLaw, BarLaw, KnotLaw, PanelLaw, Range
from ..water.laws.law import ANGLE, GAP_REYNOLDS, REYNOLDS, SOLIDITY

Array = NDArray[np.float64]
Moment = tuple[float, Array, Array]  # time (s); position, velocity (n, 3) m, m/s
Velocity = Callable[[Array, float], Array]  # of the water at points (n, 3) m and a time (s): (n, 3) m/s
# Local solidity, angle (rad) and Reynolds number of p pieces of screen at position and relative velocity (n, 3).
Screens = Callable[[Array, Array], tuple[Array, Array, Array]]

MOST_FRAMES = 50  # of a run that are looked at
KEULEGAN_CARPENTER = "Keulegan-Carpenter number"
# Laws are of steady flow; in waves with a smaller number the wake comes back to the bar that shed it. The figure is
# from memory of DNV-RP-C205, section 6.7, which was not opened.
STEADY = Range(KEULEGAN_CARPENTER, 40.0, np.inf)
ALONG = 1e-6  # sine of the angle to the flow below which a bar lies along it and has no flow across


@dataclass(frozen=True)
class LawsInUse:
    """The laws of a run, None where there is none, and the kinematic viscosity (m2/s)."""

    bars: BarLaw | None
    knots: KnotLaw | None
    panels: PanelLaw | None
    viscosity: float


def laws_of(case: Case) -> LawsInUse:
    """Return the laws of a case: those of bars and knots, or that of screens in their place."""
    screens, viscosity = case.drag.panel_law(), case.water.kinematic_viscosity
    if screens is not None:
        return LawsInUse(None, None, screens, viscosity)
    bars = case.drag.bar_law(solidity=case.solidity, folder=case.folder)
    return LawsInUse(bars, case.drag.knot_law(), None, viscosity)


@dataclass(frozen=True)
class OutOfRange:
    """What lay outside.

    warnings: a sentence for every quantity of every law; counts, for summary.json: how many of "bars", "knots" or
    "screens", by law and quantity.
    """

    warnings: tuple[str, ...]
    counts: dict[str, dict[str, dict[str, int]]]


class Watch:
    """Takes values as they come and keeps how far each has left the ranges of one law.

    law: its name; what: the word for the things that have the values.
    """

    def __init__(self, law: str, ranges: Sequence[Range], what: str) -> None:
        self.law, self.what, self._ranges = law, what, tuple(ranges)
        self._seen: dict[str, tuple[Array, Array]] = {}
        self._worst: dict[tuple[str, bool], tuple[float, float]] = {}

    def see(self, time: float, values: Mapping[str, ArrayLike]) -> None:
        """Take the values (m,) of quantities at a time (s); NaN is not judged."""
        for one in self._ranges:
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
        for one in self._ranges:
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


def out_of_range(
    net: Net,
    states: Sequence[Moment],
    laws: LawsInUse,
    water: Velocity,
    *,
    screens: Screens | None = None,
    waves: tuple[Velocity, float] | None = None,
) -> OutOfRange:
    """Judge the laws at some states of a net, each quantity once.

    water: velocity of the water, as the drag meets it; screens: what the panel law is judged by; waves: velocity
    that is theirs, and their period (s). Bars and knots in still water are not judged: nothing acts on them. A law that
    splits the flow is judged by the speed across the bar, one of the angle by the whole speed.
    """
    watches = [
        Watch(law.name, law.ranges, what)
        for law, what in ((laws.bars, "bars"), (laws.knots, "knots"), (laws.panels, "screens"))
        if law is not None
    ]
    for time, position, velocity in states:
        relative = water(position, time) - velocity
        for watch in watches:
            if watch.what == "bars" and laws.bars:
                watch.see(time, bar_values(net, position, relative, laws.bars, laws.viscosity))
            elif watch.what == "knots":
                watch.see(time, knot_values(net, relative, laws.viscosity))
            elif screens is not None:
                watch.see(time, _screen_values(*screens(position, relative)))
    told = [(watch, *one) for watch in watches for one in watch.told(timed=len(states) > 1)]
    if waves is not None and laws.bars:
        reach = _reach(net, states, laws.bars, *waves)
        told += [(reach, *one) for one in reach.told(timed=False)]
    counts: dict[str, dict[str, dict[str, int]]] = {}
    for watch, quantity, _, count in told:
        counts.setdefault(watch.what, {}).setdefault(watch.law, {})[quantity] = count
    return OutOfRange(tuple(sentence for _, _, sentence, _ in told), counts)


def _reach(net: Net, states: Sequence[Moment], law: BarLaw, velocity: Velocity, period: float) -> Watch:
    """Return a watch that has seen U T / d of every bar, U the largest speed of the waves there in these states."""
    swing = np.zeros(net.bar_count)
    for time, position, _ in states:
        swing = np.maximum(swing, np.linalg.norm(_middle(net, velocity(position, time)), axis=1))
    watch = Watch(law.name, (STEADY,), "bars")
    watch.see(states[-1][0], {KEULEGAN_CARPENTER: _where_some(swing * period / net.bar_diameter, swing)})
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


def _where_some(values: Array, size: Array) -> Array:
    return np.where(size > 0.0, values, np.nan)
