"""Numbers and colour scale at the side of the live page, as HTML."""

from __future__ import annotations

import numpy as np

from ..report.quantities import BarQuantity
from ..report.style import TENSION_COLOURS
from .study import Numbers

_BOX = "padding: 0.2em 0.9em; font-size: 0.85em; font-variant-numeric: tabular-nums"


def numbers_table(numbers: Numbers) -> str:
    """Return the numbers of a shape as a table; every cell carries its exact value in data-value."""
    sag = f"{numbers.sag:.4f} m"
    rows = [
        ("drag", "Drag", numbers.drag, _force(numbers.drag)),
        ("lift", "Lift", numbers.lift, _force(numbers.lift)),
        ("max_tension", "Largest tension", numbers.largest_tension, _force(numbers.largest_tension)),
        ("slack_bars", "Slack bars", numbers.slack, f"{numbers.slack} of {numbers.bars}"),
        ("max_displacement", "Largest displacement", numbers.sag, sag),
    ]
    cells = "".join(
        f'<tr><td>{name}</td><td style="text-align:right" data-key="{key}" data-value="{value!r}">{text}</td></tr>'
        for key, name, value, text in rows
    )
    return f'<div style="{_BOX}"><table style="width:100%">{cells}</table></div>'


def _force(value: float | None) -> str:
    return "–" if value is None else f"{value:.4g} N"


def colour_scale(quantity: BarQuantity, top: float) -> str:
    """Return a bar of colours from 0 to the largest value, in the unit of the quantity."""
    stops = ", ".join(
        "rgb({:.0f} {:.0f} {:.0f})".format(*(255.0 * np.array(TENSION_COLOURS(x))[:3]))
        for x in np.linspace(0, 1, 9)
    )
    ends = f"<span>0</span><span>{quantity.name}</span><span>{top:.3g} {quantity.unit}</span>"
    return (
        f'<div style="{_BOX}">'
        f'<div style="height:0.7em;border-radius:0.2em;background:linear-gradient(to right, {stops})"></div>'
        f'<div style="display:flex;justify-content:space-between">{ends}</div>'
        '<div style="color:#8c8c8c">grey: slack</div></div>'
    )
