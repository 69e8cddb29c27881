"""The command line: exit codes, what is printed, what is written."""

import csv
import json
import math
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fyke.cli.app import app
from fyke.cli.folder import PICTURES
from fyke.version import __version__

PANEL = Path(__file__).parents[1] / "examples" / "panel.toml"
CONTRACT = (
    "title outcome solver linear_solver iterations factorizations residual wall_time knots bars support_reaction "
    "hydrodynamic_force weight_in_water max_tension max_tension_bar slack_bars max_displacement version case_sha256"
).split()


def fyke(*arguments):
    """Run fyke; an exception that is no orderly exit fails the test with its traceback."""
    return CliRunner().invoke(app, [str(one) for one in arguments], catch_exceptions=False)


@pytest.fixture
def case(tmp_path, monkeypatch):
    """A small case file in an empty folder that is the current one."""
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "small.toml"
    file.write_text(PANEL.read_text().replace("meshes = [8, 8]", "meshes = [3, 3]").replace("0.3055", "0.11"))
    return file


def test_run_writes_the_files_of_the_contract_into_a_folder_named_after_the_case(case):
    done = fyke("run", case, "--no-figures")
    assert done.exit_code == 0
    folder = case.parent / "small"
    assert {file.name for file in folder.iterdir()} == {
        "result.nc",
        "summary.json",
        "knots.csv",
        "bars.csv",
        "parts.csv",
    }
    figures = json.loads((folder / "summary.json").read_text())
    assert set(CONTRACT) <= figures.keys() and figures["outcome"] == "converged"
    with (folder / "knots.csv").open() as file:
        knots = list(csv.DictReader(file))
    assert list(knots[0]) == "knot,label,fixed,x0,y0,z0,x,y,z".split(",")
    with (folder / "bars.csv").open() as file:
        bars = list(csv.DictReader(file))
    assert list(bars[0]) == "bar,knot_a,knot_b,rest_length,length,tension".split(",")
    # 3 x 3 diamonds have 25 knots, 36 bars, 12 knots on the frame.
    assert (figures["knots"], figures["bars"]) == (len(knots), len(bars)) == (25, 36)
    assert sum(knot["fixed"] == "1" for knot in knots) == 12
    strongest = max(bars, key=lambda bar: float(bar["tension"]))
    assert int(strongest["bar"]) == figures["max_tension_bar"]


def test_supports_carry_water_and_weight(case):
    figures = json.loads(fyke("run", case, "--no-figures", "--json").stdout)
    water, reaction = figures["hydrodynamic_force"], figures["support_reaction"]
    assert reaction[0] == pytest.approx(water[0], abs=1e-7)
    assert reaction[2] == pytest.approx(water[2] - figures["weight_in_water"], abs=1e-7)


def test_json_is_the_summary_and_nothing_else(case):
    done = fyke("run", case, "--no-figures", "--json", "-o", "out/deeper")
    assert json.loads(done.stdout) == json.loads(Path("out/deeper/summary.json").read_text())


def test_quiet_says_nothing_when_all_is_well(case):
    done = fyke("run", case, "--no-figures", "--quiet")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize(("option", "told"), [("--no-figures", True), ("--quiet", False), ("--json", False)])
def test_first_run_says_that_it_compiles(case, monkeypatch, option, told):
    monkeypatch.setattr("fyke.cli.run.needs_compiling", lambda _: True)
    assert ("compiling" in fyke("run", case, "--no-figures", option).stderr) is told
    monkeypatch.setattr("fyke.cli.run.needs_compiling", lambda _: False)
    assert "compiling" not in fyke("run", case, "--no-figures", option, "--overwrite").stderr


