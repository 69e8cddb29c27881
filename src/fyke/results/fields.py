"""The register of a result file: every variable with its dimensions, unit and meaning.

Dimensions: time (outputs), knot, bar, xyz (the three axes) and end (the two ends of a bar). A variable of a
moment has the time axis in front; the others describe the net and do not change.
"""

from __future__ import annotations

from dataclasses import dataclass

# Raised when a file of the new kind cannot be read by the old reader.
SCHEMA = 2


@dataclass(frozen=True)
class Field:
    """One variable: its name in the file, dimensions, unit ("1" when it has none) and meaning."""

    name: str
    dimensions: tuple[str, ...]
    unit: str
    long_name: str


# What changes with time: the names are those of Frame and Result.
FRAME_FIELDS: tuple[Field, ...] = (
    Field("time", ("time",), "s", "simulated time"),
    Field("position", ("time", "knot", "xyz"), "m", "position of every knot"),
    Field("velocity", ("time", "knot", "xyz"), "m s-1", "velocity of every knot"),
    Field(
        "tension",
        ("time", "bar"),
        "N",
        "tension of every bar, of one real bar where it stands for several, 0 where slack; axial force of tubes, "
        "below 0 where they push",
    ),
    Field(
        "bar_drag",
        ("time", "bar"),
        "N",
        "force of the water on a bar, all that it stands for, along the flow at it",
    ),
    Field(
        "bar_lift",
        ("time", "bar"),
        "N",
        "size of the force of the water on a bar, all that it stands for, across the flow",
    ),
    Field(
        "water_velocity",
        ("time", "bar", "xyz"),
        "m s-1",
        "velocity of the water at the middle of every bar, waves and shelter included",
    ),
    Field(
        "water_force",
        ("time", "knot", "xyz"),
        "N",
        "drag and lift gathered at the knots: half of every bar and all of a knot's own",
    ),
    Field("hydrodynamic_force", ("time", "xyz"), "N", "drag and lift of the whole net"),
    Field("support_reaction", ("time", "xyz"), "N", "force of the net on its supports"),
    Field("kinetic_energy", ("time",), "J", "kinetic energy, added mass included"),
    Field("unbalanced_force", ("time",), "N", "largest unbalanced force on a free knot"),
)

# What describes the net, under the attribute of Net that it is read from.
NET_FIELDS: dict[str, Field] = {
    "labels": Field("knot_label", ("knot",), "1", 'label of every knot, row and column "i-j" on a panel'),
    "positions": Field(
        "initial_position", ("knot", "xyz"), "m", "position of every knot before anything acts"
    ),
    "fixed": Field("fixed", ("knot",), "1", "whether a knot is held in place: 0 free, 1 fixed"),
    "knot_diameter": Field("knot_diameter", ("knot",), "m", "diameter of every knot, 0 for none"),
    "knot_multiple": Field("knot_multiple", ("knot",), "1", "how many real knots a knot stands for"),
    "knot_density": Field("knot_density", ("knot",), "kg m-3", "density of every knot"),
    "load": Field("load", ("knot", "xyz"), "N", "dead load on top of weight, buoyancy and water"),
    "bars": Field("bar_knots", ("bar", "end"), "1", "the two knots that a bar joins, counted from 0"),
    "rest_length": Field(
        "rest_length", ("bar",), "m", "unloaded length of every bar, of grouped netting as many real ones"
    ),
    "twine_of_bar": Field(
        "twine_of_bar", ("bar",), "1", "place of a bar's twine in the attribute 'twines', counted from 0"
    ),
    "bar_multiple": Field("bar_multiple", ("bar",), "1", "how many real bars side by side a bar stands for"),
    "bar_diameter": Field("bar_diameter", ("bar",), "m", "twine diameter of every bar"),
}

AXES = Field("xyz", ("xyz",), "1", "axis: x downstream by habit, z up, z = 0 at the still water")
WEIGHT = Field("weight_in_water", (), "N", "weight less buoyancy of the whole net, positive when it sinks")
