"""Laws of shelter against published numbers, balances by hand and the measured wake of a panel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fyke.water.laws.law import PanelLaw
from fyke.water.laws.panels import Aarsnes, KristiansenFaltinsen
from fyke.water.wakes import TWINES, WAKES, ChengTwines, ChengWake, GivenWake, LolandWake, MomentumWake
from reference import VALIDATION

MEASURED = np.loadtxt(VALIDATION / "data" / "panel_wake.csv", delimiter=",", skiprows=5)
LAWS = {name: law() for name, law in WAKES.items()}


@dataclass(frozen=True)
class Fixed(PanelLaw):
    """One C_D for all."""

    drag: float

    def coefficients(self, angle, solidity=0.0, reynolds=0.0):
        ones = np.ones_like(np.asarray(solidity, dtype=float) + np.asarray(reynolds, dtype=float))
        return self.drag * ones * np.cos(angle), 0.0 * ones


def test_lolands_wake_behind_aarsnes_panel_is_the_published_one():
    """0.953, 0.880, 0.743 at solidity 0.1, 0.2, 0.3; at every angle."""
    law = LolandWake(Aarsnes())
    assert law.factor(0.0, [0.1, 0.2, 0.3]) == pytest.approx([0.953, 0.880, 0.743], abs=6e-4)
    assert law.factor([0.0, 0.7, 1.5], 0.2) == pytest.approx(law.factor(0.0, 0.2), rel=1e-15)


def test_lolands_wake_of_his_own_panel_by_hand():
    """Sn 0.2: C_D = 0.04 - 0.04 + 0.066 + 0.2616 - 0.03904 = 0.28856."""
    assert LolandWake().factor(0.0, 0.2) == pytest.approx(1.0 - 0.46 * 0.28856, rel=1e-12)


def test_momentum_that_is_lost_is_the_drag():
    """0.949 at C_D = 0.1, 0.707 at 0.5; rho u (U - r U) = 1/2 rho C_D U^2 at u = (U + r U) / 2; 0 from 1 on."""
    assert MomentumWake(Fixed(0.1)).factor(0.3) == pytest.approx(0.949, abs=5e-4)
    assert MomentumWake(Fixed(0.5)).factor(0.3) == pytest.approx(0.707, abs=5e-4)
    for drag in (0.05, 0.3, 0.9):
        r = float(MomentumWake(Fixed(drag)).factor(0.0))
        assert 0.5 * (1.0 + r) * (1.0 - r) == pytest.approx(0.5 * drag, rel=1e-12)
    assert MomentumWake(Fixed(1.3)).factor(0.0) == 0.0


def test_a_wake_by_a_law_of_the_reynolds_number_knows_it():
    """Kristiansen and Faltinsen at Re' = 500: C_D = 0.324 at Sn 0.2."""
    law = LolandWake(KristiansenFaltinsen())
    assert law.factor(0.0, 0.2, 500.0 * 0.8) == pytest.approx(1.0 - 0.46 * 0.324, abs=0.46 * 6e-4)
    assert law.ranges == KristiansenFaltinsen().ranges


def test_chengs_wake_by_hand():
    """Sn 0.2 takes 0.076 of cos q + 0.05: nothing is left from cos q = 0.026 on; below Sn 0.1316 always something."""
    law = ChengWake()
    assert law.factor(np.radians([0.0, 60.0]), 0.2) == pytest.approx([0.974 / 1.05, 0.474 / 0.55], rel=1e-12)
    assert law.factor(np.arccos([0.0261, 0.0259]), 0.2) == pytest.approx([1e-4 / 0.0761, 0.0], abs=1e-12)
    assert law.factor(np.pi / 2.0, [0.1315, 0.1316]) == pytest.approx([6e-4, 0.0], abs=2e-4)


@pytest.mark.parametrize(
    ("name", "deviation"),
    [
        ("loland", [-2.4, -2.1, -2.4, -2.0, 0.3, 17.5]),
        ("momentum", [-5.1, -4.8, -5.1, -4.7, -2.5, 14.3]),
        ("cheng", [4.3, 4.4, 3.2, 1.7, -0.4, 2.2]),
    ],
)
def test_deviation_from_the_measured_wake_is_as_told(name, deviation):
    """In percent, at the solidity that the experiment states; the last angle is doubtful in the source."""
    angle, measured = np.radians(MEASURED[:, 0]), MEASURED[:, 1]
    found = 100.0 * (LAWS[name].factor(angle, 0.2) / measured - 1.0)
    assert found == pytest.approx(deviation, abs=0.06)


@given(st.floats(-10.0, 10.0), st.floats(0.0, 1.0), st.floats(1.0, 1e5))
def test_factors_lie_between_0_and_1_and_know_no_side(angle, solidity, reynolds):
    for law in LAWS.values():
        r = float(law.factor(angle, solidity, reynolds))
        assert 0.0 <= r <= 1.0
        assert float(law.factor(np.pi - angle, solidity, reynolds)) == pytest.approx(r, abs=1e-9)
    for law in TWINES.values():
        r = float(law().factor(angle, solidity))
        assert 8.0**-0.5 <= r <= 1.0


def test_twines_face_on_are_as_their_coefficient_and_never_lose_more_than_a_factor_of_8():
    law = ChengTwines()
    assert law.factor(0.0, [0.05, 0.2, 0.6]) == pytest.approx(1.0, rel=1e-15)
    assert law.factor(np.pi / 2.0, [0.2, 0.6]) ** 2 == pytest.approx(1.0 / 8.0, rel=1e-12)
    assert law.factor(np.radians(60.0), 0.2) == pytest.approx((0.474 / 0.55) / (0.974 / 1.05), rel=1e-12)
    rising = law.factor(np.radians(np.arange(0.0, 90.5, 0.5)), 0.2)
    assert np.all(np.diff(rising) <= 0.0)
    # The floor begins where cos q + 0.05 = 0.076 / (1 - 0.9276 / sqrt 8) = 0.1131.
    held = rising == law.least
    assert np.degrees(np.arccos(0.1131 - 0.05)) == pytest.approx(86.4, abs=0.05)
    assert (held[172], held[173]) == (False, True)


def test_a_factor_of_ones_own_is_one_for_all_and_within_bounds():
    assert GivenWake(0.8).factor([0.0, 1.5], 0.3) == pytest.approx(0.8, rel=1e-15)
    for wrong in (-0.1, 1.1, np.nan):
        with pytest.raises(ValueError, match="from 0 to 1 was expected"):
            GivenWake(wrong)


def test_every_law_says_where_it_comes_from():
    for law in (*WAKES.values(), *TWINES.values()):
        assert law.title and law.source and law.read and law.name
