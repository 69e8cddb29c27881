"""Sparse matrices of a net and their solvers, against dense arithmetic."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fyke
from fyke.forces.bars import assemble
from fyke.solve import linear as linear_module
from fyke.solve import memory
from fyke.solve.cholesky import gmres
from fyke.solve.engines import Rslab, SuperLU
from fyke.solve.linear import Checked, SingularMatrixError, factorizer
from fyke.solve.memory import NotEnoughMemoryError
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


ENGINES = ("rslab", "superlu", "cholmod")


def solver(pattern, name):
    """The named solver, or a skip where its package is missing."""
    if name == "cholmod":
        pytest.importorskip("cvxopt")
    return factorizer(pattern, name)


class Keep:
    """Keeps the matrices of a solve."""

    name = "keep"

    def __init__(self, pattern):
        self.inner, self.data = factorizer(pattern), []

    def renew(self):
        self.inner.renew()

    def factor(self, data):
        self.data.append(data.copy())
        return self.inner.factor(data)


@pytest.fixture(scope="module")
def tangents():
    """Pattern and tangents of a static solve: the water makes them unsymmetric, the interior point stiff."""
    system = panel(8)
    keep = Keep(Pattern.of(system.elements))
    assert fyke.solve_static(system, linear=keep).outcome.ok
    return keep.inner._pattern, keep.data


@pytest.mark.parametrize("name", ENGINES)
def test_solutions_are_numpys(tangents, name):
    pattern, data = tangents
    linear = solver(pattern, name)
    for seed, values in enumerate(data):
        dense = pattern.matrix(values).toarray()
        solve = linear.factor(values)
        for right in np.random.default_rng(seed).standard_normal((2, pattern.size)):
            exact = np.linalg.solve(dense, right)
            error = np.abs(solve(right) - exact).max() / np.abs(exact).max()
            assert error <= 1e-14 * np.linalg.cond(dense)
        assert np.all(solve(np.zeros(pattern.size)) == 0.0)


@pytest.mark.parametrize("name", [*ENGINES, "rslab LU"])
def test_statics_by_every_solver_is_the_same(name):
    system = panel(6)
    pattern = Pattern.of(system.elements)
    reference = fyke.solve_static(system, tolerance=1e-10)
    linear = Checked(pattern, Rslab, name) if name == "rslab LU" else solver(pattern, name)
    result = fyke.solve_static(system, tolerance=1e-10, linear=linear)
    assert result.outcome.ok and result.outcome.linear_solver == linear.name
    assert result.position[-1] == pytest.approx(reference.position[-1], abs=1e-9)


def test_kept_pivots_are_renewed_when_they_do_harm():
    """Two matrices of one pattern; the pivots of the first are next to nothing in the second."""
    pattern = Pattern.of(panel(2).elements)
    random = np.random.default_rng(4)
    linear = factorizer(pattern, "rslab")
    good = pattern.matrix(random.normal(size=len(pattern.indices)))
    good.setdiag(100.0)
    linear.factor(good.data)(np.ones(pattern.size))
    bad = pattern.matrix(random.normal(size=len(pattern.indices)))
    bad.setdiag(1e-13)
    right = random.normal(size=pattern.size)
    exact = np.linalg.solve(bad.toarray(), right)
    assert linear.factor(bad.data)(right) == pytest.approx(exact, abs=1e-8 * np.abs(exact).max())


def loosen(pattern, values, unknown, direction):
    """Take away all that holds the knot of an unknown in a direction."""
    matrix = pattern.matrix(values).tolil()
    first = 3 * (unknown // 3)
    across = np.eye(pattern.size)
    across[first : first + 3, first : first + 3] -= np.outer(direction, direction)
    dense = across @ matrix.toarray() @ across
    columns = np.repeat(np.arange(pattern.size), np.diff(pattern.indptr))
    return dense[pattern.indices, columns]


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("direction", [(0.0, 1.0, 0.0), (0.36, 0.48, 0.8), (-0.8, 0.6, 0.0)])
def test_matrix_without_inverse_names_what_is_loose(tangents, name, direction):
    """A pivot that is zero to the bit, and ones that rounding fills."""
    pattern, data = tangents
    unknown = 3 * 37
    values = loosen(pattern, data[-1], unknown, np.array(direction))
    right = np.random.default_rng(0).standard_normal(pattern.size)
    linear = solver(pattern, name)
    with pytest.raises(SingularMatrixError) as caught:
        linear.factor(values)(right)
    largest = unknown + int(np.argmax(np.abs(direction)))
    assert caught.value.unknown == largest
    # What broke down once serves the next matrix as if nothing had been.
    exact = np.linalg.solve(pattern.matrix(data[0]).toarray(), right)
    assert linear.factor(data[0])(right) == pytest.approx(exact, rel=1e-6, abs=1e-9 * np.abs(exact).max())


def test_matrix_of_nan_has_no_inverse(tangents):
    pattern, data = tangents
    values = data[0].copy()
    values[7] = np.nan
    for name in ("rslab", "superlu"):
        with pytest.raises(SingularMatrixError) as caught:
            factorizer(pattern, name).factor(values)(np.ones(pattern.size))
        assert caught.value.unknown is None


class Sloppy:
    """An engine whose solutions are off by a given part; kept: until it is told to renew."""

    def __init__(self, pattern, part, kept=False):
        self.inner, self.part, self.kept = SuperLU(pattern), part, kept

    def forget(self):
        if self.kept:
            self.kept, self.part = False, 0.0

    def factor(self, data):
        exact = self.inner.factor(data)
        wrong = 1.0 + self.part * np.sin(np.arange(self.inner._pattern.size))
        return lambda right: wrong * exact(right)


def test_solutions_are_refined_chosen_anew_or_refused(tangents):
    pattern, data = tangents
    # In units in which the matrix is near one, so that an error of the solution is one of the residual.
    values = np.zeros_like(data[0])
    begin, stride = pattern.diagonal[pattern.free].T
    for q in range(3):
        values[begin + q * (stride + 1)] = 2.0
    right = np.cos(np.arange(pattern.size))

    def error(part, kept=False):
        solve = Checked(pattern, lambda p: Sloppy(p, part, kept), "sloppy").factor(values)
        return np.abs(solve(right) - 0.5 * right).max()

    assert 1e-10 < error(0.9e-8) < 1e-8  # good enough: left as it is
    assert error(1e-4) < 1e-8  # refined once
    assert error(1e-1, kept=True) < 1e-15  # pivots that have aged
    with pytest.raises(SingularMatrixError, match="leaves"):
        error(0.5)
    with pytest.raises(SingularMatrixError):
        error(np.nan)


def test_caller_may_fill_its_array_anew(tangents):
    """The check is against the matrix that was factorized."""
    pattern, data = tangents
    values = data[0].copy()
    right = np.ones(pattern.size)
    solve = factorizer(pattern).factor(values)
    first = solve(right)
    values[:] = data[-1]
    assert np.array_equal(solve(right), first)


@given(st.integers(1, 30), st.integers(0, 1000))
@settings(max_examples=40, deadline=None)
def test_gmres_solves_what_it_is_given(size, seed):
    random = np.random.default_rng(seed)
    matrix = np.eye(size) + 0.3 * random.standard_normal((size, size)) / np.sqrt(size)
    right = random.standard_normal(size)
    x = gmres(matrix.__matmul__, lambda r: r / np.diag(matrix), right)
    assert matrix @ x == pytest.approx(right, abs=1e-11 * np.linalg.norm(right))


def test_solver_of_another_name_is_refused(tangents):
    with pytest.raises(ValueError, match="rslab, cholmod, superlu"):
        factorizer(tangents[0], "pardiso")


@pytest.mark.parametrize(
    ("missing", "expected"), [((), "rslab KLU"), (("rslab",), "CHOLMOD"), (("rslab", "cvxopt"), "SuperLU")]
)
def test_first_solver_installed_is_taken(tangents, monkeypatch, missing, expected):
    pytest.importorskip("cvxopt")
    real = linear_module.find_spec
    monkeypatch.setattr(linear_module, "find_spec", lambda name: None if name in missing else real(name))
    assert factorizer(tangents[0]).name.startswith(expected)


@pytest.mark.parametrize("name", ENGINES)
def test_memory_is_asked_for_before_it_is_taken(monkeypatch, name):
    """The figure told lies between the factor alone, two triangles of at least the matrix, and ten times SuperLU's."""
    system = panel(40)
    pattern = Pattern.of(system.elements)
    monkeypatch.setenv("FYKE_MEMORY_GB", "1e-4")
    linear = solver(pattern, name)
    with pytest.raises(NotEnoughMemoryError) as caught:
        linear.factor(np.ones(len(pattern.indices)))
    assert caught.value.free == 1e5
    assert 8 * len(pattern.indices) / 2 < caught.value.needed < 1e9


