"""The summary and the tables: contract, hand-computed figures, and files read by other programs."""

import csv
import dataclasses
import hashlib
import json
import math

import numpy as np
import pytest

from fyke.forces.frame import Frame
from fyke.netting.line import line
from fyke.results import summary, write_summary, write_tables
from fyke.solve.result import Result
from test_results_store import CASE, OUTCOME, TWINE, make_frame, make_result

CONTRACT = [
    *("title", "outcome", "solver", "linear_solver", "iterations", "factorizations", "residual", "wall_time"),
    *("knots", "bars", "support_reaction", "hydrodynamic_force", "weight_in_water", "max_tension"),
    *("max_tension_bar", "slack_bars", "max_displacement", "version", "case_sha256"),
]


def bent_line(tension=(30.0, 0.0)):
    """Three knots 3 m and 2 m apart; the middle one has moved by (0, 4, 0), so bars of 5 m and sqrt(20) m."""
    net = line(TWINE, [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [5.0, 0.0, 0.0]], [4.0, 5.0])
    frame = Frame(
        time=0.0,
        position=np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [5.0, 0.0, 0.0]]),
        velocity=np.zeros((3, 3)),
        tension=np.array(tension),
        bar_drag=np.zeros(2),
        bar_lift=np.zeros(2),
        water_velocity=np.zeros((2, 3)),
        water_force=np.zeros((3, 3)),
        hydrodynamic_force=np.array([6.0, 8.0, 24.0]),
        support_reaction=np.array([6.0, 8.0, 20.0]),
        kinetic_energy=0.0,
        unbalanced_force=1e-9,
    )
    outcome = dataclasses.replace(OUTCOME, name="converged", time=0.0)
    return Result.from_frames(net, outcome, 4.0, [frame], CASE)


def test_the_summary_begins_with_the_keys_of_the_contract():
    assert list(summary(make_result()))[: len(CONTRACT)] == CONTRACT


def test_the_figures_of_a_bent_line_are_those_by_hand():
    figures = summary(bent_line(), flow_direction=(2.0, 0.0, 0.0))
    assert figures["title"] == "Flume panel, 4 °C"
    assert figures["outcome"] == "converged"
    assert (figures["knots"], figures["bars"], figures["slack_bars"]) == (3, 2, 1)
    assert (figures["max_tension"], figures["max_tension_bar"]) == (30.0, 0)
    assert figures["max_tension_bar_label"] == "0 to 1"
    assert figures["max_displacement"] == 4.0
    assert figures["max_strain"] == 0.25
    assert figures["drag"] == 6.0
    assert figures["lift"] == pytest.approx(math.sqrt(8.0**2 + 24.0**2), rel=1e-15)
    assert figures["support_reaction"] == [6.0, 8.0, 20.0]
    assert figures["weight_in_water"] == 4.0
    assert figures["case_sha256"] == hashlib.sha256(CASE.encode()).hexdigest()
    assert figures["time"] is None
    assert (figures["rejected"], figures["force_evaluations"]) == (7, 9876)


def test_the_current_may_come_from_anywhere():
    figures = summary(bent_line(), flow_direction=(3.0, 4.0, 0.0))
    assert figures["drag"] == pytest.approx(6.0 * 0.6 + 8.0 * 0.8, rel=1e-15)
    assert figures["lift"] == pytest.approx(24.0, rel=1e-15)
    assert summary(bent_line(), flow_direction=(0.0, 0.0, 0.0))["drag"] is None
    assert summary(bent_line())["lift"] is None


def test_a_slack_net_has_no_bar_of_largest_tension():
    figures = summary(bent_line(tension=(0.0, 0.0)))
    assert figures["max_tension"] == 0.0
    assert figures["max_tension_bar"] is None
    assert figures["slack_bars"] == 2


def test_a_given_title_and_hash_go_before_those_of_the_case_text():
    figures = summary(make_result(), title="Mine", case_sha256="ab12")
    assert (figures["title"], figures["case_sha256"], figures["time"]) == ("Mine", "ab12", 2.0)


def test_the_summary_is_plain_json_even_when_the_solve_went_wrong(tmp_path):
    outcome = dataclasses.replace(OUTCOME, name="not_finite", residual=math.nan, wall_time=math.inf)
    figures = summary(dataclasses.replace(make_result(), outcome=outcome))

    def refuse(name):
        raise AssertionError(f"{name} is not JSON")

    path = write_summary(figures, tmp_path / "out")
    read = json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)
    assert list(read) == list(figures)
    assert read["residual"] is None
    assert read["title"] == "Flume panel, 4 °C"
    assert read["warnings"] == list(OUTCOME.warnings)
    assert [p.name for p in path.parent.iterdir()] == ["summary.json"]


def test_the_tables_hold_every_knot_and_bar_to_the_last_digit(tmp_path):
    rng = np.random.default_rng(4)
    result = make_result()
    net = result.net
    frame = dataclasses.replace(
        make_frame(net, 0),
        position=net.positions + rng.normal(size=net.positions.shape),
        tension=rng.uniform(0.0, 1e-3, net.bar_count),
    )
    knots_csv, bars_csv = write_tables(Result.from_frames(net, OUTCOME, 0.0, [frame]), tmp_path / "out")
    assert knots_csv.read_text().splitlines()[0] == "knot,label,fixed,x0,y0,z0,x,y,z"
    assert bars_csv.read_text().splitlines()[0] == "bar,knot_a,knot_b,rest_length,length,tension"
    with knots_csv.open(newline="") as file:
        knots = list(csv.DictReader(file))
    assert [row["knot"] for row in knots] == [str(i) for i in range(net.knot_count)]
    assert [row["label"] for row in knots] == list(net.labels)
    assert [row["fixed"] == "1" for row in knots] == net.fixed.tolist()
    assert {row["fixed"] for row in knots} == {"0", "1"}
    np.testing.assert_array_equal([[float(r[k]) for k in ("x0", "y0", "z0")] for r in knots], net.positions)
    np.testing.assert_array_equal([[float(r[k]) for k in ("x", "y", "z")] for r in knots], frame.position)
    bars = np.genfromtxt(bars_csv, delimiter=",", names=True)
    np.testing.assert_array_equal(bars["bar"], np.arange(net.bar_count))
    np.testing.assert_array_equal(np.column_stack([bars["knot_a"], bars["knot_b"]]), net.bars)
    np.testing.assert_array_equal(bars["rest_length"], net.rest_length)
    np.testing.assert_array_equal(bars["tension"], frame.tension)
    first = math.dist(frame.position[net.bars[0, 0]], frame.position[net.bars[0, 1]])
    assert bars["length"][0] == pytest.approx(first, rel=1e-14)
    assert sorted(p.name for p in knots_csv.parent.iterdir()) == ["bars.csv", "knots.csv"]
