"""A real browser for tests of pages: the system's Chromium, without a window, driven by Playwright."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from importlib.util import find_spec

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# Pictures in space without a graphics card; no sandbox where tests run as root, as in containers.
ARGUMENTS = [
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--no-sandbox",
]


def executable() -> str | None:
    """Path of a browser, None where there is none or nothing to drive it."""
    if find_spec("playwright") is None:
        return None
    return next(filter(None, map(shutil.which, NAMES)), None)


def described() -> str:
    """One line for the end of a test run."""
    found = executable()
    return (
        f"browser tests: with {found}"
        if found
        else "browser tests: SKIPPED, no Chromium and Playwright found"
    )


@pytest.fixture(scope="module")
def browser() -> Iterator[object]:
    """Chromium, started once for a file of tests."""
    path = executable()
    if path is None:
        pytest.skip("no Chromium and Playwright found")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield started
        started.close()
