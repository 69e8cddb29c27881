"""Files and folders that appear whole or not at all."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path


def beside(path: Path) -> Path:
    """Return the hidden working name of a file in its own folder, where a rename is one step."""
    return path.with_name(f".{path.name}.{os.getpid()}.part")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Hand out a working name to write to; rename it to `path` at the end, or remove it on a failure."""
    part = beside(path)
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


@contextmanager
def replacing_folder(path: Path, own: Sequence[str]) -> Iterator[Path]:
    """Hand out a folder under a working name to write to; put it at `path` at the end, or remove it on a failure.

    A folder that is at `path` goes when all its files have names like those in `own` (patterns); otherwise
    FileExistsError names one that has not, and nothing is touched.
    """
    if path.exists():
        _refuse_others(path, own)
    part, old = beside(path), path.with_name(f".{path.name}.{os.getpid()}.old")
    try:
        part.mkdir(parents=True)
        yield part
        if path.exists():
            path.replace(old)
        part.replace(path)
    finally:
        for left in (part, old):
            shutil.rmtree(left, ignore_errors=True)


def _refuse_others(path: Path, own: Sequence[str]) -> None:
    if not path.is_dir():
        raise FileExistsError(errno.EEXIST, "a file has the name of the folder to write", str(path))
    for there in path.iterdir():
        if not any(there.match(pattern) for pattern in own):
            found = f"the folder holds {there.name}, which an export does not write"
            raise FileExistsError(errno.EEXIST, found, str(path))


def reserve(path: Path, size: int) -> None:
    """Make a file of so many bytes, to be written over; OSError where the disk has not the room.

    For files that HDF5 is to write: it crashes on a disk that runs full.
    """
    with path.open("wb") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size)
        elif shutil.disk_usage(path.parent).free < size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
