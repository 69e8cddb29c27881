"""Grouped meshes in the case file: how many real meshes one stands for, as given or by a budget of knots."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Annotated, cast

from pydantic import Field

from ..netting.hexagon import Hexagon
from ..netting.lattice import INTERVALS
from ..netting.multiples import LEAST_AROUND, grouped_meshes
from .box import BoxSpec
from .fields import Table, whole
from .gear import MOST_GROUPED, NettingSpec, Piece, Sheet
from .places import Path
from .tapered import TaperedSpec

if TYPE_CHECKING:
    from .check import Finding, Parts

MOST_KNOTS = 10_000_000
# A group that divides all counts is taken instead of the least one when it is at most so many times as large.
DIVIDING = 1.25
Made = tuple[Piece, NettingSpec]


class GroupingSpec(Table):
    """How fine netting is laid whose group is not given."""

    knots: Annotated[int, *whole(1, MOST_KNOTS)] = Field(
        description="at most about so many knots of all netting together; meshes are grouped to keep to it",
        examples=[5000],
    )


def choose_groups(made: Sequence[Made], budget: int | None) -> tuple[int, ...]:
    """Return the group of every piece of netting: as given, else the least that keeps all within a budget of knots.

    A slightly larger one is taken when it divides the counts of meshes and the least one does not. Where no group
    keeps the budget it is the largest.
    """
    given = [_given(piece, netting) for piece, netting in made]
    free = [one for one, group in zip(made, given, strict=True) if group is None]
    if budget is None or not free:
        return tuple(group or 1 for group in given)
    left = budget - sum(
        knots_of(*one, group) for one, group in zip(made, given, strict=True) if group is not None
    )
    most = min(largest_group(*one) for one in free)
    groups = [n for n in range(1, most + 1) if all(_corners_meet(piece, n) for piece, _ in free)]
    least = _least(free, left, groups)
    further = [n for n in groups if least <= n <= DIVIDING * least]
    chosen = next((group for group in further if all(_divides(*one, group) for one in free)), least)
    return tuple(chosen if group is None else group for group in given)


def knots_of(piece: Piece, netting: NettingSpec, group: int) -> int:
    """Count the knots of a piece that is laid with a group."""
    return sum(_knots(sheet, netting, group) for sheet in _sheets(piece, netting))


def largest_group(piece: Piece, netting: NettingSpec) -> int:
    """Return the largest group that leaves a mesh along every side, and three around."""
    counts = []
    for sheet in _sheets(piece, netting):
        across = sheet.meshes[0] // LEAST_AROUND if sheet.rims else sheet.meshes[0]
        sides = [count for count, _ in sheet.sides] if sheet.sides else [across]
        counts += [*sides, sheet.meshes[1]]
    return max(1, min(MOST_GROUPED, *counts)) if counts else 1


def _given(piece: Piece, netting: NettingSpec) -> int | None:
    """The group of a piece, 1 where it cannot be grouped; None where a budget may choose."""
    if piece.given_group is not None or netting.group is not None:
        return piece.given_group if piece.given_group is not None else netting.group
    return 1 if _why_not(netting, piece) else None


def _why_not(netting: NettingSpec, piece: Piece | None = None) -> str:
    """Why netting, or a piece of it, cannot be grouped, "" where it can."""
    if isinstance(piece, TaperedSpec):
        return f"{piece.called}, whose sides are cut mesh by mesh"
    if isinstance(netting.mesh, Hexagon):
        return "hexagonal meshes, whose zigzag edges have no larger likeness"
    if netting.segments > 1:
        return "bars in segments: one bar for a bundle n times as long would bow n times as far"
    return ""


def _least(free: Sequence[Made], knots: int, groups: Sequence[int]) -> int:
    """The least of these groups that makes no more knots of these pieces, or the last."""
    return next(
        (group for group in groups if sum(knots_of(*one, group) for one in free) <= knots), groups[-1]
    )


def _corners_meet(piece: Piece, group: int) -> bool:
    """Whether the corners of a box are at knots."""
    return not isinstance(piece, BoxSpec) or all(count % group == 0 for count in piece.meshes[:2])


def _sheets(piece: Piece, netting: NettingSpec) -> tuple[Sheet, ...]:
    """Sheets of a piece, none where its keys make none, which is told elsewhere."""
    try:
        return piece.sheets(netting)
    except ValueError:
        return ()


def _divides(piece: Piece, netting: NettingSpec, group: int) -> bool:
    return all(count % group == 0 for sheet in _sheets(piece, netting) for count in sheet.meshes)


def _knots(sheet: Sheet, netting: NettingSpec, group: int) -> int:
    """Knots of a sheet, those that it shares with another one left out, and those within bars in segments."""
    meshes, mesh, closed = laid(sheet, group), netting.mesh, sheet.closed
    if sheet.taper is not None:
        try:
            grid = sheet.lattice(mesh)
        except ValueError:
            return 0  # cuts that cannot be, which are told elsewhere
        return len(grid.knots) + (netting.segments - 1) * len(grid.bars)
    if isinstance(mesh, Hexagon):
        columns, rows = mesh.counts(meshes)
        knots = (2 * columns + (not closed)) * (rows + 1)
        bars = 2 * columns * (rows + 1) + columns * rows + (rows + 1) // 2 * (not closed)
        return knots + (netting.segments - 1) * bars
    i, j = (INTERVALS[mesh] * count for count in meshes)
    rows = j + 1 - (sheet.sewn and closed) - sheet.tip
    if mesh == "diamond":
        knots, bars = ((i + (not closed)) * rows + 1) // 2 + sheet.tip, i * j
    else:
        knots, bars = (i + (not closed)) * rows, i * (j + 1) + (i + (not closed)) * j
    if sheet.sewn and not closed:
        edge = 2 * sum(meshes)
        knots, bars = knots - edge, bars - edge * (mesh == "square")
    return knots + (netting.segments - 1) * bars


def laid(sheet: Sheet, group: int) -> tuple[int, int]:
    """Return the meshes that a sheet is laid with."""
    return grouped_meshes(sheet.meshes, group, closed=sheet.closed)


def _budget_of(parts: Parts) -> int | None:
    """Budget of knots as it was written, None where it is no whole number."""
    spec = parts.raw.get("grouping")
    budget = spec.get("knots") if isinstance(spec, dict) else None
    return budget if isinstance(budget, int) else None


def gather(parts: Parts) -> None:
    """Fill in the group of every piece of netting that is good by itself, so that it is laid as it will be built."""
    made = [
        (piece, parts.nettings[piece.netting])
        for piece in parts.pieces.values()
        if piece.netting in parts.nettings
    ]
    for (piece, _), group in zip(made, choose_groups(made, _budget_of(parts)), strict=True):
        piece.gather(group)


def grouping_findings(parts: Parts) -> Iterator[Finding]:
    """Everything that is wrong with groups and the budget of knots."""
    for name, netting in parts.nettings.items():
        if netting.group is not None and netting.group > 1 and _why_not(netting):
            yield _refused(("netting", name, "group"), netting.group, netting)
    made = []
    for index, piece in parts.pieces.items():
        netting_of = parts.nettings.get(piece.netting)
        if netting_of is None or not piece.sized:
            continue
        made.append((piece, netting_of))
        yield from _of_piece(("gear", index, "group"), piece, netting_of)
    spec, budget = parts.raw.get("grouping"), _budget_of(parts)
    if budget is not None and len(made) == len(parts.pieces):
        yield from _budget(made, budget)
    elif spec is None:
        yield from _too_many(made)


def _of_piece(path: Path, piece: Piece, netting: NettingSpec) -> Iterator[Finding]:
    group, told = _given(piece, netting) or 1, piece.given_group is not None
    if group > 1 and _why_not(netting, piece):
        if told or not _why_not(netting):
            yield _refused(path, group, netting, piece)
        return
    most = largest_group(piece, netting)
    if group > most:
        counts = " and ".join(f"{a} x {b}" for a, b in (sheet.meshes for sheet in _sheets(piece, netting)))
        allowed = f"at most {most}: at least one mesh is left along every side, and three around"
        yield path, f"{group} for {piece.called} of {counts} meshes", allowed, f"write group = {most} or less"
    elif not _corners_meet(piece, group):
        sides = cast(BoxSpec, piece).meshes[:2]
        there = [n for n in range(1, most + 1) if _corners_meet(piece, n)]
        found = f"{group} for {piece.called} of {sides[0]} x {sides[1]} meshes between its corners"
        allowed = "a group that divides both, so that the corners are at knots: " + ", ".join(map(str, there))
        near = min(there, key=lambda n: abs(n - group))
        yield path, found, allowed, f"write group = {near}"


def _refused(path: Path, group: int, netting: NettingSpec, piece: Piece | None = None) -> Finding:
    found = f"{group} for {_why_not(netting, piece)}"
    allowed = "a group of rectangles and round shapes of diamond and square meshes, their bars in one piece"
    cure = (
        "write group = 1" if piece else "leave out group" + (", or segments" if netting.segments > 1 else "")
    )
    return path, found, allowed, cure


def _budget(made: Sequence[Made], budget: int) -> Iterator[Finding]:
    groups = choose_groups(made, budget)
    knots = sum(knots_of(*one, group) for one, group in zip(made, groups, strict=True))
    if knots > budget:
        found = f"{budget}, but the netting has {knots} at least"
        allowed = f"{knots} or more for this gear, whose groups are given or as large as its meshes allow"
        yield ("grouping", "knots"), found, allowed, f"write knots = {knots}, or larger groups"


def _too_many(made: Sequence[Made]) -> Iterator[Finding]:
    knots = sum(knots_of(*one, _given(*one) or 1) for one in made)
    if knots > MOST_KNOTS:
        found = f"netting of {knots:,} knots"
        cure = "group its meshes: add [grouping] with knots = 5000, or group = 10 in its [netting]"
        yield ("gear",), found, f"at most {MOST_KNOTS:,} knots", cure


def rounded(made: Sequence[Made]) -> Iterator[str]:
    """Say which counts of meshes their group does not divide, and what is laid instead."""
    for piece, netting in made:
        for sheet in _sheets(piece, netting):
            few = laid(sheet, piece.group)
            many = [real / count for real, count in zip(sheet.meshes, few, strict=True)]
            if piece.group > 1 and any(one != piece.group for one in many):
                yield (
                    f"A group of {piece.group} does not divide the {sheet.meshes[0]} x {sheet.meshes[1]} meshes of "
                    f"{'netting ' + repr(sheet.name) if sheet.name else piece.called}: {few[0]} x {few[1]} are laid, "
                    f"one for {many[0]:.4g} x {many[1]:.4g}. Size, twine, knots and weight stay those of the real "
                    "netting."
                )
