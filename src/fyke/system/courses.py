"""How far something has moved since time 0: the parts that a motion is made of.

A course has c components, 3 of a shift (m) or 1 of an angle (rad), and gives their values, rates and accelerations at a
time (s), (3, c). At time 0 the values are 0: what is moved begins where it was built.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]

# Steps of a stepper in one period, at least, and while something speeds up.
STEPS_OF_PERIOD, STEPS_OF_RAMP = 20.0, 10.0


class Course(Protocol):
    """One part of a motion."""

    @property
    def steady_from(self) -> float:
        """Time (s) from which the rates stay as they are; infinite where they never do."""

    def at(self, time: float) -> Array:
        """Values, rates and accelerations, (3, c)."""

    def longest_step(self, time: float) -> float:
        """Longest time (s) that a step from there may take without missing something."""


def ramp_up(time: float, duration: float | None) -> Array:
    """Factor, its rate (1/s) and its acceleration (1/s2), (3,), of a smooth start over a duration (s).

    The polynomial of water.ramp; 1 from the beginning without a duration.
    """
    if duration is None or time >= duration:
        return np.array([1.0, 0.0, 0.0])
    x = max(time / duration, 0.0)
    rate = 30.0 * (x * (1.0 - x)) ** 2 / duration
    curve = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / duration**2
    return np.array([x**3 * (10.0 + x * (-15.0 + 6.0 * x)), rate, curve])


def _while_starting(time: float, duration: float | None) -> float:
    """Longest step (s) while a ramp goes on, infinite after it."""
    return np.inf if duration is None or time >= duration else duration / STEPS_OF_RAMP


def _started(values: Array, time: float, duration: float | None) -> Array:
    """Values, rates and accelerations (3, c) times the ramp."""
    factor, rate, curve = ramp_up(time, duration)
    value, slope, bend = values
    return np.array(
        [factor * value, factor * slope + rate * value, factor * bend + 2.0 * rate * slope + curve * value]
    )


@dataclass(frozen=True, eq=False)
class Steady:
    """A constant rate (c,) per s, reached over a ramp (s), or at once without one."""

    rate: Array
    ramp: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", np.atleast_1d(np.asarray(self.rate, dtype=float)))
        _check_positive("ramp", self.ramp)

    @property
    def steady_from(self) -> float:
        """The end of its ramp, s."""
        return self.ramp or 0.0

    def at(self, time: float) -> Array:
        """Values, rates and accelerations, (3, c)."""
        factor, rate, _ = ramp_up(time, self.ramp)
        x = 1.0 if self.ramp is None else min(max(time / self.ramp, 0.0), 1.0)
        # Integral of the ramp: half of its duration is lost.
        way = (self.ramp or 0.0) * (x**4 * (2.5 + x * (x - 3.0)) - x) + min(time, self.ramp or 0.0)
        way += max(time - (self.ramp or 0.0), 0.0)
        return np.outer([way, factor, rate], self.rate)

    def longest_step(self, time: float) -> float:
        """Return a part of the ramp (s)."""
        return _while_starting(time, self.ramp)


@dataclass(frozen=True, eq=False)
class Swing:
    """amplitude (c,) times sin(2 pi t / period + phase), period in s, phase in rad.

    A ramp (s) lets it grow from nothing about the place as built; without one it begins with its full speed, and what
    it has at time 0 is taken off.
    """

    amplitude: Array
    period: float
    phase: float = 0.0
    ramp: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "amplitude", np.atleast_1d(np.asarray(self.amplitude, dtype=float)))
        _check_positive("period", self.period)
        _check_positive("ramp", self.ramp)

    @property
    def steady_from(self) -> float:
        """Return infinity: it never comes to rest."""
        return np.inf

    def at(self, time: float) -> Array:
        """Values, rates and accelerations, (3, c)."""
        omega = 2.0 * pi / self.period
        angle = omega * time + self.phase
        begin = np.sin(self.phase) if self.ramp is None else 0.0
        swing = np.array([np.sin(angle) - begin, omega * np.cos(angle), -(omega**2) * np.sin(angle)])
        return _started(np.outer(swing, self.amplitude), time, self.ramp)

    def longest_step(self, time: float) -> float:
        """Return a part of the period (s)."""
        return min(self.period / STEPS_OF_PERIOD, _while_starting(time, self.ramp))


@dataclass(frozen=True, eq=False)
class Record:
    """Values (t, c) at times (t,) s, at least two, 0 being the first; the cubic spline through them.

    Rates and accelerations have no jump; before the first time and after the last the rate there goes on. Without a
    ramp (s) the first values are taken off.
    """

    times: Array
    values: Array
    ramp: float | None = None
    _spline: CubicSpline = field(init=False, repr=False)
    _step: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        times, values = (np.asarray(one, dtype=float) for one in (self.times, self.values))
        if len(times) < 2 or len(values) != len(times) or not np.all(np.diff(times) > 0.0):
            raise ValueError("a Record needs two times or more that rise, and values (t, c) at each")
        _check_positive("ramp", self.ramp)
        times = times - times[0]
        values = values - values[0] if self.ramp is None else values
        spline = CubicSpline(times, values)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "_spline", spline)
        fastest, sharpest = (float(np.abs(spline(times, order)).max(initial=0.0)) for order in (1, 2))
        # The period of the swing that is as fast and as sharp.
        period = 2.0 * pi * fastest / sharpest if sharpest > 0.0 else np.inf
        object.__setattr__(self, "_step", period / STEPS_OF_PERIOD)

    @property
    def steady_from(self) -> float:
        """Return infinity: it may turn at any time."""
        return np.inf

    def at(self, time: float) -> Array:
        """Values, rates and accelerations, (3, c)."""
        inside = min(max(time, 0.0), float(self.times[-1]))
        value, rate, curve = (self._spline(inside, order) for order in (0, 1, 2))
        if time != inside:
            value, curve = value + (time - inside) * rate, np.zeros_like(curve)
        return _started(np.array([value, rate, curve]), time, self.ramp)

    def longest_step(self, time: float) -> float:
        """Return a part of the period of the swing that is as fast and as sharp (s)."""
        return min(self._step, _while_starting(time, self.ramp))


def of_vector(vector: ArrayLike) -> Array:
    """Return a vector (3,) of three numbers. ValueError for another shape and numbers that are not finite."""
    array = np.asarray(vector, dtype=float)
    if array.shape != (3,) or not np.all(np.isfinite(array)):
        raise ValueError(f"a vector of three numbers is asked, not {vector!r}")
    return array


def _check_positive(name: str, value: float | None) -> None:
    if value is not None and not 0.0 < value < np.inf:
        raise ValueError(f"{name} must be a number of seconds above 0, not {value!r}")
