"""Screens: forces against the formulas of the laws, measured panels and symmetry; tangents against differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import fyke
from fyke.forces.bars import bar_geometry
from fyke.forces.screen_faces import DENSE, DENSEST, add_screens
from fyke.forces.screen_laws import in_tables
from fyke.forces.screens import Screens
from fyke.forces.surroundings import Surroundings
from fyke.forces.wetness import wet_faces
from fyke.netting.faces import Faces, faces_of
from fyke.solve.pattern import Pattern
from fyke.system.curves import HIGHEST_REYNOLDS, LOWEST_REYNOLDS
from fyke.water.laws import LAWS, PanelLaw, cylinder, joints, measured, outside
from fyke.water.laws.panels import LEE_WIDTH, Aarsnes, Balash, Fridman, KristiansenFaltinsen, Lee, Loland

SERIES = [KristiansenFaltinsen("sheet"), KristiansenFaltinsen("quasi-static")]
LAWS_OF_PANELS = [*(law() for law in LAWS["panels"].values()), *SERIES]
IN_TABLES = (KristiansenFaltinsen, Balash, Fridman)
every_law = pytest.mark.parametrize(
    "law", LAWS_OF_PANELS, ids=lambda law: f"{law.name}-{getattr(law, 'series', '')}"
)
DENSITY, VISCOSITY = 1025.0, 1.3e-6


@pytest.fixture(scope="module")
def flat():
    """A flat panel of either kind with knots, its normal along x; 0.8 m x 0.5 m."""
    twine = fyke.Twine("main", 1140.0, 2.2e-3, fyke.LinearLaw(1e9))

    def make(mesh="square", meshes=(6, 4), **options):
        lengths = {"square": 0.14, "diamond": 0.1}
        given = {"bar_length": lengths[mesh], "size": (0.8, 0.5), "knot_diameter": 5e-3, "fixed": "top"}
        return fyke.panel(twine, mesh=mesh, meshes=meshes, **(given | options))

    return make


def with_solidity(faces: Faces, solidity: float) -> Faces:
    return replace(faces, solidity=np.full(faces.count, solidity))


def one_face(solidity=0.2, area=0.04) -> Faces:
    """Return a single quadrangle of knots 0 to 3."""
    corners = np.arange(4)[None]
    ones = np.ones(1)
    return Faces(
        corners,
        np.full((1, 4), 0.25),
        area * ones,
        solidity * ones,
        2e-3 * ones,
        np.zeros(1, dtype=int),
        corners,
    )


def quadrangle(seed=0) -> np.ndarray:
    """Corners (4, 3) of a warped quadrangle of about 0.04 m2, normal near x."""
    square = np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]]) * 0.1
    return square + 0.02 * np.random.default_rng(seed).normal(size=(4, 3))


def bellied(net: fyke.Net, seed=5) -> tuple[np.ndarray, np.ndarray]:
    """Places of a panel's knots, blown out and shaken, and an uneven flow against them."""
    rng = np.random.default_rng(seed)
    x = net.positions.copy()
    x[:, 0] += 0.15 * np.cos(3.0 * x[:, 1]) * np.cos(4.0 * x[:, 2])
    x += 0.01 * rng.normal(size=x.shape)
    return x, np.array([0.5, 0.15, -0.1]) + 0.05 * rng.normal(size=x.shape)


def load(screens: Screens, x: np.ndarray, rel: np.ndarray) -> np.ndarray:
    out = np.zeros_like(x)
    screens.add_load(x, rel, out)
    return out


def by_formula(law, faces: Faces, N: np.ndarray, w: np.ndarray):
    """Force on one face by the coefficients of the law and the definitions of drag and lift; takes complex numbers."""
    area, speed = np.sqrt(N @ N), np.sqrt(w @ w)
    n, e = N / area, w / speed
    n = n if np.real(n @ e) > 0.0 else -n
    c = n @ e
    sn = faces.solidity[0] * faces.area[0] / area
    drag, lift = law.coefficients(np.arccos(c), sn, speed * faces.diameter[0] / VISCOSITY)
    on = area * sn if law.area == "twine" else area
    across = np.cross(np.cross(e, n), e)
    return 0.5 * DENSITY * on * speed**2 * (drag * e + lift * across / np.sqrt(across @ across))


# The coefficients


