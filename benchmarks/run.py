"""Speed and memory of the framed panel, as ratios within one run: prints a table and writes RESULTS.md.

Run with `make bench`. Times are the best of several repeats on a machine that may be doing other things: read the
ratios, not the seconds.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from c_floor import floor_seconds
from timing import Row, best, force_per_bar, leap_seconds, machine, panel_system, table_of
from water import water

import fyke
from fyke.solve.auto import Work
from fyke.solve.linear import Pattern, factorizer

HERE = Path(__file__).parent
EXAMPLE = HERE.parent / "examples" / "panel.toml"


class TimedFactorizer:
    """The linear solver of the package, with the bare time of its factorizations added up."""

    def __init__(self, pattern: Pattern) -> None:
        self._solver, self.seconds = factorizer(pattern), 0.0
        self.name = self._solver.name

    def renew(self) -> None:
        """Pass on."""
        self._solver.renew()

    def factor(self, data):
        """Factorize and keep the time."""
        began = time.perf_counter()
        solve = self._solver.factor(data)
        self.seconds += time.perf_counter() - began
        return solve


def statics() -> list[Row]:
    """Factorizations, and the whole solve over its factorizations."""
    rows = []
    counts = [fyke.solve_static(panel_system(8, speed)).outcome for speed in (0.1, 0.5, 1.0, 2.0, 4.0)]
    assert all(o.ok and o.residual <= 1e-8 for o in counts)
    found = ", ".join(str(o.factorizations) for o in counts)
    rows.append(("static 8x8 at 0.1, 0.5, 1, 2, 4 m/s: factorizations", found, "<= 15"))
    system = panel_system(8)
    ratios, walls = [], []
    for _ in range(15):
        timed = TimedFactorizer(Pattern.of(system.elements))
        outcome = fyke.solve_static(system, linear=timed).outcome
        ratios.append(outcome.wall_time / timed.seconds)
        walls.append(outcome.wall_time)
    rows.append(("static 8x8: whole solve / its factorizations", f"{min(ratios):.2f}", "<= 4"))
    rows.append(("static 8x8: whole solve", f"{1e3 * min(walls):.1f} ms", "a few ms"))
    return rows


LARGE = """
import resource, sys
sys.path.insert(0, {here!r})
from timing import panel_system
import fyke
system = panel_system(100)
outcome = fyke.solve_static(system).outcome
assert outcome.ok
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(outcome.factorizations, outcome.wall_time, peak, 3 * int(system.elements.free.sum()))
"""


def large_static() -> list[Row]:
    """100 x 100 in a process of its own, for its peak memory."""
    out = subprocess.run(
        [sys.executable, "-c", LARGE.format(here=str(HERE))], check=True, capture_output=True, text=True
    ).stdout.split()
    return [
        (f"static 100x100, {out[3]} unknowns: factorizations", out[0], "<= 30"),
        ("static 100x100: whole solve", f"{float(out[1]):.2f} s", ""),
        ("static 100x100: peak memory of the process", f"{float(out[2]):.0f} MB", "< 1000 MB"),
    ]


def threads() -> list[Row]:
    """Leapfrog on two threads against one: whole steps, force evaluation included."""
    if len(os.sched_getaffinity(0)) < 2:
        return [("leapfrog 400x400: one thread / two", "not measured: one core", ">= 1.6")]
    rows = []
    for meshes, steps, goal in ((100, 200, ""), (400, 20, ">= 1.6")):
        system = panel_system(meshes)
        one, two = (leap_seconds(system, system.at_rest(), count, steps) for count in (1, 2))
        name = f"leapfrog {meshes}x{meshes}"
        rows.append((f"{name}: steps per second, one thread", f"{1 / one:,.0f}", ""))
        rows.append((f"{name}: one thread / two", f"{one / two:.2f}", goal))
    return rows


def explicit() -> list[Row]:
    """Force evaluation and the leapfrog step over it."""
    rows = []
    for meshes, goal in ((8, "<= 15 ns"), (100, "<= 15 ns"), (400, "<= 20 ns")):
        seconds = force_per_bar(panel_system(meshes))
        rows.append(
            (f"force evaluation {meshes}x{meshes}, one core, per bar", f"{1e9 * seconds:.1f} ns", goal)
        )
        if meshes == 8:
            bare = seconds * panel_system(8).net.bar_count
    system = panel_system(8)
    start = fyke.simulate(system, duration=0.3, stepper=fyke.Symplectic(), every=0.3).frame()
    seconds = leap_seconds(system, fyke.State(0.0, start.position, start.velocity), 1, 2000)
    rows.append(("leapfrog step 8x8 / bare force evaluation", f"{seconds / bare:.2f}", "<= 1.5"))
    rows.append(("leapfrog 8x8: steps per second", f"{1 / seconds:,.0f}", ""))
    short = 0.3 * fyke.Symplectic().start(system, system.at_rest()).step
    floor = floor_seconds(system, fyke.State(0.0, start.position, start.velocity), short)
    found = "not measured: no C compiler" if floor is None else f"{seconds / floor:.2f}"
    rows.append(("leapfrog step 8x8 / step of a hand-written C loop", found, "<= 1.3"))
    return rows


def steppers() -> list[Row]:
    """Two seconds of the released 8x8 panel by every stepper; how far each is from Verner through the snap."""
    system = panel_system(8)
    walls: dict[str, float] = {}
    for stepper, repeats in ((fyke.Implicit(), 5), (fyke.Symplectic(), 3), (fyke.Verner(), 1)):
        runs = [
            fyke.simulate(system, duration=2.0, stepper=stepper, every=2.0).outcome for _ in range(repeats)
        ]
        assert all(run.ok for run in runs)
        walls[stepper.name] = min(run.wall_time for run in runs)
    twine = replace(system.net.twines[0], damping_time=2e-5)
    damped = fyke.make_system(replace(system.net, twines=(twine,)), current=(0.5, 0.0, 0.0))
    exact = fyke.simulate(
        damped, duration=0.3, every=0.05, stepper=fyke.Verner(rtol=1e-5, atol=1e-8)
    ).position
    rows = []
    for stepper in (fyke.Implicit(), fyke.Symplectic()):
        found = fyke.simulate(damped, duration=0.3, every=0.05, stepper=stepper).position
        rms = np.sqrt(((found - exact) ** 2).mean(axis=(1, 2))).max()
        rows.append(
            (f"dynamic 8x8 through the snap, {stepper.name}: RMS against Verner", f"{1e3 * rms:.2f} mm", "")
        )
    implicit = walls["implicit"]
    return [
        ("dynamic 8x8, 2 s from release, implicit: wall time", f"{1e3 * implicit:.0f} ms", ""),
        ("dynamic 8x8, 2 s: implicit / leapfrog", f"{implicit / walls['symplectic']:.2f}", "<= 0.5"),
        ("dynamic 8x8, 2 s: Verner / implicit", f"{walls['verner'] / implicit:.0f}", ">= 40"),
        *rows,
    ]


def choice() -> list[Row]:
    """The stepper that chooses against both, and what it takes their work for against what that took."""
    rows = []
    for meshes in (8, 32):
        system, walls = panel_system(meshes), {}
        for stepper in (fyke.Implicit(), fyke.Symplectic(), fyke.Auto()):
            repeats = 3 if meshes == 8 else 1
            runs = [
                fyke.simulate(system, duration=2.0, stepper=stepper, every=2.0).outcome
                for _ in range(repeats)
            ]
            walls[stepper.name] = min(run.wall_time for run in runs)
            if stepper.name == "implicit":
                newtons = runs[0].force_evaluations
            if stepper.name == "symplectic":
                steps = runs[0].iterations
        better = min(walls["implicit"], walls["symplectic"])
        rows.append(
            (
                f"dynamic {meshes}x{meshes}, 2 s: auto / the faster of implicit and leapfrog",
                f"{walls['auto'] / better:.2f}",
                "<= 1.5",
            )
        )
        work = Work.on(system)
        ratio = walls["implicit"] / newtons / (walls["symplectic"] / steps)
        counted = (work.newton + work.factor) / work.leap
        rows.append(
            (
                f"dynamic {meshes}x{meshes}: Newton iteration / leapfrog step, and as auto counts it",
                f"{ratio:.0f}, {counted:.0f}",
                "",
            )
        )
    return rows


def large_motion() -> list[Row]:
    """Two seconds of the released 100x100 panel, leapfrog and implicit, and how long the last second of them takes."""
    system = panel_system(100)
    names = {"symplectic": fyke.Symplectic(), "implicit": fyke.Implicit(rtol=0.1)}
    walls, lasts, runs = {}, {}, {}
    for name, stepper in names.items():
        halfway: list[float] = []

        def note(done: float, _: str, halfway: list[float] = halfway) -> None:
            if done >= 0.5 and not halfway:
                halfway.append(time.perf_counter())

        began = time.perf_counter()
        runs[name] = fyke.simulate(system, duration=2.0, every=0.05, stepper=stepper, on_progress=note)
        ended = time.perf_counter()
        assert runs[name].outcome.ok
        walls[name], lasts[name] = ended - began, ended - halfway[0]
    apart = runs["implicit"].position - runs["symplectic"].position
    rms = np.sqrt((apart**2).mean(axis=(1, 2))).max()
    what = "dynamic 100x100"
    return [
        (f"{what}, 2 s from release: leapfrog", f"{walls['symplectic']:.1f} s", ""),
        (
            f"{what}, 2 s: leapfrog / implicit, rtol 0.1",
            f"{walls['symplectic'] / walls['implicit']:.2f}",
            ">= 2",
        ),
        (
            f"{what}, its last second: leapfrog / implicit",
            f"{lasts['symplectic'] / lasts['implicit']:.1f}",
            ">= 10",
        ),
        (f"{what}: RMS between both at the worst time", f"{1e3 * rms:.2f} mm", "<= 1 mm"),
        (f"{what}: factorizations of implicit", str(runs["implicit"].outcome.factorizations), ""),
    ]


IMPORTS = """
import time
began = time.perf_counter()
import fyke
fyke.load_case, fyke.solve_static, fyke.simulate, fyke.save
import matplotlib.figure
print(time.perf_counter() - began)
"""


def command_line() -> list[Row]:
    """Whole commands: warm, importing, and the first run ever with an empty cache of compiled code."""
    with tempfile.TemporaryDirectory() as folder:

        def run(name: str, **environment: str) -> float:
            began = time.perf_counter()
            command = [
                sys.executable,
                "-m",
                "fyke",
                "run",
                str(EXAMPLE),
                "-o",
                f"{folder}/{name}",
                "--quiet",
                "--overwrite",
            ]
            subprocess.run(command, check=True, env=os.environ | environment, capture_output=True)
            return time.perf_counter() - began

        warm = best(lambda: run("warm"), 3)
        first = run("first", NUMBA_CACHE_DIR=f"{folder}/cache")
        importing = min(
            float(
                subprocess.run(
                    [sys.executable, "-c", IMPORTS], check=True, capture_output=True, text=True
                ).stdout
            )
            for _ in range(5)
        )
    return [
        ("fyke run examples/panel.toml, warm cache", f"{warm:.2f} s", "< 3 s"),
        ("of which importing everything, matplotlib included", f"{importing:.2f} s", "< 1 s"),
        ("the first run ever, compilation included", f"{first:.1f} s", "< 20 s"),
    ]


def main() -> None:
    """Measure, print and write."""
    rows: list[Row] = []
    for part in (
        statics,
        large_static,
        explicit,
        threads,
        steppers,
        large_motion,
        choice,
        water,
        command_line,
    ):
        rows += part()
        for row in rows[-1:]:
            print(f".. {part.__name__} done: {row[0]} = {row[1]}", flush=True)
    table = table_of(rows)
    print(table)
    text = f"# Benchmarks\n\nMade by `make bench` on {time.strftime('%Y-%m-%d')}: {machine()}.\n\n{table}\n"
    (HERE / "RESULTS.md").write_text(text)


if __name__ == "__main__":
    main()
