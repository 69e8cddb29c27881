"""A current out of a netCDF file: variables time, depth, u, v and w with their units."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .current_file import ALLOWED, refuse, too_deep, unreadable
from .errors import CaseError, Problem
from .written import written

if TYPE_CHECKING:
    from xarray import DataArray, Dataset

Array = NDArray[np.float64]

# Ways of writing the units, as the CF conventions and UDUNITS have them, and their size in SI.
TIME = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), 1.0),
    **dict.fromkeys(("min", "mins", "minute", "minutes"), 60.0),
    **dict.fromkeys(("h", "hr", "hrs", "hour", "hours"), 3600.0),
    **dict.fromkeys(("d", "day", "days"), 86400.0),
}
LENGTH = dict.fromkeys(("m", "meter", "meters", "metre", "metres"), 1.0)
SPEED = {
    **dict.fromkeys(("m s-1", "m/s", "m s^-1", "m s**-1", "m.s-1", "meter second-1", "meters/second"), 1.0),
    **dict.fromkeys(("cm s-1", "cm/s"), 0.01),
}
UNITS = {"time": TIME, "depth": LENGTH, "u": SPEED, "v": SPEED, "w": SPEED}
SHOWN = {
    "time": '"s", or "seconds since" a date; also minutes, hours, days',
    "depth": '"m"',
    **dict.fromkeys("uvw", '"m s-1", "m/s", "cm s-1" or "cm/s"'),
}
NEEDED = ("time", "u", "v")
HDF5 = b"\x89HDF"  # how such a file begins; older netCDF files begin with CDF


def read_netcdf(file: Path, bed: float | None) -> tuple[Array, Array, Array]:
    """Return times (t,) s, depths (k,) m and velocities (t, k, 3) m/s; CaseError with every fault of the file.

    Times "since" a date count from the first one, others are as in the file. bed: depth of the sea bed (m).
    """
    try:
        arrays = _arrays(file)
    except CaseError:
        raise
    except Exception as error:  # a damaged file makes the readers fail in any way
        raise CaseError([unreadable(file, error, "a netCDF file")]) from None
    levels = _levels(arrays)
    shape = tuple(arrays[name].size if name in arrays else 1 for name in ("time", "depth"))
    times = _si(arrays["time"], "time").ravel()
    depths = _si(arrays["depth"], "depth").ravel() if "depth" in arrays else np.zeros(1)
    velocities = np.zeros((*shape, 3))
    for axis, name in enumerate("uvw"):
        if name in arrays:
            velocities[..., axis] = _laid(_si(arrays[name], name), arrays[name].dims, levels, shape)
    refuse(file, _numbers(file, times, depths, velocities, bed))
    return times, depths, velocities


def _arrays(file: Path) -> dict[str, DataArray]:
    """Return the variables by name, in memory; what has the wrong form is refused before it is loaded."""
    import xarray

    with file.open("rb") as beginning:
        engine = "h5netcdf" if beginning.read(len(HDF5)) == HDF5 else "scipy"
    with xarray.open_dataset(file, engine=engine, decode_times=False) as data:
        refuse(file, _lacking(file, data))
        arrays = {name: data[name] for name in UNITS if name in data.variables}
        refuse(file, (fault for name in arrays for fault in _form(file, name, arrays)))
        return {name: array.load() for name, array in arrays.items()}


def _lacking(file: Path, data: Dataset) -> Iterator[Problem]:
    """Yield a problem for every variable that must be there and is not."""
    for name in NEEDED:
        if name not in data.variables:
            there = ", ".join(str(one) for one in list(data.variables)[:9]) or "none"
            cure = f"rename the variable that holds it to {name}"
            yield Problem(str(file), f"no variable {name}; there are: {there}", "time, u, v; depth, w", cure)


def _form(file: Path, name: str, arrays: dict[str, DataArray]) -> Iterator[Problem]:
    """Yield what is wrong with the type, units and dimensions of a variable."""
    array, where = arrays[name], f"{file}, variable {name}"
    if array.dtype.kind not in "fiu" or not array.size:
        found = f"{array.size} values of type {array.dtype}"
        yield Problem(where, found, "numbers", "write them as numbers")
    units = array.attrs.get("units")
    if _factor(name, units) is None:
        found = "no attribute units" if units is None else f"units {written(units)}"
        yield Problem(where, found, f"units {SHOWN[name]}", f"give the variable {name} its attribute units")
    if name == "depth" and array.attrs.get("positive", "down") != "down":
        found = f"positive = {written(array.attrs['positive'])}"
        cure = 'give depths that count downwards, with positive = "down"'
        yield Problem(where, found, "depths below still water, from 0 downwards", cure)
    yield from _dimensions(where, name, arrays)


def _dimensions(where: str, name: str, arrays: dict[str, DataArray]) -> Iterator[Problem]:
    array, levels = arrays[name], _levels(arrays)
    sizes = {str(dim): size for dim, size in array.sizes.items()}
    found = "on " + (", ".join(f"{dim} ({size})" for dim, size in sizes.items()) or "no dimension")
    if name in ("time", "depth"):
        if array.ndim > 1 or (name == "depth" and array.size > 1 and levels[0] == levels[1]):
            cure = "give one set of times and one of depths, each on a dimension of its own"
            yield Problem(where, found, "one dimension of its own", cure)
        return
    more = [dim for dim, size in sizes.items() if dim not in levels and size > 1]
    less = [dim for dim in levels if dim and dim not in sizes and _length(dim, arrays) > 1]
    if more or less:
        cure = (
            f"choose one value of {', '.join(more)}" if more else f"give {name} along {', '.join(less)} too"
        )
        yield Problem(where, found, f"on {', '.join(filter(None, levels)) or 'no dimension'}", cure)


def _levels(arrays: dict[str, DataArray]) -> list[str]:
    """Return the names of the dimensions of time and depth, "" where there is none."""
    return [
        str(arrays[name].dims[0]) if name in arrays and arrays[name].ndim else ""
        for name in ("time", "depth")
    ]


def _length(dim: str, arrays: dict[str, DataArray]) -> int:
    return max(array.sizes.get(dim, 1) for array in arrays.values())


def _factor(name: str, units: Any) -> float | None:
    """Return the size of units in SI, None where they are not of this kind."""
    if not isinstance(units, str):
        return None
    words = " ".join(units.split())
    return UNITS[name].get(words.partition(" since ")[0].lower() if name == "time" else words)


def _si(array: DataArray, name: str) -> Array:
    units = array.attrs["units"]
    values = np.asarray(array.values, dtype=float) * (_factor(name, units) or 1.0)
    return values - values.ravel()[0] if name == "time" and " since " in units else values


def _laid(values: Array, dims: tuple[Any, ...], levels: list[str], shape: tuple[int, ...]) -> Array:
    """Lay values along time and depth, (t, k); dimensions of length 1 may be missing or more than these."""
    kept = [axis for axis, dim in enumerate(dims) if str(dim) in levels]
    alone = [axis for axis in range(len(dims)) if axis not in kept]
    order = sorted(kept, key=lambda axis: levels.index(str(dims[axis])))
    return np.transpose(values, order + alone).reshape(shape)


def _numbers(
    file: Path, times: Array, depths: Array, velocities: Array, bed: float | None
) -> Iterator[Problem]:
    """Yield a problem for every number that is missing, out of order or out of all proportion."""
    for name, values in (("time", times), ("depth", depths)):
        words, low, high = ALLOWED[name]
        for i, value in enumerate(values):
            where = f"{file}, variable {name}, value {i + 1}"
            if not low <= value <= high:  # also true of a value that is not a number
                cure = "depths count downwards" if value < 0.0 else "correct the number"
                yield Problem(where, f"{value:.10g}", words, cure)
            elif i and value <= values[i - 1]:
                found = f"{value:.10g} after {values[i - 1]:.10g}"
                yield Problem(where, found, "values that rise from each to the next", "sort them, each once")
            elif name == "depth" and bed is not None and value > bed:
                yield too_deep(where, float(value), bed)
    words, low, high = ALLOWED["u"]
    for i, k, axis in np.argwhere(~((velocities >= low) & (velocities <= high))):
        value = velocities[i, k, axis]
        where = f"{file}, variable {'uvw'[axis]}, time {times[i]:.10g} s, depth {depths[k]:.10g} m"
        found = "no value" if np.isnan(value) else f"{value:.10g}"
        yield Problem(where, found, words, "fill the gap, or correct the number")
