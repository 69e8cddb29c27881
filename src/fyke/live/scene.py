"""The net of the live page in space: its parts from the common register, and the grip on one knot."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, cast

import numpy as np
import viser
from numpy.typing import ArrayLike, NDArray

from ..report.carried import carried
from ..report.colours import GREY, PALETTE, linear
from ..report.ground import SAND, bed_under
from ..report.parts import Bars, Knots, Outline, coloured_bars, parts_of
from ..report.quantities import BarQuantity, quantities
from ..report.space import AZIMUTH, ELEVATION
from ..report.style import rgb
from .study import Study

Array = NDArray[np.float64]

# Pixels of a bar and of a frame; a knot over a bar; distance of the eye over the diagonal of the net, the grip over it.
BAR, FRAME, KNOT, EYE, GRIP = 4.0, 3.0, 0.12, 1.25, 0.12


LEAST_TUBE = 0.004  # diameter over the diagonal of the net, below which a tube is drawn as wide as a rope
Units = Literal["screen", "world"]


def _bytes(colours: ArrayLike) -> NDArray[np.uint8]:
    """Turn colours (..., 3) of sRGB, 0 to 1, into the linear bytes that browsers render."""
    return np.rint(255.0 * linear(colours)).astype(np.uint8)


COLOURS, SLACK = _bytes(PALETTE), _bytes(GREY)


class Scene:
    """What one browser sees of a study."""

    def __init__(self, client: viser.ClientHandle, study: Study) -> None:
        self.client, self.study = client, study
        self.top = 1.0
        self.gripped: int | None = None
        self._grip: viser.TransformControlsHandle | None = None
        self._drag: Callable[[int, Array], None] = lambda knot, place: None
        self._choice = 0
        self._lines: dict[str, viser.LineSegmentsHandle] = {}
        self._points: dict[str, viser.PointCloudHandle] = {}
        net = study.result.net
        low, high = net.positions.min(axis=0), net.positions.max(axis=0)
        self._size = float(np.linalg.norm(high - low)) or 1.0
        self._look_at((low + high) / 2.0)
        self._ground(low, high)
        self.draw()

    def _ground(self, low: Array, high: Array) -> None:
        """Show the sea bed under a net between two corners (3,) m, where there is one that it comes down to."""
        level = bed_under(self.study.result)
        if level is None:
            return
        x, y = ((low + high) / 2.0)[:2].tolist()
        sand = tuple(_bytes(rgb(SAND)).tolist())
        self.client.scene.add_grid(
            "/sea bed",
            2.0 * self._size,
            2.0 * self._size,
            cell_size=self._size / 20.0,
            section_size=self._size / 4.0,
            plane_color=sand,
            plane_opacity=1.0,
            fade_distance=10.0 * self._size,
            position=(x, y, level),
        )

    def _look_at(self, middle: Array) -> None:
        azimuth, elevation = np.deg2rad([AZIMUTH, ELEVATION])
        towards = np.array(
            [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
        )
        self.client.scene.set_up_direction("+z")
        camera = self.client.camera
        camera.up_direction = (0.0, 0.0, 1.0)
        away = EYE * self._size
        if camera.aspect < 1.0:
            # On a telephone the sliders cover the lower half: further off, and looking under the net.
            away, middle = away / camera.aspect, middle - [0.0, 0.0, 0.5 * self._size / camera.aspect]
        camera.position = tuple(middle + away * towards)
        camera.look_at = tuple(middle)
        camera.near = 0.01 * self._size

    @property
    def _offered(self) -> tuple[BarQuantity, ...]:
        return quantities(self.study.result)

    @property
    def choices(self) -> list[str]:
        """What bars can be coloured by, with units."""
        return [f"{q.name} ({q.unit})" for q in self._offered]

    def choose(self, name: str) -> None:
        """Colour by another quantity."""
        self._choice = self.choices.index(name) if name in self.choices else 0

    @property
    def quantity(self) -> BarQuantity:
        """What bars are coloured by."""
        return self._offered[min(self._choice, len(self._offered) - 1)]

    def renew(self) -> None:
        """Take away what stands where the net was, after a change of the net itself."""
        for handle in (*self._lines.values(), *self._points.values()):
            handle.remove()
        self._lines, self._points = {}, {}

    def draw(self) -> None:
        """Send the present shape."""
        result = self.study.result
        position = result.position[-1].astype(np.float32)
        values = self.quantity.values(result, 0)
        self.top = float(values[coloured_bars(result.net)].max(initial=0.0)) or 1.0
        slack = result.tension[-1] <= 0.0
        colours = COLOURS[np.clip(255.0 * values / self.top, 0.0, 255.0).astype(np.int64)]
        colours[slack] = SLACK
        with self.client.atomic():
            for number, part in enumerate(parts_of(carried(result).net)):
                name = f"{number} {part.name}"
                if isinstance(part, Outline):
                    points = part.points.astype(np.float32)
                    self._line(name, np.stack([points[:-1], points[1:]], axis=1), part.colour, FRAME)
                elif isinstance(part, Bars):
                    own = colours[part.bars] if part.colour is None else part.colour
                    ends = position[result.net.bars[part.bars]]
                    tube = part.diameter if part.diameter > LEAST_TUBE * self._size else None
                    self._line(name, ends, own, BAR * part.width, tube)
                else:
                    self._mark(name, part, position)

    def _line(
        self,
        name: str,
        points: NDArray[np.float32],
        colour: NDArray[np.uint8] | str,
        width: float,
        diameter: float | None = None,
    ) -> None:
        """Draw lines (k, 2, 3) m, so many pixels wide or, where a diameter (m) is given, as thick as that."""
        colours = np.empty((len(points), 2, 3), dtype=np.uint8)
        colours[:] = _bytes(rgb(colour)) if isinstance(colour, str) else colour[:, None]
        handle = self._lines.get(name)
        if handle is None:
            thickness, units = (width, "screen") if diameter is None else (diameter, "world")
            self._lines[name] = self.client.scene.add_line_segments(
                f"/{name}", points, colours, thickness=thickness, thickness_units=cast(Units, units)
            )
        else:
            handle.points, handle.colors = points, colours

    def _mark(self, name: str, part: Knots, position: NDArray[np.float32]) -> None:
        points, handle = position[part.knots], self._points.get(name)
        if handle is not None and len(handle.points) == len(points):
            handle.points = points
            return
        if handle is not None:
            handle.remove()
        colour = tuple(_bytes(rgb(part.colour)).tolist())
        size = max(KNOT * part.size * float(np.median(self.study.result.net.rest_length)), part.diameter)
        shape: Literal["circle", "diamond"] = "diamond" if part.marker == "diamond" else "circle"
        self._points[name] = self.client.scene.add_point_cloud(
            f"/{name}", points, colour, point_size=size, point_shape=shape, precision="float32"
        )

    def on_pick(self, picked: Callable[[int | None], None]) -> None:
        """Call with the knot under a click, None beside the net."""

        @self.client.scene.on_click()
        def _(event: viser.SceneClickEvent) -> None:
            picked(self.study.nearest_knot(event.ray_origin, event.ray_direction))

    def on_drag(self, dragged: Callable[[int, Array], None]) -> None:
        """Call with the gripped knot and where it is drawn to, (3,) m."""
        self._drag = dragged

    def grip(self, knot: int | None) -> None:
        """Put arrows on a knot, by which it is dragged; None takes them away."""
        if self._grip is not None:
            self._grip.remove()
            self._grip = None
        self.gripped = knot
        if knot is None:
            return
        grip = self.client.scene.add_transform_controls(
            "/grip",
            scale=GRIP * self._size,
            disable_rotations=True,
            position=tuple(self.study.result.position[-1][knot]),
        )
        grip.on_update(lambda _: self._drag(knot, np.array(grip.position)))
        self._grip = grip
