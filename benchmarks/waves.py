"""Speed of waves: motion and elevation of the water at knots, beside plain numpy and beside numpy's sine alone.

Run with `make bench-waves`. The kernel takes one thread. Times are the best of several repeats on a machine that may be
doing other things: read the ratios.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np

from fyke.water.waves import Spreading, Waves, airy, irregular, stokes2
from fyke.water.waves.sea import Harmonics

KNOTS, COMPONENTS, REPEATS, DEPTH = 5000, 200, 20, 40.0
GOAL = 5.0  # ms


def best(work: Callable[[], object]) -> float:
    """Shortest wall time (ms) of several calls, after one to warm up."""
    work()
    times = []
    for _ in range(REPEATS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return min(times) * 1e3


def plain(sea: Waves, points: np.ndarray, moment: float) -> np.ndarray:
    """Velocity, acceleration and elevation as numpy adds them up, with the kernel's own overflow-free exponentials."""
    parts: Harmonics = sea.harmonics
    x, y, z = points.T[:, :, None]
    angle = 2.0 * np.pi * (parts.turns_x * x + parts.turns_y * y + parts.phase - parts.frequency * moment)
    c, s = np.cos(angle), np.sin(angle)
    eta = c @ parts.amplitude
    z = (z - eta[:, None]) / (1.0 + eta[:, None] / sea.depth)
    down = np.exp(parts.decay * math.log(2.0) * z)
    up = parts.mirror / down
    across, along = down + up, down - up
    u, v, w = parts.velocity
    du, dv, dw = parts.acceleration
    cosines, sines = across * c, across * s
    columns = (cosines @ u, cosines @ v, (along * s) @ w, sines @ du, sines @ dv, -(along * c) @ dw, eta)
    return np.column_stack(columns)


def main() -> None:
    """Print the table."""
    points = np.random.default_rng(1).uniform([-50.0, -50.0, -30.0], [50.0, 50.0, -3.0], (KNOTS, 3))
    sea = irregular(2.0, 7.0, gamma=3.3, components=COMPONENTS, spreading=Spreading(10.0, 15), depth=DEPTH)
    small, steep = airy(2.0, 7.0, depth=DEPTH), stokes2(2.0, 7.0, depth=DEPTH)
    moved = sea.motion(points, 3.0)
    both = np.column_stack([moved.velocity, moved.acceleration, moved.elevation])
    apart = abs(both - plain(sea, points, 3.0)).max()
    phases = np.random.default_rng(2).uniform(-3.0, 3.0, (KNOTS, COMPONENTS))
    sine, numpys = best(lambda: np.sin(phases)), best(lambda: plain(sea, points, 3.0))
    print(f"{KNOTS} knots, largest difference from numpy {apart:.1e}\n")
    print(
        "| what | ms | ns a component and knot | over numpy's sine | over plain numpy |\n|---|---|---|---|---|"
    )
    rows = {
        f"numpy's sine of {COMPONENTS} phases a knot": (COMPONENTS, sine),
        f"plain numpy, {COMPONENTS} components": (COMPONENTS, numpys),
        f"irregular, {COMPONENTS} components (goal {GOAL:g} ms)": (
            COMPONENTS,
            best(lambda: sea.motion(points, 3.0)),
        ),
        "the same, elevation only": (COMPONENTS, best(lambda: sea.elevation(points, 3.0))),
        "airy": (1, best(lambda: small.motion(points, 3.0))),
        "stokes2": (2, best(lambda: steep.motion(points, 3.0))),
    }
    for what, (count, took) in rows.items():
        each = took * 1e6 / (KNOTS * count)
        ratios = (took / sine, took / numpys) if count == COMPONENTS else None
        told = f"{ratios[0]:.2f} | {ratios[1]:.3f}" if ratios else "|"
        print(f"| {what} | {took:.2f} | {each:.1f} | {told} |")
    repeats()


def repeats() -> None:
    """Print how like itself a sea gets within three hours, beside one of equal steps of frequency."""
    later = np.arange(200.0, 10_800.0)
    frequency = irregular(2.0, 10.0, gamma=3.3, components=COMPONENTS).harmonics.frequency
    likeness = np.abs(np.cos(2.0 * np.pi * np.outer(later, frequency)).mean(axis=1)).max()
    back = 1.0 / ((frequency[-1] - frequency[0]) / (COMPONENTS - 1))
    print(f"\nlargest autocorrelation from 20 to 1080 peak periods: {likeness:.2f}; ", end="")
    print(f"components at equal steps of the same band come back to 1 after {back:.0f} s")


if __name__ == "__main__":
    main()
