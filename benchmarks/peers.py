"""One panel in fyke and in other tools, side by side: prints a table and writes PEERS.md.

Run with `make bench-peers`. Two works: motion, 2 s from rest with the current switched on at once, after which the
panel hangs still, and statics. Every try runs alone in a process, on one thread, for at most LIMIT seconds. A tool
climbs its ladder of options, loosest first, until its three answers lie within 1 % of the reference, a dynamic
relaxation to 1e-9 N written for this comparison and no part of fyke.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from peer_motion import DURATION
from peer_panel import answers, make_panel, relax
from peer_tools import LARGE, MOTION, STATICS, TOOLS, Tool
from timing import machine

HERE = Path(__file__).parent
# Seconds that one try may take, importing and compiling included.
LIMIT = 60.0
WITHIN = 0.01
CELLS = {MOTION: 8, STATICS: 8, LARGE: 32}
# Works of less than so many seconds are repeated, the best counts.
REPEATED, REPEATS = 5.0, 3
DIGITS = {"sag": 7, "drag": 5, "tension": 6}
ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "RAYON_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
    "JAX_PLATFORMS": "cpu",
}

HEAD = """# The same panel in other tools

Made by `make bench-peers` on {date}: {machine}.

Diamond netting on a square frame 10 % too small for it, in a current of 0.5 m/s; see
[peer_panel.py](peer_panel.py) for the numbers and [peer_motion.py](peer_motion.py) and
[peer_statics.py](peer_statics.py) for what each tool is told.
Every row is the same net with the same equations. **Motion**: {duration:g} s from the flat net at rest, the current on
from the start, no damping in the twine; **statics**: the equilibrium, at which the motion ends too. What is compared is
the end: the mean position of the four knots in the middle, the drag of all bars and knots, the largest tension. The
reference is a dynamic relaxation to 1e-9 N in plain loops, none of it fyke's.

How to read it:

- The time is that of the solve alone on one thread, without import, set-up and compilation; best of 3 below 5 s, else
  one run. The machine does other things too: read the ratios.
- Each tool climbs its ladder of tolerances or steps, loosest first, to the first that gives all three answers within
  1 %; that rung is shown. A try over {limit:.0f} s, import and compilation included, ends the climb. The rows below the
  right ones say what went wrong.
- Only the end of the motion is compared, and it is at rest. That suits methods that damp the ringing of taut bars,
  which is what one wants of a net but not of every problem. The ringing between 0.1 and 0.3 s is chaotic and differs
  between any two rows.
- SciPy, SUNDIALS and MuJoCo call a compiled right-hand side (drag and weight for MuJoCo) through Python, once an
  evaluation or step. diffrax compiles its own. MoorDyn has its own water forces and takes drag on the unloaded length.
- Clarabel solves a convex program for a dead load; the water's load is renewed from the shape so many times.

"""


def measure(tool: Tool, option: str) -> dict[str, float]:
    """Wall time (s) of one tool with one option, and its answers."""
    panel = make_panel(CELLS[tool.work])
    walls: list[float] = []
    while not walls or (max(walls) < REPEATED and len(walls) < REPEATS):
        work = tool.make(panel, *tool.ladder[option])
        began = time.perf_counter()
        x, v = work()
        walls.append(time.perf_counter() - began)
    return {"wall": min(walls)} | answers(panel, x, v)


def reference(cells: int) -> dict[str, float]:
    """Return the answers of the equilibrium, found without fyke."""
    panel = make_panel(cells)
    x = panel.start.copy()
    most = 10**6
    if relax(x, panel.free, panel.bars, panel.weight, 0.995 if cells < 20 else 0.998, 1e-9, most) == most:
        raise RuntimeError(f"the reference of {cells} x {cells} meshes was not found")
    return answers(panel, x, 0.0 * x)


def attempt(index: int, option: str) -> dict[str, float] | str:
    """One try in a process of its own: its numbers, or why there are none."""
    command = [sys.executable, str(Path(__file__)), "--tool", str(index), "--option", option]
    try:
        done = subprocess.run(
            command, env=os.environ | ONE_THREAD, capture_output=True, text=True, timeout=LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        return f"over {LIMIT:.0f} s"
    if done.returncode != 0:
        return (done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"])[-1][:100]
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


@dataclass
class Row:
    """A line of the table; why: what is wrong with it, "" when nothing is; wrong: options that went wrong before."""

    name: str
    option: str = ""
    why: str = ""
    wall: float = 0.0
    found: dict[str, float] = field(default_factory=dict)
    error: float = 0.0
    wrong: list[str] = field(default_factory=list)

    def cells(self, best: float) -> list[str]:
        """Texts of the line."""
        shown = (
            [f"{self.found[key]:.{digits}f}" for key, digits in DIGITS.items()] if self.found else [""] * 3
        )
        times = (
            [f"{self.wall:.3g}", f"{self.wall / best:.3g}"] if self.wall > 0.0 and self.found else ["", ""]
        )
        error = f"{100 * self.error:.2g} %" if self.wall > 0.0 and self.found else ""
        before = [f"wrong with {', '.join(self.wrong)}"] if self.wrong else []
        return [self.name, self.option, *times, *shown, error, "; ".join([self.why, *before][not self.why :])]


def climb(index: int, exact: dict[str, float]) -> Row:
    """Try the options of a tool until one is right."""
    tool = TOOLS[index]
    try:
        row = Row(f"{tool.name} ({tool.package} {version(tool.package)})")
    except PackageNotFoundError:
        return Row(tool.name, why=f"{tool.package} is not installed")
    for option in tool.ladder:
        row.option, row.found = option, {}
        tried = attempt(index, option)
        if isinstance(tried, str):
            row.why = tried
            break
        row.wall, row.found = tried.pop("wall"), tried
        row.error = max(abs(tried[key] / exact[key] - 1.0) for key in exact)
        row.why = "" if row.error <= WITHIN else "wrong"
        if not row.why:
            break
        row.wrong.append(option)
    if row.why == "wrong":
        row.wrong.pop()
    return row


def table(work: str, exact: dict[str, float], rows: list[Row]) -> str:
    """Rows of one work, fastest first, those without a right answer at the end."""
    rows = sorted(rows, key=lambda r: (r.why != "", r.wall))
    best = min(r.wall for r in rows if r.name.startswith("fyke ") and not r.why)
    lines = [
        f"## {work[0].upper()}{work[1:]}",
        "",
        "| tool | options | wall s | over fyke's best | sag m | drag N | largest tension N | off by | remarks |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    lines += [f"| {' | '.join(r.cells(best))} |" for r in (Row("reference", found=exact), *rows)]
    return "\n".join(lines)


def main() -> None:
    """Measure, print and write."""
    sections = []
    for work, cells in CELLS.items():
        exact = reference(cells)
        rows = []
        for index, tool in enumerate(TOOLS):
            if tool.work == work:
                rows.append(climb(index, exact))
                print(".. " + " | ".join(rows[-1].cells(1.0)), flush=True)
        sections.append(table(work, exact, rows))
    text = HEAD.format(date=time.strftime("%Y-%m-%d"), machine=machine(), limit=LIMIT, duration=DURATION)
    text += "\n\n".join(sections) + "\n"
    print(text)
    (HERE / "PEERS.md").write_text(text)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--tool", type=int)
    parser.add_argument("--option", default="")
    chosen = parser.parse_args()
    if chosen.tool is None:
        main()
    else:
        print(json.dumps(measure(TOOLS[chosen.tool], chosen.option)))
