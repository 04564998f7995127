"""What was aimed at, and what a record shows of it."""

import math
from typing import Any

from wetdoublet.solvers.formatting.markdown import table

from ..digits import us
from ..gradient_work import HEYOKA as VARIATIONAL
from ..gradient_work import HEYOKA_ALONE as VARIATIONAL_ALONE
from ..peers.engines import HEYOKA, HEYOKA_ALONE
from .beside_heyoka import BOUND, cheapest, of_collisions, of_gradients

Record = dict[str, Any]

TIMES = {"granulation": 6.0, "pendulum": 6.0}  # faster than heyoka without its callbacks
GRADIENT_TIMES = {"granulation": 5.0, "pendulum": 3.0}
COLLISIONS, GRADIENTS = "heyoka without its callbacks", "heyoka's variational equations without callbacks"
FIRST, SECOND = 3.0, 0.1  # s: first use with compilation; beyond the imports from then on
MAP = 10_000  # collisions of a map of 100 x 100


def targets(record: Record) -> list[tuple[str, str, str, bool]]:
    """Rows of: what, target, measured, whether it is met; nothing for what the record does not hold."""
    return [*_collisions(record), *_gradients(record), *_exact(record), *_near(record), *_use(record)]


def _beside(what: str, goal: float, peer: str, slow: float, fast: float) -> tuple[str, str, str, bool]:
    said = f"{slow / fast:.1f} times faster ({us(fast)} us beside {us(slow)} us)"
    return (what, f"{goal:g} times faster than {peer}", said, slow >= goal * fast)


def _collisions(record: Record) -> list[tuple[str, str, str, bool]]:
    found = []
    for task in record["tasks"]:
        rows = of_collisions(task)
        ours, theirs = cheapest(rows, "taylor"), cheapest(rows, HEYOKA_ALONE, HEYOKA)
        if ours and theirs and task["preset"] in TIMES:
            what = f"{task['preset']}: `collide_many` of outcome and restitution, error in e_n at most {BOUND:g}"
            found.append(_beside(what, TIMES[task["preset"]], COLLISIONS, theirs.seconds, ours.seconds))
    wrong = sum(p["summary"]["wrong"] for task in record["tasks"] for p in task["points"] if p["engine"] == "taylor")
    if found:
        found.append(("wrong outcomes of taylor", "none", str(wrong or "none"), not wrong))
    return found


def _gradients(record: Record) -> list[tuple[str, str, str, bool]]:
    found = []
    for task in record["gradient_work"]:
        rows = of_gradients(task)
        ours, theirs = cheapest(rows, "gradients_many"), cheapest(rows, VARIATIONAL_ALONE, VARIATIONAL)
        if ours and theirs and task["preset"] in GRADIENT_TIMES:
            what = f"{task['preset']}: gradient to {len(task['parameters'])} parameters, error at most {BOUND:g}"
            found.append(_beside(what, GRADIENT_TIMES[task["preset"]], GRADIENTS, theirs.seconds, ours.seconds))
    return found


def _exact(record: Record) -> list[tuple[str, str, str, bool]]:
    found = []
    for each in record["sharp"]:
        least = min(row["conditioned"] for row in each["rows"])
        what = f"{each['preset']}: least relative error in e_n over its conditioning"
        found.append((what, "1e-13", f"{least:.1e}", least <= 1e-13))
    return found


def _near(record: Record) -> list[tuple[str, str, str, bool]]:
    rows = [row for row in record["near"] if row["distance"] <= 1.1e-6]
    ours = {(row["rtol"], row["distance"]): row for row in rows if row["engine"] == "taylor"}
    ratios = [row["cpu"] / ours[row["rtol"], row["distance"]]["cpu"] for row in rows if row["engine"] == HEYOKA]
    if not ratios:
        return []
    failed = sum(row["failed"] for row in ours.values())
    said = f"{min(ratios):.0f} times faster or more, {failed or 'none'} failed"
    what = "within 1e-6 to 1e-12 of the separatrix"
    return [(what, "never slower than heyoka, none fails", said, min(ratios) >= 1 and not failed)]


def _use(record: Record) -> list[tuple[str, str, str, bool]]:
    found = []
    many = [row for row in record["growth"] if row["engine"] == "taylor" and row["cores"] == 2]
    million = next((row for row in many if row["collisions"] == 1_000_000), None)
    if million:
        said = f"{million['wall']:.1f} s, {(million['memory'] - million['before']) / 2**20:.0f} MB more than before"
        found.append(("1e6 granulation collisions on two cores", "one call, none fails", said, not million["failed"]))
    small = next((row for row in many if row["collisions"] == MAP), None)
    process = min(record["cold_start"].get("import casadi", [math.nan]))
    if small:
        said = f"{small['wall']:.3f} s beside {process:.3f} s"
        what = "100 x 100 collisions of the map"
        found.append((what, "less than starting a process with casadi", said, small["wall"] < process))
    for each in record["first_use"]:
        least = {name: min(each[name]) for name in ("imports", "first", "second")}
        more = least["second"] - least["imports"]
        said = f"{least['first']:.2f} s; {more:.3f} s"
        goal = f"process below {FIRST:g} s with compilation; then {SECOND:g} s beyond the imports"
        found.append((f"{each['preset']}: first use", goal, said, least["first"] < FIRST and more < SECOND))
    return found


def target_table(record: Record) -> str:
    """As Markdown."""
    rows = [[what, goal, said, "yes" if met else "**no**"] for what, goal, said, met in targets(record)]
    return table(["", "aimed at", "measured", "met"], rows)


def headline(record: Record) -> str:
    """The first ratio to heyoka, as one line of the front page."""
    what, said, peer = next(
        (what, said, goal[goal.index(COLLISIONS) :])
        for what, goal, said, _ in targets(record)
        if goal.endswith(COLLISIONS)
    )
    return f"{what.replace('e_n', 'the restitution')}: {said.replace('faster', f'faster than {peer}')}."
