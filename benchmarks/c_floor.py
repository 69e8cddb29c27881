"""A plain C loop of the same panel, to see how much room is left: scalar masses, linear bars, no damping.

It takes semi-implicit Euler steps, bars first and then knots, in arrays of single components that the compiler turns
into vector instructions: elastic bars taut only, drag of every bar along and across, drag and weight of every knot, two
square roots and a division a bar. Only for nets of equal bars. Held knots are swept with the free ones, at no inverse
mass: loads and stores of knots are then contiguous, a fifth faster than by a list of the free knots. Beyond this loop
leapfrog has turning masses (a symmetric 3 x 3 inverse for each knot), implicit drag and damped bars.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import fyke

SOURCE = """
#include <math.h>
#define END 4
void steps(long count, long n, long m, double h, double k, double rest, double cn, double ct, double flow,
           const int *a, const int *b, const int *end, const double *drag, const double *weight, const double *inverse,
           double *restrict x, double *restrict v, double *restrict f)
{
  double *x0 = x, *x1 = x + n, *x2 = x + 2*n, *v0 = v, *v1 = v + n, *v2 = v + 2*n;
  long all = 2*m + 1;
  double *f0 = f, *f1 = f + all, *f2 = f + 2*all;
  for (long s = 0; s < count; s++) {
#pragma GCC ivdep
    for (long e = 0; e < m; e++) {
      int p = a[e], q = b[e];
      double d0 = x0[q] - x0[p], d1 = x1[q] - x1[p], d2 = x2[q] - x2[p];
      double length = sqrt(d0*d0 + d1*d1 + d2*d2), over = 1.0/length;
      d0 *= over; d1 *= over; d2 *= over;
      double w0 = flow - 0.5*(v0[p] + v0[q]), w1 = -0.5*(v1[p] + v1[q]), w2 = -0.5*(v2[p] + v2[q]);
      double along = w0*d0 + w1*d1 + w2*d2;
      w0 -= along*d0; w1 -= along*d1; w2 -= along*d2;
      double across = cn*length*sqrt(w0*w0 + w1*w1 + w2*w2), drawn = ct*length*fabs(along)*along;
      double pull = length > rest ? k*(length - rest) : 0.0;
      w0 = across*w0 + drawn*d0; w1 = across*w1 + drawn*d1; w2 = across*w2 + drawn*d2;
      f0[e] = w0 + pull*d0; f1[e] = w1 + pull*d1; f2[e] = w2 + pull*d2;
      f0[m+e] = w0 - pull*d0; f1[m+e] = w1 - pull*d1; f2[m+e] = w2 - pull*d2;
    }
#pragma GCC ivdep
    for (long i = 0; i < n; i++) {
      double u0 = flow - v0[i], u1 = -v1[i], u2 = -v2[i], c = drag[i]*sqrt(u0*u0 + u1*u1 + u2*u2);
      double g0 = c*u0, g1 = c*u1, g2 = c*u2 + weight[i];
      for (int j = 0; j < END; j++) {
        int o = end[j*n + i];
        g0 += f0[o]; g1 += f1[o]; g2 += f2[o];
      }
      double t = h*inverse[i];
      v0[i] += t*g0; v1[i] += t*g1; v2[i] += t*g2;
      x0[i] += h*v0[i]; x1[i] += h*v1[i]; x2[i] += h*v2[i];
    }
  }
}
"""


def floor_seconds(system: fyke.System, start: fyke.State, h: float, count: int = 3000) -> float | None:
    """Seconds of one step, the best of nine; None where there is no C compiler."""
    compiler = shutil.which("gcc")
    if compiler is None:
        return None
    el, n, m = system.elements, system.net.knot_count, system.net.bar_count
    end = np.full((4, n), 2 * m, dtype=np.int32)
    used = np.zeros(n, dtype=int)
    for offset, knots in ((0, el.knot_a), (m, el.knot_b)):
        for e, i in enumerate(knots.tolist()):
            end[used[i], i] = offset + e
            used[i] += 1
    mass = el.knot_mass.copy()
    for knots in (el.knot_a, el.knot_b):
        np.add.at(mass, knots, el.bar_added_mass)
    arrays = [el.knot_a.astype(np.int32), el.knot_b.astype(np.int32), end, el.knot_drag]
    arrays += [el.weight[:, 2].copy(), el.free / mass]
    state = [start.position.T.copy(), start.velocity.T.copy(), np.zeros((3, 2 * m + 1))]
    scalars = (h, el.stiffness[0], el.rest_length[0], el.normal_drag[0], el.tangential_drag[0])
    flow = system.current.velocity(start.position, 0.0)[0, 0]
    with tempfile.TemporaryDirectory() as folder:
        source, library = Path(folder) / "floor.c", Path(folder) / "floor.so"
        source.write_text(SOURCE)
        options = ["-O3", "-march=native", "-ffast-math", "-mprefer-vector-width=512", "-shared", "-fPIC"]
        subprocess.run([compiler, *options, "-o", str(library), str(source), "-lm"], check=True)
        steps = ctypes.CDLL(str(library)).steps
    given = [ctypes.c_long(count), ctypes.c_long(n), ctypes.c_long(m)]
    given += [ctypes.c_double(float(value)) for value in (*scalars, flow)]
    given += [ctypes.c_void_p(array.ctypes.data) for array in (*arrays, *state)]
    times = []
    for _ in range(10):
        began = time.perf_counter()
        steps(*given)
        times.append(time.perf_counter() - began)
    assert np.isfinite(state[0]).all()
    return min(times[1:]) / count
