"""Units against values from their definitions, worked out by hand."""

import math

import pytest

from fyke.case import units
from fyke.case.units import UnitError, read_text


@pytest.mark.parametrize(
    ("kind", "text", "si"),
    [
        (units.LENGTH, "30 mm", 0.03),
        (units.LENGTH, "30.55 mm", 0.03055),
        (units.LENGTH, "1.5mm", 0.0015),
        (units.LENGTH, "-2.5 cm", -0.025),
        (units.LENGTH, "1e-3 km", 1.0),
        (units.LENGTH, "12 in", 0.3048),
        (units.LENGTH, "6 ft", 1.8288),
        (units.LENGTH, "1 fathom", 1.8288),
        (units.LENGTH, "250 µm", 2.5e-4),
        (units.SPEED, "3600 kn", 1852.0),
        (units.SPEED, "1 kn", 0.5144444444444445),
        (units.SPEED, "36 km/h", 10.0),
        (units.SPEED, "50 cm/s", 0.5),
        (units.SPEED, "10 ft/s", 3.048),
        (units.TIME, "20 ms", 0.02),
        (units.TIME, "1.5 h", 5400.0),
        (units.TIME, "2 min", 120.0),
        (units.PRESSURE, "1.0 GPa", 1e9),
        (units.PRESSURE, "345.37 MPa", 345.37e6),
        (units.PRESSURE, "2 N/mm²", 2e6),
        (units.DENSITY, "1.14 g/cm3", 1140.0),
        (units.DENSITY, "1025 kg/m³", 1025.0),
        (units.DENSITY, "998.2 g/l", 998.2),
        (units.LINEAR_DENSITY, "2000 tex", 2e-3),
        (units.LINEAR_DENSITY, "9000 den", 1e-3),
        (units.LINEAR_DENSITY, "23 dtex", 2.3e-6),
        (units.LINEAR_DENSITY, "1.5 ktex", 1.5e-3),
        (units.LINEAR_DENSITY, "5 g/m", 5e-3),
        (units.FORCE, "1 kgf", 9.80665),
        (units.FORCE, "2.5 kN", 2500.0),
        (units.VISCOSITY, "1.05 cSt", 1.05e-6),
        (units.VISCOSITY, "1 mm2/s", 1e-6),
        (units.ENERGY, "3 uJ", 3e-6),
        (units.ANGLE, "180 deg", math.pi),
        (units.ANGLE, "90°", math.pi / 2),
        (units.RATIO, "45 %", 0.45),
    ],
)
def test_value_in_si_is_the_nearest_double(kind, text, si):
    assert read_text(text, kind) == si


@pytest.mark.parametrize(
    ("kind", "text", "cure"),
    [
        (units.LENGTH, "30 kg", "'kg' is a unit of mass, and a length is asked"),
        (units.LENGTH, "30 kPa", "'kPa' is a unit of pressure"),
        (units.LENGTH, "30 MM", 'did you mean "30 mm"?'),
        (units.LENGTH, "3 fathoms", 'did you mean "3 fathom"?'),
        (units.PRESSURE, "1 gpa", 'did you mean "1 GPa"?'),
        (units.LENGTH, "1,5 mm", '"1.5 mm"'),
        (units.LENGTH, "30", '"30 m"'),
        (units.LENGTH, "", '"30 mm"'),
        (units.LENGTH, "nan m", '"30 mm"'),
        (units.LENGTH, "30 mm wide", "no length"),
        (units.FORCE, "2 kn", 'did you mean "2 kN"?'),
    ],
)
def test_cure_of_a_wrong_text(kind, text, cure):
    with pytest.raises(UnitError) as caught:
        read_text(text, kind)
    assert cure in caught.value.cure


def test_no_text_is_too_long_or_too_large():
    assert read_text("9e999 km", units.LENGTH) == math.inf
    for text in ("1" * 5000 + " m", "1e99999999 m"):
        with pytest.raises(UnitError):
            read_text(text, units.LENGTH)
