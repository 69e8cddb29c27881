"""Tubes as beams: bars that push and bend, against exact solutions of the elastic rod."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.special import ellipe, ellipk

import fyke
from fyke.netting.rigging import with_rope
from fyke.netting.together import together
from fyke.netting.tubes import ring
from fyke.study import Found
from lines import NO_FORCES, NO_WATER, orders

STIFFNESS, LENGTH, MASS = 3.0, 2.0, 0.7  # N m2, m, kg/m of all beams here
DIAMETER = 0.02
# Tip of a beam under a dead load P, P L^2 / EI: down and inwards over L, as tables of elliptic integrals have it.
LARGE = {1.0: (0.30172, 0.05643), 2.0: (0.49346, 0.16064), 10.0: (0.81061, 0.55500)}
# Roots of 1 + cos cosh, and the load at which a strut that is clamped below buckles (N).
ROOTS = np.array([1.8751041, 4.6940911])
CRITICAL = np.pi**2 * STIFFNESS / (4.0 * LENGTH**2)


def tube(axial=1e7, mass=MASS):
    """A tube of bending stiffness STIFFNESS and axial stiffness (N)."""
    area = np.pi / 4.0 * DIAMETER**2
    return fyke.Twine(
        "tube",
        mass / area,
        DIAMETER,
        fyke.LinearLaw(axial / area),
        compression=True,
        bending_stiffness=STIFFNESS,
    )


def in_vacuum(net):
    return fyke.make_system(net, water=NO_WATER, coefficients=NO_FORCES)


def without_bars(net):
    return replace(net, bars=net.bars[:0], rest_length=net.rest_length[:0], twine_of_bar=net.twine_of_bar[:0])


def cantilever(n, direction=(1.0, 0.0, 0.0), load=(0.0, 0.0, 0.0), kind=None):
    """A beam of n bars whose clamped end is one bar more, between two held knots."""
    h = LENGTH / n
    points = np.arange(-1, n + 1)[:, None] * h * np.array(direction)
    loads = np.zeros((n + 2, 3))
    loads[-1] = load
    bare = without_bars(fyke.line(kind or tube(), points, h, fixed=(0, 1), load=loads))
    return in_vacuum(with_rope(bare, np.arange(n + 2), kind or tube(), name="beam"))


def shape(system, tolerance=1e-8, **options):
    result = fyke.solve_static(system, tolerance=tolerance, **options)
    if not result.outcome.ok:
        raise RuntimeError(result.outcome.message)
    return result.position[-1]


def small():
    """Errors of the way of the tip under a small load, over P L^3 / (3 EI)."""
    exact = 1e-3 * LENGTH**3 / (3.0 * STIFFNESS)
    return [abs(-shape(cantilever(n, load=(0.0, 0.0, -1e-3)))[-1, 2] / exact - 1.0) for n in (10, 20, 40)]


def extrapolated(coarse, fine):
    """Limit of what errs with the square of the bar length, from bars and from bars half as long."""
    return fine + (fine - coarse) / 3.0


def large(load):
    """Way of the tip down and inwards over the length."""
    force = load * STIFFNESS / LENGTH**2
    end = extrapolated(*(shape(cantilever(n, load=(0.0, 0.0, -force)))[-1] / LENGTH for n in (30, 60)))
    return -end[2], 1.0 - end[0]


def elastica(degrees):
    """Place of the tip of a strut that leans by an angle there, over the length, and the exact one.

    With k = sin(alpha / 2): L sqrt(P / EI) = K(k), height 2 E / K - 1, way 2 k / K.
    """
    k = np.sin(np.radians(degrees) / 2.0)
    whole, second = ellipk(k * k), ellipe(k * k)
    ends = []
    for n in (40, 80):
        system = cantilever(n, (0.0, 0.0, 1.0), (0.0, 0.0, -STIFFNESS * (whole / LENGTH) ** 2))
        start = system.at_rest()
        # An arc of the same length that turns by alpha.
        turn = np.radians(degrees) * np.maximum(start.position[:, 2], 0.0) / LENGTH
        start.position[:, 0] = LENGTH / np.radians(degrees) * (1.0 - np.cos(turn))
        start.position[2:, 2] = LENGTH / np.radians(degrees) * np.sin(turn[2:])
        ends.append(np.abs(shape(system, start=start)[-1]) / LENGTH)
    return extrapolated(*ends)[[0, 2]], (2.0 * k / whole, 2.0 * second / whole - 1.0)


def hoop(n, radius, pull, stretch):
    """A ring in the plane x-z, held in its lowest knot, pulled up by a force and sideways apart by another (N)."""
    net = ring(tube(axial=1e7), diameter=2.0 * radius, knots=n)
    x = net.positions
    x = np.column_stack([x[:, 0], np.zeros(n), x[:, 1]])
    load, fixed = np.zeros((n, 3)), np.zeros(n, dtype=bool)
    load[n // 4, 2], load[0, 0], load[n // 2, 0] = pull, stretch, -stretch
    fixed[3 * n // 4] = True
    return in_vacuum(replace(net, positions=x, load=load, fixed=fixed))


def pulled(n, radius=1.5):
    """Errors of both diameters of a ring, changed by (pi/4 - 2/pi) and -(2/pi - 1/2) times P R^3 / EI."""
    along, across = np.pi / 4.0 - 2.0 / np.pi, 2.0 / np.pi - 0.5
    unit = 1e-4 * STIFFNESS / radius**2
    system = hoop(n, radius, 2.0 * unit, unit)
    change = shape(system, tolerance=1e-9) - system.net.positions
    high, wide = change[n // 4, 2] - change[3 * n // 4, 2], change[0, 0] - change[n // 2, 0]
    exact = 1e-4 * radius * np.array([2.0 * along - across, along - 2.0 * across])
    return np.abs(np.array([high, wide]) / exact - 1.0)


def frequencies(n):
    """Errors of the first two frequencies of a cantilever, (1.875, 4.694)^2 / L^2 sqrt(EI / m)."""
    system = cantilever(n)
    found = fyke.modes(system, system.net.positions, count=4).frequency[::2]
    return np.abs(found / (ROOTS**2 * np.sqrt(STIFFNESS / MASS) / LENGTH**2) - 1.0)


def buckling(n):
    """Error of the load at which the square of the lowest frequency of a strut vanishes."""
    squares = []
    for part in (0.98, 0.99):
        system = cantilever(n, (0.0, 0.0, 1.0), (0.0, 0.0, -part * CRITICAL))
        squares.append(fyke.modes(system, shape(system, tolerance=1e-9), count=1).frequency[0] ** 2)
    return abs(0.99 + 0.01 * squares[1] / (squares[0] - squares[1]) - 1.0)


def swinging(n, radius=0.8):
    """Error of a ring's slowest modes in its plane, omega^2 = 36/5 EI / (m R^4), held by four soft threads."""
    net = ring(tube(), diameter=2.0 * radius, knots=n)
    soft = fyke.Twine("soft", 1e-3, 1e-3, fyke.LinearLaw(1e-5 / (np.pi / 4.0 * 1e-6)))
    quarters = np.pi / 2.0 * np.arange(4)
    places = 2.0 * radius * np.column_stack([np.cos(quarters), np.sin(quarters), np.zeros(4)])
    held = together([net, without_bars(fyke.line(soft, places, 1.0, fixed=(0, 1, 2, 3)))])
    for k in range(4):
        held = with_rope(held, [k * n // 4, n + k], soft, length=0.5 * radius, name=f"t{k}")
    modes = fyke.modes(in_vacuum(held), held.positions, count=14)
    level = np.einsum("kiq,kiq->k", modes.shape[:, :, :2], modes.shape[:, :, :2])
    flat = level > 0.99 * np.einsum("kiq,kiq->k", modes.shape, modes.shape)
    unit = np.sqrt(STIFFNESS / MASS) / radius**2
    found = modes.frequency[flat & (modes.frequency > 0.5 * unit)][:2] / unit
    return np.abs(found / np.sqrt(36.0 / 5.0) - 1.0).max()


def measure(tables):
    errors = small()
    yield Found("tip", errors[-1])
    yield Found("order", orders(errors)[-1], case="tip of a cantilever")
    for load, exact in LARGE.items():
        for name, found, true in zip(("down", "inwards"), large(load), exact, strict=True):
            yield Found("large", found, true, f"P L^2 / EI = {load:g}, {name}")
    for degrees in (60.0, 90.0):
        for name, found, true in zip(("aside", "height"), *elastica(degrees), strict=True):
            yield Found("elastica", found, true, f"leaning by {degrees:g} deg at its tip, {name}")
    for key, error, bars in (("ring", pulled, (24, 48, 96)), ("frequency", frequencies, (8, 16, 32))):
        found = np.array([error(n) for n in bars])
        for which, slope in enumerate(orders(found)[-1], 1):
            name = {"ring": "diameter of a pulled ring", "frequency": "frequency of a cantilever"}[key]
            yield Found(key, found[-1, which - 1], case=f"{which}")
            yield Found("order", slope, case=f"{name}, {which}")
    for key, error, bars in (("buckling", buckling, (8, 16, 32)), ("swing", swinging, (16, 32))):
        found = [error(n) for n in bars]
        yield Found(key, found[-1])
        name = {"buckling": "buckling load", "swing": "a ring's modes in its plane"}[key]
        yield Found("order", orders(found)[-1], case=name)