def test_table_fits_80_columns_and_tells_the_result(case):
    done = fyke("run", case, "--no-figures")
    assert max(len(line) for line in done.stdout.splitlines()) <= 80
    figures = json.loads(Path("small/summary.json").read_text())
    for told in (
        "converged",
        "25, 36",
        f"{figures['max_tension']:.4g} N in bar {figures['max_tension_bar']}, from",
        f"{figures['slack_bars']} of 36",
        f"{figures['hydrodynamic_force'][0]:.4g} N",
        "Written to small result result.nc, summary.json tables knots.csv, bars.csv",
    ):
        assert told in " ".join(done.stdout.split()), told


def test_accounts_are_told_and_kept(case):
    static = fyke("run", case, "--no-figures").stdout
    accounts = json.loads(Path("small/summary.json").read_text())["audit"]
    assert accounts["energy"] is None and "energy" not in static
    assert f"N, at knot {accounts['unbalanced_knot']}\n" in static
    assert f" of {accounts['load_size']:.4g} N\n" in static
    case.write_text(case.read_text().replace('"static"', '"dynamic"\nduration = 0.02'))
    table = fyke("run", case, "--no-figures", "--overwrite").stdout
    energy = json.loads(Path("small/summary.json").read_text())["audit"]["energy"]
    assert max(len(line) for line in table.splitlines()) <= 80
    told = " ".join(table.split())
    assert f"energy in current {energy['current_work']:.3g} J, weight" in told
    assert f"energy out drag {energy['drag_dissipation']:.3g} J, twine 0 J, stored" in told
    assert f"left over {energy['remainder']:.3g} J" in told and "the inertia of the net" in told


def test_warnings_of_the_case_are_told_and_kept(case):
    case.write_text(case.read_text().replace('"3.5 mm"', '"1 mm"'))
    done = fyke("run", case, "--no-figures")
    assert "warning: The knots of netting 'main' are thinner than its twine" in " ".join(done.stdout.split())
    assert "thinner" in json.loads(Path("small/summary.json").read_text())["warnings"][0]


def test_earlier_result_is_kept_unless_it_may_be_overwritten(case):
    fyke("run", case, "--no-figures")
    before = Path("small/summary.json").read_bytes()
    refused = fyke("run", case, "--no-figures")
    assert refused.exit_code == 2 and "--overwrite" in refused.stderr and "result.nc" in refused.stderr
    assert Path("small/summary.json").read_bytes() == before
    Path("small/summary.json").write_text("old")
    assert fyke("run", case, "--no-figures", "--overwrite").exit_code == 0
    assert json.loads(Path("small/summary.json").read_text())["outcome"] == "converged"


def test_figures_of_an_earlier_kind_of_run_do_not_outlive_it(case):
    static = case.read_text()
    case.write_text(static.replace('"static"', '"dynamic"\nduration = 0.01\n[output]\nevery = 0.005'))
    assert fyke("run", case, "--quiet").exit_code == 0
    assert Path("small/histories.png").exists()
    case.write_text(static)
    told = " ".join(fyke("run", case, "--overwrite").stdout.split())
    assert "figures initial_position, equilibrium_shape, tension_plan, tension_histogram (png, svg)" in told
    left = {file.stem for file in Path("small").iterdir() if file.suffix in (".png", ".svg")}
    assert left == {"initial_position", "equilibrium_shape", "tension_plan", "tension_histogram"}


def test_every_figure_is_known_to_the_folder(case):
    Path("measured.csv").write_text("knot,x,y,z\n1-1,0,0,-0.5\n")
    text = case.read_text().replace('"static"', '"dynamic"\nduration = 0.01\n[output]\nevery = 0.005')
    waves = '[waves]\nkind = "airy"\nheight = 0.1\nperiod = 2.0\n'
    case.write_text(text + '\n[compare]\npositions = "measured.csv"\n' + waves)
    fyke("run", case, "--quiet")
    drawn = {file.stem for file in Path("small").iterdir() if file.suffix not in (".nc", ".json", ".csv")}
    # A panel is not closed and has no sections; a case without load cases has no curves of them.
    assert drawn == set(PICTURES) - {"sections", "load_curves"}