@every_law
@pytest.mark.parametrize("mesh", ["square", "diamond"])
def test_a_flat_panel_has_the_coefficients_of_its_law(law, mesh, flat):
    """Flow turned about two axes, from either side; tables differ by less than 1e-8."""
    net = flat(mesh)
    faces = faces_of(net)
    screens = Screens.of(faces, law, DENSITY, VISCOSITY)
    rel = 1e-8 if isinstance(law, IN_TABLES) else 1e-12
    solidity, speed = faces.solidity[0], 0.7
    for degrees in (0.0, 15.0, 30.0, 45.0, 60.0, 75.0):
        q = np.radians(degrees)
        for about, side in ((0.0, 1.0), (0.9, 1.0), (2.5, -1.0)):
            across = np.array([0.0, np.cos(about), np.sin(about)])
            w = speed * side * (np.cos(q) * np.array([1.0, 0.0, 0.0]) + np.sin(q) * across)
            total = load(screens, net.positions, np.tile(w, (net.knot_count, 1))).sum(axis=0)
            found = total / (0.5 * DENSITY * speed**2 * 0.8 * 0.5)
            drag, lift = law.coefficients(q, solidity, speed * 2.2e-3 / VISCOSITY)
            if law.area == "twine":
                drag, lift = drag * solidity, lift * solidity
            if degrees == 0.0:
                lift = 0.0  # without a side to go to
            upwards = side * (np.sin(q) * np.array([1.0, 0.0, 0.0]) - np.cos(q) * across)
            assert found @ w / speed == pytest.approx(float(drag), rel=rel)
            assert found @ upwards == pytest.approx(float(lift), rel=rel, abs=1e-15)
            assert np.linalg.norm(found) == pytest.approx(float(np.hypot(drag, lift)), rel=rel)


