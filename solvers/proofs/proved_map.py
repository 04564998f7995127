"""`prove_map`: a regime map whose cells are proved, by halving those that are not, down to a sliver that is left."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...generated.automaton import OUTCOMES, ROTATE
from ..engines.interval.build import NotProvable
from ..engines.interval.call import BOX, enclose
from ..engines.interval.inputs import Inputs
from ..errors import ComputationError, InputError
from ..host.cores import usable_cores
from ..host.pictures import Drawn
from ..many.collide_many import collide_many
from ..results import outcome_attributes
from ..scene.origin import Recorded, provenance
from ..scene.scene import Scene

if TYPE_CHECKING:
    import xarray

DEPTH = 12  # halvings of a cell
_POINTS = 6  # collisions along each side of a cell that say where a proof is worth a try
_BOUNDED = 1.01  # narrower boxes are followed in steps at once
_ROTATE = OUTCOMES.index(ROTATE)
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


@dataclass(frozen=True)
class ProvedMap(Recorded, Drawn):
    """Cells that cover a rectangle of Stokes numbers and angles, each with one proved outcome, or undecided.

    Attributes:
        cells: of any size, as far as they had to be halved.
        proofs: collisions in a box that were enclosed.

    Example:
        >>> from wetdoublet.solvers import prove_map
        >>> prove_map("granulation", stokes=[0.3, 0.301], angle=[0.35, 0.351]).shares["bounce"]
        1.0
    """

    _picture = "proofs.plot.draw"
    _keys = "shares undecided_area proofs cells"

    scene: Scene
    cells: tuple[Cell, ...]
    proofs: int

    @property
    def shares(self) -> dict[str, float]:
        """The part of the area with each outcome, and "undecided"; over the logarithm of St, and the angle."""
        areas: Counter[int] = Counter()
        for cell in self.cells:
            areas[cell.outcome] += cell.area  # type: ignore[assignment] # counts of a real measure
        total = sum(areas.values())
        return {name: areas[k] / total for k, name in (*enumerate(OUTCOMES), (UNDECIDED, "undecided"))}

    @property
    def undecided_area(self) -> float:
        """The part of the area that is not proved."""
        return self.shares["undecided"]

    @property
    def outcome(self) -> np.ndarray:
        """Outcome of each cell: 0 stick, 1 stick-rotate-separate, 2 bounce, -1 undecided."""
        return np.array([cell.outcome for cell in self.cells], dtype=np.int8)

    def to_dataset(self) -> xarray.Dataset:
        """A Dataset over `cell`: `outcome`, the ends of `stokes` and `angle` (rad); attribute `undecided_area`."""
        import xarray

        ends = {
            name: (("cell", "end"), np.array([getattr(cell, name) for cell in self.cells]), {"units": unit})
            for name, unit in (("stokes", "1"), ("angle", "rad"))
        }
        outcome = ("cell", self.outcome, outcome_attributes("proved outcome", "undecided"))
        attributes = provenance(self.scene, undecided_area=self.undecided_area)
        return xarray.Dataset({"outcome": outcome, **ends}, attrs=attributes)

    def __str__(self) -> str:
        lines = [f"{100 * share:8.3f} %  {name}" for name, share in self.shares.items()]
        return "\n".join([f"{len(self.cells)} cells, {self.proofs} boxes enclosed; shares of the area:", *lines])


def prove_map(
    scene: Scene | str | Path,
    *,
    stokes: Sequence[float],
    angle: Sequence[float],
    depth: int = DEPTH,
    progress: Callable[[int, int], None] | None = None,
) -> ProvedMap:
    """Prove the outcome of every impact of a rectangle, cell by cell.

    A cell that is not proved is halved, up to `depth` times; what is left then is undecided, and drawn as such.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name; its impact is not used.
        stokes: edges of the cells, rising Stokes numbers.
        angle: edges of the cells, rising angles from 0 on, rad; a cell from 0 on holds head-on impacts, too.
        progress: called with the numbers of finished and of all cells.

    Raises:
        InputError: edges that do not rise, or are not admissible.
        ComputationError: collisions of this scene cannot be enclosed here.

    Example:
        >>> import numpy as np
        >>> from wetdoublet.solvers import prove_map
        >>> few = prove_map("granulation", stokes=[0.2, 0.21], angle=np.radians([20, 21]), depth=8)
        >>> few.shares["undecided"] < 0.2
        True
    """
    for name, edges in (("stokes", stokes), ("angle", angle)):
        if len(edges) < 2 or any(not low < high for low, high in itertools.pairwise(edges)):
            raise InputError(name, list(edges), "at least two rising edges")
    if isinstance(depth, bool) or not isinstance(depth, int) or not 0 <= depth <= 40:
        raise InputError("depth", depth, "a whole number from 0 to 40")
    loaded = Scene.load(scene).with_impact(stokes=float(stokes[-1]), angle=float(angle[-1]))
    loaded.with_impact(stokes=float(stokes[0]), angle=float(angle[0]))
    inputs = Inputs.of(loaded, {"impact.stokes": 1e-6, "impact.angle": 1e-6})
    try:
        engine = inputs.engine()
    except NotProvable as error:
        raise ComputationError(f"not provable here: {error}") from None
    if progress is not None:
        progress(0, (len(stokes) - 1) * (len(angle) - 1))
    guide = _Guide.of(loaded, stokes, angle)
    asked = 0

    def decided(cell: Cell, levels: int) -> Iterator[tuple[Cell, bool]]:
        expected, spread = guide.expected(cell), ""
        if expected is not None or not levels:
            ranges = inputs.ranges | {"stokes": cell.stokes, "angle": cell.angle}  # type: ignore[operator]
            narrow = cell.stokes[1] < cell.stokes[0] * _BOUNDED
            settings = BOX._replace(funnels=1) if narrow or expected == _ROTATE else BOX
            if expected is not None and levels:
                settings = settings._replace(expected=expected + 1)
            enclosures = enclose(engine, ranges, inputs.moving, settings)
            number, spread = enclosures.outcome - 1, ""
            if enclosures.rebounds and enclosures.spread >= 0:
                spread = inputs.moving[enclosures.spread]
            yield cell._replace(outcome=number), number >= 0 or not levels
            if number >= 0:
                return
        if levels:
            for half in _halves(cell, spread):
                yield from decided(half, levels - 1)

    def whole(cell: Cell) -> list[tuple[Cell, bool]]:
        return list(decided(cell, depth))

    pairs = [list(zip(map(float, edges), map(float, edges[1:]), strict=False)) for edges in (stokes, angle)]
    start = [Cell(span, other, UNDECIDED) for span in pairs[0] for other in pairs[1]]
    cells: list[Cell] = []
    with ThreadPoolExecutor(usable_cores()) as pool:  # the engine is called without the interpreter's lock
        for done, decisions in enumerate(pool.map(whole, start), 1):
            asked += len(decisions)
            cells += [cell for cell, decides in decisions if decides]
            if progress is not None:
                progress(done, len(start))
    return ProvedMap(loaded, tuple(cells), asked)


class _Guide(NamedTuple):
    """Outcomes of collisions on a grid; they prove nothing, but no box is tried that holds two of them."""

    stokes: np.ndarray
    angle: np.ndarray
    outcome: np.ndarray

    @classmethod
    def of(cls, scene: Scene, stokes: Sequence[float], angle: Sequence[float]) -> _Guide:
        parts = (np.arange(_POINTS) + 0.5) / _POINTS
        rows = np.exp([a + (b - a) * parts for a, b in itertools.pairwise(np.log(stokes))]).ravel()
        columns = np.concatenate([a + (b - a) * parts for a, b in itertools.pairwise(angle)])
        return cls(
            rows, columns, collide_many(scene, stokes=rows[:, None], angle=columns, of=("outcome",)).outcome.values
        )

    def expected(self, cell: Cell) -> int | None:
        """The outcome of the grid's points in a cell, or of the one next to it; None where there are two."""
        (low, high), (left, right) = (
            np.searchsorted(grid, ends) for grid, ends in ((self.stokes, cell.stokes), (self.angle, cell.angle))
        )
        last, end = (size - 1 for size in self.outcome.shape)
        inside = self.outcome[min(low, last) : max(high, low + 1), min(left, end) : max(right, left + 1)]
        return int(inside.flat[0]) if np.ptp(inside) == 0 else None


def _halves(cell: Cell, spread: str) -> tuple[Cell, Cell]:
    """Both halves, across the side that spreads trajectories more; unless it is known, by St and tan^2 of the angle."""
    (low, high), (flat, steep) = cell.stokes, cell.angle
    middle = 0.5 * (flat + steep)
    wider = math.log(high / low) * math.sin(middle) * math.cos(middle) > 2 * (steep - flat)
    by_stokes = wider if not spread else spread == "stokes"
    if by_stokes:
        between = math.sqrt(low * high)
        return cell._replace(stokes=(low, between)), cell._replace(stokes=(between, high))
    return cell._replace(angle=(flat, middle)), cell._replace(angle=(middle, steep))
