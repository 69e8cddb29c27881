"""Claims that need MoorDyn, another program, by `make test-peers`."""

from __future__ import annotations

import importlib.util

import pytest

from fyke.study.validate import judge
from reference import VALIDATION

pytestmark = [
    pytest.mark.peers,
    pytest.mark.skipif(
        importlib.util.find_spec("moordyn") is None,
        reason='MoorDyn is not installed; `make test-peers` does it, or pip install -e ".[peers]"',
    ),
]


@pytest.mark.parametrize("name", ["moordyn_panel", "moordyn_chain", "moordyn_mooring"])
def test_moordyn_comes_to_the_rest_of_statics(name):
    rows = judge(VALIDATION / f"{name}.toml").rows
    assert rows and all(row.verdict == "holds" for row in rows), rows
