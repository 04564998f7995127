"""What is timed: a function that computes one collision, or a call for many."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..answers import Answer

Collide = Callable[[int], Answer]


@dataclass(frozen=True)
class Partly:
    """A call of which a part does not count.

    Arguments:
        left_out: seconds of the last call that do not.
    """

    run: Callable[[], Any]
    left_out: Callable[[], float]

    def __call__(self) -> Any:
        return self.run()


def left_out(run: Callable[[], Any]) -> float:
    """Seconds of the last call that do not count."""
    return run.left_out() if isinstance(run, Partly) else 0.0


@dataclass(frozen=True)
class Bulk:
    """All collisions in one call.

    Arguments:
        run: the call that is timed.
        read: what it came to, collision by collision; text says why one has failed.
    """

    run: Callable[[], Any]
    read: Callable[[Any], list[Answer | str]]

    def __call__(self) -> list[Answer | str]:
        return self.read(self.run())
