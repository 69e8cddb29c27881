"""Units at the door: a text such as "30 mm" becomes a number in SI, once, when the case file is read."""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from fractions import Fraction


class UnitError(ValueError):
    """A text that is not a number and a unit of the asked kind; cure: what to write instead."""

    def __init__(self, cure: str) -> None:
        super().__init__(cure)
        self.cure = cure


@dataclass(frozen=True, eq=False)
class Kind:
    """A kind of quantity: its name, its SI unit, the size in SI of every unit, an example to write."""

    name: str
    si: str
    units: dict[str, Fraction]
    example: str


LENGTH = Kind(
    "length",
    "m",
    {
        "m": Fraction(1),
        "mm": Fraction("1e-3"),
        "cm": Fraction("1e-2"),
        "km": Fraction(1000),
        "um": Fraction("1e-6"),
        "in": Fraction("0.0254"),
        "ft": Fraction("0.3048"),
        "fathom": Fraction("1.8288"),
    },
    "30 mm",
)
SPEED = Kind(
    "speed",
    "m/s",
    {
        "m/s": Fraction(1),
        "cm/s": Fraction("1e-2"),
        "mm/s": Fraction("1e-3"),
        "kn": Fraction(1852, 3600),
        "km/h": Fraction(1000, 3600),
        "ft/s": Fraction("0.3048"),
    },
    "1.5 kn",
)
TIME = Kind(
    "time",
    "s",
    {
        "s": Fraction(1),
        "ms": Fraction("1e-3"),
        "us": Fraction("1e-6"),
        "min": Fraction(60),
        "h": Fraction(3600),
    },
    "20 ms",
)
PRESSURE = Kind(
    "pressure or modulus",
    "Pa",
    {
        "Pa": Fraction(1),
        "kPa": Fraction(10**3),
        "MPa": Fraction(10**6),
        "GPa": Fraction(10**9),
        "N/mm2": Fraction(10**6),
    },
    "1.0 GPa",
)
DENSITY = Kind(
    "density",
    "kg/m3",
    {"kg/m3": Fraction(1), "g/cm3": Fraction(1000), "g/l": Fraction(1)},
    "1.14 g/cm3",
)
FORCE = Kind(
    "force",
    "N",
    {"N": Fraction(1), "kN": Fraction(1000), "mN": Fraction("1e-3"), "kgf": Fraction("9.80665")},
    "2 kN",
)
MASS = Kind("mass", "kg", {"kg": Fraction(1), "g": Fraction("1e-3"), "t": Fraction(1000)}, "250 g")
LINEAR_DENSITY = Kind(
    "mass per length",
    "kg/m",
    {
        "tex": Fraction("1e-6"),
        "dtex": Fraction("1e-7"),
        "ktex": Fraction("1e-3"),
        "den": Fraction("1e-6") / 9,
        "g/m": Fraction("1e-3"),
        "kg/m": Fraction(1),
    },
    "2000 tex",
)
VISCOSITY = Kind(
    "kinematic viscosity",
    "m2/s",
    {"m2/s": Fraction(1), "mm2/s": Fraction("1e-6"), "cSt": Fraction("1e-6")},
    "1.0 cSt",
)
ENERGY = Kind("energy", "J", {"J": Fraction(1), "mJ": Fraction("1e-3"), "uJ": Fraction("1e-6")}, "1 uJ")
ANGLE = Kind("angle", "rad", {"deg": Fraction(math.pi) / 180, "rad": Fraction(1)}, "15 deg")
ANGULAR_SPEED = Kind(
    "angular speed",
    "rad/s",
    {"deg/s": Fraction(math.pi) / 180, "rad/s": Fraction(1), "rpm": Fraction(math.pi) / 30},
    "10 deg/s",
)
ACCELERATION = Kind("acceleration", "m/s2", {"m/s2": Fraction(1)}, "9.81 m/s2")
RATIO = Kind("ratio", "", {"%": Fraction("1e-2")}, "45 %")

KINDS = (
    LENGTH,
    SPEED,
    TIME,
    PRESSURE,
    DENSITY,
    LINEAR_DENSITY,
    FORCE,
    MASS,
    VISCOSITY,
    ENERGY,
    ANGLE,
    ANGULAR_SPEED,
    ACCELERATION,
    RATIO,
)

# Other ways of writing the same units.
_PLAIN = str.maketrans({"²": "2", "³": "3", "µ": "u", "μ": "u", "^": "", "−": "-", "\u00a0": " "})
_NUMBER_AND_UNIT = re.compile(
    r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*([^\s\d.,].*?)?\s*", re.ASCII
)
_LONGEST = 60


def read_text(text: str, kind: Kind) -> float:
    """Return the value of "number unit" in SI, rounded once; raise UnitError when it is not of this kind."""
    plain = text.translate(_PLAIN).replace("°", "deg")
    match = _NUMBER_AND_UNIT.fullmatch(plain) if len(plain) <= _LONGEST else None
    if match is None:
        raise UnitError(_cure_for_number(plain, kind))
    number, unit = match.groups()
    if unit is None:
        also = f' or with its unit, "{number} {kind.si}"' if kind.si else ""
        raise UnitError(f"write the number without quotes, {number}{also}")
    if unit not in kind.units:
        raise UnitError(_cure_for_unit(number, unit, kind))
    try:
        return float(Fraction(number) * kind.units[unit])
    except OverflowError:
        return math.inf


def _cure_for_number(text: str, kind: Kind) -> str:
    point = text.strip().replace(",", ".")
    if text.count(",") == 1 and len(text) <= _LONGEST and _NUMBER_AND_UNIT.fullmatch(point):
        return f'write the decimals after a point: "{point}"'
    return f'write a number and a unit, such as "{kind.example}"'


def _cure_for_unit(number: str, unit: str, kind: Kind) -> str:
    same_letters = [known for known in kind.units if known.casefold() == unit.casefold()]
    if same_letters:
        return f'did you mean "{number} {same_letters[0]}"?'
    for other in KINDS:
        if unit in other.units:
            return f"'{unit}' is a unit of {other.name}, and a {kind.name} is asked; " + _example(kind)
    # Two letters are too few to guess from: kg is near kn and near km.
    near = difflib.get_close_matches(unit, kind.units, n=1, cutoff=0.6) if len(unit) > 2 else []
    return f'did you mean "{number} {near[0]}"?' if near else f"'{unit}' is no {kind.name}; {_example(kind)}"


def _example(kind: Kind) -> str:
    return f'write for example "{kind.example}"'
