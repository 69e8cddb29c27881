"""The page of one browser: sliders and numbers at the side, the net in the middle, one worker that follows both."""

from __future__ import annotations

import io
import logging
import threading
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import viser

from ..case import CaseError
from ..report.figures import OPTIONS, equilibrium_shape
from ..report.style import styled
from .knobs import Knob
from .scene import Scene
from .side import colour_scale, numbers_table
from .study import RefusedError, Study

logger = logging.getLogger(__name__)

# Simulated time between two pictures of a moving net (s).
TICK = 1.0 / 30.0
# Wait (s) for something to happen before the worker looks whether its browser is still there.
PATIENCE = 0.5


class Page:
    """One browser with a study of its own.

    Callbacks of the browser only note what is wanted; one worker thread does it, always the newest wish of each kind,
    so that a slider that is drawn quickly never queues up.
    """

    def __init__(self, client: viser.ClientHandle, text: str, path: Path, cases: list[Path]) -> None:
        self.client, self.cases = client, cases
        self.updates = 0
        self._wishes: dict[str, Callable[[], None]] = {}
        self._turned: dict[str, float] = {}
        self._lock, self._wake = threading.Lock(), threading.Event()
        self._gone = False
        self._said: dict[str, Any] = {}
        self._playing = False
        self.open(text, path)
        self._worker = threading.Thread(target=self._work, name=f"fyke live {client.client_id}", daemon=True)
        self._worker.start()

    def open(self, text: str, path: Path | None) -> None:
        """Show a case from its beginning; CaseError and RefusedError leave the page as it was."""
        study = Study(text, path)
        self.study, self._playing = study, False
        self.client.gui.reset()
        self.client.scene.reset()
        self.client.gui.configure_theme(show_logo=False, show_share_button=False)
        self.scene = Scene(self.client, study)
        self.scene.on_pick(lambda knot: self._wish("pick", partial(self._pick, knot)))
        self.scene.on_drag(lambda knot, place: self._wish("drag", partial(self._drag, knot, place)))
        self._build()
        self.show()

    def close(self) -> None:
        """End the worker; the browser has gone."""
        self._gone = True
        self._wake.set()

    def _build(self) -> None:
        gui, study = self.client.gui, self.study
        gui.add_markdown(f"**{study.case.title or 'Netting'}**")
        self._numbers = gui.add_html("")
        self._colour = gui.add_dropdown("Colour by", self.scene.choices, initial_value=self.scene.choices[0])
        self._colour.on_update(lambda _: self._wish("colour", partial(self.scene.choose, self._colour.value)))
        self._scale = gui.add_html("")
        if study.waves_note:
            gui.add_markdown(study.waves_note)
        self._said = {"": gui.add_markdown("", visible=False)}
        groups: dict[str, list[Knob]] = {}
        for knob in study.knobs:
            groups.setdefault(knob.group, []).append(knob)
        for group, knobs in groups.items():
            with gui.add_folder(group):
                for knob in knobs:
                    self._add_slider(knob)
        self._add_motion()
        self._add_knot()
        self._add_files()

    def _add_slider(self, knob: Knob) -> None:
        label = f"{knob.label} ({knob.unit})" if knob.unit else knob.label
        slider = self.client.gui.add_slider(
            label, min=knob.low, max=knob.high, step=knob.step, initial_value=knob.value
        )
        self._said[knob.key] = self.client.gui.add_markdown("", visible=False)

        slider.on_update(lambda _: self.move(knob.key, float(slider.value)))

    def move(self, key: str, value: float) -> None:
        """Note that a knob is wanted at a value in its unit; the worker follows."""
        with self._lock:
            self._turned[key] = value
        self._wake.set()

    def _add_motion(self) -> None:
        gui = self.client.gui
        with gui.add_folder("Motion"):
            self._play = gui.add_button("Play", hint="Let the net move from its present shape")
            self._flat = gui.add_button("Start flat", hint="Lay the net out as it was built and let it go")
            self._pace = gui.add_markdown("At rest, in equilibrium.")
        self._play.on_click(lambda _: self._wish("play", self._toggle))
        self._flat.on_click(lambda _: self._wish("play", self._from_flat))

    def _add_knot(self) -> None:
        gui = self.client.gui
        with gui.add_folder("Knot"):
            self._chosen: Any = gui.add_text(
                "Knot", initial_value="", hint="Click a knot of the net, or write its label"
            )
            self._said["knot"] = gui.add_markdown("Click a knot, then drag its arrows.")
            pin, release = gui.add_button("Pin"), gui.add_button("Release")
        self._chosen.on_update(lambda _: self._wish("pick", partial(self._pick_label, self._chosen.value)))
        pin.on_click(lambda _: self._wish("pin", self._pin))
        release.on_click(lambda _: self._wish("pin", self._release))

    def _add_files(self) -> None:
        gui = self.client.gui
        with gui.add_folder("Files"):
            if len(self.cases) > 1:
                names = [path.name for path in self.cases]
                here = self.study.path.name if self.study.path and self.study.path.name in names else names[0]
                choose = gui.add_dropdown("Case", names, initial_value=here)
                choose.on_update(lambda _: self._wish("open", partial(self._open_named, choose.value)))
            upload = gui.add_upload_button("Open a case file", mime_type=".toml")
            upload.on_upload(lambda _: self._wish("open", partial(self._open_bytes, upload.value.content)))
            save, picture = gui.add_button("Save as case file"), gui.add_button("Save picture")
            self._said["files"] = gui.add_markdown("", visible=False)
        save.on_click(lambda _: self._wish("save", self._save_case))
        picture.on_click(lambda _: self._wish("picture", self._save_picture))

    def _wish(self, kind: str, what: Callable[[], None]) -> None:
        with self._lock:
            self._wishes[kind] = what
        self._wake.set()

    def _work(self) -> None:
        """Do the newest wishes, and move the net while it plays, until the browser goes."""
        while not self._gone:
            if not self._playing:
                self._wake.wait(PATIENCE)
            self._wake.clear()
            with self._lock:
                wishes, turned = self._wishes, self._turned
                self._wishes, self._turned = {}, {}
            if turned:
                self._do("turn", partial(self._turn, turned))
            for kind, what in wishes.items():
                self._do(kind, what)
            if self._playing:
                self._do("advance", self._advance)
            elif turned or wishes:
                self.show()

    def _do(self, kind: str, what: Callable[[], None]) -> None:
        place = {"drag": "knot", "pin": "knot", "pick": "knot", "open": "files", "save": "files"}.get(
            kind, ""
        )
        try:
            what()
        except RefusedError as refused:
            self._say(place, str(refused))
            if kind == "advance":
                self._pause()
        except CaseError as error:
            problems = (f"{p.where}: {p.found}; allowed: {p.allowed}; {p.cure}" for p in error.problems)
            self._say("files", " ".join(problems))
        except Exception as error:
            # The one thread of this page must live on; what went wrong is for whoever started the server.
            logger.exception("fault on the live page")
            self._say(place, f"⚠ A fault inside fyke, {type(error).__name__}: {error}")

    def _say(self, place: str, text: str) -> None:
        """Say something next to what it is about; "" takes it away."""
        note = self._said[place]
        note.content, note.visible = text, bool(text)

    def _turn(self, changes: dict[str, float]) -> None:
        """Turn knobs; what is refused is said under its slider."""
        for key in changes:
            self._say(key, "")
        try:
            self.study.turn(changes)
        except RefusedError as refused:
            for key in changes:
                self._say(key, f"⚠ {refused}. The net stays as it was.")
        self.scene.renew()

    def show(self) -> None:
        """Send the present shape and its numbers."""
        self.scene.draw()
        self._numbers.content = numbers_table(self.study.numbers)
        self._scale.content = colour_scale(self.scene.quantity, self.scene.top)
        self.updates += 1

    def _toggle(self) -> None:
        if self._playing:
            self._pause()
        else:
            self.study.play()
            self._start()

    def _from_flat(self) -> None:
        self.study.reset()
        self._start()

    def _start(self) -> None:
        self._playing, self._play.label = True, "Pause"
        self._begun = time.perf_counter()

    def _pause(self) -> None:
        self.study.pause()
        self._playing, self._play.label = False, "Play"
        self._pace.content = "Stopped; a slider brings it to its equilibrium."

    def _advance(self) -> None:
        """One picture of the moving net, no faster than real time."""
        self.study.advance(TICK)
        self.show()
        taken = time.perf_counter() - self._begun
        if taken < TICK:
            time.sleep(TICK - taken)
        now = time.perf_counter()
        pace, self._begun = TICK / (now - self._begun), now
        self._pace.content = f"t = {self.study.result.time[-1]:.2f} s, {pace:.2g} times real time"

    def _pick(self, knot: int | None) -> None:
        if knot is not None:
            self._choose(knot)

    def _pick_label(self, label: str) -> None:
        labels = self.study.result.net.labels
        if label.strip() in labels:
            self._choose(labels.index(label.strip()))
        elif label.strip():
            self._say("knot", f"⚠ there is no knot {label}; labels are such as {labels[0]} and {labels[-1]}")

    def _choose(self, knot: int) -> None:
        net = self.study.result.net
        self._chosen.value = net.labels[knot]
        held = net.fixed[knot] and knot not in self.study.pins
        self._say("knot", "The frame holds this knot." if held else "Drag its arrows; Release lets it go.")
        self.scene.grip(None if held else knot)

    def _drag(self, knot: int, place: np.ndarray) -> None:
        self.study.pin(knot, place)
        self._say("knot", f"Held at {place[0]:.3f}, {place[1]:.3f}, {place[2]:.3f} m.")

    def _pin(self) -> None:
        if self.scene.gripped is None:
            raise RefusedError("choose a free knot first")
        self.study.pin(self.scene.gripped)
        self._say("knot", "Held where it is.")

    def _release(self) -> None:
        for knot in [self.scene.gripped] if self.scene.gripped is not None else list(self.study.pins):
            self.study.release(knot)
        self.scene.grip(None)
        self._say("knot", "Let go.")

    def _open_named(self, name: str) -> None:
        path = next(path for path in self.cases if path.name == name)
        try:
            self.open(path.read_text(encoding="utf-8"), path)
        except (OSError, UnicodeDecodeError) as error:
            raise RefusedError(f"⚠ {name} cannot be read: {error}") from None

    def _open_bytes(self, content: bytes) -> None:
        try:
            self.open(content.decode("utf-8"), None)
        except UnicodeDecodeError:
            raise RefusedError("⚠ the file is no text in UTF-8, so no case file") from None

    def _save_case(self) -> None:
        self.client.send_file_download("net.toml", self.study.case_text().encode(), save_immediately=True)

    def _save_picture(self) -> None:
        self.client.send_file_download("net.png", picture(self.study), save_immediately=True)


@styled
def picture(study: Study) -> bytes:
    """Return the figure of the present shape as a PNG file."""
    buffer = io.BytesIO()
    equilibrium_shape(study.result).savefig(buffer, format="png", **OPTIONS["png"])
    return buffer.getvalue()
