"""What the user wrote: the case file, read, checked and put into SI units."""

from .errors import CaseError, Problem
from .load import load_case, load_cases_of, parse_case, recorded_case
from .load_case import folder_of
from .schema import Case, json_schema
from .template import template

__all__ = [
    "Case",
    "CaseError",
    "Problem",
    "folder_of",
    "json_schema",
    "load_case",
    "load_cases_of",
    "parse_case",
    "recorded_case",
    "template",
]
