"""The figures: what they say, what they show, and that the files are sound."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from fyke.forces.frame import Frame
from fyke.netting.elastic import LinearLaw
from fyke.netting.faces import faces_of
from fyke.netting.line import line
from fyke.netting.net import Net
from fyke.netting.panel import panel
from fyke.netting.twine import Twine
from fyke.report.figures import (
    draw_all,
    equilibrium_shape,
    histories,
    initial_position,
    shape_comparison,
    tension_histogram,
    tension_plan,
    write_figure,
)
from fyke.report.space import box, view_of
from fyke.report.style import prefixed
from fyke.results.compare import Comparison, compare
from fyke.solve.outcome import Outcome
from fyke.solve.result import Result

SVG = "{http://www.w3.org/2000/svg}"
TWINE = Twine("main", 1140.0, 1.5e-3, LinearLaw(1e7))
OUTCOME = Outcome("converged", "", "", "by hand", "none", 1, 1, 0.0, 0.0)
WIDTH = 0.3055


def frame_of(net: Net, position: np.ndarray, time: float = 0.0, force=(0.0, 0.0, 0.0), energy=0.0) -> Frame:
    """A frame with the tension that the law gives at these positions."""
    start, end = position[net.bars[:, 0]], position[net.bars[:, 1]]
    strain = np.linalg.norm(end - start, axis=1) / net.rest_length - 1.0
    tension = np.maximum(1e7 * TWINE.area * strain, 0.0)
    rest, flow = np.zeros_like(position), np.zeros(net.bar_count)
    total = np.array(force)
    return Frame(
        time, position, rest, tension, flow, flow, np.zeros((len(flow), 3)), rest, total, total, energy, 0.0
    )


def result_of(net: Net, position: np.ndarray | None = None) -> Result:
    return Result.from_frames(
        net, OUTCOME, 0.0, [frame_of(net, net.positions if position is None else position)]
    )


def framed(meshes=(8, 8), size=(WIDTH, WIDTH), **options) -> Net:
    return panel(TWINE, mesh="diamond", meshes=meshes, bar_length=0.03, size=size, **options)


def bag(net: Net, sag: float) -> np.ndarray:
    """The panel's knots pushed along its normal, x = sag (1 - (2y/W)^2)(1 - (2z/H)^2)."""
    where = net.panels[0]
    depth = sag * np.prod(1.0 - (2.0 * where.flat / where.size) ** 2, axis=1)
    normal = faces_of(net).vector_area(net.positions).sum(axis=0)
    return net.positions + depth[:, None] * normal / np.linalg.norm(normal)


@pytest.fixture(scope="module")
def bagged() -> Result:
    """An 8 x 8 panel in which bars near the frame are taut and bars in the middle slack."""
    net = framed()
    result = result_of(net, bag(net, 0.1))
    assert 20 < np.count_nonzero(result.tension == 0.0) < 200
    return result


@pytest.fixture(scope="module")
def moving() -> Result:
    """A net whose middle knot goes 13 mm off in steps, under a force along (3, 4, 0) that grows."""
    net = framed()
    middle = int(np.argmin(np.linalg.norm(net.positions, axis=1)))
    frames = []
    for step in range(6):
        position = bag(net, 0.1)
        position[middle] = net.positions[middle] + np.array([3e-3, 4e-3, 12e-3]) * step / 5.0
        frames.append(frame_of(net, position, 0.1 * step, (0.3 * step, 0.4 * step, 7.0), 10.0**-step))
    return Result.from_frames(net, OUTCOME, 0.0, frames)


@pytest.fixture
def shifted(bagged: Result, tmp_path: Path) -> Comparison:
    """Three knots measured 5 mm from where they are computed."""
    rows = ["knot,x,y,z"]
    for label in ("8-8", "4-4", "8-4"):
        x, y, z = bagged.position[-1][bagged.net.labels.index(label)] + [0.0, 0.003, 0.004]
        rows.append(f"{label},{x:.17g},{y:.17g},{z:.17g}")
    (tmp_path / "measured.csv").write_text("\n".join(rows), encoding="utf-8")
    return compare(bagged, tmp_path / "measured.csv")


