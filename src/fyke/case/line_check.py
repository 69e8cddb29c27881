"""What must hold between the keys of lines and moorings, and what they are made fast to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from ..netting.lines import length_for
from ..netting.net import Net
from ..netting.references import IN_ROW, ON_EDGE, around, knot_at, row_of
from .gear import LARGEST_STRAIN
from .gear_check import knot_findings, piece_findings, reference, sheets_by_name
from .keys import nearest
from .lines import LaidSpec, LineSpec, MooringsSpec
from .places import Path
from .rigging import RopeSpec
from .rows import Sheets, in_row_findings, lines_of, rows_of
from .tubes import TubularSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding, Parts
    from .schema import Water

Place = NDArray[np.float64]

CHAIN_STRAIN = 0.01  # of chain in the line as laid: steel yields before


def line_findings(parts: Parts, water: Water | None) -> Iterator[Finding]:
    """Everything that is wrong with lines, moorings and chains; water: None where it is wrong itself."""
    twines = [name for name, _ in parts.items("twine")]
    for name, _ in parts.items("chain"):
        if name in twines:
            allowed = "a name of its own among twines and chains, which lines name alike"
            yield ("chain", name), f"{written(name)}, which is also a twine", allowed, "choose another name"
    there = twines + [name for name, _ in parts.items("chain")]
    sheets, waiting = sheets_by_name(parts), dict[int, set[str]]()
    # Moorings are several lines: one of them is "NAME 1".
    many = {parts.name_of(index) for index, line in parts.lines.items() if isinstance(line, MooringsSpec)}
    rows = {name: last for name, last in rows_of(parts, sheets).items() if name not in many}
    for index, keys in parts.gear_tables():
        for number, piece in enumerate(_pieces(keys)):
            yield from reference(("gear", index, "pieces", number, "twine"), piece, "twine", there)
    for index, line in parts.lines.items():
        place, called = ("gear", index), f"{line.kind} '{parts.name_of(index)}'"
        yield from _one_length(place, line, called)
        wrong = list(_ends(place, line, called, parts, sheets, rows))
        yield from wrong
        if not wrong and water is not None:
            yield from _reach(place, line, called, parts, water)
        waiting[index] = {_part_of(one) for one in _words(line)}
    yield from _circles(parts, waiting)


def _pieces(keys: dict[str, Any]) -> list[dict[str, Any]]:
    pieces = keys.get("pieces")
    return [one if isinstance(one, dict) else {} for one in pieces] if isinstance(pieces, list) else []


def _words(line: LaidSpec) -> list[str]:
    """What a line is made fast to, in words."""
    if isinstance(line, MooringsSpec):
        return [line.around]
    return (
        [one for one in (line.begin, line.end) if isinstance(one, str)] if isinstance(line, LineSpec) else []
    )


def _part_of(word: str) -> str:
    edge = ON_EDGE.fullmatch(word)
    return edge[1] if edge else word.rpartition(":")[0] or word


def _one_length(path: Path, line: LaidSpec, called: str) -> Iterator[Finding]:
    """Twine with length or pretension, or pieces."""
    given = [key for key in ("twine", "length", "pretension", "pieces") if getattr(line, key) is not None]
    if given in (["twine", "length"], ["twine", "pretension"], ["pieces"]):
        return
    found = f"{' and '.join(given) or 'nothing of these'} in {called}"
    allowed = "twine and length, twine and pretension, or pieces alone"
    if "pieces" in given:
        cure = f"leave out {' and '.join(given[:-1])}, or pieces"
    elif "length" in given and "pretension" in given:
        cure = "leave out length or pretension: the one makes the other"
    else:
        cure = 'write twine = "main" and length = "50 m", say'
    yield (*path, given[0] if given else "twine"), found, allowed, cure


def _ends(
    path: Path, line: LaidSpec, called: str, parts: Parts, sheets: Sheets, rows: dict[str, int]
) -> Iterator[Finding]:
    """What is wrong with the knots that a line names."""
    if isinstance(line, MooringsSpec):
        yield from _rim((*path, "around"), line, called, parts, sheets, rows)
        return
    if not isinstance(line, LineSpec):
        return
    for key, end in (("from", line.begin), ("to", line.end)):
        if not isinstance(end, str):
            continue
        edge, found = ON_EDGE.fullmatch(end), f"{written(end)} of {called}"
        if edge:
            yield from _on_edge((*path, key), found, (edge[1], edge[2], int(edge[3])), sheets, parts)
        elif ":" in end and end.rpartition(":")[2].isdigit():
            yield from in_row_findings((*path, key), called, end, rows)
        else:
            yield from knot_findings((*path, key), called, end, parts, sheets)
    if line.begin == line.end:
        yield (*path, "to"), f"the place where {called} begins", "another place or knot", "check from and to"
    held = [isinstance(end, str) or hold for end, hold in zip((line.begin, line.end), line.held, strict=True)]
    if parts.is_static and not any(held) and not _others_at(path, parts):
        cure = 'write fixed = "both", or "from" or "to"'
        yield (*path, "fixed"), f"no end of {called} is held", "an end that is held, for a static case", cure


def _others_at(path: Path, parts: Parts) -> bool:
    """Whether another line is made fast to a line, and may hold it: as anchor lines do the frame of a grid."""
    name = parts.name_of(cast(int, path[1]))
    return any(name in map(_part_of, _words(other)) for i, other in parts.lines.items() if i != path[1])


def _on_edge(
    path: Path, found: str, told: tuple[str, str, int], sheets: Sheets, parts: Parts
) -> Iterator[Finding]:
    name, side, place = told
    if name not in parts.netting_names:
        near = nearest(name, parts.netting_names) or next(iter(parts.netting_names), "NAME")
        allowed = '"NAME.EDGE[k]", NAME one of ' + (
            ", ".join(written(one) for one in parts.netting_names)
            or "those of [[gear]], which have no netting"
        )
        yield path, found, allowed, f'did you mean "{near}.{side}[{place}]"?'
    elif name in sheets:
        sheet, netting = sheets[name]
        if side not in sheet.edges:
            near = nearest(side, sheet.edges) or sheet.edges[0]
            allowed = f"an edge of '{name}': {' or '.join(sheet.edges)}"
            yield path, found, allowed, f'did you mean "{name}.{near}[{place}]"?'
            return
        last = sheet.edge(cast(Any, side), netting.mesh)[0] - 1
        if place > last:
            allowed = f"a knot along '{name}.{side}': 0 to {last}"
            yield path, found, allowed, f'write "{name}.{side}[{last}]" for its last'


def _rim(
    path: Path, line: MooringsSpec, called: str, parts: Parts, sheets: Sheets, rows: dict[str, int]
) -> Iterator[Finding]:
    there = {f"{one}.{edge}": s.edge(edge, n.mesh)[0] for one, (s, n) in sheets.items() for edge in s.edges}
    there |= rows
    if line.around.rpartition(".")[0] in parts.netting_names and line.around.rpartition(".")[0] not in sheets:
        return  # on netting that is wrong itself, and told
    if line.around not in there:
        own = {one for i, part in parts.lines.items() for one in lines_of(part, parts.name_of(i))}
        others = [one for one in there if one not in own]
        near = nearest(line.around, others) or next(iter(others), "")
        allowed = '"NAME.EDGE" of netting, or the name of a ring or rope'
        cure = f'did you mean "{near}"?' if near else "add gear that they can be made fast to"
        yield path, f"{written(line.around)} of {called}", allowed, cure
    elif line.count > there[line.around]:
        found = f"{line.count} lines of {called}"
        allowed = f"at most the {there[line.around]} knots of '{line.around}'"
        yield (*path[:-1], "count"), found, allowed, "make fewer lines, or give the netting more meshes"


def _circles(parts: Parts, waiting: dict[int, set[str]]) -> Iterator[Finding]:
    """Lines that are made fast to each other in a circle, so that none can be laid first."""
    names = {one: i for i, line in parts.lines.items() for one in lines_of(line, parts.name_of(i))}
    left = {i: {names[one] for one in words if one in names} for i, words in waiting.items()}
    while True:
        done = {i for i, others in left.items() if not others & left.keys()}
        if not done:
            break
        left = {i: others for i, others in left.items() if i not in done}
    for index in left:
        found = f"line '{parts.name_of(index)}' is made fast to a line that is made fast to it"
        cure = "begin one of them at a place, [x, y, z]"
        yield ("gear", index, "from"), found, "a line that can be laid before the other", cure


def _reach(path: Path, line: LaidSpec, called: str, parts: Parts, water: Water) -> Iterator[Finding]:
    """Whether a line reaches from end to end, as far as its ends are known before anything is built."""
    if isinstance(line, MooringsSpec) and water.depth is None:
        cure = "add depth = 20.0 to [water]"
        yield ("water", "depth"), f"nothing, and {called} have their anchors there", "a depth, m", cure
        return
    bed = -water.depth if water.depth is not None else None
    known = _known_ends(line, parts, water)
    if line.pretension is not None and not known:
        found = f"{line.pretension:g} N of {called}, whose ends are not known before all is built"
        allowed = "pretension of lines between places and netting"
        yield (*path, "pretension"), found, allowed, "give length instead"
    for begin, end in known:
        for key, place in (("from", begin), ("to", end)):
            if bed is not None and place[2] < bed and isinstance(line, LineSpec):
                cure = "raise it, or check [water] depth"
                found = f"z = {place[2]:g} m, where {called} ends"
                yield (*path, key), found, f"a place above the sea bed at z = {bed:g} m", cure
        way = float(np.linalg.norm(end - begin))
        longest = _longest(line, parts)
        if longest is not None and way > longest[1]:
            found = f"{longest[0]:g} m of {called}, whose ends are {way:.4g} m apart"
            allowed = f"at least {way * longest[0] / longest[1]:.4g} m, which strains it as far as it may be"
            key = "pieces" if line.pieces is not None else "length"
            yield (*path, key), found, allowed, "make it longer, or bring its ends nearer to each other"
            return
        if line.pretension is not None and line.twine is not None:
            wrong = _pretension(line, (begin, end), parts, water)
            if wrong:
                cure = "choose another pretension, or give length instead"
                yield (*path, "pretension"), f"{line.pretension:g} N of {called}", wrong, cure
                return


def _longest(line: LaidSpec, parts: Parts) -> tuple[float, float] | None:
    """Length of a line, unloaded and as far as it may be strained (m); None where it is made by a pretension."""
    if not line.asked:
        return None
    strain = [CHAIN_STRAIN if one.twine in parts.chains else LARGEST_STRAIN for one in line.asked]
    whole = sum(one.length for one in line.asked)
    return whole, sum(one.length * (1.0 + most) for one, most in zip(line.asked, strain, strict=True))


def _pretension(line: LaidSpec, ends: tuple[Place, Place], parts: Parts, water: Water) -> str:
    """Say which pretensions are possible where the one that is asked for is not."""
    specs: dict[str, Any] = {**parts.twines, **parts.chains}
    spec = specs.get(line.twine or "")
    if spec is None or (line.twine in parts.twines and spec.resolved_law is None):
        return ""  # wrong itself, and told
    bed = -water.depth if "bed" in parts.raw and water.depth is not None else None
    try:
        length_for(
            line.pretension or 0.0,
            *ends,
            spec.twine(line.twine),
            line.segments,
            water=water.density,
            gravity=water.gravity,
            bed=bed,
        )
    except ValueError as error:
        return str(error)
    return ""


def _known_ends(line: LaidSpec, parts: Parts, water: Water) -> list[tuple[Place, Place]]:
    """Both ends (3,) m of the lines of a part; none where one is not a place nor on netting that is good by itself."""
    if isinstance(line, LineSpec):
        ends = [_known(one, parts) for one in (line.begin, line.end)]
        return [(ends[0], ends[1])] if ends[0] is not None and ends[1] is not None else []
    if not isinstance(line, MooringsSpec):
        return []
    around_edge = _edges_followed(parts).get(line.around, line.around)
    net = _netting(around_edge.rpartition(".")[0], parts)
    rim = row_of(net, around_edge) if net is not None else None
    if net is None or rim is None:
        return []
    x, y = net.positions[np.unique(rim), :2].mean(axis=0).tolist()
    anchors = line.anchors((x, y), water.depth or 0.0)
    if line.count > len(np.unique(rim)):
        return []  # told already
    knots = around(rim, net.positions, line.bearing, line.count)
    return [(np.array(a), net.positions[k]) for a, k in zip(anchors, knots, strict=True)]


def _known(end: Any, parts: Parts) -> Place | None:
    if not isinstance(end, str):
        return np.array(end, dtype=float)
    row = IN_ROW.fullmatch(end)
    edge = _edges_followed(parts).get(row[1]) if row else None
    word = f"{edge}[{row[2]}]" if row and edge else end
    net = _netting(_part_of(word), parts)
    knot = None if net is None else knot_at(net, word)
    return None if net is None or knot is None else net.positions[knot]


def _edges_followed(parts: Parts) -> dict[str, str]:
    """The edge of netting that every rope, ring and collar along one is made fast to, by the name of it."""
    along: dict[int, RopeSpec | TubularSpec] = {**parts.ropes, **parts.tubulars}
    return {parts.name_of(i): one.along for i, one in along.items() if one.along}


def _netting(name: str, parts: Parts) -> Net | None:
    """The netting of a name as it is laid, None where it cannot be laid by itself."""
    for index, piece in parts.pieces.items():
        netting = parts.nettings.get(piece.netting)
        if netting is None or name not in {parts.name_of(index, one) for one in piece.sheets(netting)}:
            continue
        twine = parts.twines.get(netting.twine)
        if twine is None or twine.resolved_law is None or twine.resolved_density is None:
            return None
        if any(piece_findings((), piece, netting)):
            return None  # told already
        piece.call(parts.name_of(index))
        piece.settle(netting)
        return piece.lay(netting, twine.twine(netting.twine))
    return None
