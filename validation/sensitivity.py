"""Which inputs move sag, drag and tension of the 8 x 8 panel, and by how much; and what scaling says exactly."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure

import fyke
from fyke.forces.evaluate import evaluate
from fyke.report.style import BLUE, DOUBLE_COLUMN, styled
from fyke.study import Found
from fyke.water.laws import LAWS
from panels import BAR, NYLON, SIDE, framed, settled

# Part of an input by which it is put up and down.
STEP = 0.02
OUTPUTS = ("sag", "drag", "largest tension")
UNITS = {"sag": "m", "drag": "N", "largest tension": "N"}
# Moduli of netting in the literature (Pa), from cages to ropes.
MODULI = (40e6, 62.5e6, 82e6, 182e6, 1e9, 2e9)
SEGMENTS = (1, 2, 4)


@dataclass(frozen=True)
class Inputs:
    """Inputs of the panel in SI; frame: its side over that of the example, so that the hanging ratios go with it."""

    modulus: float = 1e9
    normal_drag: float = 1.2
    tangential_drag: float = 0.1
    knot_drag: float = 1.0
    knot_size: float = 3.5e-3
    twine_size: float = 1.5e-3
    twine_density: float = 1140.0
    frame: float = 1.0
    current: float = 0.5


def outputs(inputs=Inputs(), bars=None, segments=1):
    """Sag (m), drag (N), largest tension (N)."""
    twine = replace(
        NYLON, diameter=inputs.twine_size, density=inputs.twine_density, law=fyke.LinearLaw(inputs.modulus)
    )
    coefficients = fyke.Coefficients(
        bars=bars or fyke.ConstantBar(inputs.normal_drag, inputs.tangential_drag),
        knots=fyke.ConstantKnot(inputs.knot_drag),
    )
    system = framed(
        twine=twine,
        coefficients=coefficients,
        current=(inputs.current, 0.0, 0.0),
        knot_diameter=inputs.knot_size,
        size=(inputs.frame * SIDE, inputs.frame * SIDE),
        segments=segments,
    )
    result = settled(system, tolerance=1e-10)
    return np.array(
        [result.position[-1][:, 0].max(), result.hydrodynamic_force[-1][0], result.tension[-1].max()]
    )


# Side of a frame, over the example's, in which the panel is just taut as built.
TAUT = Inputs(frame=8.0 * BAR * np.sqrt(2.0) / SIDE)
# Its answers go with these powers while its sag is small: strain with the square of the sag, and load with strain
# times modulus times sag.
TAUT_EXACT = {"modulus": (-1.0 / 3.0, 0.0, 1.0 / 3.0), "current": (2.0 / 3.0, 2.0, 4.0 / 3.0)}


def elasticity(name, base=Inputs()):
    """Change of every output in per cent for one of the input, from central differences."""
    value = getattr(base, name)
    up, down = (outputs(replace(base, **{name: value * (1.0 + way)})) for way in (STEP, -STEP))
    return np.log(up / down) / np.log((1.0 + STEP) / (1.0 - STEP))


def spread(name, cases):
    """Found of every output over the example's for some cases {name: outputs}, and the whole spread."""
    base = outputs()
    for case, found in cases.items():
        for output, ratio in zip(OUTPUTS, found / base, strict=True):
            yield Found(f"{name}, {output}", 100.0 * (ratio - 1.0), case=case)


def flat_drag(speed=0.5, normal=1.2, along=0.1, diameter=1.5e-3):
    """Drag (N) of a panel held flat in a current through it, without knots."""
    system = framed(
        twine=replace(NYLON, diameter=diameter),
        current=(speed, 0.0, 0.0),
        knot_diameter=0.0,
        coefficients=fyke.Coefficients(bars=fyke.ConstantBar(normal, along)),
    )
    start = fyke.State(0.0, system.net.positions, np.zeros_like(system.net.positions))
    return evaluate(system, start).hydrodynamic_force[0]


def similar(factor):
    """Weightless panels of which one has `factor` times the current and its square times the modulus."""
    water = fyke.Water(gravity=0.0)
    out = []
    for size in (1.0, factor):
        twine = replace(NYLON, law=fyke.LinearLaw(1e8 * size**2))
        system = framed(twine=twine, current=(0.5 * size, 0.0, 0.0), water=water)
        out.append(settled(system, tolerance=1e-11))
    return out


def measure(tables):
    for name in Inputs.__dataclass_fields__:
        for output, value in zip(OUTPUTS, elasticity(name), strict=True):
            yield Found(f"elasticity, {output}", value, case=name.replace("_", " "))
    for name, exact in TAUT_EXACT.items():
        for output, value, true in zip(OUTPUTS, elasticity(name, TAUT), exact, strict=True):
            yield Found(f"taut, {output}", value, true, name)
    yield from spread("modulus", {f"{e / 1e6:g} MPa": outputs(Inputs(modulus=e)) for e in MODULI})
    laws = {n: law() for n, law in LAWS["bars"].items() if not n.endswith("table") and n != "constant"}
    yield from spread("drag law", {name: outputs(bars=law) for name, law in laws.items()})
    yield from spread("segments", {f"{n} a bar": outputs(segments=n) for n in SEGMENTS})
    base = flat_drag()
    # By hand: every bar lies across the current, whichever way its diamond is drawn.
    bars, length = 256, SIDE / 16.0 * np.sqrt(2.0)
    yield Found("flat", base, 0.5 * 1000.0 * 1.2 * 1.5e-3 * length * bars * 0.25)
    yield Found("power", np.log2(flat_drag(speed=1.0) / base), 2.0, "current")
    yield Found("power", np.log2(flat_drag(normal=2.4) / base), 1.0, "C_n")
    yield Found("power", np.log2(flat_drag(along=0.2) / base), 0.0, "C_t")
    yield Found("power", np.log2(flat_drag(diameter=3e-3) / base), 1.0, "diameter")
    one, two = similar(2.0)
    yield Found("similar place", np.abs(one.position[-1] - two.position[-1]).max())
    yield Found(
        "similar tension", np.abs(4.0 * one.tension[-1] - two.tension[-1]).max() / two.tension[-1].max()
    )


@styled
def picture(found):
    """Elasticities as a tornado, the largest first."""
    figure = Figure(figsize=(DOUBLE_COLUMN, 2.4), layout="constrained")
    for axes, output in zip(figure.subplots(1, 3), OUTPUTS, strict=True):
        own = sorted(
            (abs(one.ours), one.case, one.ours) for one in found if one.key == f"elasticity, {output}"
        )
        axes.barh([case for _, case, _ in own], [value for *_, value in own], color=BLUE, height=0.7)
        axes.axvline(0.0, color="black", linewidth=0.8)
        axes.set(title=output, xlabel="% for 1 % of the input")
    return figure
