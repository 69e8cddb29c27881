"""How near the laws of bars and knots come to measured cylinders and spheres: the tables of the page."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from fyke.water.laws import LAWS, measured

Array = NDArray[np.float64]
PAGE = (Path(__file__).parents[1] / "docs" / "validation.md").read_text(encoding="utf-8")
NETTING = (30.0, 1e4)  # Reynolds numbers of twine and knots
CYLINDERS, SPHERES = measured.cylinder(), measured.sphere()


def made(kind: str) -> dict[str, object]:
    """Laws of a kind but for the user's tables, and a law of the solidity, which one cylinder has not."""
    return {
        name: law()
        for name, law in LAWS[kind].items()
        if not name.endswith("table") and name != "cifuentes-kim"
    }


BARS, KNOTS = made("bars"), made("knots")


def off(law, points: Array, low: float, high: float) -> tuple[int, float, float]:
    """Points between two Reynolds numbers; root of the mean square of ln C_D over measured, and mean of it in %."""
    re, drag = points[(points[:, 0] >= low) & (points[:, 0] <= high)].T
    found = law.coefficients(re) if points is SPHERES else law.drag_lift(re, 0.5 * np.pi)[0]
    ratio = np.log(found / drag)
    return len(re), float(np.sqrt(np.mean(ratio**2))), float(100.0 * np.expm1(np.mean(ratio)))


def row(law, points: Array) -> list[str]:
    stated = [(one.low, one.high) for one in law.ranges if one.quantity == "Re"]
    low, high = stated[0] if stated else (0.0, np.inf)
    both = [off(law, points, max(low, NETTING[0]), min(high, NETTING[1]))]
    cells = [f"{rms:.3f} ({mean:+.0f} %), {count} points" for count, rms, mean in both]
    if stated:
        count, rms, mean = off(law, points, low, high)
        return [f"{rms:.3f} ({mean:+.0f} %), {count} points", *cells]
    return ["none stated", *cells]


def rows_of(heading: str) -> dict[str, list[str]]:
    (lines,) = [part for part in PAGE.split("\n\n") if part.startswith(f"| {heading} |")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines.splitlines()]
    return {one[0]: one[1:] for one in rows[2:]}


@pytest.mark.parametrize(
    ("heading", "laws", "points"),
    [("cylinder", BARS, CYLINDERS), ("sphere", KNOTS, SPHERES)],
    ids=["cylinder", "sphere"],
)
def test_the_page_says_how_near_every_law_comes(heading, laws, points):
    assert rows_of(heading) == {name: row(law, points) for name, law in laws.items()}


def test_the_best_laws_are_as_near_as_the_points_scatter():
    """At the Reynolds numbers of netting both scatter by 0.04 about polynomials of the fourth power in ln Re."""
    assert len(CYLINDERS) == 247 and len(SPHERES) == 122
    assert off(BARS["ns-cheng"], CYLINDERS, *NETTING)[1] < 0.06
    assert off(KNOTS["clift-gauvin"], SPHERES, *NETTING)[1] < 0.06
    for law, points in ((BARS["ns-cheng"], CYLINDERS), (KNOTS["clift-gauvin"], SPHERES)):
        low, high = law.ranges[0].low, law.ranges[0].high
        assert off(law, points, low, high)[1] < 0.1
