"""A weighted line in a current: a chain of bars is a net too.

The top is held, a lead of 0.2 N hangs at the end; prints how far the end is carried off and the pull at the top.
"""

import numpy as np

import fyke

length, bars = 1.0, 50
twine = fyke.Twine("nylon", density=1140.0, diameter=3e-3, law=fyke.LinearLaw(2e9))
points = np.outer(np.linspace(0.0, length, bars + 1), [0.0, 0.0, -1.0])
load = np.zeros((bars + 1, 3))
load[-1, 2] = -0.2

line = fyke.line(twine, points, length / bars, fixed=(0,), load=load)
coefficients = fyke.Coefficients(bars=fyke.ConstantBar(1.2, 0.02))
for speed in (0.1, 0.3, 0.5, 1.0):
    system = fyke.make_system(line, current=(speed, 0.0, 0.0), coefficients=coefficients)
    result = fyke.solve_static(system)
    end = result.position[-1, -1]
    print(
        f"{speed:.1f} m/s: end at x = {end[0]:.4f} m, z = {end[2]:.4f} m, top tension {result.tension[-1, 0]:.4f} N"
    )
