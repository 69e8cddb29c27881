"""Claims: those of validation/ hold; what is wrong with one is told in its rows, and the others still run."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.study.claims import LEVELS, claims_in, read_claim
from fyke.study.text import alike, cells, levels_of, markdown
from fyke.study.validate import Judged, Report, judge, validate
from reference import VALIDATION

CLAIMS = [read_claim(file) for file in claims_in(VALIDATION)]


@pytest.mark.parametrize("claim", [one for one in CLAIMS if one.fast], ids=lambda one: one.name)
def test_what_fyke_claims_holds(claim):
    judgement = judge(claim.file)
    failed = [(row.quantity, row.case, row.ours, row.reference, row.reason) for row in judgement.rows
              if row.verdict == "fails"]  # fmt: skip
    assert judgement.rows and not failed


def test_every_level_has_a_claim_that_is_judged():
    for level in LEVELS:
        judged = [
            row for one in CLAIMS if one.level == level for row in one.rows if row.tolerance is not None
        ]
        assert judged, level


def test_the_report_in_the_repository_is_of_these_claims():
    """Of every claim and every quantity, and none fails there."""
    report = (VALIDATION / "REPORT.md").read_text(encoding="utf-8")
    assert "Made by `fyke validate` with" in report and ", 0 fail," in report
    for claim in CLAIMS:
        assert f"### {claim.title}\n" in report, claim.name
        for row in claim.rows:
            assert f"\n- {row.quantity}: " in report, (claim.name, row.quantity)


# What is wrong with a claim is a row that fails


GOOD = """
title = "A sum"
level = "unit"
source = "by hand"
script = "sum.py"

[[row]]
quantity = "one and one"
key = "sum"
unit = "m"
reference = 2.0
tolerance = 1e-12
reason = "exact"
"""
SUM = """
from fyke.study import Found


def measure(tables):
    yield Found("sum", 1.0 + 1.0)
