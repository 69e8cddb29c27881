"""What must hold between the keys of the current, the sea bed and the gear, and within the current's file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, ValidationError

from ..water import SeriesCurrent
from .current import Current, DepthTable, Moment, Profile
from .current_file import read_current
from .errors import CaseError, Problem
from .fields import Length, Time
from .places import Path
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts
    from .schema import Case, Water

# Of a time, so that a run to the very end of a file is not refused for a rounding.
ROUNDING = 1e-9
ONE = ("velocity", "speed", "direction")
_EXAMPLE = "velocity = [0.5, 0.0, 0.0]"


def current_findings(parts: Parts) -> Iterator[Finding]:
    """What is wrong between the keys of [current], and with the times asked of its file."""
    keys = _table(parts, "current")
    if not isinstance(parts.raw.get("current"), dict):
        return
    yield from _choice(keys)
    if "file" not in keys:
        yield from _pair(("current",), keys)
    yield from _profile(parts, keys)
    if "at" in keys and "file" not in keys:
        cure = "leave at out: there is no other time to begin at"
        yield ("current", "at"), written(keys["at"]), "at with a file only, whose times it counts in", cure
    yield from _times(parts, keys)


def current_file_problems(parts: Parts) -> Iterator[Problem]:
    """Every fault of the file of the current."""
    _, problems = _read(parts, _table(parts, "current"))
    yield from problems


def sea_bed_findings(parts: Parts) -> Iterator[Finding]:
    """Gear that reaches below the sea bed."""
    bed = _depth(parts)
    for index, piece in parts.pieces.items():
        netting = parts.nettings.get(piece.netting)
        heights = piece.heights(netting) if netting else None
        if bed is not None and heights is not None and heights[0] < -bed:
            found = f"its lowest knots are at z = {heights[0]:.6g} m"
            key = "centre" if "centre" in type(piece).model_fields else "top"
            cure = f"raise its {key}, or check [water] depth"
            yield ("gear", index, key), found, f"gear above the sea bed at z = {-bed:g} m", cure


def bed_findings(parts: Parts, water: Water | None) -> Iterator[Finding]:
    """A sea bed lies at a depth."""
    if "bed" in parts.raw and water is not None and water.depth is None:
        allowed = "a depth in [water] beside [bed]: the bed lies that far below still water"
        yield ("water", "depth"), "nothing", allowed, "add depth = 20.0 to [water]"


def current_oddities(case: Case) -> Iterator[str]:
    """Sentences about a current that is allowed but looks odd; file and all keys are good."""
    current = case.current
    if current.ramp is not None and case.solve.kind == "static":
        yield "The ramp of the current plays no part in a static case, which has it at full strength."
    elif current.ramp is not None and case.solve.kind == "dynamic" and current.ramp > case.solve.duration:
        yield (
            f"The current does not reach its full strength: its ramp takes {current.ramp:g} s, the run "
            f"{case.solve.duration:g} s."
        )
    last = current.lowest
    heights = [piece.heights(case.netting[piece.netting]) for piece in case.pieces]
    deepest = -min((height[0] for height in heights if height is not None), default=0.0)
    if last is not None and deepest > last:
        yield (
            f"The current is given down to {last:g} m and the gear reaches {deepest:.4g} m; below its last depth "
            "it is held."
        )


def _table(parts: Parts, name: str) -> dict[str, Any]:
    table = parts.raw.get(name)
    return table if isinstance(table, dict) else {}


def _value(kind: Any, value: Any) -> Any:
    """Return a value of the file in SI, None where it is wrong."""
    try:
        return TypeAdapter(kind).validate_python(value)
    except ValidationError:
        return None


def _depth(parts: Parts) -> float | None:
    depth: float | None = _value(Length, _table(parts, "water").get("depth"))
    return depth


def _choice(keys: dict[str, Any]) -> Iterator[Finding]:
    """Velocity, speed with direction, a table of depths or a file: one of them."""
    profile = keys.get("profile")
    kind = profile.get("kind") if isinstance(profile, dict) else None
    given = [key for key in ONE if key in keys]
    if "file" in keys:
        for key in (*given, *(["profile"] if "profile" in keys else [])):
            cure = f"leave out {key} or file"
            yield (
                ("current", key),
                f"both {key} and file",
                "a file, which holds the whole current, alone",
                cure,
            )
    elif kind in ("layers", "table"):
        for key in given:
            found = f'{key} beside a profile of kind "{kind}"'
            cure = f"leave {key} out here; the profile has its own velocities"
            yield ("current", key), found, f"{key} of the whole water or of a power law", cure
    elif "velocity" in keys:
        more = " and ".join(given[1:])
        if more:
            allowed, cure = "velocity, or speed and direction", f"leave out {more}, or velocity"
            yield ("current", given[1]), f"both velocity and {more}", allowed, cure
    elif not given and (profile is None or kind == "power") and keys.keys() <= Current.model_fields.keys():
        allowed = "velocity, or speed and direction, or a file"
        yield ("current", "velocity"), "nothing of these", allowed, f"add {_EXAMPLE}"


def _pair(path: Path, keys: dict[str, Any]) -> Iterator[Finding]:
    """Speed and direction go together."""
    for key, other, sample in (("speed", "direction", '"15 deg"'), ("direction", "speed", "0.5")):
        if key in keys and other not in keys and "velocity" not in keys:
            cure = f"add {other} = " + (f"[{sample}, ...]" if len(path) > 1 else sample)
            yield (*path, other), f"{key} without {other}", "speed and direction", cure


def _profile(parts: Parts, keys: dict[str, Any]) -> Iterator[Finding]:
    raw, path = keys.get("profile"), ("current", "profile")
    if not isinstance(raw, dict):
        return
    if raw.get("kind") == "power" and "depth" not in _table(parts, "water"):
        allowed = "the depth of the sea bed, m, from which a power law counts"
        yield ("water", "depth"), "nothing", allowed, "add depth = 20.0 to [water]"
    if raw.get("kind") in ("layers", "table"):
        yield from _pair(path, raw)
        if "velocity" in raw and (raw.keys() & {"speed", "direction"}):
            found, cure = "velocity beside speed or direction", "leave out the one or the other"
            yield (*path, "velocity"), found, "velocity, or speed and direction", cure
        elif not raw.keys() & set(ONE) and raw.keys() <= {"kind", "depth"}:
            cure = "add velocity = [[0.5, 0.0, 0.0], ...]"
            yield (*path, "velocity"), "nothing", "velocity, or speed and direction, for every depth", cure
    profile = _value(Profile, raw)
    if isinstance(profile, DepthTable):
        yield from _lengths(path, profile)
        yield from _depths(path, profile, _depth(parts))


def _lengths(path: Path, profile: DepthTable) -> Iterator[Finding]:
    many = len(profile.depth)
    for key in ONE:
        values = getattr(profile, key)
        if values is not None and len(values) != many:
            found = f"{len(values)} beside {many} depths"
            yield (*path, key), found, f"one {key} for every depth", "give as many of them as depths"


def _depths(path: Path, profile: DepthTable, bed: float | None) -> Iterator[Finding]:
    for i, depth in enumerate(profile.depth):
        if bed is not None and depth > bed:
            allowed = f"a depth down to the sea bed at {bed:g} m"
            yield (*path, "depth", i), f"{depth:g} m", allowed, "leave it out, or check [water] depth"


def _read(parts: Parts, keys: dict[str, Any]) -> tuple[SeriesCurrent | None, tuple[Problem, ...]]:
    """Read the file that is named, if any: what it holds, or what is wrong with it."""
    if not isinstance(keys.get("file"), str):
        return None, ()
    try:
        return read_current(parts.folder / keys["file"], _depth(parts)), ()
    except CaseError as error:
        return None, error.problems


def _times(parts: Parts, keys: dict[str, Any]) -> Iterator[Finding]:
    """The times of a run must be in the file; one of a single time is steady."""
    series, _ = _read(parts, keys)
    if series is None or series.steady:
        return
    first, last = (float(one) for one in series.times[[0, -1]])
    allowed = f"times that {keys['file']} has: {first:.10g} to {last:.10g} s"
    start = _value(Moment, keys["at"]) if "at" in keys else first
    if start is None:
        return
    margin = ROUNDING * max(abs(first), abs(last))
    if not first - margin <= start <= last + margin:
        found = f"{written(keys['at'])}: the file is without the times asked for"
        yield ("current", "at"), found, allowed, "begin at a time that it has, or add rows to it"
        return
    solve = _table(parts, "solve")
    duration = _value(Time, solve.get("duration")) if solve.get("kind") == "dynamic" else None
    if duration is not None and start + duration > last + margin:
        found = f"{duration:g} s from {start:.10g} s on, to {start + duration:.10g} s: "
        found += "the file is without the times asked for"
        cure = "shorten the duration, begin earlier with [current] at, or add rows to the file"
        yield ("solve", "duration"), found, allowed, cure
