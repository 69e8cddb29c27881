"""Results on disk and the figures derived from them."""

from .compare import Comparison, MeasurementError, compare
from .derive import summary
from .recorder import Recorder
from .store import ResultError, load, save
from .tables import write_summary, write_tables

__all__ = [
    "Comparison",
    "MeasurementError",
    "Recorder",
    "ResultError",
    "compare",
    "load",
    "save",
    "summary",
    "write_summary",
    "write_tables",
]
