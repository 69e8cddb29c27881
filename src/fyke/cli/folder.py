"""The folder that a run writes to."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from ..case import Case
from ..case.errors import CaseError, Problem
from ..forces.frame import Frame
from ..netting.net import Net
from ..results import CheckpointError, ResultError, frame_bytes, frames_of, load, load_checkpoint
from ..solve.dynamic import Checkpoint

RESULT, SUMMARY, KNOTS, BARS = "result.nc", "summary.json", "knots.csv", "bars.csv"
PARTS, RINGS, LINES, WAVES = "parts.csv", "rings.csv", "lines.csv", "waves.csv"
LOADS, LOADS_BY_PART, LOAD_CASES = "loads.csv", "loads_by_part.csv", "load_cases"  # the last a folder
LOAD_CURVES = "load_curves"
CHECKPOINT = "checkpoint.npz"
# Stems of the pictures: those of an earlier run of another kind must not outlive it.
PICTURES = (
    "initial_position",
    "equilibrium_shape",
    "tension_plan",
    "tension_histogram",
    "sections",
    "histories",
    "comparison",
    "waves",
    "load_curves",
)
GB = 1e9
_ALLOWED = "a folder that can be written and holds no result"


def claim(folder: Path, *, overwrite: bool) -> None:
    """Make a folder ready for a result; take an old result away when it may be overwritten.

    Raises CaseError where the folder cannot be made or written, or already holds a result.
    """
    if folder.exists() and not folder.is_dir():
        raise _refusal(folder, "a file of this name", "choose another folder with -o DIR")
    there = [name for name in (RESULT, SUMMARY, KNOTS, BARS) if (folder / name).exists()]
    if there and not overwrite:
        found = f"an earlier result: {', '.join(there)}"
        raise _refusal(folder, found, "add --overwrite to replace it, or choose another folder with -o DIR")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        if there:
            _clear(folder)
    except OSError as error:
        cure = "choose another folder with -o DIR, or give yourself the right to write there"
        raise _refusal(folder, error.strerror or str(error), cure) from None


def make_sure_of_room(folder: Path, net: Net, frames: int) -> None:
    """Raise CaseError where so many frames of a net fit neither the disk nor the memory, which keeps them all."""
    there = next((one for one in (folder, *folder.absolute().parents) if one.is_dir()), Path())
    # While it grows the file is there twice.
    needed = {"disk": 2.0 * frame_bytes(net) * frames, "memory": 1.0 * frame_bytes(net) * frames}
    room = {"disk": float(shutil.disk_usage(there).free), "memory": _memory()}
    for what, size in needed.items():
        if frames > 1 and size > room[what]:
            found = f"{frames:,} outputs of this net, which take {size / GB:.3g} GB of {what}"
            allowed = f"at most the {room[what] / GB:.3g} GB that are there"
            raise CaseError([Problem("[output] every", found, allowed, "write a larger every")])


def _memory() -> float:
    """Memory of the machine, bytes; infinite where that is not told."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * float(os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")


def _clear(folder: Path) -> None:
    pictures = [f"{stem}.{kind}" for stem in PICTURES for kind in ("png", "svg")]
    for name in (
        RESULT,
        SUMMARY,
        KNOTS,
        BARS,
        PARTS,
        RINGS,
        LINES,
        WAVES,
        LOADS,
        LOADS_BY_PART,
        CHECKPOINT,
        *pictures,
    ):
        (folder / name).unlink(missing_ok=True)
    for one in (folder / LOAD_CASES).glob("*/"):
        _clear(one)
        if not any(one.iterdir()):
            one.rmdir()


def _refusal(folder: Path, found: str, cure: str) -> CaseError:
    return CaseError([Problem(f"output folder {folder}", found, _ALLOWED, cure)])


def stopped(folder: Path, case: Case) -> tuple[Checkpoint, list[Frame]]:
    """Return the checkpoint of the run that was stopped in a folder, and its outputs so far.

    Raises CaseError where there is none of this case, or the case is static.
    """
    where = f"--resume in {folder}"
    if case.solve.kind != "dynamic":
        raise CaseError([Problem(where, "a static case", "a dynamic case", "leave out --resume")])
    try:
        checkpoint = load_checkpoint(folder / CHECKPOINT, case_sha256=case.sha256)
        return checkpoint, frames_of(load(folder / RESULT), checkpoint)
    except (CheckpointError, ResultError) as error:
        allowed = "the folder of a run of this very case that was stopped"
        cure = "run it from its beginning, with --overwrite if a result is there"
        raise CaseError([Problem(where, str(error), allowed, cure)]) from None
