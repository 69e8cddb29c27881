"""The outcome and the accounts of a run in plain words, and its tables of numbers."""

from __future__ import annotations

import math
import platform
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...netting.measures import measure_panel
from ...netting.net import Panel
from ...results.audit import forces_on_knots
from ...results.lines import line_words
from ...results.parts import part_words
from ...results.periods import period_words
from ...results.water import water_words
from ...solve.result import Result
from ...system.system import System
from ...version import __version__

Array = NDArray[np.float64]
Row = tuple[str, str, Any]

PLAIN = {
    "converged": "The net is in equilibrium.",
    "completed": "The run went to its end.",
    "iteration_limit": "The solver ran out of iterations: the shape below is the last one, not an equilibrium.",
    "stalled": "The solver got stuck: the shape below is the last one, not an equilibrium.",
    "singular": "The net cannot be solved as it is held: the shape below is not an equilibrium.",
    "not_finite": "The solver failed: the shape below is the last good one.",
    "out_of_memory": "There was not enough memory to solve the net: the shape below is not an equilibrium.",
    "step_too_small": "The run failed before its end: the last good shape is shown.",
    "not_settled": "The net had not come to rest at the end of the run.",
    "interrupted": "The run was stopped or is still going on: what was there is shown.",
}
VERSIONS = ("numpy", "scipy", "numba", "rslab")


def number(value: float | None, unit: str = "", digits: int = 5) -> str:
    """Write a number with its unit; a dash where there is none."""
    return "–" if value is None else f"{value:.{digits}g}\u00a0{unit}".rstrip()


def vector(values: list[float], unit: str) -> str:
    """Write a vector with its unit; what is only rounding beside its largest component is 0."""
    rounding = 1e-9 * max(map(abs, values))
    return "(" + ", ".join(f"{v if abs(v) > rounding else 0.0:.5g}" for v in values) + f") {unit}"


def key_numbers(figures: dict[str, Any]) -> list[Row]:
    """Name, text and exact value of the numbers at the top of the report, from the summary."""
    bar = figures["max_tension_bar_label"]
    return [
        ("Drag, along the flow", number(figures["drag"], "N"), figures["drag"]),
        ("Lift, across it", number(figures["lift"], "N"), figures["lift"]),
        (
            "Largest tension" + (f", bar {bar}" if bar else ""),
            number(figures["max_tension"], "N"),
            figures["max_tension"],
        ),
        ("Largest strain of a bar", number(100.0 * figures["max_strain"], "%"), figures["max_strain"]),
        ("Slack bars", f"{figures['slack_bars']} of {figures['bars']}", figures["slack_bars"]),
        ("Largest displacement", number(figures["max_displacement"], "m"), figures["max_displacement"]),
        ("Weight in water", number(figures["weight_in_water"], "N"), figures["weight_in_water"]),
        ("Force on the supports", vector(figures["support_reaction"], "N"), None),
        ("Knots and bars", f"{figures['knots']}, {figures['bars']}", figures["knots"]),
        *(
            (name[:1].upper() + name[1:], text, None)
            for name, text in (
                *part_words(figures),
                *period_words(figures),
                *line_words(figures),
                *water_words(figures),
            )
        ),
    ]


def account_words(figures: dict[str, Any]) -> list[str]:
    """Say in sentences how far the forces, and in motion the energies, balance."""
    accounts = figures["audit"]
    if accounts is None:
        return ["The accounts cannot be made, because the result does not say which case made it."]
    size = accounts["load_size"]
    left = math.hypot(*accounts["load_less_reaction"])
    knot = accounts["unbalanced_knot"]
    worst = number(accounts["unbalanced_force"], "N", 2)
    words = [
        f"Loads of {number(size, 'N')} act on the net in all: water, weight less buoyancy and dead loads. "
    ]
    if accounts["energy"] is None:
        words.append(
            f"The force on the supports differs from the sum of the loads by {number(left, 'N', 2)}"
            + (f", {left / size:.1g} of them. " if size else ". ")
            + (f"The worst balanced knot is {knot}, with {worst} left. " if knot else "")
        )
    else:
        words.append(
            f"At the end the largest force that only the inertia of a knot balances is {worst}, at knot {knot}. "
            if knot
            else "All knots are held. "
        )
    steps = f"{figures['iterations']} {'time steps' if accounts['energy'] else 'iterations'}"
    extra = [f"{figures['factorizations']} factorizations"] if figures["factorizations"] else []
    extra += [f"{figures['rejected']} steps taken again"] if figures["rejected"] else []
    if figures["iterations"]:
        words.append(f"It took {', '.join([steps, *extra])} and {number(figures['wall_time'], 's', 3)}.")
    return words


