"""Lattices, panels, lines, nets together."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from fyke.netting.lattice import flat_strain, hanging_ratios, hung_size, lattice
from fyke.netting.panel import panel_axes
from fyke.netting.together import together
from fyke.netting.twine import MATERIALS


@pytest.mark.parametrize(
    ("mesh", "meshes", "knots", "bars"),
    [
        ("diamond", (8, 8), 145, 256),
        ("diamond", (1, 1), 5, 4),
        ("diamond", (3, 2), 18, 24),
        ("square", (8, 8), 81, 144),
        ("square", (1, 1), 4, 4),
        ("square", (3, 2), 12, 17),
    ],
)
def test_counts(mesh, meshes, knots, bars):
    """Diamond: (2a+1)(2b+1) lattice places, those of even i + j, and 4 a b bars; square: counted by hand."""
    grid = lattice(mesh, meshes)
    assert (len(grid.knots), len(grid.bars)) == (knots, bars)
    assert len({tuple(sorted(bar)) for bar in grid.bars.tolist()}) == bars


def test_every_inner_knot_has_four_bars():
    for mesh in ("diamond", "square"):
        grid = lattice(mesh, (5, 4))
        degree = np.bincount(grid.bars.ravel(), minlength=len(grid.knots))
        inner = ~grid.held("edges")
        assert np.all(degree[inner] == 4)
        assert degree[grid.held("corners")].tolist() == [1 if mesh == "diamond" else 2] * 4


def test_labels_and_places(nylon):
    net = fyke.panel(
        nylon, mesh="diamond", meshes=(8, 8), bar_length=0.03, size=(0.32, 0.16), centre=(1.0, 2.0, -0.5)
    )
    where = dict(zip(net.labels, net.positions, strict=True))
    assert where["8-8"] == pytest.approx([1.0, 2.0, -0.5])
    assert where["0-0"] == pytest.approx([1.0, 2.0 - 0.16, -0.5 - 0.08])
    assert where["16-2"] == pytest.approx([1.0, 2.0 + 0.16, -0.5 - 0.06])
    assert "1-2" not in where
    top = fyke.panel(nylon, mesh="diamond", meshes=(2, 3), bar_length=0.03, size=(0.08, 0.12), fixed="top")
    assert [label for label, held in zip(top.labels, top.fixed, strict=True) if held] == ["0-6", "2-6", "4-6"]


@pytest.mark.parametrize("normal", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -2), (1, 2, 3)])
def test_axes_are_a_right_handed_frame_with_level_width(normal):
    width, height = panel_axes(np.array(normal, dtype=float))
    assert width[2] == 0.0
    assert np.cross(width, height) == pytest.approx(np.array(normal) / np.linalg.norm(normal), abs=1e-15)


def test_hanging_ratios():
    """Hung at E1 = 0.6 unloaded diamonds have E2 = 0.8: 10 x 8 meshes of 30 mm bars make 0.36 m by 0.384 m."""
    size = hung_size("diamond", (10, 8), 0.03, (0.6, 0.8))
    assert size == pytest.approx((0.36, 0.384))
    assert hanging_ratios("diamond", (10, 8), 0.03, size) == pytest.approx((0.6, 0.8))
    assert flat_strain("diamond", (10, 8), 0.03, size) == pytest.approx((0.0,), abs=1e-15)
    assert flat_strain("square", (10, 8), 0.03, (0.33, 0.216)) == pytest.approx((0.1, -0.1))
    net_strain = flat_strain("diamond", (8, 8), 0.03, (0.3055, 0.3055))[0]
    twine = fyke.Twine("t", 1140.0, 1e-3, fyke.LinearLaw(1e9))
    net = fyke.panel(twine, mesh="diamond", meshes=(8, 8), bar_length=0.03, size=(0.3055, 0.3055))
    ends = net.positions[net.bars]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert lengths == pytest.approx(np.full(256, 0.03 * (1 + net_strain)))


def test_two_panels_in_one_net(nylon):
    other = fyke.Twine("thin", 950.0, 1e-3, fyke.PowerLaw(345.37e6, 1.0121))
    parts = [
        fyke.panel(
            t, mesh="square", meshes=(2, 2), bar_length=0.1, size=(0.19, 0.19), centre=(x, 0.0, 0.0), name=n
        )
        for t, x, n in ((nylon, 0.0, "front"), (other, 2.0, "back"), (nylon, 4.0, "third"))
    ]
    net = together(parts)
    assert (net.knot_count, net.bar_count, [t.name for t in net.twines]) == (27, 36, ["main", "thin"])
    assert net.bar_diameter[[0, 12, 24]].tolist() == [1.5e-3, 1e-3, 1.5e-3]
    assert net.labels[9] == "back:0-0" and net.panels[1].knots.tolist() == list(range(9, 18))
    assert net.panels[2].bars.tolist() == [[bar] for bar in range(24, 36)]
    alone = [fyke.solve_static(fyke.make_system(p, current=(0.6, 0.1, 0.0)), tolerance=1e-11) for p in parts]
    both = fyke.solve_static(fyke.make_system(net, current=(0.6, 0.1, 0.0)), tolerance=1e-11)
    assert np.abs(both.position[-1] - np.concatenate([r.position[-1] for r in alone])).max() < 1e-9


def test_a_line_has_its_loads_where_they_were_put(nylon):
    net = fyke.line(nylon, [[0, 0, 0], [0, 0, -1], [0, 0, -2]], [1.0, 0.9], fixed=(0,), load=(0.0, 0.0, -2.0))
    assert net.rest_length.tolist() == [1.0, 0.9] and net.fixed.tolist() == [True, False, False]
    assert net.load.tolist() == [[0, 0, -2.0]] * 3 and net.bar_label(1) == "1 to 2"


def test_material_table():
    """Densities as tabled; moduli from EA/MBL x MBL/d^2 by hand: 5 x 207e6 x 4/pi = 1.318 GPa for nylon."""
    assert {m.name: m.density for m in MATERIALS.values()} == {
        "PA": 1140.0, "PES": 1380.0, "UHMWPE": 975.0, "PE": 950.0, "PP": 910.0, "CuZn": 8410.0
    }  # fmt: skip
    assert MATERIALS["PA"].youngs_modulus == pytest.approx(1.3178e9, rel=1e-4)
    assert MATERIALS["PE"].youngs_modulus == pytest.approx(439.7e6, rel=1e-3)
    assert MATERIALS["PP"].youngs_modulus is None
