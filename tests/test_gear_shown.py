"""Ropes, floats, sinkers and closed shapes in pictures and tables: what is drawn where, and figures by part."""

from __future__ import annotations

import base64
import json
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.netting.net import Net
from fyke.netting.panel import panel
from fyke.netting.rigging import Sphere, evenly, with_bodies, with_rope
from fyke.netting.shapes import cage, frustum
from fyke.netting.sheet import Netting
from fyke.report.bars import legend_rows
from fyke.report.colours import Colouring
from fyke.report.figures import equilibrium_shape, initial_position, tension_histogram, tension_plan
from fyke.report.gltf import write_gltf
from fyke.report.page.packing import Packed, _signed
from fyke.report.parts import Bars, Knots, Outline, coloured_bars, parts_of, tied_knots
from fyke.report.plan import _laid_flat
from fyke.report.sections import _cut, _rows, _triangles, sections
from fyke.results.parts import by_part, part_figures, part_words, write_parts
from fyke.results.volume import volume_history
from fyke.solve.result import Result
from fyke.water.laws.panels import Loland

TWINE = fyke.Twine("n", 1140.0, 2.5e-3, fyke.LinearLaw(4e8))
ROPE = fyke.Twine("rope", 1140.0, 12e-3, fyke.LinearLaw(4e8))
NETTING = Netting(TWINE, "diamond", 0.1)
TOP = (0.0, 0.0, -0.1)


def sack() -> Net:
    """A cage with a bottom, a rope round the lower rim, eight sinkers there and a float at the top."""
    net = cage(NETTING, (16, 3), diameter=0.9, depth=0.45, bottom=(3, 0.2), top=TOP)
    rim = net.panels[0].edge("bottom")
    net = with_rope(net, rim, ROPE, name="foot")
    weights = Sphere(0.5, 0.05).at(evenly(rim, 8, closed=True), name="weights", kind="sinker")
    cork = Sphere(0.01, 0.08).at([int(net.panels[0].edge("top")[3])], name="cork", kind="float")
    return with_bodies(with_bodies(net, weights), cork)


@pytest.fixture(scope="module")
def hung() -> Result:
    result = fyke.solve_static(fyke.make_system(sack(), current=(0.3, 0.0, 0.0)))
    assert result.outcome.ok
    return result


def test_every_bar_is_drawn_once_and_bodies_in_their_size():
    net = sack()
    parts = parts_of(net)
    drawn = np.concatenate([part.bars for part in parts if isinstance(part, Bars)])
    assert np.array_equal(np.sort(drawn), np.arange(net.bar_count))
    (rope,) = (part for part in parts if isinstance(part, Bars) and part.own == "foot")
    # 16 meshes round have 16 knots along their rim.
    assert (rope.name, len(rope.bars), rope.colour is None) == ("rope", 16, False)
    told = {part.name: part for part in parts if isinstance(part, Knots)}
    assert (told["sinker"].diameter, told["float"].diameter) == (0.05, 0.08)
    assert (len(told["sinker"].knots), len(told["float"].knots)) == (8, 1)
    (rim,) = (part for part in parts if isinstance(part, Outline))
    assert rim.name == "rim" and np.hypot(*rim.points[:, :2].T) == pytest.approx(np.full(17, 0.45))


def test_a_net_of_ropes_alone_is_coloured():
    net = fyke.line(ROPE, [[0, 0, 0], [0, 0, -1.0], [0, 0, -2.0]], 1.0, fixed=(0,))
    net = with_rope(net, [0, 1], ROPE, name="more")
    only = replace(net, ropes=(replace(net.ropes[0], bars=np.arange(net.bar_count)),))
    assert coloured_bars(net).tolist() == [0, 1] and coloured_bars(only).tolist() == [0, 1, 2]
    assert [part.name for part in parts_of(only)] == ["netting", "fixed knot"]


def test_places_within_bars_are_no_knots():
    plain, bowed = (
        panel(TWINE, mesh="diamond", meshes=(4, 3), bar_length=0.1, size=(0.5, 0.4), segments=s)
        for s in (1, 4)
    )
    assert tied_knots(plain).all()
    # Three places within each of 4 x 3 x 4 bars.
    assert np.count_nonzero(~tied_knots(bowed)) == 3 * 48
    assert np.count_nonzero(tied_knots(bowed)) == plain.knot_count


