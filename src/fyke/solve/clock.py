"""Where the wall time of a run goes, by parts that exclude one another.

A clock that is going charges all time to the innermost part entered; where none is going `timed` does nothing. It is
for the accounts at the end of a run: nothing is ever decided by it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextvars import ContextVar, Token
from functools import wraps
from types import TracebackType
from typing import Any, Literal, ParamSpec, Self, TypeVar

from numba.core import event

P = ParamSpec("P")
R = TypeVar("R")
Part = Literal[
    "starting", "building", "compiling", "forces", "factorizing", "solving", "accounts", "writing", "figures"
]


class Clock:
    """Adds up the time of every part; goes within a `with` block, from `since` (time.perf_counter) on.

    "compiling" is making machine code or fetching it from disk, "forces" all of a solve that is no other part.
    """

    def __init__(self, first: Part, since: float | None = None) -> None:
        self._seconds: dict[Part, float] = {}
        self._parts: list[Part] = [first]
        self._since = time.perf_counter() if since is None else since
        self._token: Token[Clock | None] | None = None
        self._compiler = _Compiler()

    def __enter__(self) -> Self:
        self._token = _GOING.set(self)
        event.register(_COMPILER, self._compiler)  # type: ignore[no-untyped-call] # numba has no types
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        event.unregister(_COMPILER, self._compiler)  # type: ignore[no-untyped-call] # numba has no types
        if self._token is not None:
            _GOING.reset(self._token)

    @property
    def seconds(self) -> dict[Part, float]:
        """Seconds of every part so far."""
        self._charge()
        return dict(self._seconds)

    def enter(self, part: Part) -> None:
        """Charge what comes to a part."""
        self._charge()
        self._parts.append(part)

    def leave(self) -> None:
        """Go back to the part before."""
        self._charge()
        self._parts.pop()

    def _charge(self) -> None:
        now, part = time.perf_counter(), self._parts[-1]
        self._seconds[part] = self._seconds.get(part, 0.0) + now - self._since
        self._since = now


_GOING: ContextVar[Clock | None] = ContextVar("clock", default=None)
# Numba holds its lock while it compiles and while it fetches what it compiled before.
_COMPILER = "numba:compiler_lock"


class timed:  # noqa: N801 reads as a verb: with timed("solving")
    """Charge a `with` block to a part of the clock that is going in this thread, if any."""

    __slots__ = ("_clock", "_part")

    def __init__(self, part: Part) -> None:
        self._part, self._clock = part, _GOING.get()

    def __enter__(self) -> None:
        if self._clock is not None:
            self._clock.enter(self._part)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._clock is not None:
            self._clock.leave()


def charged(part: Part) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Charge all calls of a function to a part."""

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            with timed(part):
                return function(*args, **kwargs)

        return call

    return decorate


class _Compiler(event.Listener):
    """Charges the time in which Numba compiles."""

    def on_start(self, event: Any) -> None:
        clock = _GOING.get()
        if clock is not None:
            clock.enter("compiling")

    def on_end(self, event: Any) -> None:
        clock = _GOING.get()
        if clock is not None:
            clock.leave()
