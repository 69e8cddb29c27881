"""Netting cut to shape: the cuts of a side in the notation of the trade, and the edges and knots that they leave.

A side is cut mesh by mesh, at every step in one of three ways. In diamond netting a mesh is two columns and two rows of
the lattice of netting.lattice:

    N   past one knot along the height: two rows further, no column lost    ("point", "sider")
    T   past one knot along the width: no row further, two columns lost     ("mesh")
    B   through one bar: one row further, one column lost                   ("bar")

Square netting is cut in N and T alone, one row or one column each. "1N2B" is one N and two B, again and again; "AN" and
"AB" are all N and all B. Over a height of d meshes with D of them lost, D below d takes 2 D cuts B to d - D cuts N, and
D above d takes 2 d cuts B to D - d cuts T. Letters as ISO 2075:1972 has them (its first page read in a public copy, its
formula not); the ratio of B to N and of B to T as lectures teach it ("Net cutting", and Fishing Gear Technology after
Prado, Fisherman's Workbook 1990, both read as excerpts), and by counting.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import gcd
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]
End = Literal["bottom", "top"]

# Columns lost and rows gained by every cut.
_STEPS = {
    "diamond": {"N": (0, 2), "T": (2, 0), "B": (1, 1)},
    "square": {"N": (0, 1), "T": (1, 0)},
}
_RATE = re.compile(r"(?:\d{0,3}[NTB])+")
_TERM = re.compile(r"(\d{0,3})([NTB])")


def cuts_of(rate: str) -> str:
    """Return the cuts of one round of a cutting rate, "NBB" of "1N2B", T first; ValueError for what is no rate."""
    told = rate.replace(" ", "").upper()
    if told in ("AN", "AB"):
        return told[1]
    if not _RATE.fullmatch(told):
        raise ValueError(f"'{rate}' is no cutting rate such as 1N2B, 1T1B, AB or AN")
    cuts = "".join(letter * int(count or 1) for count, letter in _TERM.findall(told))
    if not cuts.strip("T"):
        raise ValueError(f"'{rate}' never comes to the end of the height: it needs N or B")
    return "T" * cuts.count("T") + cuts.replace("T", "")


def rate_of(lost: int, deep: int) -> str:
    """Return the cutting rate that takes so many meshes off one side of diamond netting over so many of height."""
    if lost in (0, deep):
        return "AB" if lost else "AN"
    letter, other, bars = ("N", deep - lost, 2 * lost) if lost < deep else ("T", lost - deep, 2 * deep)
    common = gcd(other, bars)
    return f"{other // common}{letter}{bars // common}B"


def repeated(cuts: str, deep: int, mesh: str) -> str:
    """Repeat a round of cuts to the end of a height of so many meshes.

    Where half a mesh is left at the end and an N is due, a B takes its place. ValueError for cuts that this netting has
    not, or that would leave knots on one bar.
    """
    steps = _steps(mesh)
    strange = sorted(set(cuts) - set(steps))
    if strange:
        raise ValueError(f"{mesh} netting has no cut {strange[0]}, only {' and '.join(steps)}")
    if mesh == "diamond" and {"N", "T"} <= set(cuts):
        raise ValueError("N and T in one rate of diamond netting leave knots that hang on one bar")
    rows, out = deep * (2 if mesh == "diamond" else 1), []
    gained, k = 0, 0
    while gained < rows:
        cut = cuts[k % len(cuts)]
        if gained + steps[cut][1] > rows:
            cut = "B"
        out.append(cut)
        gained += steps[cut][1]
        k += 1
    return _begun("".join(out))


def spread(lost: int, deep: int, mesh: str) -> str:
    """Return cuts, as even as can be, that take so many meshes off one side over a height of so many."""
    if mesh == "square":
        return _begun(_evenly("N", deep, "T", lost))
    if lost <= deep:
        return _evenly("B", 2 * lost, "N", deep - lost)
    return _begun(_evenly("B", 2 * deep, "T", lost - deep))


def _evenly(one: str, count: int, other: str, others: int) -> str:
    """Spread two kinds of cuts over each other; the last is of the first kind if there is one."""
    whole = count + others
    return "".join(
        one if k * count // whole > (k - 1) * count // whole else other for k in range(1, whole + 1)
    )


def _begun(cuts: str) -> str:
    """Put the first T behind the first other cut: at the wide end's edge they would leave knots without bars."""
    first = len(cuts) - len(cuts.lstrip("T"))
    moved = cuts[first : first + 1] + cuts[:first] + cuts[first + 1 :]
    if moved.endswith("T"):
        raise ValueError("a height of one mesh has no room for the cut T")
    return moved


