"""What a solution of a net's linear system leaves of the right side."""

from __future__ import annotations

import numpy as np
from numba import njit

from ..forces.compiled import OPTIONS


@njit(**OPTIONS)
def residual(data, indices, indptr, x, right, left):
    """Residual right - A x into left, all (3 n_free,); returns its Euclidean size over the right side's, NaN if one is.

    data, indices, indptr: of solve.pattern.Pattern.
    """
    left[:] = right
    for column in range(0, x.shape[0], 3):
        # Unsigned: no wrapping of negative places.
        begin, stride = np.uint64(indptr[column]), np.uint64(indptr[column + 1] - indptr[column])
        # The three columns of a knot have their entries in the same rows, which come in threes as well.
        rows = indices[begin : begin + stride]
        a = data[begin : begin + stride]
        b = data[begin + stride : begin + 2 * stride]
        c = data[begin + 2 * stride : begin + 3 * stride]
        u, v, w = x[column], x[column + 1], x[column + 2]
        for k in range(0, rows.shape[0], 3):
            knot = left[rows[k] : rows[k] + 3]
            knot[0] -= a[k] * u + b[k] * v + c[k] * w
            knot[1] -= a[k + 1] * u + b[k + 1] * v + c[k + 1] * w
            knot[2] -= a[k + 2] * u + b[k + 2] * v + c[k + 2] * w
    size, remains = 0.0, 0.0
    for i in range(x.shape[0]):
        size += right[i] * right[i]
        remains += left[i] * left[i]
    return 0.0 if remains == 0.0 else np.sqrt(remains / size)