@pytest.mark.parametrize(
    ("law", "errors", "lifts"),
    [
        (
            KristiansenFaltinsen(),
            [3.371, 3.171, -1.015, -3.907, -11.94, -43.81],
            None,  # published with another C_N45
        ),
        (
            Aarsnes(),
            [0.7752, 3.911, 9.774, 24.56, 41.51, 25.9],
            [0.0, 0.0266, 0.04607, 0.0532, 0.04607, 0.0266],
        ),
        (
            Loland(),
            [11.84, 15.26, 21.55, 37.43, 54.98, 35.5],
            [0.0, 0.03396, 0.05882, 0.06792, 0.05882, 0.03396],
        ),
        (Fridman(), [31.37, 26.1, 8.115, -11.26, -26.25, -27.85], None),  # with another sign
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_the_measured_panel_is_missed_by_what_others_found(law, errors, lifts):
    """Patursson's panel, 1 m x 1 m, held flat in 0.5 m/s; others' coefficients are printed with four digits."""
    twine = fyke.Twine("main", 1140.0, 2.8e-3, fyke.LinearLaw(1e9))
    net = fyke.panel(twine, mesh="square", meshes=(34, 34), bar_length=0.029, size=(1.0, 1.0))
    faces = with_solidity(faces_of(net), measured.PANEL_SOLIDITY)
    assert 0.5 * 2.8e-3 / 1.002e-6 == pytest.approx(measured.PANEL_REYNOLDS, rel=1e-3)
    screens = Screens.of(faces, law, 1000.0, 1.002e-6)
    for row, (q, drag, _) in enumerate(measured.panel()):
        w = 0.5 * np.array([np.cos(q), np.sin(q), 0.0])
        x, z = (load(screens, net.positions, np.tile(w, (net.knot_count, 1))).sum(axis=0) / 125.0) @ np.array(
            [[np.cos(q), np.sin(q)], [np.sin(q), -np.cos(q)], [0.0, 0.0]]
        )
        assert 100.0 * (x / drag - 1.0) == pytest.approx(errors[row], abs=6e-3)
        if lifts is not None:
            assert z == pytest.approx(lifts[row], abs=6e-6)


@pytest.mark.parametrize(
    ("curve", "limit"), [(cylinder.KRISTIANSEN_FALTINSEN, 1e-8), (cylinder.WHITE, 1e-12)]
)
def test_tables_follow_their_curves_and_hold_their_ends(curve, limit):
    """By the drag face on of laws that are proportional to their curve."""
    face, x = one_face(), quadrangle()
    law = KristiansenFaltinsen() if curve is cylinder.KRISTIANSEN_FALTINSEN else Balash()
    re = np.geomspace(2e-6, 0.9 * HIGHEST_REYNOLDS, 5000)
    N = face.vector_area(x)[0]
    sn = 0.2 * 0.04 / np.linalg.norm(N)
    # So many faces at as many speeds, one for each number.
    p = len(re)
    faces = Faces(
        np.arange(4 * p).reshape(p, 4), np.full((p, 4), 0.25), np.full(p, 0.04), np.full(p, 0.2), np.full(p, 2e-3),
        np.zeros(p, dtype=int), np.full((p, 4), -1),
    )  # fmt: skip
    speed = re * (1.0 - sn) * VISCOSITY / 2e-3
    rel = np.repeat(speed, 4)[:, None] * N / np.linalg.norm(N)
    screens = Screens.of(faces, law, DENSITY, VISCOSITY)
    found = np.linalg.norm(screens.forces(np.tile(x, (p, 1)), rel), axis=1)
    drag, _ = law.coefficients(0.0, sn, re * (1.0 - sn))
    want = 0.5 * DENSITY * np.linalg.norm(N) * speed**2 * drag
    assert found == pytest.approx(want, rel=limit)
    assert joints.LEAST_REYNOLDS > LOWEST_REYNOLDS  # below which curves are held anyway
    beyond = screens.forces(np.tile(x, (p, 1)), 1e10 * rel)
    assert np.all(np.isfinite(beyond))


def test_laws_of_one_form_share_their_kernels(flat):
    net = flat()
    x, rel = bellied(net)
    load(Screens.of(faces_of(net), Aarsnes(), DENSITY, VISCOSITY), x, rel)
    kernels = len(add_screens.signatures)
    load(Screens.of(faces_of(net), Loland(), DENSITY, VISCOSITY), x, rel)
    assert len(add_screens.signatures) == kernels
    assert in_tables(Aarsnes().form) == Aarsnes().form


def test_a_law_without_a_formula_is_refused():
    class Own(PanelLaw):
        name = "own"

        def coefficients(self, angle, solidity=0.0, reynolds=0.0):
            return np.cos(angle), np.sin(angle)

    with pytest.raises(TypeError, match="'own' has no formula for screens"):
        Screens.of(one_face(), Own(), DENSITY, VISCOSITY)


# Symmetry and sharing


@every_law
@pytest.mark.parametrize("mesh", ["square", "diamond"])
def test_forces_turn_with_the_net_and_change_sides_with_the_flow(law, mesh, flat):
    net = flat(mesh)
    x, rel = bellied(net)
    screens = Screens.of(faces_of(net), law, DENSITY, VISCOSITY)
    turn = Rotation.from_rotvec([0.7, -1.9, 0.4]).as_matrix()
    straight = load(screens, x, rel)
    size = np.abs(straight).max()
    assert load(screens, x @ turn.T + [5.0, -3.0, 1.0], rel @ turn.T) == pytest.approx(
        straight @ turn.T, abs=1e-12 * size
    )
    assert load(screens, x, -rel) == pytest.approx(-straight, abs=1e-15 * size)


@pytest.mark.parametrize("mesh", ["square", "diamond"])
def test_shares_add_up_to_the_forces_of_the_faces_on_top_of_what_is_there(mesh, flat):
    net = flat(mesh)
    faces = faces_of(net)
    x, rel = bellied(net)
    screens = Screens.of(faces, Loland(), DENSITY, VISCOSITY)
    forces = screens.forces(x, rel)
    want = np.ones_like(x)
    for corner in range(4):
        np.add.at(want, faces.corners[:, corner], faces.share[:, corner, None] * forces)
    found = np.ones_like(x)
    screens.add_load(x, rel, found)
    assert found == pytest.approx(want, rel=1e-13)
    assert found.sum(axis=0) - net.knot_count == pytest.approx(forces.sum(axis=0), rel=1e-12)


@every_law
def test_every_face_has_the_force_of_the_formula(law, flat):
    net = flat("diamond")
    faces = faces_of(net)
    x, rel = bellied(net)
    found = Screens.of(faces, law, DENSITY, VISCOSITY).forces(x, rel)
    w = np.einsum("pc,pcq->pq", faces.share, rel[faces.corners])
    for f, N in enumerate(faces.vector_area(x)):
        one = replace(faces, area=faces.area[[f]], solidity=faces.solidity[[f]], diameter=faces.diameter[[f]])
        want = by_formula(law, one, N, w[f])
        assert found[f] == pytest.approx(want, rel=1e-8, abs=1e-8 * np.abs(want).max())


@every_law
def test_a_quadrangle_is_the_sum_of_its_quarters(law):
    """Flat, in even flow: any division into flat pieces of the same solidity bears the same force."""
    a, b, c, d = np.array([[0.0, 0.0, 0.0], [0.1, 0.3, 0.0], [0.15, 0.32, 0.25], [0.05, 0.02, 0.25]])
    grid = np.array(
        [[a, (a + b) / 2, b], [(a + d) / 2, (a + b + c + d) / 4, (b + c) / 2], [d, (c + d) / 2, c]]
    )
    corners = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
    x = grid.reshape(-1, 3)
    quarters = Faces(
        corners, np.full((4, 4), 0.25), np.full(4, 0.02), np.full(4, 0.2), np.full(4, 2e-3), np.zeros(4, dtype=int),
        corners,
    )  # fmt: skip
    whole = replace(one_face(0.2, 0.08), corners=np.array([[0, 2, 8, 6]]))
    rel = np.tile([0.4, 0.2, -0.3], (9, 1))
    small = Screens.of(quarters, law, DENSITY, VISCOSITY).forces(x, rel).sum(axis=0)
    large = Screens.of(whole, law, DENSITY, VISCOSITY).forces(x, rel)[0]
    assert np.linalg.norm(large) > 1.0
    assert small == pytest.approx(large, rel=1e-12)


# Local solidity


@every_law
def test_stretched_netting_has_the_solidity_that_is_left(law, flat):
    """Twice as wide: half the solidity on twice the area."""
    net = flat("square")
    faces = faces_of(net)
    x = net.positions * [1.0, 2.0, 1.0]
    w = np.array([0.6, 0.25, 0.1])
    rel = np.tile(w, (net.knot_count, 1))
    screens = Screens.of(faces, law, DENSITY, VISCOSITY)
    solidity, angle, reynolds = screens.local(x, rel)
    speed = np.linalg.norm(w)
    assert solidity == pytest.approx(faces.solidity / 2.0, rel=1e-13)
    assert angle == pytest.approx(np.full(24, np.arccos(0.6 / speed)), rel=1e-13)
    assert reynolds == pytest.approx(np.full(24, speed * 2.2e-3 / VISCOSITY), rel=1e-13)
    # The same netting woven so wide.
    woven = replace(faces, area=2.0 * faces.area, solidity=faces.solidity / 2.0)
    assert screens.forces(x, rel) == pytest.approx(
        Screens.of(woven, law, DENSITY, VISCOSITY).forces(x, rel), rel=1e-13
    )


def test_local_values_are_what_ranges_are_judged_by(flat):
    net = flat("square")
    screens = Screens.of(with_solidity(faces_of(net), 0.3), Loland(), DENSITY, VISCOSITY)
    rel = np.tile([0.5, 0.0, 0.0], (net.knot_count, 1))
    where = dict(zip(("solidity", "angle", "reynolds"), screens.local(net.positions, rel), strict=True))
    assert outside(screens.law, "panels", **where) == ()
    x = net.positions * [1.0, 0.75, 1.0]
    where = dict(zip(("solidity", "angle", "reynolds"), screens.local(x, rel), strict=True))
    (told,) = outside(screens.law, "panels", **where)
    assert "24 of 24 panels: solidity = 0.4, above its limit of 0.317" in told


@every_law
def test_netting_drawn_together_bears_less_and_less_and_never_nan(law):
    """Solidity is bounded, so that the force goes with the area in the end."""
    x, rel = quadrangle(), np.tile([0.5, 0.2, 0.1], (4, 1))
    screens = Screens.of(one_face(), law, DENSITY, VISCOSITY)
    sizes, bounds = [], []
    for narrow in (1e-2, 1e-4, 1e-8, 1e-160, 0.0):
        drawn = x * [1.0, narrow, 1.0] if narrow else np.zeros((4, 3))
        sizes.append(np.linalg.norm(screens.forces(drawn, rel)))
        bounds.append(screens.local(drawn, rel)[0][0])
        for tangent in screens.tangents(drawn, rel):
            assert np.all(np.isfinite(tangent))
    assert np.all(np.diff(sizes) < 0.0) or sizes[-1] == 0.0
    assert sizes[-1] == 0.0
    assert np.all(np.isfinite(sizes))
    assert DENSE < bounds[0] < bounds[1] < DENSEST
    assert bounds[-1] == pytest.approx(DENSEST)


# Smoothness


@every_law
def test_still_water_bears_nothing(law):
    x, face = quadrangle(), one_face()
    screens = Screens.of(face, law, DENSITY, VISCOSITY)
    assert np.all(screens.forces(x, np.zeros((4, 3))) == 0.0)
    for tangent in screens.tangents(x, np.zeros((4, 3))):
        assert np.all(tangent == 0.0)
    slower = [
        np.abs(screens.tangents(x, np.tile(speed * np.array([1.0, 0.3, 0.1]), (4, 1)))[1]).max()
        for speed in (1e-3, 1e-6, 1e-9, 1e-12)
    ]
    assert np.all(np.diff(slower) < 0.0) and slower[-1] < 1e-5


@every_law
def test_tangents_are_continuous_where_the_flow_changes_sides_and_face_on(law):
    """Just on either side of flow along the face, and all round its normal, where laws as published have edges."""
    x = np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]]) * 0.1
    screens = Screens.of(one_face(), law, DENSITY, VISCOSITY)
    least = 1e-9
    for w in (
        [[least, 0.5, 0.2], [-least, 0.5, 0.2]],
        [[0.5, least, 0.0], [0.5, -least, 0.0], [0.5, 0.0, least], [0.5, 0.0, 0.0]],
    ):
        tangents = [np.array([t.copy() for t in screens.tangents(x, np.tile(one, (4, 1)))]) for one in w]
        for other in tangents[1:]:
            for first, second in zip(tangents[0], other, strict=True):
                assert second == pytest.approx(first, abs=1e-4 * max(1e-3, np.abs(first).max()))