"""
CASE = (Path(__file__).parents[1] / "examples" / "panel.toml").read_text(encoding="utf-8")
TABLE = '[data.points]\nfile = "points.csv"\ncolumns = { x = "m", load = "N" }\n'


@pytest.fixture
def folder(tmp_path):
    """Return a writer of files beside a claim that holds."""

    def write(**files: str) -> Path:
        for name, text in {"good_toml": GOOD, "sum_py": SUM, **files}.items():
            stem, _, ending = name.rpartition("_")
            (tmp_path / f"{stem}.{ending}").write_text(text, encoding="utf-8")
        return tmp_path

    return write


def claim_of(changes: dict[str, str], more: str = "") -> str:
    text = GOOD + more
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    return text


def reasons(folder: Path) -> list[str]:
    """Reasons of the rows of the bad claim that fail; the good claim is to hold whatever the other does."""
    report = validate(claims_in(folder))
    assert not report.ok
    assert [row.verdict for row in report.rows if row.claim == "good"] == ["holds"]
    return [
        " ".join(row.reason.split()) for row in report.rows if (row.claim, row.verdict) == ("bad", "fails")
    ]


@pytest.mark.parametrize(
    ("bad", "said"),
    [
        (claim_of({'title = "A sum"': 'titel = "A sum"'}), ["titel found an unknown key", "did you mean 'title'?"]),
        (claim_of({'level = "unit"': 'level = "exakt"'}), ["level found 'exakt'", "write exact"]),
        (claim_of({'reason = "exact"': ""}), ["row 1, reason found no reason"]),
        (claim_of({'reason = "exact"': 'reason = " "'}), ["row 1, reason found no reason"]),
        (claim_of({"tolerance = 1e-12": ""}), ["row 1 found no tolerance"]),
        (claim_of({"tolerance = 1e-12": "tolerance = 1e-12\nrelative = 0.1"}), ["both tolerance and relative"]),
        (claim_of({"tolerance = 1e-12": "tolerance = -1.0"}), ["tolerance found -1.0", "a number from 0"]),
        (claim_of({"tolerance = 1e-12": "tolerence = 1e-12"}), ["did you mean 'tolerance'?"]),
        (claim_of({"reference = 2.0": 'reference = "about two"'}), ["reference found 'about two'"]),
        (claim_of({'script = "sum.py"': ""}), ["neither of script and case"]),
        (claim_of({'script = "sum.py"': 'script = "sum.py"\ncase = "a.toml"'}), ["both of script and case"]),
        ("title = [", ["bad.toml"]),
        (claim_of({'script = "sum.py"': 'script = "lost.py"'}), ["no script", "lost.py"]),
        (claim_of({'key = "sum"': 'key = "product"'}), ["nothing was measured for 'product'; there is sum"]),
        (claim_of({"reference = 2.0": "reference = 2.1"}), ["exact"]),
        (claim_of({"reference = 2.0\n": ""}), ["the script gives no reference"]),
        (claim_of({"reference = 2.0": "reference = 0.0", "tolerance": "relative"}), ["on a reference of 0"]),
        (claim_of({"reference = 2.0": 'reference = 2.5\nside = "above"'}), ["exact"]),
        (claim_of({"reference = 2.0": 'reference = 2.0\nside = "left"'}), ["side found 'left'", "above"]),
        (claim_of({"reference = 2.0": "reference = [2.0]"}), ["reference found [2.0]"]),
        (claim_of({"reference = 2.0": "reference = nan"}), ["reference found nan"]),
        (claim_of({'title = "A sum"': "title = 3"}), ["title found 3 allowed a text"]),
        (claim_of({'title = "A sum"': 'title = "A"\nfast = "no"'}), ["fast found 'no' allowed true or false"]),
        (claim_of({'title = "A sum"': 'title = "A"\nneeds = "moordyn"'}), ["needs", "a list of texts"]),
        (claim_of({'title = "A sum"': 'title = "A"\ndata = 3'}), ["data found 3"]),
        (claim_of({}, '[data.x]\nfile = "x.csv"\ncolumns = ["x"]\n'), ["data", "file and columns"]),
        (GOOD[: GOOD.index("[[row]]")] + "row = 3", ["row found 3"]),
        (GOOD[: GOOD.index("[[row]]")], ["row found nothing"]),
    ],
    ids=lambda value: None if isinstance(value, list) else "",
)  # fmt: skip
def test_a_claim_that_is_wrong_fails_and_says_so(folder, bad, said):
    told = reasons(folder(bad_toml=bad))
    assert told
    for words in said:
        assert any(words in one for one in told), told


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("x_m\n1.0\n", "no column load_N"),
        ("x_mm,load_N\n1.0,2.0\n", "column x_mm"),
        ("x_m,load_N\n1.0,2.0\n,3.0\n", "row 2 found nothing"),
        ("x_m,load_N\n1.0,two\n", "row 1 found 'two'"),
        (None, "No such file"),
    ],
    ids=["column missing", "other unit", "empty cell", "no number", "no file"],
)
def test_a_table_that_is_not_as_stated_fails_its_rows(folder, table, said):
    files = {} if table is None else {"points_csv": table}
    told = reasons(folder(bad_toml=claim_of({}, TABLE), **files))
    assert len(told) == 1 and said in told[0]


def test_what_a_script_found_before_it_raised_is_judged(folder):
    script = SUM + "    raise ArithmeticError('the rest is lost')\n"
    more = GOOD[GOOD.index("[[row]]") :].replace('"sum"', '"later"').replace("one and one", "the rest")
    bad = claim_of({"sum.py": "bad.py"}, more)
    rows = validate(claims_in(folder(bad_toml=bad, bad_py=script))).rows
    mine = {row.quantity: (row.verdict, row.reason) for row in rows if row.claim == "bad"}
    assert mine["one and one"] == ("holds", "exact")
    for quantity in ("the rest", "the claim itself"):
        verdict, reason = mine[quantity]
        assert verdict == "fails" and "ArithmeticError: the rest is lost (bad.py, line 7)" in reason


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("    raise SystemExit(3)", "SystemExit: 3"),
        ("    yield 3.0", "measure is to yield Found, not 3.0"),
        ("    return None", "TypeError"),
    ],
    ids=["leaves", "yields a number", "returns nothing"],
)
def test_a_script_that_is_none_fails_its_rows(folder, body, said):
    script = f"from fyke.study import Found\n\n\ndef measure(tables):\n{body}\n"
    (told,) = reasons(folder(bad_toml=claim_of({"sum.py": "bad.py"}), bad_py=script))
    assert said in told


def test_a_script_that_takes_its_process_with_it_fails_and_the_others_run(folder):
    script = SUM + "    import os\n    os._exit(9)\n"
    report = validate(claims_in(folder(bad_toml=claim_of({"sum.py": "bad.py"}), bad_py=script)), jobs=2)
    assert [(row.claim, row.verdict) for row in report.rows] == [("bad", "fails"), ("good", "holds")]


def test_what_no_row_asks_for_and_what_is_no_number_fails(folder):
    script = SUM + "    yield Found('more', 1.0)\n    yield Found('sum', float('nan'))\n"
    told = reasons(folder(bad_toml=claim_of({"sum.py": "bad.py"}), bad_py=script))
    assert "nan was found" in told and "'more' was measured and no row asks for it" in told


def test_a_case_that_does_not_converge_fails_its_rows(folder, monkeypatch):
    bad = claim_of({'script = "sum.py"': 'case = "cases/panel.toml"', '"sum"': '"hydrodynamic_force.0"'})
    root = folder(bad_toml=bad)
    (root / "cases").mkdir()
    (root / "cases" / "panel.toml").write_text(CASE, encoding="utf-8")
    monkeypatch.setattr(
        "fyke.study.measure.solve_case", lambda system, case: fyke.solve_static(system, max_iterations=3)
    )
    (told,) = reasons(root)
    assert "iteration_limit" in told


def test_a_case_is_asked_by_the_keys_of_its_summary(folder):
    held = claim_of({
        'script = "sum.py"': 'case = "cases/panel.toml"', '"sum"': '"hydrodynamic_force.0"', '"m"': '"N"',
        "reference = 2.0": "reference = 1.4677", "tolerance = 1e-12": "tolerance = 1e-3",
    })  # fmt: skip
    root = folder(held_toml=held)
    (root / "cases").mkdir()
    (root / "cases" / "panel.toml").write_text(CASE, encoding="utf-8")
    report = validate(claims_in(root))
    assert report.ok and report.count("holds") == 2


def test_what_is_not_installed_or_not_measured_is_missing(folder):
    needs = claim_of({'script = "sum.py"': 'script = "sum.py"\nneeds = ["no_such_package"]'})
    unknown = claim_of({'script = "sum.py"': "", "reference = 2.0": 'reference = "missing"'})
    rows = validate(claims_in(folder(needs_toml=needs, unknown_toml=unknown))).rows
    told = {row.claim: (row.verdict, row.reason) for row in rows}
    assert told["needs"] == ("missing", "not installed: no_such_package; pip install no_such_package")
    assert told["unknown"] == ("missing", "exact")


def test_a_picture_that_cannot_be_drawn_fails_and_the_rows_stay(folder):
    drawn = SUM + (
        "\n\ndef picture(found):\n    from matplotlib.figure import Figure\n\n    return Figure(figsize=(1, 1))\n"
    )
    wrong = SUM + "\n\ndef picture(found):\n    return found[7]\n"
    root = folder(
        drawn_toml=claim_of({"sum.py": "drawn.py"}), drawn_py=drawn,
        bad_toml=claim_of({"sum.py": "bad.py"}), bad_py=wrong,
    )  # fmt: skip
    report = validate(claims_in(root), draw=True)
    assert report.pictures["drawn"].startswith(b"\x89PNG") and list(report.pictures) == ["drawn"]
    assert [(r.claim, r.verdict) for r in report.rows if r.verdict == "fails"] == [("bad", "fails")]
    (page,) = levels_of(report)
    assert [claim["picture"] is not None for claim in page["claims"]] == [False, True, False]


def test_a_script_prints_nothing_into_the_table(folder, capfd):
    loud = SUM + "    import os\n    print('loud')\n    os.write(1, b'louder')\n"
    assert validate(claims_in(folder(loud_toml=claim_of({"sum.py": "loud.py"}), loud_py=loud))).ok
    assert capfd.readouterr().out == ""


# Told


def row(**given: object) -> Judged:
    whole = {
        "claim": "c", "title": "A claim", "level": "unit", "case": "here", "quantity": "sum", "unit": "m",
        "ours": 2.0, "reference": 2.5, "tolerance": 0.1, "relative": False, "verdict": "fails", "reason": "why",
        "source": "by hand",
    } | given  # fmt: skip
    return Judged(**whole)  # type: ignore[arg-type] # values of a dict have one type, fields have many


def test_cells_of_a_row():
    assert cells(row()) == ("sum", "here", "2 m", "2.5 m", "-0.5 m", "0.1 m", "fails")
    assert cells(row(relative=True))[4:6] == ("-20 %", "10 %")
    assert cells(row(reference=None, tolerance=None, verdict="shown"))[3:] == ("", "", "", "shown")
    assert cells(row(side="above", verdict="fails"))[5] == "at least that"


def test_rows_that_hold_are_told_by_the_worst_and_others_one_by_one():
    held = [row(case=f"case {i}", ours=2.5 - 0.01 * i, verdict="holds") for i in range(7)]
    failed = [row(case="lost"), row(case="lost too")]
    text = markdown(Report(tuple(held + failed), {}, {}), version="1", command="fyke validate")
    assert "worst of 7: case 6" in text and "case 4" not in text
    assert "| lost |" in text and "| lost too |" in text and "7 hold, 2 fail" in text
    assert [len(some) for some in alike(held + failed)] == [7, 1, 1]
    assert math.isclose(levels_of(Report((held[5],), {}, {}))[0]["claims"][0]["rows"][0]["miss"], 0.5)


# The command


def run(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["validate", *map(str, words)])
    return result.exit_code, result.output


def test_the_command_ends_with_0_1_or_2(folder):
    root = folder()
    assert run(root, "-j", 1, "--no-write")[0] == 0
    code, told = run(root, "-j", 1, "--only", "god")
    assert code == 2 and "did you mean 'good'?" in told
    assert run(root / "nowhere")[0] == 2
    (root / "bad.toml").write_text(claim_of({"reference = 2.0": "reference = 3.0"}), encoding="utf-8")
    code, told = run(root, "-j", 1, "--no-write")
    assert code == 1 and "1 of 2 rows hold, 1 fail" in told
    assert run(root, "-j", 1, "--only", "good", "--no-write")[0] == 0


def test_the_command_writes_a_report_and_a_page(folder):
    root = folder(slow_toml=claim_of({'script = "sum.py"': 'script = "sum.py"\nfast = false'}))
    assert run(root, "-j", 1, "--fast")[0] == 0
    assert (root / "report.html").is_file() and not (root / "REPORT.md").exists()
    assert run(root, "-j", 2)[0] == 0
    assert (root / "REPORT.md").read_text().count("| one and one |") == 2
    assert "<table>" in (root / "report.html").read_text()


def test_json_of_the_command(folder):
    """With numbers of numpy, and what is no number as null."""
    lost = (
        "import numpy as np\n" + SUM.replace("1.0 + 1.0", "np.int64(2)") + "    yield Found('sum', np.nan)\n"
    )
    root = folder(bad_toml=claim_of({"sum.py": "bad.py"}), bad_py=lost)
    code, told = run(root, "-j", 1, "--json", "--no-write")
    found = json.loads(told)
    assert code == 1 and found["ok"] is False and set(found["seconds"]) == {"bad", "good"}
    assert [(row["quantity"], row["ours"], row["verdict"]) for row in found["rows"]] == [
        ("one and one", 2.0, "holds"),
        ("one and one", None, "fails"),
        ("one and one", 2.0, "holds"),
    ]


@pytest.mark.parametrize("width", [1280, 390], ids=["desktop", "phone"])
def test_the_page_fits_the_window_with_every_claim_open(folder, browser, width):
    drawn = SUM + (
        "\n\ndef picture(found):\n    from matplotlib.figure import Figure\n\n    return Figure(figsize=(7, 3))\n"
    )
    long = claim_of({"sum.py": "drawn.py", "one and one": "a quantity of many words " * 8})
    root = folder(drawn_toml=long, drawn_py=drawn, bad_toml=claim_of({"reference = 2.0": "reference = 3.0"}))
    assert run(root, "-j", 1)[0] == 1
    page = browser.new_page(viewport={"width": width, "height": 800})
    page.goto((root / "report.html").as_uri())
    # A claim of which a row fails is open, the others are closed.
    assert page.locator("details[open]").count() == 1 and page.locator("details").count() == 3
    page.evaluate("document.querySelectorAll('details').forEach(one => one.open = true)")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.locator("details img").count() == 1
    page.close()
