"""Bounds of an approach through the film, part by part (`derive/equations/certificates/approach.py`)."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import APPROACH_PARTS, CLOSING
from ..model.model import Model
from ..model.phases import Phase
from ..scene.contact import contact_gap


@dataclass(frozen=True)
class Part:
    """A part of the film: its two gaps over x0, the largest closing speed over v0 at its end and within it."""

    start: float
    gap: float
    slowed: float
    fastest: float


def starts(y: np.ndarray, phase: Phase) -> bool:
    """True for an approach that starts at the edge of the film."""
    return bool(not phase.resting and phase.motion == CLOSING and phase.film and y[0] == 1)


class Approach:
    """Bounds of the approaches of a model; `margin` is the relative error of a speed."""

    def __init__(self, model: Model, p: np.ndarray, margin: float) -> None:
        self.model, self.p, self.margin = model, p, margin
        self._contact = contact_gap(dict(zip(model.groups, p, strict=True)))

    @property
    def covers(self) -> bool:
        """True if the model's laws have what the bounds need."""
        laws = self.model.laws
        attracting = [getattr(laws, slot) for slot in ("bridge", "attraction") if self.model.choice.law(slot)]
        return (
            self.model.has("approach_step")
            and hasattr(laws.film, "braking")
            and hasattr(laws.glass, "reach")
            and all(getattr(law, "FALLS", False) for law in attracting)
            and self.model.choice.law("arm") in (None, "midgap")
        )

    def outward(self, y: np.ndarray) -> float:
        """Largest outward force on the way in, over m v0^2/x0."""
        return self.model.values("approach_force", y[: len(self.model.state)], self.p)["outward"]

    def parts(self, y: np.ndarray) -> Iterator[Part]:
        """Every part of the film, from the gap of `y` to the deepest one above solid contact."""
        if not self._contact < y[0]:
            return
        bounds = np.array(y[: len(self.model.state)])
        for _ in range(APPROACH_PARTS):
            step = self.model.values("approach_step", bounds, self.p)
            part = Part(float(bounds[0]), step["deeper_gap"], step["slowed"], step["fastest"])
            yield part
            bounds[:2] = part.gap, -part.slowed

    def misses_glass(self, y: np.ndarray, part: Part) -> bool:
        """True if the glass criterion is not met in this part."""
        there = np.array([part.gap, -part.fastest / (1 - self.margin), *y[2 : len(self.model.state)]])
        return self.model.values("events", there, self.p)["glass"] > 0

    def clear(self, y: np.ndarray) -> Iterator[Part]:
        """The parts up to the first in which a criterion may be met."""
        for part in self.parts(y):
            if not self.misses_glass(y, part):
                return
            yield part
