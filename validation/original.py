"""The original paper's own claims, on examples/panel.toml, and on square netting where it tells of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import fyke
from fyke.study import Found
from panels import framed, settled

EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "panel.toml"
SQUARE = {"mesh": "square", "size": (0.216, 0.216), "meshes": (8, 8)}
# Released flat and slack: time to settle (s), and the damping of the twine (s) with which every stepper comes to rest.
DURATION, DAMPING = 3.0, 2e-5


def mirrored(net):
    """For every knot the one at its mirror image about the vertical middle line."""
    image = net.positions * [1.0, -1.0, 1.0]
    return np.argmin(np.linalg.norm(net.positions[None] - image[:, None], axis=2), axis=1)


def grid(net):
    """Row and column of every knot, from -1 to 1 across the panel."""
    at = np.array([[int(part) for part in label.split("-")] for label in net.labels], dtype=float)
    return 2.0 * at / at.max(axis=0) - 1.0


def middles(net):
    """Places of the bars' middles, from -1 to 1 across the panel."""
    at = grid(net)
    return 0.5 * (at[net.bars[:, 0]] + at[net.bars[:, 1]])


def settling(system, stepper):
    return fyke.simulate(
        system, duration=DURATION, every=0.05, stepper=stepper, settle=fyke.Settle(force=1e-6)
    )


def measure(tables):
    case = fyke.load_case(EXAMPLE)
    system = fyke.build_system(fyke.build_net(case), case)
    rest = settled(system, tolerance=1e-11)
    x, tension, net = rest.position[-1], rest.tension[-1], system.net
    yield Found("residual", rest.unbalanced_force[-1])
    twin = mirrored(net)
    yield Found("symmetry", np.abs(x[twin] * [1.0, -1.0, 1.0] - x).max())
    yield from diamonds(net, tension)
    yield from squares()
    yield from sinking(system, x)
    yield from coming_to_rest(rest)


def diamonds(net, tension):
    """Along the four sides against the middle mesh, bar by bar at its middle."""
    outermost = np.abs(middles(net)).max(axis=1)
    rim, middle = outermost > 0.9, outermost < 0.1
    yield Found("rim", tension[rim].mean() / tension[middle].mean())
    yield Found("largest", outermost[np.argmax(tension)])
    slack = tension == 0.0
    yield Found("slack", np.count_nonzero(slack))
    yield Found("corners", np.abs(middles(net))[slack].min())


def squares():
    """Along the diagonals against the rest; and where the panel hangs by its corners."""
    framed_square = settled(framed(**SQUARE), tolerance=1e-11)
    yield Found("diagonal", along_diagonals(framed_square))
    corners = {"fixed": "corners"}
    yield Found("diamonds at corners", along_diagonals(settled(framed(**corners), tolerance=1e-11)))
    hung = settled(framed(**SQUARE, **corners), tolerance=1e-11)
    rim = np.abs(middles(hung.net)).max(axis=1) > 0.9
    yield Found("squares at corners", hung.tension[-1][rim].max() / hung.tension[-1][~rim].max())


def along_diagonals(result):
    """Mean tension of the bars on the diagonals, or next to them, over that of the others."""
    at = np.abs(middles(result.net))
    off = np.abs(at[:, 0] - at[:, 1])
    on = off < off.min() + 1e-9
    return result.tension[-1][on].mean() / result.tension[-1][~on].mean()


def sinking(system, x):
    """Knots below the plane of the frame's middle line by weight, and none without weight."""
    free = ~system.net.fixed
    yield Found("down", 1e3 * (x - system.net.positions)[free, 2].mean())
    light = settled(framed(water=fyke.Water(gravity=0.0)), tolerance=1e-11)
    yield Found("level", 1e3 * np.abs((light.position[-1] - light.net.positions)[free, 2].mean()))


def coming_to_rest(rest):
    system = framed(damping_time=DAMPING)
    still = settled(system, tolerance=1e-11).position[-1]
    for name, stepper in (("implicit", fyke.Implicit()), ("verner", fyke.Verner(rtol=1e-4, atol=1e-7))):
        run = settling(system, stepper)
        yield Found("rest", np.abs(run.position[-1] - still).max(), case=name)
        yield Found("speed", np.abs(run.velocity[-1]).max(), case=name)
        yield Found("time", run.time[-1], case=name)
