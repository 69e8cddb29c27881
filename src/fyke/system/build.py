"""From the case to the net, and from the net to the system."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case.schema import Case
from ..netting.faces import faces_of
from ..netting.net import Net
from ..netting.panel import panel
from ..netting.together import together
from ..netting.twine import MATERIALS, Twine
from ..water.current import Current, UniformCurrent
from ..water.laws.bars import ConstantBar
from ..water.laws.knots import ConstantKnot
from ..water.waves import Waves
from .curves import INTERVALS, NO_ANGLES, ROW, bar_curves, knot_curves
from .elements import Elements
from .laws import Coefficients, Water
from .system import Displaced, System

Array = NDArray[np.float64]

# Strain at which the secant of an elastic law stands for its stiffness where one number is needed.
REFERENCE_STRAIN = 0.01


def build_net(case: Case) -> Net:
    """Make the net of a case: all its gear, in the order of the file."""
    twines = case.twines
    parts = []
    for gear in case.gear:
        netting = case.netting[gear.netting]
        parts.append(
            panel(
                twines[netting.twine],
                mesh=netting.mesh,
                meshes=gear.meshes,
                bar_length=netting.bar_length,
                size=gear.size,
                knot_diameter=netting.knot_diameter or 0.0,
                knot_density=netting.knot_density,
                centre=gear.centre,
                normal=gear.normal,
                fixed=gear.fixed,
                name=gear.name,
            )
        )
    return together(parts)


def build_system(net: Net, case: Case) -> System:
    """Put a net into the water of a case."""
    water = case.water
    system = make_system(
        net,
        current=case.current.flow(),
        water=Water(water.density, water.kinematic_viscosity, water.gravity),
        coefficients=_coefficients(case),
        waves=None if case.waves is None else case.waves.sea(water.depth, water.gravity),
        surface=True,
    )
    return replace(system, case_text=case.text)


def _coefficients(case: Case) -> Coefficients:
    """Laws of a case. CaseError for a table of coefficients that cannot be used."""
    return Coefficients(
        bars=case.drag.bar_law(solidity=case.solidity, folder=case.folder),
        knots=case.drag.knot_law(),
        screens=case.drag.panel_law(),
        added_mass_bar=case.added_mass.bar_law(folder=case.folder),
        added_mass_knot=case.added_mass.knot_coefficient(),
        wake=case.shelter.wake_law(),
        twines=case.shelter.twine_law(),
    )


def make_system(
    net: Net,
    *,
    current: Current | tuple[float, float, float] = (0.0, 0.0, 0.0),
    water: Water | None = None,
    coefficients: Coefficients | None = None,
    waves: Waves | None = None,
    surface: bool = False,
) -> System:
    """Freeze a net in water: masses, weights and drag coefficients of every knot and bar.

    surface: the water ends at z = 0, or at the crest and trough of the waves; otherwise it is everywhere.
    """
    w = water or Water()
    c = coefficients or Coefficients()
    area = np.array([t.area for t in net.twines])[net.twine_of_bar]
    density = np.array([t.density for t in net.twines])[net.twine_of_bar]
    volume = area * net.rest_length
    knot_volume = np.pi / 6.0 * net.knot_diameter**3
    mass = _to_knots(net, density * volume) + net.knot_density * knot_volume
    sinking = _to_knots(net, (density - w.density) * volume) + (net.knot_density - w.density) * knot_volume
    weight = net.load.copy()
    weight[:, 2] -= w.gravity * sinking
    rows, first, end, stiffness = _laws(net)
    linear = bool(np.all(rows[:, 3] == 0.0) and len(rows) == len(net.twines))
    knot_mass = mass + c.added_mass_knot * w.density * knot_volume
    damping = _retardation(net, ringing(net, stiffness, knot_mass))
    elements = Elements(
        knot_a=np.ascontiguousarray(net.bars[:, 0], dtype=np.uint32),
        knot_b=np.ascontiguousarray(net.bars[:, 1], dtype=np.uint32),
        rest_length=net.rest_length.copy(),
        stiffness=stiffness,
        damping_time=damping,
        bar_added_mass=0.5 * float(c.bar_mass.coefficient(0.5 * np.pi)) * w.density * volume,
        law_rows=rows,
        law_first=first,
        law_end=end,
        linear=linear,
        damped=bool(np.any(damping > 0.0)),
        knot_mass=knot_mass,
        weight=weight,
        free=(~net.fixed).astype(float),
        **_drag(net, w, c),
    )
    flow = current if not isinstance(current, tuple) else UniformCurrent(current)
    return System(
        net,
        flow,
        elements,
        float(w.gravity * sinking.sum()),
        water=w,
        coefficients=c,
        displaced=Displaced(0.5 * w.density * volume, w.density * knot_volume),
        waves=waves,
        surface=surface or waves is not None,
        faces=faces_of(net) if c.screens or c.wake or c.twines else None,
        sources=_sources(net, c, damping),
    )


def _drag(net: Net, w: Water, c: Coefficients) -> dict[str, Any]:
    """Fields of Elements that say how the water drags."""
    bars, knots = c.bars, c.knots
    scale, disc = 0.25 * w.density * net.bar_diameter, 0.5 * w.density * np.pi / 4.0 * net.knot_diameter**2
    if c.screens is not None:
        for panel in net.panels:
            scale[slice(*panel.bars)] = 0.0
            disc[slice(*panel.knots)] = 0.0
    zeros = np.zeros(len(scale), dtype=np.int32), np.zeros(len(disc), dtype=np.int32)
    fields: dict[str, Any] = {
        "bar_reynolds": net.bar_diameter / w.kinematic_viscosity,
        "drag_slopes": np.zeros((4, 0)),
        "knot_slopes": np.zeros(0),
    }
    if isinstance(bars, ConstantBar) and isinstance(knots, ConstantKnot):
        return fields | {
            "plain": True,
            "normal_drag": scale * bars.normal,
            "tangential_drag": scale * bars.tangential,
            "knot_drag": disc * knots.drag,
            "bar_curve": zeros[0],
            "bar_curves": np.zeros((1, INTERVALS, ROW)),
            "friction": 0.0,
            "angles": NO_ANGLES,
            "knot_curve": zeros[1],
            "knot_curves": np.zeros((1, INTERVALS, 5)),
        }
    thickness, bar_curve = np.unique(net.bar_diameter, return_inverse=True)
    curves = bar_curves(bars, thickness / w.kinematic_viscosity)
    breadth, knot_curve = np.unique(net.knot_diameter, return_inverse=True)
    reference, rows = knot_curves(knots, breadth / w.kinematic_viscosity)
    return fields | {
        "plain": False,
        "normal_drag": scale * curves.reference[bar_curve],
        "tangential_drag": scale * curves.along[bar_curve],
        "knot_drag": disc * reference[knot_curve],
        "bar_curve": bar_curve.astype(np.int32),
        "bar_curves": curves.rows,
        "friction": curves.friction,
        "angles": curves.angles,
        "knot_curve": knot_curve.astype(np.int32),
        "knot_curves": rows,
    }


def ringing(net: Net, stiffness: Array, knot_mass: Array) -> Array:
    """Frequency (m,) rad/s at which the two knots of a bar would swing along it if nothing but the bar held them.

    omega^2 = k (1/m_a + 1/m_b), a held knot being heavy beyond measure; 0 between two held knots. stiffness: (m,) N/m;
    knot_mass: (n,) kg, added mass of the knot included.
    """
    moves = ~net.fixed & (knot_mass > 0.0)
    lightness = np.divide(1.0, knot_mass, out=np.zeros_like(knot_mass), where=moves)
    a, b = net.bars.T
    return np.asarray(np.sqrt(stiffness * (lightness[a] + lightness[b])))


def _retardation(net: Net, frequency: Array) -> Array:
    """Retardation time of every bar, (m,) s: the twine's, and tan delta / omega at the bar's ringing (rad/s)."""
    time = np.array([t.damping_time for t in net.twines])[net.twine_of_bar]
    loss = np.array([t.loss_factor for t in net.twines])[net.twine_of_bar]
    return np.asarray(time + np.divide(loss, frequency, out=np.zeros_like(loss), where=frequency > 0.0))


def _sources(net: Net, c: Coefficients, damping: Array) -> tuple[str, ...]:
    """One line for each law: what it says and where it comes from."""
    return (
        *_drag_sources(c),
        _mass_source(c),
        *(f"elastic law of twine '{t.name}': {t.law.describe()}" for t in net.twines),
        *(
            f"damping of twine '{t.name}': {_damping(t, damping[net.twine_of_bar == i])}"
            for i, t in enumerate(net.twines)
        ),
    )


def _drag_sources(c: Coefficients) -> tuple[str, str]:
    """One line for the bars, one for the knots."""
    bars, knots = c.bars, c.knots
    if isinstance(bars, ConstantBar):
        bar = (
            f"constant C_n = {bars.normal:g}, C_t = {bars.tangential:g} on d x length, normal and tangential "
            "parts apart (split: Choo & Casarella 1971, J. Hydronautics 5(4); values 1.2, 0.1: Bessonneau & "
            "Marichal 1998, Ocean Eng. 25(7))"
        )
    else:
        bar = f"{bars.title} ({bars.source})"
    knot = (
        f"constant C_D = {knots.drag:g} of a sphere on pi d^2/4"
        if isinstance(knots, ConstantKnot)
        else f"{knots.title} ({knots.source})"
    )
    return f"bar drag: {bar}", f"knot drag: {knot}"


def _mass_source(c: Coefficients) -> str:
    """One line for the added mass."""
    law = c.bar_mass
    bar = f"C_a = {float(law.coefficient(0.0)):g}" if law.constant else f"{law.title} ({law.source})"
    return f"added mass: {bar} across a bar, {c.added_mass_knot:g} of a knot (potential flow: cylinder 1, sphere 1/2)"


def _damping(twine: Twine, time: Array) -> str:
    """Say what damps the bars of a twine, whose retardation times (s) are these."""
    longest = float(time.max(initial=0.0))
    if longest == 0.0:
        return "none"
    said = f"Kelvin-Voigt, retardation time {longest:.3g} s"
    if twine.loss_factor == 0.0:
        return said
    said += f" at most, of it loss factor {twine.loss_factor:g} over the frequency of each bar's ringing"
    material = MATERIALS.get(twine.material)
    return (
        f"{said} ({material.loss_source})" if material and material.loss_factor == twine.loss_factor else said
    )


def _to_knots(net: Net, per_bar: Array) -> Array:
    """Half of a bar's share to each end, (n,)."""
    out = np.zeros(net.knot_count)
    np.add.at(out, net.bars, 0.5 * per_bar[:, None])
    return out


def _laws(net: Net) -> tuple[Array, NDArray[np.int32], NDArray[np.int32], Array]:
    """Rows of all twines' laws, first and end row of every bar, and stiffness (N/m) of every bar."""
    tables = [t.law.rows(t.diameter) for t in net.twines]
    end = np.cumsum([len(t) for t in tables])
    first = end - [len(t) for t in tables]
    secant = np.array([_tension(t, REFERENCE_STRAIN) / REFERENCE_STRAIN for t in tables])
    which = net.twine_of_bar
    return (
        np.concatenate(tables),
        first[which].astype(np.int32),
        end[which].astype(np.int32),
        secant[which] / net.rest_length,
    )


def _tension(rows: Array, strain: float) -> float:
    """Tension (N) at one strain > 0 by the rows of netting.elastic."""
    row = rows[np.searchsorted(rows[:, 0], strain, side="right") - 1]
    x = strain - row[0]
    return float(row[1] + row[2] * x + row[3] * x ** row[4])