@pytest.mark.parametrize("stepper", [None, fyke.Implicit()])
def test_net_too_large_for_the_machine_ends_as_an_outcome(monkeypatch, stepper):
    system = panel(8)
    monkeypatch.setenv("FYKE_MEMORY_GB", "1e-6")
    if stepper is None:
        result = fyke.solve_static(system)
    else:
        result = fyke.simulate(system, duration=0.1, stepper=stepper)
    outcome = result.outcome
    assert outcome.name == "out_of_memory" and not outcome.ok
    assert "1e-06 GB are free" in outcome.message and "group meshes" in outcome.advice
    assert result.position[-1] == pytest.approx(system.net.positions)


def test_free_memory_is_the_least_that_is_told(monkeypatch, tmp_path):
    monkeypatch.delenv("FYKE_MEMORY_GB", raising=False)
    (tmp_path / "memory.max").write_text("3000000\n")
    (tmp_path / "memory.current").write_text("1000000\n")
    (tmp_path / "memory.stat").write_text("anon 5\ninactive_file 250000\n")
    assert memory._left_in(tmp_path) == 2_250_000
    (tmp_path / "memory.max").write_text("max\n")
    assert memory._left_in(tmp_path) is None
    assert memory._left_in(tmp_path / "none") is None
    monkeypatch.setattr(memory, "_of_group", lambda: 5.0)
    assert memory.free_memory() == 5.0
    memory.check_memory(4.0)
    with pytest.raises(MemoryError, match="would take 6e-09 GB"):
        memory.check_memory(6.0)


def test_outcome_names_the_knot_that_nothing_holds():
    system = panel(3)
    slot = 4
    free = np.flatnonzero(system.elements.free)

    class Broken:
        name = "broken"

        def renew(self):
            pass

        def factor(self, data):
            raise SingularMatrixError("no pivot", lambda: 3 * slot + 2)

    outcome = fyke.solve_static(system, linear=Broken()).outcome
    assert outcome.name == "singular"
    assert f"nothing holds knot {system.net.labels[free[slot]]} in direction z" in outcome.message
