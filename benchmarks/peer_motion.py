"""Motion of the panel in each tool: a function sets it up and hands back the work to be timed."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
from peer_panel import (
    AREA,
    BAR,
    C_KNOT,
    C_MASS,
    C_NORMAL,
    C_TANGENTIAL,
    CURRENT,
    GRAVITY,
    KNOT,
    KNOT_VOLUME,
    MODULUS,
    NORMAL,
    NYLON,
    SPHERE,
    STIFFNESS,
    TANGENTIAL,
    TWINE,
    WATER,
    Answer,
    Array,
    Panel,
    Work,
    compiled_rate,
    fyke_system,
    tangents,
)

import fyke

# Seconds from rest.
DURATION = 2.0


def solve_ivp(panel: Panel, method: str, rtol: float, atol: float) -> Work:
    from scipy.integrate import solve_ivp

    rate = compiled_rate(panel)
    inverse = sp.diags(np.repeat(1.0 / panel.mass[: panel.free], 3))

    def rhs(t: float, y: Array) -> Array:
        dy = np.empty_like(y)
        rate(y, dy)
        return dy

    def jacobian(t: float, y: Array) -> sp.csc_matrix:
        by_x, by_v = tangents(panel, *panel.state(y))
        return sp.bmat([[None, sp.identity(3 * panel.free)], [inverse @ by_x, inverse @ by_v]], format="csc")

    more: dict[str, Any] = {"jac": jacobian} if method in ("BDF", "Radau") else {}

    def work() -> Answer:
        end = solve_ivp(rhs, (0.0, DURATION), panel.first, method, [DURATION], rtol=rtol, atol=atol, **more)
        return panel.state(end.y[:, -1])

    return work


def cvode(panel: Panel, rtol: float, atol: float) -> Work:
    from sksundae.cvode import CVODE

    rate = compiled_rate(panel)
    solver = CVODE(
        lambda t, y, dy: rate(y, dy),
        method="BDF",
        linsolver="gmres",
        rtol=rtol,
        atol=atol,
        max_num_steps=10**8,
    )
    return lambda: panel.state(solver.solve(np.array([0.0, DURATION / 2, DURATION]), panel.first).y[-1])


def mujoco(panel: Panel, step: float) -> Work:
    """Knots as bodies on three slides, bars as tendons that only pull, drag and weight computed outside."""
    import mujoco

    def text(values: Array) -> str:
        return " ".join(repr(float(q)) for q in values)

    slides = "".join(f'<joint type="slide" axis="{text(axis)}"/>' for axis in np.eye(3))
    bodies = "".join(
        f'<body pos="{text(panel.start[i])}"><inertial pos="0 0 0" mass="{text(panel.mass[i : i + 1])}" '
        f'diaginertia="1e-9 1e-9 1e-9"/>{slides}<site name="s{i}"/></body>'
        if i < panel.free
        else f'<site name="s{i}" pos="{text(panel.start[i])}"/>'
        for i in range(len(panel.start))
    )
    tendons = "".join(
        f'<spatial stiffness="{float(STIFFNESS)!r}" springlength="0 {BAR}">'
        f'<site site="s{a}"/><site site="s{b}"/></spatial>'
        for a, b in panel.bars
    )
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler boundmass="0" boundinertia="0"/>'
        f'<option timestep="{step!r}" integrator="Euler" gravity="0 0 0" jacobian="sparse">'
        '<flag contact="disable" constraint="disable"/></option><size memory="1G"/>'
        f"<worldbody>{bodies}</worldbody><tendon>{tendons}</tendon></mujoco>"
    )
    data = mujoco.MjData(model)
    rate = compiled_rate(panel, stiffness=0.0)
    half = 3 * panel.free
    y, dy = np.empty(2 * half), np.empty(2 * half)
    start, mass = panel.first[:half], np.repeat(panel.mass[: panel.free], 3)

    def work() -> Answer:
        for _ in range(round(DURATION / step)):
            y[:half], y[half:] = data.qpos + start, data.qvel
            rate(y, dy)
            data.qfrc_applied[:] = dy[half:] * mass
            mujoco.mj_step(model, data)
        return panel.state(np.r_[data.qpos + start, data.qvel])

    return work


def moordyn(panel: Panel, step: float) -> Work:
    """Knots as points, bars as lines of one segment, the current as a wave that stands still."""
    import moordyn

    lines = [
        "MoorDyn",
        "---- LINE TYPES ----",
        "Name Diam Mass EA BA EI Cd Ca CdAx CaAx",
        "(-) (m) (kg/m) (N) (N-s) (Nm2) (-) (-) (-) (-)",
        # Its axial drag is on the wetted surface, pi d l.
        f"bar {TWINE} {NYLON * AREA!r} {MODULUS * AREA!r} 0 0 {C_NORMAL} {C_MASS} {C_TANGENTIAL / np.pi!r} {C_MASS}",
        "---- POINTS ----",
        "ID Type X Y Z Mass Volume CdA Ca",
        "(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)",
    ]
    ball = f"{NYLON * KNOT_VOLUME!r} {KNOT_VOLUME!r} {C_KNOT * np.pi / 4 * KNOT**2!r} {C_MASS}"
    for i, (x, y, z) in enumerate(panel.start.tolist()):
        # Ten metres down, where no surface is near.
        lines.append(f"{i + 1} {'Free' if i < panel.free else 'Fixed'} {x!r} {y!r} {z - 10.0!r} {ball}")
    lines += ["---- LINES ----", "ID Type A B Length Segments Outputs", "(#) (-) (#) (#) (m) (-) (-)"]
    lines += [f"{e + 1} bar {a + 1} {b + 1} {BAR} 1 -" for e, (a, b) in enumerate(panel.bars)]
    lines += [
        "---- OPTIONS ----",
        "0 writeLog",
        f"{step!r} dtM",
        "rk4 tScheme",
        f"{GRAVITY} g",
        f"{WATER} rho",
    ]
    lines += [
        "100 WtrDpth",
        "1 WaveKin",
        "0 Currents",
        "1 disableOutput",
        "1 disableOutTime",
        "---- END ----",
    ]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "panel.txt"
        path.write_text("\n".join(lines) + "\n")
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        moordyn.Init_NoIC(system, [], [])
    moordyn.ExternalWaveKinInit(system)
    places = len(moordyn.ExternalWaveKinGetCoordinates(system))
    moordyn.ExternalWaveKinSet(system, [CURRENT.tolist()] * places, [[0.0] * 3] * places, 0.0)

    def work() -> Answer:
        for call in range(20):
            moordyn.Step(system, [], [], call * DURATION / 20, DURATION / 20)
        points = [moordyn.GetPoint(system, i + 1) for i in range(len(panel.start))]
        x = np.array([moordyn.GetPointPos(p) for p in points])
        x[:, 2] += 10.0
        return x, np.array([moordyn.GetPointVel(p) for p in points])

    return work


def diffrax(panel: Panel, rtol: float, atol: float) -> Work:
    import diffrax as dfx
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    n, free = len(panel.start), panel.free
    a, b = jnp.asarray(panel.bars.T)
    # Every free knot has four bars: gathering them is much faster here than scattering.
    ends = np.concatenate([panel.bars[:, 0], panel.bars[:, 1]])
    mine = np.argsort(ends, kind="stable")[: 4 * free].reshape(free, 4)
    rest, mass = jnp.asarray(panel.start[free:]), jnp.asarray(panel.mass[:free, None])
    weight = jnp.asarray(np.outer(panel.weight[:free], [0.0, 0.0, 1.0]))
    current = jnp.asarray(CURRENT)

    def size(q: Any) -> Any:
        return jnp.sqrt((q * q).sum(axis=1, keepdims=True))

    def rhs(t: Any, y: Any, _: Any) -> Any:
        x, v = jnp.concatenate([y[0], rest]), jnp.concatenate([y[1], jnp.zeros((n - free, 3))])
        d, w = x[b] - x[a], current - 0.5 * (v[a] + v[b])
        length = size(d)
        d = d / length
        s = (w * d).sum(axis=1, keepdims=True)
        across = w - s * d
        drag = 0.5 * length * (NORMAL * size(across) * across + TANGENTIAL * jnp.abs(s) * s * d)
        pull = jnp.maximum(0.0, STIFFNESS * (length - BAR)) * d
        u = current - y[1]
        force = jnp.concatenate([drag + pull, drag - pull])[mine].sum(axis=1) + SPHERE * size(u) * u - weight
        return y[1], force / mass

    @jax.jit
    def run(x: Any, v: Any) -> Any:
        control = dfx.PIDController(rtol=rtol, atol=atol)
        end = dfx.diffeqsolve(
            dfx.ODETerm(rhs),
            dfx.Tsit5(),
            0.0,
            DURATION,
            1e-5,
            (x, v),
            saveat=dfx.SaveAt(t1=True),
            stepsize_controller=control,
            max_steps=None,
        )
        return end.ys[0][0], end.ys[1][0]

    x, v = (jnp.asarray(q[:free]) for q in panel.state(panel.first))
    compiled = run.lower(x, v).compile()

    def work() -> Answer:
        x_end, v_end = (np.asarray(q) for q in compiled(x, v))
        return panel.state(np.r_[x_end.ravel(), v_end.ravel()])

    return work


def fyke_motion(panel: Panel, name: str, step: float | None = None) -> Work:
    system = fyke_system(panel)
    stepper = getattr(fyke, name)(max_step=step)
    fyke.simulate(system, duration=1e-3, stepper=stepper)

    def work() -> Answer:
        frame = fyke.simulate(system, duration=DURATION, stepper=stepper, every=DURATION).frame()
        return frame.position, frame.velocity

    return work
