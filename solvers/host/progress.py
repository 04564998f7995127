"""Counts of finished work for `progress` functions."""

from collections.abc import Callable

Progress = Callable[[int, int], None]


class Estimated:
    """Reports work whose amount is an estimate: `done` never falls, and is `total` at the end.

    Arguments:
        progress: called with (done, total).
        total: units of work that are expected.
    """

    def __init__(self, progress: Progress | None, total: float) -> None:
        self._progress, self._total, self._done = progress, max(1, round(total)), 0.0

    def start(self, more: int = 0) -> None:
        """Report that work begins, and that this much more is to be done than was expected."""
        self._total += more
        self.add(0.0)

    def add(self, work: float) -> None:
        """Report more work; the total grows where the estimate was too small."""
        self._done += work
        self._total = max(self._total, round(self._done))
        if self._progress is not None:
            self._progress(int(self._done), self._total)

    def finish(self) -> None:
        if self._progress is not None:
            self._progress(self._total, self._total)
