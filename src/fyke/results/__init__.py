"""Results on disk and the figures derived from them."""

from .audit import Audit, EnergyBudget, audit
from .checkpoint import CheckpointError, frames_of, load_checkpoint, save_checkpoint
from .compare import Comparison, MeasurementError, compare
from .derive import finite_or_none, summary, unit_of
from .layout import frame_bytes
from .lines import LineFigures, by_line, line_figures, write_lines
from .loads import LoadRow, PartLoad, load_figures, load_row, worst_of, write_loads
from .parts import PartFigures, by_part, part_figures, write_parts
from .probes import Probes, probe, probes_of, write_probes
from .ranges import OutOfRange, moments, out_of_range
from .recorder import Recorder
from .rings import RingFigures, ring_figures, rings_told, write_rings
from .store import ResultError, load, save
from .tables import write_summary, write_tables
from .water import flow_direction, mean_current, water_figures

__all__ = [
    "Audit",
    "CheckpointError",
    "Comparison",
    "EnergyBudget",
    "LineFigures",
    "LoadRow",
    "MeasurementError",
    "OutOfRange",
    "PartFigures",
    "PartLoad",
    "Probes",
    "Recorder",
    "ResultError",
    "RingFigures",
    "audit",
    "by_line",
    "by_part",
    "compare",
    "finite_or_none",
    "flow_direction",
    "frame_bytes",
    "frames_of",
    "line_figures",
    "load",
    "load_checkpoint",
    "load_figures",
    "load_row",
    "mean_current",
    "moments",
    "out_of_range",
    "part_figures",
    "probe",
    "probes_of",
    "ring_figures",
    "rings_told",
    "save",
    "save_checkpoint",
    "summary",
    "unit_of",
    "water_figures",
    "worst_of",
    "write_lines",
    "write_loads",
    "write_parts",
    "write_probes",
    "write_rings",
    "write_summary",
    "write_tables",
]
