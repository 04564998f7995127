"""Progress of work whose steps are counted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .arguments import check_function


@dataclass
class Counted:
    """Steps of work, each reported to a function as (done, total); steps beyond the total are not counted.

    Arguments:
        report: the function, or None.
        total: expected number of steps.
    """

    report: Callable[[int, int], None] | None
    total: int
    done: int = 0

    def __post_init__(self) -> None:
        """InputError if `report` is no function; it is called with 0 at once."""
        check_function(self.report, "progress")
        self._tell()

    def step(self) -> None:
        """Count one step more."""
        self.done = min(self.done + 1, self.total)
        self._tell()

    def _tell(self) -> None:
        if self.report is not None:
            self.report(self.done, self.total)
