"""The time that heyoka spends in callbacks written in Python, which somebody who calls it from C++ does not have."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

_EVENTS, _DURATION, _RUNS = 20, 200.0, 15  # of the oscillator that a call is measured on


@dataclass
class Inside:
    """Calls of callbacks and the CPU time (s) within them. The clock itself costs about a microsecond a call."""

    calls: int = 0
    seconds: float = 0.0

    def reset(self) -> None:
        """Count from nothing."""
        self.calls, self.seconds = 0, 0.0

    def watched(self, callback: Callable[..., Any]) -> Callable[..., Any]:
        """The callback, with its time taken."""
        clock = time.thread_time

        def timed(*arguments: Any) -> Any:
            start = clock()
            found = callback(*arguments)
            self.seconds += clock() - start
            self.calls += 1
            return found

        return timed

    def left_out(self) -> float:
        """Seconds of a run that are Python's: within callbacks, on the way there, and of the clock."""
        return self.seconds + self.calls * around()


@lru_cache(maxsize=1)
def around() -> float:
    """Seconds that a watched callback takes beside the time noted: on the way from heyoka to Python, and of the clock.

    An oscillator whose crossings call one that does nothing in both directions, less the same in one direction.
    """
    import heyoka

    inside = Inside()
    directions = (heyoka.event_direction.any, heyoka.event_direction.negative)
    integrators = [_oscillator(inside.watched(lambda *_: None), each) for each in directions]
    least, calls = [math.inf, math.inf], [0, 0]
    start = integrators[0].state.copy()
    for _ in range(_RUNS):
        for k, integrator in enumerate(integrators):
            integrator.set_time(0.0)
            integrator.state[:] = start
            inside.reset()
            before = time.process_time()
            integrator.propagate_until([_DURATION] * start.shape[1])
            least[k] = min(least[k], time.process_time() - before - inside.seconds)
            calls[k] = inside.calls
    return max(0.0, (least[0] - least[1]) / (calls[0] - calls[1]))


def _oscillator(callback: Callable[..., Any], direction: Any) -> Any:
    import heyoka
    import numpy as np

    x, v = heyoka.make_vars("x", "v")
    return heyoka.taylor_adaptive_batch(
        [(x, v), (v, -x)],
        state=np.vstack([np.linspace(0.1, 1.0, 8), np.zeros(8)]),
        nt_events=[
            heyoka.nt_event_batch(x + 0.01 * k * v, callback=callback, direction=direction) for k in range(_EVENTS)
        ],
        tol=1e-9,
    )
