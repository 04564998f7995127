"""A progress bar on standard error and a forecast of long work, on a terminal only."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from ..host.progress import forecast
from ..host.remarks import say


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

    def __init__(
        self, unit: str, cheaper: str = "", *, factor: float = 1.0, at_least: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        self.unit, self.clock = unit, clock
        self._options: dict[str, Any] = {"cheaper": cheaper, "factor": factor, "at_least": at_least}
        self._first: tuple[int, float] | None = None
        self._forecast: str | None = None
        self.total: int | None = 0
        self._shown: Any = None

    def __call__(self, done: int, total: int | None) -> None:
        self.total = total
        try:
            if not sys.stderr.isatty():
                return
        except (ValueError, AttributeError):  # closed, or none
            return
        self._tell_forecast(done, total)
        from tqdm import tqdm

        if self._shown is None:  # starts at the first count, because work of an earlier run would distort the speed
            size: dict[str, Any] = {"ncols": 80, "nrows": 24}  # where the terminal does not report its size
            with suppress(OSError, ValueError, AttributeError):
                if os.get_terminal_size(sys.stderr.fileno()).columns > 0:
                    size = {"dynamic_ncols": True}
            self._shown = tqdm(total=total, initial=done, unit=f" {self.unit}", disable=None, leave=False, **size)
        self._shown.total = total
        self._shown.update(done - self._shown.n)

    def _tell_forecast(self, done: int, total: int | None) -> None:
        """Write the forecast, once, as soon as a sample of the work allows one."""
        now = self.clock()
        if self._first is None or done <= self._first[0]:
            self._first = done, now
        first, began = self._first
        if total is not None and self._forecast is None:
            self._forecast = forecast(done, total, now - began, self.unit, before=first, **self._options)
            if self._forecast is not None:
                if self._shown is not None:
                    self._shown.clear()
                say(self._forecast)

    def note(self, text: str) -> None:
        if self._shown is not None:
            self._shown.set_postfix_str(text)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown is not None:
            self._shown.close()