def energy_rows(figures: dict[str, Any]) -> list[Row]:
    """Name, text and value of the energy budget of a dynamic run; empty for a static one."""
    accounts = figures["audit"]
    if accounts is None or accounts["energy"] is None:
        return []
    e = accounts["energy"]
    shares = (
        ("Work of current and waves" if "waves" in figures else "Work of the current", e["current_work"]),
        ("Work of weight and dead loads", -e["potential"]),
        ("Work of turning added mass", e["added_mass_work"]),
        *([("Work of the inertia of the water", e["inertia_work"])] if e["inertia_work"] else []),
        *([("Work of bending and bed", e["parts_work"])] if e["parts_work"] else []),
        *([("Work of moved supports", e["support_work"])] if e["support_work"] else []),
        ("Lost to drag", -e["drag_dissipation"]),
        ("Lost in the twine", -e["twine_dissipation"]),
        ("Gone into motion", -e["kinetic"]),
        ("Gone into stretch", -e["elastic"]),
        ("Left over: numerical damping and sampling", e["remainder"]),
    )
    return [(name, number(value + 0.0, "J", 4), value) for name, value in shares]


def panel_rows(result: Result, panel: Panel) -> list[Row]:
    """Name, text and value of what one panel is made of and what it bears in the last frame."""
    net = result.net
    measures = measure_panel(net, panel)
    twine = next(t for t in net.twines if t.name == panel.twine)
    tension = result.tension[-1][np.unique(panel.bars)]
    knots = np.unique(panel.knots)
    across, down = panel.real_meshes
    few, rows = panel.meshes
    e1, e2 = measures.hanging_ratios
    material = f"{twine.material}, " if twine.material else ""
    return [
        ("Netting", f"{panel.mesh}, {across} × {down} meshes", None),
        *(
            [("Laid with", f"{few} × {rows}, one for {across / few:.4g} × {down / rows:.4g}", None)]
            if panel.grouped_from
            else []
        ),
        (
            "Frame" if panel.shape == "panel" else f"{panel.shape.capitalize()}, laid flat",
            f"{panel.size[0]:.4g} m × {panel.size[1]:.4g} m",
            None,
        ),
        ("Bar length", number(1e3 * panel.bar_length, "mm"), panel.bar_length),
        ("Twine", f"{material}{1e3 * twine.diameter:.4g} mm, {twine.law.describe()}", twine.diameter),
        (
            "Knot diameter",
            number(1e3 * panel.knot_diameter, "mm") if panel.knot_diameter else "knotless",
            panel.knot_diameter,
        ),
        ("Hanging ratios", f"E1 = {e1:.4f}, E2 = {e2:.4f}", None),
        ("Solidity", f"{measures.solidity:.4f}", measures.solidity),
        ("Twine area", number(measures.twine_area, "m²", 4), measures.twine_area),
        (
            "Fixed knots",
            f"{np.count_nonzero(net.fixed[knots])} of {len(net.fixed[knots])}",
            int(np.count_nonzero(net.fixed[knots])),
        ),
        ("Largest tension", number(float(tension.max(initial=0.0)), "N"), float(tension.max(initial=0.0))),
        (
            "Slack bars",
            f"{np.count_nonzero(tension <= 0.0)} of {len(tension)}",
            int(np.count_nonzero(tension <= 0.0)),
        ),
    ]


PART_COLUMNS = (
    "Part",
    "Knots, bars",
    "Drag (N)",
    "Lift (N)",
    "Weight in water (N)",
    "Force on supports (N)",
    "Largest tension (N)",
    "Of strength",
    "Slack bars",
)


