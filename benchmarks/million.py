"""Static equilibrium of the framed panel up to a million knots: time, memory and growth; prints and writes MILLION.md.

Run with `make bench-million`: some eight minutes and 10 GB of memory. Each size runs in a process of its own.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from math import log
from pathlib import Path

from timing import machine

HERE = Path(__file__).parent
SIZES = (100, 200, 400, 707)
TOLERANCE = 1e-6  # N, true residual

ONE = """
import json, resource, sys, time
sys.path.insert(0, {here!r})
from timing import panel_system
import fyke
from fyke.solve import nested
large, nested.LARGE = nested.LARGE, 400
assert fyke.solve_static(panel_system(24)).outcome.ok  # compiles, or reads what was compiled
nested.LARGE = large
began = time.perf_counter()
system = panel_system({meshes})
built = time.perf_counter() - began
outcome = fyke.solve_static(system, tolerance={tolerance}).outcome
whole = time.perf_counter() - began
assert outcome.ok and outcome.residual <= {tolerance}, outcome
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
print(json.dumps(dict(knots=system.net.knot_count, unknowns=3 * int(system.elements.free.sum()), built=built,
    whole=whole, factorizations=outcome.factorizations, residual=outcome.residual, peak=peak, said=outcome.message)))
"""


def measure(meshes: int) -> dict:
    """Build and solve one panel in its own process."""
    code = ONE.format(here=str(HERE), meshes=meshes, tolerance=TOLERANCE)
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def main() -> None:
    """Measure, print and write."""
    lines = [
        "| meshes | knots | unknowns | building (s) | whole (s) | factorizations | residual (N) | peak (GB) | growth |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    rows: list[dict] = []
    for meshes in SIZES:
        row = measure(meshes)
        growth = ""
        if rows:
            power = log(row["whole"] / rows[0]["whole"]) / log(row["knots"] / rows[0]["knots"])
            growth = f"N^{power:.2f}"
        rows.append(row)
        lines.append(
            f"| {meshes} x {meshes} | {row['knots']} | {row['unknowns']} | {row['built']:.1f} | {row['whole']:.1f} | "
            f"{row['factorizations']} | {row['residual']:.1e} | {row['peak']:.2f} | {growth} |"
        )
        print(lines[-1], flush=True)
    text = f"""# A million knots

Made by `make bench-million` on {time.strftime("%Y-%m-%d")}: {machine()}.

Static equilibrium of the example's diamond panel with more meshes, to a true residual of {TOLERANCE:g} N. Whole: from
building the net to the result. Factorizations: on the real meshes; those on grouped meshes, which the solve begins
with, are in the time. Growth: of the whole time since the first row, N the number of knots. The last solve said:
"{rows[-1]["said"]}".
Goals: 707 x 707 within 360 s and 12 GB on 2 cores; growth at most N^1.5.

"""
    (HERE / "MILLION.md").write_text(text + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
