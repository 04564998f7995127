"""`prove_map`: a regime map whose cells are proved, by halving those that are not, down to a sliver that is left."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...generated.automaton import OUTCOMES, ROTATE
from ..engines.interval.build import NotProvable
from ..engines.interval.call import BOX, Range, enclose
from ..engines.interval.inputs import COMPUTED, Inputs, outward
from ..errors import ComputationError, InputError
from ..host.pictures import Drawn
from ..host.workers import usable_cores
from ..many.collide_many import collide_many
from ..results import outcome_attributes
from ..scene.held import AXIS_LABELS
from ..scene.items import item
from ..scene.origin import Result, provenance
from ..scene.scene import Scene

if TYPE_CHECKING:
    import xarray

DEPTH = 12  # halvings of a cell
_POINTS = 6  # collisions along each side of a cell that say where a proof is worth a try
_BOUNDED = 1.01  # narrower boxes are followed in steps at once
_ROTATE = OUTCOMES.index(ROTATE)
UNDECIDED = -1


class Cell(NamedTuple):
    """A box of impacts, and the outcome of all its collisions by number; -1 is undecided.

    Arguments:
        speed: low and high of what `by` names: "stokes", "speed" or "relative_speed" (m/s).
        angle: low and high, rad.
    """

    speed: Range
    angle: Range
    outcome: int
    by: str = "stokes"

    @property
    def area(self) -> float:
        """Its area over the logarithm of the Stokes number or the speed, and the angle."""
        return math.log(self.speed[1] / self.speed[0]) * (self.angle[1] - self.angle[0])

    def stokes(self, per_speed: float) -> Range:
        """A range of Stokes numbers that holds those of all impacts, from St over the normal speed."""
        if self.by == "stokes":
            return self.speed
        steep, flat = (math.cos(angle) if self.by == "relative_speed" else 1.0 for angle in reversed(self.angle))
        return outward(self.speed[0] * steep * per_speed, self.speed[1] * flat * per_speed, COMPUTED)

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON object of a map: the outcome in words, null for one that is undecided."""
        word = None if self.outcome == UNDECIDED else OUTCOMES[self.outcome]
        return {self.by: self.speed, "angle": self.angle, "outcome": word}


class ProvedMap(Result, Drawn):
    """Cells that cover a rectangle of Stokes numbers or speeds, and angles, each with one proved outcome, or undecided.

    Example:
        >>> from wetdoublet.solvers import prove_map
        >>> prove_map("granulation", stokes=[0.3, 0.301], angle=[0.35, 0.351]).shares["bounce"]
        1.0
    """

    _picture = "boundaries.plot_proved.draw"
    _keys = "shares undecided_area proofs cells"

    scene: Scene
    cells: tuple[Cell, ...] = item("of any size, as far as they had to be halved")
    proofs: int = item("collisions in a box that were enclosed")
    depth: int = item("halvings of a cell", default=DEPTH)

    @property
    def shares(self) -> dict[str, float]:
        """The part of the area with each outcome, and "undecided"; over ln(St), or that of the speed, and the angle."""
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
        """A Dataset over `cell`: `outcome`, ends of `stokes` or the speed, and `angle` (rad); `undecided_area`."""
        import xarray

        by = self.cells[0].by
        ends = {
            name: (("cell", "end"), np.array([cell.to_dict()[name] for cell in self.cells]), {"units": unit})
            for name, unit in ((by, "1" if by == "stokes" else "m/s"), ("angle", "rad"))
        }
        outcome = ("cell", self.outcome, outcome_attributes("proved outcome", "undecided"))
        attributes = provenance(self.scene, undecided_area=self.undecided_area)
        return xarray.Dataset({"outcome": outcome, **ends}, attrs=attributes)

    def __str__(self) -> str:
        lines = [f"{100 * share:8.3f} %  {name}" for name, share in self.shares.items()]
        lines = [f"{len(self.cells)} cells, {self.proofs} boxes enclosed; shares of the area:", *lines]
        if self.undecided_area:
            lines.append(f"undecided cells were halved {self.depth} times; a larger depth leaves less undecided")
        return "\n".join(lines)


