"""What the water of a run was and did beside its steady push: waves, shelter, and bars that it left dry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.surroundings import Surroundings
from ..solve.result import Result
from ..system.system import System
from ..water.current import at_full_strength

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Of the largest speed at the knots: a mean current below this is what rounding leaves of one that cancels out.
ROUNDING = 1e-9


def mean_current(system: System) -> Array:
    """Return the current that a net meets, (3,) m/s, as seen from what tows it.

    It is that of the undisturbed water, at full strength at the time 0 at which runs begin, as the mean over the knots
    where the net was built; zero where currents cancel out.
    """
    current, points = at_full_strength(system.current), system.net.positions
    flow = current.velocity(points[:1] if current.uniform else points, 0.0)
    if system.motion is not None:
        flow = flow - system.motion.tow
    mean = flow.mean(axis=0)
    fastest = float(np.linalg.norm(flow, axis=1).max(initial=0.0))
    return np.asarray(mean if np.linalg.norm(mean) > ROUNDING * fastest else np.zeros(3))


def flow_direction(system: System) -> Array | None:
    """Return the unit vector (3,) along which drag is counted, None in still water.

    It is that of the mean current, without a current that in which the waves go.
    """
    mean = mean_current(system)
    if mean.any():
        return np.asarray(mean / np.linalg.norm(mean))
    return None if system.waves is None else np.array(system.waves.direction)


def depths(system: System, position: Array, time: float) -> Array:
    """Return how deep points (n, 3) m lie below the surface at a time (s), (n,) m; infinite where water never ends."""
    if not system.surface:
        return np.full(len(position), np.inf)
    surface = 0.0 if system.waves is None else system.waves.elevation(position, time)
    return np.asarray(surface - position[:, 2])


def dry_knots(system: System, position: Array, time: float) -> Flags:
    """Return which knots at positions (n, 3) m are wholly above the surface at a time (s), (n,)."""
    return np.asarray(depths(system, position, time) <= -0.5 * system.net.knot_diameter)


def dry_bars(system: System, position: Array, time: float) -> tuple[Flags, Flags]:
    """Return which bars (m,) are wholly and which partly above the surface, their knots at positions (n, 3) m."""
    radius, ends = 0.5 * system.net.bar_diameter, depths(system, position, time)[system.net.bars]
    wholly = np.all(ends <= -radius[:, None], axis=1)
    return wholly, ~wholly & np.any(ends < radius[:, None], axis=1)


def water_figures(system: System, result: Result) -> dict[str, Any]:
    """Return what summary.json tells of the water, only what acted; system: the one that the result was solved with.

    waves: kind, height (m, of an irregular sea "significant_height"), period (s, "peak_period") and direction (3,), for
    a run in time; shelter: the smallest and the mean factor by which the net slows the current at its knots in the
    last frame; wet: how many bars are wholly and partly above the surface there.
    """
    told: dict[str, Any] = {}
    waves = system.waves if result.outcome.time > 0.0 else None
    if waves is not None and waves.named is not None:
        named = waves.named
        height, period = ("height", "period") if named.regular else ("significant_height", "peak_period")
        told["waves"] = {
            "kind": named.kind,
            height: named.height,
            period: named.period,
            "direction": list(waves.direction),
        }
    position, time = result.position[-1], float(result.time[-1])
    around = Surroundings(system)
    if around.shelters:
        told["shelter"] = _shelter(around, position, time)
    wholly, partly = dry_bars(system, position, time)
    if wholly.any() or partly.any():
        told["wet"] = {
            "dry_bars": int(np.count_nonzero(wholly)),
            "partly_dry_bars": int(np.count_nonzero(partly)),
        }
    return told


def water_words(figures: dict[str, Any]) -> list[tuple[str, str]]:
    """Say what there is of `water_figures` in a summary, in names and texts for a reader."""
    rows = []
    if "waves" in figures:
        told = figures["waves"]
        sizes = (
            (f"Hs {told['significant_height']:g} m", f"Tp {told['peak_period']:g} s")
            if "significant_height" in told
            else (f"{told['height']:g} m", f"{told['period']:g} s")
        )
        towards = math.degrees(math.atan2(told["direction"][1], told["direction"][0]))
        rows.append(("waves", ", ".join([told["kind"], *sizes, f"towards {towards:.4g} deg"])))
    if "shelter" in figures:
        least, mean = figures["shelter"]["smallest"], figures["shelter"]["mean"]
        words = "no current" if mean is None else f"{mean:.3g} of it in the mean, {least:.3g} at least"
        rows.append(("current left by shelter", words))
    if "wet" in figures:
        told = figures["wet"]
        rows.append(("bars above the surface", f"{told['dry_bars']}, and {told['partly_dry_bars']} in part"))
    return rows


def _shelter(around: Surroundings, position: Array, time: float) -> dict[str, float | None]:
    """Return the smallest and the mean factor at the knots that a current reaches, None where none does."""
    around.renew(position, time)
    free = np.linalg.norm(around.system.current.velocity(position, time), axis=1)
    left = np.linalg.norm(around.velocity(position, time), axis=1)[free > 0.0] / free[free > 0.0]
    if not left.size:
        return {"smallest": None, "mean": None}
    return {"smallest": float(left.min()), "mean": float(left.mean())}
