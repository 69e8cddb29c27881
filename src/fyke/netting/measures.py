"""Derived figures of netting: hanging ratios, solidity, twine area, mass.

The cell that repeats itself over a panel has one knot and two bars, and the area of one mesh; that of hexagons two
knots and three bars, one of them long.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .hexagon import Hexagon
from .lattice import Mesh, hanging_ratios
from .net import Net, Panel

KILOGRAM_PER_METRE_IN_TEX = 1e6  # tex is g/km


@dataclass(frozen=True)
class PanelMeasures:
    """Figures of a panel as it is hung on its frame, before it stretches.

    hanging_ratios: width and height over the fully stretched ones; outline_area: of the frame (m2); solidity:
    solid projected area over outline area; twine_area: diameter times length of all bars, overlaps counted
    twice (m2); mass_per_area: dry mass of a cell, twine and knot, over its area (kg/m2); mesh_length: full
    stretched mesh, two bars and the long one of hexagons, knot centre to knot centre (m); rtex: mass per length of the
    twine (tex = g/km), as given or that of fibre all through its cross-section.
    """

    hanging_ratios: tuple[float, float]
    outline_area: float
    solidity: float
    twine_area: float
    mass_per_area: float
    mesh_length: float
    rtex: float


@dataclass(frozen=True)
class NetMeasures:
    """Figures of a whole net: counts of knots, bars and fixed knots; mass in air (kg); volume (m3).

    real_knots, real_bars: how many the grouped ones stand for; twine_length: m, of all real bars, unloaded; group: the
    most real meshes that one of the net stands for along an axis.
    """

    knots: int
    bars: int
    fixed: int
    mass: float
    volume: float
    real_knots: int
    real_bars: int
    twine_length: float
    group: float


def mesh_area(mesh: Mesh, bar_length: float, ratios: tuple[float, float]) -> float:
    """Area (m2) within one mesh, of bar length a (m), hung at E1, E2.

    2 a^2 E1 E2 for a diamond with the diagonals 2 a E1 and 2 a E2; a^2 E1 E2 for a square;
    2 a (a + l) E1 E2 for a hexagon with long bars l, see netting.hexagon.
    """
    if isinstance(mesh, Hexagon):
        return mesh.area(bar_length, ratios)
    return {"diamond": 2.0, "square": 1.0}[mesh] * bar_length**2 * ratios[0] * ratios[1]


def solidity(
    mesh: Mesh,
    bar_length: float,
    ratios: tuple[float, float],
    diameter: float,
    knot_diameter: float = 0.0,
) -> float:
    """Solid projected area over outline area of flat netting, at most 1.

    bar_length a, diameter d and knot_diameter d_k in m, 0 for knotless; ratios E1, E2.

        knotless diamond    x - x^2 / 4, x = d / (a E1 E2)
        knotless square     d / (a E1) + d / (a E2) - d^2 / (a^2 E1 E2), which is 2 d/a - (d/a)^2 when taut
        knotted diamond     (2 d (a - d_k) + pi d_k^2 / 4) / (2 a^2 E1 E2)
        knotted square      (d (a E1 - d_k) + d (a E2 - d_k) + pi d_k^2 / 4) / (a^2 E1 E2)
        hexagons            netting.hexagon.Hexagon.solid_area over the area of a mesh

    They count the area of straight bars and of discs for knots, less the overlap. Diamonds are counted with
    their whole twine, E1^2 + E2^2 = 1; netting hung slacker than that has its twine crowded into the outline.
    A knot no thicker than the twine hides in the crossing and counts as none.
    """
    if isinstance(mesh, Hexagon):
        covered = mesh.solid_area(bar_length, ratios, diameter, knot_diameter)
        return float(min(1.0, covered / mesh_area(mesh, bar_length, ratios)))
    a, d, dk = bar_length, diameter, knot_diameter
    e1, e2 = ratios
    if mesh == "square":
        ends = dk if dk > d else d / 2.0
        sides = d * (a * e1 - ends) + d * (a * e2 - ends)
    else:
        # Two knotless bars share a rhombus of area d^2 / (2 E1 E2) at every crossing.
        ends = dk if dk > d else d / (4.0 * e1 * e2)
        sides = 2.0 * d * (a - ends)
    disc = np.pi * dk**2 / 4.0 if dk > d else 0.0
    return float(min(1.0, (sides + disc) / mesh_area(mesh, a, ratios)))


def measure_panel(net: Net, panel: Panel) -> PanelMeasures:
    """Return the figures of one panel of a net, hung on its frame."""
    twine = next(t for t in net.twines if t.name == panel.twine)
    mesh = panel.kind
    ratios = hanging_ratios(mesh, panel.real_meshes, panel.bar_length, panel.size)
    density = float(np.mean(net.knot_density[panel.knots]))
    knots, own = 2 if panel.mesh == "hexagonal" else 1, np.unique(panel.bars)
    left = panel.taper.area(panel.mesh, panel.lattice.intervals) if panel.taper else 1.0
    cell_mass = (2.0 * panel.bar_length + panel.long_bar) * twine.mass_per_length
    cell_mass += knots * density * np.pi * panel.knot_diameter**3 / 6.0
    return PanelMeasures(
        hanging_ratios=ratios,
        outline_area=panel.size[0] * panel.size[1] * left,
        solidity=solidity(mesh, panel.bar_length, ratios, twine.diameter, panel.knot_diameter),
        twine_area=float(twine.diameter * net.bar_multiple[own] @ net.rest_length[own]),
        mass_per_area=cell_mass / mesh_area(mesh, panel.bar_length, ratios),
        mesh_length=2.0 * panel.bar_length + panel.long_bar,
        rtex=twine.mass_per_length * KILOGRAM_PER_METRE_IN_TEX,
    )


def measure_net(net: Net) -> NetMeasures:
    """Return the figures of a whole net: bars are cylinders of fibre as long as unloaded, knots spheres."""
    area = np.array([t.fibre_area for t in net.twines])[net.twine_of_bar]
    density = np.array([t.density for t in net.twines])[net.twine_of_bar]
    length = net.bar_multiple * net.rest_length
    bar_volume = area * length
    knot_volume = net.knot_multiple * np.pi * net.knot_diameter**3 / 6.0
    return NetMeasures(
        knots=net.knot_count,
        bars=net.bar_count,
        fixed=int(np.count_nonzero(net.fixed)),
        mass=float(density @ bar_volume + net.knot_density @ knot_volume + net.at_knots("mass").sum()),
        volume=float(np.sum(bar_volume) + np.sum(knot_volume) + net.at_knots("volume").sum()),
        real_knots=round(float(net.knot_multiple.sum())),
        real_bars=_real_bars(net),
        twine_length=float(length.sum()),
        group=max((max(panel.group) for panel in net.panels), default=1.0),
    )


def _real_bars(net: Net) -> int:
    """How many bars the real net has."""
    real = np.ones(net.bar_count)
    for panel in net.panels:
        if panel.grouped_from:
            real[panel.bars] = (net.bar_multiple * net.rest_length)[panel.bars] / panel.bar_length
    return round(float(real.sum()))
