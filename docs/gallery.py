"""Make gallery.md and its pictures: every figure function once, with the lines that draw it. Run: make gallery."""

from __future__ import annotations

import inspect
import io
import os
import tempfile
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from PIL import Image

from fyke.report import figures, laws
from fyke.report.style import styled

HERE = Path(__file__).parent
DOTS = 200  # per inch
COLOURS = 256  # of a picture, which takes a quarter of the bytes then

HEAD = """# Gallery

Every figure of fyke, drawn by `make gallery`, which runs the lines of this page. A figure is a matplotlib `Figure` of
one or two columns of a journal; `fyke run` writes those that apply as PNG and SVG.
"""

START = """from pathlib import Path

import numpy as np

import fyke
from fyke.forces.evaluate import evaluate
from fyke.report.figures import (
    equilibrium_shape,
    histories,
    initial_position,
    sections,
    shape_comparison,
    tension_histogram,
    tension_plan,
    wave_histories,
)
from fyke.report.laws import panel_by_angle
from fyke.results import compare, probe
from fyke.water.laws import LAWS
from fyke.water.wakes import ChengTwines
from fyke.water.waves import irregular

case = fyke.load_case("examples/panel.toml")
system = fyke.build_system(fyke.build_net(case), case)
current = case.current.at_surface
result = fyke.solve_static(system)
run = fyke.simulate(system, duration=0.3, every=0.002, stepper=fyke.Symplectic())
"""

# What is drawn with which lines, and a remark.
SHOWN = {
    "initial_position": ("initial_position(result, current=current)", ""),
    "equilibrium_shape": ("equilibrium_shape(result)", ""),
    "tension_plan": ("tension_plan(result)", ""),
    "tension_histogram": ("tension_histogram(result)", ""),
    "histories": ("histories(run, current=current)", ""),
    "shape_comparison": (
        """rows = ["knot,x,y,z"]
for knot in np.flatnonzero(~result.net.fixed)[::2]:
    x, y, z = 0.005 * np.round(result.position[-1][knot] / 0.005)
    rows.append(f"{result.net.labels[knot]},{x:.3f},{y:.3f},{z:.3f}")
Path("measured.csv").write_text("\\n".join(rows), encoding="utf-8")
shape_comparison(result, compare(result, "measured.csv"))""",
        "For want of a measurement, computed places rounded to 5 mm stand in for it here.",
    ),
    "sections": (
        """cage = fyke.load_case("examples/cylinder.toml")
caged = fyke.build_system(fyke.build_net(cage), cage)
sections(fyke.solve_static(caged), current=cage.current.at_surface)""",
        "Of netting that closes round.",
    ),
    "wave_histories": (
        """sea = irregular(1.0, 6.0, gamma=3.3, depth=30.0, ramp=10.0)
times, points = np.linspace(0.0, 60.0, 301), [[0.0, 0.0, -2.0], [8.0, 0.0, -2.0]]
wave_histories(probe(system.current, sea, times, points))""",
        "Written as `waves` by a run in waves: the elevation at its probes, the velocity of the water at the first.",
    ),
}

# The same of figures that are not of a result.
MEASURED = {
    "panel_by_angle": (
        """bars = {
    "bars, 1.2 and 0.1": fyke.Coefficients(),
    "bars, sheltered": fyke.Coefficients(twines=ChengTwines()),
    "bars, ns-cheng": fyke.Coefficients(bars=LAWS["bars"]["ns-cheng"](tangential=0.1)),
}
screens = {
    name: fyke.Coefficients(screens=LAWS["panels"][name]())
    for name in ("kristiansen-faltinsen", "aarsnes", "loland")
}
angles = np.radians(np.linspace(0.0, 90.0, 31))
twine = fyke.Twine("main", 1140.0, 2.8e-3, fyke.LinearLaw(1e9))
water = fyke.Water(kinematic_viscosity=1.002e-6)
curves = {}
for name, coefficients in (bars | screens).items():
    mesh = 26.522e-3 if name in screens else 29e-3  # of solidity 0.20 as stated; as measured, which has 0.184
    net = fyke.panel(twine, mesh="square", meshes=(10, 10), bar_length=mesh, size=(10 * mesh, 10 * mesh))
    still = fyke.State(0.0, net.positions, np.zeros_like(net.positions))
    area = (100 if name in screens else net.bar_count / 2) * mesh**2
    points = []
    for along in np.array([np.cos(angles), np.sin(angles), 0.0 * angles]).T:
        system = fyke.make_system(net, current=tuple(0.5 * along), coefficients=coefficients, water=water)
        force = evaluate(system, still).hydrodynamic_force / (500 * 0.5**2 * area)
        points.append((force @ along, force @ (along[1], -along[0], 0.0)))
    curves[name] = np.vstack([angles, np.transpose(points)])
panel_by_angle(curves)""",
        "Knotless netting of 2.8 mm twine and 29 mm bars at 0.5 m/s, flat: as bars, and as screens by the "
        "three laws whose words stand alone; [validation](validation.md#a-measured-panel) has the figures.",
    ),
}


@styled
def write_picture(figure: Figure, path: Path) -> None:
    """Write a figure as a PNG of few colours."""
    with io.BytesIO() as file:
        figure.savefig(file, format="png", dpi=DOTS)
        few = Image.open(file).convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
        few.save(path, optimize=True, dpi=(DOTS, DOTS))


def page() -> str:
    """Return the text of the page."""
    parts = [HEAD, f"```python\n{START}```\n"]
    for name, (lines, remark) in (SHOWN | MEASURED).items():
        home = figures if name in SHOWN else laws
        sentence = (inspect.getdoc(getattr(home, name)) or "").split("\n\n")[0]
        text = f"{sentence} {remark}".strip()
        parts.append(
            f"## {name}\n\n{text}\n\n```python\n{lines}\n```\n\n![{name}](images/gallery/{name}.png)\n"
        )
    return "\n".join(parts)


def draw(folder: Path) -> None:
    """Run the lines of the page and write the picture of each figure into a folder."""
    names: dict[str, Any] = {}
    exec(START, names)
    for name, (lines, _) in (SHOWN | MEASURED).items():
        *before, last = lines.split("\n")
        exec("\n".join([*before, f"figure = {last}"]), names)
        write_picture(names["figure"], folder / f"{name}.png")


def main() -> None:
    """Write the page and all pictures."""
    (HERE / "gallery.md").write_text(page(), encoding="utf-8")
    with tempfile.TemporaryDirectory() as scratch:
        (Path(scratch) / "examples").symlink_to(HERE.parent / "examples")
        os.chdir(scratch)
        draw(HERE / "images" / "gallery")
        os.chdir(HERE)


if __name__ == "__main__":
    main()
