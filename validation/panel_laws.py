"""Drag and lift of a plane panel by every law with a table of others' arithmetic."""

from __future__ import annotations

import numpy as np

from fyke.study import Found
from fyke.water.laws import LAWS
from fyke.water.laws.panels import Fridman, KristiansenFaltinsen

PANELS = LAWS["panels"]
COMPARED = {
    "aarsnes": PANELS["aarsnes"](),
    "loland": PANELS["loland"](),
    "kf_simple": KristiansenFaltinsen("simple"),
    "kf_sheet": KristiansenFaltinsen("sheet"),
    "lee": PANELS["lee"](),
    "bi": PANELS["bi"](),
}


def column(rows, name):
    return np.array([row[name] for row in rows])


def measure(tables):
    rows = tables["laws"]
    angle, sn, re = np.radians(column(rows, "angle")), column(rows, "solidity"), column(rows, "gap_reynolds")
    for name, law in COMPARED.items():
        drag, lift = law.coefficients(angle, sn, re * (1.0 - sn))
        yield Found("drag", np.abs(drag - column(rows, f"{name}_drag")).max(), case=name)
        yield Found("lift", np.abs(lift - column(rows, f"{name}_lift")).max(), case=name)
    drag, lift = Fridman().coefficients(angle, sn, re)
    # Along the panel acts c_t sin^2, which lowers the lift; the table adds it.
    added = 2.0 * 0.1 * re**0.14 * sn * np.sin(angle) ** 2 * np.cos(angle)
    yield Found("drag", np.abs(drag - column(rows, "fridman_drag")).max(), case="fridman")
    yield Found(
        "lift", np.abs(lift + added - column(rows, "fridman_lift_plus")).max(), case="fridman, sign put right"
    )
