"""A benchmark's record as Markdown."""

import math
from typing import Any, NamedTuple

from wetdoublet.solvers.formatting.tables import table

BOUNDS = (1e-4, 1e-6, 1e-8, 1e-10)  # of the largest error, in the table of costs at equal error

Record = dict[str, Any]


class Cost(NamedTuple):
    """Seconds, and the largest error of it."""

    seconds: float
    error: float


def of_collisions(task: Record) -> list[tuple[str, Cost]]:
    """Engines' settings at which no collision failed and no outcome was wrong."""
    found = ((point["engine"], point["summary"]) for point in task["points"])
    return [
        (name, Cost(s["cpu_mean"], s["error_largest"]))
        for name, s in found
        if not s["wrong"] and not s["failed"] and s["error_largest"] is not None
    ]


def us(seconds: float) -> str:
    """Microseconds with three digits."""
    return f"{seconds * 1e6:.3g}" if seconds < 1e-3 else f"{seconds * 1e6:.0f}"


def surroundings(record: Record) -> str:
    """Where and how it was run, and which engines were missing."""
    where = record["environment"]
    said = [f"{name} {_shown(value)}" for name, value in where.items() if value is not None]
    said += [f"{each['name']}: {each['missing']}" for each in record["engines"] if each["missing"]]
    runs = f"{record['settings']['repeats']} runs of each, the best counts; {record['wall']:.0f} s in all."
    return f"{'; '.join(said)}. {runs}"


def _shown(value: Any) -> str:
    return ", ".join(f"{each:.2f}" for each in value) if isinstance(value, list) else str(value)


def sample(task: Record) -> str:
    """The collisions and how well they are known."""
    known = task["collisions"]
    free = f"{task['drawn']}; {known['decided_at_first_touch']} are proved sticks at initial contact and do not count."
    lines = [f"{free} Of the other {known['counted']}, {known['separate']} separate."]
    if known["separate"]:
        against = ", ".join(f"{value:.0e} from {name}" for name, value in known["differences"].items())
        lines.append(f"Reference values by {known['reference']} at rtol 1e-13; e_n differs by at most {against}.")
    return "\n".join(lines + known["left_out"])


def of_collisions_at_equal_error(task: Record) -> str:
    """The least cost of each engine with an error that is small enough, and its ratio to the fastest engine's."""
    costs = of_collisions(task)
    best = {
        name: {bound: min((c.seconds for own, c in costs if own == name and c.error <= bound), default=math.inf)
               for bound in BOUNDS}
        for name in dict.fromkeys(point["engine"] for point in task["points"])
    }  # fmt: skip
    fastest = {bound: min(row[bound] for row in best.values()) for bound in BOUNDS}
    rows = [
        [name, *(f"{us(t)} ({t / fastest[bound]:.3g})" if math.isfinite(t) else "-" for bound, t in row.items())]
        for name, row in best.items()
    ]
    title = (
        "CPU us a collision not decided at initial contact (times the fastest): cheapest setting with all outcomes "
        "right and the largest error in e_n at most"
    )
    return f"{title}\n\n{table(['engine', *(f'{bound:.0e}' for bound in BOUNDS)], rows)}"


def failures(task: Record) -> str:
    """Every collision that failed or came out wrong, with what the engine said; empty if none did."""
    lines = [
        f"* {point['engine']}, rtol {point['rtol']:.1e}, {_some(places)}: {what}"
        for point in task["points"]
        for what, places in point["said"].items()
    ]
    return "\n".join(["Failures and wrong outcomes:", "", *lines]) if lines else ""


def _some(places: list[str]) -> str:
    """The places, or the first of them and how many more."""
    return ", ".join(places) if len(places) < 4 else f"{places[0]} and {len(places) - 1} others"
