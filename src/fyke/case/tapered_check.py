"""What must hold of netting that is cut to shape."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..netting.cutting import lost
from .gear import NettingSpec
from .places import Path
from .tapered import TaperedSpec, TrapezoidSpec, TriangleSpec

if TYPE_CHECKING:
    from .check import Finding


def cutting(path: Path, piece: TaperedSpec, netting: NettingSpec) -> Iterator[Finding]:
    """What is wrong with the cuts of a piece: of the netting, of the rate, and of the counts of meshes."""
    if netting.mesh_name == "hexagonal":
        found = f"{piece.called} of hexagonal netting"
        cure = f'write mesh = "diamond" in [netting.{piece.netting}], or kind = "panel"'
        yield (*path, "kind"), found, "diamond or square netting, which cutting rates are told of", cure
        return
    given = piece.cut if isinstance(piece, TrapezoidSpec) else None
    if isinstance(piece, TrapezoidSpec) and piece.lower is None and given is None:
        allowed = "lower, the meshes along the lower edge, or cut, the cutting rate"
        yield (*path, "lower"), f"neither lower nor cut in {piece.called}", allowed, 'add cut = "1N2B"'
        return
    try:
        cuts, narrow = piece.cuts(netting), piece.narrow(netting)
    except ValueError as error:
        cure = (
            "write AN, or counts of N and T such as 2N1T"
            if netting.mesh_name == "square"
            else (
                "write AN, AB, or counts of B with one of N and T, such as 1N2B; use two meshes of height or more"
            )
        )
        key = "cut" if given else "meshes"
        yield (*path, key), _told(piece), str(error), cure
        return
    yield from _counts(path, piece, netting, narrow, [lost(one, netting.mesh_name) for one in cuts])


def _counts(
    path: Path, piece: TaperedSpec, netting: NettingSpec, narrow: int, taken: list[int]
) -> Iterator[Finding]:
    """Whether the cuts leave what they must."""
    wide, asked = piece.ends()
    taking = f"{taken[0]} and {taken[1]} meshes off its sides"
    least = 1 if isinstance(piece, TrapezoidSpec) or netting.mesh_name == "square" else 0
    if narrow < least:
        if isinstance(piece, TriangleSpec):
            allowed = "diamond netting, which ends in one knot; the last row of square netting is one mesh"
            cure = (
                f'write mesh = "diamond" in [netting.{piece.netting}], or kind = "trapezoid" with lower = 1'
            )
            yield (*path, "kind"), f"{piece.called} of square netting", allowed, cure
            return
        found = f"{_told(piece)}, which takes {taking} of {wide} meshes"
        cure = "give it fewer meshes along the height or more along the edge, or a steeper rate"
        yield (*path, "cut"), found, "cuts that leave one mesh or more at the narrow end", cure
    elif asked >= 0 and narrow != asked:
        found = f"{_told(piece)}, which takes {taking}: {narrow} of {wide} meshes are left"
        allowed = f"cuts that leave the {asked} of the narrow end"
        cure = f"leave cut out for even cuts, or write lower = {narrow} where it narrows downwards"
        yield (*path, "cut"), found, allowed, cure


def _told(piece: TaperedSpec) -> str:
    if isinstance(piece, TrapezoidSpec) and piece.cut:
        left, right = piece.cut
        rate = left if left == right else f"{left} and {right}"
        return f"{rate} over {piece.meshes[1]} meshes of height in {piece.called}"
    return f"{piece.wide[0]} meshes over {piece.meshes[1]} of height in {piece.called}"
