"""Tracing of boundaries: every Stokes number at which the outcome changes, angle by angle.

Each line is sampled by collisions until its margins are resolved (`samples`). Changes are bracketed by outcomes, and
accepted if collisions on both sides agree (`changes`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ..errors import ComputationError
from ..host.workers import usable_cores
from ..scene.scene import Scene
from .changes import Change, changes_along
from .samples import answers, first_grid, sampled
from .samples_by_kernel import PER_DECADE, SceneSampler

SHARPEST = 1e-13
_TOGETHER = 32  # lines traced together
_FINER, _SHARPER = 2, 1e-2  # for a line that failed once: factors of more samples and of a smaller tolerance
_HOLE = 4.5  # most initial spacings without a completed collision
_ROUNDED = 1.01  # factor on a spacing, for rounding
_SLOW = 8  # most missing collisions computed again at once


@dataclass
class Traced:
    """Changes and failures of consecutive angles, number of collisions, and resolution of the samples."""

    changes: list[tuple[Change, ...]]
    failures: list[str]
    collisions: int
    resolution: float

    def add(self, block: Traced) -> None:
        """Append the lines of another."""
        self.changes += block.changes
        self.failures += block.failures
        self.collisions += block.collisions
        self.resolution = max(self.resolution, block.resolution)


def trace(
    scene: Scene,
    angles: np.ndarray,
    span: tuple[float, float],
    rtol: float,
    tell: Callable[[int], None] = lambda _done: None,
) -> Traced:
    """Changes at angles (rad), one line each: sampled, located and confirmed together.

    A line that fails is sampled again, more finely and with a tolerance a hundred times smaller; if it fails again, its
    reason is recorded.
    """
    blocks = [angles[first : first + _TOGETHER] for first in range(0, angles.size, _TOGETHER)]
    whole = Traced([], [], 0, 0.0)

    def traced(block: np.ndarray) -> Traced:
        result = Traced([], [], 0, 0.0)
        result.changes, result.failures = _block(scene, block, span, rtol, 1, result)
        for k in [k for k, reason in enumerate(result.failures) if reason]:
            again = _block(scene, block[k : k + 1], span, max(rtol * _SHARPER, SHARPEST), _FINER, result)
            result.changes[k], result.failures[k] = again[0][0], again[1][0]
        return result

    with ThreadPoolExecutor(usable_cores()) as pool:  # the kernel releases the interpreter's lock
        for block in (pool.map if len(blocks) > 1 else map)(traced, blocks):
            whole.add(block)
            tell(len(whole.changes))
    return whole


def _block(
    scene: Scene, angles: np.ndarray, span: tuple[float, float], rtol: float, finer: int, traced: Traced
) -> tuple[list[tuple[Change, ...]], list[str]]:
    sampler = SceneSampler(scene, rtol)
    grid = first_grid(span, finer * PER_DECADE)
    changes: list[tuple[Change, ...]] = [()] * angles.size
    failures = [""] * angles.size
    complete, places, widths = [], [], []
    first = sampler(np.repeat(angles, grid.size), np.tile(grid, angles.size), first=True)
    for k, samples in enumerate(sampled(angles, first.reshape(angles.size, grid.size), sampler)):
        try:
            samples, widest = _completed(samples, grid, sampler, float(angles[k]))
        except ComputationError as error:
            failures[k] = str(error)
            continue
        complete.append(samples)
        places.append(k)
        widths.append(widest)
    traced_changes = changes_along(angles[places].tolist(), sampler, complete)
    for k, width, outcome_changes in zip(places, widths, traced_changes, strict=True):
        if isinstance(outcome_changes, ComputationError):
            failures[k] = str(outcome_changes)
        else:
            changes[k] = tuple(outcome_changes)
            traced.resolution = max(traced.resolution, width)
    traced.collisions += sampler.collisions
    return changes, failures


def _completed(samples: np.ndarray, grid: np.ndarray, sampler: SceneSampler, angle: float) -> tuple[np.ndarray, float]:
    """Samples of a line and their widest relative spacing; some missing ones are computed again with all steps.

    Raises:
        ComputationError: too many in a row are still missing.
    """
    spacing, hole = math.log(grid[1] / grid[0]), _ROUNDED
    while True:
        at, log_stokes = _spaced(samples, grid), np.log(samples["stokes"])
        place = np.clip(np.searchsorted(at, log_stokes), 1, at.size - 1)
        missing = np.flatnonzero((samples["outcome"] < 0) & (at[place] - at[place - 1] > hole * spacing))
        if not missing.size or hole == 0:
            break
        some = missing[np.unique(np.linspace(0, missing.size - 1, _SLOW).astype(int))]
        stokes = samples["stokes"][some]
        samples["outcome"][some] = sampler.outcomes(np.full(some.size, angle), stokes)
        sampler.untried.difference_update((angle, number) for number in stokes.tolist())
        hole = _HOLE if (samples["outcome"][some] >= 0).any() else 0
    widest = int(np.argmax(np.diff(at)))
    low, high = float(np.exp(at[widest])), float(np.exp(at[widest + 1]))
    if high > low * math.exp(_HOLE * spacing):
        places = samples["stokes"][missing]
        inside = places[(low < places) & (places < high)]
        untried = sampler.untried & {(angle, number) for number in inside.tolist()}
        tried = f" ({inside.size - len(untried)} of {inside.size} tried to the end)" if untried else ""
        reason = sampler.reason(angle, low, high)
        raise ComputationError(f"collisions between St {low:.4g} and {high:.4g} could not be computed{tried}: {reason}")
    return samples, high / low - 1


def _spaced(samples: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """Logarithms of the Stokes numbers of known samples, with the first and last of the grid."""
    return np.asarray(np.log(np.concatenate([grid[:1], answers(samples)["stokes"], grid[-1:]])))
