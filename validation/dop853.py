"""A soft panel let go in a current: SciPy's DOP853 on the equations written in numpy, and fyke's steppers."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

import fyke
from fyke.study import Found
from panels import framed

# Soft enough that SciPy's steps are not those of a stiff net; twine loses some of its swing.
TWINE = fyke.Twine("soft", 1140.0, 1.5e-3, fyke.LinearLaw(2e6))
DAMPING, DURATION, EVERY = 2e-3, 0.2, 0.1
WATER, GRAVITY, NORMAL, ALONG, BALL = 1000.0, 9.81, 1.2, 0.1, 1.0
MESHES, SIDE = (3, 3), 0.12
STEPPERS = {
    "verner": fyke.Verner(rtol=1e-9, atol=1e-12),
    "leapfrog": fyke.Symplectic(max_step=5e-5),
    "implicit": fyke.Implicit(max_step=2.5e-4, fixed=True, rtol=1e-9, atol=1e-12),
    "newmark": fyke.Newmark(max_step=2.5e-4, fixed=True, rtol=1e-9, atol=1e-12),
}


def made():
    return framed(meshes=MESHES, size=(SIDE, SIDE), twine=TWINE, damping_time=DAMPING)


class Equations:
    """Accelerations of the knots of a net, from the formulas of the documentation and nothing else of fyke."""

    def __init__(self, net):
        self.a, self.b = net.bars.T
        self.rest, self.free = net.rest_length, ~net.fixed
        self.first = net.positions
        self.d, self.ball = net.bar_diameter, net.knot_diameter
        self.stiffness = 2e6 * np.pi / 4.0 * self.d**2 / self.rest
        bar, sphere = np.pi / 4.0 * self.d**2 * self.rest, np.pi / 6.0 * self.ball**3
        volume = sphere.copy()
        np.add.at(volume, net.bars.ravel(), np.repeat(0.5 * bar, 2))
        self.mass = 1140.0 * volume + 0.5 * WATER * sphere
        self.weight = (1140.0 - WATER) * GRAVITY * volume
        self.across = 0.5 * WATER * bar

    def force(self, x, v):
        """Force on every knot (n, 3) and the directions of the bars (m, 3)."""
        d = x[self.b] - x[self.a]
        length = np.linalg.norm(d, axis=1)
        t = d / length[:, None]
        rate = ((v[self.b] - v[self.a]) * t).sum(axis=1)
        stretch = length - self.rest
        pull = np.where(stretch > 0.0, np.maximum(self.stiffness * (stretch + DAMPING * rate), 0.0), 0.0)
        past = np.array([0.5, 0.0, 0.0]) - v
        w = 0.5 * (past[self.a] + past[self.b])
        s = (w * t).sum(axis=1)
        n = w - s[:, None] * t
        drag = NORMAL * np.linalg.norm(n, axis=1)[:, None] * n + ALONG * (np.abs(s) * s)[:, None] * t
        drag *= 0.25 * WATER * (self.d * length)[:, None]
        out = 0.5 * WATER * BALL * np.pi / 4.0 * (self.ball**2 * np.linalg.norm(past, axis=1))[:, None] * past
        out[:, 2] -= self.weight
        np.add.at(out, self.a, pull[:, None] * t + drag)
        np.add.at(out, self.b, drag - pull[:, None] * t)
        return out, t

    def rate(self, _, y):
        """Velocities and accelerations of the free knots."""
        x, v = self.first.copy(), np.zeros_like(self.first)
        x[self.free], v[self.free] = y.reshape(2, -1, 3)
        force, t = self.force(x, v)
        # Water moves along with a bar across itself only.
        added = self.across[:, None, None] * (np.eye(3) - t[:, :, None] * t[:, None, :])
        mass = self.mass[:, None, None] * np.eye(3)
        np.add.at(mass, self.a, added)
        np.add.at(mass, self.b, added)
        acceleration = np.linalg.solve(mass[self.free], force[self.free][:, :, None])[:, :, 0]
        return np.concatenate([v[self.free].ravel(), acceleration.ravel()])


def by_scipy(net):
    """Places of the free knots (times, k, 3)."""
    equations = Equations(net)
    start = np.concatenate([net.positions[equations.free].ravel(), np.zeros(3 * equations.free.sum())])
    times = np.arange(0.0, DURATION + 0.5 * EVERY, EVERY)
    run = solve_ivp(
        equations.rate, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-12
    )
    if not run.success:
        raise RuntimeError(run.message)
    return run.y.T[:, : run.y.shape[0] // 2].reshape(len(times), -1, 3)


def measure(tables):
    system = made()
    exact = by_scipy(system.net)
    yield Found("way", np.abs(exact[-1] - exact[0]).max())
    for name, stepper in STEPPERS.items():
        run = fyke.simulate(system, duration=DURATION, every=EVERY, stepper=stepper)
        if not run.outcome.ok:
            raise RuntimeError(f"{name}: {run.outcome.message}")
        yield Found(name, np.abs(run.position[:, ~system.net.fixed] - exact).max())
