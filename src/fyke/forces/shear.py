"""What a current that changes with height adds to the tangent of the water's load: a knot that rises meets another."""

from __future__ import annotations

from numba import njit

from .compiled import OPTIONS


@njit(**OPTIONS)
def add_shear(drag, shear, free, indptr, data):
    """Add to -dF/dx what a current u that changes with height does: -C du/dz in the columns of z.

    drag: data of C = -dF/dv, which is dF/du; shear: (n, 3) 1/s, du/dz at the knots; free, indptr: of
    solve.pattern.Pattern, to which drag and data belong.
    """
    for j in range(free.shape[0]):
        g = shear[free[j]]
        begin, stride = indptr[3 * j], indptr[3 * j + 1] - indptr[3 * j]
        for k in range(begin, begin + stride):
            data[k + 2 * stride] -= g[0] * drag[k] + g[1] * drag[k + stride] + g[2] * drag[k + 2 * stride]
