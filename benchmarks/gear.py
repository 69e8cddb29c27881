"""What gear costs: nets of a million knots, laid, joined, labelled, and put into the water; cages solved (cages.py).

Run with `make bench-gear`. Times are processor seconds, the least of some repeats, on a machine that may be doing other
things: read the ratios to the panel, not the seconds.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from cages import statics, waves
from timing import Row, table_of

import fyke
from fyke.netting.cutting import Taper
from fyke.netting.shapes import bag, box, cage, frustum
from fyke.netting.sheet import Netting

GOAL = "< 5 s"
BAR = 0.05  # m
HUNG = np.sqrt(0.5)

CAGE = """schema = 1
[current]
velocity = [0.3, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "50 mm"
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [1000, 400]
diameter = 20
height = 30
top = [0.0, 0.0, -0.3]
bottom = { meshes = 100, depth = "1 m" }
[[gear]]
kind = "rope"
twine = "main"
along = "cage.bottom"
[[gear]]
kind = "sinkers"
along = "cage.bottom"
count = 100
weight = "10 N"
density = 7850
"""


def seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Least processor time (s) of some calls, after one to warm up."""
    work()
    times = []
    for _ in range(repeats):
        began = time.process_time()
        work()
        times.append(time.process_time() - began)
    return min(times)


def building() -> list[Row]:
    """Nets of a million knots, as ratios to the panel."""
    twine = fyke.Twine("main", 1140.0, 2e-3, fyke.LinearLaw(1e9))
    diamond, square = (Netting(twine, mesh, BAR) for mesh in ("diamond", "square"))
    step = 2.0 * BAR * HUNG
    cuts = "B" * 1000
    works: dict[str, Callable[[], fyke.Net]] = {
        "panel": lambda: fyke.panel(
            twine, mesh="diamond", meshes=(707, 707), bar_length=BAR, size=(707 * step, 707 * step)
        ),
        "trapezoid, cut AB": lambda: fyke.panel(
            twine,
            mesh="diamond",
            meshes=(1500, 500),
            bar_length=BAR,
            size=(1500 * step, 500 * step),
            taper=Taper(cuts, cuts),
        ),
        "cylinder": lambda: frustum(diamond, (1000, 500), diameters=(20.0, 20.0), height=30.0),
        "cage with a bottom": lambda: cage(
            diamond, (1000, 400), diameter=20.0, depth=30.0, bottom=(100, 1.0)
        ),
        "box": lambda: box(diamond, (330, 330, 300), size=(330 * step, 330 * step, 300 * step)),
        "box of squares": lambda: box(square, (450, 450, 440), size=(450 * BAR, 450 * BAR, 440 * BAR)),
        "bag of four panels": lambda: bag(
            diamond, (750, 250), panels=4, cuts="B" * 500, diameters=(25.0, 50.0), height=15.0
        ),
    }
    counts = {name: work().knot_count for name, work in works.items()}
    times = {name: seconds(work) for name, work in works.items()}
    first = times["panel"]
    return [
        (f"building: {name}, {counts[name]:,} knots", f"{found:.2f} s, {found / first:.2f} x panel", GOAL)
        for name, found in times.items()
    ]


def whole() -> list[Row]:
    """A cage of a million knots from its case file to a system."""
    case = fyke.parse_case(CAGE)
    net = fyke.build_net(case)
    steps: dict[str, Callable[[], object]] = {
        "reading and judging the case": lambda: fyke.parse_case(CAGE),
        "building the net": lambda: fyke.build_net(case),
        "building the system": lambda: fyke.build_system(net, case),
    }
    return [
        (
            f"case of a cage, {net.knot_count:,} knots: {name}",
            f"{seconds(work):.2f} s",
            GOAL if "net" in name else "",
        )
        for name, work in steps.items()
    ]


def gear() -> list[Row]:
    """All of it."""
    return [*building(), *whole(), *waves(), *statics()]


if __name__ == "__main__":
    print(table_of(gear()))
