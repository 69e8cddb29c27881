"""What must hold of seams: edges that are there, and counts of meshes that match."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from .gear import NettingSpec, Sheet
from .keys import nearest
from .places import Path
from .seams import SeamSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts

_HALF = 0.5 + 1e-9  # meshes by which counts and take-up may differ: rounding to whole meshes


def joined_names(keys: Mapping[str, Any]) -> list[str]:
    """Return the names of netting that the keys of a seam join, as far as they are such."""
    join = keys.get("join") if keys.get("kind") == "seam" else None
    return [one.rpartition(".")[0] for one in join if isinstance(one, str)] if isinstance(join, list) else []


Sheets = Mapping[str, tuple[Sheet, NettingSpec]]


def seam_findings(parts: Parts, sheets: Sheets) -> Iterator[Finding]:
    """What is wrong with seams: edges that are not there, counts that do not match, edges gathered already."""
    gathered: dict[str, str] = {}
    for index, seam in parts.seams.items():
        path, called = ("gear", index), f"seam '{parts.name_of(index)}'"
        found = [_edge((*path, "join", k), called, one, parts, sheets) for k, one in enumerate(seam.join)]
        wrong_edges = [one for one in found if isinstance(one[0], tuple)]
        yield from wrong_edges
        if wrong_edges or any(one == _UNKNOWN for one in found):
            continue
        first, second = found
        yield from _pair(path, called, seam, first, second, gathered)


_UNKNOWN = (0, False)  # of netting that is wrong itself, and told


def _edge(path: Path, called: str, along: str, parts: Parts, sheets: Sheets) -> Finding | tuple[int, bool]:
    """Return how many knots an edge has, each once, and whether it closes; or what is wrong with it."""
    name, dot, side = along.rpartition(".")
    if not dot or name not in parts.netting_names:
        every = [f"{one}.{edge}" for one, (sheet, _) in sheets.items() for edge in sheet.edges]
        allowed = "NAME.EDGE of netting in this file, NAME one of " + (
            ", ".join(written(one) for one in parts.netting_names) or "those of [[gear]] with netting"
        )
        near = nearest(along, every) or (every[0] if every else "")
        cure = f'did you mean "{near}"?' if near else "add gear with netting that it can join"
        return path, f"{written(along)} of {called}", allowed, cure
    if name not in sheets:
        return _UNKNOWN
    sheet, netting = sheets[name]
    if side not in sheet.edges:
        near = nearest(side, sheet.edges) or sheet.edges[1]
        allowed = f"an edge of '{name}': {' or '.join(sheet.edges)}"
        return path, f"{written(along)} of {called}", allowed, f'did you mean "{name}.{near}"?'
    count = sheet.edge(side, netting.mesh)[0]
    if count == 1:
        found = f"{written(along)} of {called}, one knot"
        return path, found, "an edge of several knots", "name another edge"
    return count, sheet.closed and side in ("top", "bottom")


def _pair(
    path: Path,
    called: str,
    seam: SeamSpec,
    first: Any,
    second: Any,
    gathered: dict[str, str],
) -> Iterator[Finding]:
    key, told = (*path, "join"), " and ".join(written(one) for one in seam.join)
    if seam.join[0] == seam.join[1]:
        yield key, f"{told} of {called}", "two different edges", "name the edge that it is joined to"
        return
    if first[1] != second[1]:
        found = f"{told} of {called}, of which one closes round and the other does not"
        yield (
            key,
            found,
            "two edges that close round, or two that do not",
            "join the sides of the open one first",
        )
        return
    for one in seam.join:
        if one in gathered:
            found = f"{written(one)} of {called}, whose meshes {gathered[one]} takes up"
            yield key, found, "an edge with a knot for every mesh", "join the edge that it is taken up on"
            return
    counts = [count - (not closed) for count, closed in (first, second)]
    if counts[0] != counts[1]:
        gathered[seam.join[0 if counts[0] > counts[1] else 1]] = called
    yield from _take_up(path, called, seam, counts)


def _take_up(path: Path, called: str, seam: SeamSpec, counts: list[int]) -> Iterator[Finding]:
    a, b = counts
    has = f"{a} meshes along {written(seam.join[0])} and {b} along {written(seam.join[1])} in {called}"
    if seam.take_up is None:
        if a != b:
            cure = f"write take_up = {a / b:.4g} to gather the longer edge, or give both as many meshes"
            yield (*path, "join"), has, "as many meshes on either side, or a take_up", cure
    elif abs(a - seam.take_up * b) > _HALF and abs(a / seam.take_up - b) > _HALF:
        cure = f"write take_up = {a / b:.4g}, or give the first edge {max(round(seam.take_up * b), 1)} meshes"
        yield (*path, "take_up"), f"{seam.take_up:.4g} with {has}", f"{a / b:.4g}, as the counts are", cure
