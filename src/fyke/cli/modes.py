"""fyke modes: the static equilibrium of a case and its slowest natural periods, added mass included."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.text import Text

from ..case import Case, CaseError, Problem, load_case
from ..results.periods import told_modes
from ..solve.modes import Modes, modes
from ..solve.result import Result
from ..solve.static import solve_static
from ..system.build import build_net, build_system
from ..system.carriage import seen_from_the_carriage
from ..system.system import System
from ..water.current import at_full_strength
from .show import (
    DONE,
    NOT_CONVERGED,
    WRONG_INPUT,
    print_json,
    print_problems,
    print_rows,
    print_warnings,
    problems_as_json,
    quantity,
    stderr,
    stdout,
)

# Loose knots that are shown by name.
MOST_NAMED = 5


def show_modes(file: Path, count: int, *, json: bool) -> int:
    """Print the natural periods about the static equilibrium of a case file and return the exit code."""
    try:
        case = load_case(file)
        system = build_system(build_net(case), case)
        system = _at_rest(file, replace(system, current=at_full_strength(system.current)))
        rest = solve_static(system, tolerance=case.solve.tolerance)
        found = _modes(file, system, rest, count) if rest.outcome.ok else None
    except CaseError as error:
        if json:
            print_json(problems_as_json(error.problems))
        else:
            print_problems(error.problems)
        return WRONG_INPUT
    findings = _findings(case, system, rest, found)
    if json:
        print_json(findings)
    elif found is not None:
        _show(case.title or file.stem, findings)
    if found is not None:
        return DONE
    end = rest.outcome
    stderr().print(Text(f"{end.name}: {end.message}\n{end.advice}".rstrip()))
    return NOT_CONVERGED


def _at_rest(file: Path, system: System) -> System:
    """Return a system that may come to rest: a towed one as it is seen from the carriage."""
    try:
        return seen_from_the_carriage(system)
    except ValueError as error:
        cure = "tow all held knots at one velocity"
        raise CaseError(
            [Problem(f"{file}, [[motion]]", str(error), "a net that comes to rest", cure)]
        ) from None


def _modes(file: Path, system: System, rest: Result, count: int) -> Modes:
    try:
        return modes(system, rest.position[-1], count=count)
    except ValueError as error:
        cure = "give its twine a density or the knot a diameter and a density"
        raise CaseError([Problem(str(file), str(error), "a mass for every free knot", cure)]) from None


def _findings(case: Case, system: System, rest: Result, found: Modes | None) -> dict[str, Any]:
    """Return what was found, ready for JSON.

    modes: as results.periods tells them; loose: labels of the knots without a period; falling: how many of the modes
    are no oscillations, because a tube buckles.
    """
    labels, net = system.net.labels, system.net
    listed = [] if found is None else told_modes(system, rest.position[-1], found)
    return {
        "title": case.title,
        "knots": net.knot_count,
        "bars": net.bar_count,
        "modes": listed,
        "falling": 0 if found is None else found.falling,
        "loose": [] if found is None else [labels[knot] for knot in found.loose],
        "outcome": rest.outcome.name,
        "message": rest.outcome.message,
        "advice": rest.outcome.advice,
        "residual": rest.outcome.residual,
        "warnings": list(dict.fromkeys([*case.warnings, *rest.outcome.warnings])),
        "case_sha256": case.sha256,
    }


def _show(title: str, findings: dict[str, Any]) -> None:
    console = stdout()
    rows = [
        ("knots, bars", f"{findings['knots']}, {findings['bars']}"),
        ("equilibrium", findings["message"]),
    ]
    loose = findings["loose"]
    if loose:
        named = ", ".join(loose[:MOST_NAMED]) + (" .." if len(loose) > MOST_NAMED else "")
        rows.append(("loose knots", f"{len(loose)}, on slack bars only and left out: {named}"))
    if findings["falling"]:
        rows.append(
            ("falling", f"the first {findings['falling']}: the equilibrium is not stable in still water")
        )
    print_rows(console, title, rows)
    console.print(Text("Natural modes, slowest first; undamped, with added mass", style="bold"))
    console.print(Text("  mode     period  frequency  moves most", style="dim"))
    for number, one in enumerate(findings["modes"], 1):
        period = quantity(one["period"], "s")
        along = ", ".join(f"{part:.2f}" for part in (x + 0.0 for x in np.round(one["direction"], 2)))
        console.print(
            f"  {number:4d} {period:>10} {quantity(one['frequency'], 'Hz'):>10}  knot {one['largest_motion']} "
            f"along [{along}]"
        )
    print_warnings(console, findings["warnings"])