def test_lee_has_no_lift_face_on_nor_along_the_flow():
    """The polynomials leave 0.013 and 0.045 there; screens go over within 3 deg, and drag face on stays 1.155 Sn."""
    x = np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]]) * 0.1
    screens = Screens.of(one_face(), Lee(), DENSITY, VISCOSITY)
    unit = 0.5 * DENSITY * 0.04 * 0.2
    face_on = screens.forces(x, np.tile([1.0, 0.0, 0.0], (4, 1)))[0] / unit
    along = screens.forces(x, np.tile([0.0, 1.0, 0.0], (4, 1)))[0] / unit
    assert face_on == pytest.approx([1.155, 0.0, 0.0], abs=1e-12)
    assert along[[0, 2]] == pytest.approx([0.0, 0.0], abs=1e-15)
    assert along[1] == pytest.approx(float(Lee().coefficients(np.pi / 2.0)[0]), rel=1e-12)


def test_a_lost_net_is_seen_as_such():
    """NaN stays NaN, wherever tables are read."""
    screens = Screens.of(one_face(), Fridman(), DENSITY, VISCOSITY)
    x, rel = quadrangle(), np.tile([0.5, 0.2, 0.1], (4, 1))
    assert np.all(np.isnan(screens.forces(x, np.nan * rel)))
    assert np.all(np.isnan(screens.forces(np.nan * x, rel)))
    assert np.all(np.isnan(screens.tangents(x, np.nan * rel)[1]))


