"""What a case may hold but looks odd: warnings with the number and the limit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..netting.lattice import hanging_ratios
from .gear import LARGEST_STRAIN
from .grouping import rounded
from .motion_check import motion_oddities
from .schema import Case
from .sewing import tried
from .water_check import current_oddities
from .waves import wave_oddities

LEAST_HANGING = 0.05
AT_SURFACE = 1e-6  # m, above which a knot is above still water and not only by rounding


def warnings(case: Case) -> tuple[str, ...]:
    """Return one sentence for everything that looks odd in a checked case."""
    return (
        *_floating(case),
        *_thin_knots(case),
        *_frames(case),
        *_unused(case),
        *_no_effect(case),
        *_seams(case),
        *_waves(case),
        *_sheltered_twice(case),
        *_above_water(case),
        *_groundless(case),
        *rounded([(piece, case.netting[piece.netting]) for piece in case.pieces]),
        *current_oddities(case),
        *motion_oddities(case),
    )


def _floating(case: Case) -> Iterator[str]:
    water = case.water.density
    for name, twine in case.twine.items():
        density = twine.mean_density or 0.0
        if density < water:
            yield (f"Twine '{name}' floats: {density:g} kg/m3 is below the water's {water:g} kg/m3.")
    for name, netting in case.netting.items():
        if netting.knot_diameter and netting.knot_density and netting.knot_density < water:
            yield (
                f"The knots of netting '{name}' float: {netting.knot_density:g} kg/m3 is below "
                f"the water's {water:g} kg/m3."
            )


def _thin_knots(case: Case) -> Iterator[str]:
    for name, netting in case.netting.items():
        knot, twine = netting.knot_diameter, case.twine[netting.twine].diameter
        if knot is not None and knot < twine:
            yield (
                f"The knots of netting '{name}' are thinner than its twine: {knot * 1e3:g} mm against "
                f"{twine * 1e3:g} mm."
            )


def _frames(case: Case) -> Iterator[str]:
    for netting, sheet in case.sheets:
        shape = "netting" if sheet.closed else "panel"
        what = f"{shape} '{sheet.name}'" if sheet.name else f"the {shape}"
        on, sides = ("its frame", ("width", "height"))
        if sheet.rims:
            on, sides = ("its rims", ("mean way round", "height along the netting"))
        if sheet.sides:
            on, sides = ("the box", ("way round", "depth"))
        strain = sheet.strain(netting)
        # Rounding alone must not warn: a netting hung at E1^2 + E2^2 = 1 is just taut.
        if strain > 1e-9:
            yield (
                f"The bars of {what} are stretched on {on}: their strain is {strain * 100:.2g} % "
                f"(refused above {LARGEST_STRAIN * 100:g} %)."
            )
        hung = hanging_ratios(netting.mesh, sheet.meshes, netting.bar_length, sheet.size)
        for side, ratio in zip(sides, hung, strict=True):
            if ratio < LEAST_HANGING:
                yield (
                    f"The {side} of {what} is {ratio * 100:.2g} % of the stretched netting "
                    f"(odd below {LEAST_HANGING * 100:g} %); check the unit of its size."
                )


def _unused(case: Case) -> Iterator[str]:
    worn = {piece.netting for piece in case.pieces}
    for name in sorted(case.netting.keys() - worn):
        yield f"Netting '{name}' is not used by any gear."
    spun = {netting.twine for netting in case.netting.values()} | {rope.twine for rope in case.ropes}
    spun |= {piece.twine for line in case.lines for piece in line.asked}
    spun |= {line.twine for line in case.lines if line.twine is not None}
    also = " or rope" * bool(case.ropes) + " or line" * bool(case.lines)
    for what in ("twine", "chain"):
        for name in sorted(getattr(case, what).keys() - spun):
            yield f"{what.capitalize()} '{name}' is not used by any netting{also}."
    for name in sorted(case.tube.keys() - {part.tube for part in case.tubulars}):
        yield f"Tube '{name}' is not used by any ring or collar."
    made = {twine.material for twine in case.twine.values()} | {tube.material for tube in case.tube.values()}
    for name in sorted(case.material.keys() - made):
        yield f"Material '{name}' is not used by any twine" + (" or tube." if case.tube else ".")


def _groundless(case: Case) -> Iterator[str]:
    if case.lines and case.water.depth is not None and case.bed is None:
        yield (
            f"Nothing bears lines at the sea bed {case.water.depth:g} m down: they hang through it; add [bed]."
        )


def _no_effect(case: Case) -> Iterator[str]:
    solve = case.solve
    if solve.kind == "dynamic" and "tolerance" in solve.model_fields_set and solve.start == "built":
        yield "The tolerance plays no part in a dynamic case; settle_force or settle_energy end it at rest."
    if case.drag.kind == "bars" and case.drag.screens is not None:
        yield 'The drag law of screens plays no part without kind = "screens" in [drag].'
    if case.solve.kind == "dynamic" and case.output.periods is not None:
        yield "[output] periods plays no part in a dynamic case; natural periods are those about an equilibrium."
    if case.solve.kind == "static" and case.output.every is not None:
        yield "[output] every plays no part in a static case, which has one output."


def _seams(case: Case) -> Iterator[str]:
    """Edges that lie apart before they are joined."""
    for trial in tried(case):
        if trial.apart > trial.mesh:
            yield (
                f"The edges of seam '{trial.seam.name}' lie up to {trial.apart:.3g} m apart, more than a stretched "
                f"mesh of {trial.mesh:.3g} m: their knots are put together, and bars there begin as long as that "
                "makes them."
            )


def _sheltered_twice(case: Case) -> Iterator[str]:
    if case.drag.kind == "screens" and case.shelter.twine_law() is not None:
        yield (
            "The shelter between twines counts twice: the drag laws of screens were measured on whole panels and "
            'hold it already; leave out [shelter] twines with kind = "screens".'
        )


def _above_water(case: Case) -> Iterator[str]:
    for piece in case.pieces:
        netting = case.netting[piece.netting]
        known = piece.heights(netting)
        if known is None or known[1] <= AT_SURFACE:
            continue
        heights = piece.lay(netting, case.twines[netting.twine]).positions[:, 2]
        yield (
            f"{np.count_nonzero(heights > AT_SURFACE)} of {len(heights)} knots of {piece.called} begin above the "
            f"surface, up to z = {known[1]:.4g} m, with their weight in air and without drag; below still water z is "
            "negative."
        )


def _waves(case: Case) -> Iterator[str]:
    if case.waves is None:
        if "probes" in case.output.model_fields_set:
            yield "[output] probes plays no part without [waves]."
        return
    water, duration = case.water, case.solve.duration if case.solve.kind == "dynamic" else None
    yield from wave_oddities(case.waves, depth=water.depth, gravity=water.gravity, duration=duration)
