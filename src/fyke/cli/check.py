"""fyke check: what a case would build, and what looks odd, without solving it."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case import Case, CaseError, load_case, load_cases_of
from ..case.gear import NettingSpec, Sheet
from ..netting.measures import measure_net, measure_panel
from ..netting.net import Panel
from ..results.ranges import bar_values, knot_values, out_of_range
from ..system.build import build_net, build_system
from ..system.carriage import seen_from_the_carriage
from ..system.hanging import hanging
from ..system.system import System
from ..water.current import at_full_strength
from ..water.laws.bars import ConstantBar
from ..water.laws.law import REYNOLDS
from ..water.wakes import GivenWake
from .check_lines import bed_of, bed_words, line_rows, lines_of
from .check_rigging import (
    bodies_of,
    body_rows,
    rope_rows,
    ropes_of,
    seam_rows,
    seams_of,
    tube_rows,
    tubes_of,
)
from .show import (
    DONE,
    WRONG_INPUT,
    percent,
    print_json,
    print_problems,
    print_rows,
    print_warnings,
    problems_as_json,
    quantity,
    stdout,
    vector,
)

Array = NDArray[np.float64]


def check_case(file: Path, *, json: bool) -> int:
    """Judge a case file, print what would be built and return the exit code."""
    try:
        findings = judge(load_case(file))
    except CaseError as error:
        if json:
            print_json(problems_as_json(error.problems))
        else:
            print_problems(error.problems)
        return WRONG_INPUT
    if json:
        print_json(findings)
    else:
        _show(file, findings)
    return DONE


def judge(case: Case) -> dict[str, Any]:
    """Return what the case would build, ready for JSON.

    real_knots, real_bars: of the real netting, twine_length: of all its bars (m), group: the most real meshes that
    one stands for along an axis; laid: meshes of a panel as it is laid. mass: in air (kg); weight_in_water: N,
    positive sinks; panels: one table each sheet of netting, lengths in m, areas in m2, mass_per_area in kg/m2, rtex
    in tex; strain: largest as built, negative where all bars are slack; rims: diameters (m) of the lower and the
    upper rim of netting that closes round, None of a flat panel; ends: meshes along the upper and the lower edge of one
    that is cut to shape, else None;
    reynolds: speed of the current at the surface times twine diameter over viscosity; reynolds_across: least and
    largest by the speed across the flat panel's bars, reynolds_knots: by the knot diameter; damping_time: longest
    retardation time (s).
    seams: one table each, knots of both edges; ropes: the same, lengths in m, stiffness: EA in N; tubes: rings and
    collars, see tubes_of; lines: see lines_of; bed: of the sea, None without one; bodies: floats and sinkers, one table
    each kind, mass (kg), diameter (m), weight_in_water (N, negative floats) and drag_area (m2) of each one,
    total_weight of all.
    load_cases: name, current and waves of each, in words.
    drag, shelter: the laws by their words; out_of_range: at how many bars, knots or screens those of drag leave their
    ranges in the undisturbed current.
    """
    net = build_net(case)
    system = build_system(net, case)
    measures, viscosity = measure_net(net), system.water.kinematic_viscosity
    steady = replace(
        _from_the_carriage(system),
        waves=None,
        coefficients=replace(system.coefficients, wake=None, twines=None),
    )
    water = steady.current.velocity(net.positions, 0.0)
    numbers = (
        bar_values(net, net.positions, water, ConstantBar(), viscosity)[REYNOLDS],
        knot_values(net, water, viscosity)[REYNOLDS],
    )
    outside = out_of_range(steady, [(0.0, net.positions, np.zeros_like(net.positions))])
    return {
        "title": case.title,
        "solve": case.solve.kind,
        **asdict(measures),
        "weight_in_water": system.weight_in_water,
        "current": list(case.current.at_surface),
        "current_words": case.current.described,
        "waves": case.waves.described if case.waves else None,
        "motion": _motions(case, system),
        "drag": _drag(system),
        "shelter": _shelter(system),
        "panels": [
            _panel(case, system, panel, made, *numbers)
            for panel, made in zip(net.panels, case.sheets, strict=True)
        ],
        "seams": seams_of(case),
        "ropes": ropes_of(case, system),
        "tubes": tubes_of(case, system),
        "lines": lines_of(system),
        "bed": bed_of(case),
        "bodies": bodies_of(case, system),
        "warnings": [*case.warnings, *hanging(system, static=case.solve.kind == "static"), *outside.warnings],
        "out_of_range": outside.counts,
        "load_cases": _load_cases(case),
        "case_sha256": case.sha256,
    }


def _load_cases(case: Case) -> list[dict[str, str]]:
    """Return every load case by its name, with its current and waves in words."""
    return [
        {
            "name": name,
            "current": vector(one.current.at_surface, "m/s"),
            "waves": one.waves.described if one.waves else "",
        }
        for _, name, one in load_cases_of(case)
    ]


def _from_the_carriage(system: System) -> System:
    """Return a towed system as it is seen from the carriage, where one carriage tows it."""
    full = replace(system, current=at_full_strength(system.current))
    try:
        return seen_from_the_carriage(full)
    except ValueError:
        return full


def _motions(case: Case, system: System) -> list[dict[str, Any]]:
    """Return how many knots each motion moves, of what, and how."""
    moves = system.motion.moves if system.motion else ()
    return [
        {"of": list(spec.of) if spec.of else None, "knots": len(move.knots), "words": spec.described}
        for spec, move in zip(case.motion, moves, strict=False)
    ]


def _drag(system: System) -> dict[str, str]:
    """Return the words of the laws of drag that act, by what they act on."""
    c = system.coefficients
    if c.screens is not None:
        return {"screens": c.screens.name}
    return {"bars": c.bars.name, "knots": c.knots.name}


def _shelter(system: System) -> dict[str, str]:
    """Return the words of the laws of shelter that are asked for, a given factor as its number."""
    c = system.coefficients
    wake = f"{c.wake.left:g}" if isinstance(c.wake, GivenWake) else c.wake and c.wake.name
    return {key: word for key, word in (("wake", wake), ("twines", c.twines and c.twines.name)) if word}


def _span(values: Array) -> list[float]:
    """Return the least and the largest of some numbers, NaN left out; zeros where there is none."""
    there = values[np.isfinite(values)]
    return [float(there.min()), float(there.max())] if there.size else [0.0, 0.0]


def _panel(
    case: Case,
    system: System,
    panel: Panel,
    made: tuple[NettingSpec, Sheet],
    across: Array,
    at_knots: Array,
) -> dict[str, Any]:
    net, twine = system.net, case.twine[panel.twine]
    netting, sheet = made
    speed = float(np.linalg.norm(case.current.at_surface))
    return {
        "name": panel.name,
        "shape": panel.shape,
        "netting": next(name for name, spec in case.netting.items() if spec is netting),
        "mesh": netting.mesh_name,
        "meshes": list(panel.real_meshes),
        "laid": list(panel.meshes),
        "ends": [len(panel.edge(end)) - 1 for end in ("top", "bottom")] if panel.taper else None,
        "segments": netting.segments,
        "size": list(panel.size),
        "rims": list(sheet.rims) if sheet.rims else None,
        **asdict(measure_panel(net, panel)),
        "fixed": int(np.count_nonzero(net.fixed[np.unique(panel.knots)])),
        "strain": sheet.strain(netting),
        "reynolds": speed * twine.diameter / case.water.kinematic_viscosity,
        "reynolds_across": _span(across[panel.bars]),
        "reynolds_knots": _span(at_knots[panel.knots])[1],
        "damping_time": float(system.elements.damping_time[panel.bars].max()),
        "damping_source": twine.damping_source,
    }


def _show(file: Path, findings: dict[str, Any]) -> None:
    console = stdout()
    sinks = "sinks" if findings["weight_in_water"] >= 0.0 else "floats"
    rows = [
        ("solve", findings["solve"]),
        ("current", ", ".join(filter(None, [vector(findings["current"], "m/s"), findings["current_words"]]))),
        *([("waves", findings["waves"])] if findings["waves"] else []),
        *([("sea bed", bed_words(findings["bed"]))] if findings["bed"] else []),
        *(
            (
                "motion",
                f"{', '.join(one['of'] or ['all that is held'])} ({one['knots']} knots): {one['words']}",
            )
            for one in findings["motion"]
        ),
        ("knots", f"{findings['knots']}, of which fixed {findings['fixed']}" + _real(findings, "real_knots")),
        ("bars", f"{findings['bars']}" + _real(findings, "real_bars")),
        ("length of bars", quantity(findings["twine_length"], "m")),
        ("drag", _words(findings["drag"])),
        *([("shelter", _words(findings["shelter"]))] if findings["shelter"] else []),
        ("mass in air", quantity(findings["mass"], "kg")),
        ("weight in water", f"{quantity(findings['weight_in_water'], 'N')} ({sinks})"),
    ]
    print_rows(console, findings["title"] or file.stem, rows)
    for panel in findings["panels"]:
        name = f"{panel['shape']} {panel['name']}".rstrip()
        print_rows(console, f"{name}: {panel['mesh']} netting '{panel['netting']}'", _panel_rows(panel))
    for seam in findings["seams"]:
        print_rows(console, f"seam {seam['name']}", seam_rows(seam))
    for rope in findings["ropes"]:
        print_rows(console, f"rope {rope['name']}: twine '{rope['twine']}'", rope_rows(rope))
    for tube in findings["tubes"]:
        print_rows(console, f"{tube['kind']} {tube['name']}: tube '{tube['tube']}'", tube_rows(tube))
    for line in findings["lines"]:
        print_rows(console, f"line {line['name']}: {', '.join(line['twines'])}", line_rows(line))
    for bodies in findings["bodies"]:
        print_rows(console, f"{bodies['kind']} {bodies['name']}", body_rows(bodies))
    if findings["load_cases"]:
        rows = [
            (one["name"], "; ".join(filter(None, (one["current"], one["waves"]))))
            for one in findings["load_cases"]
        ]
        print_rows(console, "load cases", rows)
    print_warnings(console, findings["warnings"])
    if not findings["warnings"]:
        console.print("Nothing looks odd.")


def _real(findings: dict[str, Any], key: str) -> str:
    return f", for {findings[key]} real ones" if findings["group"] > 1.0 else ""


def _words(laws: dict[str, str]) -> str:
    return ", ".join(f"{what}: {law}" for what, law in laws.items())


def _panel_rows(panel: dict[str, Any]) -> list[tuple[str, str]]:
    across, down = panel["meshes"]
    few, rows = panel["laid"]
    width, height = panel["size"]
    e1, e2 = panel["hanging_ratios"]
    state = "taut" if panel["strain"] > 0.0 else "slack"
    return [
        ("meshes", f"{_meshes(panel)}, stretched {panel['mesh_length'] * 1e3:.4g} mm"),
        *(
            [("laid with", f"{few} x {rows} = {few * rows}, one for {across / few:.4g} x {down / rows:.4g}")]
            if [few, rows] != [across, down]
            else []
        ),
        *([("bars", f"in {panel['segments']} segments each")] if panel["segments"] > 1 else []),
        *_outline(panel, width, height),
        ("hanging ratios", f"E1 = {e1:.4f}, E2 = {e2:.4f}"),
        ("solidity", f"{panel['solidity']:.4f}"),
        ("twine area", quantity(panel["twine_area"], "m2")),
        ("mass per area", quantity(panel["mass_per_area"], "kg/m2")),
        ("twine", quantity(panel["rtex"], "tex")),
        ("fixed knots", f"{panel['fixed']}"),
        (
            "bar strain as built" if panel["rims"] else "bar strain when flat",
            f"{percent(panel['strain'])} ({state})",
        ),
        ("Reynolds number", _reynolds(panel)),
        ("twine damping", f"{quantity(panel['damping_time'] * 1e6, 'us', 3)}, {panel['damping_source']}"),
    ]


def _meshes(panel: dict[str, Any]) -> str:
    across, down = panel["meshes"]
    if panel["ends"]:
        high, low = panel["ends"]
        return f"{high} above, {low} below, {down} high"
    return f"{across} x {down} = {across * down}"


def _outline(panel: dict[str, Any], width: float, height: float) -> list[tuple[str, str]]:
    area = quantity(panel["outline_area"], "m2")
    if panel["shape"] == "box":
        return [("walls", f"{width:.4g} m round, {height:.4g} m deep, {area}")]
    if panel["rims"] is None:
        return [("frame", f"{width:.4g} m x {height:.4g} m, {area}")]
    low, high = panel["rims"]
    rims = f"{high:.4g} m" if low == high else f"{low:.4g} m below, {high:.4g} m above"
    return [
        ("diameter", "tip below, rim " + f"{high:.4g} m" if low == 0.0 else rims),
        ("netting", f"{width:.4g} m round in the mean, {height:.4g} m along it, {area}"),
    ]


def _reynolds(panel: dict[str, Any]) -> str:
    low, high = (f"{value:.4g}" for value in panel["reynolds_across"])
    span = high if low == high else f"{low} to {high}"
    knots = f", {panel['reynolds_knots']:.4g} at the knots" if panel["reynolds_knots"] else ""
    return f"{span} across the bars{knots}"
