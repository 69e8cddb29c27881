"""What must hold of netting that closes round."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING

from ..netting.hexagon import Hexagon
from ..netting.lattice import taut_ratios
from ..netting.multiples import LEAST_AROUND
from .gear import NettingSpec, Piece
from .places import Path
from .shapes import ConeSpec, CylinderSpec, RoundSpec
from .written import written

if TYPE_CHECKING:
    from .check import Finding


def round_findings(path: Path, piece: RoundSpec, netting: NettingSpec | None) -> Iterator[Finding]:
    """What a shape round an axis must have to close."""
    if piece.meshes[0] < LEAST_AROUND:
        found = f"{piece.meshes[0]} around in {piece.called}"
        allowed = f"at least {LEAST_AROUND} meshes around, and as many as its netting has"
        yield (*path, "meshes"), found, allowed, "give first the meshes around, then those along the height"
    if isinstance(piece, CylinderSpec | ConeSpec):
        yield from _one_round_size(path, piece)
        yield from _closing_ratio(path, piece, netting)
    yield from hexagons_round(path, piece, netting)
    if netting is None or netting.mesh == "diamond":
        return
    allowed = "diamond netting, which can be gathered in one knot"
    allowed += "; square netting has bars round its edge" * (netting.mesh == "square")
    if isinstance(piece, ConeSpec):
        cure = f'write mesh = "diamond" in [netting.{piece.netting}], or kind = "frustum"'
        yield (*path, "kind"), f"{piece.called} of {netting.mesh_name} netting", allowed, cure
    if piece.floor is not None:
        cure = f'leave bottom out, or write mesh = "diamond" in [netting.{piece.netting}]'
        yield (*path, "bottom"), f"a bottom of {netting.mesh_name} netting in {piece.called}", allowed, cure


def hexagons_round(
    path: Path, piece: Piece, netting: NettingSpec | None, *, bottom: bool = False
) -> Iterator[Finding]:
    """What hexagons must have to close round, and that no bottom of theirs matches the walls of a box."""
    if netting is None or not isinstance(netting.mesh, Hexagon):
        return
    if netting.mesh.turned:
        found = f"hexagons with their long bars round {piece.called}"
        cure = f'write orientation = "T0" in [netting.{piece.netting}]'
        yield (*path, "netting"), found, "hexagons with their long bars along the height", cure
    if bottom:
        allowed = "diamond or square netting, whose bottom matches its walls knot by knot"
        cure = f'write bottom = false, or mesh = "diamond" in [netting.{piece.netting}]'
        yield (*path, "bottom"), f"a bottom of hexagonal netting in {piece.called}", allowed, cure


def _one_round_size(path: Path, piece: CylinderSpec | ConeSpec) -> Iterator[Finding]:
    if piece.sized:
        return
    given = [key for key in ("diameter", "height", "hanging_ratio") if getattr(piece, key) is not None]
    found = f"{' and '.join(given) or 'nothing of these'} in {piece.called}"
    missing = " and ".join(f'{key} = "1.5 m"' for key in ("diameter", "height") if key not in given)
    cure = "leave out hanging_ratio, or the others" if "hanging_ratio" in given else f"add {missing}"
    yield (*path, "diameter"), found, "diameter and height, or hanging_ratio instead of both", cure


def _closing_ratio(
    path: Path, piece: CylinderSpec | ConeSpec, netting: NettingSpec | None
) -> Iterator[Finding]:
    ratio = piece.hanging_ratio
    if netting is None or ratio is None or not piece.sized:
        return
    key = (*path, "hanging_ratio")
    if isinstance(ratio, tuple) and max(ratio) > 1.0:
        allowed = "E1 and E2 above 0 and at most 1: netting is never longer than stretched"
        cure = "0.5 to 0.8 is common for E1; E2 = sqrt(1 - E1^2) just straightens the bars of diamonds"
        yield key, f"{written(list(ratio))} of {piece.called}", allowed, cure
    elif isinstance(ratio, float) and taut_ratios(netting.mesh, ratio) is None:
        yield from one_ratio(path, ratio, netting)
    elif isinstance(piece, ConeSpec) and piece.rims(netting) is None:
        around, slant = piece.flat_size(netting)
        found = f"{written(ratio)}: the netting of {piece.called} is {slant:.4g} m from rim to tip"
        allowed = f"a slant above the radius of the rim, here {around / pi:.4g} m, so that it closes"
        yield key, found, allowed, "make E1 smaller, or give it fewer meshes around or more along the height"


def one_ratio(path: Path, ratio: float, netting: NettingSpec) -> Iterator[Finding]:
    """What is wrong with one hanging ratio where no other one makes every bar just taut."""
    if isinstance(netting.mesh, Hexagon):
        long = netting.mesh.long_bar
        allowed = f"at least {long / (1.0 + long):.4g}, where the slanted bars lie across, or [E1, E2]"
        yield (*path, "hanging_ratio"), f"{ratio:g}", allowed, 'give both, or write orientation = "T0"'
        return
    allowed = "[E1, E2] for square mesh, width and height over the stretched ones"
    yield (*path, "hanging_ratio"), f"{ratio:g}", allowed, f"write hanging_ratio = [{ratio:g}, {ratio:g}]"
