"""Rings and collars: tubes as bars, what the case file makes of them, what is told and drawn of them."""

from __future__ import annotations

import numpy as np
import pytest

import fyke
from fyke.netting.tubes import Tube, ring

PIPE = Tube.of("HDPE", diameter=0.315, wall=0.0179)


def test_the_section_of_a_tube_is_that_of_thin_walls_in_the_limit():
    thin = Tube(1.0, 1e-5, 1000.0, 1e9)
    assert thin.wall_area == pytest.approx(np.pi * 1e-5, rel=1e-4)
    assert thin.second_moment == pytest.approx(np.pi / 8.0 * 1e-5, rel=1e-4)


@pytest.mark.parametrize("contents", ["air", "water"])
def test_a_ring_weighs_in_water_its_wall_less_what_it_displaces(contents):
    tube = Tube(0.3, 0.02, 958.0, 9e8, contents)
    net = ring(tube.twine("pipe"), diameter=12.0, knots=24, centre=(0.0, 0.0, -5.0))
    system = fyke.make_system(net, water=fyke.Water(1025.0))
    length, wall, outline = 24 * 12.0 * np.sin(np.pi / 24), np.pi / 4 * (0.3**2 - 0.26**2), np.pi / 4 * 0.3**2
    displaced = outline if contents == "air" else wall
    assert system.weight_in_water == pytest.approx(
        9.81 * length * (958.0 * wall - 1025.0 * displaced), rel=1e-12
    )
    # The water inside is carried along.
    inside = 0.0 if contents == "air" else 1025.0 * (outline - wall)
    assert system.elements.knot_mass.sum() == pytest.approx(length * (958.0 * wall + inside), rel=1e-12)


def test_a_tube_is_as_stiff_as_its_wall():
    twine = PIPE.twine("pipe")
    (row,) = twine.law.rows(twine.diameter)
    assert row[2] == pytest.approx(9e8 * np.pi / 4 * (0.315**2 - 0.2792**2), rel=1e-12)
    assert twine.bending_stiffness == pytest.approx(9e8 * np.pi / 64 * (0.315**4 - 0.2792**4), rel=1e-12)


def test_a_wall_must_leave_room():
    with pytest.raises(ValueError, match=r"wall of 0\.2 m"):
        Tube(0.3, 0.2, 958.0, 9e8)
