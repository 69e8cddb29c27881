"""Sparse matrices of a net and their solvers, against dense arithmetic."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fyke
from fyke.forces.bars import assemble
from fyke.solve.pattern import Pattern

TWINE = fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9))


def panel(meshes, speed=0.5, **held):
    side = 0.9 * meshes * 0.03 * np.sqrt(2.0)
    net = fyke.panel(
        TWINE, mesh="diamond", meshes=(meshes, meshes), bar_length=0.03, size=(side, side), **held
    )
    return fyke.make_system(net, current=(speed, 0.0, 0.0))


@given(
    st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)).filter(lambda p: p[0] != p[1]), max_size=20),
    st.lists(st.booleans(), min_size=7, max_size=7),
)
@settings(max_examples=60, deadline=None)
def test_pattern_puts_every_block_in_its_place(bars, held):
    """Any graph, bars repeated and ends held as they may: the sparse matrix is the sum of the bars' blocks."""
    template = panel(2).elements
    a, b = np.array(bars, dtype=np.int64).reshape(-1, 2).T
    free = np.where(held, 0.0, 1.0)
    el = template._replace(
        knot_a=a, knot_b=b, free=free, normal_drag=np.zeros(len(a)), tangential_drag=np.zeros(len(a))
    )
    block = np.random.default_rng(len(bars)).standard_normal((len(a), 3, 3))
    dense = np.zeros((7, 3, 7, 3))
    for e, (i, j) in enumerate(bars):
        for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            dense[p, :, q, :] += sign * block[e]
    kept = np.flatnonzero(free)
    expected = dense[kept][:, :, kept].reshape(3 * len(kept), 3 * len(kept))
    pattern = Pattern.of(el)
    data = np.empty(len(pattern.indices))
    t = np.tile([1.0, 0.0, 0.0], (len(a), 1))
    assemble(block, np.zeros((7, 3)), el, t, pattern.start, pattern.stride, data)
    matrix = pattern.matrix(data)
    assert matrix.has_canonical_format
    assert matrix.toarray() == pytest.approx(expected, abs=1e-14)
    for knot, (begin, stride) in zip(kept, pattern.diagonal[kept], strict=True):
        own = data[begin + stride * np.arange(3) + np.arange(3)[:, None]]
        assert own == pytest.approx(dense[knot, :, knot, :], abs=1e-14)
    assert np.all(pattern.diagonal[free == 0.0, 0] == -1)
