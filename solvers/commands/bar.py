"""What long work writes on standard error: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, ClassVar, Self

from ..host.remarks import say, underway

_FIRST = 10.0  # s


class Bar:
    """A progress bar, updated by calling it with (done, total) and removed at the end of its context.

    The total may be None if it is unknown.

    Arguments:
        unit: name of the counted items, such as `collisions`.
    """

    latest: ClassVar[Bar | None] = None
    """The bar that counts at present."""

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.done = 0
        self.total: int | None = 0
        self.shown: Any = None

    def __call__(self, done: int, total: int | None) -> None:
        Bar.latest = self
        self.done, self.total = done, total
        try:
            if not sys.stderr.isatty():
                return
        except (ValueError, AttributeError):  # closed, or none
            return
        from tqdm import tqdm

        if self.shown is None:  # starts at the first count, because work of an earlier run would distort the speed
            size: dict[str, Any] = {"ncols": 80, "nrows": 24}  # where the terminal does not report its size
            with suppress(OSError, ValueError, AttributeError):
                if os.get_terminal_size(sys.stderr.fileno()).columns > 0:
                    size = {"dynamic_ncols": True}
            self.shown = tqdm(total=total, initial=done, unit=f" {self.unit}", disable=None, leave=False, **size)
        self.shown.total = total
        self.shown.update(done - self.shown.n)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        Bar.latest = None
        if self.shown is not None:
            self.shown.close()


class AtWork:
    """A context that writes a line after 10 s, 20 s, 40 s, ... of work, with its count; none where a bar is seen.

    Arguments:
        clock: seconds since any fixed time.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self._began, self._next = clock(), _FIRST
        self._ended = threading.Event()

    def look(self) -> float:
        """Write the line if it is due; returns the seconds until the next one is."""
        passed, bar = self.clock() - self._began, Bar.latest
        if passed >= self._next:
            what = underway[:1]
            if bar is not None and not what:
                what = [f"{bar.done} {'' if bar.total is None else f'of {bar.total} '}{bar.unit}"]
            if bar is None or bar.shown is None:
                say(": ".join([f"at work for {self._next:g} s", *what]))
            while self._next <= passed:
                self._next *= 2
        return self._next - passed

    def _watch(self) -> None:
        while not self._ended.wait(self.look()):
            pass

    def __enter__(self) -> Self:
        threading.Thread(target=self._watch, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
