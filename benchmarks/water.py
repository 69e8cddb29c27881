"""What the water costs: laws of drag beside constant coefficients, currents, waves, screens and shelter.

Run with `make bench-water`; the rows are part of `make bench`. Every kernel takes one thread. Times are the best of
several repeats on a machine that may be doing other things: read the ratios, not the seconds.
"""

from __future__ import annotations

import math

import numpy as np
from timing import Row, best, best_in_turn, forces_of, in_motion, leaps_of, panel_system, table_of

import fyke
from fyke.forces.bars import bar_geometry, water_load
from fyke.forces.screens import Screens
from fyke.forces.shelter import Shelter
from fyke.forces.surroundings import Surroundings
from fyke.netting.faces import faces_of
from fyke.netting.together import together
from fyke.solve.pattern import Pattern
from fyke.solve.smooth import assemble_step
from fyke.water.laws import LAWS, AngleTable, BarTable, bars, knots
from fyke.water.wakes import ChengTwines, ChengWake
from fyke.water.waves import Spreading, Waves, airy, irregular, stokes2

# Speed (m/s) of the knots in a current of 0.5 m/s, so that the laws are asked at all speeds and angles.
MOTION = 0.2


def angle_table(speeds: int, angles: int) -> AngleTable:
    """A table with so many rows and columns, of a cylinder."""
    re, angle = np.geomspace(10.0, 1e5, speeds), np.linspace(0.0, 0.5 * np.pi, angles)
    across = (1.0 + 10.0 * re ** (-2.0 / 3.0))[:, None]
    drag, lift = across * np.sin(angle) ** 3, across * np.sin(angle) ** 2 * np.cos(angle)
    return AngleTable(
        tuple(re.tolist()), tuple(angle.tolist()), *(tuple(map(tuple, t.tolist())) for t in (drag, lift))
    )


def laws() -> list[Row]:
    """A law against constant coefficients in explicit kernels, and finding the water at every residual elsewhere."""
    sphere, table = knots.CliftGauvin(), BarTable((10.0, 100.0, 1e4), (2.5, 1.6, 1.1), (0.3, 0.2, 0.05))
    given: dict[str, tuple[fyke.Coefficients, str]] = {
        "constant bars and knots": (fyke.Coefficients(), ""),
        "clift-gauvin knots": (fyke.Coefficients(knots=sphere), "<= 2, 2"),
        "takagi bars": (fyke.Coefficients(bars=bars.Takagi()), "<= 2, 2"),
        "choo-casarella bars": (fyke.Coefficients(bars=bars.ChooCasarella()), "<= 2, 2"),
        "choo-casarella bars, clift-gauvin knots": (
            fyke.Coefficients(bars=bars.ChooCasarella(), knots=sphere),
            "<= 2, 2",
        ),
        "hoerner bars": (fyke.Coefficients(bars=bars.Hoerner()), "<= 2, 2"),
        "table of C_n and C_t": (fyke.Coefficients(bars=table), "<= 2, 2"),
        "angle table, 3 x 7": (fyke.Coefficients(bars=angle_table(3, 7)), ""),
        "angle table, 20 x 91": (fyke.Coefficients(bars=angle_table(20, 91)), ""),
    }
    net, count, steps = panel_system(32).net, 5, 10
    forces, leaps = {}, {}
    for name, (law, _) in given.items():
        system = fyke.make_system(net, current=(0.5, 0.0, 0.0), coefficients=law)
        start = in_motion(system, MOTION)
        forces[name], leaps[name] = forces_of(system, start, count), leaps_of(system, start, 1, steps)
    force, leap = best_in_turn(forces, 300), best_in_turn(leaps, 300)
    first = next(iter(given))
    per_bar = 1e9 / net.bar_count
    each = f"{force[first] / count * per_bar:.1f} ns, {leap[first] / (steps + 1) * per_bar:.1f} ns"
    rows = [(f"{first}, 32x32: force evaluation, leapfrog step, per bar", each, "")]
    for name, (_, goal) in list(given.items())[1:]:
        found = f"{force[name] / force[first]:.2f}, {leap[name] / leap[first]:.2f}"
        rows.append((f"{name} / constant: force evaluation, leapfrog step", found, goal))
    return rows + around()


