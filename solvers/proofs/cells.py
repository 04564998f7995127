"""Cells of a proved map."""

import math
from typing import Any, NamedTuple

from ...generated.automaton import OUTCOMES

UNDECIDED = -1


class Cell(NamedTuple):
    """A box of Stokes numbers and angles (rad), and the outcome of all its collisions by number; -1 is undecided."""

    stokes: tuple[float, float]
    angle: tuple[float, float]
    outcome: int

    @property
    def area(self) -> float:
        """Its area over the logarithm of the Stokes number, and the angle."""
        return math.log(self.stokes[1] / self.stokes[0]) * (self.angle[1] - self.angle[0])

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON object of a map: the outcome in words, null for one that is undecided."""
        return self._asdict() | {"outcome": None if self.outcome == UNDECIDED else OUTCOMES[self.outcome]}
