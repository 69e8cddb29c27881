"""A measured panel of netting, from the text of a case to the force on it: as bars, sheltered bars and screens."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

import fyke
from fyke.forces.evaluate import evaluate
from fyke.netting.faces import faces_of
from fyke.study import Found
from fyke.water.laws import measured

CASE = (Path(__file__).parent / "cases" / "patursson.toml").read_text(encoding="utf-8")
ANGLE, DRAG, LIFT = measured.panel().T
AS_MEASURED = ("29 mm", "986 mm", 34)  # bar, side and meshes; straight bars have a solidity of 0.184
AS_STATED = ("26.522 mm", "1007.836 mm", 38)  # bars that are of solidity 0.20
BARS = {
    "constant, 1.2 and 0.1; takagi": '{ law = "constant", normal = 1.2, tangential = 0.1 }',
    "choo-casarella": '"choo-casarella"',
    "kristiansen-faltinsen": '"kristiansen-faltinsen"',
    "ns-cheng": '"ns-cheng"',
}
# What a case says of drag and shelter, and of the netting.
MODELS = {
    **{f"bars, {name}": (f"bars = {law}", "off", AS_MEASURED) for name, law in BARS.items()},
    **{f"sheltered, {name}": (f"bars = {law}", "cheng", AS_MEASURED) for name, law in BARS.items()},
    **{
        f"screens, {name}": (f'kind = "screens"\nscreens = "{name}"', "off", AS_STATED)
        for name in ("kristiansen-faltinsen", "aarsnes", "loland", "fridman", "balash", "lee", "bi")
    },
    **{
        f"screens at 0.184, {name}": (f'kind = "screens"\nscreens = "{name}"', "off", AS_MEASURED)
        for name in ("kristiansen-faltinsen", "loland")
    },
}
CONSTANT, SHELTERED = (f"{kind}, constant, 1.2 and 0.1; takagi" for kind in ("bars", "sheltered"))
SCREENS = "screens, kristiansen-faltinsen"
STIFFNESSES = ('material = "PA"', 'material = "PA"\nyoungs_modulus = "40 MPa"')
BELLIED = (CONSTANT, SHELTERED, SCREENS, "screens, lee")
BELLIED_AT = (0, 3)  # which of the angles


def written(text, *changes):
    """Return the case with words changed, each of which must be there."""
    for old, new in changes:
        if old not in text:
            raise ValueError(f"'{old}' is not in the case")
        text = text.replace(old, new)
    return text


def case_of(model, angle, *more):
    """Return the case for a model, the panel turned by an angle (rad)."""
    drag, twines, (bar, side, meshes) = MODELS[model]
    return written(
        CASE,
        ('bars = { law = "constant", normal = 1.2, tangential = 0.1 }', drag),
        ('twines = "off"', f'twines = "{twines}"'),
        ('"29 mm"', f'"{bar}"'),
        ('["986 mm", "986 mm"]', f'["{side}", "{side}"]'),
        ("[34, 34]", f"[{meshes}, {meshes}]"),
        ("[1.0, 0.0, 0.0]", f"[{np.cos(angle)}, {np.sin(angle)}, 0.0]"),
        *more,
    )


def made(text):
    case = fyke.parse_case(text)
    return fyke.build_system(fyke.build_net(case), case)


def at_rest(system):
    """As built: flat, and every knot held in its place."""
    return fyke.State(0.0, system.net.positions, np.zeros_like(system.net.positions))


def over_pressure(system, force):
    """C_D and C_L, (2,): a bar stands for half a mesh of netting, a screen for itself, also along the frame."""
    net, bar = system.net, system.net.rest_length[0]
    area = faces_of(net).area.sum() if system.coefficients.screens else 0.5 * net.bar_count * bar**2
    return force[:2] / (0.5 * system.water.density * 0.5**2 * area)


@cache
def flat(model):
    """C_D and C_L of a model at the measured angles, (2, 6)."""
    systems = [made(case_of(model, angle)) for angle in ANGLE]
    return np.transpose([over_pressure(s, evaluate(s, at_rest(s)).hydrodynamic_force) for s in systems])


def error(found, true):
    return 100.0 * (found / true - 1.0)


def by_stated_solidity(twines):
    """C_D at 60 deg by more twine on the same outline, 2 d / l = 0.211 and not 0.193."""
    netting = [('"29 mm"', '"26.522 mm"'), ('["986 mm", "986 mm"]', '["901.748 mm", "901.748 mm"]')]
    system = made(case_of(CONSTANT, ANGLE[4], ('twines = "off"', f'twines = "{twines}"'), *netting))
    return over_pressure(system, evaluate(system, at_rest(system)).hydrodynamic_force)[0]


@cache
def solved(model, stiffness):
    """Largest sag (mm), largest change of C_D (%) and of C_L over the flat panel at 0 and 45 deg."""
    sag, found = [], []
    for which in BELLIED_AT:
        system = made(case_of(model, ANGLE[which], (STIFFNESSES[0], stiffness)))
        result = fyke.solve_static(system)
        if not result.outcome.ok:
            raise RuntimeError(result.outcome.message)
        sag.append(np.linalg.norm(result.position[-1] - system.net.positions, axis=1).max())
        found.append(over_pressure(system, result.hydrodynamic_force[-1]))
    drag, lift = np.transpose(found)
    before = flat(model)[:, BELLIED_AT]
    return 1e3 * max(sag), np.abs(error(drag, before[0])).max(), np.abs(lift - before[1]).max()


def measure(tables):
    degrees = np.degrees(ANGLE)
    for model in MODELS:
        found = flat(model)
        for where, drag, true in zip(degrees, found[0], DRAG, strict=True):
            key = "drag"
            if model == SCREENS and where < 50.0:
                key = "best to 30" if where < 40.0 else "best at 45"
            elif model == SHELTERED and where < 70.0:
                key = "sheltered to 60"
            elif model == CONSTANT and where < 40.0:
                key = "bars to 30"
            yield Found(key, drag, true, f"{model}, {where:.0f} deg")
        for where, lift, true in zip(degrees[1:], found[1, 1:], LIFT[1:], strict=True):
            yield Found("lift", lift, true, f"{model}, {where:.0f} deg")
    for twines, case in (("off", "bars"), ("cheng", "sheltered")):
        yield Found("more twine", by_stated_solidity(twines), DRAG[4], f"{case}, 60 deg")


def picture(found):
    """Every model's drag and lift over the points."""
    from fyke.report.laws import panel_by_angle

    shown = {
        "bars, 1.2 and 0.1": CONSTANT,
        "the same, sheltered": SHELTERED,
        "bars, ns-cheng": "bars, ns-cheng",
        "screens, kristiansen-f.": SCREENS,
        "screens, aarsnes": "screens, aarsnes",
        "screens, loland": "screens, loland",
    }
    return panel_by_angle({name: np.vstack([ANGLE, flat(model)]) for name, model in shown.items()})
