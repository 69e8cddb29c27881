"""Grouped meshes: totals by hand, the same forces whatever the group, and real bars' tensions.

The sags of 96 x 96 meshes, whole and grouped, were computed with another program than fyke: a CHOLMOD prototype of the
interior-point method, documented to six digits.
"""

import numpy as np
import pytest

import fyke
from fyke.forces.evaluate import evaluate
from fyke.netting.measures import measure_net
from fyke.system.system import State
from fyke.water.laws.bars import Hoerner, Takagi
from fyke.water.laws.knots import SchillerNaumann
from fyke.water.laws.panels import KristiansenFaltinsen, Loland
from fyke.water.wakes import LolandWake

BAR, TWINE_DIAMETER, KNOT = 0.03, 1.5e-3, 3.5e-3
DENSITY, KNOT_DENSITY = 1140.0, 1300.0
LAWS = {
    "linear": fyke.LinearLaw(1e9),
    "power": fyke.PowerLaw(345.37e6, 1.0121),
    "quadratic": fyke.QuadraticLaw(1160.0, 37300.0),
    "table": fyke.TableLaw((0.0, 0.02, 0.05, 0.1), (0.0, 4.0, 20.0, 90.0)),
}
GROUPS = [1, 2, 4, 8]


def twine(law="linear"):
    return fyke.Twine("main", DENSITY, TWINE_DIAMETER, LAWS[law])


def panel(mesh, meshes, group, *, hung=0.9, law="linear", **options):
    bars = np.sqrt(2.0) if mesh == "diamond" else 1.0
    size = tuple(hung * count * BAR * bars for count in meshes)
    return fyke.panel(
        twine(law),
        mesh=mesh,
        meshes=meshes,
        bar_length=BAR,
        size=size,
        knot_diameter=KNOT,
        knot_density=KNOT_DENSITY,
        group=group,
        **options,
    )


def counts(mesh, meshes):
    """Knots and bars of a flat panel, by hand."""
    a, b = meshes
    return (2 * a * b + a + b + 1, 4 * a * b) if mesh == "diamond" else ((a + 1) * (b + 1), 2 * a * b + a + b)


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("group", [*GROUPS, 5, 7])
def test_knots_bars_mass_and_weight_are_those_of_the_real_net_by_hand(mesh, group):
    """24 x 16 meshes, which 5 and 7 do not divide."""
    meshes = (24, 16)
    net = panel(mesh, meshes, group)
    knots, bars = counts(mesh, meshes)
    told = measure_net(net)
    assert (told.real_knots, told.real_bars) == (knots, bars)
    assert told.twine_length == pytest.approx(bars * BAR, rel=1e-12)
    fibre, ball = np.pi / 4.0 * TWINE_DIAMETER**2 * bars * BAR, np.pi / 6.0 * KNOT**3 * knots
    assert told.mass == pytest.approx(DENSITY * fibre + KNOT_DENSITY * ball, rel=1e-12)
    system = fyke.make_system(net)
    sinking = (DENSITY - 1000.0) * fibre + (KNOT_DENSITY - 1000.0) * ball
    assert system.weight_in_water == pytest.approx(9.81 * sinking, rel=1e-12)
    assert system.elements.weight[:, 2].sum() == pytest.approx(-9.81 * sinking, rel=1e-12)
    added = 1000.0 * (fibre + 0.5 * ball)
    assert 2.0 * system.elements.bar_added_mass.sum() == pytest.approx(1000.0 * fibre, rel=1e-12)
    assert system.elements.knot_mass.sum() == pytest.approx(told.mass + added - 1000.0 * fibre, rel=1e-12)
    few = counts(mesh, net.panels[0].meshes)
    assert (net.knot_count, net.bar_count) == few
    assert group == 1 or few[0] < knots


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("group", GROUPS)
def test_drag_of_a_flat_panel_by_hand(mesh, group):
    """Face on, 1/2 rho U^2 (1.2 d l + 1.0 pi/4 d_k^2) over all bars as they are on the frame, and all knots."""
    meshes, speed = (16, 24), 0.5
    net = panel(mesh, meshes, group)
    knots, bars = counts(mesh, meshes)
    frame = evaluate(fyke.make_system(net, current=(speed, 0.0, 0.0)), fyke.make_system(net).at_rest())
    area = 1.2 * TWINE_DIAMETER * 0.9 * BAR * bars + np.pi / 4.0 * KNOT**2 * knots
    assert frame.hydrodynamic_force == pytest.approx(
        [500.0 * speed**2 * area, 0.0, 0.0], rel=1e-12, abs=1e-12
    )


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize(
    "laws",
    [
        {},
        {"bars": Takagi(), "knots": SchillerNaumann()},
        {"bars": Hoerner()},
        {"screens": Loland()},
        {"screens": KristiansenFaltinsen()},
        {"screens": Loland(), "wake": LolandWake()},
    ],
)
def test_an_inclined_panel_has_the_same_drag_and_lift_whatever_the_group(mesh, laws):
    forces = []
    for group in GROUPS:
        net = panel(mesh, (16, 24), group, normal=(1.0, 0.3, 0.5))
        system = fyke.make_system(net, current=(0.5, 0.0, 0.0), coefficients=fyke.Coefficients(**laws))
        forces.append(evaluate(system, system.at_rest()).hydrodynamic_force)
    assert np.linalg.norm(forces[0]) > 1.0
    for force in forces[1:]:
        assert force == pytest.approx(forces[0], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("mesh", ["diamond", "square"])
@pytest.mark.parametrize("law", LAWS)
def test_an_affine_stretch_gives_the_same_edge_force_and_real_tension(mesh, law):
    """Every bar of the real net has the strain of the stretch; its tension is that of its law by hand."""
    stretch = np.array([1.0, 1.0, 1.0]) * 1.03
    edge = []
    for group in GROUPS:
        net = panel(mesh, (16, 24), group, hung=1.0, law=law)
        system = fyke.make_system(net)
        frame = evaluate(system, State(0.0, net.positions * stretch, np.zeros_like(net.positions)))
        strain = 0.03
        row = LAWS[law].rows(TWINE_DIAMETER)
        row = row[np.searchsorted(row[:, 0], strain, side="right") - 1]
        above = strain - row[0]
        want = row[1] + row[2] * above + row[3] * above ** row[4]
        assert frame.tension == pytest.approx(np.full(net.bar_count, want), rel=1e-9)
        pull = (net.bar_multiple * frame.tension)[:, None] * _along(net)
        right = net.positions[:, 1] > net.positions[:, 1].max() - 1e-9
        a, b = net.bars.T
        edge.append(pull[right[b] & ~right[a]].sum(axis=0) - pull[right[a] & ~right[b]].sum(axis=0))
        # Every row of meshes has two bars at the side, at 45 degrees; every row of squares one.
        bars = 2 * 24 / np.sqrt(2.0) if mesh == "diamond" else 25
        assert edge[-1][1] == pytest.approx(bars * want, rel=1e-9)
    for force in edge[1:]:
        assert force == pytest.approx(edge[0], rel=1e-12, abs=1e-9)


def _along(net):
    a, b = net.positions[net.bars].transpose(1, 0, 2)
    return (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
