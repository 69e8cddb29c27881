"""fyke simulates fishing and aquaculture netting in water."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .version import __version__

if TYPE_CHECKING:
    from .case import Case, CaseError, load_case, parse_case
    from .netting.chain import chain
    from .netting.elastic import LinearLaw, PowerLaw, QuadraticLaw, TableLaw
    from .netting.line import line
    from .netting.lines import LinePiece, with_line
    from .netting.net import Net
    from .netting.panel import panel
    from .netting.tubes import Tube
    from .netting.twine import Twine
    from .results import load, save
    from .solve.auto import Auto
    from .solve.dynamic import Settle, simulate
    from .solve.implicit import Implicit, Newmark
    from .solve.modes import Modes, modes
    from .solve.outcome import Outcome
    from .solve.result import Result
    from .solve.static import solve_static
    from .solve.symplectic import Symplectic
    from .solve.verner import Verner
    from .system.build import build_net, build_system, make_system
    from .system.laws import Coefficients, Water
    from .system.system import State, System
    from .water.bed import Bed
    from .water.laws.bars import ConstantBar
    from .water.laws.knots import ConstantKnot

# Names are fetched when first used, so that `import fyke` and `fyke --help` are quick.
_HOME = {
    "Auto": "solve.auto",
    "Bed": "water.bed",
    "Case": "case",
    "CaseError": "case",
    "Coefficients": "system.laws",
    "ConstantBar": "water.laws.bars",
    "ConstantKnot": "water.laws.knots",
    "Implicit": "solve.implicit",
    "LinePiece": "netting.lines",
    "LinearLaw": "netting.elastic",
    "Modes": "solve.modes",
    "Net": "netting.net",
    "Newmark": "solve.implicit",
    "Outcome": "solve.outcome",
    "PowerLaw": "netting.elastic",
    "QuadraticLaw": "netting.elastic",
    "Result": "solve.result",
    "Settle": "solve.dynamic",
    "State": "system.system",
    "Symplectic": "solve.symplectic",
    "System": "system.system",
    "TableLaw": "netting.elastic",
    "Tube": "netting.tubes",
    "Twine": "netting.twine",
    "Verner": "solve.verner",
    "Water": "system.laws",
    "build_net": "system.build",
    "build_system": "system.build",
    "chain": "netting.chain",
    "line": "netting.line",
    "load": "results",
    "load_case": "case",
    "make_system": "system.build",
    "modes": "solve.modes",
    "panel": "netting.panel",
    "parse_case": "case",
    "save": "results",
    "simulate": "solve.dynamic",
    "solve_static": "solve.static",
    "with_line": "netting.lines",
}

__all__ = [
    "Auto",
    "Bed",
    "Case",
    "CaseError",
    "Coefficients",
    "ConstantBar",
    "ConstantKnot",
    "Implicit",
    "LinePiece",
    "LinearLaw",
    "Modes",
    "Net",
    "Newmark",
    "Outcome",
    "PowerLaw",
    "QuadraticLaw",
    "Result",
    "Settle",
    "State",
    "Symplectic",
    "System",
    "TableLaw",
    "Tube",
    "Twine",
    "Verner",
    "Water",
    "__version__",
    "build_net",
    "build_system",
    "chain",
    "line",
    "load",
    "load_case",
    "make_system",
    "modes",
    "panel",
    "parse_case",
    "save",
    "simulate",
    "solve_static",
    "with_line",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'fyke' has no attribute '{name}'")
    return getattr(import_module(f".{_HOME[name]}", __name__), name)


def __dir__() -> list[str]:
    return __all__
