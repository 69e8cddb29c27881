"""A gravity cage in current by mesh and by size ratio: square, diamond and hexagonal netting, shallow and deep.

Six cages of one volume, one twine, nearly as much twine to the square metre and sinker tubes of one weight, in the
scale of a model, every mesh laid. The upper rim is held; eight ropes as long as the wall is deep carry the tube. Prints
drag, volume left and the largest tension of a bar of the netting by the speed of the current; --figure FILE draws them.

In still water square netting keeps its volume. Diamonds and hexagons have no bars that go straight round: under no more
than its own weight such netting draws in between the rims, the more the deeper it is.

The question is that of Y.-P. Zhao and others (2007), whose paper was not opened: this cage is of our own measure, so it
shows and does not validate. That the size ratio is diameter over depth is told in the abstract of Zhao's thesis.
"""

import argparse
from dataclasses import dataclass
from math import hypot, pi, sqrt

from matplotlib.figure import Figure

import fyke
from fyke.report import style
from fyke.results.volume import volume_history

SPEEDS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9)  # m/s
BAR = 0.040  # m, of the square netting; the others have about as much twine to the square metre
AROUND = {"shallow": 78, "deep": 62}  # squares around the wall
DOWN = 12  # of the shallow one
# Diameters and depths, m, of the same volume: their ratios are 2.07 and 1.04.
SIZES = {
    name: (around * BAR / pi, DOWN * BAR * (AROUND["shallow"] / around) ** 2)
    for name, around in AROUND.items()
}

CASE = """
schema = 1

[water]
density = {density}                     # kg/m3
gravity = {gravity}                       # m/s2

[current]
velocity = [{speed}, 0.0, 0.0]       # m/s

[twine.main]
material = "PA"
diameter = "2 mm"

[twine.rope]
material = "PES"
diameter = "4 mm"

[tube.steel]
material = "steel"
diameter = {outer}
wall = {wall}
contents = "water"
mass_per_length = {mass}             # kg/m, with its ballast

[netting.main]
twine = "main"
mesh = "{mesh}"
bar_length = {bar}
{long_bar}

[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [{around}, {down}]
diameter = {diameter}
height = {depth}
top = [0.0, 0.0, -0.1]
fixed = "top"

[[gear]]
kind = "ring"
name = "sinker tube"
tube = "steel"
along = "cage.bottom"

{ropes}
[shelter]
wake = "loland"
"""
ROPE = """
[[gear]]
kind = "line"
name = "rope {number}"
twine = "rope"
from = "cage.top[{knot}]"
to = "cage.bottom[{knot}]"
length = {depth}
segments = 1
"""
ROPES = 8  # from ring to ring, as long as the wall is deep
OUTER, WALL = 0.010, 0.001  # m, of the sinker tube
WEIGHT = 40.0  # N, of the sinker tube in water
DENSITY, GRAVITY = 1025.0, 9.81  # kg/m3 and m/s2


@dataclass(frozen=True)
class Meshes:
    """Meshes of a wall: how many around and down, and the lengths of their bars (m) when just taut."""

    around: int
    down: int
    bar: float
    long_bar: float | None = None


def square(around: float, depth: float) -> Meshes:
    """Return the squares nearest to BAR on a wall of this way around and depth (m)."""
    n, k = round(around / BAR), round(depth / BAR)
    return Meshes(n, k, max(around / n, depth / k))


def diamond(around: float, depth: float) -> Meshes:
    """Return the diamonds nearest to squares of BAR turned by 45 degrees: E1 and E2 about 0.7071."""
    n, k = 2 * round(around / (sqrt(8) * BAR)), round(depth / (sqrt(2) * BAR))
    return Meshes(n, k, hypot(around / n, depth / k) / 2)


def hexagonal(around: float, depth: float) -> Meshes:
    """Return hexagons, nearly regular; with odd rows both rims have their knots in the same columns."""
    n = round(around / BAR)
    bar = around / n / sqrt(3)
    k = 2 * round(((depth - bar / 2) / (1.5 * bar) - 1) / 2) + 1
    return Meshes(n, k, bar, (depth - bar / 2) / k - bar / 2)


MESHES = {"square": square, "diamond": diamond, "hexagonal": hexagonal}


@dataclass(frozen=True)
class Answer:
    """What one cage does at one speed (m/s).

    drag: N; volume_left: share of that built; tension: N, the largest of the netting.
    """

    speed: float
    drag: float
    volume_left: float
    tension: float
    result: fyke.Result


