"""A study of uncertainty as its file says it: which values of a case are uncertain, and how."""

from __future__ import annotations

import hashlib
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case import Case
from ..case.errors import CaseError, Problem
from ..case.keys import nearest, unknown_keys
from ..case.vary import Value, value_at

Array = NDArray[np.float64]

METHODS = ("latin-hypercube", "sobol")
# Numbers that each distribution takes, least first.
DISTRIBUTIONS = {
    "normal": ("mean", "deviation"),
    "uniform": ("low", "high"),
    "triangular": ("low", "mode", "high"),
}
MOST_SAMPLES = 1_000_000
_KEYS = {"samples", "method", "seed", "outputs", "input"}
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*?)?\s*")


@dataclass(frozen=True)
class Input:
    """One uncertain value: numbers of its distribution, in the unit, or over the value of the case when relative.

    nominal: the value of the case, in the unit; None where the case leaves it out.
    """

    key: str
    distribution: str
    numbers: tuple[float, ...]
    unit: str
    relative: bool
    nominal: float | None

    def quantile(self, part: Array) -> Array:
        """Return the values below which so many parts (0 to 1) of the samples lie, in the unit."""
        from scipy.stats import norm, triang

        if self.distribution == "normal":
            mean, deviation = self.numbers
            drawn = norm.ppf(part, mean, deviation)
        elif self.distribution == "uniform":
            low, high = self.numbers
            drawn = low + (high - low) * part
        else:
            low, mode, high = self.numbers
            drawn = triang.ppf(part, (mode - low) / (high - low), low, high - low)
        return np.asarray(drawn * self.nominal if self.relative and self.nominal is not None else drawn)

    def written(self, value: float) -> Value:
        """Write a value as the case file has it."""
        return f"{value!r} {self.unit}" if self.unit else value


@dataclass(frozen=True)
class Study:
    """What is uncertain, how it is sampled, and which figures of the summary are asked for; sha256: of the file."""

    inputs: tuple[Input, ...]
    outputs: tuple[str, ...]
    samples: int
    method: str
    seed: int
    sha256: str

    def points(self) -> Array:
        """Return the samples as parts (0 to 1) of the distributions, (samples, inputs)."""
        from scipy.stats import qmc

        count = len(self.inputs)
        if self.method == "sobol":
            # The whole power of two, of which the first are taken: those have Sobol's balance as far as it goes.
            power = int(np.ceil(np.log2(max(self.samples, 1))))
            return np.asarray(qmc.Sobol(count, rng=self.seed).random_base2(power)[: self.samples])
        return np.asarray(qmc.LatinHypercube(count, rng=self.seed).random(self.samples))


def read_study(file: Path, case: Case) -> Study:
    """Read a study of a case. Raises CaseError with all that is wrong with it."""
    try:
        text = file.read_text(encoding="utf-8")
        raw = tomllib.loads(text)
    except (OSError, ValueError) as error:
        found = getattr(error, "strerror", None) or str(error)
        cure = "check the name and the TOML"
        raise CaseError([Problem(str(file), found, "a study of uncertainty (TOML)", cure)]) from None
    problems = [*unknown_keys(str(file), raw, _KEYS)]
    samples = raw.get("samples", 0)
    if not _is_whole(samples) or not 2 <= samples <= MOST_SAMPLES:
        allowed = f"a whole number from 2 to {MOST_SAMPLES:,}"
        problems.append(Problem(f"{file}, samples", _told(raw, "samples"), allowed, "write samples = 1000"))
    method = raw.get("method", METHODS[0])
    if method not in METHODS:
        problems.append(Problem(f"{file}, method", repr(method), ", ".join(METHODS), "write one of these"))
    seed = raw.get("seed", 0)
    if not _is_whole(seed) or seed < 0:
        problems.append(Problem(f"{file}, seed", repr(seed), "a whole number from 0", "write seed = 1"))
    outputs = raw.get("outputs", [])
    if not (isinstance(outputs, list) and outputs and all(isinstance(one, str) for one in outputs)):
        allowed = "keys of summary.json that are numbers, as max_tension, drag, support_reaction.1"
        problems.append(Problem(f"{file}, outputs", _told(raw, "outputs"), allowed, "name one at least"))
    given = raw.get("input", [])
    if not (isinstance(given, list) and given):
        allowed = "[[input]] tables with key and distribution"
        problems.append(Problem(f"{file}, input", _told(raw, "input"), allowed, "add an [[input]]"))
        given = []
    inputs = [_input(f"{file}, [[input]] {n}", one, case, problems) for n, one in enumerate(given, 1)]
    keys = [one.key for one in inputs if one]
    for key in sorted({key for key in keys if keys.count(key) > 1}):
        problems.append(
            Problem(f"{file}, input", f"'{key}' twice", "every key once", "leave out one of the two")
        )
    if problems:
        raise CaseError(problems)
    return Study(
        inputs=tuple(one for one in inputs if one),
        outputs=tuple(outputs),
        samples=samples,
        method=method,
        seed=seed,
        sha256=hashlib.sha256(text.encode()).hexdigest(),
    )


