"""Every example runs and says what it should."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"


@pytest.mark.parametrize("case", sorted(EXAMPLES.glob("*.toml")), ids=lambda p: p.stem)
def test_case_runs(case, tmp_path):
    command = [
        sys.executable,
        "-m",
        "fyke",
        "run",
        str(case),
        "-o",
        str(tmp_path / "out"),
        "--json",
        "--no-figures",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert summary["outcome"] == "converged"
    assert all("floats" in warning for warning in summary["warnings"])
    held = [
        q + (summary["weight_in_water"] if i == 2 else 0.0) for i, q in enumerate(summary["support_reaction"])
    ]
    assert held == pytest.approx(summary["hydrodynamic_force"], abs=1e-4)


def test_hanging_line_agrees_with_the_exact_curve():
    """Excursion, depth and top tension of the inextensible line, from its differential equation."""
    out = subprocess.run(
        [sys.executable, EXAMPLES / "hanging_line.py"], capture_output=True, text=True, check=True
    )
    exact = {
        0.1: (0.04351329, 0.99874708, 0.20969658),
        0.3: (0.34586977, 0.91886658, 0.20932930),
        0.5: (0.64247886, 0.69921680, 0.21036078),
        1.0: (0.89226931, 0.33383891, 0.22821804),
    }
    lines = re.findall(
        r"([\d.]+) m/s: end at x = ([\d.]+) m, z = -([\d.]+) m, top tension ([\d.]+) N", out.stdout
    )
    assert len(lines) == len(exact)
    for speed, *values in lines:
        assert [float(v) for v in values] == pytest.approx(exact[float(speed)], abs=1.5e-3)
