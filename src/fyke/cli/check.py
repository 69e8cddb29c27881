"""fyke check: what a case would build, and what looks odd, without solving it."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..case import Case, CaseError, load_case
from ..netting.lattice import flat_strain
from ..netting.measures import measure_net, measure_panel
from ..netting.net import Panel
from ..system.build import build_net, build_system
from ..system.system import System
from .show import (
    DONE,
    WRONG_INPUT,
    print_json,
    print_problems,
    print_rows,
    print_warnings,
    problems_as_json,
    quantity,
    stdout,
    vector,
)


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

    mass: in air (kg); weight_in_water: N, positive sinks; panels: one table each, lengths in m, areas in m2,
    mass_per_area in kg/m2, rtex in tex; strain: largest of the flat panel, negative where all bars are slack;
    reynolds: speed of the current times twine diameter over viscosity; damping_time: longest retardation time (s).
    """
    net = build_net(case)
    system = build_system(net, case)
    measures = measure_net(net)
    return {
        "title": case.title,
        "solve": case.solve.kind,
        **asdict(measures),
        "weight_in_water": system.weight_in_water,
        "current": list(case.current.velocity),
        "panels": [_panel(case, system, panel) for panel in net.panels],
        "warnings": list(case.warnings),
        "case_sha256": case.sha256,
    }


def _panel(case: Case, system: System, panel: Panel) -> dict[str, Any]:
    net, twine = system.net, case.twine[panel.twine]
    spec = next(one for one in case.gear if one.name == panel.name)
    mesh = case.netting[spec.netting].mesh
    speed = float(np.linalg.norm(case.current.velocity))
    return {
        "name": panel.name,
        "netting": spec.netting,
        "mesh": mesh,
        "meshes": list(panel.meshes),
        "size": list(panel.size),
        **asdict(measure_panel(net, panel)),
        "fixed": int(np.count_nonzero(net.fixed[slice(*panel.knots)])),
        "strain": max(flat_strain(mesh, panel.meshes, panel.bar_length, panel.size)),
        "reynolds": speed * twine.diameter / case.water.kinematic_viscosity,
        "damping_time": float(system.elements.damping_time[slice(*panel.bars)].max()),
        "damping_source": twine.damping_source,
    }


def _show(file: Path, findings: dict[str, Any]) -> None:
    console = stdout()
    sinks = "sinks" if findings["weight_in_water"] >= 0.0 else "floats"
    rows = [
        ("solve", findings["solve"]),
        ("current", vector(findings["current"], "m/s")),
        ("knots", f"{findings['knots']}, of which fixed {findings['fixed']}"),
        ("bars", f"{findings['bars']}"),
        ("mass in air", quantity(findings["mass"], "kg")),
        ("weight in water", f"{quantity(findings['weight_in_water'], 'N')} ({sinks})"),
    ]
    print_rows(console, findings["title"] or file.stem, rows)
    for panel in findings["panels"]:
        name = f"panel {panel['name']}".rstrip()
        print_rows(console, f"{name}: {panel['mesh']} netting '{panel['netting']}'", _panel_rows(panel))
    print_warnings(console, findings["warnings"])
    if not findings["warnings"]:
        console.print("Nothing looks odd.")


def _panel_rows(panel: dict[str, Any]) -> list[tuple[str, str]]:
    across, down = panel["meshes"]
    width, height = panel["size"]
    e1, e2 = panel["hanging_ratios"]
    state = "taut" if panel["strain"] > 0.0 else "slack"
    return [
        ("meshes", f"{across} x {down} = {across * down}, stretched {panel['mesh_length'] * 1e3:.4g} mm"),
        ("frame", f"{width:.4g} m x {height:.4g} m, {quantity(panel['outline_area'], 'm2')}"),
        ("hanging ratios", f"E1 = {e1:.4f}, E2 = {e2:.4f}"),
        ("solidity", f"{panel['solidity']:.4f}"),
        ("twine area", quantity(panel["twine_area"], "m2")),
        ("mass per area", quantity(panel["mass_per_area"], "kg/m2")),
        ("twine", quantity(panel["rtex"], "tex")),
        ("fixed knots", f"{panel['fixed']}"),
        ("bar strain when flat", f"{panel['strain'] * 100:.2f} % ({state})"),
        ("Reynolds number", f"{panel['reynolds']:.0f} at the bars"),
        ("twine damping", f"{quantity(panel['damping_time'] * 1e6, 'us', 3)}, {panel['damping_source']}"),
    ]
