"""Speed of exports and films, beside the bare write of as many bytes on the same disk; of the report and the live page.

Run with `make bench-see`. Times are the best of several repeats on a machine that may be doing other things: read the
ratios to the bare write, not the megabytes a second.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

import fyke
from fyke.forces.evaluate import evaluate
from fyke.report.gltf import write_gltf
from fyke.results.export import write_csv, write_vtkhdf, write_vtu

EXAMPLE = Path(__file__).parent.parent / "examples" / "panel.toml"
MESHES, FRAMES, REPEATS, TURNS = 100, 25, 5, 100
GOAL = 100.0  # MB/s of VTKHDF and VTU


def shaken(meshes: int, frames: int) -> fyke.Result:
    """A framed panel of so many meshes each way, its knots shaken in every frame."""
    twine = fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9))
    side = 0.9 * meshes * 0.03 * np.sqrt(2.0)
    net = fyke.panel(twine, mesh="diamond", meshes=(meshes, meshes), bar_length=0.03, size=(side, side))
    system = fyke.make_system(net, current=(0.5, 0.0, 0.0))
    random = np.random.default_rng(1)
    rest = system.at_rest()
    told = []
    for k in range(frames):
        off = 1e-3 * random.normal(size=net.positions.shape)
        told.append(evaluate(system, replace(rest, time=0.02 * k, position=net.positions + off)))
    outcome = fyke.Outcome("completed", "", "", "", "", frames, 0, 0.0, 0.0)
    return fyke.Result.from_frames(net, outcome, 0.0, told)


def size_of(path: Path) -> int:
    """Bytes of a file or of all files of a folder."""
    return sum(one.stat().st_size for one in (path.iterdir() if path.is_dir() else (path,)))


def best(work: Callable[[], object]) -> float:
    """Shortest wall time (s) of several calls, after one to warm up."""
    work()
    times = []
    for _ in range(REPEATS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return min(times)


def bare(path: Path, size: int) -> float:
    """Seconds that the disk takes for so many bytes."""
    data = np.zeros(size, dtype=np.uint8).data
    return best(lambda: path.write_bytes(data))


def main() -> None:
    """Print the table."""
    result = shaken(MESHES, FRAMES)
    print(f"{result.net.knot_count} knots, {result.net.bar_count} bars, {FRAMES} frames\n")
    print("| what | MB | MB/s | times a bare write |\n|---|---|---|---|")
    writers = {
        "vtkhdf": write_vtkhdf,
        "vtu series": write_vtu,
        "csv": write_csv,
        "gltf, last frame": write_gltf,
    }
    with tempfile.TemporaryDirectory() as name:
        for what, write in writers.items():
            path = Path(name) / what.split(",")[0].replace(" ", "_")
            took = best(lambda write=write, path=path: write(result, path))
            size = size_of(path)
            ratio = took / bare(Path(name) / "bare", size)
            goal = "" if what[:2] != "vt" else f" (goal {GOAL:g})"
            print(f"| {what} | {size / 1e6:.1f} | {size / took / 1e6:.0f}{goal} | {ratio:.1f} |")
    film()
    report()
    live_page()


def report() -> None:
    """Print what a report of 5 000 knots and 100 frames takes."""
    from fyke.report.page import Origin, write_report
    from fyke.results.derive import summary

    result = shaken(50, 100)
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "report.html"
        began = time.perf_counter()
        write_report(result, file, figures=summary(result), origin=Origin(Path("result.nc")))
        took = time.perf_counter() - began
        print(f"\nreport of {result.net.knot_count} knots, 100 frames: {took:.1f} s (goal 10), ", end="")
        print(f"{file.stat().st_size / 1e6:.1f} MB (goal 8)")


def live_page() -> None:
    """Print how many times a second the live page follows a slider, from its event to its last message sent."""
    from playwright.sync_api import sync_playwright

    from fyke.live import serve

    path = shutil.which("chromium")
    if path is None:
        print("\nlive page: not measured, no chromium")
        return
    for meshes, goal in ((8, 30), (32, 10)):
        side = 0.9 * meshes * 0.03 * np.sqrt(2.0)
        text = EXAMPLE.read_text(encoding="utf-8").replace("[8, 8]", f"[{meshes}, {meshes}]")
        text = text.replace("[0.3055, 0.3055]", f"[{side}, {side}]")
        began = time.perf_counter()
        live = serve(text, EXAMPLE, port=18100)
        up = time.perf_counter() - began
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
            # A window too small to draw in, so that the browser's own work does not count.
            page = browser.new_page(viewport={"width": 60, "height": 60})
            page.goto(live.url)
            page.wait_for_timeout(3000)
            mine = next(iter(live.pages.values()))
            began = time.perf_counter()
            for k in range(TURNS):
                before = mine.updates
                mine.move("current.speed", 0.3 + 0.01 * k)
                while mine.updates == before:
                    time.sleep(2e-4)
            rate = TURNS / (time.perf_counter() - began)
            browser.close()
        live.stop()
        print(
            f"live page, {meshes} x {meshes} meshes: {rate:.0f} updates a second (goal {goal}), up in {up:.1f} s"
        )


def film() -> None:
    """Print how fast pictures of a film come."""
    from fyke.report.movie import MovieError, Reel, Stage

    for meshes in (8, MESHES):
        try:
            stage = Stage(shaken(meshes, 2), Reel(), None)
        except MovieError as error:
            print(f"\nno film: {error}")
            return
        took = best(lambda stage=stage: stage.picture(0.01))
        print(f"\nfilm of {meshes} x {meshes} meshes, 1280 x 720: {1.0 / took:.1f} pictures a second")
        stage.close()


if __name__ == "__main__":
    main()
