"""What is timed and how: calls of all engines take turns, so that a busy machine slows all alike; the best counts."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from wetdoublet.solvers.errors import ComputationError

Tell = Callable[[str], None]

CALL = 1000  # of collisions or gradients, at least, in one call of an engine that takes many
REPEATS, OFTEN = 3, 7  # turns, and calls in each of an engine that takes many
LONG = 0.5  # s of a call, which is then not repeated at once
DEAR = 2.0  # s: an engine that takes longer in all is not asked for a tighter tolerance


@dataclass(frozen=True)
class Call:
    """A function that is timed.

    Arguments:
        read: what its result comes to, item by item.
        left_out: seconds of the last call that do not count.
    """

    run: Callable[[], Any]
    read: Callable[[Any], Any] = lambda found: found
    left_out: Callable[[], float] = lambda: 0.0

    def __call__(self) -> Any:
        return self.read(self.run())


@dataclass
class Least:
    """The least CPU time (s) of an item, and what the last call came to."""

    call: Call
    items: int
    cpu: float = math.inf
    found: Any = None

    def run(self) -> float:
        """Call once more; the CPU time of the call."""
        start = time.process_time()
        found = self.call.run()
        cpu = time.process_time() - start
        self.cpu = min(self.cpu, (cpu - self.call.left_out()) / self.items)
        self.found = self.call.read(found)
        return cpu


@dataclass(frozen=True)
class Engine:
    """A way to results.

    Arguments:
        prepare: from what is asked, copies of it in one call and a tolerance, the call.
        tolerances: what it is asked at; for differences, steps.
        many: it takes many in one call.
        missing: why it cannot be used here; empty if it can.
    """

    name: str
    prepare: Callable[[Any, int, float], Call]
    tolerances: tuple[float, ...] = ()
    many: bool = True
    missing: str = ""


def measured(
    engines: Sequence[Engine], asked: Any, size: int, repeats: int, tell: Tell, call: int = CALL
) -> list[tuple[Engine, float, Least]]:
    """All engines that are there at all their tolerances, for something of this size; a first call builds and caches.

    Arguments:
        call: items in one call of an engine that takes many, at least.
    """
    ready, dear = list[tuple[Engine, float, Least]](), set[str]()
    for engine, rtol in ((each, rtol) for each in engines for rtol in sorted(each.tolerances, reverse=True)):
        if engine.missing or engine.name in dear:
            continue
        tell(f"{engine.name} {rtol:.1e}")
        copies = -(-call // size) if engine.many else 1
        try:
            least = Least(engine.prepare(asked, copies, rtol), copies * size)
        except ComputationError as error:  # what a peer does not have
            tell(f"{engine.name}: {error}")
            continue
        if least.run() > DEAR and not engine.many:
            dear.add(engine.name)
        least.cpu = math.inf
        ready.append((engine, rtol, least))
    for turn in range(repeats):
        for engine, rtol, least in ready:
            tell(f"{turn + 1}/{repeats} {engine.name} {rtol:.1e}")
            for _ in range(OFTEN if engine.many else 1):
                if least.run() > LONG:
                    break
    return ready
