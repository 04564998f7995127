"""What a collision and a gradient cost beside heyoka, whose callbacks are Python's: three ways, at equal error."""

from typing import Any, NamedTuple

from wetdoublet.solvers.formatting.markdown import table

from ..gradient_work import HEYOKA as VARIATIONAL
from ..gradient_work import HEYOKA_ALONE as VARIATIONAL_ALONE
from ..peers.engines import HEYOKA, HEYOKA_ALONE, KERNEL

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


def three_ways(record: Record) -> str:
    """As a Python user gets it, without its callbacks, ours."""
    rows = []
    for task in record["tasks"]:
        names = ((HEYOKA,), (HEYOKA_ALONE, HEYOKA), ("taylor",), (KERNEL,))
        costs = of_collisions(task)
        rows.append(_row(f"{task['preset']}, collision", [cheapest(costs, *each) for each in names]))
    for task in record["gradient_work"]:
        names = ((VARIATIONAL,), (VARIATIONAL_ALONE, VARIATIONAL), ("gradients_many",), (KERNEL,))
        costs = of_gradients(task)
        found = [cheapest(costs, *each) for each in names]
        rows.append(_row(f"{task['preset']}, gradient to {len(task['parameters'])} parameters", found))
    head = ["CPU us (largest error)", "heyoka in Python", "without callbacks", "ours", "our kernel alone"]
    return table([*head, "heyoka in Python / ours", "without callbacks / ours"], rows)


def _row(what: str, costs: list[Cost | None]) -> list[str]:
    theirs, alone, ours = costs[:3]
    ratios = [f"{each.seconds / ours.seconds:.1f}" if each and ours else "-" for each in (theirs, alone)]
    return [what, *(f"{us(each.seconds)} ({each.error:.0e})" if each else "-" for each in costs), *ratios]


def note(record: Record) -> str:
    """What the columns are."""
    around = record["settings"].get("around_callback")
    said = f": {1e9 * around:.0f} ns a call" if around else ""
    return NOTE.format(bound=f"{BOUND:g}", around=said)


NOTE = """\
Each at its cheapest setting with all outcomes right and a largest error of at most {bound}, some 1000 in a call, all
in one run. Events of heyoka end in callbacks; from Python these are Python.

* **Without callbacks**: less the CPU time within callbacks, by a clock in each, and less the way from heyoka to Python,
  measured on an oscillator whose crossings call a function that does nothing{around}. A caller in C++ waits at least
  so long, as what callbacks do costs something there as well.
* **Ours**: `collide_many` and `gradients_many` as a user calls them; "kernel alone" leaves out what these add.

All get the same collisions, none of which is decided at initial contact by any of our proofs. heyoka does not get our
jump along the slow manifold, nor the bound of the impulse where a trajectory turns."""
