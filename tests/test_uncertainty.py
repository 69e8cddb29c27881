"""Studies of uncertainty: samples, bands and tornado of outputs that are known functions of the inputs."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import norm, triang, uniform
from typer.testing import CliRunner

from fyke.case import CaseError, load_case
from fyke.cli.app import app
from fyke.study.inputs import read_study
from fyke.study.uncertainty import propagate

# A mesh whose knots are all held is a rigid thing: its drag goes with C_n, with U^2 and with nothing else.
HELD = """
schema = 1
title = "One held mesh"
[current]
velocity = [0.5, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "2 mm"
[netting.main]
twine = "main"
mesh = "square"
bar_length = "30 mm"
[[gear]]
kind = "panel"
name = "mesh"
netting = "main"
meshes = [1, 1]
size = [0.03, 0.03]
centre = [0.0, 0.0, -1.0]
fixed = "edges"
[drag]
bars = { law = "constant", normal = 1.2, tangential = 0.0 }
"""
STUDY = """
samples = {samples}
method = "{method}"
seed = 3
outputs = ["drag", "hydrodynamic_force.1"]
[[input]]
key = "drag.bars.normal"
distribution = "normal"
mean = 1.2
deviation = 0.1
[[input]]
key = "current.velocity.1"
distribution = "uniform"
low = "45 cm/s"
high = "55 cm/s"
"""


@pytest.fixture
def files(tmp_path):
    case, study = tmp_path / "held.toml", tmp_path / "study.toml"
    case.write_text(HELD)

    def of(samples=64, method="latin-hypercube", text=STUDY):
        study.write_text(text.format(samples=samples, method=method) if text is STUDY else text)
        return case, study

    return of


def drag(normal, speed):
    """Four bars of 30 mm across the current, each 1/2 rho C_n d l U^2."""
    return 4 * 0.5 * 1000.0 * normal * 2e-3 * 0.03 * speed**2


def ran(files, tmp_path, **given):
    case, study = (load_case(files[0]), files[1])
    return propagate(case, read_study(study, case), tmp_path / "samples.csv", **given)


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol"])
def test_outputs_are_what_the_inputs_make_of_them(files, tmp_path, method):
    ensemble = ran(files(256, method), tmp_path)
    assert not ensemble.failed and len(ensemble.samples) == 256
    normal, speed = ensemble.drawn[:, 0], 0.01 * ensemble.drawn[:, 1]
    exact = drag(normal, speed)
    assert ensemble.samples[:, 0] == pytest.approx(exact, rel=1e-12)
    assert ensemble.samples[:, 1] == pytest.approx(exact, rel=1e-12)
    # Both inputs follow their distributions: no sample is further from its place in them than one interval.
    for drawn, law in ((normal, norm(1.2, 0.1)), (speed, uniform(0.45, 0.1))):
        there = np.sort(law.cdf(drawn))
        assert np.abs(there - (np.arange(256) + 0.5) / 256).max() < 1.5 / 256
    # U^2 of uniform U: mean (b^3 - a^3) / (3 (b - a)); the inputs are independent, so the mean is the product.
    mean = drag(1.2, 1.0) * (0.55**3 - 0.45**3) / 0.3
    found = ensemble.spreads()["drag"]
    assert found.mean == pytest.approx(mean, rel=2e-3)
    assert found.nominal == pytest.approx(drag(1.2, 0.5), rel=1e-12)
    square = drag(1.0, 1.0) ** 2 * (1.2**2 + 0.1**2) * (0.55**5 - 0.45**5) / 0.5
    # Columns of a Latin hypercube are paired by chance: three standard errors of a deviation, 1 / sqrt(2 n) each.
    rel = 0.02 if method == "sobol" else 3.0 / np.sqrt(2.0 * 256)
    assert found.deviation == pytest.approx(np.sqrt(square - mean**2), rel=rel)


def test_the_tornado_moves_one_input_at_a_time(files, tmp_path):
    found = ran(files(2), tmp_path).tornado()[:, :, 0]
    ends = norm(1.2, 0.1).ppf([0.05, 0.95])
    assert found[0] == pytest.approx(drag(ends, 0.5), rel=1e-12)
    assert found[1] == pytest.approx(drag(1.2, np.array([0.455, 0.545])), rel=1e-12)


def test_triangular_and_relative(files, tmp_path):
    text = """
samples = 200
outputs = ["drag"]
[[input]]
key = "twine.main.diameter"
distribution = "triangular"
relative = true
low = 0.9
mode = 1.0
high = 1.3
"""
    ensemble = ran(files(text=text), tmp_path)
    assert ensemble.study.inputs[0].unit == "mm"
    law = triang(0.25, 1.8, 0.8)
    assert np.sort(law.cdf(ensemble.drawn[:, 0])) == pytest.approx((np.arange(200) + 0.5) / 200, abs=1 / 200)
    assert ensemble.samples[:, 0] == pytest.approx(drag(1.2, 0.5) * ensemble.drawn[:, 0] / 2.0, rel=1e-12)


def test_same_numbers_for_any_number_of_processes_and_after_an_interruption(files, tmp_path):
    case, study = files(24)
    texts = []
    for jobs in (1, 2):
        folder = tmp_path / str(jobs)
        folder.mkdir()
        ran((case, study), folder, jobs=jobs)
        texts.append((folder / "samples.csv").read_text())
    assert texts[0] == texts[1]
    # Cut in the middle of a line, as by kill -9.
    file = tmp_path / "1" / "samples.csv"
    file.write_text(texts[0][: len(texts[0]) // 2])
    done = []
    ran((case, study), tmp_path / "1", resume=True, on_progress=lambda n, of: done.append(n))
    assert 0 < len(done) < 29
    assert sorted(file.read_text().splitlines()) == sorted(texts[0].splitlines())


def test_a_sample_that_the_case_does_not_allow_is_told(files, tmp_path):
    """Half of these currents are faster than 100 m/s, which no case may have; their quantiles 5 and 95 % are not."""
    text = STUDY.replace('low = "45 cm/s"', "low = 99.0").replace('high = "55 cm/s"', "high = 100.01")
    text = text.format(samples=400, method="latin-hypercube")
    ensemble = ran(files(text=text), tmp_path)
    over = int(np.sum([run.inputs[1] > 100.0 for run in ensemble.runs]))
    assert over >= 3 and len(ensemble.failed) == over
    assert len(ensemble.samples) == 400 - over and np.isfinite(ensemble.samples).all()
    assert "100" in ensemble.failed[0].outcome and "not allowed" in ensemble.failed[0].outcome


def invoke(*words):
    return CliRunner().invoke(app, ["run", *map(str, words)])


def test_the_command_writes_tables_and_figures(files, tmp_path):
    case, study = files(16)
    out = tmp_path / "out"
    done = invoke(case, "--uncertainty", study, "-o", out, "-j", 1)
    assert done.exit_code == 0, done.output
    assert "drag (N)" in done.output and max(map(len, done.output.splitlines())) <= 80
    told = json.loads((out / "uncertainty.json").read_text())
    lines = [one for one in (out / "samples.csv").read_text().splitlines() if not one.startswith("#")]
    rows = list(csv.DictReader(lines))
    assert len(rows) == 1 + 4 + 16
    drags = np.array([float(row["drag"]) for row in rows[5:]])
    assert told["outputs"]["drag"]["mean"] == pytest.approx(drags.mean(), rel=1e-12)
    assert told["outputs"]["drag"]["unit"] == "N"
    assert told["tornado"]["drag.bars.normal"]["drag"] == [float(rows[1]["drag"]), float(rows[2]["drag"])]
    for name in ("tornado", "bands"):
        assert (out / f"{name}.png").stat().st_size > 5_000
    again = invoke(case, "--uncertainty", study, "-o", out)
    assert again.exit_code == 2 and "--overwrite" in again.output
    study.write_text(study.read_text().replace("seed = 3", "seed = 4"))
    other = invoke(case, "--uncertainty", study, "-o", out, "--resume")
    assert other.exit_code == 2 and "another" in other.output


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("samples = 16", "samples = 1", ["samples", "from 2 to"]),
        ('method = "sobol"', 'method = "random"', ["method", "latin-hypercube, sobol"]),
        ('key = "drag.bars.normal"', 'key = "drag.bar.normal"', ["no 'bar'", "did you mean 'bars'?"]),
        ('key = "current.velocity.1"', 'key = "current.velocity.4"', ["no '4'", "1, 2, 3"]),
        ('key = "current.velocity.1"', 'key = "current.velocity"', ["name one number"]),
        (
            'distribution = "normal"',
            'distribution = "gauss"',
            ["distribution", "normal, uniform, triangular"],
        ),
        ("deviation = 0.1", "deviation = 0.0", ["a deviation above 0"]),
        ('high = "55 cm/s"', 'high = "0.55 m/s"', ["one unit for all its numbers"]),
        ('high = "55 cm/s"', 'high = "44 cm/s"', ["put them in order"]),
        ('high = "55 cm/s"', 'high = "9000 m/s"', ["one unit"]),
        ("mean = 1.2", "mean = 1.2\nmode = 3", ["mode", "unknown key"]),
        ('outputs = ["drag"', 'outputs = ["drags"', ["no number 'drags'", "did you mean 'drag'?"]),
        ("deviation = 0.1", "deviation = 5.0", ["drag.bars.normal = -", "from 0"]),
    ],
)
def test_wrong_studies(files, tmp_path, old, new, words):
    case, study = files(16, "sobol")
    assert old in study.read_text()
    study.write_text(study.read_text().replace(old, new))
    done = invoke(case, "--uncertainty", study, "-o", tmp_path / "out")
    assert done.exit_code == 2, done.output
    told = " ".join(done.output.split())
    for word in words:
        assert word in told, told
    assert "Traceback" not in told


def test_every_error_of_a_study_at_once(files):
    case, study = files(16)
    study.write_text(
        study.read_text().replace("samples = 16", "samples = 0").replace('normal"\nmean', 'bell"\nmean')
    )
    with pytest.raises(CaseError) as error:
        read_study(study, load_case(case))
    assert len(error.value.problems) == 2


def test_the_example_study_fits_its_panel(tmp_path):
    examples = Path(__file__).parent.parent / "examples"
    case = load_case(examples / "panel.toml")
    study = read_study(examples / "studies" / "panel.toml", case)
    few = replace(study, samples=4)
    ensemble = propagate(case, few, tmp_path / "samples.csv")
    assert not ensemble.failed
    # Drag goes with the square of the current, and the shape of a taut panel hardly changes with it.
    low, high = ensemble.tornado()[4, :, 1] / ensemble.runs[0].outputs[1]
    slow, fast = study.inputs[4].quantile(np.array([0.05, 0.95])) / 0.5
    assert (low, high) == pytest.approx((slow**2, fast**2), rel=1e-3)
