"""Grouped meshes, and large panels that begin on them.

The sags of 96 x 96 meshes, whole and grouped, were computed with another program than fyke: a CHOLMOD prototype of the
interior-point method, documented to six digits.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fyke
from fyke.netting.grouping import Grid, carry, grid_of, nearest
from fyke.netting.together import together
from fyke.solve import nested
from fyke.solve.equilibrium import Equilibrium
from fyke.system.grouped import grouped
from fyke.water.laws.panels import KristiansenFaltinsen, Loland
from fyke.water.wakes import ChengTwines, LolandWake

TWINE = fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9))


def panel_system(meshes, mesh="diamond", fixed="edges", speed=(0.5, 0.0, 0.0), hung=0.9, **laws):
    bars = np.sqrt(2.0) if mesh == "diamond" else 1.0
    size = tuple(hung * count * 0.03 * bars for count in meshes)
    net = fyke.panel(
        TWINE, mesh=mesh, meshes=meshes, bar_length=0.03, size=size, knot_diameter=3.5e-3, fixed=fixed
    )
    return fyke.make_system(net, current=speed, coefficients=fyke.Coefficients(**laws))


def on_fewer(system, meshes):
    fine = grid_of(system.net)
    return grouped(system, fine, Grid.of(fine.mesh, meshes))


@pytest.mark.parametrize(("meshes", "sag"), [(48, 1.11328), (24, 1.11380)])
def test_sag_of_grouped_meshes(meshes, sag):
    """The sag of 96 x 96 meshes grouped 2 x 2 and 4 x 4 in one."""
    result = fyke.solve_static(on_fewer(panel_system((96, 96)), (meshes, meshes)))
    assert result.outcome.ok
    assert np.abs(result.position[-1][:, 0]).max() == pytest.approx(sag, abs=5.1e-6)


def test_sag_of_96_meshes_is_the_same_by_nested_iteration(monkeypatch):
    monkeypatch.setattr(nested, "LARGE", 5_000)
    result = fyke.solve_static(panel_system((96, 96)))
    assert result.outcome.ok and "begun from 48 x 48" in result.outcome.message
    assert result.outcome.factorizations <= 20
    assert np.abs(result.position[-1][:, 0]).max() == pytest.approx(1.11306, abs=5.1e-6)


@pytest.mark.parametrize(
    ("meshes", "options"),
    [
        ((40, 40), {}),
        ((33, 50), {}),
        ((30, 24), {"mesh": "square"}),
        ((24, 24), {"fixed": "top"}),
        ((31, 31), {"hung": 1.02, "mesh": "square"}),
        ((33, 24), {"screens": Loland()}),
        ((24, 30), {"mesh": "square", "hung": 0.97, "screens": KristiansenFaltinsen()}),
        ((30, 30), {"twines": ChengTwines(), "speed": (0.1, 0.5, 0.0)}),
        ((24, 24), {"twines": ChengTwines(), "wake": LolandWake(), "screens": Loland()}),
    ],
)
def test_nested_and_plain_end_at_the_same_shape(monkeypatch, meshes, options):
    system = panel_system(meshes, **options)
    plain = fyke.solve_static(system, tolerance=1e-10)
    monkeypatch.setattr(nested, "LARGE", 400)
    result = fyke.solve_static(system, tolerance=1e-10)
    assert plain.outcome.ok and "begun from" not in plain.outcome.message
    assert result.outcome.ok and "begun from" in result.outcome.message
    taut = plain.tension[-1] > 0.0
    assert np.abs(result.tension[-1] - plain.tension[-1]).max() < 1e-7
    # Bars that bear nothing leave their knots free within what the tolerance sees.
    joined = np.unique(system.net.bars[taut])
    assert np.abs((result.position[-1] - plain.position[-1])[joined]).max() < 1e-6


def test_nested_gives_the_same_bits_twice(monkeypatch):
    monkeypatch.setattr(nested, "LARGE", 400)
    a, b = (fyke.solve_static(panel_system((24, 24))) for _ in range(2))
    assert a.position.tobytes() == b.position.tobytes()


def test_weight_drag_and_stiffness_of_the_grouped_panel_are_those_of_the_whole():
    """Totals: weight and knots' drag stay; bars' drag d l and frame stiffness EA over length keep their sums."""
    system = panel_system((48, 48))
    small = on_fewer(system, (24, 24))
    whole, few = system.elements, small.elements
    free = [el.free > 0.0 for el in (whole, few)]
    # Every free knot of a diamond panel has four bars: n^2 knots in one.
    assert few.weight[free[1]].mean(axis=0) == pytest.approx(4.0 * whole.weight[free[0]].mean(axis=0))
    assert (few.normal_drag * few.rest_length).sum() == pytest.approx(
        (whole.normal_drag * whole.rest_length).sum()
    )
    assert (few.stiffness * few.rest_length).mean() == pytest.approx(
        2.0 * (whole.stiffness * whole.rest_length).mean()
    )
    assert few.rest_length == pytest.approx(0.06)
    assert small.net.positions.max() == pytest.approx(system.net.positions.max())


@pytest.mark.parametrize("mesh", ["diamond", "square"])
def test_screens_of_the_grouped_panel_push_as_much(mesh):
    """Face on: F = 1/2 rho C_D A U^2 with Loeland's C_D = 0.33 Sn + 6.54 Sn^2 - 4.88 Sn^3 of the whole."""
    system = panel_system((24, 24), mesh=mesh, hung=0.9, screens=Loland())
    sn = system.faces.solidity[0]
    width, height = system.net.panels[0].size
    want = 500.0 * (0.33 * sn + 6.54 * sn**2 - 4.88 * sn**3) * width * height * 0.5**2
    for one in (system, on_fewer(system, (12, 12)), on_fewer(system, (7, 9))):
        s = Equilibrium(one, one.at_rest(), None)
        assert s.b.load[:, 0].sum() == pytest.approx(want, rel=1e-9)


