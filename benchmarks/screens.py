"""Speed of screens: the load of the water on the meshes of a panel beside that on its bars and knots, in one run.

Run with `make bench-screens`. The kernels take one thread. Times are the best of several repeats on a machine that may
be doing other things: read the ratios.
"""

from __future__ import annotations

import numpy as np
from run import best, panel_system

from fyke.forces.bars import bar_geometry, water_load
from fyke.forces.screens import Screens
from fyke.netting.faces import faces_of
from fyke.solve.pattern import Pattern
from fyke.solve.smooth import assemble_step
from fyke.water.laws import LAWS

MESHES, REPEATS = 100, 40
GOAL = 30.0  # ns a face


def main() -> None:
    """Print the table."""
    system = panel_system(MESHES)
    net, el, faces = system.net, system.elements, faces_of(system.net)
    rng = np.random.default_rng(0)
    x = net.positions + 1e-3 * rng.normal(size=net.positions.shape)
    rel = np.array([0.5, 0.0, 0.0]) + 0.05 * rng.normal(size=x.shape)
    t, length, out = np.empty((net.bar_count, 3)), np.empty(net.bar_count), np.zeros_like(x)

    def on_bars() -> None:
        bar_geometry(x, el, t, length)
        water_load(rel, el, t, length, out)

    pattern = Pattern.of(el, faces.corners)
    data, zeros, mass = np.zeros(len(pattern.indices)), np.zeros(net.bar_count), np.ones((net.knot_count, 6))

    def bars_into_matrix() -> None:
        assemble_step(
            rel, el, t, length, zeros, zeros, 1.0, 1.0, 1.0, mass, False, pattern.start, pattern.stride,
            pattern.diagonal, data,
        )  # fmt: skip

    bars, matrix = best(on_bars, REPEATS), best(bars_into_matrix, REPEATS)
    per = 1e9 / faces.count
    print(f"{faces.count} faces, {net.bar_count} bars, {net.knot_count} knots\n")
    print(
        f"| what | load, ns a face (goal {GOAL:g}) | over bars and knots | into the matrix | over bars and knots |"
    )
    print("|---|---|---|---|---|")
    print(f"| bars and knots | {bars * per:.1f} | 1 | {matrix * per:.0f} | 1 |")
    for name, law in LAWS["panels"].items():
        screens = Screens.of(faces, law(), 1000.0, 1e-6)
        load = best(lambda s=screens: s.add_load(x, rel, out), REPEATS)
        into = best(
            lambda s=screens: s.assemble(x, rel, 1.0, 1.0, pattern.groups, symmetric=False, data=data),
            REPEATS,
        )
        print(f"| {name} | {load * per:.1f} | {load / bars:.2f} | {into * per:.0f} | {into / matrix:.2f} |")
    plain = Pattern.of(el)
    print(
        f"\npattern: {len(pattern.indices) / len(plain.indices):.2f} times the entries of that of the bars, found in "
        f"{best(lambda: Pattern.of(el, faces.corners), 5) / best(lambda: Pattern.of(el), 5):.1f} times its time"
    )


if __name__ == "__main__":
    main()
