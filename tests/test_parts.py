"""Forces besides those of bars, knots and screens: what statics and implicit steps make of any of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fyke
from fyke.forces import surroundings
from fyke.netting.together import together
from fyke.results.audit import audit
from reference import NO_FORCES, NO_WATER, thread

STIFFNESS, DASHPOT = 3.0, 0.4


class Ties:
    """Springs of no length (N/m) and dashpots (N s/m) between pairs of knots that no bar joins."""

    def __init__(self, pairs):
        self.groups = np.array(pairs, dtype=np.int64)

    def see(self, x, v, time):
        a, b = self.groups.T
        self.force = STIFFNESS * (x[b] - x[a]) + DASHPOT * (v[b] - v[a])

    def add_load(self, out):
        np.add.at(out, self.groups[:, 0], self.force)
        np.subtract.at(out, self.groups[:, 1], self.force)

    def assemble(self, c0, c1, places, *, symmetric, data):
        start, stride = places
        value = c0 * STIFFNESS + c1 * DASHPOT
        for f in range(len(self.groups)):
            for i in range(2):
                for k in range(2):
                    if start[f, i, k] >= 0:
                        at = start[f, i, k] + np.arange(3) * (stride[f, k] + 1)
                        data[at] += value if i == k else -value


@pytest.fixture
def tied(monkeypatch):
    """Two strings hang side by side; their lower knots, of 2 kg each, are tied."""
    monkeypatch.setattr(surroundings, "parts_of", lambda system: (Ties([[1, 3]]),))
    load = np.zeros((4, 3))
    load[1, 2], load[3, 2] = -20.0, -10.0
    points, heavy = [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0]], {"knot_diameter": 0.08, "knot_density": 7500.0}
    one = fyke.line(thread(5e4), points, 1.0, load=load[:2], **heavy)
    other = fyke.line(thread(5e4), np.add(points, [0.5, 0.0, 0.0]), 1.0, load=load[2:], **heavy)
    net = replace(together([one, other]), fixed=np.array([True, False, True, False]))
    return fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)


def test_statics_balances_a_part_that_joins_knots_without_a_bar(tied):
    """By moments: knot of weight W on a string of length l pulled aside by k d, d the distance of the knots."""
    result = fyke.solve_static(tied, tolerance=1e-10)
    assert result.outcome.ok, result.outcome
    x = result.position[-1]
    pull = STIFFNESS * (x[3] - x[1])
    for knot, top, sign, weight in ((1, 0, 1.0, 20.0), (3, 2, -1.0, 10.0)):
        arm = x[knot] - x[top]
        force = sign * pull + np.array([0.0, 0.0, -weight])
        assert np.cross(arm, force) == pytest.approx(np.zeros(3), abs=1e-9)
    assert x[3, 0] - x[1, 0] < 0.5
    # Frame: the part is no force of the water, and the supports carry the weights alone.
    assert result.frame().hydrodynamic_force == pytest.approx(np.zeros(3), abs=1e-12)
    assert result.frame().support_reaction == pytest.approx([0.0, 0.0, -30.0], abs=1e-8)
    assert audit(tied, result).unbalanced_force < 1e-9


def test_energy_of_a_part_is_in_the_accounts(tied):
    result = fyke.simulate(tied, duration=1.0, every=0.01, stepper=fyke.Implicit(rtol=1e-4))
    energy = audit(tied, result).energy
    assert energy.parts_work != 0.0
    size = abs(energy.kinetic) + abs(energy.potential) + abs(energy.elastic) + abs(energy.parts_work)
    assert abs(energy.remainder) < 0.02 * size
