"""The tools that take part, each with its ladder of options."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from peer_motion import cvode, diffrax, fyke_motion, moordyn, mujoco, solve_ivp
from peer_panel import Work
from peer_statics import AS_BUILT, BULGED, cone_program, fyke_static, relaxation, scipy_static

import fyke

MOTION, STATICS, LARGE = "motion, 8 x 8", "statics, 8 x 8", "statics, 32 x 32"


@dataclass(frozen=True)
class Tool:
    """One row of the table: what it needs, which function makes it work, and its ladder of options, loosest first."""

    name: str
    work: str
    package: str
    make: Callable[..., Work]
    ladder: dict[str, tuple[Any, ...]]


def _tolerances(*first: str) -> dict[str, tuple[Any, ...]]:
    pairs = ((1e-3, 1e-6), (1e-4, 1e-7), (1e-5, 1e-8))
    return {f"rtol {r:g}, atol {a:g} m": (*first, r, a) for r, a in pairs}


def _steps(*steps: float) -> dict[str, tuple[Any, ...]]:
    return {f"step {1e6 * step:g} us": (step,) for step in steps}


def _starts(method: str) -> dict[str, tuple[Any, ...]]:
    return {start: (method, start) for start in (AS_BUILT, BULGED)}


# Leapfrog's longest stable step is no friend of bars that snap taut undamped.
CLOSER = {"Symplectic": {f"step {1e6 * step:g} us": ("Symplectic", step) for step in (50e-6, 40e-6)}}
STEPPERS = [name for name in ("Symplectic", "Verner", "Implicit") if hasattr(fyke, name)]
TOOLS = [
    *(
        Tool(f"fyke {name}", MOTION, "fyke", fyke_motion, {"defaults": (name,)} | CLOSER.get(name, {}))
        for name in STEPPERS
    ),
    Tool("diffrax Tsit5", MOTION, "diffrax", diffrax, _tolerances()),
    Tool("MuJoCo Euler", MOTION, "mujoco", mujoco, _steps(60e-6, 50e-6, 40e-6)),
    Tool("MoorDyn RK4", MOTION, "moordyn", moordyn, _steps(90e-6, 45e-6)),
    *(
        Tool(f"SciPy {m}", MOTION, "scipy", solve_ivp, _tolerances(m))
        for m in ("RK45", "DOP853", "Radau", "BDF")
    ),
    Tool("SUNDIALS CVODE BDF, GMRES", MOTION, "scikit-sundae", cvode, _tolerances()),
    Tool("fyke solve_static", STATICS, "fyke", fyke_static, {"defaults": ()}),
    Tool("dynamic relaxation, compiled", STATICS, "numba", relaxation, {"keep 0.995": (0.995, 1e-6)}),
    Tool(
        "Clarabel, load renewed", STATICS, "clarabel", cone_program, {f"{k} times": (k,) for k in (4, 8, 16)}
    ),
    Tool("SciPy root hybr", STATICS, "scipy", scipy_static, _starts("hybr")),
    Tool("SciPy least_squares", STATICS, "scipy", scipy_static, _starts("least_squares")),
    Tool("SciPy root df-sane", STATICS, "scipy", scipy_static, _starts("df-sane")),
    Tool("fyke solve_static", LARGE, "fyke", fyke_static, {"defaults": ()}),
    Tool("dynamic relaxation, compiled", LARGE, "numba", relaxation, {"keep 0.998": (0.998, 1e-6)}),
    Tool("Clarabel, load renewed", LARGE, "clarabel", cone_program, {f"{k} times": (k,) for k in (4, 8, 16)}),
    *(
        Tool(f"SciPy {shown}", LARGE, "scipy", scipy_static, {BULGED: (method, BULGED)})
        for shown, method in (("least_squares", "least_squares"), ("root df-sane", "df-sane"))
    ),
]
