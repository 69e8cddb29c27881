"""Speed behind Patursson's panel by the laws of wakes."""

from __future__ import annotations

import numpy as np

from fyke.study import Found
from fyke.water.laws import measured
from fyke.water.wakes import ChengWake, LolandWake, MomentumWake


def measure(tables):
    rows = tables["wake"]
    angle, left = np.radians([row["angle"] for row in rows]), [row["left"] for row in rows]
    for law in (ChengWake(), LolandWake(), MomentumWake()):
        found = np.broadcast_to(law.factor(angle, measured.PANEL_SOLIDITY), angle.shape)
        for here, ours, true in zip(angle, found, left, strict=True):
            key = law.name if here < np.radians(50.0) else "doubted"
            yield Found(key, ours, true, f"{law.name}, {np.degrees(here):.0f} deg")
    # The force goes with the square of the speed.
    yield Found("behind", 100.0 * (left[0] ** -2.0 - 1.0))
