"""What `solve()` returns: the values of an entry, with derivatives, jumps over the target, and what was not seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..collision.text import name_of
from ..formatting.tables import numbers_aligned
from ..results import DEFINITIONS
from ..scene.origin import origin
from ..scene.scene import Scene


@dataclass(frozen=True)
class Question:
    """Where, with `free` from `low` to `high`, has the result `of` this `value`? SI.

    Attributes:
        hold: what the impact keeps.
        rtol: relative tolerance of the collisions.
    """

    scene: Scene
    free: str
    low: float
    high: float
    of: str
    value: float
    hold: str
    rtol: float


@dataclass(frozen=True)
class Solution:
    """One value of the entry, SI.

    Attributes:
        outcome: of the collision there.
        gradient: derivatives of the value by parameter, and by the result's target; empty where there are none.
        reason: why there are none.
    """

    value: float
    outcome: str
    gradient: Mapping[str, float] = field(default_factory=dict)
    reason: str = ""


@dataclass(frozen=True)
class Jump:
    """Value of the entry where the result jumps over its target; outcomes, with criteria, and results beside it."""

    value: float
    before: str
    below: float
    after: str
    above: float

    def __str__(self) -> str:
        return f"{self.value:.10g}: {self.before} {self.below:.4g}, {self.after} {self.above:.4g}"


class Solutions(list[float]):
    """The values of the entry at which the result has its target, SI, ascending.

    Attributes:
        found: each with outcome and derivatives.
        jumps: where the target is passed and not taken.
        throughout: parts of the range in which the result has its target all along.
        attained: least and greatest result of the samples of the range; None if it is not defined anywhere.
        remarks: what was not seen, a sentence each.
    """

    def __init__(
        self, asked: Question, roots: Sequence[Solution], jumps: Sequence[Jump],
        throughout: Sequence[tuple[float, float]], attained: tuple[float, float] | None, remarks: Sequence[str],
    ) -> None:  # fmt: skip
        super().__init__(root.value for root in roots)
        self.asked, self.found, self.jumps, self.throughout = asked, tuple(roots), tuple(jumps), tuple(throughout)
        self.attained, self.remarks = attained, tuple(remarks)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet solve --json`."""
        asked = self.asked
        return {
            "solutions": list(self),
            "outcomes": [root.outcome for root in self.found],
            "gradients": [dict(root.gradient) for root in self.found],
            "jumps": [vars(jump) for jump in self.jumps],
            "throughout": self.throughout,
            "attained": self.attained,
            "free": asked.free,
            "within": [asked.low, asked.high],
            "of": {asked.of: asked.value},
            "units": {asked.free: asked.scene.fields[asked.free].unit or "1", asked.of: DEFINITIONS[asked.of].unit},
            **origin(asked.scene),
        }

    def __str__(self) -> str:
        asked, result = self.asked, DEFINITIONS[self.asked.of]
        unit, of_result = asked.scene.fields[asked.free].unit or "", result.unit.removeprefix("1")
        span = f"{asked.free} from {asked.low:.6g} to {asked.high:.6g} {unit}".rstrip()
        lines = [f"{name_of(asked.scene)}: {result.label} = {asked.value:.6g} {of_result}".rstrip() + f", {span}"]
        lines += [f"  {root.value:.10g} {unit}".rstrip() + f"  {root.outcome}" for root in self.found]
        lines += [f"  all along from {low:.6g} to {high:.6g} {unit}".rstrip() for low, high in self.throughout]
        if len(lines) == 1:
            others = self.attained and "; collisions there have {:.6g} to {:.6g}".format(*self.attained)
            lines.append(f"  none: no {span} has it{others or ''}")
        lines += [f"  jumped over at {jump}" for jump in self.jumps]
        lines += [f"  no derivatives at {root.value:.6g}: {root.reason}" for root in self.found if root.reason]
        lines += [f"  {text}" for text in self.remarks]
        names = dict.fromkeys(name for root in self.found for name, slope in root.gradient.items() if slope)
        rows = [[name, *(f"{root.gradient.get(name, float('nan')):.6g}" for root in self.found)] for name in names]
        return "\n".join([*lines, *(["", f"d({asked.free})/dp, SI", *numbers_aligned(rows)] if rows else [])])

    __repr__ = __str__  # what a notebook shows
