"""Results on disk: one netCDF-4 file that holds the net, its frames, the outcome and the case behind it."""

from __future__ import annotations

from io import FileIO
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ..netting.net import Bodies, Net, Panel, Rope
from ..solve.outcome import Outcome
from ..solve.result import Result
from .encoding import outcome_from_attributes, outcome_to_attributes, parts_from_text, twines_from_text
from .fields import FRAME_FIELDS, NET_FIELDS, SCHEMA, WEIGHT
from .layout import RUNNING, Content, check_finite, frame_offsets, lay_out, write_frames
from .whole import replacing


class ResultError(Exception):
    """A result file cannot be read; the message is one sentence that says why."""


def save(result: Result, path: str | Path) -> None:
    """Write a result to a netCDF-4 file; `path` holds the old file or the whole new one at any moment.

    ValueError, with variable, place and time, for a number that is not finite. OSError where the file cannot
    be written.
    """
    values = {field.name: np.asarray(getattr(result, field.name)) for field in FRAME_FIELDS}
    for field in FRAME_FIELDS:
        check_finite(field, values[field.name], result.net, result.time)
    outcome = outcome_to_attributes(result.outcome)
    content = Content(result.net, result.weight_in_water, result.case_text, outcome)
    with replacing(Path(path)) as part:
        lay_out(part, content, len(result.time))
        with FileIO(part, "r+") as file:
            write_frames(file, frame_offsets(part), 0, values)


def load(path: str | Path) -> Result:
    """Read a result file back.

    The file of a run that was killed, or still goes on, gives the frames up to the last whole one, and the
    outcome "interrupted". ResultError for a file that is missing, not a result of fyke, cut off or written by
    a newer fyke.
    """
    path = Path(path)
    if not path.is_file():
        raise ResultError(f"{path}: there is no such file.")
    try:
        if not h5py.is_hdf5(path):
            raise ResultError(f"{path}: the file is no netCDF-4 file, so no result of fyke.")
        with h5py.File(path, "r") as file:
            attributes = {name: _plain(value) for name, value in file.attrs.items()}
            _check_schema(path, attributes)
            return _read(file, attributes)
    except (OSError, RuntimeError, LookupError, ValueError, TypeError, AttributeError) as error:
        raise ResultError(
            f"{path}: the file is damaged or cut off ({type(error).__name__}: {error})."
        ) from error


def _plain(value: Any) -> Any:
    """Turn the one-element array that netCDF makes of a number back into a number of Python."""
    return value.item() if isinstance(value, np.generic | np.ndarray) and value.size == 1 else value


def _check_schema(path: Path, attributes: dict[str, Any]) -> None:
    schema = attributes.get("fyke_result_schema")
    if schema is None:
        raise ResultError(
            f"{path}: the file was not written by fyke, it has no attribute fyke_result_schema."
        )
    if schema > SCHEMA:
        raise ResultError(
            f"{path}: the file has result schema {schema} of fyke {attributes.get('fyke_version')}, "
            f"this fyke reads up to {SCHEMA}: update fyke."
        )


def _read(file: Any, attributes: dict[str, Any]) -> Result:
    net = _read_net(file, attributes)
    missing = np.isnan(file["time"][...])
    count = int(np.argmax(missing)) if missing.any() else len(missing)
    if count == 0:
        raise ValueError("it holds no frame")
    frames = {field.name: file[field.name][:count] for field in FRAME_FIELDS}
    if attributes["outcome"] == RUNNING["outcome"]:
        outcome = _interrupted(float(frames["time"][-1]), float(frames["unbalanced_force"][-1]))
    else:
        outcome = outcome_from_attributes(attributes)
    weight = float(file[WEIGHT.name][()])
    return Result(net=net, outcome=outcome, weight_in_water=weight, case_text=attributes["case"], **frames)


MULTIPLES = ("bar_multiple", "knot_multiple")


def _read_net(file: Any, attributes: dict[str, Any]) -> Net:
    names = {name: field.name for name, field in NET_FIELDS.items() if name not in ("bar_diameter", "labels")}
    # Files of a version before grouped netting have no multiples, which are ones then.
    values = {name: file[at][...] for name, at in names.items() if at in file or name not in MULTIPLES}
    values["fixed"] = values["fixed"].astype(bool)
    return Net(
        labels=tuple(file[NET_FIELDS["labels"].name].asstr()[...]),
        twines=twines_from_text(attributes["twines"]),
        panels=parts_from_text(Panel, attributes["panels"]),
        ropes=parts_from_text(Rope, attributes["ropes"]),
        bodies=parts_from_text(Bodies, attributes["bodies"]),
        **values,
    )


def _interrupted(time: float, residual: float) -> Outcome:
    """Return the outcome of a run that said nothing about its end."""
    return Outcome(
        name="interrupted",
        message=f"The run had not ended when the file was written; its last whole frame is at {time:g} s.",
        advice="Run the case again for the frames after it.",
        solver="",
        linear_solver="",
        iterations=0,
        factorizations=0,
        residual=residual,
        wall_time=0.0,
        time=time,
    )
