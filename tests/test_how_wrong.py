"""The page on how wrong it can be has its numbers from the report, and the report from the claims."""

from __future__ import annotations

import re

import pytest

from reference import VALIDATION

ROOT = VALIDATION.parent
PAGE = (ROOT / "docs" / "how-wrong.md").read_text(encoding="utf-8")
REPORT = (VALIDATION / "REPORT.md").read_text(encoding="utf-8")
SECTIONS = {title: text for title, text in re.findall(r"^### ([^\n]*)\n(.*?)(?=^##|\Z)", REPORT, re.M | re.S)}


def same(page: str, report: str) -> bool:
    """Whether a cell of the page is one of the report, rounded as on the page."""
    number, _, unit = page.partition(" ")
    other, _, others = report.partition(" ")
    digits = len(re.sub(r"e.*|[-+.]", "", number).lstrip("0")) or 1
    try:
        return unit == others and float(f"{float(other):.{digits}g}") == float(number)
    except ValueError:
        return False


def rows():
    """Rows of the page's tables: cells, and the claims named in the last one."""
    for table in re.findall(r"(?:^\|.*\n)+", PAGE, re.M):
        for line in table.splitlines()[2:]:
            *cells, claim = [cell.strip() for cell in line.strip("|").split("|")]
            yield cells, claim


@pytest.mark.parametrize(("cells", "claim"), list(rows()), ids=lambda value: str(value)[:40])
def test_every_number_of_the_page_is_in_the_report(cells, claim):
    told = [
        cell.strip() for line in SECTIONS[claim].splitlines() if line[:1] == "|" for cell in line.split("|")
    ]
    numbers = [cell for cell in cells[1:] if cell]
    assert numbers
    for number in numbers:
        assert any(same(number, one) for one in told), (number, claim)


def test_the_page_has_numbers_of_every_part_that_can_be_wrong():
    assert len(list(rows())) >= 15
    assert {"Sensitivity", "Experiments"} <= set(re.findall(r"^## (.*)$", REPORT, re.M))
