"""What abstracts say of panels of netting in one line, beside what the default coefficients make of it."""

from __future__ import annotations

import fyke
from fyke.study import Found
from panels import framed, settled


def drag(**given):
    return settled(framed(**given)).hydrodynamic_force[-1][0]


def measure(tables):
    knotted = drag()
    bare = drag(coefficients=fyke.Coefficients(knots=fyke.ConstantKnot(0.0)))
    yield Found("share", 100.0 * (1.0 - bare / knotted), 21.0)
    yield Found("knots", 100.0 * (knotted / bare - 1.0), 10.0)
    normal, tangential = fyke.ConstantBar().coefficients(500.0)
    yield Found("along", 100.0 * float(tangential / normal), 30.0)
