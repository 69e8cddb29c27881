"""Natural periods as tables tell them: each with where and how it moves, and how much of the whole goes along."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.inertia import mass_matrices
from ..solve.modes import Modes, modes
from ..solve.result import Result
from ..system.system import System

Array = NDArray[np.float64]

# Share of the mass that has to go one way for a mode to be called a motion of the whole.
WHOLE = 0.5
WAYS = ("along x", "along y", "up and down")


def told_modes(system: System, position: Array, found: Modes) -> list[dict[str, Any]]:
    """Return the modes about an equilibrium at positions (n, 3) m, slowest first, ready for JSON.

    frequency in Hz, circular_frequency in rad/s, period in s, None where nothing pulls the net back; largest_motion:
    label of the knot that moves most, direction: its unit vector; share: of the mass of all free knots, added mass
    included, that the mode moves along x, y and z: (shape.M e)^2 / (shape.M shape) / (e.M e), the effective modal mass.
    """
    moved = _with_mass(system, position)
    free = system.elements.free[:, None]
    axes = [free * np.eye(3)[q] for q in range(3)]
    wholes = [float(np.sum(axis * moved(axis))) for axis in axes]
    told = []
    for omega, shape in zip(found.frequency, found.shape, strict=True):
        knot = int(np.argmax(np.linalg.norm(shape, axis=1)))
        heavy = moved(shape)
        own = float(np.sum(shape * heavy))
        told.append(
            {
                "period": 2.0 * np.pi / float(omega) if omega > 0.0 else None,
                "frequency": float(omega) / (2.0 * np.pi),
                "circular_frequency": float(omega),
                "largest_motion": system.net.labels[knot],
                "direction": (shape[knot] / np.linalg.norm(shape[knot])).tolist(),
                "share": [
                    float(np.sum(axis * heavy)) ** 2 / own / whole
                    for axis, whole in zip(axes, wholes, strict=True)
                ],
            }
        )
    return told


def period_figures(system: System, result: Result, count: int) -> dict[str, Any]:
    """Return natural_periods for summary.json: the slowest modes about a static equilibrium; none where it is none.

    period_fault: why there are none.
    """
    if not result.outcome.ok:
        return {"natural_periods": [], "period_fault": "the net is in no equilibrium"}
    try:
        found = modes(system, result.position[-1], count=count)
    except ValueError as error:
        return {"natural_periods": [], "period_fault": str(error)}
    return {"natural_periods": told_modes(system, result.position[-1], found)}


def period_words(figures: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Say the natural periods in a summary, in names and texts for a reader."""
    if "natural_periods" not in figures:
        return []
    if "period_fault" in figures:
        return [("natural periods", f"none: {figures['period_fault']}")]
    told = []
    for one in figures["natural_periods"]:
        way = int(np.argmax(one["share"]))
        whole = f" (the whole {WAYS[way]})" if one["share"][way] >= WHOLE else ""
        told.append(("none" if one["period"] is None else f"{one['period']:.4g} s") + whole)
    return [("natural periods", ", ".join(told) + "; undamped")]


def _with_mass(system: System, position: Array) -> Any:
    """Return a function that multiplies motions (n, 3) by the mass of the knots, added mass included."""
    packed = np.empty((len(position), 6))
    mass_matrices(np.ascontiguousarray(position), system.elements, packed)
    blocks = packed[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)
    return lambda motion: np.einsum("npq,nq->np", blocks, motion)
