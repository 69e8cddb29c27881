"""The motion that a case asks for, of the knots that it names."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..case.errors import CaseError, Problem
from ..case.motion import MotionRecord, MotionSpec
from ..case.schema import Case
from ..netting.net import Net
from ..netting.references import is_gear, knots_named
from .courses import Course, Record, Steady, Swing
from .motion import Motion, Move, Turn

Indices = NDArray[np.int64]


def motion_of(net: Net, case: Case) -> Motion | None:
    """Return the motion of a case's held knots, None without one and in a static case, which is that of time 0.

    CaseError for what is not held, and for a file that cannot be used.
    """
    if not case.motion or case.solve.kind == "static":
        return None
    problems: list[Problem] = []
    named = [_knots(net, spec, number, problems) for number, spec in enumerate(case.motion, 1)]
    if problems:
        raise CaseError(problems)
    return Motion(net, [_move(net, spec, knots) for spec, knots in zip(case.motion, named, strict=True)])


def _knots(net: Net, spec: MotionSpec, number: int, problems: list[Problem]) -> Indices:
    """Knots that one motion moves; what is wrong with them is added to problems."""
    if spec.of is None:
        if not net.fixed.any():
            where, allowed = f"[[motion]] {number}", "held knots, which alone can be moved"
            problems.append(
                Problem(where, "a net without a held knot", allowed, 'write fixed = "edges" of its gear')
            )
        return np.flatnonzero(net.fixed)
    out = [np.zeros(0, dtype=np.int64)]
    for name in spec.of:
        knots = knots_named(net, name)
        held = knots[net.fixed[knots]]
        if not len(held) or (len(held) < len(knots) and not is_gear(net, name)):
            found = f'"{name}": {len(knots) - len(held)} of its {len(knots)} knots are free'
            allowed, cure = "knots that are held", "hold them, or leave of out for all that is held"
            problems.append(Problem(f"[[motion]] {number} of", found, allowed, cure))
        out.append(held)
    return np.unique(np.concatenate(out))


def _move(net: Net, spec: MotionSpec, knots: Indices) -> Move:
    shifts: list[Course] = []
    if spec.velocity is not None:
        shifts.append(Steady(np.array(spec.velocity), spec.ramp))
    if spec.amplitude is not None and spec.period is not None:
        shifts.append(Swing(np.array(spec.amplitude), spec.period, spec.phase, spec.ramp))
    record = spec.record()
    if record is not None and record.shifts is not None:
        shifts.append(Record(record.times, record.shifts, spec.ramp))
    return Move(knots, tuple(shifts), tuple(_turns(net, spec, knots, record)))


def _turns(net: Net, spec: MotionSpec, knots: Indices, record: MotionRecord | None) -> list[Turn]:
    turn, turns = spec.rotation, []
    point = net.positions[knots].mean(axis=0)
    if turn is not None and turn.point is not None:
        point = np.array(turn.point)
    if turn is not None and turn.axis is not None:
        angle: Course = Steady(np.array([turn.rate or 0.0]), spec.ramp)
        period = turn.period or spec.period
        if turn.amplitude is not None and period is not None:
            angle = Swing(np.array([turn.amplitude]), period, turn.phase, spec.ramp)
        turns.append(Turn(turn.axis, point, angle))
    if record is not None and record.angles is not None:
        columns = zip(np.eye(3), record.angles.T, strict=True)
        turns += [Turn(axis, point, Record(record.times, one[:, None], spec.ramp)) for axis, one in columns]
    return turns
