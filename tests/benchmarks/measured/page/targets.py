"""What was aimed at, and what a record shows of it."""

import math
from typing import Any

from wetdoublet.solvers.formatting.tables import table

from ..peers.engines import HEYOKA, HEYOKA_ALONE
from .tables import of_collisions, us

Record = dict[str, Any]

TIMES = {"granulation": 6.0, "pendulum": 6.0}  # faster than the peer
PEER, BOUND = "heyoka without its callbacks", 1e-8  # of the largest error, at which costs are compared
FIRST, SECOND = 3.0, 0.1  # s: first use with compilation; beyond the imports from then on
MAP = 10_000  # collisions of a map of 100 x 100


def targets(record: Record) -> list[tuple[str, str, str, bool]]:
    """Rows of: what, target, measured, whether it is met; nothing for what the record does not hold."""
    return [*_times(record), *_wrong(record), *_use(record)]


def _times(record: Record) -> list[tuple[str, str, str, bool]]:
    """How many times faster than heyoka collisions are.

    Without its callbacks heyoka costs no more than with them: the lesser of both ways of measuring counts.
    """
    found = []
    for task in record["tasks"]:
        rows = [(name, cost) for name, cost in of_collisions(task) if cost.error <= BOUND]
        ours = min((cost.seconds for name, cost in rows if name == "taylor"), default=None)
        theirs = min((cost.seconds for name, cost in rows if name in (HEYOKA_ALONE, HEYOKA)), default=None)
        if ours and theirs and (goal := TIMES.get(task["preset"])):
            ratio = theirs / ours
            said = f"{ratio:.1f} times faster ({us(ours)} us beside {us(theirs)} us)"
            what = f"{task['preset']}: `collide_many` of outcome and restitution, error in e_n at most {BOUND:g}"
            found.append((what, f"{goal:g} times faster than {PEER}", said, ratio >= goal))
    return found


def _wrong(record: Record) -> list[tuple[str, str, str, bool]]:
    wrong = sum(p["summary"]["wrong"] for task in record["tasks"] for p in task["points"] if p["engine"] == "taylor")
    return [("wrong outcomes of taylor", "none", str(wrong or "none"), not wrong)]


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
    what, _, said, _ = _times(record)[0]
    return f"{what.replace('e_n', 'the restitution')}: {said.replace('faster', f'faster than {PEER}')}."
