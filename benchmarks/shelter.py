"""What shelter costs: one evaluation of all factors, best of 30, in ms. Run it alone on the machine."""

from __future__ import annotations

import time

import numpy as np

from fyke.forces.shelter import Shelter
from fyke.netting.elastic import LinearLaw
from fyke.netting.faces import faces_of
from fyke.netting.net import Net
from fyke.netting.panel import panel
from fyke.netting.together import together
from fyke.netting.twine import Twine
from fyke.water.wakes import ChengTwines, ChengWake

TWINE = Twine("main", density=1140.0, diameter=2.8e-3, law=LinearLaw(1e9))


def flat(meshes: int, x: float = 0.0, angle: float = 0.0) -> Net:
    """A panel 1 m x 1 m at x (m) whose normal makes an angle (deg) with the current."""
    normal = (float(np.cos(np.radians(angle))), float(np.sin(np.radians(angle))), 0.0)
    return panel(
        TWINE,
        mesh="square",
        meshes=(meshes, meshes),
        bar_length=1.0 / meshes,
        size=(1.0, 1.0),
        centre=(x, 0.0, -1.0),
        normal=normal,
    )


def cost(shelter: Shelter, x: np.ndarray, current: np.ndarray) -> float:
    """Best of 30, ms."""
    shelter.factors(x, current)
    times = []
    for _ in range(30):
        begin = time.perf_counter()
        shelter.factors(x, current)
        times.append(time.perf_counter() - begin)
    return 1e3 * min(times)


def main() -> None:
    """Print the table."""
    nets = {
        "two of 50 x 50": together([flat(50), flat(50, 1.0)]),
        **{f"100 x 100 at {angle:g} deg": flat(100, angle=angle) for angle in (0.0, 60.0, 85.0, 89.0)},
    }
    print("net                    knots  faces   wake  twines  both   both, current turning by 22 deg")
    for name, net in nets.items():
        faces, x = faces_of(net), net.positions
        along = np.tile([0.5, 0.0, 0.0], (net.knot_count, 1))
        turn = np.radians(22.0) * np.linspace(0.0, 1.0, net.knot_count)
        turning = 0.5 * np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
        wake, twines = Shelter(faces, ChengWake()), Shelter(faces, None, ChengTwines())
        both = Shelter(faces, ChengWake(), ChengTwines())
        times = [cost(wake, x, along), cost(twines, x, along), cost(both, x, along), cost(both, x, turning)]
        print(f"{name:20s} {net.knot_count:7d} {faces.count:6d} " + " ".join(f"{one:6.2f}" for one in times))


if __name__ == "__main__":
    main()
