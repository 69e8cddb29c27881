"""Bars as tubes and knots as balls: the triangles that programs for pictures in space ask for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SIDES = 6  # of a tube


@dataclass(frozen=True)
class Solid:
    """points: (p, 3) m; normals: (p, 3); colours: (p, 3); corners: (t, 3) triangles, or (t, 2) lines, of points."""

    points: Array
    normals: Array
    colours: Array
    corners: Indices


def tubes(start: Array, end: Array, radius: Array, colours: Array) -> Solid:
    """Make open tubes from start to end (m, 3) m with radius (m,) m and colours (m, 3)."""
    along = end - start
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = np.divide(along, length, out=np.tile([1.0, 0.0, 0.0], (len(along), 1)), where=length > 0.0)
    # The axis that the bar is least along makes a good perpendicular.
    least = np.eye(3)[np.abs(along).argmin(axis=1)]
    right = np.cross(along, least)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.cross(along, right)
    turn = 2.0 * np.pi * np.arange(SIDES) / SIDES
    ring = np.cos(turn)[:, None] * right[:, None] + np.sin(turn)[:, None] * up[:, None]
    offset = radius[:, None, None] * ring
    points = np.stack([start[:, None] + offset, end[:, None] + offset], axis=1)
    normals = np.stack([ring, ring], axis=1)
    here = np.arange(SIDES)
    after = (here + 1) % SIDES
    one = np.concatenate(
        [
            np.column_stack([here, after, here + SIDES]),
            np.column_stack([after, after + SIDES, here + SIDES]),
        ]
    )
    corners = one + 2 * SIDES * np.arange(len(start))[:, None, None]
    each = np.repeat(colours, 2 * SIDES, axis=0)
    return Solid(points.reshape(-1, 3), normals.reshape(-1, 3), each, corners.reshape(-1, 3))


def balls(centre: Array, radius: Array, colours: Array) -> Solid:
    """Make icosahedra about centres (k, 3) m with radius (k,) m and colours (k, 3), shaded as balls."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    signs = np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]]) * [1.0, golden]
    flat = np.column_stack([np.zeros(4), signs])
    tips = np.concatenate([np.roll(flat, turn, axis=1) for turn in range(3)])
    tips /= np.linalg.norm(tips, axis=1, keepdims=True)
    apart = np.linalg.norm(tips[:, None] - tips, axis=2)
    near = apart < 1.01 * apart[apart > 0.0].min()
    faces = np.array(
        [
            (a, b, c)
            for a in range(12)
            for b in range(a + 1, 12)
            for c in range(b + 1, 12)
            if near[a, b] and near[b, c] and near[a, c]
        ]
    )
    inward = np.linalg.det(tips[faces]) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    points = centre[:, None] + radius[:, None, None] * tips
    corners = faces + 12 * np.arange(len(centre))[:, None, None]
    normals = np.broadcast_to(tips, points.shape)
    return Solid(
        points.reshape(-1, 3), normals.reshape(-1, 3), np.repeat(colours, 12, axis=0), corners.reshape(-1, 3)
    )


def threads(start: Array, end: Array, colours: Array) -> Solid:
    """Make plain lines from start to end (m, 3) m with colours (m, 3)."""
    points = np.stack([start, end], axis=1).reshape(-1, 3)
    corners = np.arange(len(points)).reshape(-1, 2)
    return Solid(points, np.zeros_like(points), np.repeat(colours, 2, axis=0), corners)