# Tangents


@every_law
@pytest.mark.parametrize("flow", [[0.5, 0.2, -0.1], [-0.3, 0.1, 0.3], [0.15, 0.6, -0.2]])
def test_tangents_against_the_complex_step_of_the_formula(law, flow):
    """A step of 1e-30 in N and in w through the law's own coefficients, which know nothing of tables."""
    x, face, w = quadrangle(), one_face(), np.array(flow)
    N = face.vector_area(x)[0]
    assert LEE_WIDTH < abs(N @ w) / np.linalg.norm(N) / np.linalg.norm(w) < 0.99
    screens = Screens.of(face, law, DENSITY, VISCOSITY)
    by_area, by_speed = screens.tangents(x, np.tile(w, (4, 1)))
    for q in range(3):
        step = 1e-30j * np.eye(3)[q]
        want = by_formula(law, face, N + step, w.astype(complex)).imag / 1e-30
        assert by_area[0, :, q] == pytest.approx(want, rel=1e-7, abs=1e-7 * np.abs(by_area).max())
        want = by_formula(law, face, N.astype(complex), w + step).imag / 1e-30
        assert by_speed[0, :, q] == pytest.approx(want, rel=1e-7, abs=1e-7 * np.abs(by_speed).max())


PLACES_OF_ONE = (
    (12 * 3 * np.arange(4)[None, None, :] + 3 * np.arange(4)[None, :, None]).astype(np.int64),
    np.full((1, 4), 12, dtype=np.int64),
)


