"""Films of a run: the net in space against time, drawn off the screen by VTK, in real time or slower.

VTK draws the net, matplotlib what stands over it: the scale in metres, which parallel projection makes true all over
the picture, the colours with their unit, and the time.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, fields, replace
from functools import cache
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..forces.frame import Frame
from ..results.whole import replacing
from ..solve.result import Result
from . import style
from .carried import parts_in_time
from .colours import Colouring
from .parts import Bars, Knots, Outline
from .space import box, view_of
from .ticks import number

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
Progress = Callable[[float], None]

KINDS = (".mp4", ".gif")
# Draws nothing, off the screen. VTK crashes where it finds neither a display nor EGL nor OSMesa.
PROBE = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.Render()
"""
# Shares of the width and the height that the net may fill; the colours stand at the right.
NET_WIDE, NET_TALL, NET_MIDDLE = 0.76, 0.84, 0.43
DOTS = 100  # per inch of what stands over the net; type is of TYPE points at TYPE_HEIGHT pixels of height
TYPE, TYPE_HEIGHT = 11.0, 720.0
THINNEST, THICKEST, KNOT = 1.4, 8.0, 5.0  # pixels of bars and of marked knots, at TYPE_HEIGHT
SCALE_SHARE = 0.22  # of the width that the scale may take at most
NEAR_FAR = 20.0  # distance of the eye in diagonals of the net; of no effect on the picture


class MovieError(Exception):
    """A film cannot be made; the message is one sentence that says why and what helps."""


@dataclass(frozen=True)
class Reel:
    """How a film is to be: pictures a second, speed (1 in real time), width and height in pixels, colours."""

    fps: float = 25.0
    speed: float = 1.0
    size: tuple[int, int] = (1280, 720)
    colour: str = "tension"

    def moments(self, result: Result) -> Array:
        """Return the simulated time (s) of every picture, at least two; MovieError for a run without duration."""
        first, last = float(result.time[0]), float(result.time[-1])
        if len(result.time) < 2 or last <= first:
            raise MovieError(
                "this result has one frame and nothing in it moves; see it with: fyke report RESULT"
            )
        count = int(np.floor((last - first) / self.speed * self.fps * (1.0 + 1e-9))) + 1
        return np.asarray(np.minimum(first + np.arange(max(count, 2)) * self.speed / self.fps, last))


def write_movie(
    result: Result,
    path: str | Path,
    reel: Reel | None = None,
    *,
    on_progress: Progress = lambda share: None,
) -> Path:
    """Make a film of a run, .mp4 or .gif, which appears whole or not at all, and return its path.

    Between two outputs positions and forces go straight from one to the other. MovieError for a result of one frame,
    another ending and packages that are missing; QuantityError for a colour without values; OSError where the film
    cannot be written.
    """
    path, reel = Path(path), reel or Reel()
    if path.suffix.lower() not in KINDS:
        raise MovieError(f"a film is one of {', '.join(KINDS)}, not {path.suffix or 'a name without ending'}")
    if path.suffix.lower() == ".mp4" and any(side % 2 for side in reel.size):
        raise MovieError("width and height of an mp4 film are even numbers")
    moments = reel.moments(result)
    stage = Stage(result, reel)
    with replacing(path) as part, closing(stage), _with_ending(part, path.suffix.lower()) as reeling:
        with _writer(reeling, reel.fps) as film:
            for index, moment in enumerate(moments.tolist()):
                film.append_data(stage.picture(moment))
                on_progress((index + 1) / len(moments))
        _check_whole(reeling, len(moments))
    return path


def at_time(result: Result, time: float) -> Result:
    """Return a result of the one frame at a time (s) between two outputs, every variable blended linearly."""
    after = int(np.clip(np.searchsorted(result.time, time), 1, len(result.time) - 1))
    before = after - 1
    share = (time - result.time[before]) / (result.time[after] - result.time[before])
    told = {f.name: getattr(result, f.name) for f in fields(Frame)}
    blend = {name: ((1.0 - share) * v[before] + share * v[after])[None] for name, v in told.items()}
    return replace(result, **blend)


def _needed(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise MovieError(f"a film needs the package {package}: pip install 'fyke[movie]'") from None


@cache
def _check_drawing() -> None:
    """Raise MovieError where VTK cannot draw here, found out in a process that may crash."""
    try:
        done = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, check=False, timeout=60)
        works = done.returncode == 0
    except subprocess.TimeoutExpired:
        works = False
    if not works:
        raise MovieError(
            "VTK can draw nothing here: it finds neither a display nor EGL nor OSMesa; on Debian: apt install libegl1"
        )


