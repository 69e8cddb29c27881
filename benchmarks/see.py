"""Speed of exports and films, beside the bare write of as many bytes on the same disk.

Run with `make bench-see`. Times are the best of several repeats on a machine that may be doing other things: read the
ratios to the bare write, not the megabytes a second.
"""

from __future__ import annotations

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

MESHES, FRAMES, REPEATS = 100, 25, 5
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
