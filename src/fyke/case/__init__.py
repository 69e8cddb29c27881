"""What the user wrote: the case file, read, checked and put into SI units."""

from .errors import CaseError, Problem
from .load import load_case, parse_case, recorded_case
from .schema import Case, json_schema
from .template import template

__all__ = [
    "Case",
    "CaseError",
    "Problem",
    "json_schema",
    "load_case",
    "parse_case",
    "recorded_case",
    "template",
]
