"""A benchmark's record as Markdown."""

from typing import Any

from wetdoublet.solvers.formatting.markdown import table

from ..digits import us
from ..gradient_work import gradient_work_text
from ..near import near_text

BOUNDS = (1e-4, 1e-6, 1e-8, 1e-10)  # of the largest error, in the table of costs at equal error

Record = dict[str, Any]


def _error(value: float | None) -> str:
    return "-" if value is None else f"{value:.1e}"


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


def equal_error(task: Record) -> str:
    """Mean CPU time at the cheapest setting that is good enough, and its ratio to the fastest engine's."""
    best: dict[str, dict[float, float]] = {point["engine"]: {} for point in task["points"]}
    for point in task["points"]:
        s = point["summary"]
        for bound in BOUNDS:
            if not s["wrong"] and not s["failed"] and s["error_largest"] is not None and s["error_largest"] <= bound:
                row = best[point["engine"]]
                row[bound] = min(row.get(bound, float("inf")), s["cpu_mean"])
    fastest = {bound: min((row[bound] for row in best.values() if bound in row), default=0.0) for bound in BOUNDS}
    rows = [
        [
            engine,
            *(f"{us(row[bound])} ({row[bound] / fastest[bound]:.3g})" if bound in row else "-" for bound in BOUNDS),
        ]
        for engine, row in best.items()
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


def others(record: Record) -> list[str]:
    """What was measured besides: gradients, the separatrix, growth; nothing for what was not."""
    parts: list[str] = []
    if record["gradient_work"]:
        parts += ["## Gradients to twelve parameters, beside peers", gradient_work_text(record["gradient_work"])]
    if record["near"]:
        parts += ["## Near the separatrix", near_text(record["near"])]
    if record["growth"]:
        parts += ["## From one collision to many"]
    return parts
