"""A tabulated collision law as plain data: scene, ranges, errors, and arrays as files and readers have them."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..scene.scene import Scene
from .series import Trees

STOKES, ANGLE = "impact.stokes", "impact.angle"


@dataclass
class Data:
    """The arrays of a table.

    Attributes:
        low, high: ranges of the third variable (its logarithm if `logarithmic`; 0..1 if there is none), angle, ln St.
        slices: ends of the panels of the third variable.
        first_panel: first angle panel of each slice, and their number at the end.
        cuts: roots of the lower and upper angle of each panel, among the shapes.
        maps: map of the angle in each panel.
        first_edge: first boundary of each panel among `edges`, and their number at the end.
        edges: roots of the boundaries, among the shapes.
        outcome, criterion, cell_map, root: of each cell: outcome by number, first rebound criterion (-1 for none), map
            of its height and root of its results (-1 for a stick). A panel has a cell more than boundaries; its first
            is number `first_edge` + the number of the panel.
        of_stick: results of a stick: restitution 0, others NaN.
        shapes, results: trees of angles and ln St, and of results.
    """

    low: np.ndarray
    high: np.ndarray
    logarithmic: bool
    slices: np.ndarray
    first_panel: np.ndarray
    cuts: np.ndarray
    maps: np.ndarray
    first_edge: np.ndarray
    edges: np.ndarray
    outcome: np.ndarray
    criterion: np.ndarray
    cell_map: np.ndarray
    root: np.ndarray
    of_stick: np.ndarray
    shapes: Trees
    results: Trees

    @property
    def bytes(self) -> int:
        """Size of the arrays in C."""
        own_arrays = sum(getattr(self, name).nbytes for name in ("slices", "first_panel", "cuts", "maps", "first_edge",
                  "edges", "outcome", "criterion", "cell_map", "root", "of_stick"))  # fmt: skip
        parts = ("axis", "cut", "child", "box", "size", "start", "coefficients")
        return int(
            own_arrays + sum(getattr(trees, name).nbytes for trees in (self.shapes, self.results) for name in parts)
        )


@dataclass
class Range:
    """The ranges of a table.

    Attributes:
        third: dotted name of the third variable, if there is one.
        ends: its range, SI; 0..1 if there is none.
        angle, stokes: ranges, rad and 1.
    """

    third: str | None
    ends: tuple[float, float]
    angle: tuple[float, float]
    stokes: tuple[float, float]

    @property
    def logarithmic(self) -> bool:
        """True if the table is over the logarithm of the third variable."""
        return self.third is not None and self.ends[0] > 0 and self.ends[1] > 2 * self.ends[0]

    @property
    def corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest third variable (or its logarithm), angle and ln St."""
        third = np.log(self.ends) if self.logarithmic else np.array(self.ends)
        low, high = zip(third.tolist(), self.angle, (math.log(one) for one in self.stokes), strict=True)
        return np.array(low), np.array(high)


@dataclass
class Attack:
    """What an attack has found.

    Attributes:
        queries: number of queries.
        largest: largest error of an answer that holds; of all answers if some do not.
        at: where it is: third variable, angle (rad), St.
        direct: number of queries that agree with the collision at their own impact; the others beside it.
        failures: impacts (third variable, angle, St) at which the table is wrong, with what it says and what is right.
    """

    queries: int = 0
    largest: float = 0.0
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    direct: int = 0
    failures: list[tuple[np.ndarray, str]] = field(default_factory=list)
    failed: int = 0


@dataclass(frozen=True)
class Law:
    """A tabulated law.

    Attributes:
        scene: the scene.
        of: results.
        range: ranges of the variables.
        error: largest error that it states, over the magnitude of a result where that is above 1.
        found: what the attack found: number of `queries`, `largest` error and where.
        rtol: relative tolerance of the collisions.
        data: its arrays.
    """

    scene: Scene
    of: tuple[str, ...]
    range: Range
    error: float
    found: Attack
    rtol: float
    data: Data

    @property
    def variables(self) -> tuple[str, ...]:
        """Dotted names of the variables."""
        return (STOKES, ANGLE) + (() if self.range.third is None else (self.range.third,))
