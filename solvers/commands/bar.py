"""What long work writes on standard error: a bar and a forecast on a terminal, a line now and then elsewhere."""

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
_WORTH = 2.0  # s that are left, from which a forecast is made
_SAMPLE = 0.5  # s of work that a forecast is made from


class Bar:
    """A progress bar, updated by calling it with (done, total) and removed at the end of its context.

    The total may be None if it is unknown.

    Arguments:
        unit: name of the counted items, such as `collisions`.
        cheaper: what the forecast names as the cheaper way.
        factor: by which the forecast may be wrong, where the total is an estimate.
        at_least: other work follows, which is not counted.
        clock: seconds since any fixed time.
    """

    latest: ClassVar[Bar | None] = None
    """The bar that counts at present."""

    def __init__(
        self, unit: str, cheaper: str = "", *, factor: float = 1.0, at_least: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        self.unit, self.cheaper, self.factor, self.at_least, self.clock = unit, cheaper, factor, at_least, clock
        self._first: tuple[int, float] | None = None
        self._forecast_written = False
        self.done = 0
        self.total: int | None = 0
        self.shown: Any = None

    def __call__(self, done: int, total: int | None) -> None:
        Bar.latest = self
        self.done, self.total = done, total
        if self._first is None or done <= self._first[0]:
            self._first = done, self.clock()
        try:
            if not sys.stderr.isatty():
                return
        except (ValueError, AttributeError):  # closed, or none
            return
        line = None if self._forecast_written else self.forecast()
        if line is not None:  # once, as soon as a sample of the work allows one
            self._forecast_written = True
            if self.shown is not None:
                self.shown.clear()
            say(line)
        from tqdm import tqdm

        if self.shown is None:  # starts at the first count, because work of an earlier run would distort the speed
            size: dict[str, Any] = {"ncols": 80, "nrows": 24}  # where the terminal does not report its size
            with suppress(OSError, ValueError, AttributeError):
                if os.get_terminal_size(sys.stderr.fileno()).columns > 0:
                    size = {"dynamic_ncols": True}
            self.shown = tqdm(total=total, initial=done, unit=f" {self.unit}", disable=None, leave=False, **size)
        self.shown.total = total
        self.shown.update(done - self.shown.n)

    def forecast(self) -> str | None:
        """How long the rest takes; None where that cannot be told yet, or where it is less than 2 s."""
        if self._first is None or self.total is None:
            return None
        before, began = self._first
        counted, seconds = self.done - before, self.clock() - began
        if seconds < _SAMPLE or counted <= 0:
            return None
        rest = seconds * (self.total - self.done) / counted
        if rest < _WORTH:
            return None
        word, about, bounds = "at least" if self.at_least else "about", "", ""
        if self.factor > 1:
            about, bounds = "about ", f" ({duration(rest / self.factor)} to {duration(rest * self.factor)})"
        sample = f"{counted} of {about}{self.total - before} {self.unit} in {seconds:.1f} s"
        line = f"{word} {duration(rest)} more{bounds}: {sample}"
        return line + (f"; {self.cheaper}" if self.cheaper else "")

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        Bar.latest = None
        if self.shown is not None:
            self.shown.close()


def duration(seconds: float) -> str:
    """Two digits of a duration, with its unit."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * size:
            return f"{float(f'{seconds / size:.2g}'):g} {unit}"
    return f"{float(f'{seconds:.2g}'):g} s"


class AtWork:
    """A context that writes a line after 10 s, 20 s, 40 s, ... of work, with the forecast; none where a bar is seen.

    Arguments:
        clock: seconds since any fixed time.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self._began, self._next = clock(), _FIRST
        self._ended = threading.Event()

    def look(self) -> float:
        """Write the line if it is due; returns the seconds until the next one is."""
        passed = self.clock() - self._began
        if passed >= self._next:
            bar = Bar.latest
            slow = "".join(f": {line}" for line in underway[:1])
            if bar is None:
                say(f"at work for {duration(passed)}{slow}")
            elif bar.shown is None:
                count = f"{bar.done} {'' if bar.total is None else f'of {bar.total} '}{bar.unit}"
                say(f"at work for {duration(passed)}{slow or f': {bar.forecast() or count}'}")
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
