"""Measured positions laid over a result: distances by hand, and every fault of a file in one go."""

import dataclasses

import numpy as np
import pytest

from fyke.results import MeasurementError, compare
from test_results_store import make_result


@pytest.fixture
def result():
    """Return a panel whose last frame lies 0.5 m downstream of the first place of every knot."""
    made = make_result(2)
    position = np.stack([made.net.positions, made.net.positions + np.array([0.5, 0.0, 0.0])])
    return dataclasses.replace(made, position=position)


@pytest.fixture
def measured(tmp_path):
    def write(text, encoding="utf-8"):
        path = tmp_path / "measured.csv"
        path.write_text(text, encoding=encoding)
        return path

    return write


def rows_by_label(result, offsets):
    lines = ["knot,x,y,z"]
    for label, offset in offsets.items():
        place = result.position[-1, result.net.labels.index(label)] + offset
        lines.append(",".join([label, *map(repr, place.tolist())]))
    return "\n".join(lines) + "\n"


def problems_of(result, path):
    with pytest.raises(MeasurementError) as caught:
        compare(result, path)
    assert all(str(problem) in str(caught.value) for problem in caught.value.problems)
    return caught.value.problems


def test_distances_are_those_between_measured_and_computed_knots(result, measured):
    offsets = {"1-1": (0.0, 0.0, 0.02), "2-2": (0.03, 0.0, 0.04), "3-3": (0.0, 0.0, 0.0)}
    found = compare(result, measured(rows_by_label(result, offsets)))
    assert found.labels == ("1-1", "2-2", "3-3")
    assert [result.net.labels[knot] for knot in found.knots] == ["1-1", "2-2", "3-3"]
    np.testing.assert_allclose(found.distance, [0.02, 0.05, 0.0], atol=1e-15)
    assert found.rms == pytest.approx(np.sqrt((0.02**2 + 0.05**2) / 3), rel=1e-12)
    assert found.largest == pytest.approx(0.05, rel=1e-12)
    assert found.largest_label == "2-2"
    np.testing.assert_allclose(found.measured - found.computed, list(offsets.values()), atol=1e-15)


def test_knots_are_found_by_their_initial_place(result, measured):
    shape = result.net.positions[[4, 7]] + [0.0, 0.004, -0.01]
    lines = ["x0,y0,z0,x,y,z"]
    for start, knot in zip(shape, (4, 7), strict=True):
        end = result.position[-1, knot] + [0.0, 0.1, 0.0]
        lines.append(",".join(map(repr, [*start.tolist(), *end.tolist()])))
    found = compare(result, measured("\n".join(lines)))
    assert found.knots.tolist() == [4, 7]
    assert found.rms == pytest.approx(0.1, rel=1e-12)


def test_a_file_of_a_spreadsheet_is_read(result, measured):
    """A byte order mark, Windows line ends, blanks and an empty last row."""
    text = "knot, x, y, z\r\n 1-1 , 0.5, 0.0, 0.0\r\n,,,\r\n"
    assert compare(result, measured(text, encoding="utf-8-sig")).labels == ("1-1",)


def test_all_faults_of_a_file_are_told_at_once(result, measured):
    path = measured("knot,x,y,z\n1-1,0,0,0\n1-2,0,0,0\n2-2,0.1,abc,nan\n1-1,0,0,0\n3-3,1,2\n,0,0,0\n")
    problems = {problem.where: problem for problem in problems_of(result, path)}
    assert set(problems) == {
        f"{path}, row 3",
        f"{path}, row 4, column y",
        f"{path}, row 4, column z",
        f"{path}, row 5",
        f"{path}, row 6",
        f"{path}, row 7",
    }
    unknown = problems[f"{path}, row 3"]
    assert "'1-2'" in unknown.found
    assert unknown.cure == "did you mean '0-2' or '1-1' or '1-3'?"
    assert "'abc'" in problems[f"{path}, row 4, column y"].found
    assert "'nan'" in problems[f"{path}, row 4, column z"].found
    assert "row 2" in problems[f"{path}, row 5"].found
    assert problems[f"{path}, row 6"].found == "3 values"
    for problem in problems.values():
        assert problem.allowed
        assert problem.cure


def test_a_place_far_from_every_knot_and_a_place_twice_are_told(result, measured):
    start = ",".join(map(repr, result.net.positions[4].tolist()))
    path = measured(f"x0,y0,z0,x,y,z\n{start},0,0,0\n9.0,9.0,9.0,0,0,0\n{start},0,0,0\n")
    far, twice = problems_of(result, path)
    assert far.where == f"{path}, row 3"
    assert "0.015 m" in far.allowed
    assert twice.where == f"{path}, row 4"
    assert result.net.labels[4] in twice.found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("knot;x;y;z\n1-1;0;0;0\n", "knot;x;y;z"),
        ("label,x,y,z\n1-1,0,0,0\n", "label,x,y,z"),
        ("", "no names of columns"),
        ("knot,x,y,z\n", "the end of the file"),
    ],
)
def test_wrong_columns_and_empty_files_are_told(result, measured, text, found):
    (problem,) = problems_of(result, measured(text))
    assert problem.found == found


def test_a_file_that_cannot_be_read_is_told(result, measured, tmp_path):
    (missing,) = problems_of(result, tmp_path / "missing.csv")
    assert "missing.csv" in missing.where
    (odd,) = problems_of(result, measured("knot,x,y,z\n1-1,0,0,0 # 4 °C\n", encoding="latin-1"))
    assert "UTF-8" in odd.allowed
