"""What must hold of motions: what is moved is held, nothing is missing, and the run can follow."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from ..netting.net import Net
from ..netting.references import edges_of, is_gear, knots_named
from .errors import CaseError, Problem
from .keys import nearest
from .motion import MotionRecord, MotionSpec
from .places import Path
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts
    from .schema import Case, DynamicSolve

ROUNDING = 1e-9  # of a duration that a record must last
MOST_LAID = 200_000  # meshes that are laid to see which knots are held


def motion_findings(parts: Parts, solve: DynamicSolve | None) -> Iterator[Finding]:
    """Everything that is wrong with [[motion]]; solve: of a dynamic case that is good by itself."""
    specs = _specs(parts)
    nets = _laid(parts) if any(spec.of for spec in specs.values()) else []
    for index, spec in specs.items():
        path: Path = ("motion", index)
        record = _record(spec)
        yield from _keys(path, spec, record)
        yield from _static(path, spec, parts) if parts.is_static else ()
        for place, name in enumerate(spec.of or ()):
            yield from _held((*path, "of", place), name, parts, nets)
        if solve is not None and record is not None:
            yield from _lasting(path, spec, record, solve.duration)
    if solve is not None and specs:
        yield from _solver(specs, solve)


def motion_file_problems(parts: Parts) -> Iterator[tuple[Path, Problem]]:
    """Every fault of the files of motions, with the key that names the file."""
    for index, spec in _specs(parts).items():
        try:
            spec.record()
        except CaseError as error:
            for number, problem in enumerate(error.problems):
                yield ("motion", index, "file", number), problem


def motion_oddities(case: Case) -> Iterator[str]:
    """Yield what is allowed of motions but looks odd."""
    if case.motion and case.solve.kind == "static":
        yield "[[motion]] plays no part in a static case, which is that of the net as built."
        return
    for number, spec in enumerate(case.motion, 1):
        if spec.ramp is not None and case.solve.kind == "dynamic" and spec.ramp > case.solve.duration:
            yield (
                f"[[motion]] {number} does not reach its full strength: its ramp takes {spec.ramp:g} s, the run "
                f"{case.solve.duration:g} s."
            )


def _specs(parts: Parts) -> dict[int, MotionSpec]:
    """Motions that are good by themselves, by their place in the file."""
    raw, out = parts.raw.get("motion"), {}
    for index, keys in enumerate(raw if isinstance(raw, list) else []):
        try:
            out[index] = MotionSpec.model_validate(keys)
        except ValidationError:
            continue
        out[index].settle(parts.folder)
    return out


def _record(spec: MotionSpec) -> MotionRecord | None:
    try:
        return spec.record()
    except CaseError:
        return None  # told with its rows


def _keys(path: Path, spec: MotionSpec, record: MotionRecord | None) -> Iterator[Finding]:
    """Whether it moves, and every swing has a period."""
    turn = spec.rotation
    if all(one is None for one in (spec.velocity, spec.amplitude, spec.rotation, spec.file)):
        allowed = "velocity, amplitude and period, rotation or file"
        yield (*path, "velocity"), "nothing that moves", allowed, "add velocity = [-0.5, 0.0, 0.0]"
    if spec.amplitude is not None and spec.period is None:
        yield (*path, "period"), "amplitude without period", "period, s, of the swing", 'add period = "6 s"'
    swings = spec.amplitude is not None or (turn is not None and turn.amplitude is not None)
    if spec.period is not None and not swings:
        cure = "add amplitude = [0.0, 0.0, 0.5], or leave period out"
        yield (*path, "period"), "period without amplitude", "both of them", cure
    if "phase" in spec.model_fields_set and spec.amplitude is None:
        yield (*path, "phase"), "phase without amplitude", "phase of a swing", "leave phase out"
    if turn is not None:
        yield from _turn((*path, "rotation"), spec, record)


def _turn(path: Path, spec: MotionSpec, record: MotionRecord | None) -> Iterator[Finding]:
    turn = spec.rotation
    if turn is None:
        return
    given = [key for key in ("amplitude", "rate") if getattr(turn, key) is not None]
    of_file = spec.file is not None and (record is None or record.angles is not None)
    if len(given) == 2:
        allowed = "amplitude, to and fro, or rate, on and on"
        yield (
            (*path, "rate"),
            "both amplitude and rate",
            allowed,
            "leave out one of them, or write two [[motion]]",
        )
    elif not given and not (of_file and turn.axis is None):
        cure = 'add amplitude = "5 deg" and period = "6 s", or rate = "10 deg/s"'
        yield (*path, "amplitude"), "neither amplitude nor rate", "one of them, or a file with angles", cure
    if given and turn.axis is None:
        yield (
            (*path, "axis"),
            "nothing",
            "axis, the direction about which it turns",
            "add axis = [0.0, 1.0, 0.0]",
        )
    if turn.amplitude is not None and turn.period is None and spec.period is None:
        yield (*path, "period"), "amplitude without period", "period, s, of the swing", 'add period = "6 s"'
    for key in ("period", "phase"):
        if key in turn.model_fields_set and turn.amplitude is None:
            yield (*path, key), f"{key} without amplitude", f"{key} of a swing", f"leave {key} out"


def _static(path: Path, spec: MotionSpec, parts: Parts) -> Iterator[Finding]:
    """A tow has no equilibrium in water that stands still; the water that goes past it has one."""
    if spec.rotation is not None and spec.rotation.rate is not None:
        cure = 'write kind = "dynamic" and a duration in [solve]'
        yield (*path, "rotation", "rate"), "a steady rotation in a static case", "a dynamic case", cure
    if spec.velocity is None or not any(spec.velocity):
        return
    cure = 'give the current as it is seen from what is towed, or write kind = "dynamic" in [solve]'
    current: Any = parts.raw.get("current")
    water = current.get("velocity") if isinstance(current, dict) and current.keys() == {"velocity"} else None
    if isinstance(water, list) and all(isinstance(one, int | float) for one in water) and len(water) == 3:
        seen = [round(u - v, 12) + 0.0 for u, v in zip(water, spec.velocity, strict=True)]
        cure = f"leave it out and write velocity = {written(seen)} in [current], as seen from what is towed"
    yield (*path, "velocity"), f"{written(list(spec.velocity))} in a static case", "a dynamic case", cure


def _laid(parts: Parts) -> list[Net]:
    """All netting that can be built by itself, what is very large apart; build_system judges that, too."""
    nets = []
    for index, piece in parts.pieces.items():
        netting = parts.nettings.get(piece.netting)
        twine = parts.twines.get(netting.twine) if netting else None
        if netting is None or twine is None or not piece.sized:
            continue
        if sum(sheet.meshes[0] * sheet.meshes[1] for sheet in piece.sheets(netting)) > MOST_LAID:
            continue
        try:
            piece.call(parts.name_of(index))
            piece.settle(netting)
            nets.append(piece.lay(netting, twine.twine(netting.twine)))
        except (ValueError, ArithmeticError):
            continue  # wrong itself, and told
    return nets


def _held(path: Path, name: str, parts: Parts, nets: list[Net]) -> Iterator[Finding]:
    """What is wrong with something that is to be moved."""
    found = [(net, knots) for net in nets if len(knots := knots_named(net, name))]
    if not found:
        names = [parts.name_of(index) for index, _ in parts.gear_tables()]
        own = name.partition(":")[0] if ":" in name else name if name in names else name.rpartition(".")[0]
        told = own in names and (own not in parts.netting_names or own not in _known(nets))
        if not told:  # else a gear that is wrong itself, or one whose knots are known when it is built
            yield _unknown(path, name, names, nets)
        return
    free = sum(int((~net.fixed[knots]).sum()) for net, knots in found)
    count = sum(len(knots) for _, knots in found)
    whole = any(is_gear(net, name) for net, _ in found)
    if free == count or (free and not whole):
        which = "its knot is free" if count == 1 else f"{free} of its {count} knots are free"
        allowed = "knots that are held: what is free moves as the water and its bars push it"
        held = _held_edges(nets)
        cure = f"name what is held, such as {written(held[0])}" if held else "hold it by fixed of its gear"
        yield (
            path,
            f"{written(name)}: {which}",
            allowed,
            cure + ", or leave of out for all that is held" * bool(held),
        )


def _known(nets: list[Net]) -> set[str]:
    return {panel.name for net in nets for panel in net.panels}


def _held_edges(nets: list[Net]) -> list[str]:
    edges = [
        (net, f"{panel.name}.{side}") for net in nets for panel in net.panels for side in edges_of(panel)
    ]
    return [edge for net, edge in edges if net.fixed[knots_named(net, edge)].all()]


def _unknown(path: Path, name: str, names: list[str], nets: list[Net]) -> Finding:
    allowed = "NAME.EDGE of netting, the label of a knot, or the name of gear: " + (
        ", ".join(written(one) for one in names if one) or "leave of out for all held knots"
    )
    if ":" in name and name.partition(":")[0] in names:
        return path, written(name), allowed, "choose a knot that is there; knots.csv of a run lists them"
    near = nearest(name, [*(one for one in names if one), *_held_edges(nets)])
    cure = (
        f'did you mean "{near}"?'
        if near
        else "leave of out for all held knots; knots.csv of a run lists labels"
    )
    return path, written(name), allowed, cure


def _lasting(path: Path, spec: MotionSpec, record: MotionRecord, duration: float) -> Iterator[Finding]:
    last = float(record.times[-1])
    if last < duration * (1.0 - ROUNDING):
        found = f"{written(spec.file)}, which lasts {last:g} s"
        allowed = f"a record as long as the duration of {duration:g} s"
        yield (*path, "file"), found, allowed, "shorten the duration, or add rows to the file"


def _solver(specs: dict[int, MotionSpec], solve: DynamicSolve) -> Iterator[Finding]:
    """What the solver cannot do with moved knots."""
    if solve.stepper in ("verner", "symplectic"):
        found = f'"{solve.stepper}" with [[motion]], which explicit steps do not know'
        allowed = '"auto", "implicit" or "newmark" with [[motion]]'
        yield ("solve", "stepper"), found, allowed, 'write stepper = "implicit", or leave it out'
    if solve.start == "equilibrium" and any(spec.velocity is not None for spec in specs.values()):
        found = '"equilibrium" with a tow, which moves from the beginning'
        yield ("solve", "start"), found, '"built" with a tow', "leave start out; give the tow a ramp"
    towed = all(one is None for spec in specs.values() for one in (spec.amplitude, spec.rotation, spec.file))
    for key in ("settle_force", "settle_energy"):
        if getattr(solve, key) is None or (towed and key == "settle_force"):
            continue
        found = f"{key} with a {'tow' if towed else 'motion to and fro'}"
        allowed = "settle_force, of nets that are towed at a constant velocity"
        yield ("solve", key), found, allowed, "write settle_force instead" if towed else f"leave {key} out"
