"""Linear waves: wavelength, and the amplitudes of speed and acceleration under the surface."""

from __future__ import annotations

import math

import numpy as np

from fyke.study import Found
from fyke.water.waves import airy, wavenumber

G = 9.81
# The phase at which the vertical speed is looked at: the surface is above z = 0 there.
SIXTH = math.sin(math.pi / 3.0)


def motion(sea, depth, time):
    """Velocity and acceleration (3,) at x = 0."""
    moved = sea.motion(np.array([[0.0, 0.0, depth]]), time)
    return moved.velocity[0], moved.acceleration[0]


def measure(tables):
    for row in tables["waves"]:
        sea = airy(row["H"], row["T"], depth=row["h"], stretching="none")
        case = f"{row['T']:g} s, {row['h']:g} m deep, z = {row['z'] + 0.0:g} m"
        yield Found(
            "length",
            2.0 * math.pi / wavenumber(2.0 * math.pi / row["T"], row["h"], G),
            row["wavelength"],
            case,
        )
        yield Found("along", motion(sea, row["z"], 0.0)[0][0], row["u_amp"], case)
        velocity, acceleration = motion(sea, row["z"], -row["T"] / 6.0)
        yield Found("up", velocity[2] / SIXTH, row["w_amp"], case)
        yield Found("acceleration", acceleration[0] / SIXTH, row["ax_amp"], case)
