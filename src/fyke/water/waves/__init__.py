"""Waves: velocity, acceleration and surface elevation of the water at points and times.

Regular waves after Airy and Stokes, and irregular seas of many components; all are sums of harmonics that one kernel
adds up.
"""

from .dispersion import wavenumber
from .irregular import Spreading, irregular
from .limits import breaking_height, keulegan_carpenter, ursell_number
from .regular import airy, stokes2
from .sea import Motion, Stretching, Waves
from .spectra import default_gamma, jonswap, pierson_moskowitz

__all__ = [
    "Motion",
    "Spreading",
    "Stretching",
    "Waves",
    "airy",
    "breaking_height",
    "default_gamma",
    "irregular",
    "jonswap",
    "keulegan_carpenter",
    "pierson_moskowitz",
    "stokes2",
    "ursell_number",
    "wavenumber",
]
