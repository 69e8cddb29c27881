"""What `fyke run` shows of the accounts: forces and, in motion, energies against each other."""

from __future__ import annotations

import math
from typing import Any

from .show import quantity


def account_rows(figures: dict[str, Any]) -> list[tuple[str, str]]:
    """Return names and texts of what is out of balance, and in motion of where the energy went, from a summary."""
    accounts = figures["audit"]
    energy, knot = accounts["energy"], accounts["unbalanced_knot"]
    where = "" if knot is None else f", at knot {knot}"
    left = f"{math.hypot(*accounts['load_less_reaction']):.2g} of {quantity(accounts['load_size'], 'N')}"
    rows = [
        ("unbalanced force", quantity(accounts["unbalanced_force"], "N", 2) + where),
        ("load less reaction", left if energy is None else f"{left}, the inertia of the net"),
    ]
    if energy is not None:
        taken = {
            "current and waves" if "waves" in figures else "current": energy["current_work"],
            "weight and loads": -energy["potential"],
            "turning added mass": energy["added_mass_work"],
        }
        if energy["inertia_work"]:
            taken["inertia of the water"] = energy["inertia_work"]
        if energy["support_work"]:
            taken["moved supports"] = energy["support_work"]
        if energy["parts_work"]:
            taken["bending and bed"] = energy["parts_work"]
        given = {
            "drag": energy["drag_dissipation"],
            "twine": energy["twine_dissipation"],
            "stored": energy["kinetic"] + energy["elastic"],
            "left over": energy["remainder"],
        }
        for what, shares in (("energy in", taken), ("energy out", given)):
            rows.append((what, ", ".join(f"{name} {quantity(one, 'J', 3)}" for name, one in shares.items())))
    return rows
