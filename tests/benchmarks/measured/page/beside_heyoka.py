"""The least costs at equal error, and what is left out of the cost of heyoka, whose callbacks are Python's."""

from typing import Any, NamedTuple

Record = dict[str, Any]

BOUND = 1e-8  # of the largest error, at which costs are compared


def us(seconds: float) -> str:
    """Microseconds with three digits."""
    return f"{seconds * 1e6:.3g}" if seconds < 1e-3 else f"{seconds * 1e6:.0f}"


class Cost(NamedTuple):
    """Seconds, and the largest error of it."""

    seconds: float
    error: float


def cheapest(rows: list[tuple[str, Cost]], *names: str) -> Cost | None:
    """The least cost of engines within the bound; None if it never is.

    A peer without its callbacks is given both ways of its measurement: it costs no more than with them.
    """
    return min((cost for own, cost in rows if own in names and cost.error <= BOUND), default=None)


def of_collisions(task: Record) -> list[tuple[str, Cost]]:
    """Engines' settings at which no collision failed and no outcome was wrong."""
    found = ((point["engine"], point["summary"]) for point in task["points"])
    return [
        (name, Cost(s["cpu_mean"], s["error_largest"]))
        for name, s in found
        if not s["wrong"] and not s["failed"] and s["error_largest"] is not None
    ]


def of_gradients(task: Record) -> list[tuple[str, Cost]]:
    """Methods' settings at which no gradient failed."""
    return [
        (row["method"], Cost(row["cpu"], row["error_largest"]))
        for row in task["rows"]
        if not row["failed"] and row["error_largest"] is not None
    ]


def note(record: Record) -> str:
    """What is left out of the cost of a collision."""
    around = record["settings"].get("around_callback")
    said = f": {1e9 * around:.0f} ns a call" if around else ""
    return NOTE.format(around=said)


NOTE = """\
* **heyoka, without callbacks**: its events end in callbacks, which from Python are Python. This is less the CPU time
  within them, by a clock in each, and less the way from heyoka to Python, measured on an oscillator whose crossings
  call a function that does nothing{around}. A caller in C++ waits at least so long."""