def differences(screens: Screens, x: np.ndarray, rel: np.ndarray, c0: float, c1: float, step: float):
    """Return c0 (-dF/dx) + c1 (-dF/dv) by central differences, every column; v lowers rel."""
    size = x.size
    out = np.empty((size, size))
    for column in range(size):
        d = np.zeros(size)
        d[column] = step
        d = d.reshape(x.shape)
        by_x = load(screens, x + d, rel) - load(screens, x - d, rel)
        by_v = load(screens, x, rel - d) - load(screens, x, rel + d)
        out[:, column] = -(c0 * by_x + c1 * by_v).ravel() / (2.0 * step)
    return out


@every_law
@pytest.mark.parametrize(
    ("solidity", "flow"),
    [(0.2, [0.5, 0.2, 0.1]), (0.2, [0.004, 0.6, 0.2]), (0.2, [0.6, 0.01, 0.01]), (0.7, [-0.4, 0.3, 0.1])],
    ids=["open", "grazing", "face on", "dense"],
)
def test_one_face_against_differences_in_every_regime(law, solidity, flow):
    x = np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]]) * 0.1
    x[:, 1:] += 0.01 * np.random.default_rng(2).normal(size=(4, 2))
    rel = np.tile(flow, (4, 1))
    screens = Screens.of(one_face(solidity), law, DENSITY, VISCOSITY)
    data = np.zeros(144)
    screens.assemble(x, rel, 1.0, 0.4, PLACES_OF_ONE, symmetric=False, data=data)
    want = differences(screens, x, rel, 1.0, 0.4, 1e-6)
    assert data.reshape(12, 12).T == pytest.approx(want, abs=2e-6 * np.abs(want).max())


@every_law
@pytest.mark.parametrize("mesh", ["square", "diamond"])
def test_the_assembled_matrix_against_differences_of_the_load(law, mesh, flat):
    """A bellied panel hung by its top: positions, velocities and both, all of it and the symmetric part."""
    net = flat(mesh, (2, 3) if mesh == "diamond" else (3, 3), fixed="top")
    el = fyke.make_system(net).elements
    faces = faces_of(net)
    x, rel = bellied(net)
    screens = Screens.of(faces, law, DENSITY, VISCOSITY)
    pattern = Pattern.of(el, (faces.corners,))
    free = np.repeat(el.free > 0.0, 3)
    for c0, c1 in ((1.0, 0.0), (0.0, 1.0), (0.7, 0.3)):
        want = differences(screens, x, rel, c0, c1, 1e-6)[np.ix_(free, free)]
        for symmetric in (False, True):
            data = np.zeros(len(pattern.indices))
            screens.assemble(x, rel, c0, c1, pattern.groups[0], symmetric=symmetric, data=data)
            expected = 0.5 * (want + want.T) if symmetric else want
            found = pattern.matrix(data).toarray()
            assert found == pytest.approx(expected, abs=3e-7 * np.abs(want).max())
    twice = np.ones(len(pattern.indices))
    screens.assemble(x, rel, 0.7, 0.3, pattern.groups[0], symmetric=True, data=twice)
    assert twice - 1.0 == pytest.approx(data, abs=1e-12 * np.abs(data).max() + 1e-15)


# The surface


