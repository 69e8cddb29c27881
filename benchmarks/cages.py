"""Cages of 5 000 and 50 000 knots: statics, and a minute of regular waves; each figure in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from timing import Row

HERE = Path(__file__).parent
CASE = """schema = 1
[water]
depth = 100.0
[current]
velocity = [0.5, 0.0, 0.0]
[waves]
kind = "airy"
height = 1.0
period = "6 s"
ramp = "6 s"
[twine.main]
material = "PA"
diameter = "3 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = {bar}
[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [{around}, {down}]
diameter = 10.0
height = 8.0
top = [0.0, 0.0, {top}]
bottom = {{ meshes = {bottom}, depth = "3 m" }}
[[gear]]
kind = "sinkers"
along = "cage.bottom"
count = {sinkers}
weight = "{weight} N"
density = 7850.0
{more}
[solve]
kind = "dynamic"
duration = 60.0
"""
SMALL, LARGE = (84, 17, 14), (270, 54, 45)
# Simulated seconds that are measured of the 60.
SHARE = 1.0
ONE = """
import json, resource, sys, time
import fyke
def system(text):
    case = fyke.parse_case(text)
    return fyke.build_system(fyke.build_net(case), case)
kind, text, warm, share = json.loads(sys.stdin.read())
def solve(one, seconds):
    if kind == "static":
        return fyke.solve_static(one).outcome
    stepper = fyke.Symplectic() if kind == "symplectic" else fyke.Implicit()
    return fyke.simulate(one, duration=seconds, stepper=stepper, every=0.1).outcome
one = system(text)
solve(system(warm), 0.1)  # compiles, or reads what was compiled
wall, cpu = time.perf_counter(), time.process_time()
outcome = solve(one, share)
print(json.dumps(dict(knots=one.net.knot_count, wall=time.perf_counter() - wall, cpu=time.process_time() - cpu,
    name=outcome.name, iterations=outcome.iterations, message=outcome.message,
    peak=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)))
"""


def case_of(meshes: tuple[int, int, int], *, sinkers: int, more: str = "", top: float = 0.0) -> str:
    """The case of a cage whose sinkers weigh 8.4 kN together."""
    around, down, bottom = meshes
    bar = 0.51 * ((31.416 / around) ** 2 + (8.0 / down) ** 2) ** 0.5
    return CASE.format(
        around=around,
        down=down,
        bottom=bottom,
        bar=bar,
        sinkers=sinkers,
        weight=8400 / sinkers,
        more=more,
        top=top,
    )


def measured(kind: str, text: str, warm: str) -> dict:
    """Run one in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", ONE],
        input=json.dumps([kind, text, warm, SHARE]),
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    return json.loads(done.stdout)


def statics() -> Iterator[Row]:
    """Equilibrium in 0.5 m/s after compilation."""
    rope = '[twine.rope]\nmaterial = "PES"\ndiameter = "20 mm"\n[[gear]]\nkind = "rope"\ntwine = "rope"\n'
    rope += 'along = "cage.bottom"\n'
    shelter = '[drag]\nbars = "ns-cheng"\n[shelter]\nwake = "loland"\n'
    for what, meshes, sinkers, more, goal in (
        ("a sinker at every mesh", SMALL, 84, "", "< 1 s"),
        ("16 sinkers and a footrope", SMALL, 16, rope, "< 1 s"),
        ("16 sinkers", SMALL, 16, "", "< 1 s"),
        ("a sinker at every mesh", LARGE, 270, "", "< 20 s"),
        ("16 sinkers, ns-cheng, Loland's wake", SMALL, 16, shelter, "< 1 s"),
    ):
        warm = case_of((24, 5, 4), sinkers=min(sinkers, 24), more=more)
        one = measured("static", case_of(meshes, sinkers=sinkers, more=more), warm)
        yield (
            f"static cage, {one['knots']:,} knots, {what}",
            f"{one['wall']:.1f} s, {one['cpu']:.1f} s of processor, {one['iterations']} iterations, "
            f"{one['peak']:.0f} MB, {one['name']}",
            goal,
        )


def waves() -> Iterator[Row]:
    """A minute of waves of 1 m and 6 s, from the first seconds of it."""
    for kind in ("symplectic", "implicit"):
        text = case_of(SMALL, sinkers=84, top=-1.5)
        one = measured(kind, text, case_of((24, 5, 4), sinkers=24, top=-1.5))
        minute = 60.0 / SHARE
        yield (
            f"cage of {one['knots']:,} knots, 60 s of waves, {kind}, by its first {SHARE:g} s",
            f"{minute * one['wall']:.0f} s, {minute * one['cpu']:.0f} s of processor, {one['iterations']} steps",
            "< 60 s",
        )


if __name__ == "__main__":
    for rows in (waves(), statics()):
        for row in rows:
            print(*row, sep=" | ", flush=True)
