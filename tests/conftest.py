"""Nets that several tests share."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import fyke
from browser import browser, described  # noqa: F401


@pytest.fixture(scope="session")
def nylon() -> fyke.Twine:
    return fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9), material="PA")


@pytest.fixture(scope="session")
def framed(nylon):
    """Return a maker of the 8 x 8 panel of the example; keywords change twine (damping_time), panel and water."""

    def make(current=(0.5, 0.0, 0.0), damping_time=0.0, water=None, coefficients=None, **panel: Any):
        options: dict[str, Any] = {
            "mesh": "diamond",
            "meshes": (8, 8),
            "bar_length": 0.03,
            "size": (0.3055, 0.3055),
            "knot_diameter": 3.5e-3,
        }
        net = fyke.panel(replace(nylon, damping_time=damping_time), **(options | panel))
        return fyke.make_system(net, current=current, water=water, coefficients=coefficients)

    return make


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    terminalreporter.write_line(described())
