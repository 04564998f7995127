"""Boundaries between outcomes, traced: every Stokes number at which the outcome changes, angle by angle.

Each line is sampled by collisions until its margins are resolved (`samples`); the changes that show are located by
functions that are smooth through them (`probe`), and accepted if collisions on either side agree (`changes`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.taylor.build import knows
from ..errors import ComputationError, InputError
from ..host.arguments import check_function
from ..host.cores import usable_cores
from ..host.workers import lasting_workers
from ..many.batch import checked_numbers, checked_span
from ..model.validity import warn
from ..scene.scene import Scene
from ..settings import RTOL, check_rtol
from .changes import MERGED, Change, changes_between
from .line import Line
from .look import Look, blank
from .samples import first_grid, known, merged, sampled

if TYPE_CHECKING:
    import xarray

_LARGEST = 1e30  # Stokes number, and its inverse the least
STOKES = (1e-4, 100.0)
SHARPEST = 1e-13
_WORTH, _WORTH_BY_KERNEL = 4, 100  # angles that are worth starting a process for
_TOGETHER = 16  # lines that are sampled together
_FINER, _SHARPER = 2, 1e-2  # a line that fails once: more samples, and a tolerance that is so much smaller
_HOLE = 4.5  # spacings of the first grid over which collisions may be missing
_ROUNDED = 1.01  # times a spacing, which is rounded
_CREEPING = 0.1  # of the samples of a line: where the kernel hands over more for creeping, Rosenbrock samples the line
_SLOW = 8  # collisions that are asked for again where more are missing


@dataclass(frozen=True)
class Boundaries:
    """Changes of outcome for each angle (rad), ascending in St.

    Attributes:
        collisions: how many had to be integrated.
        failures: the reason of each line that could not be traced (its changes are then empty), else "".
        resolution: relative spacing of the Stokes numbers at which every line was looked at. A strip of an outcome that
            is wider is seen; a narrower one is where a margin (of a rebound criterion, of the escape) shows it.
        scene, window: whose boundaries they are, and the Stokes numbers between which they were looked for.
    """

    angles: tuple[float, ...]
    changes: tuple[tuple[Change, ...], ...]
    collisions: int
    failures: tuple[str, ...] = ()
    resolution: float = 0.0
    scene: Scene | None = field(default=None, repr=False)
    window: tuple[float, float] = STOKES

    @property
    def failed(self) -> tuple[tuple[float, str], ...]:
        """Angle and reason of the lines that could not be traced."""
        return tuple(pair for pair in zip(self.angles, self.failures, strict=True) if pair[1])

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --json`."""
        return {"angles": list(self.angles), "changes": [[one.to_dict() for one in line] for line in self.changes]}

    def to_dataset(self) -> xarray.Dataset:
        """Labelled, units in attributes: over `line` and `change`, padded with NaN (see docs/results.md)."""
        from .labelled import dataset

        return dataset(self)

    def plot(self, file: str | FilePath) -> None:
        """Draw a picture (.png, .pdf or .svg): the regions of each outcome, the curves and where they meet."""
        from .plot import plot

        plot(self, file)

    def __str__(self) -> str:
        lines = ["angle (deg)   St              Ce          change"]
        for angle, changes in zip(self.angles, self.changes, strict=True):
            for one in changes:
                ce = "-" if one.centrifugal is None else f"{one.centrifugal:.6g}"
                lines.append(f"{math.degrees(angle):<13.6g} {one.stokes:<15.10g} {ce:<11} {one.before} -> {one.after}")
            if not changes:
                failure = next((reason for at, reason in self.failed if at == angle), "no change")
                lines.append(f"{math.degrees(angle):<13.6g} {failure}")
        points = sum(len(changes) for changes in self.changes)
        merged = sum(one.merged for line in self.changes for one in line)
        lines += [f"{merged} of the changes stand for several closer than {MERGED:g}"] if merged else []
        looked = f"; strips narrower than {self.resolution:.1%} of St are seen where a margin shows them"
        return "\n".join([*lines, f"{points} changes from {self.collisions} collisions{looked}"])


@dataclass
class Traced:
    """Changes and failures of consecutive angles, the collisions they took, and how finely they were sampled."""

    changes: list[tuple[Change, ...]]
    failures: list[str]
    collisions: int
    resolution: float


