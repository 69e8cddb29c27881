"""Threads of explicit dynamics: how many, how they wait for each other, how they begin and end.

All threads of a team run one compiled kernel, each on its own blocks of knots, and meet at a barrier after every
step. They are plain Python threads in kernels that let go of the interpreter lock, so that several runs may go on at
once in one process. What a run finds does not depend on their number.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped] # has no types
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic as _intrinsic
from numpy.typing import NDArray

from .compiled import OPTIONS

# A thread needs so many bars to be worth waking and waiting for.
BARS_PER_THREAD = 8192
# Looks at the others before a waiting thread offers its core to the system.
PATIENCE = 2000
# Numbers of a cache line, doubled because lines are fetched in pairs: what threads write must lie so far apart.
LINE = 16
# Places of the arrivals and of the call to stop.
ARRIVED, STOPPED = 0, LINE

# What numba makes of these functions has fewer arguments than they are written with.
intrinsic: Any = _intrinsic

_YIELD = "SwitchToThread" if os.name == "nt" else "sched_yield"


def threads_for(bars: int) -> int:
    """Return the number of threads for so many bars: FYKE_THREADS at most, else the cores this process may use."""
    return max(1, min(threads_allowed(), bars // BARS_PER_THREAD))


def threads_allowed() -> int:
    """Return FYKE_THREADS or NUMBA_NUM_THREADS from the environment, else the cores that the system lets us use.

    ValueError where FYKE_THREADS is set to anything but a whole number above 0.
    """
    for name in ("FYKE_THREADS", "NUMBA_NUM_THREADS"):
        text = os.environ.get(name, "").strip()
        if text.isdecimal() and int(text) > 0:
            return int(text)
        if text and name == "FYKE_THREADS":
            raise ValueError(
                f"FYKE_THREADS is {text!r}; it must be a whole number above 0, such as 2, or not set at all"
            )
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min(cores, _quota()))


def _quota() -> int:
    """Whole cores that a container is given (Linux control groups), or many when nothing is said."""
    try:
        share, period = Path("/sys/fs/cgroup/cpu.max").read_text().split()
        return max(1, int(share) // int(period))
    except (OSError, ValueError, ZeroDivisionError):
        return 1 << 16


@intrinsic
def _add(typing, array, place, number):
    """Add to an entry of an array of int64 at once for all threads; returns the entry before."""

    def code(context, builder, signature, args):
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        return builder.atomic_rmw("add", builder.gep(data, [args[1]]), args[2], "acq_rel")

    return types.int64(array, types.intp, types.int64), code


@intrinsic
def _look(typing, array, place):
    """Entry of an array of int64 as other threads left it."""

    def code(context, builder, signature, args):
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        return builder.load_atomic(builder.gep(data, [args[1]]), "acquire", 8)

    return types.int64(array, types.intp), code


@intrinsic
def _offer(typing):
    """Offer the core to other threads of the system."""

    def code(context, builder, signature, args):
        kind = ir.FunctionType(ir.IntType(32), [])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, _YIELD), [])

    return types.int32(), code


@njit(**OPTIONS)
def meet(signal, team):
    """Wait until all threads of the team are here; false when they were told to stop."""
    if team == 1:
        return True
    ticket = _add(signal, ARRIVED, 1)
    target = (ticket // team + 1) * team
    looks = 0
    while _look(signal, ARRIVED) < target:
        looks += 1
        if looks > PATIENCE:
            _offer()
        if _look(signal, STOPPED) != 0:
            return False
    return True


def run_team(team: int, kernel: Callable[..., Any], *args: Any) -> Any:
    """Call kernel(rank, team, signal, *args) in so many threads and return what rank 0 returned.

    Ctrl-C and faults stop all of them at their next meeting and are raised again here.
    """
    signal: NDArray[np.int64] = np.zeros(2 * LINE, dtype=np.int64)
    if team == 1:
        return kernel(0, 1, signal, *args)
    found: dict[int, Any] = {}
    faults: list[BaseException] = []

    def work(rank: int) -> None:
        try:
            found[rank] = kernel(rank, team, signal, *args)
        except BaseException as fault:
            signal[STOPPED] = 1
            faults.append(fault)

    threads = [threading.Thread(target=work, args=(rank,), daemon=True) for rank in range(team)]
    started = []
    try:
        for thread in threads:
            thread.start()
            started.append(thread)
        for thread in threads:
            thread.join()
    except BaseException:
        signal[STOPPED] = 1
        for thread in started:
            thread.join()
        raise
    if faults:
        raise faults[0]
    return found[0]
