"""fyke run --uncertainty: what uncertain inputs make of the figures of a case."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.text import Text

from ..case import Case, CaseError, Problem, load_case
from ..report.figures import write_figure
from ..report.uncertainty import bands, tornado
from ..results import finite_or_none, unit_of
from ..results.whole import replacing
from ..study.inputs import Study, read_study
from ..study.uncertainty import DONE as ARRIVED
from ..study.uncertainty import Ensemble, propagate
from .load_cases import Wishes
from .progress import progress_bar
from .show import DONE, NOT_CONVERGED, WRONG_INPUT, print_json, print_problems, stderr, stdout

SAMPLES, FIGURES = "samples.csv", "uncertainty.json"
PICTURES = ("tornado", "bands")
# Runs that failed which are told one by one.
MOST_TOLD = 3


def run_study(file: Path, study_file: Path, wishes: Wishes, *, jobs: int) -> int:
    """Run a study of a case file and return the exit code."""
    folder = wishes.output or Path(f"{file.stem}-{study_file.stem}")
    try:
        case = load_case(file)
        study = read_study(study_file, case)
        _claim(folder, wishes)
        with progress_bar(stderr(), shown=wishes.talk, doing="sampling") as show:
            ensemble = propagate(
                case,
                study,
                folder / SAMPLES,
                jobs=jobs,
                resume=wishes.resume,
                on_progress=lambda done, of: show(done / of, f"{done} of {of} runs"),
            )
    except CaseError as error:
        print_problems(error.problems)
        return WRONG_INPUT
    except KeyboardInterrupt:
        stderr().print(f"interrupted: what is done is in {folder / SAMPLES}; go on with --resume")
        return NOT_CONVERGED
    if len(ensemble.runs) == 1:
        stderr().print(Text(f"the case itself fails: {ensemble.runs[0].outcome}"))
        return NOT_CONVERGED
    figures = _figures(case, ensemble)
    _write(folder, ensemble, figures, wishes)
    if wishes.json:
        print_json(figures)
    elif wishes.talk:
        _show(stdout(), case.title or file.stem, figures, folder)
    for run in ensemble.failed[:MOST_TOLD] if not wishes.json else ():
        stderr().print(Text(f"run {run.number}: {run.outcome}"))
    return DONE if not ensemble.failed else NOT_CONVERGED


def _claim(folder: Path, wishes: Wishes) -> None:
    """Make the folder; CaseError where it cannot be made or holds a study."""
    where = f"output folder {folder}"
    if (folder / SAMPLES).exists() and not (wishes.overwrite or wishes.resume):
        cure = (
            "add --resume to go on with it, --overwrite to replace it, or choose another folder with -o DIR"
        )
        allowed = "a folder without a study"
        raise CaseError([Problem(where, f"an earlier study: {SAMPLES}", allowed, cure)])
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not wishes.resume:
            pictures = [f"{name}.{kind}" for name in PICTURES for kind in ("png", "svg")]
            for name in (SAMPLES, FIGURES, *pictures):
                (folder / name).unlink(missing_ok=True)
    except OSError as error:
        cure = "choose another folder with -o DIR"
        raise CaseError(
            [Problem(where, error.strerror or str(error), "a folder to write to", cure)]
        ) from None


def _figures(case: Case, ensemble: Ensemble) -> dict[str, Any]:
    """Return what was found, ready for JSON: SI units; tornado: by input, then output, at its low and high value."""
    study, found = ensemble.study, ensemble.tornado()
    spreads = {name: asdict(one) for name, one in ensemble.spreads().items()}
    return {
        "title": case.title,
        "case_sha256": case.sha256,
        "study_sha256": study.sha256,
        "samples": study.samples,
        "method": study.method,
        "seed": study.seed,
        "failed": sum(run.outcome != ARRIVED for run in ensemble.runs),
        "outputs": {
            name: {"unit": unit_of(name)} | {key: finite_or_none(value) for key, value in one.items()}
            for name, one in spreads.items()
        },
        "tornado": {
            one.key: {
                name: [finite_or_none(value) for value in found[row, :, place].tolist()]
                for place, name in enumerate(study.outputs)
            }
            for row, one in enumerate(study.inputs)
        },
    }


def _write(folder: Path, ensemble: Ensemble, figures: dict[str, Any], wishes: Wishes) -> None:
    with replacing(folder / FIGURES) as part:
        part.write_text(json.dumps(figures, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    samples = ensemble.samples
    if wishes.figures and len(samples):
        study = ensemble.study
        outputs = {name: unit_of(name) for name in study.outputs}
        nominal = np.array(ensemble.runs[0].outputs)
        drawn = tornado(
            [_named(study, row) for row in range(len(study.inputs))], outputs, nominal, ensemble.tornado()
        )
        write_figure(drawn, folder / PICTURES[0])
        write_figure(bands(outputs, nominal, samples), folder / PICTURES[1])


def _named(study: Study, row: int) -> str:
    """Name an input by its key without the table, with its low and high value."""
    one = study.inputs[row]
    low, high = one.quantile(np.array([0.05, 0.95]))
    unit = f" {one.unit}" if one.unit else ""
    return f"{one.key.split('.', 1)[-1]}\n{low:.3g} to {high:.3g}{unit}"


def _show(console: Console, title: str, figures: dict[str, Any], folder: Path) -> None:
    console.print(Text(title, style="bold"))
    console.print(Text(f"  {figures['samples']} samples, {figures['method']}, seed {figures['seed']}"))
    console.print(
        Text(f"  {'':<22}{'the case':>10}{'mean':>10}{'deviation':>10}{'5 %':>10}{'95 %':>10}", style="dim")
    )
    for name, one in figures["outputs"].items():
        numbers = "".join(
            f"{'-' if one[key] is None else format(one[key], '.4g'):>10}"
            for key in ("nominal", "mean", "deviation", "low", "high")
        )
        told = f"{name} ({one['unit']})" if one["unit"] else name
        console.print(Text(f"  {told:<22.22}{numbers}"))
    console.print(Text("Change of each output, with one input at its 5 and 95 % quantile", style="bold"))
    for name, one in figures["outputs"].items():
        rows = [(key, found[name]) for key, found in figures["tornado"].items()]
        known = [
            (key, low - one["nominal"], high - one["nominal"])
            for key, (low, high) in rows
            if None not in (low, high)
        ]
        for key, low, high in sorted(known, key=lambda row: -max(abs(row[1]), abs(row[2]))):
            console.print(
                Text(f"  {name:<18.18} {key:<34.34} {low:>+10.3g} {high:>+10.3g} {one['unit']}".rstrip())
            )
    console.print(Text(f"wrote {folder}", style="dim"), soft_wrap=True)
