"""Lines that hang in a current from the starts that users draw; validation/hanging_line.toml has the rest."""

from __future__ import annotations

import numpy as np
import pytest

from hanging_line import errors, hang, name_of
from reference import rows_of_claim


@pytest.fixture(scope="module")
def lines():
    return rows_of_claim("hanging_line", "lines")


def test_line_let_go_straight_down(lines):
    """However strong the current."""
    for row in lines:
        for bars in (5, 10, 25, 50, 100):
            assert hang(row, bars, angle=0.0).outcome.ok, (name_of(row), bars)


def test_line_let_go_gathered(lines):
    """A hundred metres of wire laid out over one, the rest slack."""
    row = next(r for r in lines if name_of(r) == "wire warp, 0.1 m/s")
    result = hang(row, 50, np.pi / 4.0, gathered=0.01)
    assert result.outcome.ok
    assert np.abs(errors(row, result)).max() < 1e-3
