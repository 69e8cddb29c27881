"""The gallery: every figure function is in it, with a small picture, and the page is what its program makes."""

from __future__ import annotations

import inspect
import runpy
from pathlib import Path

from PIL import Image

from fyke.report import figures

DOCS = Path(__file__).parents[1] / "docs"
LARGEST = 150_000  # bytes of a picture


def test_every_figure_function_is_in_the_gallery():
    made = {
        name
        for name in figures.__all__
        if inspect.signature(getattr(figures, name)).return_annotation in ("Figure", "Figure | None")
    }
    told = runpy.run_path(str(DOCS / "gallery.py"))
    assert made == set(told["SHOWN"]) and len(made) >= 6
    assert told["page"]() == (DOCS / "gallery.md").read_text(encoding="utf-8"), "run: make gallery"
    for name in made:
        file = DOCS / "images" / "gallery" / f"{name}.png"
        assert file.stat().st_size < LARGEST, name
        with Image.open(file) as picture:
            assert picture.width > 500 and len(set(picture.convert("L").tobytes())) > 10, name
