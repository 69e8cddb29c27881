"""A chain that sags between two points in a current across it, in MoorDyn and in fyke, with the same bars."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import fyke
from fyke.study import Found

# Chain of studless links as an equivalent line: diameter (m), mass (kg/m), EA (N), length (m), bars, span and rise (m).
DIAMETER, MASS, EA, LENGTH, BARS = 0.036, 19.9, 1.0e7, 60.0, 30
ENDS = np.array([[0.0, 0.0, -40.0], [50.0, 0.0, -20.0]])
DENSITY, GRAVITY, SPEED, DRAG, ALONG = 1025.0, 9.81, 1.0, 1.6, 0.05
# MoorDyn's damping of the chain, over the critical one, and its steps and time (s): to rest.
ZETA, STEP, DURATION = 0.8, 1e-3, 120.0
VOLUME = np.pi / 4.0 * DIAMETER**2


def input_file():
    """MoorDyn's input: its axial drag is on the wetted surface, pi d l."""
    points = [f"{i + 1} Fixed {x} {y} {z} 0 0 0 0" for i, (x, y, z) in enumerate(ENDS.tolist())]
    return "\n".join(
        [
            "MoorDyn",
            "---- LINE TYPES ----",
            "Name Diam Mass EA BA EI Cd Ca CdAx CaAx",
            "(-) (m) (kg/m) (N) (N-s) (Nm2) (-) (-) (-) (-)",
            f"chain {DIAMETER} {MASS} {EA} {-ZETA} 0 {DRAG} 1.0 {ALONG / np.pi!r} 0.0",
            "---- POINTS ----",
            "ID Type X Y Z Mass Volume CdA Ca",
            "(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)",
            *points,
            "---- LINES ----",
            "ID Type A B Length Segments Outputs",
            "(#) (-) (#) (#) (m) (-) (-)",
            f"1 chain 1 2 {LENGTH} {BARS} -",
            "---- OPTIONS ----",
            "0 writeLog",
            f"{STEP} dtM",
            "rk4 tScheme",
            f"{GRAVITY} g",
            f"{DENSITY} rho",
            "200 WtrDpth",
            "1 WaveKin",
            "0 Currents",
            "1 disableOutput",
            "1 disableOutTime",
            "---- END ----",
            "",
        ]
    )


def by_moordyn():
    """Places (n, 3) m of the knots at the end, their largest speed (m/s) and the tension at the upper end (N)."""
    import moordyn

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "chain.txt"
        path.write_text(input_file())
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        moordyn.Init_NoIC(system, [], [])
    moordyn.ExternalWaveKinInit(system)
    places = len(moordyn.ExternalWaveKinGetCoordinates(system))
    moordyn.ExternalWaveKinSet(system, [[0.0, SPEED, 0.0]] * places, [[0.0] * 3] * places, 0.0)
    for call in range(60):
        moordyn.Step(system, [], [], call * DURATION / 60, DURATION / 60)
    line = moordyn.GetLine(system, 1)
    knots = range(BARS + 1)
    position = np.array([moordyn.GetLineNodePos(line, i) for i in knots])
    speed = max(np.abs(moordyn.GetLineNodeVel(line, i)).max() for i in knots)
    tension = moordyn.GetLineFairTen(line)
    moordyn.Close(system)
    return position, speed, tension


def by_fyke():
    twine = fyke.Twine("chain", MASS / VOLUME, DIAMETER, fyke.LinearLaw(EA / VOLUME))
    net = fyke.line(twine, np.linspace(*ENDS, BARS + 1), LENGTH / BARS)
    system = fyke.make_system(
        net,
        current=(0.0, SPEED, 0.0),
        water=fyke.Water(DENSITY, gravity=GRAVITY),
        coefficients=fyke.Coefficients(bars=fyke.ConstantBar(DRAG, ALONG)),
    )
    result = fyke.solve_static(system)
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return result


def measure(tables):
    position, speed, tension = by_moordyn()
    result = by_fyke()
    ours = result.position[-1]
    yield Found("speed", speed)
    yield Found("place", np.linalg.norm(ours - position, axis=1).max() / LENGTH)
    yield Found("swing", ours[:, 1].max(), position[:, 1].max())
    yield Found("depth", -ours[:, 2].min(), -position[:, 2].min())
    yield Found("tension", result.tension[-1][-1], tension)
