"""What must hold between the parts of the gear: names, sizes, and what hangs on what."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

from ..netting.lattice import taut_ratios
from ..netting.references import IN_ROW
from .bodies_check import body_findings
from .box import BoxSpec
from .gear import LARGEST_STRAIN, FlatSpec, NettingSpec, Piece, Sheet
from .keys import nearest
from .places import Path
from .rigging import BodiesSpec, RopeSpec
from .rows import in_row_findings, length_of, rows_of
from .seams_check import joined_names, seam_findings
from .shapes import RoundSpec
from .shapes_check import hexagons_round, one_ratio, round_findings
from .tapered import TaperedSpec
from .tapered_check import cutting
from .tube_check import tubular_findings
from .tubes import TubularSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts
    from .schema import Water

_LABEL = re.compile(r"(?:([^:]*):)?(\d{1,9})-(\d{1,9})", re.ASCII)
_ANCHORED = ("line", "moorings")  # kinds of gear that may hold others
_LEAST_EDGE = 1e-6  # m, that a rope can follow; a shorter one is a slip of the pen
_FLAT = ("panel", "trapezoid", "triangle")


def reference(
    path: Path, keys: dict[str, Any], table: str, there: list[str], tubes: Collection[str] = ()
) -> Iterator[Finding]:
    """A key that names a table of the file, the twine of a netting for one; tubes: that may be taken for twine."""
    name = keys.get(table)
    if not isinstance(name, str) or name in there:
        return
    allowed = f"a {table} of this file: " + (", ".join(written(one) for one in there) or "there is none yet")
    near = nearest(name, there)
    cure = f'did you mean "{near}"?' if near else f"add a table [{table}.{name}] or name one that is there"
    if table == "twine" and name in tubes:
        cure = 'tubes make gear of the kinds "ring" and "collar" alone: name a twine or chain'
    yield path, written(name), allowed, cure


def gear_findings(parts: Parts, water: Water | None) -> Iterator[Finding]:
    """Everything that is wrong between the keys and parts of the gear; water: None where it is wrong itself."""
    yield from _names(parts)
    for index, keys in parts.gear_tables():
        for table in ("netting", "twine", "tube"):
            there = [name for name, _ in parts.items(table)]
            there += [name for name, _ in parts.items("chain") if table == "twine"]
            tubes = [name for name, _ in parts.items("tube")]
            yield from reference(("gear", index, table), keys, table, there, tubes)
        yield from _held(("gear", index), keys, parts)
        if keys.get("kind") in (*_FLAT, "box", None):
            yield from _one_size(("gear", index), keys)
    for index, piece in parts.pieces.items():
        yield from piece_findings(("gear", index), piece, parts.nettings.get(piece.netting))
    sheets = sheets_by_name(parts)
    yield from seam_findings(parts, sheets)
    for index, rope in parts.ropes.items():
        yield from _rope(("gear", index), rope, parts, sheets)
    for index, part in parts.tubulars.items():
        yield from tubular_findings(("gear", index), part, parts.name_of(index))
        yield from _way(("gear", index), part, parts, sheets)
    for index, bodies in parts.bodies.items():
        yield from body_findings(("gear", index), bodies, water)
        yield from _hung(("gear", index), bodies, parts, sheets)


def piece_findings(path: Path, piece: Piece, netting: NettingSpec | None) -> Iterator[Finding]:
    """What is wrong with a piece of netting by itself; netting: None where it is wrong or not there."""
    if isinstance(piece, TaperedSpec) and netting is not None:
        wrong_cuts = list(cutting(path, piece, netting))
        yield from wrong_cuts
        if wrong_cuts:
            return
    if isinstance(piece, BoxSpec):
        yield from hexagons_round(path, piece, netting, bottom=piece.bottom)
    if isinstance(piece, RoundSpec):
        yield from round_findings(path, piece, netting)
    yield from _frame(path, piece, netting)


def _names(parts: Parts) -> Iterator[Finding]:
    """Every part has a name of its own, and so has the bottom of one."""
    seen: dict[str, str] = {}
    for index, keys in parts.gear_tables():
        name = keys.get("name", str(index + 1))
        if not isinstance(name, str):
            continue
        taken = {name: f"[[gear]] {index + 1}"}
        if has_bottom(keys):
            taken[f"{name} bottom"] = f"the bottom of [[gear]] {index + 1}"
        for one, owner in taken.items():
            if one in seen:
                found = f"{written(one)}, which is also the name of {seen[one]}"
                yield (
                    ("gear", index, "name"),
                    found,
                    "a name of its own for every gear",
                    "choose another name",
                )
            seen.setdefault(one, owner)


def has_bottom(keys: dict[str, Any]) -> bool:
    """Whether a part of these keys has netting below it, valid or not."""
    return keys.get("bottom", keys.get("kind") == "box") is not False


def _held(path: Path, keys: dict[str, Any], parts: Parts) -> Iterator[Finding]:
    anchored = any(other.get("kind") in _ANCHORED for _, other in parts.gear_tables())
    if parts.is_static and keys.get("fixed") == "none" and not anchored and not _hangs(path, parts):
        panel = keys.get("kind") in _FLAT
        allowed = ('"edges", "top" or "corners"' if panel else '"top" or "edges"') + " for a static case"
        hold = "edges" if panel else "top"
        cure = f'nothing would hold it: write fixed = "{hold}", or solve with kind = "dynamic"'
        yield (*path, "fixed"), '"none"', allowed, cure


def _hangs(path: Path, parts: Parts) -> bool:
    """Whether seams join a part, by way of others or not, to one that is held."""
    held = {parts.name_of(i) for i, keys in parts.gear_tables() if keys.get("fixed") != "none"}
    owner = {name: parts.name_of(i) for i, keys in parts.gear_tables() for name in parts.names_of(i, keys)}
    pairs = [{owner.get(one, one) for one in joined_names(keys)} for _, keys in parts.gear_tables()]
    if any(one not in owner for pair in pairs for one in pair):
        return True  # whatever a seam means that names no part, and is told
    known = {parts.name_of(cast(int, path[1]))}
    while any(pair & known and pair - known for pair in pairs):
        known = known.union(*(pair for pair in pairs if pair & known))
    return bool(known & held & set(parts.netting_names))


def _one_size(path: Path, keys: dict[str, Any]) -> Iterator[Finding]:
    asked = {"size", "hanging_ratio"} & keys.keys()
    if len(asked) != 1:
        found = "both size and hanging_ratio" if asked else "neither size nor hanging_ratio"
        sides = "[along x, along y, deep]" if keys.get("kind") == "box" else "[width, height]"
        cure = "leave out one of the two" if asked else f"add size = {sides} in m, or hanging_ratio = 0.6"
        yield (*path, "size"), found, "one of size and hanging_ratio", cure


def _frame(path: Path, piece: Piece, netting: NettingSpec | None) -> Iterator[Finding]:
    if netting is None or not piece.sized:
        return
    ratio = getattr(piece, "hanging_ratio", None)
    if isinstance(ratio, tuple) and max(ratio) > 1.0 and isinstance(piece, RoundSpec):
        return  # told already
    if isinstance(ratio, float) and taut_ratios(netting.mesh, ratio) is None:
        if isinstance(piece, FlatSpec | BoxSpec):
            yield from one_ratio(path, ratio, netting)
        return
    for sheet in piece.sheets(netting):
        if sheet.strain(netting) > LARGEST_STRAIN:
            yield _overstretched(path, piece, sheet, netting)


def _overstretched(path: Path, piece: Piece, sheet: Sheet, netting: NettingSpec) -> Finding:
    percent = sheet.strain(netting) * 100
    told = f"{percent:.0f}" if percent > 100.0 else f"{percent:.3g}"
    strain = f"which strains the bars by {told} % before anything acts"
    if isinstance(piece, FlatSpec | BoxSpec):
        key = "size" if piece.given_size else "hanging_ratio"
        of = "" if isinstance(piece, FlatSpec) else "a bottom of " if sheet.sewn else "walls of "
        found = f"{of}{sheet.size[0]:g} m x {sheet.size[1]:g} m, {strain}"
        allowed = f"a frame that the net can span: at most {LARGEST_STRAIN * 100:g} % strain"
        return (*path, key), found, allowed, "check the units of size and bar_length and the number of meshes"
    low, high = sheet.rims or (0.0, 0.0)
    what = f"the bottom of {piece.called}" if sheet.sewn else piece.called
    found = f"{what} spans rims of {low:g} m and {high:g} m and a slant of {sheet.size[1]:.4g} m, {strain}"
    allowed = f"a shape that the netting can span: at most {LARGEST_STRAIN * 100:g} % strain"
    key = "bottom" if sheet.sewn else "hanging_ratio" if getattr(piece, "hanging_ratio", None) else "diameter"
    cure = "check the units of its sizes and of bar_length, and the number of meshes"
    return (*path, key), found, allowed, cure


def sheets_by_name(parts: Parts) -> dict[str, tuple[Sheet, NettingSpec]]:
    """The sheets of netting of all pieces that are good by themselves, by name."""
    out = {}
    for index, piece in parts.pieces.items():
        netting = parts.nettings.get(piece.netting)
        if netting and isinstance(piece, TaperedSpec) and any(cutting((), piece, netting)):
            continue
        for sheet in piece.sheets(netting) if netting else ():
            out[parts.name_of(index, sheet)] = (sheet, netting)
    return cast(dict[str, tuple[Sheet, NettingSpec]], out)


def edge_named(
    path: Path, what: str, along: str, parts: Parts, sheets: Mapping[str, tuple[Sheet, NettingSpec]]
) -> Iterator[Finding | tuple[int, float]]:
    """Either what is wrong with an edge that is named, or how many knots it has and its length (m)."""
    name, dot, side = along.rpartition(".")
    known = parts.netting_names
    key = (*path, "along")
    if not dot or name not in known:
        every = [f"{one}.{edge}" for one, (sheet, _) in sheets.items() for edge in sheet.edges]
        allowed = "NAME.EDGE of netting in this file, NAME one of " + (
            ", ".join(written(one) for one in known) or "those of [[gear]], which have no netting yet"
        )
        near = nearest(along, every) or (every[0] if every else "")
        cure = f'did you mean "{near}"?' if near else "add gear with netting that it can hang on"
        yield key, f"{written(along)} of {what}", allowed, cure
        return
    if name not in sheets:
        return  # wrong itself, and told
    sheet, netting = sheets[name]
    if side not in sheet.edges:
        allowed = f"an edge of '{name}': {' or '.join(sheet.edges)}"
        if sheet.closed:
            allowed += "; it closes round and has no other"
        near = nearest(side, sheet.edges) or sheet.edges[1]
        yield key, f"{written(along)} of {what}", allowed, f'did you mean "{name}.{near}"?'
        return
    yield sheet.edge(side, netting.mesh)


def _rope(
    path: Path, rope: RopeSpec, parts: Parts, sheets: Mapping[str, tuple[Sheet, NettingSpec]]
) -> Iterator[Finding]:
    called = f"rope '{parts.name_of(cast(int, path[1]))}'"
    for one in edge_named(path, called, rope.along, parts, sheets):
        if len(one) == 4:
            yield one
            continue
        count, built = one
        if count == 1 or built < _LEAST_EDGE:
            yield _no_way(path, called, rope.along, count, built)
        elif rope.length is not None and built > (1.0 + LARGEST_STRAIN) * rope.length:
            found = f"{rope.length:g} m of {called}, on an edge of {built:.4g} m: a strain of "
            found += f"{(built / rope.length - 1.0) * 100:.3g} % before anything acts"
            least = built / (1.0 + LARGEST_STRAIN)
            allowed = f"at least {least:.4g} m: at most {LARGEST_STRAIN * 100:g} % strain"
            yield (
                (*path, "length"),
                found,
                allowed,
                "make it longer, or leave length out for that of the edge",
            )


def _round_edge(along: str, sheets: Mapping[str, tuple[Sheet, NettingSpec]]) -> bool:
    """Whether an edge goes round; a row that is no edge does not."""
    name, _, side = along.rpartition(".")
    return name in sheets and sheets[name][0].closed and side in ("top", "bottom")


def _way(
    path: Path, part: TubularSpec, parts: Parts, sheets: Mapping[str, tuple[Sheet, NettingSpec]]
) -> Iterator[Finding]:
    """What is wrong with the edge that a ring or a collar follows, if it follows one."""
    if part.along is None:
        return
    called = f"{part.kind} '{parts.name_of(cast(int, path[1]))}'"
    for one in edge_named(path, called, part.along, parts, sheets):
        if len(one) == 4:
            yield one
        elif one[0] == 1 or one[1] < _LEAST_EDGE:
            yield _no_way(path, called, part.along, *one)


def _no_way(path: Path, called: str, along: str, count: int, built: float) -> Finding:
    if count == 1:
        found = f"{written(along)} of {called}, one knot"
        return (*path, "along"), found, "an edge of several knots", "name another edge"
    found, allowed = (
        f"{written(along)} of {called}, {built:g} m long",
        f"an edge of {_LEAST_EDGE:g} m or more",
    )
    return (*path, "along"), found, allowed, "check the units of the netting that it belongs to"


def _hung(
    path: Path, bodies: BodiesSpec, parts: Parts, sheets: Mapping[str, tuple[Sheet, NettingSpec]]
) -> Iterator[Finding]:
    """Where floats and sinkers are."""
    called = f"{bodies.kind} '{parts.name_of(cast(int, path[1]))}'"
    if (bodies.along is None) == (bodies.at is None):
        found = f"both along and at in {called}" if bodies.at else f"neither along nor at in {called}"
        cure = "leave one of the two out" if bodies.at else 'add along = "NAME.bottom", or at = ["NAME:0-0"]'
        yield (*path, "along"), found, "an edge (along) or labels of knots (at)", cure
        return
    if bodies.along is not None:
        last = rows_of(parts, sheets).get(bodies.along)
        in_row = [] if last is None else [(last + 1, length_of(parts, bodies.along))]
        for one in in_row or edge_named(path, called, bodies.along, parts, sheets):
            if len(one) == 4:
                yield one
            elif bodies.many(*one, closed=_round_edge(bodies.along, sheets)) > one[0]:
                many = bodies.many(*one, closed=_round_edge(bodies.along, sheets))
                found = f"{many} of {called} along {written(bodies.along)}"
                allowed = f"at most the {one[0]} knots of this edge"
                cure = "put fewer and heavier ones there, or leave count out for one at every knot"
                yield (*path, "spacing" if bodies.spacing else "count"), found, allowed, cure
    if bodies.spacing is not None and (bodies.at is not None or bodies.count is not None):
        other = "at" if bodies.at is not None else "count"
        yield (
            (*path, "spacing"),
            f"spacing beside {other} in {called}",
            "one of the two",
            f"leave {other} or spacing out",
        )
    if bodies.at is None:
        return
    if bodies.count is not None:
        cure = "leave count out: there is one at every label"
        yield (*path, "count"), f"{bodies.count} beside at in {called}", "count with along only", cure
    for place, label in enumerate(bodies.at):
        yield from knot_findings((*path, "at", place), called, label, parts, sheets)
        if label in bodies.at[:place]:
            found = f"{written(label)} of {called}, twice"
            yield (*path, "at", place), found, "every knot once", "leave it out, or make a heavier one"


def knot_findings(
    path: Path, what: str, label: str, parts: Parts, sheets: Mapping[str, tuple[Sheet, NettingSpec]]
) -> Iterator[Finding]:
    """What is wrong with the label of a knot; what: who hangs there."""
    if IN_ROW.fullmatch(label):
        yield from in_row_findings(path, what, label, rows_of(parts, sheets))
        return
    match = _LABEL.fullmatch(label)
    name = (match[1] or "") if match else label.partition(":")[0]
    found = f"{written(label)} of {what}"
    if match is None or name not in parts.netting_names:
        near = nearest(name, parts.netting_names)
        allowed = 'the label of a knot, "NAME:column-row", NAME one of ' + (
            ", ".join(written(one) for one in parts.netting_names) or "those of [[gear]] with netting"
        )
        cure = f'write for example "{near}:0-0"' if near else 'write for example "NAME:0-0"'
        yield path, found, allowed, cure
    elif name in sheets:
        sheet, netting = sheets[name]
        if not sheet.has(int(match[2]), int(match[3]), netting.mesh):
            last = sheet.last(netting.mesh)
            within = int(sheet.sewn and not sheet.closed)
            columns, rows = f"{within} to {last[0] - within}", f"{within} to {last[1]}"
            allowed = f"a knot of '{name}': columns {columns}, rows {rows} from below"
            allowed += "; those of its edge are of the walls" * bool(within)
            allowed += "; of diamond netting those whose sum is even" * (netting.mesh == "diamond")
            allowed += "; of hexagons every other one" * (netting.mesh_name == "hexagonal")
            allowed += "; its tip is 0-0" * sheet.tip
            yield path, found, allowed, "choose a knot that is there; knots.csv of a run lists them"