def boundary(
    scene: Scene | str | FilePath,
    *,
    angle: Any = None,
    stokes: tuple[float, float] = STOKES,
    rtol: float = RTOL,
    progress: Callable[[int], None] | None = None,
) -> Boundaries:
    """Every change of outcome along lines of constant angle.

    Arguments:
        scene: a Scene, a path or a preset's name.
        angle: impact angles in rad, a number or 1-D; default the scene's. Traced in ascending order.
        stokes: lowest and highest Stokes number.
        rtol: relative tolerance of the integrations.
        progress: called with the number of angles done.

    Returns:
        Boundaries, in the order of the angles given.

    Raises:
        InputError: an angle or Stokes number that cannot be. A line that fails is no error, it is marked.

    Example:
        >>> from wetdoublet.solvers import boundary
        >>> [round(one.stokes, 6) for one in boundary("granulation", angle=0.9599310885968813).changes[0]]
        [0.034232, 0.118639]
    """
    loaded = Scene.load(scene)
    angles = checked_numbers("impact.angle", loaded.angle if angle is None else angle).reshape(-1)
    low, high = checked_span("impact.stokes", stokes)
    if low < 1 / _LARGEST or high > _LARGEST:
        raise InputError("impact.stokes", f"{low}:{high}", f"from {1 / _LARGEST:g} to {_LARGEST:g}", "is too far off")
    rtol, tell = check_rtol(rtol), check_function(progress, "progress") or (lambda _done: None)
    warn(loaded)
    order = np.argsort(angles, kind="stable")
    worth = _WORTH_BY_KERNEL if knows(loaded) else _WORTH
    cores = min(usable_cores(), max(1, angles.size // worth))
    parts = np.array_split(angles[order], cores)
    whole = Traced([], [], 0, 0.0)
    for part in _traces(loaded, parts, (low, high), rtol, tell):
        whole.changes += part.changes
        whole.failures += part.failures
        whole.collisions += part.collisions
        whole.resolution = max(whole.resolution, part.resolution)
        tell(len(whole.changes))
    back = np.argsort(order, kind="stable")
    return Boundaries(
        tuple(angles.tolist()),
        tuple(whole.changes[k] for k in back),
        whole.collisions,
        tuple(whole.failures[k] for k in back),
        whole.resolution,
        loaded,
        (low, high),
    )


def _traces(
    scene: Scene, parts: Sequence[np.ndarray], span: tuple[float, float], rtol: float, tell: Callable[[int], None]
) -> Iterator[Traced]:
    """All parts in their order: the first in this process, which `tell` is told of, the others in one each."""
    if len(parts) == 1:
        yield trace(scene, parts[0], span, rtol, tell)
        return
    with lasting_workers(len(parts) - 1) as pool:
        others = [pool.submit(trace, scene, part, span, rtol) for part in parts[1:]]
        yield trace(scene, parts[0], span, rtol, tell)
        for other in others:
            yield other.result()


def trace(
    scene: Scene,
    angles: np.ndarray,
    span: tuple[float, float],
    rtol: float,
    tell: Callable[[int], None] = lambda _done: None,
    kernel: bool | None = None,
) -> Traced:
    """Changes at angles (rad), a line each: sampled together, then located and confirmed one by one.

    A line that fails is sampled again, more finely and a hundred times sharper; then it is left out with its reason.

    Arguments:
        kernel: let the Taylor kernel integrate; default: if it can. Without it a line has fewer samples.
    """
    traced = Traced([], [], 0, 0.0)
    for first in range(0, angles.size, _TOGETHER):
        block = angles[first : first + _TOGETHER]
        changes, failures = _block(scene, block, span, rtol, 1, traced, kernel)
        for k in [k for k, reason in enumerate(failures) if reason]:
            again = _block(scene, block[k : k + 1], span, max(rtol * _SHARPER, SHARPEST), _FINER, traced, kernel)
            changes[k], failures[k] = again[0][0], again[1][0]
        traced.changes += changes
        traced.failures += failures
        tell(len(traced.changes))
    return traced


def _block(
    scene: Scene,
    angles: np.ndarray,
    span: tuple[float, float],
    rtol: float,
    finer: int,
    traced: Traced,
    kernel: bool | None,
) -> tuple[list[tuple[Change, ...]], list[str]]:
    look = Look(scene, rtol, kernel)
    grid = first_grid(span, finer * look.per_decade)
    changes: list[tuple[Change, ...]] = []
    failures: list[str] = []
    for angle, samples in zip(angles.tolist(), sampled(angles, grid, look), strict=True):
        if kernel is None and look.creeping[angle] > _CREEPING * grid.size:
            alone = _block(scene, np.array([angle]), span, rtol, finer, traced, False)
            changes += alone[0]
            failures += alone[1]
            continue
        line = Line(scene, angle, rtol, kernel)
        try:
            samples, widest = _completed(samples, grid, look, angle)
            changes.append(tuple(changes_between(line, look, samples)))
            failures.append("")
            traced.resolution = max(traced.resolution, widest)
        except ComputationError as error:
            changes.append(())
            failures.append(str(error))
        traced.collisions += line.collisions
    traced.collisions += look.collisions
    return changes, failures


def _completed(samples: np.ndarray, grid: np.ndarray, look: Look, angle: float) -> tuple[np.ndarray, float]:
    """Samples of a line and their widest relative spacing; some that are missing are asked for with more patience.

    Raises:
        ComputationError: too many in a row are missing still.
    """
    spacing = math.log(grid[1] / grid[0])
    at = _spaced(samples, grid)
    missing = samples["stokes"][samples["outcome"] < 0]
    place = np.clip(np.searchsorted(at, np.log(missing)), 1, at.size - 1)
    missing = missing[at[place] - at[place - 1] > _ROUNDED * spacing]
    if missing.size:
        some = missing[np.unique(np.linspace(0, missing.size - 1, _SLOW).astype(int))]
        found = blank(some)
        found["outcome"] = look.outcomes(np.full(some.size, angle), some)["outcome"]
        samples = merged(samples, found)
        at = _spaced(samples, grid)
    widest = int(np.argmax(np.diff(at)))
    low, high = float(np.exp(at[widest])), float(np.exp(at[widest + 1]))
    if high > low * math.exp(_HOLE * spacing):
        reason = look.reason(angle, low, high)
        raise ComputationError(f"collisions between St {low:.4g} and {high:.4g} could not be computed: {reason}")
    return samples, high / low - 1


def _spaced(samples: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """Logarithms of the Stokes numbers of known samples, from the first of the grid to its last."""
    spaced: np.ndarray = np.log(np.concatenate([grid[:1], known(samples)["stokes"], grid[-1:]]))
    return spaced
