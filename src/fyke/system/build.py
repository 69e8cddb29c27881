"""From the case to the net, and from the net to the system."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from ..case.schema import Case
from ..netting.faces import faces_of
from ..netting.net import Net
from ..netting.together import together
from ..netting.twine import MATERIALS, Twine
from ..water.bed import Bed
from ..water.current import Current, UniformCurrent
from ..water.inertia import AddedMassLaw
from ..water.laws import Law
from ..water.laws.bars import ConstantBar
from ..water.laws.knots import ConstantKnot
from ..water.waves import Waves
from .curves import CONSTANT_BARS, NONE, bar_curves, knot_curve
from .elements import DragLaws, Elements
from .laws import Coefficients, Water
from .motion import Motion, Move
from .moves import motion_of
from .rigging import free_rings, rigged
from .system import Displaced, System

Array = NDArray[np.float64]

# Strain at which the secant of an elastic law stands for its stiffness where one number is needed.
REFERENCE_STRAIN = 0.01
NOT_READ = "-"  # of a law that has nothing to be read


def build_net(case: Case) -> Net:
    """Make the net of a case: its netting and rings of their own as the file has them, then the rest."""
    twines = case.twines
    made = [(piece, case.netting[piece.netting]) for piece in case.pieces]
    laid = [piece.lay(netting, twines[netting.twine]) for piece, netting in made] + free_rings(case)
    return rigged(together(laid) if laid else None, case)


def build_system(net: Net, case: Case) -> System:
    """Put a net into the water of a case."""
    water = case.water
    system = make_system(
        net,
        current=case.current.flow(),
        water=Water(water.density, water.kinematic_viscosity, water.gravity),
        coefficients=_coefficients(case),
        waves=_waves(case),
        surface=True,
        bed=case.bed.ground(water.depth) if case.bed and water.depth else None,
    )
    return replace(system, case_text=case.text, motion=motion_of(net, case))


def _waves(case: Case) -> Waves | None:
    """Waves of a case; a static one has none, just as its current has no ramp."""
    if case.waves is None or case.solve.kind == "static":
        return None
    return case.waves.sea(case.water.depth, case.water.gravity)


def _coefficients(case: Case) -> Coefficients:
    """Laws of a case. CaseError for a table of coefficients that cannot be used."""
    return Coefficients(
        bars=case.drag.bar_law(solidity=case.solidity, folder=case.folder),
        knots=case.drag.knot_law(),
        screens=case.drag.panel_law(),
        added_mass_bar=case.added_mass.bar_law(folder=case.folder),
        added_mass_knot=case.added_mass.knot_coefficient(),
        wake=case.shelter.wake_law(),
        twines=case.shelter.twine_law(),
    )


def make_system(
    net: Net,
    *,
    current: Current | tuple[float, float, float] = (0.0, 0.0, 0.0),
    water: Water | None = None,
    coefficients: Coefficients | None = None,
    waves: Waves | None = None,
    surface: bool = False,
    bed: Bed | None = None,
    moves: Sequence[Move] = (),
) -> System:
    """Freeze a net in water: masses, weights and drag coefficients of every knot and bar.

    surface: the water ends at z = 0, or at the crest and trough of the waves; otherwise it is everywhere; bed: the
    ground that knots come to lie on; moves: of held knots, ValueError for free ones.
    """
    w = water or Water()
    c = coefficients or Coefficients()
    area = np.array([t.area for t in net.twines])[net.twine_of_bar]
    density = np.array([t.soaked_density(w.density) for t in net.twines])[net.twine_of_bar]
    volume = net.bar_multiple * area * net.rest_length
    knot_volume = net.knot_multiple * np.pi / 6.0 * net.knot_diameter**3
    body_mass, body_volume = net.at_knots("mass"), net.at_knots("volume")
    mass = _to_knots(net, density * volume) + net.knot_density * knot_volume + body_mass
    sinking = _to_knots(net, (density - w.density) * volume) + (net.knot_density - w.density) * knot_volume
    sinking += body_mass - w.density * body_volume
    knot_volume = knot_volume + body_volume
    weight = net.load.copy()
    weight[:, 2] -= w.gravity * sinking
    rows, first, end, stiffness = _laws(net)
    linear = bool(np.all(rows[:, 3] == 0.0) and np.all(end - first == 1))
    knot_mass = mass + c.added_mass_knot * w.density * knot_volume
    damping = _retardation(net, ringing(net, stiffness, knot_mass))
    drag, drag_laws = _drag(net, w, c)
    elements = Elements(
        knot_a=np.ascontiguousarray(net.bars[:, 0], dtype=np.uint32),
        knot_b=np.ascontiguousarray(net.bars[:, 1], dtype=np.uint32),
        rest_length=net.rest_length.copy(),
        stiffness=stiffness,
        damping_time=damping,
        bar_added_mass=0.5 * float(c.bar_mass.coefficient(0.5 * np.pi)) * w.density * volume,
        law_rows=rows,
        law_first=first,
        law_end=end,
        linear=linear,
        damped=bool(np.any(damping > 0.0)),
        knot_mass=knot_mass,
        weight=weight,
        free=(~net.fixed).astype(float),
        two_way=net.two_way,
        **drag,
    )
    flow = current if not isinstance(current, tuple) else UniformCurrent(current)
    return System(
        net,
        flow,
        elements,
        float(w.gravity * sinking.sum()),
        water=w,
        coefficients=c,
        displaced=Displaced(0.5 * w.density * volume, w.density * knot_volume),
        drag_laws=drag_laws,
        waves=waves,
        surface=surface or waves is not None,
        faces=faces_of(net) if c.screens or c.wake or c.twines else None,
        bed=bed,
        motion=Motion(net, moves) if moves else None,
        sources=(*_sources(net, c, damping, waves), *((bed.told,) if bed else ())),
    )


def _drag(net: Net, w: Water, c: Coefficients) -> tuple[dict[str, Array], DragLaws | None]:
    """Fields of Elements that say how the water drags, and the laws that change them."""
    scale = 0.25 * w.density * net.bar_multiple * net.bar_diameter
    disc = 0.5 * w.density * net.knot_multiple * np.pi / 4.0 * net.knot_diameter**2
    if c.screens is not None:
        for panel in net.panels:
            scale[panel.bars] = 0.0
            disc[panel.knots] = 0.0
    across, along, bars = bar_curves(c.bars)
    reference, knots = knot_curve(c.knots)
    own = disc * reference
    whole = own + 0.5 * w.density * net.at_knots("drag_area")
    fields = {
        "normal_drag": scale * across,
        "tangential_drag": scale * along,
        "knot_drag": whole,
        "drag_slopes": np.zeros((4, 0)),
        "knot_slopes": np.zeros(0),
    }
    if bars is CONSTANT_BARS and knots is NONE:
        return fields, None
    laws = DragLaws(
        bar_reynolds=net.bar_diameter / w.kinematic_viscosity,
        bars=bars,
        knot_reynolds=net.knot_diameter / w.kinematic_viscosity,
        knots=knots,
        knot_share=np.divide(own, whole, out=np.zeros_like(whole), where=whole > 0.0),
    )
    return fields, laws


def ringing(net: Net, stiffness: Array, knot_mass: Array) -> Array:
    """Frequency (m,) rad/s at which the two knots of a bar would swing along it if nothing but the bar held them.

    omega^2 = k (1/m_a + 1/m_b), a held knot being heavy beyond measure; 0 between two held knots. stiffness: (m,) N/m;
    knot_mass: (n,) kg, added mass of the knot included.
    """
    moves = ~net.fixed & (knot_mass > 0.0)
    lightness = np.divide(1.0, knot_mass, out=np.zeros_like(knot_mass), where=moves)
    a, b = net.bars.T
    return np.asarray(np.sqrt(stiffness * (lightness[a] + lightness[b])))


def _retardation(net: Net, frequency: Array) -> Array:
    """Retardation time of every bar, (m,) s: the twine's, and tan delta / omega at the bar's ringing (rad/s)."""
    time = np.array([t.damping_time for t in net.twines])[net.twine_of_bar]
    loss = np.array([t.loss_factor for t in net.twines])[net.twine_of_bar]
    return np.asarray(time + np.divide(loss, frequency, out=np.zeros_like(loss), where=frequency > 0.0))


def _sources(net: Net, c: Coefficients, damping: Array, waves: Waves | None) -> tuple[str, ...]:
    """One line for each law: what it says, where it comes from and how far that was read."""
    return (
        *_drag_sources(net, c),
        *(
            f"shelter {where}: {_told(law)}"
            for where, law in (("behind netting", c.wake), ("between twines", c.twines))
            if law is not None
        ),
        _mass_source(c),
        *_wave_sources(waves),
        *(f"elastic law of twine '{t.name}': {t.law.describe()}" for t in net.twines),
        *(
            f"bending of '{t.name}': EI = {t.bending_stiffness:.4g} N m2, discrete elastic rods (M. Bergou et al., ACM "
            "Trans. Graph. 27(3), 63, 2008, not opened; derived here and checked)"
            for t in net.twines
            if t.bending_stiffness > 0.0
        ),
        *(
            f"damping of twine '{t.name}': {_damping(t, damping[net.twine_of_bar == i])}"
            for i, t in enumerate(net.twines)
        ),
    )


def _drag_sources(net: Net, c: Coefficients) -> Iterator[str]:
    """One line for screens, and for bars and knots where there are some outside of them."""
    if c.screens is not None and net.panels:
        yield f"drag of netting as screens: {_told(c.screens)}"
        if len(np.unique(np.concatenate([panel.bars.ravel() for panel in net.panels]))) == net.bar_count:
            return
    if isinstance(c.bars, ConstantBar):
        yield (
            f"bar drag: constant C_n = {c.bars.normal:g}, C_t = {c.bars.tangential:g} on d x length, normal and "
            "tangential parts apart (split: Choo & Casarella 1971, J. Hydronautics 5(4); values 1.2, 0.1: Bessonneau & "
            "Marichal 1998, Ocean Eng. 25(7))"
        )
    else:
        yield f"bar drag: {_told(c.bars)}"
    if isinstance(c.knots, ConstantKnot):
        yield f"knot drag: constant C_D = {c.knots.drag:g} of a sphere on pi d^2/4"
    else:
        yield f"knot drag: {_told(c.knots)}"


def _told(law: Law | AddedMassLaw) -> str:
    """Title, parameters and source of a law, and how far that was read."""
    known = {one.name: getattr(law, one.name) for one in fields(law)}  # type: ignore[arg-type] # all are dataclasses
    given = [f"{name} = {value:g}" for name, value in known.items() if isinstance(value, float)]
    given += [f"{name} = {value}" for name, value in known.items() if isinstance(value, str)]
    given += [f"by {value.title} ({value.name})" for value in known.values() if isinstance(value, Law)]
    read = "" if law.read == NOT_READ else f"; read {law.read}"
    return f"{', '.join([law.title, *given])} ({law.source}{read})"


def _mass_source(c: Coefficients) -> str:
    """One line for the added mass."""
    law = c.bar_mass
    bar = f"C_a = {float(law.coefficient(0.0)):g}" if law.constant else _told(law)
    return f"added mass: {bar} across a bar, {c.added_mass_knot:g} of a knot (potential flow: cylinder 1, sphere 1/2)"


def _wave_sources(waves: Waves | None) -> Iterator[str]:
    """One line for the waves, what they do at the surface, and the force of accelerating water."""
    if waves is None:
        return
    if waves.named is not None:
        yield f"waves: {waves.named.kind} ({waves.named.source})"
    if waves.stretching == "wheeler":
        yield (
            "waves up to the surface: J.D. Wheeler, Method for calculating forces produced by irregular waves, J. "
            "Petroleum Technology 22, 1970; read in public codes"
        )
    yield (
        "force of accelerating water: (1 + C_a) rho V a across a bar and of a knot, rho V a along a bar (J.R. Morison, "
        "M.P. O'Brien, J.W. Johnson, S.A. Schaaf, The force exerted by surface waves on piles, Petroleum Transactions "
        "189, 149-154, 1950; not opened, for a moving body worked out)"
    )


def _damping(twine: Twine, time: Array) -> str:
    """Say what damps the bars of a twine, whose retardation times (s) are these."""
    longest = float(time.max(initial=0.0))
    if longest == 0.0:
        return "none"
    said = f"Kelvin-Voigt, retardation time {longest:.3g} s"
    if twine.loss_factor == 0.0:
        return said
    said += f" at most, of it loss factor {twine.loss_factor:g} over the frequency of each bar's ringing"
    material = MATERIALS.get(twine.material)
    return (
        f"{said} ({material.loss_source})" if material and material.loss_factor == twine.loss_factor else said
    )


def _to_knots(net: Net, per_bar: Array) -> Array:
    """Half of a bar's share to each end, (n,)."""
    out = np.zeros(net.knot_count)
    np.add.at(out, net.bars, 0.5 * per_bar[:, None])
    return out


