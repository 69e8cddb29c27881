"""Mass of the knots: lumped masses and the added mass of the bars, which turns with them.

M_i = m_i I + sum over the bars at i of m_a (I - t t^T), with m_a half of C_a rho pi/4 d^2 l0: a bar drags water along
only when it moves across itself.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .apart import keep, kept, put, summed, take
from .around import ADDED, BAR_ROWS, BLOCK, FREE, KNOT_ROWS, MASS, PITCH, extent, neighbours, own_fields
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


# Rows of the work array of block_inverse_masses: entries of the masses, then those of one slot's bars, then rates.
_OF_BARS, _RATE = 6, 12


@njit(**OPTIONS)
def block_inverse_masses(block, old, fields, around, near, g, inverse):
    """Inverse masses of a block of knots into inverse, flat (blocks, 6, BLOCK) 1/kg, zero for held knots.

    old: row of x in fields, as forces.around lays them out; near, g: work arrays as in forces.gather. Returns the
    square of the largest rate (1/s2) at which one of their bars with added mass turns or stretches.
    """
    here, size = extent(block, around)
    mine = own_fields(old, here, here, fields, around)
    own = around.knots_row[block] * KNOT_ROWS * BLOCK
    for i in range(size):
        mass = take(around.knots, own + MASS * BLOCK + i)
        for q in range(3):
            put(g, q * PITCH + i, mass)
            put(g, (3 + q) * PITCH + i, 0.0)
        put(g, _RATE * PITCH + i, 0.0)
    for slot in range(around.first[block], around.first[block + 1]):
        begin, end = around.begin[slot], around.end[slot]
        _add_masses(slot, mine, neighbours(slot, old, here, here, fields, around, near), around, g)
        if around.both[slot]:
            for q in range(6):
                for i in range(begin, end):
                    k = q * PITCH + around.shift[slot] + i
                    put(g, k, summed(g, k) + kept(g, (_OF_BARS + q) * PITCH + i))
    fastest = 0.0
    for i in range(size):
        fastest = max(fastest, summed(g, _RATE * PITCH + i))
    for i in range(size):
        xx, yy, zz = summed(g, i), summed(g, PITCH + i), summed(g, 2 * PITCH + i)
        xy, xz, yz = summed(g, 3 * PITCH + i), summed(g, 4 * PITCH + i), summed(g, 5 * PITCH + i)
        c0 = yy * zz - yz * yz
        c1 = xz * yz - xy * zz
        c2 = xy * yz - xz * yy
        determinant = xx * c0 + xy * c1 + xz * c2
        # A held knot may have no mass.
        s = 1.0 / determinant if take(around.knots, own + FREE * BLOCK + i) > 0.0 else 0.0
        k = block * 6 * BLOCK + i
        keep(inverse, k, s * c0)
        keep(inverse, k + BLOCK, s * (xx * zz - xz * xz))
        keep(inverse, k + 2 * BLOCK, s * (xx * yy - xy * xy))
        keep(inverse, k + 3 * BLOCK, s * c1)
        keep(inverse, k + 4 * BLOCK, s * c2)
        keep(inverse, k + 5 * BLOCK, s * (xy * xz - xx * yz))
    return fastest


@njit(**OPTIONS)
def _add_masses(slot, own, others, around, g):
    """Add the added masses of one slot's bars to rows 0 to 5 of g and keep them; arguments as in gather._add_bars."""
    fields, width, x, v, _ = own
    far, pitch, far_x, far_v, _ = others
    bars, added = around.bars, (around.bars_row[slot] * BAR_ROWS + ADDED) * BLOCK
    for i in range(around.begin[slot], around.end[slot]):
        dx = take(far, far_x + i) - take(fields, x + i)
        dy = take(far, far_x + pitch + i) - take(fields, x + width + i)
        dz = take(far, far_x + 2 * pitch + i) - take(fields, x + 2 * width + i)
        p = take(far, far_v + i) - take(fields, v + i)
        q = take(far, far_v + pitch + i) - take(fields, v + width + i)
        r = take(far, far_v + 2 * pitch + i) - take(fields, v + 2 * width + i)
        m = take(bars, added + i)
        inverse_square = 1.0 / max(dx * dx + dy * dy + dz * dz, TINY_LENGTH)
        c = m * inverse_square
        rate = (p * p + q * q + r * r) * inverse_square if m > 0.0 else 0.0
        put(g, _RATE * PITCH + i, max(summed(g, _RATE * PITCH + i), rate))
        entries = (
            m - c * dx * dx,
            m - c * dy * dy,
            m - c * dz * dz,
            -c * dx * dy,
            -c * dx * dz,
            -c * dy * dz,
        )
        for k in range(6):
            put(g, k * PITCH + i, summed(g, k * PITCH + i) + entries[k])
            keep(g, (_OF_BARS + k) * PITCH + i, entries[k])


@njit(**OPTIONS)
def inertia_forces(mass, a, out):
    """M a of every knot into out (n, 3) N; mass: (n, 6) kg as mass_matrices gives it, a: (n, 3) m/s2."""
    for i in range(a.shape[0]):
        m, (p, q, r) = mass[i], a[i]
        out[i, 0] = m[0] * p + m[3] * q + m[4] * r
        out[i, 1] = m[3] * p + m[1] * q + m[5] * r
        out[i, 2] = m[4] * p + m[5] * q + m[2] * r


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
    for i in range(x.shape[0]):
        if el.free[i] > 0.0:
            largest = max(largest, _largest_eigenvalue(inverse_mass, stiffness, i, largest))
    return np.sqrt(2.0 * largest)


@njit(**OPTIONS)
def _largest_eigenvalue(left, right, i, known):
    """Bound trace(B^8)^(1/8) of the product B of symmetric matrices, rows i of left and right; 0 where below known."""
    m0, m1, m2, m3, m4, m5 = left[i]
    s0, s1, s2, s3, s4, s5 = right[i]
    trace = m0 * s0 + m1 * s1 + m2 * s2 + 2.0 * (m3 * s3 + m4 * s4 + m5 * s5)
    # No eigenvalue is negative: none is above the trace.
    if trace <= known:
        return 0.0
    c = 1.0 / trace
    m0, m1, m2, m3, m4, m5 = c * m0, c * m1, c * m2, c * m3, c * m4, c * m5
    product = _times((m0, m3, m4, m3, m1, m5, m4, m5, m2), (s0, s3, s4, s3, s1, s5, s4, s5, s2))
    square = _times(product, product)
    f = _times(square, square)
    eighth = f[0] * f[0] + f[4] * f[4] + f[8] * f[8]
    eighth += 2.0 * (f[1] * f[3] + f[2] * f[6] + f[5] * f[7])
    return trace * np.sqrt(np.sqrt(np.sqrt(eighth)))


@njit(**OPTIONS)
def _times(a, b):
    """Product of two 3 x 3 matrices, each nine numbers by rows."""
    return (
        a[0] * b[0] + a[1] * b[3] + a[2] * b[6],
        a[0] * b[1] + a[1] * b[4] + a[2] * b[7],
        a[0] * b[2] + a[1] * b[5] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[3] + a[5] * b[6],
        a[3] * b[1] + a[4] * b[4] + a[5] * b[7],
        a[3] * b[2] + a[4] * b[5] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[3] + a[8] * b[6],
        a[6] * b[1] + a[7] * b[4] + a[8] * b[7],
        a[6] * b[2] + a[7] * b[5] + a[8] * b[8],
    )
