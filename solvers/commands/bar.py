"""A progress bar on standard error, shown only on a terminal."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_SIZE = {"ncols": 80, "nrows": 24}  # assumed where the terminal does not report its size


class Bar:
    """A progress bar, updated by calling it with (done, total); the total may be None if unknown.

    Arguments:
        unit: name of the counted items, such as `collisions`.
    """

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self._shown: Any = None

    def __call__(self, done: int, total: int | None) -> None:
        if not _on_terminal():
            return
        from tqdm import tqdm

        if self._shown is None:  # starts at the first count, because work of an earlier run would distort the speed
            size = {"dynamic_ncols": True} if _size_is_known() else _SIZE
            self._shown = tqdm(total=total, initial=done, unit=f" {self.unit}", disable=None, leave=False, **size)
        self._shown.update(done - self._shown.n)

    def note(self, text: str) -> None:
        """Show a text behind the counts."""
        if self._shown is not None:
            self._shown.set_postfix_str(text)

    def close(self) -> None:
        """Remove the bar."""
        if self._shown is not None:
            self._shown.close()


@contextmanager
def bar(unit: str) -> Iterator[Bar]:
    """Yield a bar, which is removed at the end; nothing is shown if standard error is no terminal."""
    shown = Bar(unit)
    try:
        yield shown
    finally:
        shown.close()


def _on_terminal() -> bool:
    try:
        return sys.stderr.isatty()
    except (ValueError, AttributeError):  # closed, or none
        return False


def _size_is_known() -> bool:
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns > 0
    except (OSError, ValueError, AttributeError):
        return False
