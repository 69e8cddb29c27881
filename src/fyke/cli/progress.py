"""A progress bar with the time left, on a terminal only."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn


@contextmanager
def progress_bar(
    console: Console, *, shown: bool, doing: str = "solving"
) -> Iterator[Callable[[float, str], None]]:
    """Hand out a function of the fraction done (0 to 1) and a text; nothing is drawn where no one looks."""
    bar = Progress(
        TextColumn(doing),
        BarColumn(bar_width=24),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[text]}", style="dim"),
        console=console,
        transient=True,
        disable=not (shown and console.is_terminal),
    )
    with bar:
        task = bar.add_task("", total=1.0, text="")

        def report(fraction: float, text: str) -> None:
            bar.update(task, completed=fraction, text=text)

        yield report