def test_folder_with_other_files_is_no_earlier_result(case):
    Path("small").mkdir()
    Path("small/notes.txt").write_text("mine")
    assert fyke("run", case, "--no-figures").exit_code == 0
    assert Path("small/notes.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("output", "words"),
    [("small.toml", "a file of this name"), ("small.toml/out", "Not a directory")],
)
def test_folder_that_cannot_be_written(case, output, words):
    done = fyke("run", case, "-o", output)
    assert done.exit_code == 2
    assert words in done.stderr and "-o DIR" in done.stderr


@pytest.mark.parametrize("command", ["run", "check", "cite"])
def test_wrong_input_is_told_in_four_parts_and_nothing_is_written(case, command):
    case.write_text(case.read_text().replace("bar_length", "bar_lenght").replace("[3, 3]", "[0, 3]"))
    done = fyke(command, case)
    assert done.exit_code == 2 and done.stdout == ""
    assert done.stderr.startswith("2 problems:")
    assert "[netting.main] bar_lenght" in done.stderr and "did you mean 'bar_length'?" in done.stderr
    assert "[[gear]] 1 meshes, value 1" in done.stderr
    assert list(case.parent.iterdir()) == [case]


def test_missing_case(tmp_path):
    done = fyke("run", tmp_path / "no.toml")
    assert done.exit_code == 2 and "No such file" in done.stderr


def test_run_that_does_not_settle_is_saved_and_exits_with_1(case):
    # Without damping a net cannot be at rest to 1e-12 N after a hundredth of a second.
    case.write_text(case.read_text().replace('"static"', '"dynamic"\nduration = 0.01\nsettle_force = 1e-12'))
    done = fyke("run", case, "--no-figures", "--quiet")
    assert done.exit_code == 1 and done.stdout == "" and "not_settled" in done.stderr
    assert json.loads(Path("small/summary.json").read_text())["outcome"] == "not_settled"


def test_dynamic_run_keeps_every_output(case):
    import xarray

    case.write_text(
        case.read_text().replace('"static"', '"dynamic"\nduration = 0.02\n[output]\nevery = 0.004')
    )
    assert fyke("run", case, "--no-figures", "--quiet").exit_code == 0
    with xarray.open_dataset("small/result.nc") as data:
        assert data.time.values == pytest.approx([0.0, 0.004, 0.008, 0.012, 0.016, 0.02])
    assert json.loads(Path("small/summary.json").read_text())["time"] == 0.02


def test_measurements_are_compared(case):
    fyke("run", case, "--no-figures", "-o", "first")
    with Path("first/knots.csv").open() as file:
        knots = [(knot["label"], *(float(knot[axis]) for axis in "xyz")) for knot in csv.DictReader(file)]
    rows = [f"{label},{x + 0.003},{y},{z - 0.004}" for label, x, y, z in knots[4:9]]
    Path("measured.csv").write_text("\n".join(["knot,x,y,z", *rows]))
    case.write_text(case.read_text() + '[compare]\npositions = "measured.csv"\n')
    figures = json.loads(fyke("run", case, "--no-figures", "--json").stdout)
    assert figures["measured_knots"] == 5
    assert figures["measured_rms"] == pytest.approx(0.005, rel=1e-6)
    assert "RMS 0.005 m over 5 knots" in fyke("run", case, "--no-figures", "--overwrite").stdout


def test_faulty_measurements_are_told_before_anything_is_solved_or_replaced(case):
    fyke("run", case, "--no-figures")
    before = Path("small/result.nc").read_bytes()
    Path("measured.csv").write_text("knot,x,y,z\n1-1,0,zero,0\n99-99,0,0,0\n")
    case.write_text(case.read_text() + '[compare]\npositions = "measured.csv"\n')
    done = fyke("run", case, "--no-figures", "--overwrite")
    assert done.exit_code == 2 and "'zero'" in done.stderr and "99-99" in done.stderr
    assert Path("small/result.nc").read_bytes() == before