def prove_map(
    scene: Scene | str | Path,
    *,
    stokes: Sequence[float] | None = None,
    angle: Sequence[float],
    speed: Sequence[float] | None = None,
    relative_speed: Sequence[float] | None = None,
    depth: int = DEPTH,
    progress: Callable[[int, int], None] | None = None,
) -> ProvedMap:
    """Prove the outcome of every impact of a rectangle, cell by cell.

    A cell that is not proved is halved, up to `depth` times; what is left then is undecided, and drawn as such.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name; its impact is not used.
        stokes: edges of the cells, rising Stokes numbers.
        angle: edges of the cells, rising angles from 0 on, rad; a cell from 0 on holds head-on impacts, too.
        speed: edges of the cells in place of Stokes numbers, rising normal speeds, m/s.
        relative_speed: edges in their place, rising magnitudes of the relative velocity.
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
    given = {name: edges for name, edges in zip(AXIS_LABELS, (speed, stokes, relative_speed)) if edges is not None}
    if len(given) != 1:
        raise InputError("stokes", list(given) or None, "edges of one of stokes, speed, relative_speed")
    [(by, speeds)] = given.items()
    for name, edges in ((by, speeds), ("angle", angle)):
        if len(edges) < 2 or any(not low < high for low, high in itertools.pairwise(edges)):
            raise InputError(name, [*map(float, edges)] or None, "at least two rising edges of cells, as LO:HI:N")
    if isinstance(depth, bool) or not isinstance(depth, int) or not 0 <= depth <= 40:
        raise InputError("depth", depth, "a whole number from 0 to 40")
    loaded = Scene.load(scene)
    for k in (0, -1):
        admissible = loaded.with_impact(angle=float(angle[k]), **{by: float(speeds[k])})
    loaded, per_speed = loaded.with_impact(stokes=admissible.stokes, angle=admissible.angle), loaded.stokes_per_speed
    inputs = Inputs.of(loaded, {"impact.stokes": 1e-6, "impact.angle": 1e-6})
    try:
        engine = inputs.engine()
    except NotProvable as error:
        raise ComputationError(f"not provable here: {error}") from None
    if progress is not None:
        progress(0, (len(speeds) - 1) * (len(angle) - 1))
    guide = _Guide.of(loaded, by, speeds, angle)
    asked = 0

    def decided(cell: Cell, levels: int) -> Iterator[tuple[Cell, bool]]:
        expected, spread = guide.expected(cell), ""
        if expected is not None or not levels:
            stokes = cell.stokes(per_speed)
            ranges = {**inputs.ranges, "stokes": stokes, "angle": cell.angle}
            narrow = stokes[1] < stokes[0] * _BOUNDED
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

    pairs = [list(zip(map(float, edges), map(float, edges[1:]), strict=False)) for edges in (speeds, angle)]
    start = [Cell(span, other, UNDECIDED, by) for span in pairs[0] for other in pairs[1]]
    cells: list[Cell] = []
    with ThreadPoolExecutor(usable_cores()) as pool:  # the engine is called without the interpreter's lock
        for done, decisions in enumerate(pool.map(whole, start), 1):
            asked += len(decisions)
            cells += [cell for cell, decides in decisions if decides]
            if progress is not None:
                progress(done, len(start))
    return ProvedMap(loaded, tuple(cells), asked, depth)


class _Guide(NamedTuple):
    """Outcomes of collisions on a grid; they prove nothing, but no box is tried that holds two of them."""

    speed: np.ndarray
    angle: np.ndarray
    outcome: np.ndarray

    @classmethod
    def of(cls, scene: Scene, by: str, speeds: Sequence[float], angle: Sequence[float]) -> _Guide:
        parts = (np.arange(_POINTS) + 0.5) / _POINTS
        rows = np.exp([a + (b - a) * parts for a, b in itertools.pairwise(np.log(speeds))]).ravel()
        columns = np.concatenate([a + (b - a) * parts for a, b in itertools.pairwise(angle)])
        impacts: dict[str, Any] = {by: rows[:, None], "angle": columns}
        return cls(rows, columns, collide_many(scene, of=("outcome",), **impacts).outcome.values)

    def expected(self, cell: Cell) -> int | None:
        """The outcome of the grid's points in a cell, or of the one next to it; None where there are two."""
        (low, high), (left, right) = (
            np.searchsorted(grid, ends) for grid, ends in ((self.speed, cell.speed), (self.angle, cell.angle))
        )
        last, end = (size - 1 for size in self.outcome.shape)
        inside = self.outcome[min(low, last) : max(high, low + 1), min(left, end) : max(right, left + 1)]
        return int(inside.flat[0]) if np.ptp(inside) == 0 else None


def _halves(cell: Cell, spread: str) -> tuple[Cell, Cell]:
    """Both halves, across the side that spreads trajectories more; unless it is known, by St and tan^2 of the angle."""
    (low, high), (flat, steep) = cell.speed, cell.angle
    middle = 0.5 * (flat + steep)
    wider = math.log(high / low) * math.sin(middle) * math.cos(middle) > 2 * (steep - flat)
    by_speed = wider if not spread else spread == "stokes"
    if by_speed:
        between = math.sqrt(low * high)
        return cell._replace(speed=(low, between)), cell._replace(speed=(between, high))
    return cell._replace(angle=(flat, middle)), cell._replace(angle=(middle, steep))
