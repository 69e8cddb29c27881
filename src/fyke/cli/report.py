"""fyke report: one HTML page of a result."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..case import Case
from ..results import (
    Comparison,
    MeasurementError,
    ResultError,
    audit,
    compare,
    flow_direction,
    line_figures,
    moments,
    out_of_range,
    part_figures,
    rings_told,
    summary,
    water_figures,
)
from ..results.periods import period_figures
from ..solve.result import Result
from ..system.build import build_net, build_system
from ..system.hanging import hanging
from ..system.system import System
from .export import case_of, opened, taken, unwritten
from .folder import SUMMARY
from .show import DONE, WRONG_INPUT, print_problems, print_warnings, stderr, stdout
from .texts import sources_of

REPORT = "report.html"
LOST = (
    "the case of this result is of another version, or a file that it names is not in the present folder: "
    "accounts, sources, drag and lift are left out"
)


def report_result(file: Path, output: Path | None, positions: Path | None, *, overwrite: bool) -> int:
    """Write the report of a result, given as its file or the folder of its run, and return the exit code."""
    from ..report.page import Origin, write_report

    try:
        source, result = opened(file)
    except ResultError as error:
        stderr().print(str(error), soft_wrap=True)
        return WRONG_INPUT
    target = output or source.with_name(REPORT)
    problem = taken(target, source, overwrite=overwrite)
    if problem is not None:
        print_problems([problem])
        return WRONG_INPUT
    try:
        case, system = behind(result)
        comparison, warnings = _measured(result, case, source, positions)
        figures = _figures(result, case, system)
        if case is None and result.case_text:
            warnings.append(LOST)
        figures["warnings"] += warnings
        figures["load_cases"], figures["worst_load_case"] = _load_cases(source, figures["case_sha256"])
        sources = () if case is None or system is None else sources_of(case, system)
        origin = Origin(source, case, system, sources)
        write_report(result, target, figures=figures, origin=origin, comparison=comparison)
    except MeasurementError as error:
        print_problems(error.problems)
        return WRONG_INPUT
    except OSError as error:
        print_problems([unwritten(target, error)])
        return WRONG_INPUT
    print_warnings(stdout(), warnings)
    size = target.stat().st_size / 1e6
    stdout().print(f"{target}: {size:.1f} MB, opens in any browser, without a network", soft_wrap=True)
    return DONE


def behind(result: Result) -> tuple[Case, System] | tuple[None, None]:
    """Return case and system that made a result; None for a net made in Python and a case of another version."""
    case = case_of(result)
    if case is None:
        return None, None
    system = build_system(build_net(case), case)
    return (case, system) if system.net.labels == result.net.labels else (None, None)


def _measured(
    result: Result, case: Case | None, source: Path, positions: Path | None
) -> tuple[Comparison | None, list[str]]:
    """Compare with the file that is asked for, or with that of the case where it can be found."""
    if positions is not None:
        return compare(result, positions), []
    if case is None or case.compare is None:
        return None, []
    name = case.compare.positions
    for folder in (source.parent, source.parent.parent, Path()):
        if (folder / name).is_file():
            return compare(result, folder / name), []
    return None, [
        f"the measured positions {name} of the case are not near the result: give them with --positions"
    ]


def _figures(result: Result, case: Case | None, system: System | None) -> dict[str, Any]:
    figures = summary(
        result,
        flow_direction=None if system is None else flow_direction(system),
        audit=None if system is None else audit(system, result),
    )
    warnings = [*(() if case is None else case.warnings), *result.outcome.warnings]
    if system is not None:
        depth = None if case is None else case.water.depth
        figures |= water_figures(system, result) | part_figures(system, result, depth=depth)
        figures |= line_figures(system, result)
        figures |= rings_told(system, result)
        if case is not None and case.output.periods is not None and case.solve.kind == "static":
            figures |= period_figures(system, result, case.output.periods)
        warnings += hanging(system, static=case is not None and case.solve.kind == "static")
        warnings += out_of_range(system, moments(result)).warnings
    figures["warnings"] = list(dict.fromkeys(warnings))
    return figures


def _load_cases(source: Path, case_sha256: str) -> tuple[list[dict[str, Any]], str | None]:
    """Return the load cases that the summary beside a result tells of, and the worst; none of another case."""
    try:
        told = json.loads(source.with_name(SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return [], None
    if not isinstance(told, dict) or told.get("case_sha256") != case_sha256:
        return [], None
    return told.get("load_cases", []), told.get("worst_load_case")
