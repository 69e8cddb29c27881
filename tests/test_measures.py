"""Derived figures of netting: solidity against a pixel count, masses by hand, formulas of the trade."""

import dataclasses

import numpy as np
import pytest

from fyke.netting.elastic import LinearLaw
from fyke.netting.measures import measure_net, measure_panel, solidity
from fyke.netting.net import Net
from fyke.netting.panel import panel
from fyke.netting.twine import Twine
from netting_measures import hung

BAR = 0.03


def test_solidity_of_square_mesh_on_its_point_is_that_of_square_mesh():
    on_point = solidity("diamond", BAR, (np.sqrt(0.5), np.sqrt(0.5)), 0.0015)
    assert on_point == pytest.approx(solidity("square", BAR, (1.0, 1.0), 0.0015), rel=1e-14)


def test_a_square_mesh_pulled_out_of_square_covers_less():
    """Wires d apart by b1 and b2 leave holes of (b1 - d)(b2 - d)."""
    open_part = (0.036 - 0.0015) * (0.024 - 0.0015) / (0.036 * 0.024)
    assert solidity("square", BAR, (1.2, 0.8), 0.0015) == pytest.approx(1.0 - open_part, rel=1e-13)


def test_netting_closed_to_a_rope_is_solid_and_no_more():
    for knot_diameter in (0.0, 0.0035):
        values = [
            solidity("diamond", BAR, (e, np.sqrt(1 - e**2)), 0.0015, knot_diameter) for e in (0.3, 0.03)
        ]
        assert values[0] < 0.3
        assert values[1] <= 1.0


def test_the_figures_of_the_example_panel_are_those_by_hand():
    net = panel(
        Twine("main", 1140.0, 0.0015, LinearLaw(1e9)),
        mesh="diamond",
        meshes=(8, 8),
        bar_length=0.03,
        size=(0.3055, 0.3055),
        knot_diameter=0.0035,
    )
    figures = measure_panel(net, net.panels[0])
    assert figures.hanging_ratios == pytest.approx((0.3055 / 0.48, 0.3055 / 0.48), rel=1e-14)
    assert figures.outline_area == pytest.approx(0.09333025, rel=1e-12)
    assert figures.mesh_length == 0.06
    # 1140 kg/m3 through a circle of 1.5 mm: 2014.546 g/km.
    assert figures.rtex == pytest.approx(2014.546, rel=1e-6)
    # 64 meshes of 4 bars, 1.5 mm by 30 mm each.
    assert figures.twine_area == pytest.approx(64 * 4 * 0.0015 * 0.03, rel=1e-12)
    # Rtex / (a E1 E2) for the twine, and a nylon ball of 3.5 mm, 25.59218 mg, for every two bars.
    twine = 2014.546e-6 / (0.03 * (0.3055 / 0.48) ** 2)
    assert figures.mass_per_area == pytest.approx(twine + 128 * 25.59218e-6 / 0.09333025, rel=1e-6)


def test_each_panel_of_a_net_is_measured_with_its_own_twine_and_knots():
    thin, thick = hung("diamond", 0.6, 0.001, 0.004), hung("diamond", 0.6, 0.002, 0.004)
    n, m = thin.knot_count, thin.bar_count
    second = dataclasses.replace(
        thick.panels[0], twine="thick", knots=thick.panels[0].knots + n, bars=thick.panels[0].bars + m
    )
    both = Net(
        positions=np.vstack([thin.positions, thick.positions + 1.0]),
        labels=tuple(f"{part}:{label}" for part in "ab" for label in thin.labels),
        fixed=np.tile(thin.fixed, 2),
        bars=np.vstack([thin.bars, thick.bars + n]),
        rest_length=np.concatenate([thin.rest_length, thick.rest_length]),
        twines=(thin.twines[0], dataclasses.replace(thick.twines[0], name="thick")),
        twine_of_bar=np.repeat([0, 1], m),
        knot_diameter=np.tile(thin.knot_diameter, 2),
        knot_density=np.repeat([1140.0, 7850.0], n),
        load=np.zeros((2 * n, 3)),
        panels=(thin.panels[0], second),
    )
    one, two = (measure_panel(both, p) for p in both.panels)
    assert two.twine_area == pytest.approx(2.0 * one.twine_area, rel=1e-14)
    assert two.rtex == pytest.approx(4.0 * one.rtex, rel=1e-14)
    ball = np.pi / 6.0 * 0.004**3
    # A rectangle of 2 x 2 diamonds, edges shared with its neighbours, has 8 knots of its own.
    extra = (two.mass_per_area - 4.0 * one.mass_per_area) * one.outline_area / 8.0
    assert extra == pytest.approx((7850.0 - 4.0 * 1140.0) * ball, rel=1e-9)
    assert measure_net(both).mass == pytest.approx(
        sum(measure_net(net).mass for net in (thin, thick)) + n * (7850.0 - 1140.0) * ball, rel=1e-12
    )
