"""What the benchmarks share: the net that they take, the clock, and the table that they print."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numba
import numpy as np
import scipy
from numba import njit

import fyke
from fyke.forces.total import total_force, work_arrays

# What was measured, the figure, the goal.
Row = tuple[str, str, str]


def panel_system(meshes: int, speed: float = 0.5) -> fyke.System:
    """Diamond panel of the example with so many meshes each way, on a frame 10 % short."""
    twine = fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9))
    side = 0.9 * meshes * 0.03 * np.sqrt(2.0)
    net = fyke.panel(
        twine,
        mesh="diamond",
        meshes=(meshes, meshes),
        bar_length=0.03,
        size=(side, side),
        knot_diameter=3.5e-3,
    )
    return fyke.make_system(net, current=(speed, 0.0, 0.0))


def best(work: Callable[[], object], repeats: int = 7) -> float:
    """Shortest wall time (s) of several calls, after one to warm up."""
    work()
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return min(times)


def best_in_turn(works: Mapping[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Shortest wall time (s) of each of several works, called in turn so that all meet the same machine."""
    found = dict.fromkeys(works, np.inf)
    for turn in range(repeats + 1):
        for name, work in works.items():
            began = time.perf_counter()
            work()
            found[name] = min(found[name], time.perf_counter() - began) if turn else np.inf
    return found


@njit
def many_forces(count, state, el, work, laws):
    """Call the force evaluation so many times without going back to Python."""
    (x, v, u), (rel, g, out) = state, work
    for _ in range(count):
        total_force(x, v, u, el, rel, g, out, laws)


def in_motion(system: fyke.System, speed: float) -> fyke.State:
    """A state about the one as built: 1 mm off, with velocities of this size (m/s)."""
    rng, x = np.random.default_rng(0), system.net.positions
    return fyke.State(0.0, x + rng.normal(scale=1e-3, size=x.shape), rng.normal(scale=speed, size=x.shape))


def forces_of(system: fyke.System, start: fyke.State, count: int) -> Callable[[], object]:
    """Return a call of so many force evaluations."""
    x, v = start.position, start.velocity
    u = system.current.velocity(x, 0.0)
    work = (*work_arrays(len(x)), np.empty_like(x))
    return lambda: many_forces(count, (x, v, u), system.elements, work, system.drag_laws)


def force_per_bar(system: fyke.System) -> float:
    """Seconds of one force evaluation over the number of bars."""
    count = max(1, 50_000 // system.net.bar_count)
    return best(forces_of(system, in_motion(system, 0.0), count), 200) / count / system.net.bar_count


def leaps_of(system: fyke.System, start: fyke.State, threads: int, steps: int) -> Callable[[], object]:
    """Return a call of so many leapfrog steps, and one more, without the conversions at the ends of a call."""
    run = fyke.Symplectic().start(system, start)
    run.threads = threads
    assert run.advance(steps * run.step) == "ok"
    h = 0.7 * run.step
    return lambda: run.leap(h, steps, True)


def leap_seconds(system: fyke.System, start: fyke.State, threads: int, steps: int) -> float:
    """Seconds of one leapfrog step."""
    return best(leaps_of(system, start, threads, steps), 40) / (steps + 1)


def table_of(rows: Sequence[Row]) -> str:
    """Rows as a table."""
    width = max(len(row[0]) for row in rows)
    lines = [f"| {'what'.ljust(width)} | measured | goal |", f"|{'-' * (width + 2)}|---|---|"]
    return "\n".join([*lines, *(f"| {what.ljust(width)} | {value} | {goal} |" for what, value, goal in rows)])


def machine() -> str:
    """What this ran on."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [
            line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if "model name" in line
        ]
        model = names[0] if names else model
    return (
        f"{model}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}, "
        f"numpy {np.__version__}, scipy {scipy.__version__}, numba {numba.__version__}, fyke {fyke.__version__}"
    )
