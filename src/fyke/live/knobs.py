"""What of a case can be moved while one looks at it: each with its unit, range and place in the case."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..case.box import BoxSpec
from ..case.gear import FlatSpec, Part
from ..case.rigging import BodiesSpec
from ..case.schema import Case
from ..case.shapes import RoundSpec

Values = Mapping[str, float]
Raw = dict[str, Any]

# Ranges that slider of a length offers, over the value of the case, and in how many steps.
LEAST, MOST, STEPS = 0.4, 2.0, 400
FASTEST = 3.0  # m/s, of the slider of speed, unless the case is faster
SOFTEST, STIFFEST = 0.05, 10.0  # GPa; published moduli of netting lie between 0.04 and 2


@dataclass(frozen=True)
class Knob:
    """One value that a slider moves.

    key: its name; group, label, unit: as shown; low, high, step, value: in the shown unit; write: puts it into the
    tables of a case, given the shown values of all knobs.
    """

    key: str
    group: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    value: float
    write: Callable[[Raw, Values], None]


def knobs_of(case: Case) -> tuple[Knob, ...]:
    """Return the knobs of a case, in the order of the case file."""
    knobs = [*_current(case)]
    for name in case.twine:
        knobs += _twine(case, name)
    for name in case.netting:
        knobs += _netting(case, name)
    for index, part in enumerate(case.gear):
        if isinstance(part, FlatSpec):
            knobs += _panel(part, index)
        elif isinstance(part, BoxSpec):
            knobs += _ratio(part.hanging_ratio, index, _group(part))
        elif isinstance(part, RoundSpec):
            knobs += _round(part, index)
        elif isinstance(part, BodiesSpec):
            knobs += _bodies(part, index)
    return tuple(knobs)


def turned(raw: Raw, knobs: tuple[Knob, ...], values: Values) -> Raw:
    """Return the tables of a case with the values of all knobs written in."""
    out = copy.deepcopy(raw)
    for knob in knobs:
        if values[knob.key] != knob.value:
            knob.write(out, values)
    return out


def _current(case: Case) -> list[Knob]:
    if not case.current.is_one_velocity:
        return []  # no slider moves a whole profile
    velocity = np.array(case.current.at_surface)
    speed = float(np.linalg.norm(velocity))
    level = float(np.hypot(velocity[0], velocity[1]))
    azimuth = float(np.degrees(np.arctan2(velocity[1], velocity[0])))
    elevation = float(np.degrees(np.arctan2(velocity[2], level)))

    def write(raw: Raw, values: Values) -> None:
        a, e = np.radians(values["current.direction"]), np.radians(values["current.rise"])
        unit = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        # What is only rounding of a right angle is nothing.
        unit[np.abs(unit) < 1e-15] = 0.0
        for key in ("speed", "direction"):
            raw["current"].pop(key, None)
        raw["current"]["velocity"] = (values["current.speed"] * unit).tolist()

    top = max(FASTEST, 2.0 * speed)
    return [
        Knob("current.speed", "Current", "Speed", "m/s", 0.0, top, 0.01, speed, write),
        Knob("current.direction", "Current", "Direction", "deg", -180.0, 180.0, 1.0, azimuth, write),
        Knob("current.rise", "Current", "Rise", "deg", -90.0, 90.0, 1.0, elevation, write),
    ]


def _range(value: float) -> tuple[float, float, float]:
    """Low, high and a round step around a value."""
    step = 10.0 ** np.floor(np.log10((MOST - LEAST) * value / STEPS))
    return float(round(LEAST * value / step) * step), float(round(MOST * value / step) * step), float(step)


def _length(key: str, group: str, label: str, value: float, put: Callable[[Raw, float], None]) -> Knob:
    """Return the knob of a length (m), shown in mm."""
    shown = round(1e3 * value, 9)
    return Knob(
        key, group, label, "mm", *_range(shown), shown, lambda raw, values: put(raw, 1e-3 * values[key])
    )


def _twine(case: Case, name: str) -> list[Knob]:
    spec, key = case.twine[name], f"twine.{name}"
    group = "Twine" if len(case.twine) == 1 else f"Twine {name}"

    def put(raw: Raw, value: float) -> None:
        raw["twine"][name]["diameter"] = value

    # A diameter from rtex keeps to it, and a diameter besides rtex to the fibre that must fit in.
    knobs = [] if spec.rtex else [_length(f"{key}.diameter", group, "Diameter", spec.diameter, put)]
    modulus = getattr(spec.resolved_law, "youngs_modulus", None)
    if modulus is not None and spec.law is None:
        shown = modulus / 1e9

        def write(raw: Raw, values: Values) -> None:
            raw["twine"][name]["youngs_modulus"] = 1e9 * values[f"{key}.modulus"]

        low, high = min(SOFTEST, shown), max(STIFFEST, shown)
        knobs.append(Knob(f"{key}.modulus", group, "Modulus", "GPa", low, high, 0.05, shown, write))
    return knobs


def _netting(case: Case, name: str) -> list[Knob]:
    spec, key = case.netting[name], f"netting.{name}"
    group = "Netting" if len(case.netting) == 1 else f"Netting {name}"

    def put_bar(raw: Raw, value: float) -> None:
        raw["netting"][name]["bar_length"] = value

    def put_knot(raw: Raw, value: float) -> None:
        raw["netting"][name]["knot_diameter"] = value

    knobs = [_length(f"{key}.bar_length", group, "Bar length", spec.bar_length, put_bar)]
    if spec.knot_diameter:
        knobs.append(_length(f"{key}.knot_diameter", group, "Knot diameter", spec.knot_diameter, put_knot))
    return knobs


def _put(index: int, name: str) -> Callable[[Raw, float], None]:
    """Return what writes a key of a part of the gear."""

    def put(raw: Raw, value: float) -> None:
        raw["gear"][index][name] = value

    return put


def _panel(spec: FlatSpec, index: int) -> list[Knob]:
    key, group = f"gear.{index}", _group(spec)
    if spec.given_size is None:
        return _ratio(spec.hanging_ratio, index, group)

    def side(which: int, label: str) -> Knob:
        def put(raw: Raw, value: float) -> None:
            size = raw["gear"][index]["size"] = list(raw["gear"][index]["size"])
            size[which] = value

        return _length(f"{key}.{label}", group, f"Frame {label}", spec.size[which], put)

    return [side(0, "width"), side(1, "height")]


def _round(spec: RoundSpec, index: int) -> list[Knob]:
    """Sizes of netting round an axis; those of a frustum's two rims stay as they are."""
    group = _group(spec)
    sizes = [(name, getattr(spec, name)) for name in ("diameter", "height")]
    knobs = [
        _length(f"gear.{index}.{name}", group, name.capitalize(), value, _put(index, name))
        for name, value in sizes
        if isinstance(value, float)
    ]
    return knobs or _ratio(getattr(spec, "hanging_ratio", None), index, group)


def _ratio(ratio: float | tuple[float, float] | None, index: int, group: str) -> list[Knob]:
    key = f"gear.{index}.ratio"
    if not isinstance(ratio, float):
        return []

    def write(raw: Raw, values: Values) -> None:
        raw["gear"][index]["hanging_ratio"] = values[key]

    return [Knob(key, group, "Hanging ratio E1", "", 0.05, 0.95, 0.005, ratio, write)]


def _bodies(spec: BodiesSpec, index: int) -> list[Knob]:
    """The force in water of each float or sinker, where it is given."""
    if spec.force is None:
        return []
    word = "weight" if spec.kind == "sinkers" else "buoyancy"
    key, put = f"gear.{index}.{word}", _put(index, word)
    low, high, step = _range(spec.force)

    def write(raw: Raw, values: Values) -> None:
        put(raw, values[key])

    return [Knob(key, _group(spec), f"{word.capitalize()} of each", "N", low, high, step, spec.force, write)]


def _group(spec: Part) -> str:
    return f"{spec.kind.capitalize()} {spec.name}".rstrip()
