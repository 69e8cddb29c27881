"""The report as a person sees it: opened in a real browser, its numbers against summary.json."""

from __future__ import annotations

import json

import pytest

from fyke.cli.app import app
from reference import panel_case

typer_testing = pytest.importorskip("typer.testing")

CASE = panel_case(
    3,
    0.11,
    title="A small panel let go <in a current>",
    more="[solve]\nkind = 'dynamic'\nduration = 0.4\n[output]\nevery = 0.02",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    (folder / "net.toml").write_text(CASE)
    runner = typer_testing.CliRunner()
    made = runner.invoke(
        app, ["run", str(folder / "net.toml"), "-o", str(folder / "net"), "--quiet", "--no-figures"]
    )
    assert made.exit_code == 0, made.output
    made = runner.invoke(app, ["report", str(folder / "net")])
    assert made.exit_code == 0, made.output
    return folder / "net"


@pytest.fixture(scope="module")
def page(browser, folder):
    context = browser.new_context(viewport={"width": 1280, "height": 800}, offline=True)
    page = context.new_page()
    page.faults = []
    page.on("pageerror", lambda error: page.faults.append(str(error)))
    page.on(
        "request", lambda request: page.faults.append(request.url) if request.url.startswith("http") else None
    )
    page.goto((folder / "report.html").as_uri())
    page.wait_for_function("window.fyke !== undefined && document.querySelector('#space canvas') !== null")
    return page


def test_the_numbers_are_those_of_the_summary(page, folder):
    summary = json.loads((folder / "summary.json").read_text())
    shown = {
        row.locator("dt").inner_text(): row.locator("dd").get_attribute("data-value")
        for row in page.locator("#numbers dl > div").all()
    }
    assert float(shown["Drag, along the flow"]) == summary["drag"]
    assert float(shown["Lift, across it"]) == summary["lift"]
    bar = summary["max_tension_bar_label"]
    assert float(shown[f"Largest tension, bar {bar}"]) == summary["max_tension"]
    assert float(shown["Largest displacement"]) == summary["max_displacement"]
    assert int(shown["Slack bars"]) == summary["slack_bars"]
    assert page.locator("[data-key=outcome]").get_attribute("data-value") == summary["outcome"]
    assert page.locator("#case pre").inner_text().strip() == CASE.strip()
    assert page.title().startswith("A small panel let go <in a current>")


def test_the_slider_moves_the_net_through_time(page, folder):
    import fyke

    result = fyke.load(folder / "result.nc")
    knot = int(abs(result.position[-1] - result.position[0]).max(axis=1).argmax())
    span = result.position.max() - result.position.min()
    slider = page.locator("#time")
    for frame in (0, 7, 20):
        slider.fill(str(frame))
        page.wait_for_function(
            f"document.querySelector('#time-text').textContent === '{result.time[frame]:.3f} s'"
        )
        seen = page.evaluate(
            f"[0, 1, 2].map((axis) => document.querySelector('#space').data.at(-1)['xyz'[axis]][{knot}])"
        )
        assert seen == pytest.approx(result.position[frame][knot].tolist(), abs=span / 65535.0)


def test_colours_can_be_those_of_another_quantity(page):
    names = page.locator("#quantity option").all_inner_texts()
    assert names == [
        "Bar tension (N)",
        "Bar strain (%)",
        "Local water velocity (m/s)",
        "Angle of bar to flow (deg)",
    ]
    for index, name in enumerate(names):
        page.locator("#quantity").select_option(str(index))
        title = "document.querySelector('#space').data.find((t) => t.line && t.line.showscale).line.colorbar.title.text"
        page.wait_for_function(f"{title} === {json.dumps(name)}")


def test_a_bar_tells_its_name_and_tension(page, folder):
    import fyke

    name = fyke.load(folder / "result.nc").net.bar_label(0)
    text = page.evaluate("document.querySelector('#space').data.find((t) => t.name === 'bars').hovertext[0]")
    assert text.startswith(f"bar {name}<br>"), text
    assert "Bar tension" in text and " N" in text


def test_nothing_is_fetched_and_nothing_fails(page):
    assert page.faults == []


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_runs_out_of_the_page(browser, folder, width, height, scheme):
    page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
    page.goto((folder / "report.html").as_uri())
    page.wait_for_function("window.fyke !== undefined")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    ink, paper = page.evaluate(
        "[getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]"
    )
    lightness = [sum(map(int, c[4:-1].split(","))) for c in (ink, paper)]
    assert (lightness[0] < lightness[1]) == (scheme == "light")
    page.close()


def test_printed_it_has_its_figures_and_no_buttons(page):
    page.emulate_media(media="print")
    assert not page.locator("#theme").is_visible()
    assert not page.locator("#space").is_visible()
    assert page.locator("#figure-equilibrium_shape img").is_visible()
    assert page.pdf(format="A4").startswith(b"%PDF")
    page.emulate_media(media="screen")
