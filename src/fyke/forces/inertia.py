"""Mass of the knots: lumped masses and the added mass of the bars, which turns with them.

M_i = m_i I + sum over the bars at i of m_a (I - t t^T), with m_a half of C_a rho pi/4 d^2 l0: a bar drags water along
only when it moves across itself.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .around import ADDED, FREE, MASS, differences, extent
from .compiled import OPTIONS
from .total import TINY_LENGTH

# Places of the symmetric 3 x 3 entries xx, yy, zz, xy, xz, yz in a row of six.


@njit(**OPTIONS)
def mass_matrices(x, el, out):
    """Mass of every knot into out (n, 6) kg, symmetric entries xx, yy, zz, xy, xz, yz."""
    for i in range(x.shape[0]):
        out[i, 0] = out[i, 1] = out[i, 2] = el.knot_mass[i]
        out[i, 3] = out[i, 4] = out[i, 5] = 0.0
    for e in range(el.knot_a.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        m = el.bar_added_mass[e]
        c = m / max(dx * dx + dy * dy + dz * dz, TINY_LENGTH)
        xx, yy, zz = m - c * dx * dx, m - c * dy * dy, m - c * dz * dz
        xy, xz, yz = -c * dx * dy, -c * dx * dz, -c * dy * dz
        for i in (a, b):
            out[i, 0] += xx
            out[i, 1] += yy
            out[i, 2] += zz
            out[i, 3] += xy
            out[i, 4] += xz
            out[i, 5] += yz


@njit(**OPTIONS)
def invert_masses(mass, free):
    """Invert symmetric matrices (n, 6) in place; zero for the held knots, so that they do not move."""
    for i in range(mass.shape[0]):
        if free[i] == 0.0:
            mass[i, :] = 0.0
            continue
        xx, yy, zz, xy, xz, yz = mass[i]
        c0 = yy * zz - yz * yz
        c1 = xz * yz - xy * zz
        c2 = xy * yz - xz * yy
        s = 1.0 / (xx * c0 + xy * c1 + xz * c2)
        mass[i, 0] = s * c0
        mass[i, 1] = s * (xx * zz - xz * xz)
        mass[i, 2] = s * (xx * yy - xy * xy)
        mass[i, 3] = s * c1
        mass[i, 4] = s * c2
        mass[i, 5] = s * (xy * xz - xx * yz)


@njit(**OPTIONS)
def block_inverse_masses(block, x, v, around, g, inverse):
    """Inverse masses of a block of knots into inverse (6, blocks x BLOCK) 1/kg, zero for held knots.

    x, v: (3, width) as forces.around lays them out; g: work array. Returns the square of the largest rate (1/s2) at
    which one of their bars with added mass turns or stretches.
    """
    here, size = extent(block, around)
    own = around.knots_row[block]
    for i in range(size):
        g[0, i] = g[1, i] = g[2, i] = around.knots[own, MASS, i]
        g[3, i] = g[4, i] = g[5, i] = g[12, i] = 0.0
    for slot in range(around.first[block], around.first[block + 1]):
        differences(slot, here, size, x, around, g, 6)
        differences(slot, here, size, v, around, g, 9)
        bar = around.bars_row[slot]
        for i in range(size):
            dx, dy, dz, p, q, r = g[6, i], g[7, i], g[8, i], g[9, i], g[10, i], g[11, i]
            m = around.bars[bar, ADDED, i]
            inverse_square = 1.0 / max(dx * dx + dy * dy + dz * dz, TINY_LENGTH)
            c = m * inverse_square
            rate = (p * p + q * q + r * r) * inverse_square if m > 0.0 else 0.0
            g[12, i] = max(g[12, i], rate)
            g[0, i] += m - c * dx * dx
            g[1, i] += m - c * dy * dy
            g[2, i] += m - c * dz * dz
            g[3, i] -= c * dx * dy
            g[4, i] -= c * dx * dz
            g[5, i] -= c * dy * dz
    fastest = 0.0
    for i in range(size):
        fastest = max(fastest, g[12, i])
        g[12, i] = 0.0
    low = here - np.uint64(around.margin)
    for i in range(size):
        xx, yy, zz, xy, xz, yz = g[0, i], g[1, i], g[2, i], g[3, i], g[4, i], g[5, i]
        c0 = yy * zz - yz * yz
        c1 = xz * yz - xy * zz
        c2 = xy * yz - xz * yy
        determinant = xx * c0 + xy * c1 + xz * c2
        # A held knot may have no mass.
        s = 1.0 / determinant if around.knots[own, FREE, i] > 0.0 else 0.0
        inverse[0, low + i] = s * c0
        inverse[1, low + i] = s * (xx * zz - xz * xz)
        inverse[2, low + i] = s * (xx * yy - xy * xy)
        inverse[3, low + i] = s * c1
        inverse[4, low + i] = s * c2
        inverse[5, low + i] = s * (xy * xz - xx * yz)
    return fastest


@njit(**OPTIONS)
def kinetic_energy(mass, v):
    """Half of sum v.M v (J); mass: (n, 6) kg as mass_matrices gives it."""
    total = 0.0
    for i in range(v.shape[0]):
        p, q, r = v[i]
        total += mass[i, 0] * p * p + mass[i, 1] * q * q + mass[i, 2] * r * r
        total += 2.0 * (mass[i, 3] * p * q + mass[i, 4] * p * r + mass[i, 5] * q * r)
    return 0.5 * total


@njit(**OPTIONS)
def largest_frequency(x, k, inverse_mass, el):
    """Upper bound of the largest circular frequency (rad/s) of the net with all its bars taut.

    k: (m,) N/m; inverse_mass: (n, 6) 1/kg. From v.K v = sum k (t.(v_b - v_a))^2 <= 2 sum k ((t.v_a)^2 + (t.v_b)^2)
    follows omega^2 <= 2 max_i lambda(B_i), B_i = M_i^-1 sum over the bars at i of k t t^T; exact on a square lattice,
    where it is 4 k/m. lambda <= trace(B^8)^(1/8), at most 3^(1/16) = 1.07 times too large in omega.
    """
    stiffness = np.zeros((x.shape[0], 6))
    for e in range(k.shape[0]):
        a, b = el.knot_a[e], el.knot_b[e]
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        c = k[e] / max(dx * dx + dy * dy + dz * dz, TINY_LENGTH)
        for i in (a, b):
            stiffness[i, 0] += c * dx * dx
            stiffness[i, 1] += c * dy * dy
            stiffness[i, 2] += c * dz * dz
            stiffness[i, 3] += c * dx * dy
            stiffness[i, 4] += c * dx * dz
            stiffness[i, 5] += c * dy * dz
    largest = 0.0
    m, s = np.zeros((3, 3)), np.zeros((3, 3))
    for i in range(x.shape[0]):
        if el.free[i] > 0.0:
            _unpack(inverse_mass[i], m)
            _unpack(stiffness[i], s)
            product = _times(m, s)
            trace = product[0, 0] + product[1, 1] + product[2, 2]
            if trace > 0.0:
                square = _times(product / trace, product / trace)
                fourth = _times(square, square)
                eighth = 0.0
                for p in range(3):
                    for q in range(3):
                        eighth += fourth[p, q] * fourth[q, p]
                largest = max(largest, trace * eighth**0.125)
    return np.sqrt(2.0 * largest)


@njit(**OPTIONS)
def _unpack(row, out):
    out[0, 0], out[1, 1], out[2, 2] = row[0], row[1], row[2]
    out[0, 1] = out[1, 0] = row[3]
    out[0, 2] = out[2, 0] = row[4]
    out[1, 2] = out[2, 1] = row[5]


@njit(**OPTIONS)
def _times(a, b):
    out = np.zeros((3, 3))
    for p in range(3):
        for q in range(3):
            out[p, q] = a[p, 0] * b[0, q] + a[p, 1] * b[1, q] + a[p, 2] * b[2, q]
    return out
