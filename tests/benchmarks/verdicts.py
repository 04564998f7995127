"""Random collisions beside an independent reference: verdicts, what is printed of them, and the summary."""

# ruff: noqa: T201 -- of scripts that print
from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

SAME = 1e-8
OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
FAILED = "failed"  # of the engine; it counts as a disagreement


@dataclass(frozen=True)
class Verdict:
    """One comparison: `apart` by quantity, `sharpest` what an engine can be held to.

    Arguments:
        tables: the scene.
        impact: what else repeats the comparison.
    """

    tables: dict[str, object]
    impact: object
    expected: str
    found: str
    apart: dict[str, float] = field(default_factory=dict)
    sharpest: float = SAME
    remark: str = ""

    @property
    def compared(self) -> bool:
        """Whether the reference came to an end, and the engine to one or to a failure."""
        return self.expected in OUTCOMES and self.found in (*OUTCOMES, FAILED)

    @property
    def agrees(self) -> bool:
        return self.expected == self.found and max(self.apart.values(), default=0.0) <= self.sharpest


def show(verdict: Verdict) -> None:
    """Print what deserves a look, with its scene."""
    fine = verdict.agrees and not verdict.remark
    left = verdict.found in OUTCOMES and verdict.expected != "Unfinished"
    if fine if verdict.compared else left:
        return
    word = "left" if not verdict.compared else "agrees" if verdict.agrees else "DISAGREES"
    print(f"{word}: {verdict.expected}, found {verdict.found} {verdict.apart} limit {verdict.sharpest:.1e}")
    print(f"  {verdict.remark}\n  {json.dumps(verdict.tables)}\n  {verdict.impact}", flush=True)


def summary(batches: Iterable[list[Verdict]], names: Iterable[str]) -> int:
    """Show the verdicts as they come, then the largest differences by quantity; 1 if any disagrees."""
    verdicts: list[Verdict] = []
    for some in batches:
        for one in some:
            show(one)
        verdicts += some
        print(f"{len(verdicts)} done", flush=True)
    print(Counter((one.expected, one.found) for one in verdicts))
    both = [one for one in verdicts if one.compared]
    for name in names:
        apart = [one.apart[name] for one in both if name in one.apart]
        if apart:
            print(f"{name:22} {len(apart)} largest {max(apart):.1e}, {sum(a > SAME for a in apart)} beyond {SAME:g}")
    disagree = sum(not one.agrees for one in both)
    print(f"{len(both)} compared, {len(verdicts) - len(both)} left out, {disagree} disagreements")
    return int(disagree > 0)
