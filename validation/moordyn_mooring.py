"""A mooring line that lies in part on the ground, in still water without friction, in MoorDyn and in fyke."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import fyke
from fyke.study import Found

SPAN, DEPTH, TOP, LENGTH, SEGMENTS = 38.0, 15.0, -1.0, 45.0, 45
THICK, HEAVY, STIFF = 0.03, 4000.0, 2e5  # m, kg/m3, N
AREA = np.pi / 4.0 * THICK**2


def input_file():
    return f"""MoorDyn
---- LINE TYPES ----
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (Nm2) (-) (-) (-) (-)
rope {THICK} {HEAVY * AREA!r} {STIFF} -0.8 0 1.2 1.0 0.5 0
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


def by_moordyn():
    """Places (n, 3) m and tensions (n,) N of the nodes, after its own search for rest and 20 s more."""
    import moordyn

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mooring.txt"
        path.write_text(input_file())
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


def by_fyke():
    rope = fyke.Twine("rope", HEAVY, THICK, fyke.LinearLaw(STIFF / AREA))
    net = fyke.with_line(
        None,
        (0.0, 0.0, -DEPTH),
        (SPAN, 0.0, TOP),
        [fyke.LinePiece(rope, LENGTH, SEGMENTS)],
        name="m",
        bed=-DEPTH,
        water=1025.0,
    )
    bed = fyke.Bed(DEPTH, friction=0.0)
    result = fyke.solve_static(
        fyke.make_system(net, water=fyke.Water(density=1025.0), bed=bed), tolerance=1e-7
    )
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return result


def measure(tables):
    x, tension = by_moordyn()
    result = by_fyke()
    yield Found("lying", np.count_nonzero(x[:, 2] < -DEPTH))
    yield Found("place", np.abs(result.position[-1] - x).max())
    yield Found("tension", result.tension[-1][0], tension[0], "at the anchor")
    yield Found("tension", result.tension[-1][-1], tension[-1], "at the fairlead")
