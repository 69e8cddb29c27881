"""Measure what a claim is about: run its script or its case, and keep what was found before something went wrong."""

from __future__ import annotations

import importlib.util
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from ..case import load_case
from ..case.errors import CaseError
from ..results import flow_direction, part_figures, summary
from ..solve.run import solve_case
from ..system.build import build_net, build_system
from .claims import Claim, Found

# Lines of a fault that are told.
TOLD = 3
STANDARD_OUTPUT = 1


@dataclass
class Measured:
    """What was found before something went wrong, if it did; module: the script; absent: why nothing could be."""

    found: list[Found]
    wrong: str = ""
    absent: str = ""
    module: ModuleType | None = None


def measure(claim: Claim) -> Measured:
    """Measure what a claim is about. Whatever a script raises is its own rows' fault: the others still run."""
    out = Measured([])
    lacking = [name for name in claim.needs if importlib.util.find_spec(name) is None]
    if lacking:
        out.absent = f"not installed: {', '.join(lacking)}; pip install {' '.join(lacking)}"
        return out
    try:
        tables = claim.tables()
        with _silent():
            if claim.script is not None:
                out.module = _script((claim.file.parent / claim.script).resolve())
                for one in out.module.measure(tables):
                    if not isinstance(one, Found):
                        raise TypeError(f"measure is to yield Found, not {one!r}")
                    out.found.append(one)
            elif claim.case is not None:
                out.found.extend(_of_case(claim))
    except CaseError as error:
        out.wrong = str(error)
    except (Exception, SystemExit) as error:
        out.wrong = last_lines(error)
    return out


def _script(file: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"fyke_validation_{file.stem}", file)
    if spec is None or spec.loader is None or not file.is_file():
        raise FileNotFoundError(f"no script {file}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    with _beside(file.parent):
        spec.loader.exec_module(module)
    # Scripts that import this one are to have what it has worked out, under the name by which they ask for it.
    if getattr(sys.modules.get(file.stem, module), "__file__", None) == str(file):
        sys.modules[file.stem] = module
    return module


def picture_of(measured: Measured) -> bytes | None:
    """Draw what a script has to show."""
    picture = getattr(measured.module, "picture", None)
    if picture is None:
        return None
    from ..report.verdicts import as_png

    return as_png(picture(measured.found))


@contextmanager
def _silent() -> Iterator[None]:
    """Let nothing through that other programs print, from compiled code too: standard output is the command's own."""
    sys.stdout.flush()
    with open(os.devnull, "w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
        kept = os.dup(STANDARD_OUTPUT)
        os.dup2(nowhere.fileno(), STANDARD_OUTPUT)
        try:
            yield
        finally:
            os.dup2(kept, STANDARD_OUTPUT)
            os.close(kept)


@contextmanager
def _beside(folder: Path) -> Iterator[None]:
    """Let a script import what lies beside it."""
    sys.path.insert(0, str(folder.resolve()))
    try:
        yield
    finally:
        sys.path.remove(str(folder.resolve()))


def _of_case(claim: Claim) -> Iterator[Found]:
    """Values of the summary of a case, by the rows' keys."""
    case = load_case(claim.file.parent / str(claim.case))
    system = build_system(build_net(case), case)
    result = solve_case(system, case)
    if not result.outcome.ok:
        raise RuntimeError(f"{result.outcome.name}: {result.outcome.message}")
    figures = summary(result, flow_direction=flow_direction(system)) | part_figures(
        system, result, depth=case.water.depth
    )
    for spec in claim.rows:
        yield Found(spec.key, float(_by_key(figures, spec.key)))


def _by_key(figures: dict[str, Any], key: str) -> Any:
    """Return the value at a dotted key, list entries by number."""
    value: Any = figures
    for part in key.split("."):
        value = value[int(part)] if isinstance(value, list) else value[part]
    return value


def last_lines(error: BaseException) -> str:
    """Say in a line what was raised and where, in code that is not of another package."""
    lines = "".join(traceback.format_exception_only(error)).strip().splitlines()
    places = traceback.extract_tb(error.__traceback__)
    near = [one for one in places if "site-packages" not in one.filename] or places
    where = f" ({Path(near[-1].filename).name}, line {near[-1].lineno})" if near else ""
    return " ".join(lines[-TOLD:]) + where
