"""Load cases: the same gear in other water, one folder and one row each."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import fyke
from fyke.case import CaseError, load_cases_of, parse_case
from fyke.cli.app import app
from fyke.cli.check import judge

GEAR = """
[twine.main]
material = "PA"
diameter = "2 mm"
breaking_strength = "250 N"

[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "100 mm"

[[gear]]
kind = "cylinder"
name = "cage"
netting = "main"
meshes = [20, 5]
diameter = "0.8 m"
height = "0.8 m"
top = [0.0, 0.0, -0.3]

[[gear]]
kind = "sinkers"
name = "leads"
along = "cage.bottom"
count = 5
weight = "1 N"
density = "11.3 g/cm3"
"""
HEAD = 'schema = 1\ntitle = "Cage"\n\n[water]\ndepth = 20.0\n\n[current]\nvelocity = [0.1, 0.0, 0.0]\n'
LOADS = """
[[load_case]]
name = "slow"
current = { speed = 0.2, direction = "0 deg" }

[[load_case]]
name = "fast, across"
current = { speed = 0.4, direction = "90 deg" }
load_factor = 1.3
material_factor = 1.5

[[load_case]]
[load_case.current]
velocity = [0.3, 0.0, 0.0]
""".replace("fast, across", "fast across")


def run(folder: Path, text: str, *more: str) -> tuple[int, str]:
    file = folder / "cage.toml"
    file.write_text(text)
    done = CliRunner().invoke(app, ["run", str(file), "-o", str(folder / "out"), "--no-figures", *more])
    return done.exit_code, done.output


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("loads")
    code, said = run(folder, HEAD + GEAR + LOADS)
    assert code == 0, said
    return folder / "out", said


def rows_of(file: Path) -> list[dict[str, str]]:
    with file.open(newline="") as opened:
        return list(csv.DictReader(opened))


def alone(velocity: str) -> fyke.Result:
    case = parse_case(HEAD.replace("[0.1, 0.0, 0.0]", velocity) + GEAR)
    return fyke.solve_static(fyke.build_system(fyke.build_net(case), case))


def test_every_row_is_what_the_same_water_does_alone(out):
    folder, _ = out
    rows = rows_of(folder / "loads.csv")
    assert [row["load_case"] for row in rows] == ["slow", "fast across", "3"]
    for row, velocity in zip(rows, ("[0.2, 0.0, 0.0]", "[0.0, 0.4, 0.0]", "[0.3, 0.0, 0.0]"), strict=True):
        single = alone(velocity)
        assert float(row["support_force"]) == pytest.approx(
            np.linalg.norm(single.support_reaction[-1]), rel=1e-6
        )
        assert float(row["tension"]) == pytest.approx(single.tension[-1].max(), rel=1e-5)
        moved = np.linalg.norm(single.position[-1] - single.net.positions, axis=1).max()
        assert float(row["displacement"]) == pytest.approx(moved, rel=1e-5)
        assert row["tension_part"] == "cylinder cage"
        factor = float(row["load_factor"]) * float(row["material_factor"])
        assert float(row["utilisation"]) == pytest.approx(factor * single.tension[-1].max() / 250.0, rel=1e-5)
    assert [float(row["towards"]) for row in rows] == pytest.approx([0.0, 90.0, 0.0])
    assert [float(row["current"]) for row in rows] == pytest.approx([0.2, 0.4, 0.3])
    assert [row["worst"] for row in rows] == ["0", "1", "0"]


def test_folders_hold_whole_results_and_the_own_water_stays_in_the_output_folder(out):
    folder, _ = out
    own = json.loads((folder / "summary.json").read_text())
    assert own["drag"] == pytest.approx(alone("[0.1, 0.0, 0.0]").hydrodynamic_force[-1, 0], rel=1e-6)
    assert own["worst_load_case"] == "fast across"
    assert [one["name"] for one in own["load_cases"]] == ["slow", "fast across", "3"]
    across = folder / "load_cases" / "fast_across"
    told = json.loads((across / "summary.json").read_text())
    assert told["title"] == "Cage: fast across"
    # The result carries the case that made it, with its own water: the drag is along +y.
    result = fyke.load(across / "result.nc")
    again = fyke.case.recorded_case(result.case_text)
    assert again.current.at_surface == pytest.approx((0.0, 0.4, 0.0))
    assert told["drag"] == pytest.approx(result.hydrodynamic_force[-1, 1], rel=1e-12)
    parts = rows_of(folder / "loads_by_part.csv")
    assert {(row["load_case"], row["name"]) for row in parts} == {
        (n, "cage") for n in ("slow", "fast across", "3")
    }


def test_the_terminal_keeps_to_80_columns_and_marks_the_worst(out):
    _, said = out
    lines = said.splitlines()
    assert max(map(len, lines)) <= 80
    marked = [line for line in lines if line.startswith("* ") and "the worst" not in line]
    assert len(marked) == 1 and marked[0].startswith("* fast across"[:14])


def test_a_report_shows_them(out):
    folder, _ = out
    done = CliRunner().invoke(app, ["report", str(folder), "--overwrite"])
    assert done.exit_code == 0, done.output
    page = (folder / "report.html").read_text()
    assert '<section id="load-cases">' in page and page.count('<tr class="worst">') == 1


def test_one_can_be_chosen_alone(tmp_path):
    code, said = run(tmp_path, 'chosen_load_case = "fast across"\n' + HEAD + GEAR + LOADS, "--json")
    assert code == 0
    figures = json.loads(said[said.index("{") :])
    assert figures["drag"] == pytest.approx(alone("[0.0, 0.4, 0.0]").hydrodynamic_force[-1, 1], rel=1e-6)
    assert not (tmp_path / "out" / "load_cases").exists()


def test_a_second_run_asks_before_it_writes_over_and_then_leaves_nothing_old(tmp_path):
    text = HEAD + GEAR + LOADS
    assert run(tmp_path, text)[0] == 0
    assert run(tmp_path, text)[0] == 2
    code, said = run(tmp_path, text.replace('"slow"', '"still"'), "--overwrite")
    assert code == 0, said
    there = {one.name for one in (tmp_path / "out" / "load_cases").iterdir()}
    assert there == {"still", "fast_across", "3"}


def test_one_that_does_not_converge_leaves_the_others_and_says_so(tmp_path, monkeypatch):
    from fyke.cli import run as command

    real = command.solve_case

    def failing(system, case, **more):
        if case.title.endswith("fast across"):
            from fyke.solve.static import solve_static

            result = solve_static(system, max_iterations=1)
            more["on_frame"](result.frame())
            return result
        return real(system, case, **more)

    monkeypatch.setattr(command, "solve_case", failing)
    code, said = run(tmp_path, HEAD + GEAR + LOADS)
    assert code == 1
    rows = rows_of(tmp_path / "out" / "loads.csv")
    assert [row["outcome"] for row in rows] == ["converged", "iteration_limit", "converged"]
    assert [row["worst"] for row in rows] == ["0", "0", "1"]
    assert "load case fast across: iteration_limit" in said


def test_waves_of_a_dynamic_load_case_are_in_its_row(tmp_path):
    dynamic = '\n[solve]\nkind = "dynamic"\nduration = 0.2\n\n[output]\nevery = 0.1\n'
    sea = '\n[[load_case]]\nname = "sea"\n'
    sea += 'waves = { kind = "airy", height = 0.1, period = 1.5, direction = "180 deg" }\n'
    code, said = run(tmp_path, HEAD + GEAR + dynamic + sea)
    assert code == 0, said
    (row,) = rows_of(tmp_path / "out" / "loads.csv")
    assert (float(row["wave_height"]), float(row["wave_period"])) == (0.1, 1.5)
    assert float(row["waves_towards"]) == pytest.approx(180.0)
    result = fyke.load(tmp_path / "out" / "load_cases" / "sea" / "result.nc")
    assert float(row["support_force"]) == np.linalg.norm(result.support_reaction, axis=1).max()
    assert result.support_reaction.shape == (3, 3)


WRONG = [
    ('name = "slow"', 'name = "3"', "[[load_case]] 3 name", "makes the same folder"),
    (
        "speed = 0.2, direction",
        "sped = 0.2, direction",
        "[[load_case]] 1 current.sped",
        "did you mean 'speed'?",
    ),
    ('speed = 0.2, direction = "0 deg"', "speed = 0.2", "[[load_case]] 1 current.direction", "speed without"),
    ("load_factor = 1.3", "load_factor = 0", "[[load_case]] 2 load_factor", "above 0"),
    ("load_factor = 1.3", "factor = 1.3", "[[load_case]] 2 factor", "did you mean"),
    (
        "load_factor = 1.3",
        'waves = { kind = "airy", height = 5.0, period = 2.0 }',
        "[[load_case]] 2 waves.height",
        "where waves break",
    ),
]


@pytest.mark.parametrize(("good", "bad", "where", "told"), WRONG)
def test_errors_name_the_load_case(good, bad, where, told):
    with pytest.raises(CaseError) as caught:
        parse_case(HEAD + GEAR + LOADS.replace(good, bad))
    (problem,) = caught.value.problems
    assert where in problem.where and "line" in problem.where
    assert told in f"{problem.found} {problem.allowed} {problem.cure}"


def test_a_file_of_a_current_that_is_gone_is_named():
    with pytest.raises(CaseError, match=r"gone\.csv"):
        parse_case(HEAD + GEAR + LOADS.replace("velocity = [0.3, 0.0, 0.0]", 'file = "gone.csv"'))


def test_a_choice_that_is_not_there_is_refused_with_those_that_are():
    with pytest.raises(CaseError) as caught:
        parse_case('chosen_load_case = "fats"\n' + HEAD + GEAR + LOADS)
    (problem,) = caught.value.problems
    assert '"fast across"' in problem.allowed and "chosen_load_case" in problem.where


def test_load_cases_are_cases_with_their_own_water():
    case = parse_case(HEAD + GEAR + LOADS)
    made = {name: one.current.at_surface for _, name, one in load_cases_of(case)}
    assert made["3"] == (0.3, 0.0, 0.0)
    assert made["fast across"] == pytest.approx((0.0, 0.4, 0.0))
    assert case.current.at_surface == (0.1, 0.0, 0.0)


def test_resume_is_refused_in_words(tmp_path):
    code, said = run(tmp_path, HEAD + GEAR + LOADS, "--resume")
    assert code == 2 and "chosen_load_case" in said


def test_curves_go_through_the_load_cases_that_differ_in_speed_alone():
    from fyke.report.loads import load_curves
    from fyke.results import LoadRow

    def row(speed, towards=0.0):
        whole = {name: None for name in LoadRow.__dataclass_fields__}
        more = {
            "name": str(speed),
            "ok": True,
            "current": speed,
            "towards": towards,
            "drag": speed**2,
            "parts": (),
        }
        return LoadRow(**(whole | more | {"volume_left": 1.0 - speed}))

    figure = load_curves([row(0.4), row(0.2), row(0.6)])
    drag, left = figure.axes
    assert drag.lines[0].get_xdata() == pytest.approx([0.2, 0.4, 0.6])
    assert left.lines[0].get_ydata() == pytest.approx([80.0, 60.0, 40.0])
    assert load_curves([row(0.4), row(0.2)]) is None
    assert load_curves([row(0.4), row(0.2), row(0.6, towards=90.0)]) is None


def test_check_tells_every_load_case():
    told = judge(parse_case(HEAD + GEAR + LOADS))["load_cases"]
    assert [one["name"] for one in told] == ["slow", "fast across", "3"]
    assert [one["current"] for one in told] == ["[0.2, 0, 0] m/s", "[0, 0.4, 0] m/s", "[0.3, 0, 0] m/s"]
