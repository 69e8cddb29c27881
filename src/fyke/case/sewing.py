"""Seams tried out on the netting that they join: what cannot be joined, and what lies apart before."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from ..netting.joining import once, sewn, stitches
from ..netting.lattice import Corner, Side
from ..netting.net import Net
from ..netting.together import together
from .seams import SeamSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding
    from .schema import Case


@dataclass(frozen=True)
class Trial:
    """A seam as it was tried.

    place: of the seam in the gear; apart: m, farthest that two knots lie apart before they are joined; mesh: m, longest
    stretched mesh beside it; fault: what is wrong with it, "" for nothing; net: the pieces that seams join, sewn so
    far.
    """

    place: int
    seam: SeamSpec
    apart: float
    mesh: float
    fault: str
    net: Net


def tried(case: Case) -> Iterator[Trial]:
    """Try the seams of a case one after the other, to the first that cannot be."""
    net = _sewn_pieces(case) if case.seams else None
    for place, seam in enumerate(case.gear):
        if not isinstance(seam, SeamSpec) or net is None:
            continue
        one, other = (cast("tuple[str, Side | Corner]", edge.rpartition(".")[::2]) for edge in seam.join)
        try:
            stays, goes = stitches(net, one, other)
            apart = float(np.linalg.norm(net.positions[stays] - net.positions[goes], axis=1).max())
            net = sewn(net, one, other)
            fault = "" if (net.bars[:, 0] != net.bars[:, 1]).all() else "bars would end where they begin"
        except ValueError as error:
            apart, fault = 0.0, str(error)
        mesh = 2.0 * max(panel.bar_length for panel in net.panels if panel.name in (one[0], other[0]))
        yield Trial(place, seam, apart, mesh, fault, net)
        if fault:
            return


def sewing_findings(case: Case) -> Iterator[Finding]:
    """What is wrong with seams of a case that is good otherwise, and with ropes along what they join."""
    trial = None
    for trial in tried(case):
        if trial.fault:
            told = " and ".join(written(edge) for edge in trial.seam.join)
            found = f"{told} of seam '{trial.seam.name}', where {trial.fault}"
            allowed = "edges whose knots can become one, each with one"
            cure = "look whether an edge is joined already, or meets the other one at a corner"
            yield ("gear", trial.place, "join"), found, allowed, cure
    if trial is not None and not trial.fault:
        yield from _ropes(case, trial.net)


def _ropes(case: Case, net: Net) -> Iterator[Finding]:
    """Ropes and tubes that follow an edge of which a seam leaves nothing."""
    panels = {panel.name: panel for panel in net.panels}
    for place, part in enumerate(case.gear):
        name, _, side = (getattr(part, "along", None) or "").rpartition(".")
        if part.kind in ("sinkers", "floats") or name not in panels:
            continue
        knots = once(panels[name].edge(cast("Side | Corner", side)))
        apart = np.linalg.norm(np.diff(net.positions[knots], axis=0), axis=1)
        if not (len(apart) and apart.all()):
            found = f"{written(f'{name}.{side}')} of {part.called}, whose knots a seam puts in one place"
            yield ("gear", place, "along"), found, "an edge of several knots", "name another edge"


def _sewn_pieces(case: Case) -> Net:
    """Return the pieces of netting that seams join, side by side."""
    names = {edge.rpartition(".")[0] for seam in case.seams for edge in seam.join}
    made = [(piece, case.netting[piece.netting]) for piece in case.pieces]
    return together(
        [
            piece.lay(netting, case.twines[netting.twine])
            for piece, netting in made
            if names & {sheet.name for sheet in piece.sheets(netting)}
        ]
    )
