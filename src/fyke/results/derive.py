"""Figures derived from a result: what a run prints and other programs read."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..netting.measures import measure_net
from ..solve.result import Result
from ..version import __version__
from .audit import Audit
from .encoding import case_hash, case_title

Array = NDArray[np.float64]


def bar_lengths(result: Result, index: int = -1) -> Array:
    """Return the distance between the two knots of every bar in one frame, (m,) m."""
    start, end = result.net.bars.T
    position = result.position[index]
    return np.asarray(np.linalg.norm(position[end] - position[start], axis=1))


def drag_and_lift(force: Array, flow_direction: ArrayLike | None) -> tuple[float | None, float | None]:
    """Split a force (3,) N into the part along the flow and the size of the part across it.

    flow_direction: (3,), of any length, as results.flow_direction gives it; both parts are None without one.
    """
    if flow_direction is None or not np.any(flow_direction):
        return None, None
    along = np.asarray(flow_direction, dtype=float)
    along = along / np.linalg.norm(along)
    drag = float(force @ along)
    return drag, float(np.linalg.norm(force - drag * along))


# Units of what `summary` returns; the rest are counts, ratios and texts.
UNITS = {
    **dict.fromkeys(("max_tension", "drag", "lift", "weight_in_water", "residual"), "N"),
    **dict.fromkeys(("support_reaction", "hydrodynamic_force"), "N"),
    "max_displacement": "m",
    **dict.fromkeys(("time", "wall_time"), "s"),
}


def unit_of(key: str) -> str:
    """Return the unit of a figure of the summary by its dotted key, "" for none."""
    return UNITS.get(key.split(".", maxsplit=1)[0], "")


def summary(
    result: Result,
    *,
    title: str | None = None,
    case_sha256: str = "",
    flow_direction: ArrayLike | None = None,
    audit: Audit | None = None,
) -> dict[str, Any]:
    """Return the figures of the last frame and of the solve, ready for JSON; NaN and infinity become None.

    title and case_sha256: those of the result's case text when left out. flow_direction: (3,), of any
    length; it splits the force of the water into drag and lift, which are None without it.
    audit: the accounts of the run, None when left out. Forces are in N, lengths in m, times in s.

    support_reaction: force of the net on its supports, (3,). max_tension_bar: number of the bar with the
    largest tension, counted from 0 as in bars.csv, None when all are slack; max_tension_bar_label: the labels
    of its two knots. slack_bars: how many bars have no tension, tubes apart. max_displacement: of a knot, against its
    initial position. max_strain: of a bar, (length - rest length) / rest length, 0 where all are slack.
    real_knots, real_bars: those of the real netting where meshes are grouped, group: the most real meshes that one
    stands for along an axis, 1 where all stand for themselves; tensions are those of one real bar.
    residual: largest unbalanced force on a free knot. time: simulated time, None for statics.
    """
    net, outcome, last = result.net, result.outcome, result.frame()
    measures = measure_net(net)
    bar = int(np.argmax(last.tension)) if np.any(last.tension > 0.0) else None
    strain = bar_lengths(result) / net.rest_length - 1.0
    drag, lift = drag_and_lift(last.hydrodynamic_force, flow_direction)
    figures = {
        "title": case_title(result.case_text) if title is None else title,
        "outcome": outcome.name,
        "solver": outcome.solver,
        "linear_solver": outcome.linear_solver,
        "iterations": outcome.iterations,
        "factorizations": outcome.factorizations,
        "residual": outcome.residual,
        "wall_time": outcome.wall_time,
        "knots": net.knot_count,
        "bars": net.bar_count,
        "support_reaction": last.support_reaction.tolist(),
        "hydrodynamic_force": last.hydrodynamic_force.tolist(),
        "weight_in_water": result.weight_in_water,
        "max_tension": float(np.max(last.tension, initial=0.0)),
        "max_tension_bar": bar,
        "slack_bars": int(np.count_nonzero((last.tension <= 0.0) & ~net.two_way)),
        "max_displacement": float(np.max(np.linalg.norm(last.position - net.positions, axis=1))),
        "version": __version__,
        "case_sha256": case_sha256 or case_hash(result.case_text),
        "message": outcome.message,
        "advice": outcome.advice,
        "warnings": list(outcome.warnings),
        "max_tension_bar_label": None if bar is None else net.bar_label(bar),
        "drag": drag,
        "lift": lift,
        "max_strain": float(np.max(strain, initial=0.0)),
        "time": outcome.time if outcome.time > 0.0 else None,
        "real_knots": measures.real_knots,
        "real_bars": measures.real_bars,
        "group": measures.group,
        "rejected": outcome.rejected,
        "force_evaluations": outcome.force_evaluations,
        "audit": None if audit is None else audit.figures(),
    }
    return {key: finite_or_none(value) for key, value in figures.items()}


def finite_or_none(value: Any) -> Any:
    """JSON knows no NaN and no infinity."""
    if isinstance(value, dict):
        return {key: finite_or_none(one) for key, one in value.items()}
    if isinstance(value, list):
        return [finite_or_none(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
