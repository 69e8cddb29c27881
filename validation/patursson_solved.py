"""Patursson's panel as solved, not flat: what its belly does to drag and lift."""

from __future__ import annotations

from fyke.study import Found
from patursson import BELLIED, STIFFNESSES, solved


def measure(tables):
    for model in BELLIED:
        # Lee's drag falls steeply with the angle: shown, not judged.
        shown = " shown" if model == "screens, lee" else ""
        for stiffness, twine in zip(STIFFNESSES, ("nylon as of rope", "netting of 40 MPa"), strict=True):
            sag, drag, lift = solved(model, stiffness)
            yield Found("sag", sag, case=f"{model}, {twine}")
            yield Found(f"drag{shown}", drag, case=f"{model}, {twine}")
            yield Found("lift", lift, case=f"{model}, {twine}")
