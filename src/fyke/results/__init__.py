"""Results on disk and the figures derived from them."""

from .audit import Audit, EnergyBudget, audit
from .compare import Comparison, MeasurementError, compare
from .derive import summary
from .recorder import Recorder
from .store import ResultError, load, save
from .tables import write_summary, write_tables

__all__ = [
    "Audit",
    "Comparison",
    "EnergyBudget",
    "MeasurementError",
    "Recorder",
    "ResultError",
    "audit",
    "compare",
    "load",
    "save",
    "summary",
    "write_summary",
    "write_tables",
]