@pytest.mark.parametrize("low", [0.0, 0.3, 0.9])
def test_rows_of_a_frustum_laid_flat_are_as_wide_as_built(low):
    """Every row is a polygon of 12 knots: 12 x 2 r sin(pi/12) round, with r linear in the height."""
    net = frustum(NETTING, (12, 4), diameters=(low, 0.9), height=0.5)
    where = net.panels[0]
    points = _laid_flat(net, where)
    j = where.lattice.knots[:, 1]
    for row in range(0, 9, 2):
        radius = 0.5 * (low + (0.9 - low) * row / 8)
        assert np.ptp(points[j == row, 0]) == pytest.approx(24.0 * radius * np.sin(np.pi / 12), abs=1e-12)
    assert np.ptp(points[:, 1]) == pytest.approx(np.hypot(0.5, 0.45 - low / 2.0))


def test_colours_are_those_of_the_netting(hung):
    """A rope that bears more than all netting does not take the colours for itself."""
    rope = hung.net.ropes[0].bars
    loud = hung.tension.copy()
    loud[0, rope] = 1e6
    result = replace(hung, tension=loud)
    largest = np.delete(hung.tension[0], rope).max()
    assert Colouring.of(result, "tension").largest == largest
    for figure in (equilibrium_shape(result), tension_plan(result)):
        scale = next(ax for ax in figure.axes if ax.get_label() == "colour bar")
        # The colour bar counts in N or mN.
        assert scale.get_xlabel() == "Bar tension (N)" and scale.get_xlim()[1] == pytest.approx(largest)
    assert tension_histogram(result).axes[0].get_xlim()[1] < 1.1 * largest


def test_figures_name_the_gear(hung):
    for figure in (initial_position(hung), equilibrium_shape(hung), tension_plan(hung)):
        legends = [*figure.legends, *(ax.get_legend() for ax in figure.axes if ax.get_legend())]
        named = {text.get_text() for legend in legends for text in legend.get_texts()}
        assert {"rope", "sinker", "float", "fixed knot"} <= named
        ropes = [c for ax in figure.axes for c in ax.collections if c.get_gid() == "ropes"]
        # Both plans, of the wall and of the bottom, have the rope along the rim where they meet.
        assert [len(c.get_segments()) for c in ropes] in ([16], [16, 16])


def test_legends_take_a_second_row_where_one_is_too_short():
    assert legend_rows(["fixed knot", "free knot"], 3.39) == 1
    assert legend_rows(["slack bar (186 of 1792)", "rope", "fixed knot", "float", "sinker"], 3.39) == 2