def texts(figure: Figure) -> list[str]:
    return [text.get_text() for text in written(figure)]


def written(figure: Figure) -> list[Text]:
    """All texts that are seen, after the figure was drawn."""
    FigureCanvasAgg(figure).draw()
    return [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip() and seen(figure, t)]


def seen(figure: Figure, text: Text) -> bool:
    """False for the numbers of axes that are switched off, and those that matplotlib keeps beyond the limits."""
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
            if text in [label for tick in ticks for label in (tick.label1, tick.label2)]:
                low, high = sorted(axis.get_view_interval())
                place = next(t.get_loc() for t in ticks if text in (t.label1, t.label2))
                slip = 1e-9 * (high - low)
                return ax.axison and low - slip <= place <= high + slip
            if text in (axis.label, axis.offsetText) and not ax.axison:
                return False
    return True


def drawn(figure: Figure, tmp_path: Path, group: str) -> list[ElementTree.Element]:
    """The paths of a group, read back from the written SVG."""
    svg = ElementTree.parse(write_figure(figure, tmp_path / "figure")[1])
    return [p for g in svg.iter(f"{SVG}g") if g.get("id") == group for p in g.iter(f"{SVG}path")]


def strokes(paths: list[ElementTree.Element]) -> list[str]:
    found = [re.search(r"stroke: (#\w+)", path.get("style", "")) for path in paths]
    return [match[1] for match in found if match]


