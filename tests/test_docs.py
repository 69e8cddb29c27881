"""The pages say what is so: their Python runs, their cases load, their links and commands lead somewhere."""

import os
import re
import runpy
import shlex
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

import fyke
from fyke.netting.twine import MATERIALS
from fyke.solve.outcome import OutcomeName

ROOT = Path(__file__).parents[1]
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(?:\]\(|src=\")([^)\s\"]+)[)\"]")
OPTION = re.compile(r"(?<![\w-])--?[a-z][a-z-]*")
BEHIND_A_COMMAND = {"|", ">", ">>", "&&", "||", ";", "2>"}


def blocks(page: Path, language: str) -> list[str]:
    return [text for kind, text in BLOCK.findall(page.read_text(encoding="utf-8")) if kind == language]


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


def anchors(page: Path) -> set[str]:
    """What GitHub makes of the headings of a page."""
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", [p for p in PAGES if blocks(p, "python")], ids=name)
def test_python_blocks_run_in_their_order(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    script = tmp_path / f"{page.stem}.py"
    script.write_text("\n\n".join(blocks(page, "python")), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    runpy.run_path(str(script), run_name="__main__")


def whole_cases() -> list[tuple[str, str]]:
    return [(name(p), text) for p in PAGES for text in blocks(p, "toml") if text.startswith("schema = 1")]


def test_whole_cases_load_without_a_warning() -> None:
    cases = whole_cases()
    assert cases
    for where, text in cases:
        assert fyke.parse_case(text, where).warnings == ()


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_to_files_and_headings(page: Path) -> None:
    for link in LINK.findall(BLOCK.sub("", page.read_text(encoding="utf-8"))):
        if re.match(r"[a-z]+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = (page.parent / file).resolve() if file else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@cache
def options_of(command: str) -> set[str]:
    """The options that the command line's own help names; "" for fyke itself."""
    asked = [sys.executable, "-c", "from fyke.cli import main; main()", *filter(None, [command]), "--help"]
    wide = os.environ | {"COLUMNS": "200", "NO_COLOR": "1", "TERM": "dumb"}
    told = subprocess.run(asked, capture_output=True, text=True, env=wide, check=False, timeout=60)
    assert told.returncode == 0, f"fyke {command} --help: {told.stderr}"
    return set(OPTION.findall(told.stdout))


def commands(page: Path) -> list[list[str]]:
    """Every fyke command of the page's sh blocks, in words, without what the shell does behind it."""
    found = []
    for line in "".join(blocks(page, "sh")).splitlines():
        words = shlex.split(line, comments=True)
        if words and Path(words[0]).name == "fyke":
            end = next((i for i, word in enumerate(words) if word in BEHIND_A_COMMAND), len(words))
            found.append(words[1:end])
    return found


@pytest.mark.parametrize("page", [p for p in PAGES if commands(p)], ids=name)
def test_commands_and_options_exist(page: Path) -> None:
    for words in commands(page):
        command = next((word for word in words if not word.startswith("-")), "")
        asked = {word.partition("=")[0] for word in words if word.startswith("-")}
        assert asked <= options_of(command), " ".join(words)


def test_make_targets_exist() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z]+):", makefile, re.MULTILINE))
    shown = {target for p in PAGES for target in re.findall(r"\bmake ([a-z]+)`", p.read_text("utf-8"))}
    assert {"demo", "test"} <= shown <= targets


def test_api_page_tells_every_public_name() -> None:
    told = set(re.findall(r"^\| `(\w+)", (ROOT / "docs/api.md").read_text(encoding="utf-8"), re.MULTILINE))
    assert told == set(fyke.__all__)


def test_conventions_tell_every_outcome() -> None:
    page = (ROOT / "docs/conventions.md").read_text(encoding="utf-8")
    table = page[page.index("## Outcomes") :]
    assert set(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == set(get_args(OutcomeName))


def test_materials_are_told_as_they_are() -> None:
    page = (ROOT / "docs/choose.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\w+) \| (\d+) \| ([\d.]+|none) \|", page, re.MULTILINE)
    told = {material: (float(density), modulus) for material, density, modulus in rows}
    known = {
        m.name: (m.density, f"{m.youngs_modulus / 1e9:.2f}" if m.youngs_modulus else "none")
        for m in MATERIALS.values()
    }
    assert told == known


def test_every_page_is_reached_from_the_index() -> None:
    index = (ROOT / "docs/README.md").read_text(encoding="utf-8")
    linked = {link.partition("#")[0] for link in LINK.findall(index)}
    assert {p.name for p in (ROOT / "docs").glob("*.md")} - {"README.md"} <= linked