def _input(where: str, raw: Any, case: Case, problems: list[Problem]) -> Input | None:
    """Read one input, or add to the problems what is wrong with it."""
    if not isinstance(raw, dict):
        problems.append(Problem(where, repr(raw), "a table", "write [[input]]"))
        return None
    wanted = DISTRIBUTIONS.get(str(raw.get("distribution")))
    if wanted is None:
        allowed, near = ", ".join(DISTRIBUTIONS), nearest(str(raw.get("distribution")), list(DISTRIBUTIONS))
        cure = f"did you mean '{near}'?" if near else "write one of these"
        problems.append(Problem(f"{where}, distribution", _told(raw, "distribution"), allowed, cure))
        return None
    wrong = unknown_keys(where, raw, {"key", "distribution", "relative", *wanted})
    read = {name: _number(f"{where}, {name}", raw, name, wrong) for name in wanted}
    relative = raw.get("relative", False)
    key, nominal, unit = str(raw.get("key", "")), None, ""
    units = {one[1] for one in read.values() if one}
    try:
        there = value_at(case, key, where=where)
        nominal, unit = _parts(there) if there is not None else (None, "")
    except CaseError as error:
        wrong += error.problems
    else:
        wrong += _unfit(where, key, there, nominal, units, relative=bool(relative))
    numbers = tuple(one[0] for one in read.values() if one)
    if len(numbers) == len(wanted):
        wrong += _out_of_order(where, raw["distribution"], numbers)
    problems += wrong
    if wrong:
        return None
    return Input(
        key, raw["distribution"], numbers, unit if relative else units.pop(), bool(relative), nominal
    )


def _unfit(
    where: str, key: str, there: Any, nominal: float | None, units: set[str], *, relative: bool
) -> list[Problem]:
    """Judge a distribution beside the value that the case has."""
    if there is not None and nominal is None:
        cure = "name one number: values of a list by their number, as gear.1.size.2"
        return [Problem(f"{where}, key", f"{key} = {there!r}", "a number, or a text with a unit", cure)]
    if relative and nominal is None:
        cure = "leave out relative, or write the value into the case file"
        return [Problem(f"{where}, relative", f"{key} is not in the case file", "a value to multiply", cure)]
    if relative and units - {""}:
        return [
            Problem(
                where, f"relative, in {', '.join(units)}", "plain numbers", "write 1.0 for the value itself"
            )
        ]
    if len(units) > 1:
        told = ", ".join(sorted(one or "no unit" for one in units))
        return [Problem(where, told, "one unit for all its numbers", "write them in one unit")]
    return []


def _out_of_order(where: str, distribution: str, numbers: tuple[float, ...]) -> list[Problem]:
    if distribution == "normal":
        wrong = numbers[1] <= 0.0
        allowed = "a deviation above 0"
    else:
        wrong = list(numbers) != sorted(numbers) or numbers[0] == numbers[-1]
        allowed = f"{' below or at '.join(DISTRIBUTIONS[distribution])}, the first below the last"
    found = ", ".join(f"{number:g}" for number in numbers)
    return [Problem(where, found, allowed, "put them in order")] if wrong else []


def _number(where: str, raw: dict[str, Any], name: str, wrong: list[Problem]) -> tuple[float, str] | None:
    number, unit = _parts(raw[name]) if name in raw else (None, "")
    if number is None or not np.isfinite(number):
        wrong.append(
            Problem(where, _told(raw, name), 'a number, or a text such as "1.0 GPa"', f"give {name}")
        )
        return None
    return number, unit


def _parts(value: Any) -> tuple[float | None, str]:
    """Return number and unit of a value, (None, "") where it is none."""
    if isinstance(value, str):
        match = _NUMBER.fullmatch(value)
        return (float(match[1]), match[2] or "") if match else (None, "")
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None, ""
    return float(value), ""


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _told(raw: dict[str, Any], key: str) -> str:
    return repr(raw[key]) if key in raw else "nothing"
