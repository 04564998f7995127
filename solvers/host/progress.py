"""Counts of finished work for `progress` functions, and the forecast that is made from them."""

from collections.abc import Callable

Progress = Callable[[int, int], None]

_WORTH = 2.0  # seconds left from which a forecast is made
_SAMPLE = 0.5  # seconds of work that a forecast is made from


def forecast(
    done: int, total: int, seconds: float, unit: str, *, factor: float = 1.0, cheaper: str = "", before: int = 0,
    at_least: bool = False,
) -> str | None:  # fmt: skip
    """The sentence on how long the rest takes; None where the sample is too short or the rest takes less than 2 s.

    Arguments:
        done, total: counted items.
        seconds: in which the items after the first `before` were done.
        unit: name of the items.
        factor: by which the time may be larger or smaller, where `total` is an estimate.
        cheaper: the cheaper way, if there is one.
        at_least: other work follows, which is not counted.
    """
    if seconds < _SAMPLE or done <= before:
        return None
    rest = seconds * (total - done) / (done - before)
    if rest < _WORTH:
        return None
    bounds = f" ({duration(rest / factor)} to {duration(rest * factor)})" if factor > 1 else ""
    word, about = "at least" if at_least else "about", "about " if factor > 1 else ""
    sample = f"{done - before} of {about}{total - before} {unit} in {seconds:.1f} s"
    line = f"{word} {duration(rest)} more{bounds}: {sample}"
    return line + (f"; {cheaper}" if cheaper else "")


def duration(seconds: float) -> str:
    """Two digits of a duration, with its unit."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * size:
            return f"{float(f'{seconds / size:.2g}'):g} {unit}"
    return f"{float(f'{seconds:.2g}'):g} s"


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
