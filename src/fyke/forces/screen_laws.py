"""Formulas of water.laws.panels for kernels: chosen by the type of what they are given, with curves read from tables.

A kernel is compiled once for each form of law that it meets; coefficients and tables are data.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import types
from numba.extending import overload as _overload
from numba.extending import register_jitable
from numpy.typing import NDArray

from ..water.laws import panels
from ..water.laws.joints import Curve
from .apart import take
from .compiled import OPTIONS

# Its types ask for more than it does.
overload: Any = _overload

# What of the options goes down to functions within a kernel.
WITHIN: dict[str, Any] = {name: OPTIONS[name] for name in ("fastmath", "error_model")}

# Tables cut every octave of Re into 2^9 even pieces: which one and how far along it stand in the bits of the number
# (IEEE 754: 52 bits of fraction behind the exponent), so that loops that look up remain vector loops. Cubics through
# values and slopes have one continuous derivative; they differ from Kristiansen and Faltinsen's curve by less than
# 1e-8 of it, from smooth ones by less than 1e-12.
_SHIFT = 52 - 9
_MASK = (1 << _SHIFT) - 1
_ALONG = 0.5**_SHIFT
# The lowest is below water.laws.joints.LEAST_REYNOLDS, from which curves are held.
LOWEST_REYNOLDS, HIGHEST_REYNOLDS = 2.0**-20, 2.0**27
_LOWEST, _HIGHEST = (int(np.float64(re).view(np.int64)) for re in (LOWEST_REYNOLDS, HIGHEST_REYNOLDS))
_FIRST, _PIECES = _LOWEST >> _SHIFT, (_HIGHEST - _LOWEST) >> _SHIFT


class CurveTable(NamedTuple):
    """pieces: (pieces, 4) coefficients of the powers of t, 0 to 1 along each piece."""

    pieces: NDArray[np.float64]


def table_of(curve: Curve) -> CurveTable:
    """Return the table of a curve from LOWEST_REYNOLDS to HIGHEST_REYNOLDS; beyond, it is held."""
    re = ((np.arange(_PIECES + 1) + _FIRST) << _SHIFT).view(np.float64)
    value, slope, width = curve.value(re), curve.slope(re), np.diff(re)
    rise, a, b = np.diff(value), slope[:-1] * width, slope[1:] * width
    return CurveTable(np.column_stack([value[:-1], a, 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise]))


def in_tables(form: Any) -> Any:
    """Return the form of a law with tables in place of its curves."""
    curves = {name: one for name, one in form._asdict().items() if isinstance(one, Curve)}
    return form._replace(**{name: table_of(curve) for name, curve in curves.items()})


def screen(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s) by the formula of a form of law."""
    return panels.FORMULAS[type(law)](law, c, s, sn, re)


# The formulas have annotations, which numba would want here too.
@overload(screen, jit_options=WITHIN, strict=False)
def _screen_in_kernels(law, c, s, sn, re):
    return panels.FORMULAS[law.instance_class]


for _function in (panels.polynomial, panels.blunt, panels.upheld):
    register_jitable(**WITHIN)(_function)


@register_jitable(**WITHIN)
def _cubic(curve, re):
    """Value of the cubic at a Reynolds number, its derivative with t, and the bits of the number, kept to the table.

    Bits of positive numbers rise with them; NaN too is kept to the table.
    """
    bits = min(max(int(np.float64(re).view(np.int64)), _LOWEST), _HIGHEST - 1)
    row, t = 4 * ((bits >> _SHIFT) - _FIRST), (bits & _MASK) * _ALONG
    a, b = take(curve.pieces, row), take(curve.pieces, row + 1)
    c, d = take(curve.pieces, row + 2), take(curve.pieces, row + 3)
    return a + t * (b + t * (c + t * d)), b + t * (2.0 * c + t * 3.0 * d), bits


@overload(panels.at, jit_options=WITHIN)
def _at_in_kernels(curve, re):
    def value(curve, re):
        return _cubic(curve, re)[0]

    def value_and_change(curve, re):
        """Value at the real part, and the derivative times the imaginary part."""
        found, by_t, bits = _cubic(curve, re.real)
        start = bits & ~_MASK
        width = np.int64(start + _MASK + 1).view(np.float64) - np.int64(start).view(np.float64)
        slope = by_t / width if _LOWEST < bits < _HIGHEST - 1 else 0.0
        return complex(found, slope * re.imag)

    return value_and_change if isinstance(re, types.Complex) else value
