"""How kernels are compiled, and whether they are compiled yet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

# NaN and infinity keep their meaning (no nnan, no ninf), so that a fault is seen where it happens; the other
# relaxations let the compiler use vector instructions and are the same in every run on one machine.
OPTIONS: dict[str, Any] = {
    "cache": True,
    "fastmath": {"contract", "arcp", "nsz", "reassoc"},
    "error_model": "numpy",
    # Kernels touch no Python object: other threads go on meanwhile.
    "nogil": True,
}
# The same for steps of the innermost loops over blocks: a call that stays one hands all arrays of Elements or Around
# over by value, which costs as much as the forces of some 40 bars.
INLINED: dict[str, Any] = {**OPTIONS, "forceinline": True}
# What of the options goes down to functions within a kernel.
WITHIN: dict[str, Any] = {name: OPTIONS[name] for name in ("fastmath", "error_model")}


def is_compiled(kernel: Any) -> bool:
    """Whether the machine code of a kernel lies on disk, made after its source was last changed."""
    source = Path(kernel.py_func.__code__.co_filename)
    index = Path(kernel.stats.cache_path).glob(f"{source.stem}.{kernel.py_func.__name__}-*.nbi")
    return any(file.stat().st_mtime >= source.stat().st_mtime for file in index)