def lightness(colour: str) -> float:
    """Relative luminance of a colour (ITU-R BT.709)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


@pytest.mark.parametrize(
    ("draw", "labels"),
    [
        (initial_position, ["x (m)", "y (m)", "z (m)", "free knot", "fixed knot"]),
        (equilibrium_shape, ["x (m)", "y (m)", "z (m)", "Bar tension (N)", "fixed knot"]),
        (tension_plan, ["Width (m)", "Height (m)", "Bar tension (N)", "fixed knot"]),
        (tension_histogram, ["Bar tension (N)", "Number of bars", "slack"]),
    ],
)
def test_axes_are_labelled_with_units(bagged, draw, labels):
    assert set(labels) <= set(texts(draw(bagged)))


def test_small_tensions_are_written_with_a_prefix(bagged):
    small = replace(bagged, tension=bagged.tension * (0.042 / bagged.tension.max()))
    found = texts(tension_plan(small))
    assert "Bar tension (mN)" in found
    assert {"0", "10", "20", "30", "40"} <= set(found)


@pytest.mark.parametrize(
    ("largest", "written_as"),
    [
        (0.0, "0 N"),
        (3.2e-5, "32 µN"),
        (0.0432, "43.2 mN"),
        (0.7, "0.7 N"),
        (512.0, "512 N"),
        (2.5e4, "25 kN"),
    ],
)
def test_prefixes(largest, written_as):
    factor, unit = prefixed(largest, "N")
    assert f"{largest * factor:.3g} {unit}" == written_as


@pytest.mark.parametrize("draw", [equilibrium_shape, tension_plan])
def test_every_bar_is_drawn_once_and_slack_ones_apart(bagged, draw, tmp_path):
    figure = draw(bagged)
    taut, slack = drawn(figure, tmp_path, "taut-bars"), drawn(figure, tmp_path, "slack-bars")
    without = int(np.sum(bagged.tension[-1] == 0.0))
    assert (len(taut), len(slack)) == (256 - without, without)
    assert all("stroke-dasharray" in path.get("style", "") for path in slack)
    assert not any("stroke-dasharray" in path.get("style", "") for path in taut)
    assert f"slack bar ({without} of 256)" in texts(figure)


def test_initial_position_draws_every_bar_and_the_current(bagged, tmp_path):
    assert len(drawn(initial_position(bagged), tmp_path, "bars")) == 256
    assert not any("current" in text for text in texts(initial_position(bagged)))
    assert "current, 0.5 m/s" in texts(initial_position(bagged, current=(0.3, 0.4, 0.0)))


def test_darker_colour_means_more_tension(bagged, tmp_path):
    tension = bagged.tension[-1][bagged.tension[-1] > 0.0]
    colours = strokes(drawn(tension_plan(bagged), tmp_path, "taut-bars"))
    in_order = [lightness(colours[bar]) for bar in np.argsort(tension)]
    assert in_order == sorted(in_order, reverse=True)
    assert len(set(colours)) > 10
    assert lightness(max(colours, key=lightness)) < 0.65  # no bar is lost on white paper


def test_colours_of_known_tensions(tmp_path):
    # viridis as published has 256 entries, from #440154 to #fde725; the largest tension takes the first, and the
    # scale begins at 0 N with the palest one used.
    net = line(TWINE, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], 1.0)
    result = replace(result_of(net), tension=np.array([[1e-9, 2.0, 4.0]]))
    first, middle, last = strokes(drawn(tension_plan(result), tmp_path, "taut-bars"))
    assert last == "#440154"
    table = [mpl.colors.to_hex(mpl.colormaps["viridis"](i)) for i in range(256)]
    assert table.index(middle) == pytest.approx(table.index(first) / 2, abs=1)


def test_the_shape_in_space_has_the_colours_of_the_plan(bagged, tmp_path):
    in_space = strokes(drawn(equilibrium_shape(bagged), tmp_path, "taut-bars"))
    in_plan = strokes(drawn(tension_plan(bagged), tmp_path, "taut-bars"))
    assert sorted(in_space) == sorted(in_plan)
    assert in_space != in_plan  # drawn from far to near, not in the order of the net


def test_the_view_keeps_one_scale_on_three_axes():
    # Of any orthonormal axes seen from afar, the squared lengths on paper add up to 2.
    corners = np.array([[-1.0, 2.0, -9.0], [3.0, 2.5, -4.0]])
    view = view_of(corners)
    tiny = 1e-6
    tips = view.middle + tiny * np.eye(3)
    on_paper = view.see(tips)[:, :2] / tiny
    assert np.sum(on_paper**2) == pytest.approx(2.0, abs=1e-4)
    assert view.see(view.middle[None])[0] == pytest.approx(np.zeros(3))
    # Up is up, downstream and y point to the right, and the eye is downstream.
    assert on_paper[2] == pytest.approx([0.0, np.cos(np.deg2rad(20.0))], abs=1e-4)
    assert on_paper[0, 0] > 0.5 < on_paper[1, 0]
    assert view.see(view.middle + np.array([[1.0, 0.0, 0.0]]))[0, 2] > 0.0


def test_near_things_look_larger():
    view = view_of(np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]))
    towards = view.axes[2]
    near, far = (
        np.ptp(view.see(view.middle + shift * towards + np.outer([-0.1, 0.1], view.axes[0]))[:, 0])
        for shift in (0.5, -0.5)
    )
    assert near > 0.2 > far


def test_a_flat_net_has_a_box_to_stand_in():
    sides = np.ptp(box(np.array([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0]])), axis=0)
    assert sides[1] > 2.0
    assert sides[[0, 2]] == pytest.approx(0.32)
    assert np.ptp(box(np.zeros((1, 3))), axis=0).min() > 0.0


def test_plan_has_one_scale_and_is_as_wide_as_the_panel(bagged):
    ax = tension_plan(bagged).axes[0]
    corners = ax.transData.transform([[0.0, 0.0], [WIDTH, 0.0], [0.0, WIDTH]])
    assert corners[1, 0] - corners[0, 0] == pytest.approx(corners[2, 1] - corners[0, 1])
    assert ax.get_xlim()[1] >= WIDTH / 2.0


def test_plan_does_not_depend_on_where_the_panel_stands():
    def segments(net: Net) -> np.ndarray:
        plan = tension_plan(result_of(net, bag(net, 0.1))).axes[0]
        return np.concatenate([c.get_segments() for c in plan.collections])

    stands = framed(meshes=(5, 3), size=(0.2, 0.12))
    leans = framed(meshes=(5, 3), size=(0.2, 0.12), centre=(4.0, -7.0, -20.0), normal=(1.0, -2.0, 0.5))
    assert segments(stands) == pytest.approx(segments(leans), abs=1e-12)
    assert np.ptp(segments(stands)[..., 0]) == pytest.approx(0.2)


def test_one_plan_per_panel_on_one_scale():
    left, right = framed(name="wing"), framed(meshes=(4, 4), size=(0.16, 0.16), name="codend")
    n, m = left.knot_count, left.bar_count
    (wing,), (codend,) = left.panels, right.panels
    codend = replace(codend, knots=codend.knots + n, bars=codend.bars + m)
    both = {
        name: np.concatenate([getattr(left, name), getattr(right, name)])
        for name in (
            "positions",
            "fixed",
            "rest_length",
            "twine_of_bar",
            "knot_diameter",
            "knot_density",
            "load",
        )
    }
    bars = np.concatenate([left.bars, right.bars + n])
    net = replace(left, bars=bars, labels=left.labels + right.labels, panels=(wing, codend), **both)
    figure = tension_plan(result_of(net))
    plans = [ax for ax in figure.axes if ax.get_title()]
    assert [ax.get_title() for ax in plans] == ["wing", "codend"]
    assert [sum(len(c.get_segments()) for c in ax.collections) for ax in plans] == [256, 64]
    scales = [np.ptp(ax.transData.transform([[0, 0], [1, 0]])[:, 0]) for ax in plans]
    assert scales[0] == pytest.approx(scales[1])


def test_histogram_counts_every_bar_once(bagged):
    ax = tension_histogram(bagged).axes[0]
    columns = [(patch.get_x(), patch.get_height()) for patch in ax.patches]
    slack = [height for x, height in columns if x < 0.0]
    assert slack == [np.sum(bagged.tension[-1] == 0.0)]
    assert sum(height for x, height in columns if x >= 0.0) == np.sum(bagged.tension[-1] > 0.0)


def test_histogram_shows_taut_bars_beside_a_tower_of_slack_ones():
    net = line(TWINE, np.outer(np.linspace(0.0, 500.0, 501), [1.0, 0.0, 0.0]), 1.0)
    tension = np.zeros((1, 500))
    tension[0, :3] = [1.0, 2.0, 3.0]
    figure = tension_histogram(replace(result_of(net), tension=tension))
    assert figure.axes[0].get_ylim()[1] < 2.0
    assert "↑ 497" in texts(figure)


def test_a_net_without_tension_has_no_colour_bar():
    result = result_of(framed())
    for draw in (equilibrium_shape, tension_plan, tension_histogram):
        found = texts(draw(result))
        assert "slack bar (256 of 256)" in found
    assert "Bar tension (N)" not in texts(equilibrium_shape(result))


def hanging_line() -> Result:
    along = np.linspace(0.0, 10.0, 21)
    net = line(TWINE, np.column_stack([along, 0 * along, 0 * along]), 0.55)
    return result_of(net, net.positions - np.outer(2.0 - 0.08 * (along - 5.0) ** 2, [0.0, 0.0, 1.0]))


SHAPES = {
    "bag": lambda: result_of(net := framed(centre=(0.0, 0.0, -0.5)), bag(net, 0.1)),
    "deep": lambda: result_of(net := framed(centre=(2.0, -1.0, -30.0)), bag(net, 0.5)),
    "flat": lambda: result_of(framed()),
    "lying": lambda: result_of(net := framed(normal=(0.0, 0.0, -1.0)), bag(net, 0.1)),
    "across": lambda: result_of(net := framed(normal=(0.0, 1.0, 0.0)), bag(net, 0.08)),
    "wide": lambda: result_of(net := framed(meshes=(30, 4), size=(1.2, 0.15)), bag(net, 0.1)),
    "tall": lambda: result_of(net := framed(meshes=(4, 24), size=(0.15, 1.0)), bag(net, 0.1)),
    "huge": lambda: result_of(net := framed(size=(250.0, 250.0), centre=(0.0, 0.0, -125.0)), bag(net, 80.0)),
    "equal": lambda: result_of(
        panel(TWINE, mesh="square", meshes=(6, 4), bar_length=0.03, size=(0.186, 0.124))
    ),
    "line": hanging_line,
    "bar": lambda: result_of(line(TWINE, [[0, 0, 0], [0, 0, -2.0]], 1.9)),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_no_text_is_cut_or_meets_another(shape):
    result = SHAPES[shape]()
    for draw in (initial_position, equilibrium_shape, tension_plan, tension_histogram):
        figure = draw(result)
        check_layout(figure)


def test_no_text_of_histories_and_comparison_is_cut(moving, bagged, shifted):
    check_layout(histories(moving))
    check_layout(shape_comparison(bagged, shifted))
    check_layout(initial_position(bagged, current=(0.0, 0.0, -1.25)))


def check_layout(figure: Figure) -> None:
    """Every text lies on the page, and no two touch."""
    page = figure.bbox
    boxes = [(text.get_text(), text.get_window_extent()) for text in written(figure)]
    for text, extent in boxes:
        assert extent.x0 >= page.x0 and extent.x1 <= page.x1, text
        assert extent.y0 >= page.y0 and extent.y1 <= page.y1, text
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        assert not (a.x0 < b.x1 and b.x0 < a.x1 and a.y0 < b.y1 and b.y0 < a.y1), (one, other)


def curve(figure: Figure, index: int) -> np.ndarray:
    return figure.axes[index].lines[0].get_ydata()


def test_histories_show_deflection_drag_tension_and_energy(moving):
    figure = histories(moving)
    assert {"Centre\ndeflection (mm)", "Drag (N)", "Time (s)", "Kinetic\nenergy (J)"} <= set(texts(figure))
    steps = np.arange(6)
    assert curve(figure, 0) == pytest.approx(13.0 * steps / 5.0)
    assert curve(figure, 1) == pytest.approx(0.5 * steps)
    assert curve(figure, 2) == pytest.approx(moving.tension.max(axis=1))
    assert curve(figure, 3) == pytest.approx(10.0**-steps)
    assert figure.axes[3].get_yscale() == "log"
    for ax in figure.axes:
        assert ax.get_xlim() == pytest.approx((0.0, 0.5))


def test_drag_is_counted_along_the_current(moving):
    steps = np.arange(6)
    assert curve(histories(moving, current=(0.0, -2.0, 0.0)), 1) == pytest.approx(-0.4 * steps)


def test_a_run_that_never_moves_has_no_energy(moving):
    still = replace(moving, kinetic_energy=np.zeros(6))
    assert len(histories(still).axes) == 3


def test_a_static_result_has_no_histories(bagged):
    with pytest.raises(ValueError, match="two frames"):
        histories(bagged)


def test_comparison_says_and_shows_how_far_apart(bagged, shifted):
    figure = shape_comparison(bagged, shifted)
    found = texts(figure)
    assert any(t.startswith("RMS distance 5 mm, largest 5 mm at knot ") for t in found)
    assert any("(3 knots measured)" in t for t in found)
    assert {"computed", "measured", "x (m)", "y (m)", "z (m)"} <= set(found)
    for ax, pair in zip(figure.axes[1:], ((0, 2), (1, 2)), strict=True):
        (marks,) = (one for one in ax.lines if one.get_label() == "measured")
        assert np.array(marks.get_xydata()) == pytest.approx(shifted.measured[:, pair])


def test_comparison_of_a_long_net_is_seen_from_above():
    result = hanging_line()
    knots = np.array([5, 10])
    computed = result.position[-1][knots]
    apart = np.array([0.1, 0.1])
    measured = computed + np.array([0.0, 0.1, 0.0])
    figure = shape_comparison(
        result, Comparison(knots, ("5", "10"), measured, computed, apart, 0.1, 0.1, "5")
    )
    assert (figure.axes[2].get_xlabel(), figure.axes[2].get_ylabel()) == ("x (m)", "y (m)")
    check_layout(figure)


def test_draw_all_writes_sound_files(bagged, moving, shifted, tmp_path):
    names = ["initial_position", "equilibrium_shape", "tension_plan", "tension_histogram"]
    for result, comparison, more in ((bagged, shifted, "comparison"), (moving, None, "histories")):
        folder = tmp_path / more
        folder.mkdir()
        files = draw_all(result, folder, comparison=comparison, current=(0.5, 0.0, 0.0))
        expected = [f"{name}.{kind}" for name in [*names, more] for kind in ("png", "svg")]
        assert [file.name for file in files] == expected
        assert sorted(file.name for file in folder.iterdir()) == sorted(expected)
        for file in files:
            width = 178.0 if file.stem == "comparison" else 86.0  # mm
            if file.suffix == ".png":
                with Image.open(file) as image:
                    image.load()
                    assert image.width == pytest.approx(width / 25.4 * 300.0, abs=1.0)
                    assert image.info["dpi"] == pytest.approx((300.0, 300.0), rel=1e-3)
                    assert len(image.convert("L").getcolors()) > 20
            else:
                root = ElementTree.parse(file).getroot()
                assert float(root.get("width").removesuffix("pt")) == pytest.approx(
                    width / 25.4 * 72.0, rel=1e-4
                )


def test_same_result_same_bytes_whatever_the_settings(bagged, shifted, tmp_path):
    (tmp_path / "plain").mkdir()
    (tmp_path / "odd").mkdir()
    plain = draw_all(bagged, tmp_path / "plain", comparison=shifted)
    with mpl.rc_context({"axes.grid": True, "font.size": 30.0, "savefig.dpi": 20.0, "lines.linewidth": 9.0}):
        before = dict(mpl.rcParams)
        odd = draw_all(bagged, tmp_path / "odd", comparison=shifted)
        assert dict(mpl.rcParams) == before
    for one, other in zip(plain, odd, strict=True):
        assert one.read_bytes() == other.read_bytes()


def test_files_tell_no_date(bagged, tmp_path):
    for file in write_figure(tension_histogram(bagged), tmp_path / "figure"):
        assert not re.search(rb"20\d\d-\d\d-\d\d|dc:date", file.read_bytes())


def test_a_large_net_is_drawn_thin_and_its_vector_file_stays_small(tmp_path):
    net = framed(meshes=(60, 60), size=(2.3, 2.3))
    result = result_of(net, bag(net, 0.7))
    assert net.bar_count == 14400
    figure = equilibrium_shape(result)
    _, svg = write_figure(figure, tmp_path / "large")
    assert svg.stat().st_size < 3_000_000
    assert "free knot" not in texts(initial_position(result))
    (taut,) = (c for c in figure.axes[0].collections if c.get_gid() == "taut-bars")
    assert taut.get_linewidths()[0] < 0.4


def test_drawing_needs_no_display_and_loads_no_window_system(tmp_path):
    code = (
        "import sys, fyke; assert 'matplotlib' not in sys.modules; import fyke.report.figures;"
        "print('matplotlib.pyplot' in sys.modules)"
    )
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    run = subprocess.run(
        [sys.executable, "-c", code],
        env={**environment, "MPLBACKEND": "tkagg"},
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert run.stdout.strip() == "False"


def test_of_very_many_bars_some_are_drawn_and_the_legend_says_so(monkeypatch):
    monkeypatch.setattr("fyke.report.bars.BARS_UP_TO", 100)
    net = panel(TWINE, mesh="diamond", meshes=(8, 8), bar_length=0.03, size=(WIDTH, WIDTH))
    result = Result.from_frames(net, OUTCOME, 0.0, [frame_of(net, 1.2 * net.positions)])
    for make, kind in (
        (initial_position, "bars"),
        (equilibrium_shape, "taut-bars"),
        (tension_plan, "taut-bars"),
    ):
        figure = make(result)
        (collection,) = [c for ax in figure.axes for c in ax.collections if c.get_gid() == kind]
        assert len(collection.get_segments()) == 100
        assert "100 of 256 bars drawn" in [text.get_text() for text in figure.findobj(Text)]
    # Every tension keeps its own bar: the colours are those of the bars that are drawn.
    assert len(collection.get_array()) == 100
