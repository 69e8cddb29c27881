"""Checkpoints: all that a stepper needs to go on as if it had never stopped.

An npz file of plain arrays beside the result, written whole at every output after the frame itself, so that a run
killed at any moment finds the frames of its last checkpoint in the result file.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..forces.frame import Frame
from ..solve.dynamic import Checkpoint
from ..solve.result import Result
from ..solve.stepper import Count
from .whole import beside

COUNTS = ("steps", "rejected", "evaluations", "factorizations")


class CheckpointError(Exception):
    """A checkpoint that cannot be used, in one sentence."""


def save_checkpoint(path: str | Path, checkpoint: Checkpoint, *, case_sha256: str) -> None:
    """Write a checkpoint of a run of the case with this hash; OSError where that cannot be done."""
    arrays: dict[str, Any] = {f"memory_{name}": value for name, value in checkpoint.memory.items()}
    arrays["case"] = np.array(case_sha256)
    arrays["frames"] = np.array(checkpoint.frames)
    arrays["counts"] = np.array([getattr(checkpoint.count, name) for name in COUNTS], dtype=np.int64)
    part = beside(Path(path))
    with part.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    part.replace(path)


def load_checkpoint(path: str | Path, *, case_sha256: str) -> Checkpoint:
    """Read a checkpoint; CheckpointError when it is missing, damaged or of another case."""
    try:
        with np.load(path, allow_pickle=False) as file:
            case, frames = str(file["case"]), int(file["frames"])
            count = Count(**dict(zip(COUNTS, file["counts"].tolist(), strict=True)))
            memory = {
                name.removeprefix("memory_"): file[name] for name in file.files if name.startswith("memory_")
            }
    except FileNotFoundError:
        raise CheckpointError("there is no checkpoint") from None
    except Exception as error:  # numpy and zipfile have no common class for a damaged file
        raise CheckpointError(f"the checkpoint cannot be read ({error})") from error
    if case != case_sha256:
        raise CheckpointError("the checkpoint is of another case file, or the case has changed since")
    return Checkpoint(frames, memory, count)


def frames_of(result: Result, checkpoint: Checkpoint) -> list[Frame]:
    """Return the frames of a result up to a checkpoint; CheckpointError when it holds fewer."""
    if len(result.time) < checkpoint.frames:
        raise CheckpointError(
            f"the result holds {len(result.time)} of the {checkpoint.frames} outputs before it"
        )
    return [result.frame(i) for i in range(checkpoint.frames)]
