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

from fyke.report import figures
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
from fyke.report.figures import (
    equilibrium_shape,
    histories,
    initial_position,
    shape_comparison,
    tension_histogram,
    tension_plan,
    wave_histories,
)
from fyke.results import compare, probe
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
    "wave_histories": (
        """sea = irregular(1.0, 6.0, gamma=3.3, depth=30.0, ramp=10.0)
times, points = np.linspace(0.0, 60.0, 301), [[0.0, 0.0, -2.0], [8.0, 0.0, -2.0]]
wave_histories(probe(system.current, sea, times, points))""",
        "Written as `waves` by a run in waves: the elevation at its probes, the velocity of the water at the first.",
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
    for name, (lines, remark) in SHOWN.items():
        sentence = (inspect.getdoc(getattr(figures, name)) or "").split("\n\n")[0]
        text = f"{sentence} {remark}".strip()
        parts.append(
            f"## {name}\n\n{text}\n\n```python\n{lines}\n```\n\n![{name}](images/gallery/{name}.png)\n"
        )
    return "\n".join(parts)


def draw(folder: Path) -> None:
    """Run the lines of the page and write the picture of each figure into a folder."""
    names: dict[str, Any] = {}
    exec(START, names)
    for name, (lines, _) in SHOWN.items():
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
