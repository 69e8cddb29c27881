"""A result as an xarray.Dataset, with the names, units and meanings of a result file."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray

from ..solve.result import Result
from ..version import __version__
from .encoding import PARTS, case_hash, case_title, outcome_to_attributes, parts_to_text, twines_to_text
from .fields import AXES, FRAME_FIELDS, NET_FIELDS, SCHEMA, WEIGHT, Field

COORDINATES = ("time", "knot_label", "xyz")


def to_xarray(result: Result) -> xarray.Dataset:
    """Return a result as a data set; arrays are those of the result, not copies.

    Variables, dimensions and the attributes units and long_name are those of the register of fields; coordinates are
    time, xyz and the labels of the knots. Attributes tell case, twines, panels, outcome and version.
    """
    net = result.net
    told: list[tuple[Field, Any]] = [(AXES, np.array(["x", "y", "z"], dtype=object))]
    told += [(field, getattr(result, field.name)) for field in FRAME_FIELDS]
    for attribute, field in NET_FIELDS.items():
        value = getattr(net, attribute)
        told.append((field, np.array(value, dtype=object) if attribute == "labels" else value))
    told.append((WEIGHT, result.weight_in_water))
    variables = {
        field.name: (field.dimensions, value, {"units": field.unit, "long_name": field.long_name})
        for field, value in told
    }
    coordinates = {name: variables.pop(name) for name in COORDINATES}
    attributes = {
        "title": case_title(result.case_text),
        "source": f"fyke {__version__}",
        "fyke_result_schema": SCHEMA,
        "case": result.case_text,
        "case_sha256": case_hash(result.case_text),
        "twines": twines_to_text(net.twines),
        **{name: parts_to_text(getattr(net, name)) for name in PARTS},
        **outcome_to_attributes(result.outcome),
    }
    return xarray.Dataset(variables, coordinates, attributes)