def around() -> list[Row]:
    """Finding the water anew at every residual, over the load of it."""
    rows = []
    for meshes in (8, 100):
        for name, law in (
            ("constant", fyke.Coefficients()),
            ("by choo-casarella", fyke.Coefficients(bars=bars.ChooCasarella())),
        ):
            net = panel_system(meshes).net
            system = fyke.make_system(net, current=(0.5, 0.0, 0.0), coefficients=law, surface=True)
            at, start = Surroundings(system), in_motion(system, MOTION)
            x = start.position - np.array([0.0, 0.0, 1e3])
            found = best(lambda a=at, x=x, v=start.velocity: a.at(x, v, 0.0), 40)
            rows.append(
                (f"water found in a uniform current, {meshes}x{meshes}, {name}", f"{1e6 * found:.0f} us", "")
            )
    return rows


def waves() -> list[Row]:
    """Motion of the water at 5000 knots, beside plain numpy and beside numpy's sine alone."""
    count, components, depth = 5000, 200, 40.0
    points = np.random.default_rng(1).uniform([-50.0, -50.0, -30.0], [50.0, 50.0, -3.0], (count, 3))
    sea = irregular(2.0, 7.0, gamma=3.3, components=components, spreading=Spreading(10.0, 15), depth=depth)
    moved = sea.motion(points, 3.0)
    both = np.column_stack([moved.velocity, moved.acceleration, moved.elevation])
    assert abs(both - _by_numpy(sea, points, 3.0)).max() < 1e-12
    phases = np.random.default_rng(2).uniform(-3.0, 3.0, (count, components))
    sine, numpys = best(lambda: np.sin(phases), 20), best(lambda: _by_numpy(sea, points, 3.0), 5)
    took, high = best(lambda: sea.motion(points, 3.0), 20), best(lambda: sea.elevation(points, 3.0), 20)
    what = f"waves, {components} components at {count} knots"
    small, steep = airy(2.0, 7.0, depth=depth), stokes2(2.0, 7.0, depth=depth)
    return [
        (f"{what}: motion", f"{1e3 * took:.2f} ms", "<= 5 ms"),
        (f"{what}: motion / numpy's sine of the phases", f"{took / sine:.2f}", ""),
        (f"{what}: motion / plain numpy", f"{took / numpys:.3f}", ""),
        (f"{what}: elevation", f"{1e3 * high:.2f} ms", ""),
        (
            "waves, airy: motion, per knot",
            f"{1e9 * best(lambda: small.motion(points, 3.0), 20) / count:.0f} ns",
            "",
        ),
        (
            "waves, stokes2: motion, per knot",
            f"{1e9 * best(lambda: steep.motion(points, 3.0), 20) / count:.0f} ns",
            "",
        ),
        *(
            (
                f"waves, {n} components: largest autocorrelation from 20 to 1080 peak periods",
                f"{_likeness(n):.2f}",
                "",
            )
            for n in (50, 200)
        ),
    ]


def _by_numpy(sea: Waves, points: np.ndarray, moment: float) -> np.ndarray:
    """Velocity, acceleration and elevation as numpy adds them up, with the kernel's own overflow-free exponentials."""
    parts = sea.harmonics
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


def _likeness(components: int) -> float:
    """How like itself a sea gets within three hours, at a peak period of 10 s."""
    later = np.arange(200.0, 10_800.0)
    frequency = irregular(2.0, 10.0, gamma=3.3, components=components).harmonics.frequency
    return float(np.abs(np.cos(2.0 * np.pi * np.outer(later, frequency)).mean(axis=1)).max())


