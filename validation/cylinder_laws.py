"""Drag of a bar across the flow by every law with a table of others' arithmetic."""

from __future__ import annotations

import numpy as np

from fyke.study import Found
from fyke.water.laws import BAND, LAWS
from fyke.water.laws.bars import CifuentesKim

BARS = LAWS["bars"]
# Law of a column, the Reynolds numbers at which its pieces meet, and the last one that is compared. Beyond X = 200 the
# parabola of Cifuentes and Kim falls below zero and is not followed.
COMPARED = {
    "choo_casarella": (BARS["choo-casarella"](), (1.0, 30.0, 2.33e5, 4.92e5), np.inf),
    "takagi": (BARS["takagi"](), (200.0,), np.inf),
    "kristiansen_faltinsen": (BARS["kristiansen-faltinsen"](), (), np.inf),
    "cifuentes_kim": (CifuentesKim(solidity=0.2), (), 5000.0),
    "white": (BARS["white"](), (), np.inf),
}
TWO_DECIMALS = {"ns_cheng": "ns-cheng", "sucker_brauer": "sucker-brauer"}


def measure(tables):
    re = np.array([row["reynolds"] for row in tables["laws"]])
    for column, (law, joints, last) in COMPARED.items():
        exact = np.array([row[column] for row in tables["laws"]])
        at_joint = np.any([np.abs(np.log(re / one)) <= np.log(BAND) for one in joints] or [re < 0.0], axis=0)
        compared = np.isfinite(exact) & ~at_joint & (re <= last)
        off = np.abs(law.coefficients(re)[0] - exact)[compared]
        yield Found("coefficient", off.max(), case=f"{law.name}, {len(off)} numbers")
    re = np.array([row["reynolds"] for row in tables["printed"]])
    for column, name in TWO_DECIMALS.items():
        printed = np.array([row[column] for row in tables["printed"]])
        off = np.abs(BARS[name]().coefficients(re)[0] - printed)
        yield Found("printed", off.max(), case=f"{name}, {len(off)} numbers")