def test_check_tells_what_would_be_built():
    found = json.loads(fyke("check", PANEL, "--json").stdout)
    (panel,) = found["panels"]
    assert (found["knots"], found["bars"], found["fixed"]) == (145, 256, 32)
    assert panel["hanging_ratios"] == pytest.approx([0.3055 / 0.48] * 2)
    assert panel["strain"] == pytest.approx(math.hypot(0.3055, 0.3055) / 0.48 - 1.0)
    assert panel["reynolds"] == pytest.approx(750.0)
    assert panel["twine_area"] == pytest.approx(256 * 0.03 * 0.0015)
    volume = 256 * 0.03 * math.pi / 4 * 0.0015**2 + 145 * math.pi / 6 * 0.0035**3
    assert found["weight_in_water"] == pytest.approx(140.0 * 9.81 * volume)
    assert found["mass"] == pytest.approx(1140.0 * volume)


def test_check_prints_a_table_and_what_looks_odd(case):
    table = fyke("check", PANEL).stdout
    assert max(len(line) for line in table.splitlines()) <= 80
    for told in (
        "145, of which fixed 32",
        "8 x 8 = 64",
        "E1 = 0.6365",
        "-9.99 % (slack)",
        "750",
        "Nothing looks odd",
    ):
        assert told in table
    case.write_text(case.read_text().replace("density = 1140.0", "density = 900"))
    assert "floats" in fyke("check", case).stdout


def test_check_as_json_tells_problems_too(case):
    case.write_text(case.read_text().replace('"30 mm"', '"30 kg"'))
    done = fyke("check", case, "--json")
    (problem,) = json.loads(done.stdout)["problems"]
    assert done.exit_code == 2 and problem["found"] == '"30 kg"'
    assert set(problem) == {"where", "found", "allowed", "cure"}


def test_new_case_is_checked_as_good_and_never_replaced(tmp_path):
    file = tmp_path / "mine.toml"
    assert fyke("new", file).exit_code == 0
    assert fyke("check", file).exit_code == 0
    file.write_text("precious")
    again = fyke("new", file)
    assert again.exit_code == 2 and "never writes over" in again.stderr
    assert file.read_text() == "precious"
    assert fyke("new", tmp_path / "no" / "where.toml").exit_code == 2


def test_schema_is_json():
    schema = json.loads(fyke("schema").stdout)
    assert schema["type"] == "object" and schema["additionalProperties"] is False


def test_a_reader_that_goes_away_is_no_fault(case, tmp_path):
    """`fyke run ... --json | head -c 1`: the files are there and nothing is said."""
    command = f"{sys.executable} -m fyke run {case} -o {tmp_path / 'out'} --json --no-figures | head -c 1"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert done.stdout == "{" and done.stderr == ""
    assert (tmp_path / "out" / "bars.csv").exists()


def test_cite_names_the_sources_of_what_is_used(case):
    static = " ".join(fyke("cite", case).stdout.split())
    assert "Bessonneau & Marichal 1998" in static and "Mehrotra" in static and "material PA" not in static
    text = (
        case.read_text()
        .replace('"static"', '"dynamic"\nduration = 1')
        .replace('youngs_modulus = "1.0 GPa"', "")
    )
    case.write_text(text)
    dynamic = " ".join(fyke("cite", case).stdout.split())
    assert "Norsett" in dynamic and "Mehrotra" not in dynamic and "material PA: MoorPy" in dynamic


def test_version_and_usage():
    assert fyke("--version").stdout == f"fyke {__version__}\n"
    assert fyke("swim").exit_code == 2
    assert fyke("run").exit_code == 2


def test_help_waits_for_no_heavy_import():
    code = (
        "import sys; from fyke.cli import main; "
        "print(*({'numba', 'scipy', 'h5py', 'matplotlib', 'pydantic'} & set(sys.modules)))"
    )
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert loaded.stdout.strip() == ""
