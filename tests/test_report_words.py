"""The words of the report."""

from __future__ import annotations

from typing import get_args

from fyke.report.page.words import PLAIN
from fyke.solve.outcome import OutcomeName


def test_every_outcome_has_its_words():
    assert set(PLAIN) == set(get_args(OutcomeName))
