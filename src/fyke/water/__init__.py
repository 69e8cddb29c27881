"""Currents: the velocity of the water at points and times."""

from .current import Current, RampedCurrent, UniformCurrent
from .profile import LayerCurrent, PowerCurrent, TableCurrent
from .series import SeriesCurrent

__all__ = [
    "Current",
    "LayerCurrent",
    "PowerCurrent",
    "RampedCurrent",
    "SeriesCurrent",
    "TableCurrent",
    "UniformCurrent",
]
