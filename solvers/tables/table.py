"""`table`: a collision law as Chebyshev series between traced boundaries, attacked before it is returned."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.choice import collision_engine
from ..engines.settings import RTOL, check_rtol
from ..errors import ComputationError, InputError
from ..host.arguments import check_function, check_mapping, check_names, check_whole
from ..host.pictures import Drawn
from ..host.progress import Estimated, Progress
from ..many.batch import ascending, checked_numbers, checked_span, checked_vary
from ..model.validity import warn
from ..scene.scene import Scene
from ..scene.schema import Field
from ..scene.schema import Range as Interval
from .attack import attack as attacked
from .build import Builder
from .data import ANGLE, STOKES, Attack, Law, Range
from .read import read
from .slices import Slicer

if TYPE_CHECKING:
    import xarray

RESULTS = ("restitution", "tangential_restitution", "rotation")
"""Results that a table may have."""
ATTACK = 1_000_000  # default number of queries
_SHORT = {"stokes": STOKES, "angle": ANGLE}
_ERROR = Field("error", "an error", "1e-4", Interval("from 1e-7 to 0.1", 1e-7, 0.1, low_open=False, high_open=False))
_DOUBLE_BELOW = 1e-5  # error below which results are kept in double precision
_SHARPER = 0.3  # factor of the tolerance after an attack that was lost
_ATTEMPTS = 3
_LEAST_UNBOUND = 1e-3  # rad; without attraction e_n tends to 0 with a power of the angle
_ACCEPTED = '{"stokes": (LO, HI), "angle": (LO, HI)}, and at most one other numeric entry by its dotted name'


@dataclass(frozen=True)
class Table(Law, Drawn):
    """A collision law as a table, as `table` returns it; its attributes are those of `Law`.

    `plot` draws restitution, boundaries and patches.

    Example:
        >>> from wetdoublet.solvers import table
        >>> law = table("granulation", over={"stokes": (0.15, 0.2), "angle": (0.3, 0.4)}, error=1e-3, attack=2000)
        >>> law([0.17, 0.3], 0.35).outcome.values  # a bounce, and an impact outside
        array([ 2, -1])
    """

    _picture = "tables.plot.draw"

    def __call__(self, stokes: Any, angle: Any, third: Any = None, slopes: bool = False) -> xarray.Dataset:
        """Outcome and results at impacts.

        Arguments:
            stokes: Stokes numbers.
            angle: impact angles in rad.
            third: the third variable, SI, if the table has one. All are broadcast against each other.
            slopes: also derivatives by each variable, others held.

        Returns:
            Dataset over `collision`: outcome (-1 outside the table's ranges), results, and with `slopes` a variable
            `d_NAME` for each, over `wrt`, the names of the variables. A stick has restitution 0, and NaN otherwise.

        Raises:
            InputError: no numbers, or a third variable that is missing or unknown.
        """
        from .labelled import answers

        if (third is None) != (self.range.third is None):
            raise InputError(self.range.third or "third", third, "a third variable where the table has one, else none")
        known = [checked_numbers(STOKES, stokes, most=None), checked_numbers(ANGLE, angle, most=None)]
        if self.range.third is not None:
            field = self.scene.fields[self.range.third]
            known.append(checked_numbers(self.range.third, third, field, None))
        try:
            columns = [np.ravel(one) for one in np.broadcast_arrays(*known)]
        except ValueError:
            sizes = ", ".join(str(one.size) for one in known)
            raise InputError("stokes", sizes, "sizes that numpy can broadcast", "differ in size") from None
        at = columns[2] if len(columns) > 2 else np.full(columns[0].size, 0.5)
        with np.errstate(divide="ignore", invalid="ignore"):
            height, place = np.log(columns[0]), np.log(at) if self.range.logarithmic else at
        read_values = read(self.data, place, columns[1], height, slopes)
        return answers(self, columns, read_values, slopes)

    def to_dataset(self) -> xarray.Dataset:
        """The table's arrays with its scene, ranges and errors as attributes; what `save` writes."""
        from .store import dataset

        return dataset(self)

    def save(self, path: str | FilePath) -> None:
        """Write the table: `.nc` (NetCDF), or `.h` (C99, data and reader).

        Raises:
            InputError: a file of another kind. OSError: it cannot be written.
        """
        from .store import save

        save(self, path)

    @classmethod
    def load(cls, path: str | FilePath) -> Table:
        """Read a table that `save` has written as NetCDF. InputError if the file is none."""
        from .store import load

        return cls(**vars(load(path)))

    def __str__(self) -> str:
        from .labelled import text

        return text(self)


def table(
    scene: Scene | str | FilePath,
    *,
    over: Mapping[str, Sequence[Any]],
    error: float = 1e-4,
    of: Sequence[str] = ("restitution", "tangential_restitution"),
    rtol: float = RTOL,
    attack: int = ATTACK,
    progress: Progress | None = None,
) -> Table:
    """A table of the collision law of a scene, whose error was looked for.

    Arguments:
        scene: a Scene, a path or a preset's name.
        over: ranges (LO, HI) of `stokes`, `angle` (rad, or text with a unit) and at most one numeric entry.
        error: largest error of a result, over its magnitude where that is above 1.
        of: results of collisions that separate: restitution, tangential_restitution, rotation.
        rtol: relative tolerance of the collisions.
        attack: number of queries that are held against collisions, random ones and ones beside boundaries. An answer
            holds if the kernel gives it at some impact within 1e-6 relative.
        progress: called with (queries held against collisions, queries in all); with 0 while the series are made. A
            second attempt adds its queries to both.

    Returns:
        Table.

    Raises:
        InputError: an invalid range, name or number.
        ComputationError: the law could not be tabulated to this error, with the place; nothing is returned then.

    Example:
        >>> from wetdoublet.solvers import table
        >>> law = table("granulation", over={"stokes": (0.15, 0.2), "angle": (0.3, 0.4)}, error=1e-3, attack=2000)
        >>> law.found.largest < 1e-3
        True
    """
    loaded = Scene.load(scene)
    loaded, ranges = _ranges(loaded, over)
    tolerance = _ERROR.number(error)
    kept, rtol = check_names(of, RESULTS, "of"), check_rtol(rtol)
    count = check_whole(attack, "attack", 1, 10**9)
    check_function(progress, "progress")
    _check_supported(loaded, ranges)
    warn(loaded)
    work = Estimated(progress, count)
    made = _made(loaded, ranges, tolerance, kept, rtol, count, work)
    work.finish()
    return made


def _made(
    scene: Scene, ranges: Range, error: float, of: tuple[str, ...], rtol: float, count: int, work: Estimated
) -> Table:
    doubts, tolerance = np.zeros((0, 3)), error
    for attempt in range(_ATTEMPTS):
        work.start(count if attempt else 0)
        slicer = Slicer(scene, ranges, rtol, of, doubts, work.start)
        builder = Builder(slicer.signatures, of, tolerance, work.start)
        slicer.fill(builder)
        data = builder.data(*ranges.corners, ranges.logarithmic, np.float64 if error < _DOUBLE_BELOW else np.float32)
        attack = attacked(data, scene, ranges.third, of, error, rtol, count, attempt + 1, work.add)
        if not attack.failed:
            return Table(scene, of, ranges, error, attack, rtol, data)
        doubts = np.vstack([doubts, [place for place, _ in attack.failures]])
        tolerance *= _SHARPER
    raise _lost(ranges, error, attack, slicer.failures)


def _lost(ranges: Range, error: float, attack: Attack, remarks: list[str]) -> ComputationError:
    place, text = attack.failures[0]
    more = f"; {remarks[0]}" if remarks else ""
    third = "" if ranges.third is None else f", {ranges.third} {place[0]:.6g} (SI)"
    return ComputationError(
        f"the table does not hold to {error:g}: {attack.failed} of {attack.queries} answers are wrong, the first at"
        f" {math.degrees(place[1]):.8g} deg, St {place[2]:.8g}{third}: {text}{more}",
        advice="leave that place out of the ranges, or ask for a larger error",
    )


def _ranges(scene: Scene, over: object) -> tuple[Scene, Range]:
    ranges = check_mapping(over, "over", _ACCEPTED)
    named = {_SHORT.get(name, name): ends for name, ends in ranges.items()}
    for name in (STOKES, ANGLE):
        if name not in named:
            problem = f"comes without a range of {name.partition('.')[2]}"
            raise InputError("over", ", ".join(ranges) or None, _ACCEPTED, problem)
    others = [name for name in named if name not in (STOKES, ANGLE)]
    if len(others) > 1 or len(named) != len(ranges):
        raise InputError("over", ", ".join(ranges), _ACCEPTED, "has too many variables")
    stokes, angle = (checked_span(name, named[name]) for name in (STOKES, ANGLE))
    if not others:
        return scene, Range(None, (0.0, 1.0), angle, stokes)
    scene, varied = checked_vary(scene, {others[0]: named[others[0]]}, "over")
    ends = ascending(others[0], varied[others[0]])
    for end in ends:
        scene.with_si({others[0]: end})  # the scene validates it
    return scene, Range(others[0], ends, angle, stokes)


def _check_supported(scene: Scene, ranges: Range) -> None:
    """Raise an error for a scene that cannot be tabulated at all."""
    if collision_engine(scene) != "taylor":
        raise ComputationError(
            "a table takes millions of collisions, and there is no Taylor kernel of this scene",
            advice="install a C compiler, or use laws that the kernel has",
        )
    if scene.package is not None and scene.package.events:
        raise InputError("SCENE", scene.name, "a model without declared events", "has events of its own")
    bound = scene.bridge is not None or scene.pendulum is not None or scene.attraction is not None
    if not bound and ranges.angle[0] < _LEAST_UNBOUND:
        accepted = (
            f"an angle of at least {_LEAST_UNBOUND:g} rad: without attraction e_n falls to 0 towards head-on impact"
        )
        raise InputError(ANGLE, ranges.angle[0], accepted, "is too small")
