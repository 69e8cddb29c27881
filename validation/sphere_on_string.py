"""A steel sphere on a string in a current."""

from __future__ import annotations

import fyke
from fyke.study import Found
from lines import thread

COEFFICIENTS = fyke.Coefficients(
    bars=fyke.ConstantBar(0.0, 0.0), knots=fyke.ConstantKnot(0.47), added_mass_bar=0.0, added_mass_knot=0.0
)


def hang(stiffness, speed):
    net = fyke.line(
        thread(stiffness, diameter=1e-4),
        [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
        1.0,
        fixed=(0,),
        knot_diameter=[0.0, 0.04],
        knot_density=7850.0,
    )
    system = fyke.make_system(net, current=(speed, 0.0, 0.0), coefficients=COEFFICIENTS)
    result = fyke.solve_static(system, tolerance=1e-10)
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return result


def measure(tables):
    for row in tables["spheres"]:
        case = f"{row['speed']:g} m/s"
        # A string of stiffness k is T/k too long: two stiffnesses give the place on one that does not stretch.
        soft, stiff = hang(1e5, row["speed"]), hang(2e5, row["speed"])
        x, _, z = 2.0 * stiff.position[-1][1] - soft.position[-1][1]
        yield Found("excursion", x, row["excursion"], case)
        yield Found("depth", -z, row["depth"], case)
        yield Found("tension", stiff.tension[-1][0], row["tension"], case)
        yield Found("weight", stiff.weight_in_water, row["weight"], case)
        yield Found("drag", stiff.hydrodynamic_force[-1][0], row["drag"], case)
