"""Added mass by the angle between bar and flow, against formulas by hand, and tables of one's own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fyke.case import CaseError
from fyke.case.added_mass import read_added_mass_table
from fyke.water.inertia import (
    ADDED_MASS_LAWS,
    SPHERE,
    AddedMassTable,
    ConstantAddedMass,
    LeeAddedMass,
    PotentialFlow,
)

DEGREES = np.radians([0.0, 30.0, 45.0, 90.0, 150.0, 180.0])


def test_lee_is_the_inertia_coefficient_less_the_water_itself():
    # C_m = 1 + sin a: 1, 1.5, 1.7071, 2, 1.5, 1.
    assert 1.0 + LeeAddedMass().coefficient(DEGREES) == pytest.approx([1, 1.5, 1 + 0.5**0.5, 2, 1.5, 1])


@given(st.floats(0.0, 2.0 * np.pi), st.floats(0.0, np.pi), st.floats(-np.pi, np.pi))
def test_potential_flow_across_the_bar_is_sine_squared_along_the_flow(azimuth, polar, turn):
    """C_a (I - t t^T) of a bar t, seen along a flow e at the angle a to it, is C_a sin^2 a in all directions."""
    t = np.array([np.cos(azimuth) * np.sin(polar), np.sin(azimuth) * np.sin(polar), np.cos(polar)])
    e = np.array([np.cos(turn), np.sin(turn), 0.0])
    angle = np.arctan2(np.linalg.norm(np.cross(t, e)), t @ e)
    tensor = PotentialFlow().coefficient(angle) * (np.eye(3) - np.outer(t, t))
    assert e @ tensor @ e == pytest.approx(np.sin(angle) ** 2, abs=1e-12)


def test_potential_flow_of_a_cylinder_by_its_kinetic_energy():
    """The dipole around a moving cylinder, phi = -a^2 cos(q) / r, carries 1/2 rho pi a^2 times C_a = 1."""
    r = np.linspace(1.0, 400.0, 400_001)
    energy = 0.5 * 2.0 * np.pi * np.trapezoid(r**-3.0, r)  # |grad phi|^2 = r^-4, around r dq
    assert energy / (0.5 * np.pi) == pytest.approx(float(PotentialFlow().coefficient(1.0)), rel=1e-4)
    # Around a sphere phi = -cos(q) / (2 r^2): |grad phi|^2 = (cos^2 + sin^2 / 4) / r^6 over 4/3 pi.
    shell = 2.0 * np.pi * (2.0 / 3.0 + 4.0 / 3.0 / 4.0)
    assert 0.5 * shell * np.trapezoid(r**-4.0, r) / (0.5 * 4.0 / 3.0 * np.pi) == pytest.approx(
        SPHERE, rel=1e-4
    )


def test_table_is_straight_between_points_held_beyond_and_the_same_from_either_end():
    table = AddedMassTable((np.radians(30.0), np.radians(60.0)), (0.2, 0.8))
    asked = np.radians([0.0, 30.0, 45.0, 60.0, 90.0, 135.0, -45.0])
    assert table.coefficient(asked) == pytest.approx([0.2, 0.2, 0.5, 0.8, 0.8, 0.5, 0.5])


def test_constant_says_so_and_others_do_not():
    assert ConstantAddedMass(1.3).coefficient(DEGREES) == pytest.approx(np.full(6, 1.3))
    for law in (ConstantAddedMass(), PotentialFlow(), LeeAddedMass()):
        flat = np.ptp(law.coefficient(DEGREES)) == 0.0
        assert flat == law.constant, law


@pytest.mark.parametrize(
    ("angle", "value"),
    [
        ((0.0,), (1.0,)),
        ((0.5, 0.5), (1.0, 1.0)),
        ((0.0, 2.0), (1.0, 1.0)),
        ((-0.1, 1.0), (1.0, 1.0)),
        ((0.0, float("nan")), (1.0, 1.0)),
        ((0.0, 1.0), (1.0, -0.1)),
        ((0.0, 1.0), (1.0, float("inf"))),
        ((0.0, 1.0), (1.0,)),
    ],
)
def test_tables_that_cannot_be_used_are_refused(angle, value):
    with pytest.raises(ValueError, match="must be"):
        AddedMassTable(angle, value)


def test_every_law_states_what_a_reader_needs():
    for name, law in ADDED_MASS_LAWS.items():
        assert name == law.name and law.title and law.source and law.read and law.__doc__


def test_a_file_holds_c_a_or_c_m(tmp_path):
    file = tmp_path / "mass.csv"
    file.write_text("# mine\nangle,coefficient\n0,0.1\n90,1.2\n")
    assert read_added_mass_table(file) == AddedMassTable((0.0, np.pi / 2.0), (0.1, 1.2))
    file.write_text("angle,inertia\n0,1.5\n90,3\n")
    assert read_added_mass_table(file) == AddedMassTable((0.0, np.pi / 2.0), (0.5, 2.0))


def test_every_fault_of_a_file_is_told_with_its_row(tmp_path):
    file = tmp_path / "mass.csv"
    file.write_text("angle,inertia\n0,1.5\n100,2\n30,0.5\n20,x\n40,1\n10,1\n10\n")
    with pytest.raises(CaseError) as told:
        read_added_mass_table(file)
    found = [(one.where.removeprefix(f"{file}, "), one.found) for one in told.value.problems]
    assert found == [
        ("row 3, column angle", "'100'"),
        ("row 4, column inertia", "'0.5'"),
        ("row 5, column inertia", "'x'"),
        ("row 8", "1 values"),
        ("row 7", "angle 10 after angle 40"),
    ]
    file.write_text("angle,inertia\n")
    with pytest.raises(CaseError, match="no row of numbers"):
        read_added_mass_table(file)
    file.write_text("angle,mass\n0,1\n90,1\n")
    with pytest.raises(CaseError, match="angle,coefficient or angle,inertia"):
        read_added_mass_table(file)
