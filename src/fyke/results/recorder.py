"""Recorder: a result file that grows while a run goes on and can be read at any moment, even after a kill."""

from __future__ import annotations

from collections.abc import Sequence
from io import FileIO
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from ..forces.frame import Frame
from ..netting.net import Net
from ..solve.result import Result
from .fields import FRAME_FIELDS
from .layout import (
    FLOAT,
    RUNNING,
    Content,
    check_finite,
    frame_bytes,
    frame_offsets,
    frame_shape,
    lay_out,
    read_frames,
    write_frames,
)
from .store import save
from .whole import beside

# Bytes taken at once; a run of more outputs than fit into them gets more when it comes to them.
FIRST_ROOM = 64 * 2**20


class Recorder:
    """Writes a result file as a run goes.

    Frames go straight into their places in a file that is whole from the start, the time of a frame last, so
    that a run that is killed at any moment leaves a readable file with every frame appended before. No lock
    is held: the file can be read while the run goes on. `path` appears, or is replaced, with the first frame.

        with Recorder("panel.nc", net, times=101, weight_in_water=weight) as recorder:
            recorder.append(frame)
            ...
            recorder.finish(result)
    """

    def __init__(
        self,
        path: str | Path,
        net: Net,
        *,
        times: int,
        weight_in_water: float,
        case_text: str = "",
        frames: Sequence[Frame] = (),
    ) -> None:
        """Take room for `times` outputs, or the first of them; more than that may come.

        weight_in_water: weight less buoyancy of the whole net (N); frames: outputs of a run that is taken up again,
        which are in the file from the moment it is in place. OSError where the file cannot be written,
        ValueError where the net holds a number that is not finite.
        """
        self._path = Path(path)
        self._content = Content(net, weight_in_water, case_text, RUNNING)
        self._count = 0
        self._capacity = 0
        self._file: FileIO | None = None
        self._in_place = False
        self._offsets: dict[str, int] = {}
        self._make_room(max(1, len(frames), min(times, FIRST_ROOM // frame_bytes(net))))
        for frame in frames:
            self._write(frame)
        if frames:
            self._put_in_place()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def append(self, frame: Frame) -> None:
        """Add a frame to the file.

        ValueError for a shape that is not the net's and, with variable and knot or bar, for a number that is
        not finite; the file stays as it was.
        """
        self._write(frame)
        if not self._in_place:
            self._put_in_place()

    def _write(self, frame: Frame) -> None:
        net = self._content.net
        values = {field.name: np.asarray(getattr(frame, field.name), dtype=FLOAT) for field in FRAME_FIELDS}
        for field in FRAME_FIELDS:
            shape = values[field.name].shape
            if shape != frame_shape(field, net):
                raise ValueError(
                    f"{field.name} has shape {shape}, the net asks for {frame_shape(field, net)}"
                )
            check_finite(field, values[field.name], net)
        if self._count == self._capacity:
            self._make_room(2 * self._capacity)
        one = {name: value[np.newaxis] for name, value in values.items()}
        write_frames(self._open_file(), self._offsets, self._count, one)
        self._count += 1

    def finish(self, result: Result) -> None:
        """Replace the file by the whole result: with its outcome and without room to spare."""
        self.close()
        save(result, self._path)

    def close(self) -> None:
        """Let go of the file and leave it readable as it is; a second call does nothing."""
        if self._file is None:
            return
        self._file.close()
        self._file = None
        if not self._in_place:
            beside(self._path).unlink()

    def _make_room(self, capacity: int) -> None:
        """Lay out a file for `capacity` frames beside the one in place, with the frames so far."""
        part = beside(self._path)
        try:
            lay_out(part, self._content, capacity)
            offsets = frame_offsets(part)
            file = FileIO(part, "r+")
            if self._count:
                old = read_frames(self._open_file(), self._offsets, self._count, self._content.net)
                write_frames(file, offsets, 0, old)
        except BaseException:
            part.unlink(missing_ok=True)
            raise
        if self._file is not None:
            self._file.close()
        self._file, self._offsets, self._capacity, self._in_place = file, offsets, capacity, False

    def _put_in_place(self) -> None:
        # Closed for the rename, which some systems refuse for an open file.
        self._open_file().close()
        beside(self._path).replace(self._path)
        self._file = FileIO(self._path, "r+")
        self._in_place = True

    def _open_file(self) -> FileIO:
        if self._file is None:
            raise ValueError(f"the recorder of {self._path} is closed")
        return self._file