def test_the_default_size_of_a_large_panel_counts_screens_too():
    """90 x 90 meshes: 20 and more iterations from the flat start, 15 at most from grouped meshes."""
    result = fyke.solve_static(panel_system((90, 90), screens=Loland()))
    assert result.outcome.ok and "begun from 45 x 45" in result.outcome.message
    assert result.outcome.iterations <= 15


@settings(max_examples=25, deadline=None)
@given(
    mesh=st.sampled_from(["diamond", "square"]),
    fine=st.tuples(st.integers(6, 14), st.integers(6, 14)),
    coarse=st.tuples(st.integers(4, 6), st.integers(4, 6)),
    degree=st.sampled_from([1, 3]),
    slope=st.tuples(*[st.floats(-2.0, 2.0)] * 3),
)
def test_a_plane_is_carried_exactly(mesh, fine, coarse, degree, slope):
    """Knots and bars of either direction, from fine to coarse and back."""
    a, b = Grid.of(mesh, fine), Grid.of(mesh, coarse)
    for have, want in ((a, b), (b, a)):
        for own, other in zip((have.knots, *have.directions), (want.knots, *want.directions), strict=True):
            places = [(p.at + np.array(p.offset)) / np.array(p.intervals) for p in (own, other)]
            values = [slope[0] + place @ np.array(slope[1:]) for place in places]
            assert carry(values[0], own, other, degree) == pytest.approx(values[1], abs=1e-9)
            at = nearest(own, other)
            assert np.abs(places[0][at] - places[1]).max() * min(own.intervals) < 3.0


def test_nets_that_are_no_panel_have_no_grid():
    chain = fyke.line(TWINE, np.column_stack([np.arange(9.0), np.zeros((9, 2))]), 1.1)
    panel = panel_system((4, 4)).net
    assert grid_of(chain) is None
    assert grid_of(together([panel, chain])) is None
    assert grid_of(panel).meshes == (4, 4)


def test_a_stop_on_a_level_is_a_stop(monkeypatch):
    monkeypatch.setattr(nested, "LARGE", 400)

    def stop(fraction, text):
        raise KeyboardInterrupt

    result = fyke.solve_static(panel_system((24, 24)), on_progress=stop)
    assert result.outcome.name == "interrupted"
    assert np.isfinite(result.position).all()
