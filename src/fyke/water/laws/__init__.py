"""Published laws of the coefficients of drag and lift: of bars, of knots, and of whole panels of netting.

They are what papers say, with source, range, reference area and convention of the angle; nothing here knows a net.
`LAWS` lists them by kind, each under the name that a case file would use.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from . import bars, knots, panels
from .joints import BAND, LEAST_REYNOLDS, Curve, joined
from .law import AngleLaw, BarLaw, KnotLaw, Law, PanelLaw, Range, SplitLaw, outside
from .table import AngleTable, BarTable

__all__ = [
    "BAND",
    "LAWS",
    "LEAST_REYNOLDS",
    "AngleLaw",
    "AngleTable",
    "BarLaw",
    "BarTable",
    "Curve",
    "KnotLaw",
    "Law",
    "PanelLaw",
    "Range",
    "SplitLaw",
    "joined",
    "outside",
]


def _by_name(*laws: type[Law]) -> Mapping[str, type[Law]]:
    return MappingProxyType({law.name: law for law in laws})


LAWS: Mapping[str, Mapping[str, type[Law]]] = MappingProxyType(
    {
        "bars": _by_name(
            bars.ConstantBar,
            bars.ChooCasarella,
            bars.Takagi,
            bars.BessonneauMarichal,
            bars.Wan,
            bars.CifuentesKim,
            bars.Hoerner,
            bars.White,
            bars.SuckerBrauer,
            bars.Cheng,
            bars.KristiansenFaltinsenBar,
            BarTable,
            AngleTable,
        ),
        "knots": _by_name(
            knots.ConstantKnot, knots.SchillerNaumann, knots.CliftGauvin, knots.CliftGraceWeber
        ),
        "panels": _by_name(
            panels.Aarsnes,
            panels.Loland,
            panels.KristiansenFaltinsen,
            panels.Balash,
            panels.Fridman,
            panels.Bi,
            panels.Lee,
        ),
    }
)