def _laws(net: Net) -> tuple[Array, NDArray[np.int32], NDArray[np.int32], Array]:
    """Rows of all laws, first and end row of every bar, and stiffness (N/m) of every bar.

    One law for every twine and every number of bars side by side, whose tensions add up.
    """
    multiples, place = np.unique(net.bar_multiple, return_inverse=True)
    code = net.twine_of_bar * len(multiples) + place
    there = np.bincount(code, minlength=len(net.twines) * len(multiples)) > 0
    which = (np.cumsum(there) - 1)[code]
    own = [t.law.rows(t.diameter) for t in net.twines]
    kinds = [(k // len(multiples), multiples[k % len(multiples)]) for k in np.flatnonzero(there).tolist()]
    tables = [own[twine] * np.array([1.0, many, many, many, 1.0]) for twine, many in kinds]
    end = np.cumsum([len(t) for t in tables], dtype=np.int64)
    first = end - [len(t) for t in tables]
    secant = np.array([_tension(t, REFERENCE_STRAIN) / REFERENCE_STRAIN for t in tables])
    return (
        np.concatenate([np.empty((0, 5)), *tables]),
        first[which].astype(np.int32),
        end[which].astype(np.int32),
        secant[which] / net.rest_length,
    )


def _tension(rows: Array, strain: float) -> float:
    """Tension (N) at one strain > 0 by the rows of netting.elastic."""
    row = rows[np.searchsorted(rows[:, 0], strain, side="right") - 1]
    x = strain - row[0]
    return float(row[1] + row[2] * x + row[3] * x ** row[4])
