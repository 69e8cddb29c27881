"""Elastic laws, materials and twine by its tex number, against their formulas, quadrature and sums by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import fyke
from fyke.netting.measures import measure_net, measure_panel
from fyke.netting.twine import MATERIALS, Twine, diameter_of
from fyke.results.audit import audit, elastic_energy
from fyke.system.build import build_net, build_system
from reference import NO_FORCES, NO_WATER

# As REEF3D has them.
C1, C2 = 1160.0, 37300.0
LAW = fyke.QuadraticLaw(C1, C2)
TWINE = Twine("quadratic", 1140.0, 2e-3, LAW)


def quadratic(strain):
    return C1 * strain + C2 * strain**2


def strain_at(tension):
    """Return the inverse, the root of C2 e^2 + C1 e - T = 0 that is above zero."""
    return (-C1 + np.sqrt(C1**2 + 4.0 * C2 * tension)) / (2.0 * C2)


def hanging(twine, weights, *, density=NO_WATER):
    """Hang a line by its top, with a weight (N) at each knot below it; bars of 0.5 m."""
    bars = len(weights)
    load = np.zeros((bars + 1, 3))
    load[1:, 2] = -np.array(weights)
    points = np.outer(np.arange(bars + 1.0), [0.0, 0.0, -0.5])
    fixed = np.arange(bars + 1) == 0
    net = fyke.line(twine, points, 0.5, load=load, fixed=fixed)
    return fyke.make_system(net, water=density, coefficients=NO_FORCES)


@pytest.mark.parametrize("strain", [-0.1, 0.0, 1e-9, 0.013, 0.2, 1.0])
def test_quadratic_law_and_its_slope_are_the_formula(strain):
    from fyke.forces.tension import law_tension

    tension, slope = law_tension(max(strain, 0.0), LAW.rows(2e-3), 0, 1)
    assert tension == pytest.approx(quadratic(max(strain, 0.0)), rel=1e-15)
    assert slope == pytest.approx(C1 + 2.0 * C2 * max(strain, 0.0), rel=1e-15)


def test_energy_of_the_quadratic_law_is_its_integral():
    system = hanging(TWINE, [1.0] * 6)
    strain = np.array([-0.2, 0.0, 1e-3, 0.01, 0.1, 0.5])
    exact = [0.5 * quad(quadratic, 0.0, max(one, 0.0), epsabs=1e-14)[0] for one in strain]
    assert elastic_energy(system.elements, 0.5 * (1.0 + strain)) == pytest.approx(exact, rel=1e-12, abs=1e-15)


def test_statics_of_a_hanging_line_is_exact():
    weights = [3.0, 0.5, 20.0, 100.0]
    result = fyke.solve_static(hanging(TWINE, weights))
    tension = np.cumsum(weights[::-1])[::-1]
    assert result.outcome.ok
    assert result.tension[-1] == pytest.approx(tension, rel=1e-9)
    depth = -np.cumsum(0.5 * (1.0 + strain_at(tension)))
    assert result.position[-1][1:, 2] == pytest.approx(depth, rel=1e-10)


@pytest.mark.parametrize(
    "stepper", [fyke.Implicit(rtol=1e-6, atol=1e-12), fyke.Verner(rtol=1e-8), fyke.Symplectic()]
)
def test_a_mass_that_bounces_keeps_its_energy_and_comes_back(stepper):
    """One mass on one bar, let go at rest length: it turns where m g x = l0 (C1 e^2/2 + C2 e^3/3)."""
    mass, gravity = 2.0, 9.81
    system = hanging(TWINE, [mass * gravity])
    knot_mass = system.elements.knot_mass.copy()
    knot_mass[1] = mass
    system = replace(system, elements=system.elements._replace(knot_mass=knot_mass))
    # e (C1/2 + C2 e/3) = m g, with x = l0 e.
    turn = (-C1 / 2 + np.sqrt(C1**2 / 4 + 4 * C2 / 3 * mass * gravity)) / (2 * C2 / 3)
    result = fyke.simulate(system, duration=0.2, every=2e-4, stepper=stepper)
    assert result.outcome.ok
    lowest = result.position[:, 1, 2].min()
    assert -lowest - 0.5 == pytest.approx(0.5 * turn, rel=1e-3)


def test_the_balance_of_a_run_is_taken_with_the_law_inverted_exactly():
    """What the audit calls elastic energy of a settled net is that at the tension of its bars."""
    system = hanging(TWINE, [3.0, 20.0])
    result = fyke.simulate(system, duration=0.05, every=0.01, stepper=fyke.Implicit(rtol=1e-6, atol=1e-12))
    energy = audit(system, result).energy
    assert result.outcome.ok
    tension = result.tension[[0, -1]]
    before, after = (
        sum(0.5 * quad(quadratic, 0.0, one)[0] for one in strain_at(np.maximum(row, 0.0))) for row in tension
    )
    assert energy.elastic == pytest.approx(after - before, rel=1e-9)


def test_modes_of_a_stretched_bar_go_by_the_slope_of_the_law():
    """A mass on a taut bar rings at sqrt((C1 + 2 C2 e)/(l0 m)) along it."""
    weight, mass = 30.0, 30.0 / 9.81
    system = hanging(TWINE, [weight])
    knot_mass = system.elements.knot_mass.copy()
    knot_mass[1] = mass
    system = replace(system, elements=system.elements._replace(knot_mass=knot_mass))
    found = fyke.modes(system, fyke.solve_static(system).position[-1], count=3)
    along = np.sqrt((C1 + 2.0 * C2 * strain_at(weight)) / (0.5 * mass))
    assert found.frequency.max() == pytest.approx(along, rel=1e-6)


def test_a_saved_result_gives_the_law_back(tmp_path):
    result = fyke.solve_static(hanging(TWINE, [3.0]))
    fyke.save(result, tmp_path / "line.nc")
    assert fyke.load(tmp_path / "line.nc").net.twines == (TWINE,)


CASE = """
schema = 1
[current]
velocity = [0.5, 0.0, 0.0]
[twine.main]
material = "PA"
diameter = "1.5 mm"
[netting.main]
twine = "main"
mesh = "diamond"
bar_length = "30 mm"
[[gear]]
kind = "panel"
netting = "main"
meshes = [4, 4]
hanging_ratio = 0.6
"""


def written(*changes):
    text = CASE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


def test_quadratic_law_of_a_case():
    law = 'diameter = "1.5 mm"\nlaw = { kind = "quadratic", c1 = "1160 N", c2 = "37.3 kN" }'
    case = fyke.parse_case(written(('diameter = "1.5 mm"', law)))
    assert case.twines["main"].law == LAW
    assert any("C1 = 1160 N" in line for line in build_system(build_net(case), case).sources)


@pytest.mark.parametrize(("tex", "millimetres"), [(500.0, 0.93), (1000.0, 1.31), (2000.0, 1.85)])
def test_diameter_of_nylon_by_its_tex_number(tex, millimetres):
    """Figures of Rtex tables worked out by d = 2 sqrt(Rtex / (pi rho packing)), packing 0.65."""
    assert diameter_of(tex * 1e-6, 1140.0) == pytest.approx(millimetres * 1e-3, rel=4e-3)


def test_twine_by_rtex_weighs_what_it_weighs():
    """1000 tex is a gram a metre; in water it weighs less by the water that its fibre displaces."""
    case = fyke.parse_case(written(('diameter = "1.5 mm"', 'rtex = "1000 tex"\npacking = 0.6')))
    twine = case.twines["main"]
    assert twine.diameter == pytest.approx(np.sqrt(4.0 * 1e-3 / (np.pi * 1140.0 * 0.6)), rel=1e-12)
    net = build_net(case)
    length = 64 * 0.03
    assert net.bar_count == 64
    assert measure_net(net).mass == pytest.approx(1e-3 * length, rel=1e-12)
    assert measure_panel(net, net.panels[0]).rtex == pytest.approx(1000.0, rel=1e-12)
    system = build_system(net, case)
    assert system.weight_in_water == pytest.approx(9.81 * 1e-3 * length * (1.0 - 1000.0 / 1140.0), rel=1e-10)
    # Pores are full: fibre and water, and the added mass of the whole outline.
    pores = 1000.0 * (twine.area - 1e-3 / 1140.0) * length
    assert system.elements.knot_mass.sum() == pytest.approx(1e-3 * length + pores, rel=1e-12)
    assert system.displaced.bar.sum() == pytest.approx(0.5 * 1000.0 * twine.area * length, rel=1e-12)


def test_twine_by_diameter_and_rtex_has_its_own_mass_and_its_own_thickness():
    case = fyke.parse_case(written(('"1.5 mm"', '"1.5 mm"\nrtex = "12000 den"')))
    twine = case.twines["main"]
    assert (twine.diameter, twine.density) == (1.5e-3, 1140.0)
    assert twine.mass_per_length == pytest.approx(12000.0 / 9.0 * 1e-6, rel=1e-14)
    assert build_system(build_net(case), case).elements.normal_drag == pytest.approx(
        0.25 * 1000.0 * 1.5e-3 * 1.2, rel=1e-12
    )


def test_twine_that_is_all_fibre_is_the_same_by_tex_and_by_density():
    solid = 1140.0 * np.pi * 1.5e-3**2 / 4.0
    by_tex = replace(TWINE, diameter=1.5e-3, linear_density=solid)
    assert by_tex.soaked_density(1025.0) == pytest.approx(1140.0, rel=1e-13)
    assert by_tex.mass_per_length == pytest.approx(
        replace(by_tex, linear_density=None).mass_per_length, rel=1e-14
    )


def test_copper_alloy_is_naval_brass():
    """8.41 g/cm3 and 15 million psi: pound-force 4.4482216 N on 0.0254 m squared."""
    brass = MATERIALS["CuZn"]
    assert brass.density == 8410.0
    assert brass.youngs_modulus == pytest.approx(15e6 * 4.4482216152605 / 0.0254**2, rel=1e-7)
    assert "C46400" in brass.source


OWN = """
[material.PLA]
density = "1.24 g/cm3"
youngs_modulus = "3.5 GPa"
loss_factor = 0.03
source = "sheet of the maker"
[twine.main]"""


def test_material_of_the_users_own():
    from fyke.cli.texts import sources_of

    case = fyke.parse_case(written(("[twine.main]", OWN), ('"PA"', '"PLA"')))
    twine = case.twines["main"]
    assert (twine.density, twine.law, twine.loss_factor) == (1240.0, fyke.LinearLaw(3.5e9), 0.03)
    assert "material PLA: sheet of the maker" in sources_of(case, build_system(build_net(case), case))


WRONG = {
    "material that is a known one": (
        [("[twine.main]", OWN.replace("PLA", "PES"))],
        ("line 6, [material.PES]", '"PES"', "a name of its own", "[material.PES-mine]"),
    ),
    "material misspelled": (
        [("[twine.main]", OWN), ('"PA"', '"PLAA"')],
        ("[twine.main] material", '"PLAA"', '"CuZn"', 'did you mean "PLA"?'),
    ),
    "material without density": (
        [("[twine.main]", OWN.replace('density = "1.24 g/cm3"\n', "")), ('"PA"', '"PLA"')],
        ("[material.PLA] density", "nothing", "kg/m3", "density = 1140.0"),
    ),
    "no thickness": (
        [('diameter = "1.5 mm"\n', "")],
        ("[twine.main] diameter", "nothing", "rtex", 'add diameter = "1.5 mm"'),
    ),
    "tex without a unit": (
        [('diameter = "1.5 mm"', "rtex = 2000")],
        ("[twine.main] rtex", "2000", "tex, dtex", 'in quotes: "2000 tex"'),
    ),
    "packing besides a diameter": (
        [('"1.5 mm"', '"1.5 mm"\nrtex = "1000 tex"\npacking = 0.6')],
        ("[twine.main] packing", "both packing and diameter", "rtex alone", "leave out packing or diameter"),
    ),
    "packing of nothing": (
        [('"1.5 mm"', '"1.5 mm"\npacking = 0.6')],
        ("[twine.main] packing", "both", "rtex alone", "leave out packing"),
    ),
    "more fibre than room": (
        [('"1.5 mm"', '"1.5 mm"\nrtex = "20 ktex"')],
        ("[twine.main] rtex", "20000 tex in a diameter of 1.5 mm", "4.726 mm", "check the units"),
    ),
    "law of no force": (
        [('"1.5 mm"', '"1.5 mm"\nlaw = { kind = "quadratic", c1 = "1160 Pa", c2 = 37300 }')],
        ("[twine.main] law.c1", '"1160 Pa"', "a force above 0", "unit of pressure"),
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_wrong_twines_are_told_in_words(what):
    changes, (where, found, allowed, cure) = WRONG[what]
    with pytest.raises(fyke.CaseError) as error:
        fyke.parse_case(written(*changes), "c.toml")
    assert len(error.value.problems) == 1, error.value
    problem = error.value.problems[0]
    for said, part in zip(
        (problem.where, problem.found, problem.allowed, problem.cure),
        (where, found, allowed, cure),
        strict=True,
    ):
        assert part in said