@pytest.mark.parametrize("mesh", ["square", "diamond"])
def test_netting_out_of_the_water_bears_its_wet_part(mesh, flat):
    """Hung with its middle at the surface half of it is wet, by symmetry; above the water nothing, below everything."""
    net = flat(mesh, (6, 5))
    law = fyke.Coefficients(screens=Loland())
    system = fyke.make_system(net, current=(0.5, 0.0, 0.0), coefficients=law, surface=True)
    around, still = Surroundings(system), np.zeros_like(net.positions)
    mean = 0.5 * (net.positions[:, 2].max() + net.positions[:, 2].min())
    forces = {}
    for height in (-3.0, 0.0, 3.0, -2.0):
        x = net.positions + np.array([0.0, 0.0, height - mean])
        el, u = around.at(x, still, 0.0)
        t, length, out = np.empty((net.bar_count, 3)), np.empty(net.bar_count), np.empty_like(x)
        bar_geometry(x, el, t, length)
        around.load(x, u, el, t, length, out)
        forces[height] = out[:, 0].sum()
    assert forces[-3.0] > 1.0
    assert forces[0.0] == pytest.approx(0.5 * forces[-3.0], rel=1e-12)
    assert forces[3.0] == 0.0
    assert forces[-2.0] == pytest.approx(forces[-3.0], rel=1e-14)


@pytest.mark.parametrize(("low", "high", "part"), [(-0.3, 0.1, 0.75), (-0.02, 0.18, 0.1), (0.02, 0.2, 0.0)])
def test_a_standing_face_is_wet_to_the_surface(low, high, part):
    """A rectangle of thin twine from z = low to high: both diagonals are under water by the same part."""
    z = np.array([low, low, high, high])
    out = np.empty(1)
    wet_faces(-z, np.arange(4)[None].astype(np.uint32), np.array([1e-6]), out)
    assert out[0] == pytest.approx(part, abs=1e-5)


@every_law
def test_half_a_face_bears_half_and_resists_half(law):
    x, rel = quadrangle(), np.tile([0.4, 0.2, -0.1], (4, 1))
    screens = Screens.of(one_face(), law, DENSITY, VISCOSITY)
    whole, (by_area, by_speed) = screens.forces(x, rel), (t.copy() for t in screens.tangents(x, rel))
    screens.wet[:] = 0.5
    assert np.array_equal(screens.forces(x, rel), 0.5 * whole)
    found = screens.tangents(x, rel)
    assert np.array_equal(found[0], 0.5 * by_area) and np.array_equal(found[1], 0.5 * by_speed)
    assert load(screens, x, rel).sum(axis=0) == pytest.approx(0.5 * whole[0], rel=1e-14)


# The pattern


def test_a_pattern_without_faces_is_what_it_was(flat):
    """Blocks of a square panel of one mesh held at the top: two free knots joined by one bar."""
    el = fyke.make_system(flat("square", (1, 1), fixed="top")).elements
    pattern = Pattern.of(el)
    assert pattern.size == 6
    assert pattern.matrix(np.ones(len(pattern.indices))).toarray() == pytest.approx(np.ones((6, 6)))
    assert pattern.groups == ()


@pytest.mark.parametrize(("mesh", "meshes"), [("square", (3, 4)), ("diamond", (3, 2))])
def test_a_pattern_joins_the_corners_of_faces_and_nothing_else(mesh, meshes, flat):
    net = flat(mesh, meshes, fixed="corners")
    el, faces = fyke.make_system(net).elements, faces_of(net)
    pattern = Pattern.of(el, (faces.corners,))
    joined = np.eye(net.knot_count, dtype=bool)
    for group in [*net.bars, *faces.corners]:
        joined[np.ix_(group, group)] = True
    free = pattern.free
    want = np.kron(joined[np.ix_(free, free)], np.ones((3, 3)))
    assert pattern.matrix(np.ones(len(pattern.indices))).toarray() == pytest.approx(want)
    # Every block of a face lies where its corners are.
    start, stride = pattern.groups[0]
    columns = np.repeat(np.arange(pattern.size), np.diff(pattern.indptr))
    slot = np.full(net.knot_count, -1)
    slot[free] = np.arange(len(free))
    for f, corners in enumerate(faces.corners):
        for i, row in enumerate(corners):
            for k, column in enumerate(corners):
                place = start[f, i, k]
                assert (place < 0) == (slot[row] < 0 or slot[column] < 0)
                if place >= 0:
                    last = place + 2 * stride[f, k] + 2
                    assert (pattern.indices[place], columns[place]) == (3 * slot[row], 3 * slot[column])
                    assert (pattern.indices[last], columns[last]) == (3 * slot[row] + 2, 3 * slot[column] + 2)
