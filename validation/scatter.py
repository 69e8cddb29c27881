"""How near the laws of bars and knots come to measured cylinders and spheres."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from fyke.report.style import DOUBLE_COLUMN, styled
from fyke.study import Found
from fyke.water.laws import LAWS, measured

NETTING = (30.0, 1e4)  # Reynolds numbers of twine and knots
CYLINDERS, SPHERES = measured.cylinder(), measured.sphere()


def made(kind):
    """Laws of a kind but for the user's tables, and a law of the solidity, which one cylinder has not."""
    return {
        name: law()
        for name, law in LAWS[kind].items()
        if not name.endswith("table") and name != "cifuentes-kim"
    }


def off(law, points, low, high):
    """Points between two Reynolds numbers; root of the mean square of ln C_D over measured, and mean of it in %."""
    re, drag = points[(points[:, 0] >= low) & (points[:, 0] <= high)].T
    found = law.coefficients(re) if points is SPHERES else law.drag_lift(re, 0.5 * np.pi)[0]
    ratio = np.log(found / drag)
    return len(re), float(np.sqrt(np.mean(ratio**2))), float(100.0 * np.expm1(np.mean(ratio)))


def noise(points):
    """Scatter of ln C_D at the Reynolds numbers of netting about a polynomial of the fourth power in ln Re."""
    re, drag = np.log(points[(points[:, 0] >= NETTING[0]) & (points[:, 0] <= NETTING[1])]).T
    return np.std(drag - np.polynomial.Polynomial.fit(re, drag, 4)(re))


def measure(tables):
    yield Found("points", len(CYLINDERS), 247, "cylinders")
    yield Found("points", len(SPHERES), 122, "spheres")
    for kind, points in (("bars", CYLINDERS), ("knots", SPHERES)):
        body = "sphere" if kind == "knots" else "cylinder"
        yield Found("noise", noise(points), case=body)
        for name, law in made(kind).items():
            stated = [(one.low, one.high) for one in law.ranges if one.quantity == "Re"]
            low, high = stated[0] if stated else (0.0, np.inf)
            if stated:
                count, rms, _ = off(law, points, low, high)
                yield Found(f"{body} in its range", rms, case=f"{name}, {count} points")
            count, rms, mean = off(law, points, max(low, NETTING[0]), min(high, NETTING[1]))
            key = (
                "at netting, best"
                if name in {"ns-cheng", "kristiansen-faltinsen", "clift-gauvin"}
                else "at netting"
            )
            yield Found(key, rms, case=f"{body}, {name}, {count} points")
            yield Found("mean", mean, case=f"{body}, {name}, {count} points")


@styled
def picture(found):
    """C_D of cylinders and spheres by Reynolds number, laws over points."""
    figure = Figure(figsize=(DOUBLE_COLUMN, 3.2), layout="constrained")
    re = np.geomspace(1.0, 1e6, 400)
    for axes, kind, points, title in zip(
        figure.subplots(1, 2), ("bars", "knots"), (CYLINDERS, SPHERES), ("cylinder", "sphere"), strict=True
    ):
        axes.loglog(*points.T, ".", color="0.6", markersize=3, label="measured")
        for name, law in made(kind).items():
            bounds = next(((one.low, one.high) for one in law.ranges if one.quantity == "Re"), (0.0, np.inf))
            here = re[(re >= bounds[0]) & (re <= bounds[1])]
            curve = law.coefficients(here) if kind == "knots" else law.drag_lift(here, 0.5 * np.pi)[0]
            axes.loglog(here, np.broadcast_to(curve, here.shape), linewidth=0.9, label=name)
        axes.set(title=title, xlabel="Re (-)", ylabel="C_D (-)", ylim=(0.05, 1e3))
        axes.legend(ncols=2, loc="upper right")
    return figure
