"""fyke export: a result in the files of other programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..case import Case, CaseError, Problem, recorded_case
from ..results import ResultError, load
from ..results.export import write_csv, write_vtkhdf, write_vtu
from ..solve.result import Result
from .folder import RESULT
from .show import DONE, WRONG_INPUT, print_problems, print_warnings, stderr, stdout


@dataclass(frozen=True)
class Format:
    """A kind of file: how to write it, how its name ends for one frame and for several, what opens it.

    all_frames: whether it holds all frames, or the last only.
    """

    write: Callable[[Result, Path], Path]
    ending: str
    ending_of_series: str
    opens: str
    all_frames: bool = True


def _write_gltf(result: Result, path: Path) -> Path:
    from ..report.gltf import write_gltf

    return write_gltf(result, path)


FORMATS = {
    "vtkhdf": Format(write_vtkhdf, ".vtkhdf", ".vtkhdf", "ParaView and VTK"),
    "vtu": Format(write_vtu, ".vtu", "_vtu", "ParaView, VisIt, PyVista"),
    "csv": Format(write_csv, "_csv", "_csv", "spreadsheets, R, pandas"),
    "gltf": Format(_write_gltf, ".glb", ".glb", "Blender, PowerPoint, browsers", all_frames=False),
}


def export_result(file: Path, to: str, output: Path | None, *, overwrite: bool) -> int:
    """Write a result, given as its file or the folder of its run, in another format and return the exit code."""
    if to not in FORMATS:
        print_problems([Problem("--to", to, ", ".join(FORMATS), "choose one of these")])
        return WRONG_INPUT
    try:
        source, result = opened(file)
    except ResultError as error:
        stderr().print(str(error), soft_wrap=True)
        return WRONG_INPUT
    kind = FORMATS[to]
    ending = kind.ending if len(result.time) == 1 else kind.ending_of_series
    target = output or source.with_name(source.stem + ending)
    problem = taken(target, source, overwrite=overwrite)
    if problem is not None:
        print_problems([problem])
        return WRONG_INPUT
    try:
        kind.write(result, target)
    except OSError as error:
        print_problems([unwritten(target, error)])
        return WRONG_INPUT
    print_warnings(stdout(), whole(result))
    frames = "one frame" if len(result.time) == 1 else f"{len(result.time)} frames"
    if len(result.time) > 1 and not kind.all_frames:
        frames = f"the last of {frames}"
    text = f"{target}: {frames}, {_size(target) / 1e6:.3g} MB, for {kind.opens}"
    stdout().print(text, soft_wrap=True)
    return DONE


def opened(file: Path) -> tuple[Path, Result]:
    """Read a result, given as its file or the folder of its run; ResultError where that cannot be done."""
    source = file / RESULT if file.is_dir() else file
    return source, load(source)


def case_of(result: Result) -> Case | None:
    """Return the case behind a result, None for a net made in Python and a case of another version.

    None also where a file of its current or of a motion is gone; they are looked for from the present folder.
    """
    try:
        case = recorded_case(result.case_text) if result.case_text else None
        if case is not None:
            case.current.flow()
            for motion in case.motion:
                motion.record()
    except CaseError:
        return None
    return case


def taken(target: Path, source: Path, *, overwrite: bool) -> Problem | None:
    """Say why a name cannot be written to, None where it can."""
    if target.exists() and target.resolve() in (source.resolve(), source.parent.resolve()):
        return Problem(
            str(target), "the result itself", "a name for a new file", "choose another name with -o PATH"
        )
    if target.exists() and not overwrite:
        cure = "add --overwrite, or choose another name with -o PATH"
        return Problem(str(target), "something of this name", "a name for a new file", cure)
    return None


def unwritten(target: Path, error: OSError) -> Problem:
    """Say what came between a file and the disk."""
    free = "free the disk, or choose another place with -o PATH"
    cure = "choose another place with -o PATH" if isinstance(error, FileExistsError) else free
    return Problem(str(target), error.strerror or str(error), "a place that can be written", cure)


def whole(result: Result) -> list[str]:
    """Return a warning where a result ends before its run was to end."""
    if result.outcome.name != "interrupted":
        return []
    return [f"the run was stopped: this is what it had reached, up to {float(result.time[-1]):g} s"]


def _size(path: Path) -> int:
    """Bytes of a file, or of all files in a folder."""
    return sum(one.stat().st_size for one in (path.iterdir() if path.is_dir() else (path,)))