def case_of(mesh: str, size: str, speed: float) -> fyke.Case:
    """Return the case of one cage at one speed (m/s)."""
    diameter, depth = SIZES[size]
    laid = MESHES[mesh](pi * diameter, depth)
    # Where a rim begins, in meshes from the middle of the lee side.
    first = 0.5 if mesh == "hexagonal" else 0.0
    text = CASE.format(
        density=DENSITY,
        gravity=GRAVITY,
        speed=speed,
        mesh=mesh,
        bar=laid.bar,
        long_bar=f"long_bar = {laid.long_bar}" if laid.long_bar else "",
        around=laid.around,
        down=laid.down,
        diameter=diameter,
        depth=depth,
        outer=OUTER,
        wall=WALL,
        mass=WEIGHT / (GRAVITY * pi * diameter) + DENSITY * pi * (OUTER - WALL) * WALL,
        ropes="".join(
            ROPE.format(number=i, knot=round((i + 0.5) * laid.around / ROPES - first), depth=depth)
            for i in range(ROPES)
        ),
    )
    return fyke.parse_case(text)


def answers(mesh: str, size: str, speeds: tuple[float, ...] = SPEEDS) -> list[Answer]:
    """Solve one cage at every speed (m/s), each from the shape of the one before.

    RuntimeError where a solve does not converge.
    """
    found: list[Answer] = []
    for speed in speeds:
        case = case_of(mesh, size, speed)
        net = fyke.build_net(case)
        start = found[-1].result.state() if found else None
        result = fyke.solve_static(fyke.build_system(net, case), start=start)
        if not result.outcome.ok:
            raise RuntimeError(f"{mesh} {size} at {speed} m/s: {result.outcome.message}")
        volumes = volume_history(result)
        if volumes is None:
            raise RuntimeError(f"{mesh} {size} encloses nothing")
        left = float(volumes[1][-1]) / volumes[0]
        tension = float(result.tension[-1][net.panels[0].bars].max())
        found.append(Answer(speed, float(result.hydrodynamic_force[-1, 0]), left, tension, result))
    return found


Found = dict[tuple[str, str], list[Answer]]


def table(found: Found) -> str:
    """Return the answers by mesh and size as text."""
    lines = []
    for size, (diameter, depth) in SIZES.items():
        volume = pi / 4 * diameter**2 * depth
        sizes = f"{diameter:.3f} m across, {depth:.3f} m deep, ratio {diameter / depth:.2f}"
        lines.append(f"{size}: {sizes}, {volume:.3f} m3")
        lines.append(" " * 7 + "".join(f"{mesh:>27}" for mesh in MESHES))
        lines.append("    m/s" + "   drag N  volume %  tens. N" * len(MESHES))
        for row in zip(*(found[mesh, size] for mesh in MESHES), strict=True):
            cells = (f"{a.drag:9.2f}{100 * a.volume_left:10.1f}{a.tension:9.3f}" for a in row)
            lines.append(f"{row[0].speed:7.1f}" + "".join(f"{cell:>27}" for cell in cells))
    return "\n".join(lines)


@style.styled
def curves(found: Found) -> Figure:
    """Draw volume left and drag against the speed: a colour and a marker for each mesh, dashes for the deep cage."""
    figure = Figure(figsize=(style.DOUBLE_COLUMN, 2.6), layout="constrained")
    looks = zip(MESHES, (style.BLUE, style.VERMILION, style.GREEN), ("s", "D", "h"), strict=True)
    volume, drag = figure.subplots(1, 2)
    for mesh, colour, marker in looks:
        for size, dashes in zip(SIZES, ("-", "--"), strict=True):
            speeds = [a.speed for a in found[mesh, size]]
            look = {"color": colour, "marker": marker, "linestyle": dashes, "markersize": 3.5}
            left = [100 * a.volume_left for a in found[mesh, size]]
            volume.plot(speeds, left, label=f"{mesh}, {size}", **look)
            drag.plot(speeds, [a.drag for a in found[mesh, size]], **look)
    for ax, name in ((volume, "Volume left (%)"), (drag, "Drag (N)")):
        ax.set_xlabel("Speed of the current (m/s)")
        ax.set_ylabel(name)
        ax.set_ylim(bottom=0.0)
        ax.set_xlim(left=0.0)
        ax.grid(True)
    figure.legend(loc="outside right center", handlelength=3.0)
    return figure


def main() -> None:
    """Solve all cages, print the table, and draw the curves where a file is named."""
    options = argparse.ArgumentParser(description="Cages in current by mesh and by size ratio.")
    options.add_argument("--figure", metavar="FILE", help="draw the curves: .png, .svg or .pdf")
    wanted = options.parse_args().figure
    found = {(mesh, size): answers(mesh, size) for size in SIZES for mesh in MESHES}
    print(table(found))
    if wanted:
        curves(found).savefig(wanted, dpi=style.RESOLUTION)


if __name__ == "__main__":
    main()
