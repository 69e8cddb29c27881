"""How much memory a factorization may take, known before it begins."""

from __future__ import annotations

import os
from pathlib import Path

# GB that fyke may take, instead of what the machine says it has free.
VARIABLE = "FYKE_MEMORY_GB"
GB = 1e9


class NotEnoughMemoryError(MemoryError):
    """A factorization would take more memory than is free; needed and free in bytes."""

    def __init__(self, needed: float, free: float) -> None:
        super().__init__(
            f"a factorization would take {needed / GB:.3g} GB of memory and {free / GB:.3g} GB are free"
        )
        self.needed, self.free = needed, free


def check_memory(needed: float) -> None:
    """Raise NotEnoughMemoryError when fewer bytes are free; where the system does not tell, all is well."""
    free = free_memory()
    if free is not None and needed > free:
        raise NotEnoughMemoryError(needed, free)


def free_memory() -> float | None:
    """Bytes that this process may still take: least of the machine's, the control group's and the process's own."""
    told = os.environ.get(VARIABLE)
    if told:
        return float(told) * GB
    known = [free for free in (_of_machine(), _of_group(), _of_process()) if free is not None]
    return min(known, default=None)


def _of_machine() -> float | None:
    """Linux tells what it can hand out without swapping; other systems their free pages, or nothing."""
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * float(line.split()[1])
    except OSError:
        pass
    try:
        return float(os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        return None


def _of_group() -> float | None:
    """Limit of a container or batch job, version 2 of the kernel's control groups, less what it has taken."""
    try:
        entries = Path("/proc/self/cgroup").read_text().splitlines()
    except OSError:
        return None
    own = next((entry[3:] for entry in entries if entry.startswith("0::")), None)
    if own is None:
        return None
    root = Path("/sys/fs/cgroup")
    here = root / own.lstrip("/")
    found = [_left_in(folder) for folder in (here, *here.parents) if folder.is_relative_to(root)]
    return min((left for left in found if left is not None), default=None)


def _left_in(folder: Path) -> float | None:
    try:
        limit = (folder / "memory.max").read_text().strip()
        if limit == "max":
            return None
        taken = float((folder / "memory.current").read_text())
        # Files read before are dropped when memory is wanted.
        for line in (folder / "memory.stat").read_text().splitlines():
            if line.startswith("inactive_file "):
                taken -= float(line.split()[1])
    except (OSError, ValueError):
        return None
    return max(float(limit) - taken, 0.0)


def _of_process() -> float | None:
    """Limit of the address space, less what is taken."""
    try:
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit == resource.RLIM_INFINITY:
            return None
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except (ImportError, OSError, ValueError):
        return None
    return max(float(limit) - float(pages * os.sysconf("SC_PAGE_SIZE")), 0.0)
