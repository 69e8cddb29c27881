"""Planted errors: each is caught by rows of validation/, here by those named, and by nothing's accident."""

from __future__ import annotations

from itertools import count

import pytest

from fyke.solve import verner
from fyke.study.validate import judge
from fyke.system import build
from fyke.water.laws.panels import Aarsnes, Loland
from reference import VALIDATION


def failing(name: str) -> set[str]:
    """Quantities of a claim that fail somewhere."""
    rows = judge(VALIDATION / f"{name}.toml").rows
    told = {row.quantity for row in rows if row.verdict == "fails"}
    assert "the claim itself" not in told
    return told


@pytest.fixture
def of_elements(monkeypatch):
    """Return a changer of fields of Elements: what(name, value) in place of the value."""

    def change(**what):
        made = build.Elements

        def wrong(**fields):
            return made(
                **{name: what.get(name, lambda value: value)(value) for name, value in fields.items()}
            )

        monkeypatch.setattr(build, "Elements", wrong)

    return change


def test_drag_five_per_cent_off(of_elements):
    assert failing("inclined_bar") == set()
    of_elements(normal_drag=lambda c: 1.05 * c, tangential_drag=lambda c: 1.05 * c)
    assert failing("inclined_bar") == {
        "drag over 1/2 rho U^2 d l",
        "lift over the same",
        "upward force over the same: down, as the bar rises downstream",
    }
    assert {"sag of the middle mesh", "drag", "largest tension"} <= failing("independent_panel")


def test_drag_of_knots_five_per_cent_off(of_elements):
    assert failing("sphere_on_string") == set()
    of_elements(knot_drag=lambda c: 1.05 * c)
    assert failing("sphere_on_string") == {"excursion", "depth", "tension", "drag"}


@pytest.mark.parametrize("law", [Loland, Aarsnes])
def test_sign_of_lift(law, monkeypatch):
    """Of the formula, which is also that of the kernels."""
    right = law.form.fget

    def wrong(self):
        form = right(self)
        return form._replace(lift=tuple(-one for one in form.lift))

    monkeypatch.setattr(law, "form", property(wrong))
    assert failing("panel_laws") == {"largest error of C_L"}


def test_sign_of_lift_of_a_bar(of_elements):
    """A tangential force along the water's own turns the small part of the lift round."""
    of_elements(tangential_drag=lambda c: -c)
    assert "lift over the same" in failing("inclined_bar")


def test_added_mass_doubled(of_elements):
    assert failing("netting_measures") == set()
    of_elements(bar_added_mass=lambda mass: 2.0 * mass)
    assert failing("netting_measures") == {"mass of water that moves along"}
    assert failing("dop853") == {
        "largest distance from SciPy's places, Verner",
        "largest distance from SciPy's places, leapfrog, steps of 0.05 ms",
        "largest distance from SciPy's places, implicit, steps of 0.25 ms",
        "largest distance from SciPy's places, Newmark, steps of 0.25 ms",
    }


def test_weight_of_bars_halved(monkeypatch):
    """Of the two sums over the bars, the mass and the weight in water, the second."""
    right, calls = build._to_knots, count()
    monkeypatch.setattr(
        build, "_to_knots", lambda net, each: right(net, each) * (0.5 if next(calls) % 2 else 1.0)
    )
    assert failing("netting_measures") == {"weight that the frame of the 8 x 8 panel bears"}
    assert "largest error of a bar's tension" in failing("hanging_nets")


def test_a_transposed_entry_of_the_tableau(monkeypatch):
    """Two numbers of a row exchanged, which keeps its sum."""
    table, kernel = [list(row) for row in verner.A], verner._A.copy()
    table[6][1], table[6][2] = table[6][2], table[6][1]
    kernel[6, 1], kernel[6, 2] = verner._A[6, 2], verner._A[6, 1]
    monkeypatch.setattr(verner, "A", tuple(tuple(row) for row in table))
    monkeypatch.setattr(verner, "_A", kernel)
    assert {"order conditions that hold", "norm of the errors of the next order"} <= failing(
        "verner_conditions"
    )
    assert failing("steppers") == {"order with twice as many steps"}


def test_a_law_of_twine_five_per_cent_off(monkeypatch):
    """The modulus alone, which the shape of a slack panel hardly shows: see the rows of sensitivity."""
    right = build._laws

    def wrong(net):
        rows, first, end, stiffness = right(net)
        return 1.05 * rows, first, end, 1.05 * stiffness

    monkeypatch.setattr(build, "_laws", wrong)
    assert "largest error of a knot's place" in failing("chain")