def test_gltf_has_bodies_and_ropes_in_true_size(hung, tmp_path):
    blob = write_gltf(hung, tmp_path / "net.glb").read_bytes()
    told = json.loads(blob[20 : 20 + struct.unpack("<I", blob[12:16])[0]])
    accessors = {
        mesh["name"]: told["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]
        for mesh in told["meshes"]
    }
    cork = accessors["float cork"]
    # An icosahedron with its corners on a sphere reaches 0.8507 of the radius along each axis.
    assert np.subtract(cork["max"], cork["min"]) == pytest.approx(np.full(3, 0.8507 * 0.08), rel=1e-3)
    assert {"rope foot", "sinker weights", "rim", "netting"} <= set(accessors)


def system_of(net: Net, **options) -> fyke.System:
    return fyke.make_system(net, current=(0.3, 0.1, 0.0), surface=True, **options)


@pytest.mark.parametrize("screens", [False, True])
def test_parts_add_up_to_the_net(screens):
    """Forces, weights and supports of the parts, floats at the surface among them, are those of the whole net."""
    law = fyke.Coefficients(screens=Loland()) if screens else None
    net = replace(sack(), load=np.tile([0.0, 0.01, 0.02], (sack().knot_count, 1)))
    system = system_of(net, coefficients=law)
    result = fyke.solve_static(system, tolerance=1e-9)
    parts = by_part(system, result)
    assert [(part.kind, part.name) for part in parts] == [
        ("cylinder", "cage"),
        ("cone", "cage bottom"),
        ("rope", "foot"),
        ("sinker", "weights"),
        ("float", "cork"),
    ]
    assert np.sum([part.water_force for part in parts], axis=0) == pytest.approx(
        result.hydrodynamic_force[-1]
    )
    assert sum(part.weight_in_water for part in parts) == pytest.approx(result.weight_in_water)
    assert np.sum([part.support_reaction for part in parts], axis=0) == pytest.approx(
        result.support_reaction[-1]
    )
    assert sum(part.bars for part in parts) == net.bar_count


def test_a_string_with_a_sinker_by_hand():
    """Two bars of 1 m that hang across a current: each bar and the sinker by formula."""
    net = fyke.line(ROPE, [[0, 0, 0], [0, 0, -1.0], [0, 0, -2.0]], 1.0, fixed=(0,))
    ball = Sphere(5.0, 0.1, drag=0.5)
    net = with_bodies(net, ball.at([2], name="lead", kind="sinker"))
    system = fyke.make_system(net, current=(1e-3, 0.0, 0.0))
    line, lead = by_part(system, fyke.solve_static(system), depth=3.0)
    assert (line.kind, line.name, line.knots, line.bars, line.fixed_knots) == ("other bars", "", 3, 2, 1)
    # 1/2 rho C_D A u^2, with C_n = 1.2 on the bars, C_D = 0.5 on the ball.
    assert lead.drag == pytest.approx(500.0 * 0.5 * np.pi / 4.0 * 0.01 * 1e-6, rel=1e-6)
    weight = 9.81 * (5.0 - 1000.0 * np.pi / 6.0 * 1e-3)
    own = 9.81 * 140.0 * np.pi / 4.0 * 0.012**2 * 2.0
    length = 2.0 * (1.0 + (weight + 0.5 * own) / (4e8 * np.pi / 4.0 * 0.012**2))
    assert line.drag == pytest.approx(500.0 * 1.2 * 0.012 * length * 1e-6, rel=1e-5)
    assert (lead.weight_in_water, line.weight_in_water) == pytest.approx((weight, own))
    # All hangs on the string, and nothing on the sinker is held.
    assert line.support_reaction[2] == pytest.approx(-(weight + own), rel=1e-6)
    assert lead.support_reaction == (0.0, 0.0, 0.0)
    assert line.max_tension == pytest.approx(weight + 0.75 * own, rel=1e-4) and line.max_tension_bar == 0
    # Strings stretch by 3 mm or so.
    assert line.clearance == pytest.approx(1.0, abs=5e-3)
    assert lead.clearance == pytest.approx(line.clearance - 0.05)


def test_a_float_at_the_surface_bears_what_hangs_on_it():
    """Its lost buoyancy is the water's force on it alone: the string below is under water."""
    net = fyke.line(ROPE, [[0, 0, 0], [0, 0, -1.0]], 1.0, fixed=(1,))
    net = with_bodies(net, Sphere(1.0, 0.2).at([0], name="buoy", kind="float"))
    system = fyke.make_system(net, surface=True)
    result = fyke.solve_static(system)
    buoy = by_part(system, result)[1]
    volume = np.pi / 6.0 * 8e-3
    assert buoy.weight_in_water == pytest.approx(9.81 * (1.0 - 1000.0 * volume))
    lost = result.water_force[-1][0, 2]
    assert lost < 0.0
    # The string has a share as small as its own volume.
    assert buoy.water_force[2] == pytest.approx(lost, rel=0.03)


def test_utilisation_and_slack_bars_count_whole_bars():
    """A bar in segments is slack when all of it is, and one that bears half its strength is used by half."""
    weak = replace(TWINE, breaking_strength=50.0)
    net = panel(weak, mesh="square", meshes=(3, 2), bar_length=0.1, size=(0.3, 0.2), segments=2)
    system = fyke.make_system(net)
    tension = np.zeros(net.bar_count)
    tension[[3, 8]] = 10.0, 25.0
    still = fyke.solve_static(system)
    result = replace(still, tension=np.array([3.0 * tension, tension]), time=np.array([0.0, 1.0]))
    result = replace(
        result,
        **{
            name: np.repeat(getattr(still, name), 2, axis=0)
            for name in ("position", "velocity", "water_force", "hydrodynamic_force", "support_reaction")
        },
        **{
            name: np.repeat(getattr(still, name), 2, axis=0)
            for name in ("bar_drag", "bar_lift", "water_velocity", "kinetic_energy", "unbalanced_force")
        },
    )
    (part,) = by_part(system, result)
    # 3 x 3 bars along the width and 4 x 2 along the height.
    assert (part.bars, part.knots, part.slack_bars) == (17, 12, 15)
    assert (part.max_tension, part.max_tension_bar, part.peak_tension) == (25.0, 8, 75.0)
    assert part.utilisation == pytest.approx(1.5)


def test_parts_are_told_in_summary_and_table(hung, tmp_path):
    system = system_of(hung.net)
    figures = part_figures(system, hung, depth=2.0)
    # A cylinder of 32 columns, closed below by a cone of height 0.2 with the same polygon.
    polygon = 16.0 * 0.45**2 * np.sin(np.pi / 16.0)
    assert figures["volume_unloaded"] == pytest.approx(polygon * (0.45 + 0.2 / 3.0), rel=2e-2)
    assert figures["volume"] < figures["volume_unloaded"]
    assert figures["clearance"] == min(part["clearance"] for part in figures["parts"])
    table = write_parts(figures["parts"], tmp_path).read_text().splitlines()
    assert len(table) == 1 + 5
    row = dict(zip(table[0].split(","), table[4].split(","), strict=True))
    assert (row["part"], row["kind"], row["name"], row["utilisation"]) == ("3", "sinker", "weights", "")
    assert float(row["weight_in_water"]) == figures["parts"][3]["weight_in_water"]
    words = dict(part_words(figures))
    lost = 100.0 * (1.0 - figures["volume"] / figures["volume_unloaded"])
    assert f"{lost:.3g} % lost" in words["volume"] and "clearance to the sea bed" in words


def test_a_flat_panel_is_no_sack():
    net = panel(TWINE, mesh="diamond", meshes=(4, 4), bar_length=0.1, size=(0.55, 0.55))
    result = fyke.solve_static(fyke.make_system(net, current=(0.5, 0.0, 0.0)))
    assert volume_history(result) is None


def test_cuts_and_rows_of_a_cone_are_those_of_geometry(hung):
    """As built, the cut of a cone is its two slants, and its rows are circles of known radius."""
    net = frustum(NETTING, (12, 4), diameters=(0.0, 0.8), height=0.6, centre=TOP)
    x = net.positions
    lines = _cut(x, _triangles(net, [0]), np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    # Knots lie on the slants r = 0.4 (1 + (z + 0.1) / 0.6), chords of 12 sides within them by cos(pi/12) at most.
    way, z = lines.reshape(-1, 2).T
    slant = 0.4 * (1.0 + (z + 0.1) / 0.6)
    assert np.all(np.abs(way) <= slant + 1e-12) and np.all(np.abs(way) >= np.cos(np.pi / 12) * slant - 1e-12)
    assert (way.min(), way.max(), z.min()) == pytest.approx((-0.4, 0.4, -0.7))
    # Each slant is covered once.
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum()
    assert length == pytest.approx(2.0 * np.hypot(0.4, 0.6), rel=1e-2)
    rows = _rows(net, [0])
    assert rows[0][0] == pytest.approx(-0.1) and len(rows) == 4
    for height, knots in rows:
        assert np.hypot(*x[knots, :2].T) == pytest.approx(np.full(13, 0.4 * (1.0 + (height + 0.1) / 0.6)))
        assert knots[0] == knots[-1] and len(np.unique(knots)) == 12
    figure = sections(hung, current=(0.3, 0.0, 0.0))
    assert [ax.get_xlabel() for ax in figure.axes] == ["Along the flow (m)", "x (m)"]
    assert "current, 0.3 m/s" in [text.get_text() for text in figure.texts]


def test_a_panel_has_no_sections():
    net = panel(TWINE, mesh="diamond", meshes=(4, 4), bar_length=0.1, size=(0.55, 0.55))
    assert sections(fyke.solve_static(fyke.make_system(net))) is None


def test_what_a_page_carries_keeps_its_sign():
    """The page counts slack bars: 0 stays 0 and tiny pulls stay pulls, beside large pulls and pushes."""
    for values in ([0.0, 1e-6, 8746.0, 3.0], [0.0, -5605.2, 1e-6, -1e-6, 1871.6], [0.0, 0.0], [-2.0, -1e-9]):
        asked = np.array(values).reshape(1, -1, 1)
        high = float(asked.max(initial=0.0)) or 1.0
        packed = Packed.of(*_signed(asked, high))
        whole = np.frombuffer(zlib.decompress(base64.b64decode(packed.text)), dtype="<u2")
        shown = packed.low[0] + packed.step[0] * whole
        assert np.array_equal(np.sign(shown), np.sign(values))
        assert np.abs(shown - values).max() <= 1.01 * packed.step[0]