def part_table(figures: dict[str, Any]) -> list[list[tuple[str, Any]]]:
    """Text and exact value of every cell under PART_COLUMNS, a row for each part; empty where parts are not known."""
    return [_part_row(part) for part in figures.get("parts", ())]


def _part_row(part: dict[str, Any]) -> list[tuple[str, Any]]:
    bar, used = part["max_tension_bar_label"], part["utilisation"]
    support = math.hypot(*part["support_reaction"])
    kinds = {"float": "floats", "sinker": "sinkers"}
    return [
        (f"{kinds.get(part['kind'], part['kind'])} {part['name']}".rstrip(), None),
        (f"{part['knots']}, {part['bars']}" if part["bars"] else str(part["knots"]), None),
        *((number(part[key]), part[key]) for key in ("drag", "lift", "weight_in_water")),
        (number(support) if part["fixed_knots"] else "–", support),
        (number(part["max_tension"]) + f", bar {bar}" if bar else "–", part["max_tension"]),
        ("–" if used is None else number(100.0 * used, "%", 3), used),
        (str(part["slack_bars"]) if part["bars"] else "–", part["slack_bars"]),
    ]


RING_COLUMNS = (
    "Ring or collar",
    "Weight, buoyancy (N)",
    "Draught (m)",
    "Axial force (N)",
    "Bending moment (N m)",
    "Stress (MPa)",
    "Of yield",
    "Ovality",
    "From netting (N)",
    "From lines (N)",
)


def ring_table(figures: dict[str, Any]) -> list[list[tuple[str, Any]]]:
    """Text and exact value of every cell under RING_COLUMNS, a row for each ring and collar; empty without any."""
    return [_ring_row(ring) for ring in figures.get("rings", ())]


def _ring_row(ring: dict[str, Any]) -> list[tuple[str, Any]]:
    deep = [ring[f"draught_{which}"] for which in ("least", "most")]
    many = f", {ring['tubes']} tubes" if ring["tubes"] > 1 else ""
    stress, used = ring["stress"], ring["utilisation"]
    return [
        (f"{ring['kind']} {ring['name']}".rstrip() + many, None),
        (f"{number(ring['weight'])}, {number(ring['buoyancy'])}", ring["buoyancy"]),
        ("–" if deep[0] is None else f"{number(deep[0], digits=3)} to {number(deep[1], digits=3)}", deep[1]),
        (number(ring["axial_force"]), ring["axial_force"]),
        (number(ring["bending_moment"]), ring["bending_moment"]),
        ("–" if stress is None else number(1e-6 * stress, digits=3), stress),
        ("–" if used is None else number(100.0 * used, "%", 3), used),
        ("–" if ring["ovality"] is None else f"{ring['ovality']:.4f}", ring["ovality"]),
        *((number(math.hypot(*ring[key])), math.hypot(*ring[key])) for key in ("from_netting", "from_lines")),
    ]


def support_rows(result: Result, system: System | None) -> list[tuple[str, str, str, str]]:
    """Part, held knots, force of the net on them and its size, in the last frame; a row per panel, then all.

    system: that of the result; without it the panels are not told apart.
    """
    net, last = result.net, result.frame()
    rows = []
    if system is not None and len(net.panels) > 1:
        force = forces_on_knots(system, last)
        for panel in net.panels:
            knots = np.unique(panel.knots)
            held = knots[net.fixed[knots]]
            if len(held):
                rows.append(_support(panel.name, len(held), force[held].sum(axis=0)))
    return [*rows, _support("whole net", int(np.count_nonzero(net.fixed)), last.support_reaction)]


def _support(name: str, held: int, force: Array) -> tuple[str, str, str, str]:
    return name, str(held), vector(force.tolist(), "N"), number(float(np.linalg.norm(force)), "N")


def versions() -> list[tuple[str, str]]:
    """Programs behind the numbers and their versions."""
    found = [("fyke", __version__), ("Python", platform.python_version())]
    return [*found, *((name, version(name)) for name in VERSIONS)]
