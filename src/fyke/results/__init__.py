"""Results on disk and the figures derived from them."""

from .audit import Audit, EnergyBudget, audit
from .checkpoint import CheckpointError, frames_of, load_checkpoint, save_checkpoint
from .compare import Comparison, MeasurementError, compare
from .derive import summary
from .layout import frame_bytes
from .probes import Probes, probe, write_probes
from .recorder import Recorder
from .store import ResultError, load, save
from .tables import write_summary, write_tables

__all__ = [
    "Audit",
    "CheckpointError",
    "Comparison",
    "EnergyBudget",
    "MeasurementError",
    "Probes",
    "Recorder",
    "ResultError",
    "audit",
    "compare",
    "frame_bytes",
    "frames_of",
    "load",
    "load_checkpoint",
    "probe",
    "save",
    "save_checkpoint",
    "summary",
    "write_probes",
    "write_summary",
    "write_tables",
]
