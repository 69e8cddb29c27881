"""Formulas of water.laws.panels for kernels: chosen by the type of what they are given, with curves read from tables.

A kernel is compiled once for each form of law that it meets; coefficients and tables are data.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import overload as _overload
from numba.extending import register_jitable

from ..system.curves import curve_of
from ..water.laws import panels
from ..water.laws.joints import Curve
from .compiled import WITHIN
from .cubics import cubic

# Its types ask for more than it does.
overload: Any = _overload


def in_tables(form: Any) -> Any:
    """Return the form of a law with curves of system.curves, (INTERVALS, 4), in place of its own."""
    curves = {name: one for name, one in form._asdict().items() if isinstance(one, Curve)}
    return form._replace(**{name: curve_of(one.value, one.slope) for name, one in curves.items()})


def screen(law: Any, c: Any, s: Any, sn: Any, re: Any) -> Any:
    """Return C_D and C_L / (c s) by the formula of a form of law."""
    return panels.FORMULAS[type(law)](law, c, s, sn, re)


# The formulas have annotations, which numba would want here too.
@overload(screen, jit_options=WITHIN, strict=False)
def _screen_in_kernels(law, c, s, sn, re):
    return panels.FORMULAS[law.instance_class]


for _function in (panels.polynomial, panels.blunt, panels.upheld):
    register_jitable(**WITHIN)(_function)


@overload(panels.at, jit_options=WITHIN)
def _at_in_kernels(curve, re):
    def value(curve, re):
        return cubic(curve, re * re)[0]

    def value_and_change(curve, re):
        """Value at the real part, and the derivative times the imaginary part."""
        found, by_square = cubic(curve, re.real * re.real)
        return complex(found, 2.0 * re.real * by_square * re.imag)

    return value_and_change if isinstance(re, types.Complex) else value
