"""Results in the files of other programs: VTKHDF and VTU for ParaView, tables for everything else."""

from .tidy import write_csv
from .vtkhdf import write_vtkhdf
from .vtu import write_vtu

__all__ = ["write_csv", "write_vtkhdf", "write_vtu"]
