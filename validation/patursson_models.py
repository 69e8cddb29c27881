"""Patursson's panel by the five usual models, to the digits that others printed."""

from __future__ import annotations

import numpy as np

from fyke.study import Found
from fyke.water.laws import measured
from patursson import CONSTANT, SCREENS, flat

COLUMNS = {
    "aarsnes": "screens, aarsnes",
    "loland": "screens, loland",
    "kf": SCREENS,
    "fridman": "screens, fridman",
    "bars": CONSTANT,
}


def column(rows, name):
    return np.array([row[name] for row in rows])


def by_hand(name, angle, drag, lift):
    """Lifts put right where the code of the table departs from its formulas; twice for the others' 0.9314."""
    if name == "kf":
        # C_N45 = C_D0 / 2. All lifts of the code are 0.9314 of these.
        normal = 0.5 * drag[0]
        lift_45 = (normal - np.pi * normal / (8.0 + normal)) / np.sqrt(2.0)
        return lift_45 * (np.sin(2.0 * angle) + 0.1 * np.sin(4.0 * angle))
    if name == "fridman":
        # The part along the panel takes from the lift and does not add to it.
        along = 0.1 * measured.PANEL_REYNOLDS**0.14 * 0.2
        return lift - 2.0 * along * np.sin(angle) ** 2 * np.cos(angle)
    return lift


def measure(tables):
    rows = tables["models"]
    angle = np.radians(column(rows, "angle"))
    for name, model in COLUMNS.items():
        drag, lift = column(rows, f"{name}_drag"), column(rows, f"{name}_lift")
        found = flat(model)
        for which, here in enumerate(angle):
            case = f"{model}, {np.degrees(here):.0f} deg"
            yield Found("drag", found[0][which], drag[which], case)
            yield Found("lift", found[1][which], by_hand(name, angle, drag, lift)[which], case)
    scale = column(rows, "kf_lift")[1:] / by_hand("kf", angle, column(rows, "kf_drag"), None)[1:]
    yield Found("slip", np.ptp(scale) / scale.mean())
