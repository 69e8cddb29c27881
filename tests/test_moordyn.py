"""The panel and a mooring line in MoorDyn, another program, by `make test-peers`.

Of the panel one point for each knot and one line for each bar.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import fyke

pytestmark = [
    pytest.mark.peers,
    pytest.mark.skipif(
        importlib.util.find_spec("moordyn") is None,
        reason='MoorDyn is not installed; `make test-peers` does it, or pip install -e ".[peers]"',
    ),
]


def test_moordyn_swings_the_panel_into_the_shape_of_statics(monkeypatch):
    """Two seconds from rest in 0.5 m/s by Runge-Kutta steps of 90 us, nothing of fyke in it: the same 144 knots."""
    monkeypatch.syspath_prepend(Path(__file__).parents[1] / "benchmarks")
    from peer_motion import moordyn
    from peer_panel import fyke_system, make_panel

    panel = make_panel(8)
    position, velocity = moordyn(panel, 90e-6)()
    assert np.abs(velocity).max() < 1e-6
    static = fyke.solve_static(fyke_system(panel), tolerance=1e-10)
    assert static.outcome.ok
    assert np.ptp(static.position[-1][:, 0]) > 0.09
    # MoorDyn takes the drag on the unloaded length of a bar, fyke on its length: 3e-5 m.
    assert np.abs(position - static.position[-1]).max() < 1e-4


SPAN, DEPTH, TOP, LENGTH, SEGMENTS = 38.0, 15.0, -1.0, 45.0, 45
THICK, HEAVY, STIFF = 0.03, 4000.0, 2e5  # m, kg/m3, N


def moored_by_moordyn(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and tensions there of a line on the sea bed in part, after its own search for rest and 20 s more."""
    import moordyn

    mass = HEAVY * np.pi / 4.0 * THICK**2
    text = f"""MoorDyn
---- LINE TYPES ----
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (Nm2) (-) (-) (-) (-)
rope {THICK} {mass!r} {STIFF} -0.8 0 1.2 1.0 0.5 0
---- POINTS ----
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)
1 Fixed 0 0 {-DEPTH} 0 0 0 0
2 Fixed {SPAN} 0 {TOP} 0 0 0 0
---- LINES ----
ID Type A B Length Segments Outputs
(#) (-) (#) (#) (m) (-) (-)
1 rope 1 2 {LENGTH} {SEGMENTS} -
---- OPTIONS ----
0 writeLog
1e-4 dtM
9.81 g
1025 rho
{DEPTH} WtrDpth
3e6 kBot
3e5 cBot
0 FrictionCoefficient
60 TmaxIC
1 disableOutput
1 disableOutTime
---- END ----
"""
    path = folder / "mooring.txt"
    path.write_text(text)
    system = moordyn.Create(str(path))
    moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
    moordyn.Init(system, [], [])
    for second in range(20):
        moordyn.Step(system, [], [], float(second), 1.0)
    line = moordyn.GetLine(system, 1)
    nodes = range(SEGMENTS + 1)
    x = np.array([moordyn.GetLineNodePos(line, i) for i in nodes])
    tension = np.array([np.linalg.norm(moordyn.GetLineNodeTen(line, i)) for i in nodes])
    moordyn.Close(system)
    return x, tension


def test_moordyn_lays_a_mooring_line_on_the_sea_bed_alike(tmp_path):
    """The same bars on the same ground, without friction: 1 mm, of which the soft half of the ground is the most."""
    x, tension = moored_by_moordyn(tmp_path)
    rope = fyke.Twine("rope", HEAVY, THICK, fyke.LinearLaw(STIFF / (np.pi / 4.0 * THICK**2)))
    net = fyke.with_line(
        None,
        (0.0, 0.0, -DEPTH),
        (SPAN, 0.0, TOP),
        [fyke.LinePiece(rope, LENGTH, SEGMENTS)],
        name="m",
        bed=-DEPTH,
        water=1025.0,
    )
    water = fyke.Water(density=1025.0)
    system = fyke.make_system(net, water=water, bed=fyke.Bed(DEPTH, friction=0.0))
    result = fyke.solve_static(system, tolerance=1e-7)
    assert np.count_nonzero(x[:, 2] < -DEPTH) > 15
    assert np.abs(result.position[-1] - x).max() < 1.5e-3
    assert tension[[0, -1]] == pytest.approx(result.tension[-1][[0, -1]], rel=1e-3)
