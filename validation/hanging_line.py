"""A weighted line hanging in a current, cut into bars, against its differential equation."""

from __future__ import annotations

from functools import cache

import numpy as np

import fyke
from fyke.study import Found
from lines import STIFF, draw_orders, orders, thread

NO_GRAVITY = fyke.Water(gravity=0.0)
# Speeds (m/s) at which the order is taken, and numbers of bars for it; angles from the vertical to begin at.
ORDERS, CUTS = (0.5, 0.8, 1.0), (20, 40, 80)
STARTS = (90.0, 45.0)


def hang(row, bars, angle=np.pi / 2.0, gathered=1.0):
    """Let a line go at an angle (rad) from the vertical, streaming downstream by default.

    gathered: the part of its length over which the line is laid out.
    """
    s = np.linspace(0.0, row["length"] * gathered, bars + 1)
    points = np.outer(s, [np.sin(angle), 0.0, -np.cos(angle)])
    load = np.zeros_like(points)
    load[:, 2] = -row["w"] * row["length"] / bars
    load[[0, -1]] *= 0.5
    load[-1, 2] -= row["end_weight"]
    net = fyke.line(
        thread(STIFF * row["top_tension"], row["diameter"]),
        points,
        row["length"] / bars,
        fixed=(0,),
        load=load,
    )
    coefficients = fyke.Coefficients(
        bars=fyke.ConstantBar(row["Cn"], row["Ct"]),
        knots=fyke.ConstantKnot(0.0),
        added_mass_bar=0.0,
        added_mass_knot=0.0,
    )
    current = (row["speed"], 0.0, 0.0)
    return fyke.solve_static(
        fyke.make_system(net, current=current, water=NO_GRAVITY, coefficients=coefficients)
    )


def errors(row, result):
    """Excursion and depth over the length, force on the top, its size and its parts, over its size."""
    if not result.outcome.ok:
        raise RuntimeError(f"{name_of(row)}: {result.outcome.message}")
    end, force = result.position[-1][-1], result.support_reaction[-1]
    where = np.array([end[0] - row["excursion"], -end[2] - row["depth"]]) / row["length"]
    pull = np.array([np.linalg.norm(force), force[0], -force[2]])
    exact = [row["top_tension"], row["drag"], row["vertical"]]
    return np.concatenate([where, (pull - exact) / row["top_tension"]])


def name_of(row):
    return f"{row['case'].replace('_', ' ')}, {row['speed']:g} m/s"


def bars_of(row):
    """Fifty, twice as many where the drag bends the line within one of them: radius W over the drag per length."""
    drag = 0.5 * 1000.0 * row["Cn"] * row["diameter"] * row["speed"] ** 2
    return 50 if row["end_weight"] / drag > row["length"] / 50 else 100


def of_profile(row, points, bars=100):
    """Largest errors of ten places over the length, and of the tensions between them, over the exact ones.

    A hundred bars: the lower end of the lightest line turns by 42 degrees within a tenth of its length.
    """
    result = hang(row, bars)
    # A knot has the mean tension of the two bars that meet there.
    tension = 0.5 * (result.tension[-1][1:] + result.tension[-1][:-1])
    places, tensions = [], []
    for p in points:
        knot = round(p["s"] / row["length"] * bars)
        places.append(np.abs(result.position[-1][knot] - [p["x"], 0.0, p["z"]]).max() / row["length"])
        if 0 < knot < bars:
            tensions.append(abs(tension[knot - 1] / p["tension"] - 1.0))
    return max(places), max(tensions)


@cache
def cuts():
    """Errors by the number of bars, of every line whose order was taken, for the picture."""
    return {}


def measure(tables):
    for row in tables["lines"]:
        case = name_of(row)
        for degrees in STARTS:
            off = np.abs(errors(row, hang(row, bars_of(row), np.radians(degrees)))).max()
            yield Found("values", off, case=f"{case}, {bars_of(row)} bars, let go at {degrees:g} deg")
        if row["speed"] in ORDERS:
            found = [np.linalg.norm(errors(row, hang(row, bars))) for bars in CUTS]
            cuts()[case] = (CUTS, found)
            yield Found("order", orders(found)[-1], case=case)
        points = [p for p in tables["profiles"] if (p["case"], p["speed"]) == (row["case"], row["speed"])]
        if points:
            place, tension = of_profile(row, points)
            yield Found("place", place, case=case)
            yield Found("tension", tension, case=case)


def picture(found):
    return draw_orders(cuts(), 2, by="bars", what="error of end and force, over length and force")