@contextmanager
def _with_ending(part: Path, ending: str) -> Iterator[Path]:
    """Hand out a working name with the ending that the writers of films go by; rename it to `part` at the end."""
    reeling = part.with_name(part.name + ending)
    try:
        yield reeling
        reeling.replace(part)
    finally:
        reeling.unlink(missing_ok=True)


def _writer(file: Path, fps: float) -> Any:
    imageio = _needed("imageio.v2")
    if file.suffix == ".gif":
        return imageio.get_writer(file, mode="I", duration=1000.0 / fps, loop=0)
    _needed("imageio_ffmpeg")
    how = {"codec": "libx264", "quality": 8, "macro_block_size": 2, "ffmpeg_log_level": "error"}
    return imageio.get_writer(file, mode="I", fps=fps, output_params=["-movflags", "+faststart"], **how)


def _check_whole(file: Path, count: int) -> None:
    """Count the pictures: ffmpeg does not say when the disk was full."""
    if file.suffix == ".gif":
        return
    try:
        there = _needed("imageio_ffmpeg").count_frames_and_secs(str(file))[0]
    except RuntimeError:
        there = 0
    if there != count:
        raise OSError(f"only {there} of {count} pictures could be written; the disk may be full")


class Stage:
    """The net in front of a camera that sees all of the run."""

    def __init__(self, result: Result, reel: Reel) -> None:
        self._result, self._reel = result, reel
        self._colouring = Colouring.of(result, reel.colour)
        self._pv = _needed("pyvista")
        _check_drawing()
        # VTK warns of a screen that it does not find, and then does without.
        logger = _needed("vtkmodules.vtkCommonCore").vtkLogger
        logger.SetStderrVerbosity(logger.VERBOSITY_ERROR)
        points = [part.points for part in parts_in_time(result) if isinstance(part, Outline)]
        corners = box(result.position.reshape(-1, 3), *points)
        self._view = view_of(corners)
        self._plotter = self._pv.Plotter(off_screen=True, window_size=list(reel.size))
        self._plotter.set_background("white")
        self.metres = self._aim(corners)
        self._moving: list[Any] = []
        self._coloured: list[tuple[Any, Bars]] = []
        for part in parts_in_time(result):
            self._add(part)
        self._over = self._overlay()

    def close(self) -> None:
        """Give back what VTK holds."""
        self._plotter.close()

    def picture(self, time: float) -> Picture:
        """Draw the net at a time (s), (height, width, 3) of 0 to 255."""
        moment = at_time(self._result, time)
        for mesh in self._moving:
            mesh.points = moment.position[0]
        colours = np.rint(255.0 * self._colouring.colours(moment, 0)).astype(np.uint8)
        for mesh, part in self._coloured:
            mesh.cell_data["colour"] = colours[part.bars]
        self._plotter.render()
        seen = np.array(self._plotter.screenshot(return_img=True)[..., :3])
        _lay_over(seen, self._over)
        stamp = self._stamp(time)
        rows, columns = stamp.shape[:2]
        _lay_over(seen[:rows, :columns], stamp)
        return seen

    def _aim(self, corners: Array) -> float:
        """Let the camera see a box (2, 3) m beside the colours; return metres to a pixel."""
        wide, tall = self._reel.size
        axes = self._view.axes
        half = 0.5 * np.abs(axes[:2] @ np.diag(np.ptp(corners, axis=0))).sum(axis=1)
        metres = 2.0 * float(max(half[0] / (NET_WIDE * wide), half[1] / (NET_TALL * tall)))
        diagonal = float(np.linalg.norm(np.ptp(corners, axis=0)))
        aim = self._view.middle + (0.5 - NET_MIDDLE) * wide * metres * axes[0]
        camera = self._plotter.camera
        camera.parallel_projection = True
        camera.focal_point = aim
        camera.position = aim + NEAR_FAR * diagonal * axes[2]
        camera.up = axes[1]
        camera.parallel_scale = 0.5 * tall * metres
        camera.clipping_range = ((NEAR_FAR - 1.0) * diagonal, (NEAR_FAR + 1.0) * diagonal)
        self._plotter.camera_set = True
        return metres

    def _add(self, part: Bars | Knots | Outline) -> None:
        net, scale = self._result.net, self._reel.size[1] / TYPE_HEIGHT
        if isinstance(part, Outline):
            ends = np.array(list(pairwise(range(len(part.points)))))
            mesh = self._pv.PolyData(np.array(part.points), lines=_lines(ends))
            self._plotter.add_mesh(mesh, color=part.colour, line_width=part.width * scale, lighting=False)
            return
        if isinstance(part, Knots):
            mesh = self._pv.PolyData(np.array(net.positions), verts=_vertices(part.knots))
            round_ = part.marker == "circle" or part.diameter > 0.0
            size = max(KNOT * part.size * scale, part.diameter / self.metres)
            self._plotter.add_mesh(
                mesh, color=part.colour, point_size=size, render_points_as_spheres=round_, lighting=False
            )
        else:
            mesh = self._pv.PolyData(np.array(net.positions), lines=_lines(net.bars[part.bars]))
            thick = float(np.max(net.bar_diameter[part.bars])) / self.metres
            width = part.width * float(np.clip(thick, THINNEST * scale, THICKEST * scale))
            width = max(width, part.diameter / self.metres)
            options: dict[str, Any] = {"line_width": width, "lighting": False}
            if part.diameter:
                # Thick lines leave gaps where they turn.
                mesh.verts = _vertices(np.unique(net.bars[part.bars]))
                options |= {"point_size": width, "render_points_as_spheres": True}
            if part.colour is None:
                mesh.cell_data["colour"] = np.zeros((len(part.bars), 3), dtype=np.uint8)
                self._plotter.add_mesh(mesh, scalars="colour", rgb=True, **options)
                self._coloured.append((mesh, part))
            else:
                self._plotter.add_mesh(mesh, color=part.colour, **options)
        self._moving.append(mesh)

    @style.styled
    def _overlay(self) -> Picture:
        """Draw what stands over every picture: the scale and the colours, (height, width, 4)."""
        wide, tall = self._reel.size
        kind = TYPE * tall / TYPE_HEIGHT * 72.0 / DOTS
        figure = Figure(figsize=(wide / DOTS, tall / DOTS), dpi=DOTS, facecolor="none")
        length = _round_below(SCALE_SHARE * wide * self.metres)
        share = length / self.metres / wide
        factor, unit = style.prefixed(length, "m")
        ax = figure.add_axes((0.03, 0.05, share, 0.012))
        ax.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
        ax.set_axis_off()
        ax.plot([0, 0, 1, 1], [1, 0, 0, 1], color=style.BLACK, linewidth=0.12 * kind, clip_on=False)
        ax.text(0.5, 1.4, f"{number(length * factor)} {unit}", ha="center", va="bottom", fontsize=kind)
        self._colour_bar(figure, kind)
        return _drawn(figure)

    def _colour_bar(self, figure: Figure, kind: float) -> None:
        quantity, largest = self._colouring.quantity, self._colouring.largest
        prefixable = quantity.unit == "N"
        factor, unit = style.prefixed(largest, "N") if prefixable else (1.0, quantity.unit)
        ax = figure.add_axes((0.89, 0.2, 0.013, 0.6))
        mappable = ScalarMappable(Normalize(0.0, largest * factor), style.TENSION_COLOURS)
        bar = figure.colorbar(mappable, cax=ax)
        bar.set_label(f"{quantity.name} ({unit})", fontsize=kind)
        ax.tick_params(labelsize=kind)
        figure.text(0.89, 0.135, "slack", color=style.SLACK_GREY, fontsize=kind, va="center")

    @style.styled
    def _stamp(self, time: float) -> Picture:
        """Draw the time, for the upper left corner, (h, w, 4)."""
        wide, tall = self._reel.size
        kind = TYPE * tall / TYPE_HEIGHT * 72.0 / DOTS
        corner = round(0.35 * wide), round(0.09 * tall)
        figure = Figure(figsize=(corner[0] / DOTS, corner[1] / DOTS), dpi=DOTS, facecolor="none")
        step = self._reel.speed / self._reel.fps
        digits = max(0, int(np.ceil(-np.log10(step) - 1e-9)))
        slow = "" if self._reel.speed == 1.0 else f"   ({number(self._reel.speed)} × real time)"
        x = 0.03 * wide / corner[0]
        figure.text(x, 0.5, f"t = {time:.{digits}f} s{slow}", fontsize=1.2 * kind, va="center")
        return _drawn(figure)


def _lines(ends: NDArray[np.int64]) -> NDArray[np.int64]:
    """Lines between two points each (m, 2), as VTK packs them."""
    return np.column_stack([np.full(len(ends), 2), ends]).ravel()


def _vertices(points: NDArray[np.int64]) -> NDArray[np.int64]:
    """Points (k,) to be shown, as VTK packs them."""
    return np.column_stack([np.ones(len(points), dtype=np.int64), points]).ravel()


def _round_below(length: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not above a length."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length * (1.0 + 1e-9)))


def _drawn(figure: Figure) -> Picture:
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())


def _lay_over(seen: Picture, over: Picture) -> None:
    """Lay a picture with an alpha channel (h, w, 4) over another (h, w, 3), where it is not clear."""
    there = over[..., 3] > 0
    alpha = over[there, 3:] / 255.0
    # Agg hands colours out that are not multiplied by alpha.
    seen[there] = np.rint(alpha * over[there, :3] + (1.0 - alpha) * seen[there])
