"""Result: what a solve hands back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..forces.frame import Frame
from ..netting.net import Net
from ..system.system import State
from .outcome import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Result:
    """Frames of a solve, stacked; one frame for statics, k for dynamics.

    Shapes and units are those of Frame with the time axis put in front: time (k,) s, position (k, n, 3) m,
    velocity (k, n, 3) m/s, tension (k, m) N, bar_drag and bar_lift (k, m) N, water_velocity (k, m, 3) m/s,
    water_force (k, n, 3) N, hydrodynamic_force and support_reaction (k, 3) N, kinetic_energy (k,) J,
    unbalanced_force (k,) N.
    weight_in_water: weight less buoyancy of the whole net, (N, positive sinks); case_text: the case file as read,
    "" for a net made in Python.
    """

    net: Net
    outcome: Outcome
    weight_in_water: float
    time: Array
    position: Array
    velocity: Array
    tension: Array
    bar_drag: Array
    bar_lift: Array
    water_velocity: Array
    water_force: Array
    hydrodynamic_force: Array
    support_reaction: Array
    kinetic_energy: Array
    unbalanced_force: Array
    case_text: str = ""

    @classmethod
    def from_frames(
        cls, net: Net, outcome: Outcome, weight_in_water: float, frames: Sequence[Frame], case_text: str = ""
    ) -> Result:
        """Stack frames, at least one."""
        stacked = {f.name: np.array([getattr(frame, f.name) for frame in frames]) for f in fields(Frame)}
        return cls(net, outcome, weight_in_water, case_text=case_text, **stacked)

    def state(self, index: int = -1) -> State:
        """Return the state at one frame, tensions included; the last by default. A warm start for statics."""
        pull = self.net.bar_multiple * self.tension[index]
        return State(float(self.time[index]), self.position[index], self.velocity[index], pull)

    def frame(self, index: int = -1) -> Frame:
        """Return one frame; the last by default."""
        return Frame(**{f.name: getattr(self, f.name)[index] for f in fields(Frame)})

    @property
    def plot(self) -> Any:
        """Plots into matplotlib axes: plot.shape(ax=None), plot.tension(ax=None), plot.history(ax=None, of="drag")."""
        return _further("report.notebook").Plot(self)

    def to_xarray(self) -> Any:
        """Return the result as an xarray.Dataset with units, meanings and the labels of the knots."""
        return _further("results.dataset").to_xarray(self)

    def _repr_html_(self) -> str:
        text: str = _further("report.notebook").glance(self)
        return text


def _further(name: str) -> Any:
    """Return a module of a later layer, fetched when a notebook asks: solving needs neither pictures nor files."""
    return import_module(f"fyke.{name}")
