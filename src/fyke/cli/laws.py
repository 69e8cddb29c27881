"""fyke laws: the drag laws that are known, and pictures of them."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from dataclasses import MISSING, Field, fields
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from rich.text import Text

from ..case import CaseError, Problem
from ..case.drag_table import read_drag_table
from ..water.inertia import ADDED_MASS_LAWS, AddedMassLaw
from ..water.laws import LAWS, AngleLaw, BarLaw, KnotLaw, Law
from ..water.wakes import TWINES, WAKES, WakeLaw
from .show import DONE, WRONG_INPUT, print_json, print_problems, stdout

TITLES = {
    "bars": "Bars: drag across and along a bar, by the Reynolds number of the twine",
    "knots": "Knots: drag of a sphere, by the Reynolds number of the knot",
    "panels": "Panels: drag and lift of a plane panel as a whole, by angle and solidity",
    "wakes": "Wakes: the part of the current that is left behind netting",
    "twines": "Twines: the part of the current that is left between the twines of a panel",
    "added_mass": "Added mass: of a bar across itself, over the mass of the water it displaces",
}
NO_OTHER_NETTING = "bi"  # a fit to one netting says nothing of another, so it is drawn only when asked for
KINDS: dict[str, Mapping[str, type[Law] | type[AddedMassLaw]]] = {
    **LAWS,
    "wakes": WAKES,
    "twines": TWINES,
    "added_mass": ADDED_MASS_LAWS,
}
HOW_TO_WRITE = (
    "d twine or knot diameter, l bar length, Re = d V / nu, Sn solidity, V speed",
    "angles of a bar to the flow, 90 deg across; of a panel's normal, 0 face on",
    'in a case file, { law = "NAME", ... } where a law has parameters:',
    '[drag] bars = "NAME", knots = "NAME"; kind = "screens", screens = "NAME"',
    '[shelter] wake = "NAME", or the factor as a number; twines = "NAME"',
    '[added_mass] bars = "NAME", or C_a as a number',
)


def list_laws(*, json: bool) -> int:
    """Print every law by kind and return the exit code."""
    found = {kind: [_described(law) for law in laws.values()] for kind, laws in KINDS.items()}
    if json:
        print_json(found)
        return DONE
    console = stdout()
    for kind, laws in found.items():
        console.print(Text(TITLES[kind], style="bold"))
        for law in laws:
            console.print(Text.assemble(("  " + law["name"], "bold"), f"  {law['title']}"))
            where = f"{'; '.join(law['range']) or 'no range stated'}; on {law['area']}"
            for words in (where, law["source"], f"read {law['read']}"):
                for line in textwrap.wrap(words, console.width - 6) if words not in {"read -"} else ():
                    console.print(Text(" " * 6 + line, style="dim" if words is not where else ""))
        console.print()
    for line in HOW_TO_WRITE:
        console.print(Text(line))
    return DONE


def _described(law: type[Law] | type[AddedMassLaw]) -> dict[str, Any]:
    known = fields(law)  # type: ignore[arg-type] # every law is a dataclass, which its type does not say
    asked = [one for one in known if _asked(one)]
    ranges = ["that of its points"] if asked else _ranges(law())
    return {
        "name": law.name,
        "title": law.title,
        "range": ranges,
        "area": law.area if issubclass(law, Law) else "pi d^2 / 4 x l0",
        "angle": _angle(law),
        "parameters": {
            one.name: None if one in asked else _written(getattr(law(), one.name)) for one in known
        },
        "source": law.source,
        "read": law.read,
    }


def _asked(parameter: Field[Any]) -> bool:
    return parameter.default is MISSING and parameter.default_factory is MISSING


def _ranges(law: Law | AddedMassLaw) -> list[str]:
    return [str(one) for one in law.ranges] if isinstance(law, Law) else []


def _written(value: Any) -> Any:
    """Return a parameter as JSON can hold it: a law by its name."""
    return value.name if isinstance(value, Law) else value


def _angle(law: type[Law] | type[AddedMassLaw]) -> str:
    if issubclass(law, AngleLaw):
        return "between bar and flow, 90 deg across"
    if issubclass(law, BarLaw):
        return "by the speeds across and along the bar"
    if issubclass(law, AddedMassLaw):
        return "none" if law.constant else "between bar and flow, 90 deg across"
    if issubclass(law, WakeLaw) and not law.lean:
        return "none"
    return "none" if issubclass(law, KnotLaw) else "between normal and flow, 0 deg face on"


def plot_laws(names: list[str], output: Path, *, overwrite: bool) -> int:
    """Draw laws over measured points as PNG and SVG and return the exit code; no names: all laws."""
    from ..report.figures import write_figure
    from ..report.laws import drag_laws

    problems: list[Problem] = []
    laws = [law for name in names or _all() for law in _of_name(name, problems)]
    files = [output.with_suffix(ending) for ending in (".png", ".svg")]
    if output.suffix not in {"", ".png", ".svg"}:
        allowed, cure = "a name that ends in .png or .svg", "both are written whichever you name"
        problems.append(Problem("--output", str(output), allowed, cure))
    for file in files:
        if file.exists() and not overwrite:
            cure = "choose another name with -o, or replace it with --overwrite"
            problems.append(Problem(str(file), "a file of this name", "a new file", cure))
    if not problems:
        try:
            written = write_figure(drag_laws(laws), output.with_suffix(""))
        except OSError as error:
            found, cure = error.strerror or str(error), "choose another place with -o"
            problems.append(Problem(str(output), found, "a place to write to", cure))
    if problems:
        print_problems(problems)
        return WRONG_INPUT
    for file in written:
        stdout().print(f"{file}", soft_wrap=True)
    return DONE


def _all() -> list[str]:
    drawn = (name for laws in LAWS.values() for name, law in laws.items() if _ready(law))
    return [name for name in dict.fromkeys(drawn) if name != NO_OTHER_NETTING]


def _ready(law: type[Law]) -> bool:
    """Whether a law can be made without parameters, as all but the tables can."""
    return not any(map(_asked, fields(law)))  # type: ignore[arg-type] # a dataclass


def _of_name(name: str, problems: list[Problem]) -> list[Law]:
    """Return the laws of a name, of every kind, or that of a CSV file; add a problem when there is none."""
    if name.endswith(".csv"):
        try:
            return [read_drag_table(name)]
        except CaseError as error:
            problems += error.problems
            return []
    found = [law() for laws in LAWS.values() if (law := laws.get(name)) is not None and _ready(law)]
    if not found:
        names = sorted({law for laws in LAWS.values() for law, kind in laws.items() if _ready(kind)})
        near = get_close_matches(name, names, n=1)
        cure = f"write {near[0]}" if near else "fyke laws lists them; give a table as its CSV file"
        problems.append(Problem("name of a law", name, ", ".join(names), cure))
    return found
