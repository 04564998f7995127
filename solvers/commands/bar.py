"""A progress bar on standard error, shown only on a terminal."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import Any


class Bar:
    """A progress bar, updated by calling it with (done, total) and removed at the end of its context.

    The total may be None if it is unknown.

    Arguments:
        unit: name of the counted items, such as `collisions`.
    """

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.total: int | None = 0
        self.steps = 0
        self._shown: Any = None

    def __call__(self, done: int, total: int | None) -> None:
        self.total = total
        try:
            if not sys.stderr.isatty():
                return
        except (ValueError, AttributeError):  # closed, or none
            return
        from tqdm import tqdm

        if self._shown is None:  # starts at the first count, because work of an earlier run would distort the speed
            size: dict[str, Any] = {"ncols": 80, "nrows": 24}  # where the terminal does not report its size
            with suppress(OSError, ValueError, AttributeError):
                if os.get_terminal_size(sys.stderr.fileno()).columns > 0:
                    size = {"dynamic_ncols": True}
            self._shown = tqdm(total=total, initial=done, unit=f" {self.unit}", disable=None, leave=False, **size)
        self._shown.update(done - self._shown.n)

    def step(self, text: str) -> None:
        """Count one more step and show its text behind the count."""
        self.steps += 1
        self(self.steps, None)
        self.note(text)

    def note(self, text: str) -> None:
        """Show a text behind the counts."""
        if self._shown is not None:
            self._shown.set_postfix_str(text)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown is not None:
            self._shown.close()
