"""A progress bar on standard error: on a terminal only."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_SIZE = {"ncols": 80, "nrows": 24}  # of a terminal that does not say


@contextmanager
def bar(unit: str) -> Iterator[Callable[[int, int | None], None]]:
    """Yield what is to be told of (done, total), None where the total is not known; nothing is shown in a pipe.

    Arguments:
        unit: what is counted, as `collisions`.
    """
    from tqdm import tqdm

    shown: Any = None

    def tell(done: int, total: int | None) -> None:
        nonlocal shown
        if shown is None:  # what an earlier run has done says nothing of the speed of this one
            size = {"dynamic_ncols": True} if _size_is_known() else _SIZE
            shown = tqdm(total=total, initial=done, unit=f" {unit}", disable=None, leave=False, **size)
        shown.update(done - shown.n)

    try:
        yield tell
    finally:
        if shown is not None:
            shown.close()


def _size_is_known() -> bool:
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns > 0
    except (OSError, ValueError, AttributeError):
        return False
