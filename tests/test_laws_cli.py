"""fyke laws: what it lists and draws, and tables of one's own; what is wrong with them is told as a whole."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from typer.testing import CliRunner

from fyke.case import CaseError
from fyke.case.drag_table import read_drag_table
from fyke.cli.app import app
from fyke.report.laws import drag_laws
from fyke.water.inertia import ADDED_MASS_LAWS
from fyke.water.laws import LAWS, AngleTable, BarTable, measured
from fyke.water.wakes import TWINES, WAKES

BY_ANGLE = """# measured in a tank
reynolds,angle,drag,lift
100,0,0.1,0
100,45,0.8,0.6
100,90,1.8,0
1000,0,0.05,0
1000,45,0.5,0.4
1000,90,1.2,0
"""


def fyke(*arguments):
    return CliRunner().invoke(app, ["laws", *map(str, arguments)], catch_exceptions=False)


def test_every_law_is_listed_in_80_columns(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    told = fyke()
    assert told.exit_code == 0
    lines = told.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    for laws in LAWS.values():
        for name in laws:
            assert any(line.startswith(f"  {name}  ") for line in lines), name


def test_json_tells_the_same():
    told = json.loads(fyke("--json").stdout)
    assert {kind: [law["name"] for law in laws] for kind, laws in told.items()} == {
        **{kind: list(laws) for kind, laws in LAWS.items()},
        "wakes": list(WAKES),
        "twines": list(TWINES),
        "added_mass": list(ADDED_MASS_LAWS),
    }
    choo = told["bars"][1]
    assert choo["range"] == ["Re up to 1e+07"] and choo["area"] == "d l" and "126-131, 1971" in choo["source"]
    assert told["panels"][2]["parameters"] == {"series": "simple"}


def test_plot_writes_both_pictures_and_never_over_others(tmp_path):
    file = tmp_path / "some.png"
    told = fyke("plot", "takagi", "clift-gauvin", "-o", file)
    assert told.exit_code == 0, told.stderr
    assert told.stdout.split() == [str(file), str(file.with_suffix(".svg"))]
    assert imread(file).std() > 0.05 and "<svg" in file.with_suffix(".svg").read_text()
    again = fyke("plot", "takagi", "-o", file)
    assert again.exit_code == 2 and again.stderr.count("a file of this name") == 2
    assert fyke("plot", "takagi", "-o", file, "--overwrite").exit_code == 0


def test_unknown_names_are_told_all_at_once_with_the_nearest(tmp_path):
    told = fyke("plot", "takagy", "table", "missing.csv", "-o", tmp_path / "x.pdf")
    assert told.exit_code == 2
    for words in ("4 problems", "write takagi", "missing.csv", "ends in .png or .svg"):
        assert words in told.stderr
    assert not list(tmp_path.iterdir())


def test_curves_and_points_of_the_figure_are_the_laws_and_the_measurements(tmp_path):
    (tmp_path / "mine.csv").write_text(BY_ANGLE)
    table = read_drag_table(tmp_path / "mine.csv")
    laws = [LAWS["bars"]["kristiansen-faltinsen"](), table, LAWS["panels"]["lee"]()]
    figure = drag_laws(laws)
    assert len(figure.axes) == 4
    fit, own, points = figure.axes[0].get_lines()
    assert fit.get_xdata()[[0, -1]] == pytest.approx([10.0**1.5, 1e4])
    assert fit.get_ydata()[-1] == pytest.approx(1.09169, abs=1e-6)
    assert own.get_ydata()[[0, -1]] == pytest.approx([1.8, 1.2])
    assert np.array(points.get_data()).T == pytest.approx(measured.cylinder())
    lee, panel = figure.axes[2].get_lines()
    assert lee.get_ydata()[0] == pytest.approx(0.2 * 1.155)
    assert panel.get_ydata()[:2] == pytest.approx([0.258, 0.243])
    assert figure.axes[3].get_lines()[1].get_ydata()[1] == pytest.approx(0.037)
    with pytest.raises(ValueError, match="no law"):
        drag_laws([])


def test_tables_are_read_as_written(tmp_path):
    file = tmp_path / "table.csv"
    file.write_text(BY_ANGLE)
    table = read_drag_table(file)
    assert isinstance(table, AngleTable) and table.angle[1:] == pytest.approx([np.pi / 4.0, np.pi / 2.0])
    assert table.drag == ((0.1, 0.8, 1.8), (0.05, 0.5, 1.2)) and table.lift[1] == (0.0, 0.4, 0.0)
    file.write_text("\ufeffreynolds, normal, tangential\n10, 2.0, 0.3\n\n1e2, 1.5, 0.1\n", encoding="utf-8")
    assert read_drag_table(file) == BarTable((10.0, 100.0), (2.0, 1.5), (0.3, 0.1))


def test_every_fault_of_a_table_is_told_with_its_row(tmp_path):
    file = tmp_path / "bad.csv"
    rows = [
        "# mine",
        "reynolds,normal,tangential",
        "10,2,0.1",
        "5,2,0.1",
        "nan,1,0.1",
        "20,,0.1",
        "30,-1,0.1",
    ]
    file.write_text("\n".join([*rows, "40,1", "50,1,x", "10,1,0.1"]))
    with pytest.raises(CaseError) as told:
        read_drag_table(file)
    found = [(one.where.removeprefix(f"{file}, "), one.found) for one in told.value.problems]
    assert found == [
        ("row 5, column reynolds", "'nan'"),
        ("row 6, column normal", "an empty cell"),
        ("row 7, column normal", "'-1'"),
        ("row 8", "2 values"),
        ("row 9, column tangential", "'x'"),
        ("row 4", "reynolds 5 after reynolds 10"),
        ("row 10", "reynolds 10 after reynolds 5"),
    ]
    assert all(one.allowed and one.cure for one in told.value.problems)


def test_gaps_of_a_grid_are_told(tmp_path):
    file = tmp_path / "grid.csv"
    lines = BY_ANGLE.splitlines()
    file.write_text("\n".join(lines[:6] + lines[7:]))
    with pytest.raises(CaseError, match=r"no row for reynolds 1000 at angle 45"):
        read_drag_table(file)
    file.write_text("\n".join([*lines, lines[-1]]))
    with pytest.raises(CaseError, match="keep one row for each"):
        read_drag_table(file)
    file.write_text(BY_ANGLE.replace("1000,", "100,"))
    with pytest.raises(CaseError, match="one value of reynolds, 100"):
        read_drag_table(file)


def test_places_that_nine_digits_cannot_tell_apart_are_one(tmp_path):
    file = tmp_path / "table.csv"
    file.write_text("reynolds,normal,tangential\n1e8,1,0\n100000000.00000001,2,0\n2e8,1,0\n")
    with pytest.raises(CaseError, match="keep one row for each"):
        read_drag_table(file)
    file.write_text(BY_ANGLE.replace("100,45", "100.0000000000001,45"))
    assert read_drag_table(file).reynolds == (100.0, 1000.0)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", "no names of columns"),
        ("re,cn\n1,2\n", "re,cn"),
        ("reynolds,normal,tangential\n", "no row of numbers"),
        ("reynolds,normal,tangential\n10,1,0\n", "one value of reynolds, 10"),
        ("reynolds,angle,drag,lift\n10,91,1,0\n", "'91'"),
        ("reynolds,normal,tangential\n0,1,0\n10,1,0\n", "'0'"),
    ],
)
def test_tables_that_are_none_are_told(tmp_path: Path, text: str, found: str) -> None:
    file = tmp_path / "table.csv"
    file.write_text(text)
    with pytest.raises(CaseError) as told:
        read_drag_table(file)
    assert found in told.value.problems[0].found
    file.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(CaseError, match="cannot be read"):
        read_drag_table(file)