def lost(cuts: str, mesh: str) -> int:
    """Return how many meshes cuts take off the width."""
    columns = sum(_steps(mesh)[cut][0] for cut in cuts)
    return columns // 2 if mesh == "diamond" else columns


def _steps(mesh: str) -> dict[str, tuple[int, int]]:
    if mesh not in _STEPS:
        raise ValueError(f"{mesh} netting is not cut to shape")
    return _STEPS[mesh]


@dataclass(frozen=True)
class Taper:
    """Netting whose left and right side are cut, narrower at one end.

    left, right: all cuts of the side, from the wide end to the narrow one; narrow: the narrow end.
    """

    left: str
    right: str
    narrow: End = "bottom"

    def shape(self, mesh: str, meshes: tuple[int, int]) -> str:
        """Return "triangle" where the narrow end is one knot, else "trapezoid"; meshes: of the wide end, and high."""
        whole = lost(self.left, mesh) + lost(self.right, mesh) >= meshes[0]
        return "triangle" if whole else "trapezoid"

    def area(self, mesh: str, intervals: tuple[int, int]) -> float:
        """Return the share of the whole rectangle that is left."""
        round_it = np.concatenate([path[:: 1 - 2 * k] for k, path in enumerate(self.paths(mesh, intervals))])
        i, j = round_it.T
        twice = np.sum(i * np.roll(j, -1) - np.roll(i, -1) * j)
        return abs(float(twice)) / (2.0 * intervals[0] * intervals[1])

    def paths(self, mesh: str, intervals: tuple[int, int]) -> tuple[Indices, Indices]:
        """Return the lattice points (p, 2) along the left and the right side, from below.

        intervals: of the whole lattice, as wide as the wide end. ValueError for cuts that end above or below the narrow
        end or meet before it.
        """
        left, right = (self._path(cuts, mesh, intervals[1]) for cuts in (self.left, self.right))
        right[:, 0] = intervals[0] - right[:, 0]
        least = 0 if mesh == "diamond" else 1
        if right[-1, 0] - left[-1, 0] < least:
            raise ValueError(
                f"the cuts take {left[-1, 0] + intervals[0] - right[-1, 0]} of {intervals[0]} columns"
            )
        if self.narrow == "top":
            return left, right
        for path in (left, right):
            path[:, 1] = intervals[1] - path[:, 1]
        return left[::-1].copy(), right[::-1].copy()

    @staticmethod
    def _path(cuts: str, mesh: str, rows: int) -> Indices:
        steps = np.array([(0, 0), *(_steps(mesh)[cut] for cut in cuts)], dtype=np.int64)
        path = np.asarray(np.cumsum(steps, axis=0))
        if path[-1, 1] != rows:
            raise ValueError(f"cuts over {path[-1, 1]} rows, where there are {rows}")
        return path

    def columns(self, mesh: str, intervals: tuple[int, int]) -> tuple[Indices, Indices]:
        """Return the first and the last column of every row, (rows,) each."""
        (left, right), rows = self.paths(mesh, intervals), np.arange(intervals[1] + 1)
        first = np.full(len(rows), intervals[0] + 1, dtype=np.int64)
        last = np.full(len(rows), -1, dtype=np.int64)
        # Between the two ends of an N lies a knot half a mesh further in.
        for path, inwards in ((left, 1), (right, -1)):
            jumps = np.flatnonzero(np.diff(path[:, 1]) == 2)
            between = path[jumps] + np.array([inwards, 1])
            every = np.concatenate([path, between])
            if inwards == 1:
                np.minimum.at(first, every[:, 1], every[:, 0])
            else:
                np.maximum.at(last, every[:, 1], every[:, 0])
        return first, last
