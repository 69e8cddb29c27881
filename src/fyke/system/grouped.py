"""The system of a panel with fewer, larger meshes on the same frame, that behave like the many."""

from __future__ import annotations

from dataclasses import replace

from ..netting.coarser import coarser
from ..netting.grouping import Grid
from .build import make_system
from .system import System


def grouped(system: System, fine: Grid, coarse: Grid) -> System:
    """Return the system with the meshes of the coarse grid in place of the fine grid's, which is the system's own."""
    net = coarser(system.net, fine, coarse)
    made = make_system(
        net,
        current=system.current,
        water=system.water,
        coefficients=system.coefficients,
        waves=system.waves,
        surface=system.surface,
    )
    return replace(
        system,
        net=net,
        elements=made.elements,
        displaced=made.displaced,
        drag_laws=made.drag_laws,
        faces=made.faces,
        motion=None,
        sources=(),
        case_text="",
    )
