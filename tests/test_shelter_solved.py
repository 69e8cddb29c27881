"""Solved nets in the shelter of their own shape: against held shelter, by hand, in time, and how many iterations."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

import fyke
from fyke.forces.shelter import Shelter
from fyke.netting.faces import faces_of
from fyke.netting.together import together
from fyke.solve import held_shelter
from fyke.solve.equilibrium import Equilibrium
from fyke.water.laws.panels import Loland
from fyke.water.wakes import TWINES, WAKES, ChengTwines, ChengWake, GivenWake, LolandWake

TWINE = fyke.Twine("main", 1140.0, 1.5e-3, fyke.LinearLaw(1e9), damping_time=2e-5)
SPEED = 0.5
wakes = [law(0.5) if law is GivenWake else law() for law in WAKES.values()]
twines = [law() for law in TWINES.values()]


def panel(
    angle=0.0, at=(0.0, 0.0, -1.0), mesh="diamond", hung=0.9, meshes=(6, 6), name="", **options
) -> fyke.Net:
    """Panel whose normal lies at an angle (deg) to the current along x."""
    a, bars = np.radians(angle), np.sqrt(2.0) if mesh == "diamond" else 1.0
    return fyke.panel(
        options.pop("twine", TWINE),
        mesh=mesh,
        meshes=meshes,
        bar_length=0.03,
        size=tuple(hung * count * 0.03 * bars for count in meshes),
        centre=at,
        normal=(np.cos(a), np.sin(a), 0.0),
        name=name,
        **options,
    )


def row(count=2, angle=0.0, gap=0.4, **options) -> fyke.Net:
    return together([panel(angle, (i * gap, 0.0, -1.0), name=f"row {i}", **options) for i in range(count)])


def box(turn=0.0, hung=0.9, mesh="diamond") -> fyke.Net:
    """Four upright panels as the sides of a square cage."""
    half = 0.5 * hung * 6 * 0.03 * (np.sqrt(2.0) if mesh == "diamond" else 1.0)
    sides = []
    for k in range(4):
        a = np.radians(90.0 * k + turn)
        sides.append(
            panel(
                90.0 * k + turn,
                (half * np.cos(a), half * np.sin(a), -1.0),
                mesh,
                hung,
                name=f"side {k}",
            )
        )
    return together(sides)


def system(net: fyke.Net, **laws) -> fyke.System:
    return fyke.make_system(net, current=(SPEED, 0.0, 0.0), coefficients=fyke.Coefficients(**laws))


@dataclass(frozen=True)
class Held:
    """A current that has its velocity at every knot written down."""

    at_knots: np.ndarray
    steady: ClassVar[bool] = True
    uniform: ClassVar[bool] = True

    def velocity(self, points: np.ndarray, time: float) -> np.ndarray:
        return self.at_knots.copy()


nets = {
    "face on": panel(),
    "at 45": panel(45.0),
    "at 80": panel(80.0),
    "two": row(2),
    "three at 30": row(3, 30.0),
    "box": box(),
    "box at 20": box(20.0),
    "square": row(2, 20.0, mesh="square", hung=0.97),
}
every_net = pytest.mark.parametrize("net", nets.values(), ids=nets)


@every_net
@pytest.mark.parametrize(
    "laws",
    [*({"wake": wake} for wake in wakes), *({"wake": ChengWake(), "twines": law} for law in twines)],
    ids=lambda laws: "-".join(law.name for law in laws.values()),
)
def test_a_sheltered_net_rests_in_the_current_of_its_own_shape(net, laws):
    """The shelter of the shape found, written down as a current, leaves a net that knows none where it is."""
    result = fyke.solve_static(system(net, **laws), tolerance=1e-9)
    assert result.outcome.ok and result.outcome.iterations <= 30
    x = result.position[-1]
    current = np.tile([SPEED, 0.0, 0.0], (len(x), 1))
    left = Shelter(faces_of(net), laws.get("wake"), laws.get("twines")).factors(x, current)
    plain = fyke.solve_static(fyke.make_system(net, current=Held(left[:, None] * current)), tolerance=1e-9)
    taut = plain.tension[-1] > 1e-6
    joined = np.unique(net.bars[taut])
    assert np.abs((plain.position[-1] - x)[joined]).max() < 1e-6
    assert np.abs(plain.tension[-1] - result.tension[-1]).max() < 1e-6


def test_the_drag_of_panels_in_a_row_falls_with_the_square_of_what_is_left():
    """Taut stiff panels one behind the other, bars of constant coefficients: 1, 0.8^2, 0.8^4."""
    net = row(3, mesh="square", hung=1.0, twine=replace(TWINE, law=fyke.LinearLaw(1e12)))
    result = fyke.solve_static(system(net, wake=GivenWake(0.8)))
    parts = [p.knots for p in net.panels]
    drag = [result.water_force[-1][part, 0].sum() for part in parts]
    assert drag[1] / drag[0] == pytest.approx(0.8**2, rel=1e-3)
    assert drag[2] / drag[0] == pytest.approx(0.8**4, rel=1e-3)


@pytest.mark.parametrize("angle", [60, 80, 84, 86, 88])
@pytest.mark.parametrize(("mesh", "hung"), [("diamond", 0.9), ("square", 0.97)])
def test_grazing_panels_take_a_few_iterations(angle, mesh, hung):
    """Each renewal of a held shelter takes a solve of its own: 50 to 110 iterations where this takes 10 to 24."""
    result = fyke.solve_static(
        system(panel(angle, mesh=mesh, hung=hung, meshes=(12, 12)), twines=ChengTwines())
    )
    assert result.outcome.ok and "renewed" not in result.outcome.message
    assert result.outcome.iterations <= 25


@pytest.mark.parametrize("stepper", [fyke.Implicit(), fyke.Symplectic()], ids=["implicit", "symplectic"])
@pytest.mark.parametrize(
    ("net", "laws"),
    [
        ("face on", {"twines": ChengTwines()}),
        ("at 45", {"twines": ChengTwines()}),
        ("two", {"wake": LolandWake()}),
        ("two", {"wake": ChengWake(), "twines": ChengTwines()}),
    ],
)
def test_a_run_comes_to_rest_where_statics_does(net, laws, stepper):
    sheltered = system(nets[net], **laws)
    still = fyke.solve_static(sheltered, tolerance=1e-10)
    run = fyke.simulate(sheltered, duration=20.0, every=1.0, stepper=stepper, settle=fyke.Settle(force=1e-7))
    assert run.outcome.ok
    assert np.abs(run.position[-1] - still.position[-1]).max() < 1e-6


@pytest.mark.parametrize("angle", [80, 85])
def test_long_steps_close_to_rest_keep_grazing_panels_at_rest(angle):
    """Guesses without accelerations, which steps of seconds make, would leave 1e-5 N and more."""
    sheltered = system(panel(angle), twines=ChengTwines())
    run = fyke.simulate(sheltered, duration=30.0, every=1.0, stepper=fyke.Implicit())
    assert run.unbalanced_force[-1] < 2e-6


# What does not follow


dead_wake = row(2, gap=0.5, mesh="square", meshes=(12, 12))


@pytest.mark.parametrize("net", [dead_wake, box(20.0)], ids=["two", "box"])
def test_slack_netting_at_the_rim_of_a_dead_wake_is_found_by_renewals(net):
    """Nothing is left of the current: knots at the rim would step in and out of the wake for ever."""
    dead = system(net, wake=GivenWake(0.0))
    result = fyke.solve_static(dead)
    assert result.outcome.ok and "renewed" in result.outcome.message
    # In the shelter of the shape itself.
    again = Equilibrium(dead, result.state(), None)
    assert again.residual < 1e-8


def test_shelter_that_never_settles_is_named(monkeypatch):
    monkeypatch.setattr(held_shelter, "MOST_RENEWALS", 2)
    outcome = fyke.solve_static(system(dead_wake, wake=GivenWake(0.0))).outcome
    assert outcome.name == "stalled"
    assert "after 2 renewals" in outcome.message and "leave the wake out" in outcome.advice


def test_aitken_finds_a_fixed_point_that_runs_away():
    """x -> 5 - 3 x has the fixed point 1.25, from which plain renewals step away to and fro."""
    approach, x = held_shelter.Approach(), np.array([[0.0], [2.0]])
    for _ in range(12):
        x = approach.step(x, 5.0 - 3.0 * x)
    assert x == pytest.approx(1.25, abs=1e-6)


@every_net
def test_screens_and_shelter_together(net):
    sheltered = system(net, wake=LolandWake(), screens=Loland())
    result = fyke.solve_static(sheltered)
    assert result.outcome.ok and result.outcome.iterations <= 30


# Panels at random: every law in any current


def _random_law(rng: np.random.Generator, kind: str):
    from fyke.water.laws import LAWS, AngleTable, BarTable

    law = LAWS[kind][str(rng.choice(list(LAWS[kind])))]
    if law is BarTable:
        return BarTable(reynolds=(10.0, 1e3, 1e5), normal=(2.0, 1.0, 1.2), tangential=(0.2, 0.05, 0.02))
    if law is AngleTable:
        angle = np.radians([0.0, 30.0, 60.0, 90.0])
        drag, lift = 0.1 + 1.1 * np.sin(angle) ** 2, np.sin(angle) ** 2 * np.cos(angle)
        return AngleTable(
            reynolds=(10.0, 1e4),
            angle=tuple(angle),
            drag=(tuple(1.5 * drag), tuple(drag)),
            lift=(tuple(1.2 * lift), tuple(lift)),
        )
    needed = {"normal": 1.2, "tangential": 0.1, "drag": 1.0, "solidity": 0.2}
    return law(**{key: value for key, value in needed.items() if key in law.__dataclass_fields__})


def _random_current(rng: np.random.Generator):
    from fyke.water.current import UniformCurrent
    from fyke.water.profile import PowerCurrent, TableCurrent

    way = rng.normal(size=(2, 3)) * [1.0, 1.0, 0.2]
    flow = 10.0 ** rng.uniform(-1.3, 0.3) * way / np.linalg.norm(way, axis=1)[:, None]
    first = (float(flow[0, 0]), float(flow[0, 1]), float(flow[0, 2]))
    kind = rng.integers(4)
    if kind == 0:
        return UniformCurrent(first)
    if kind == 1:
        return PowerCurrent(first, 20.0, float(rng.uniform(0.1, 1.0)))
    if kind == 2:
        return TableCurrent([0.0, 2.0, 3.0, 10.0], [flow[0], flow[0], flow[1], 0.5 * flow[0]])
    return TableCurrent([0.0, 4.0], flow)


def _random_system(seed: int) -> fyke.System:
    rng = np.random.default_rng(seed)
    mesh, bar = str(rng.choice(["diamond", "square"])), 10.0 ** rng.uniform(-1.7, -0.7)
    meshes = (int(rng.integers(3, 14)), int(rng.integers(3, 14)))
    opening = rng.uniform(0.4, 1.1)
    spread = 2.0 * np.array([np.sin(opening), np.cos(opening)]) if mesh == "diamond" else np.ones(2)
    thickness = bar * 10.0 ** rng.uniform(-1.8, -1.0)
    twine = fyke.Twine(
        "any", rng.uniform(900.0, 1400.0), thickness, fyke.LinearLaw(10.0 ** rng.uniform(8, 10))
    )
    shape = {
        "mesh": mesh,
        "meshes": meshes,
        "bar_length": bar,
        "size": tuple(np.array(meshes) * spread * bar * rng.uniform(0.7, 1.0)),
        "knot_diameter": 2.0 * thickness if rng.random() < 0.5 else 0.0,
        "normal": tuple(rng.normal(size=3)),
    }
    count, gap = int(rng.choice([1, 1, 2])), rng.uniform(0.2, 2.0)
    net = together(
        [fyke.panel(twine, centre=(i * gap, 0.0, -2.5), name=f"panel {i}", **shape) for i in range(count)]
    )
    laws = {"bars": _random_law(rng, "bars"), "knots": _random_law(rng, "knots")}
    if rng.random() < 0.5:
        laws["screens"] = _random_law(rng, "panels")
    if rng.random() < 0.6:
        laws["wake"] = wakes[rng.integers(len(wakes))]
    if rng.random() < 0.5:
        laws["twines"] = ChengTwines()
    return fyke.make_system(net, current=_random_current(rng), coefficients=fyke.Coefficients(**laws))


def test_framed_panels_at_random_converge():
    """60 of them, with any law, currents of any direction and profile, and shelter."""
    iterations = []
    for seed in range(60):
        outcome = fyke.solve_static(_random_system(seed)).outcome
        assert outcome.ok, (seed, outcome)
        iterations.append(outcome.iterations)
    assert np.median(iterations) <= 16 and np.mean(np.array(iterations) > 40) <= 0.1
