"""Strains that no netting bears."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..forces.frame import Frame
from ..netting.net import Net

# The load-strain curves at hand for nylon twine end at 14 %, so twice that rests on extrapolation alone.
LARGEST_STRAIN = 0.30


def strain_warnings(net: Net, frames: Sequence[Frame]) -> tuple[str, ...]:
    """One sentence with number and bar when the strain of a bar passes LARGEST_STRAIN in any frame."""
    a, b = net.bars.T
    worst, bar, time = 0.0, 0, 0.0
    for frame in frames:
        strain = np.linalg.norm(frame.position[b] - frame.position[a], axis=1) / net.rest_length - 1.0
        if strain.size and strain.max() > worst:
            worst, bar, time = float(strain.max()), int(strain.argmax()), frame.time
    if worst <= LARGEST_STRAIN:
        return ()
    when = f" at {time:.4g} s" if len(frames) > 1 else ""
    return (
        f"the strain of bar {bar} (from {net.bar_label(bar)}) reaches {100 * worst:.0f} %{when}, above "
        f"{100 * LARGEST_STRAIN:.0f} %: no elastic law is measured there; check current, diameter and modulus",
    )
