"""The live page in a real browser: sliders against runs, two visitors, refusals, a visitor who goes."""

from __future__ import annotations

import json
import time
import tomllib

import pytest
from typer.testing import CliRunner

from fyke.cli.app import app
from reference import panel_case

pytest.importorskip("viser", reason="the extra 'view' is not installed")
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from fyke.live import serve

CASE = panel_case(4, 0.15, title="A small panel")


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    folder = tmp_path_factory.mktemp("live")
    (folder / "net.toml").write_text(CASE)
    (folder / "other.toml").write_text(
        CASE.replace("A small panel", "Another one").replace("[4, 4]", "[5, 5]")
    )
    (folder / "broken.toml").write_text(CASE.replace("30 mm", "30 pounds"))
    live = serve(CASE, folder / "net.toml", port=18080)
    yield live
    live.stop()


@pytest.fixture
def visit(browser, live):
    """Open the page in a browser of its own, as often as called."""
    contexts = []

    def open_page():
        context = browser.new_context(viewport={"width": 1280, "height": 900})
        contexts.append(context)
        page = context.new_page()
        page.goto(live.url)
        page.locator("[data-key=drag]").wait_for()
        return page

    yield open_page
    for context in contexts:
        context.close()


def number(page, key: str) -> float:
    return float(page.locator(f"[data-key={key}]").get_attribute("data-value"))


def field(page, label: str):
    """Return the box to write into beside a label."""
    row = f"//label[normalize-space(.)='{label}']/ancestor::div[contains(@class,'Flex-root')][1]"
    return page.locator(f"xpath={row}//input[not(@type='hidden')]")


def slide(page, label: str, value: float) -> None:
    """Write a value into the box of a slider and wait for the net to answer."""
    before = page.locator("[data-key=drag]").get_attribute("data-value")
    box = field(page, label)
    box.fill(f"{value:g}")
    box.press("Enter")
    page.wait_for_function(
        "before => document.querySelector('[data-key=drag]').dataset.value !== before", arg=before
    )


def by_run(tmp_path, speed: float) -> dict[str, float]:
    case = tmp_path / "net.toml"
    case.write_text(CASE.replace("[0.5, 0.0, 0.0]", f"[{speed}, 0.0, 0.0]"))
    made = CliRunner().invoke(
        app, ["run", str(case), "-o", str(tmp_path / f"{speed}"), "--json", "--no-figures"]
    )
    assert made.exit_code == 0
    return json.loads((tmp_path / f"{speed}" / "summary.json").read_text())


def test_a_slider_gives_the_numbers_of_a_run(visit, tmp_path):
    page = visit()
    for speed in (0.31, 0.94, 2.2):
        slide(page, "Speed (m/s)", speed)
        run = by_run(tmp_path, speed)
        for key in ("drag", "max_displacement", "max_tension"):
            assert number(page, key) == pytest.approx(run[key], abs=1e-6), (speed, key)


def test_two_visitors_do_not_mix(visit):
    one, other = visit(), visit()
    before = number(other, "drag")
    slide(one, "Speed (m/s)", 1.7)
    time.sleep(0.5)
    assert number(other, "drag") == before
    assert number(one, "drag") > 5.0 * before


def test_a_visitor_who_goes_leaves_nothing(visit, live):
    page = visit()
    count = len(live.pages)
    assert count >= 1
    page.context.close()
    deadline = time.monotonic() + 10.0
    while len(live.pages) >= count and time.monotonic() < deadline:
        time.sleep(0.05)
    assert len(live.pages) == count - 1


def test_what_is_refused_is_said_at_its_slider(visit, live):
    page = visit()
    newest = live.pages[max(live.pages)]
    before = number(page, "drag")
    newest.move("netting.main.bar_length", -1.0)
    page.get_by_text("The net stays as it was").wait_for()
    assert number(page, "drag") == before
    slide(page, "Speed (m/s)", 0.6)
    assert number(page, "drag") > before


def test_play_moves_the_net_and_says_its_pace(visit):
    page = visit()
    rest = number(page, "max_displacement")
    page.get_by_role("button", name="Start flat").click()
    page.get_by_text("times real time").wait_for()
    page.get_by_role("button", name="Pause").click()
    page.get_by_text("Stopped").wait_for()
    assert number(page, "max_displacement") != rest


def test_a_knot_is_chosen_pinned_and_let_go(visit):
    page = visit()
    box = field(page, "Knot")
    box.fill("3-4")
    box.press("Enter")
    page.get_by_text("there is no knot 3-4").wait_for()
    box.fill("4-4")
    box.press("Enter")
    page.get_by_text("Drag its arrows").wait_for()
    page.get_by_role("button", name="Pin").click()
    page.get_by_text("Held where it is").wait_for()
    page.get_by_role("button", name="Release").click()
    page.get_by_text("Let go").wait_for()


def test_the_case_is_saved_as_it_stands(visit):
    page = visit()
    slide(page, "Speed (m/s)", 0.77)
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save as case file").click()
    text = open(saved.value.path(), encoding="utf-8").read()
    assert tomllib.loads(text)["current"]["velocity"] == pytest.approx([0.77, 0.0, 0.0])
    with page.expect_download() as picture:
        page.get_by_role("button", name="Save picture").click()
    with open(picture.value.path(), "rb") as file:
        assert file.read(8) == b"\x89PNG\r\n\x1a\n"


def test_the_next_case_of_the_folder_opens_and_a_broken_one_is_told(visit):
    page = visit()
    for name, shown in (("other.toml", "Another one"), ("broken.toml", "30 pounds")):
        field(page, "Case").click()
        page.get_by_role("option", name=name).click()
        page.get_by_text(shown).first.wait_for()
    assert page.get_by_text("Another one").is_visible()


@pytest.mark.parametrize("origin", ["http://elsewhere.example", "http://elsewhere.example:18080", "null"])
def test_pages_of_other_sites_are_not_let_in(live, origin):
    with pytest.raises(InvalidStatus) as refused:
        connect(live.url.replace("http", "ws"), origin=origin)
    assert refused.value.response.status_code == 403


def test_nobody_outside_is_let_in():
    made = CliRunner().invoke(app, ["live", "examples/panel.toml", "--host", "0.0.0.0"])
    assert made.exit_code == 2
    assert "--open-to-network" in made.output
