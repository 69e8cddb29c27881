"""The shape of a line at rest: straight bars in a row, weights at their joints, ends in their places.

With f = (H, V) the horizontal tension and the vertical one at the end, the tension of bar j is (H, v_j), v_j being V
less the weights between bar j and the end. The bars reach from end to end where the complementary energy

    sum_j l_j (s_j + s_j^2 / (2 EA_j)) - f . d,    s_j = |(H, v_j)|,    d from the first to the last end

is least: its derivatives say that the bars end there. It is convex in f, so that Newton's method with a step control
finds f from any start, slack or taut. On a bed that bears what lies on it v_j is never below 0, which keeps it convex.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Tensions below which slack bars have no direction of their own, over the weight of the line, one after the other:
# Newton's method finds its way to a folded line by way of rounder ones.
SOFT = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
WEIGHTLESS = 1e-9  # of the stiffness, in place of the weight of a line that has none
MOST_STEPS = 100  # at one softness
LEAST_STEP = 1e-12
ARMIJO = 1e-4
CLOSED = 1e-12  # gap at the end over the length of the line


def hanging_line(
    begin: Array, end: Array, length: Array, weight: Array, stiffness: Array, *, bed: float | None = None
) -> Array:
    """Return the places (m + 1, 3) m of the joints of a line of m bars at rest, its ends exactly in their places.

    begin, end: (3,) m; length: (m,) m, unloaded; weight: (m,) N of every bar in water, negative where it floats, half
    of it at each joint; stiffness: (m,) N, EA; bed: z (m) of ground that bears the line without friction. A line whose
    two ends are clear of the ground, and one that floats in part, hangs freely and is then lifted onto the bed.
    """
    if bed is not None and end[2] <= bed < begin[2]:
        turned = hanging_line(end, begin, length[::-1], weight[::-1], stiffness[::-1], bed=bed)
        return np.asarray(turned[::-1])
    reach, forward = _reach(begin, end)
    lies = _lies(begin, weight, bed)
    tension, size = _tension(length, weight, stiffness, reach, float(end[2] - begin[2]), lies=lies)
    down = lies & (tension[1] <= 0.0)
    stretched = length * np.where(down, 1.0, 1.0 + size / stiffness)
    steps = stretched * tension / size
    places: Array = begin + np.concatenate([[[0.0, 0.0, 0.0]], _sums(steps, forward)])
    # What is left of the gap goes to the bars that hang, by their length.
    share = np.where(down & (not down.all()), 0.0, length)
    places[1:] += np.outer(np.cumsum(share) / share.sum(), end - places[-1])
    places[0], places[-1] = begin, end
    if bed is not None:
        places[1:-1, 2] = np.maximum(places[1:-1, 2], bed)
    return places


def end_tension(
    begin: Array, end: Array, length: Array, weight: Array, stiffness: Array, *, bed: float | None = None
) -> float:
    """Return the tension (N) at the end of the line of `hanging_line`, half of the last bar's weight included."""
    lies = _lies(begin, weight, bed)
    reach, _ = _reach(begin, end)
    (h, v), _ = _tension(length, weight, stiffness, reach, float(end[2] - begin[2]), lies=lies)
    return float(np.hypot(h[-1], v[-1] + 0.5 * weight[-1]))


def _reach(begin: Array, end: Array) -> tuple[float, Array]:
    """Horizontal distance (m) from begin to end, and the unit vector (3,) of that way."""
    across = end - begin
    reach = float(np.hypot(across[0], across[1]))
    return reach, np.array([across[0], across[1], 0.0]) / reach if reach > 0.0 else np.array([1.0, 0.0, 0.0])


def _lies(begin: Array, weight: Array, bed: float | None) -> bool:
    """Whether the line may lie on the bed from its beginning on."""
    return bed is not None and float(begin[2]) <= bed and bool(np.all(weight >= 0.0))


def _sums(steps: Array, forward: Array) -> Array:
    """Places (m, 3) after every step (2, m) forward and up."""
    return np.asarray(np.cumsum(steps[0])[:, None] * forward + np.cumsum(steps[1])[:, None] * [0.0, 0.0, 1.0])


def _tension(
    length: Array, weight: Array, stiffness: Array, reach: float, rise: float, *, lies: bool
) -> tuple[Array, Array]:
    """Horizontal and vertical tension (2, m) N of every bar, towards the end, and its size (m,) N.

    A slack bar of a folded line has next to no tension and a size above its parts: it is shorter than unloaded.
    """
    # Weights between each bar and the last one, half a bar's at each of its ends.
    beyond = weight[::-1].cumsum()[::-1] - 0.5 * weight - 0.5 * weight[-1]
    scale = max(float(np.abs(weight).sum()), WEIGHTLESS * float(stiffness.max()))
    chords = _Chords(length, beyond, stiffness, np.array([reach, rise]), lies=lies)
    f = np.array([scale, float(beyond[len(beyond) // 2])])
    for soft in SOFT:
        f = chords.least(f, soft * scale)
    v, size = chords.bars(f, SOFT[-1] * scale)
    return np.array([np.full(len(length), f[0]), v]), size


@dataclass(frozen=True)
class _Chords:
    """The complementary energy of a line; beyond: (m,) N, weights between each bar and the last; d: (2,) m."""

    length: Array
    beyond: Array
    stiffness: Array
    d: Array
    lies: bool

    def bars(self, f: Array, soft: float) -> tuple[Array, Array]:
        """Vertical tension (m,) N of every bar and its tension (m,) N, which is soft (N) at least."""
        v = f[1] - self.beyond
        v = np.maximum(v, 0.0) if self.lies else v
        return v, np.sqrt(f[0] ** 2 + v**2 + soft**2)

    def energy(self, f: Array, soft: float) -> float:
        """The sum of the module's page, N m."""
        _, s = self.bars(f, soft)
        return float(np.sum(self.length * (s + s**2 / (2.0 * self.stiffness))) - f @ self.d)

    def least(self, f: Array, soft: float) -> Array:
        """Return f (2,) N where it is least, from a guess, by Newton's method with Armijo's step control."""
        for _ in range(MOST_STEPS):
            gap, step = self.newton(f, soft)
            if np.abs(gap).max() < CLOSED * float(self.length.sum()):
                break
            part, before, slope = 1.0, self.energy(f, soft), float(gap @ step)
            while part > LEAST_STEP and self.energy(f + part * step, soft) > before + ARMIJO * part * slope:
                part *= 0.5
            if part <= LEAST_STEP:
                break
            f = f + part * step
        return f

    def newton(self, f: Array, soft: float) -> tuple[Array, Array]:
        """Gap (2,) m that f leaves at the end, and Newton's step (2,) N."""
        v, s = self.bars(f, soft)
        each, bend = self.length * (1.0 / s + 1.0 / self.stiffness), self.length / s**3
        hangs = (v > 0.0) if self.lies else np.ones(len(v), dtype=bool)
        gap = np.array([np.sum(each) * f[0], np.sum(each * v)]) - self.d
        h00, h01 = np.sum(each - bend * f[0] ** 2), -np.sum(bend * f[0] * v)
        h11 = np.sum(np.where(hangs, each - bend * v**2, 0.0))
        tiny = np.finfo(float).eps * float(np.sum(each))
        return gap, -np.linalg.solve(np.array([[h00 + tiny, h01], [h01, h11 + tiny]]), gap)