def screens() -> list[Row]:
    """Load of the water on the meshes of a panel, and its blocks in the matrix, beside those of bars and knots."""
    system = panel_system(100)
    net, el, faces = system.net, system.elements, faces_of(system.net)
    rng = np.random.default_rng(0)
    x = net.positions + 1e-3 * rng.normal(size=net.positions.shape)
    rel = np.array([0.5, 0.0, 0.0]) + 0.05 * rng.normal(size=x.shape)
    t, length, out = np.empty((net.bar_count, 3)), np.empty(net.bar_count), np.zeros_like(x)
    pattern = Pattern.of(el, faces.corners)
    data, zeros, mass = np.zeros(len(pattern.indices)), np.zeros(net.bar_count), np.ones((net.knot_count, 6))
    places = pattern.start, pattern.stride, pattern.diagonal

    def on_bars() -> None:
        bar_geometry(x, el, t, length)
        water_load(rel, el, t, length, out)

    def bars_into_matrix() -> None:
        assemble_step(rel, el, t, length, zeros, zeros, 1.0, 1.0, 1.0, mass, False, *places, data)

    per_bars, matrix = best(on_bars, 40), best(bars_into_matrix, 40)
    per = 1e9 / faces.count
    rows = [(f"bars and knots, {faces.count} meshes: load, per mesh", f"{per_bars * per:.1f} ns", "")]
    for name, law in LAWS["panels"].items():
        faced = Screens.of(faces, law(), 1000.0, 1e-6)
        load = best(lambda s=faced: s.add_load(x, rel, out), 40)
        into = best(
            lambda s=faced: s.assemble(x, rel, 1.0, 1.0, pattern.groups, symmetric=False, data=data), 40
        )
        rows.append((f"screens, {name}: load, per mesh", f"{load * per:.1f} ns", "<= 30 ns"))
        rows.append((f"screens, {name}: into the matrix / bars and knots", f"{into / matrix:.2f}", ""))
    plain = Pattern.of(el)
    more = len(pattern.indices) / len(plain.indices)
    return [*rows, ("screens: entries of the matrix / bars alone", f"{more:.2f}", "")]


def shelter() -> list[Row]:
    """One evaluation of all factors by which netting slows the current."""
    nets = {
        "two panels of 50x50": together([_flat(50), _flat(50, 1.0)]),
        **{f"100x100 at {angle:g} deg": _flat(100, angle=angle) for angle in (0.0, 60.0, 89.0)},
    }
    rows = []
    for name, net in nets.items():
        faces, x = faces_of(net), net.positions
        along = np.tile([0.5, 0.0, 0.0], (net.knot_count, 1))
        turn = np.radians(22.0) * np.linspace(0.0, 1.0, net.knot_count)
        turning = 0.5 * np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
        given = {
            "wake": (Shelter(faces, ChengWake()), along),
            "twines": (Shelter(faces, None, ChengTwines()), along),
            "both": (Shelter(faces, ChengWake(), ChengTwines()), along),
            "both, current turning by 22 deg": (Shelter(faces, ChengWake(), ChengTwines()), turning),
        }
        times = [f"{1e3 * best(lambda s=s, u=u, x=x: s.factors(x, u), 10):.1f}" for s, u in given.values()]
        rows.append((f"shelter, {name}: {'; '.join(given)}", ", ".join(times) + " ms", ""))
    return rows


def _flat(meshes: int, x: float = 0.0, angle: float = 0.0) -> fyke.Net:
    """A panel 1 m x 1 m at x (m) whose normal makes an angle (deg) with the current."""
    twine = fyke.Twine("main", 1140.0, 2.8e-3, fyke.LinearLaw(1e9))
    return fyke.panel(
        twine,
        mesh="square",
        meshes=(meshes, meshes),
        bar_length=1.0 / meshes,
        size=(1.0, 1.0),
        centre=(x, 0.0, -1.0),
        normal=(float(np.cos(np.radians(angle))), float(np.sin(np.radians(angle))), 0.0),
    )


def water() -> list[Row]:
    """All of it."""
    return [*laws(), *waves(), *screens(), *shelter()]


if __name__ == "__main__":
    print(table_of(water()))
