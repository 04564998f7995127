"""A benchmark's record as Markdown."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

from wetdoublet.solvers.formatting.markdown import table

from ..near import near_text
from .beside_heyoka import Cost, of_collisions, of_gradients, us

BOUNDS = (1e-4, 1e-6, 1e-8, 1e-10)  # of the largest error, in the table of costs at equal error

Record = dict[str, Any]


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


def equal_error(costs: Sequence[tuple[str, Cost]], names: Iterable[str], head: str) -> str:
    """The least cost of each engine with an error that is small enough, and its ratio to the fastest engine's."""
    best = {
        name: {bound: min((c.seconds for own, c in costs if own == name and c.error <= bound), default=math.inf)
               for bound in BOUNDS}
        for name in names
    }  # fmt: skip
    fastest = {bound: min(row[bound] for row in best.values()) for bound in BOUNDS}
    rows = [
        [name, *(f"{us(t)} ({t / fastest[bound]:.3g})" if math.isfinite(t) else "-" for bound, t in row.items())]
        for name, row in best.items()
    ]
    return table([head, *(f"{bound:.0e}" for bound in BOUNDS)], rows)


def of_collisions_at_equal_error(task: Record) -> str:
    """The costs of a task's collisions."""
    title = (
        "CPU us a collision not decided at initial contact (times the fastest): cheapest setting with all outcomes "
        "right and the largest error in e_n at most"
    )
    names = dict.fromkeys(point["engine"] for point in task["points"])
    return f"{title}\n\n{equal_error(of_collisions(task), names, 'engine')}"


NOTE = """\
Derivatives of e_n in theta, p = p_ref (1 + theta), of 25 collisions of each task that separate, drawn on from its
sequence until there are so many; the set is repeated 40 times in one call. `gradients_many` has some 2 ms a call
beside the kernel (checks, boundaries too near, the labelled Dataset), so smaller calls cost more. The error of a
collision is its largest, over its largest derivative, against forward derivatives of Rosenbrock at 1e-12. heyoka's
are its variational equations in batches of 8 with a queue; the saltation at each event is a compiled function of our
own; it need prove no stick, and is given the derivatives of the groups in the parameters.
Differences are of collisions at rtol 1e-13; what is listed as their tolerance is the relative step."""


def of_gradients_at_equal_error(found: Sequence[Record]) -> str:
    """The costs of gradients, by task."""
    said = "CPU us a gradient (times the cheapest): cheapest setting with none refused and a largest error of at most"
    parts = [NOTE]
    for task in found:
        title = f"### {task['preset']}, {task['collisions']} collisions, {len(task['parameters'])} parameters"
        names = dict.fromkeys(row["method"] for row in task["rows"])
        parts += [title, said, equal_error(of_gradients(task), names, "method")]
        parts += [f"* {name}: {why}" for name, why in task["missing"].items()]
    return "\n\n".join(parts)


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


def others(record: Record) -> list[tuple[str, str, list[str]]]:
    """What was measured besides, with its picture: gradients, the separatrix, growth; nothing for what was not."""
    gradients, beside = record["gradient_work"], record["near"]
    parts = [("Gradients to twelve parameters, beside peers", "gradients", [of_gradients_at_equal_error(gradients)])]
    parts += [("Near the separatrix", "near", [near_text(beside)] if beside else [])]
    parts += [("From one collision to many", "growth", [])]
    there = (gradients, beside, record["growth"])
    return [part for part, rows in zip(parts, there, strict=True) if rows]
