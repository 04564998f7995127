"""Averages of all pairs of sizes: in blocks on all cores; of many radii most pairs are interpolated between fewer.

The interpolation is a Chebyshev series in the logarithms of the radii.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import barycentric_interpolate

from ..errors import InputError
from ..host.cores import usable_cores
from ..host.progress import Progress
from ..host.workers import in_workers
from ..many.blocks import checkpoint
from ..many.impacts import fill, software
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .geometry import COLUMNS, SLOPES, over_angles
from .gradients import gradients, scales
from .over_speeds import means
from .sizes import experiment_of, scene_of_sizes, target
from .speeds import Speeds

_BLOCK = 32  # pairs that are computed together
_CUT, _SHARP_CUT = 1e-6, 1e-9  # width to which changes of sequence are enclosed, over the fastest speed; the derivative
# of a mean may grow as an inverse square root beside one
_OF_GRADIENTS = 100.0  # tolerance of derivatives, over that of the means
_OF_ONE = ("particles.radius", "particles.density")  # entries of one sphere of a pair, as those of its partner
_FINEST = 25  # nodes along an axis of the finest grid
_STEPS = (4, 2, 1)  # between the nodes of the grids, in those of the finest
_CHECKS = 32  # pairs that are computed beside the nodes, and compared with the interpolation
_POINTS = -np.cos(np.pi * np.arange(_FINEST) / (_FINEST - 1))

Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Request:
    """Averages as requested."""

    scene: Scene
    speeds: Speeds
    axes: dict[str, np.ndarray]
    films: str
    tolerance: float
    rtol: float
    wrt: tuple[str, ...]

    @property
    def sizes(self) -> np.ndarray:
        """Radii of the pairs, (pairs, axes)."""
        return np.array(list(product(*self.axes.values())))

    @property
    def symmetric(self) -> bool:
        """True if an exchange of the two spheres changes no result."""
        spins = self.scene.impact.spin, self.scene.impact.partner_spin
        equal_spins = spins[1] is None or spins[0] == spins[1]
        of_one_sphere = any(name in _OF_ONE or name.startswith("partner.") for name in self.wrt)
        return len(self.axes) == 2 and self.scene.partner is None and equal_spins and not of_one_sphere

    def scene_of(self, sizes: np.ndarray) -> Scene:
        """The scene of a pair; InputError if it is impossible."""
        if not sizes.size:
            entries = tuple((name, value) for name, value in self.scene.given if name not in MEETING)
            return Scene(self.scene.name, entries, package=self.scene.package)
        radius, *other = sizes.tolist()
        return scene_of_sizes(self.scene, radius, other[0] if other else None, self.films)

    def attributes(self) -> dict[str, Any]:
        return {"speeds": self.speeds.text, "films": self.films, "tolerance": self.tolerance, "rtol": self.rtol}

    def identity(self) -> dict[str, Any]:
        """Everything that the results depend on, as JSON values."""
        distribution = None if self.speeds.density is None else self.speeds.density(self.speeds.knots).tolist()
        return {
            **self.attributes(),
            "averages": self.scene.to_toml(),
            "distribution": [self.speeds.knots.tolist(), distribution],
            "axes": {name: axis.tolist() for name, axis in self.axes.items()},
            "wrt": list(self.wrt),
            **software(self.scene),
        }


def averages(request: Request, resume: Path | None, progress: Progress | None) -> Columns:
    """The columns of all pairs; arguments as of `collision_averages`."""
    matrix = _Matrix(request, progress or (lambda _done, _total: None))
    with checkpoint(resume, request.identity, matrix.columns, matrix.done, "pairs"):
        return matrix.complete()


class _Matrix:
    """The distinct pairs, those asked for and the nodes of the finest grid, and which of them are computed.

    Attributes:
        sizes: of the distinct pairs, (pairs, axes).
        asked: index of each pair that is asked for.
        nodes: index of each node of the finest grid, shaped as the grid; empty where nothing is interpolated.
    """

    def __init__(self, request: Request, progress: Progress) -> None:
        self.request, self.progress = request, progress
        axes = list(request.axes.values())
        many = bool(axes) and not request.wrt and axes[0].size > _FINEST
        grid = product(*([_from_unit(_POINTS, axis) for axis in axes] if many else [()]))
        every = np.array([*request.sizes.tolist(), *grid])
        if request.symmetric:
            every.sort(axis=1)
        self.sizes, place = np.unique(every, axis=0, return_inverse=True)
        self.asked, nodes = np.split(place.ravel(), [len(request.sizes)])
        self.nodes = nodes.reshape((_FINEST,) * len(axes) if many else 0)
        self.columns, self.done = _blank(len(self.sizes), len(request.wrt)), np.zeros(len(self.sizes), bool)

    def complete(self) -> Columns:
        """The columns of all pairs that are asked for, after the others are computed or interpolated."""
        wanted = np.unique(self.asked)
        if not (self.nodes.size and not self.done[wanted].all() and self._interpolated(wanted)):
            self._compute(wanted)
        return {name: values[self.asked] for name, values in self.columns.items()}

    def _compute(self, which: np.ndarray) -> None:
        rest = np.unique(which)
        rest = rest[~self.done[rest]]
        total = int(np.count_nonzero(self.done)) + rest.size
        self.progress(total - rest.size, total)
        for where, block in self._blocks([rest[k : k + _BLOCK] for k in range(0, rest.size, _BLOCK)]):
            fill(self.columns, where, block)
            self.done[where] = True
            self.progress(int(np.count_nonzero(self.done)), total)

    def _blocks(self, blocks: list[np.ndarray]) -> Iterator[tuple[np.ndarray, Columns]]:
        """Pairs and their columns: the first in this process, which compiles the kernel, many others on all cores."""
        cores = min(usable_cores(), len(blocks) - 1)
        run = partial(_block, self.request)
        nodes = self.nodes.ravel()  # their errors leave room for that of the interpolation
        parts = [(where, (self.sizes[where], 2 if np.isin(where, nodes).any() else 1)) for where in blocks]
        for where, arguments in parts[:1] if cores > 1 else parts:
            yield where, run(*arguments)
        if cores > 1:
            yield from in_workers(cores, run, parts[1:])

    def _interpolated(self, wanted: np.ndarray) -> bool:
        """Whether the pairs that are not computed are interpolated from nodes; others are computed to check it."""
        checks = np.random.default_rng(0).choice(wanted, min(_CHECKS, wanted.size), replace=False)
        axes = list(self.request.axes.values())
        first = np.zeros(len(self.sizes), int)
        first[self.asked[::-1]] = np.arange(self.asked.size)[::-1]  # of the pairs asked for, by distinct pair
        for step in _STEPS:
            nodes = self.nodes[(slice(None, None, step),) * len(axes)]
            if 2 * (np.unique(nodes).size + checks.size) > wanted.size:
                continue
            self._compute(nodes.ravel())
            self._compute(checks)
            mean, error = self.columns["mean"], self.columns["error"]
            value = _interpolate(mean[nodes], axes)
            apart = 2 * np.abs(value[first[checks]] - mean[checks]).max(axis=0)
            of_nodes = error[nodes].reshape(-1, COLUMNS).max(axis=0)
            if (apart <= np.maximum(self.request.tolerance / 2, of_nodes)).all():  # nor where any is NaN
                rest = wanted[~self.done[wanted]]
                try:
                    scenes = [self.request.scene_of(sizes) for sizes in self.sizes[rest]]
                except InputError:
                    return False
                mean[rest], error[rest] = value[first[rest]], of_nodes + apart
                self.columns["rate"][rest] = [self.request.speeds.mean * target(scene) for scene in scenes]
                self.progress(int(np.count_nonzero(self.done)), int(np.count_nonzero(self.done)))
                return True
        return False


def _from_unit(points: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Radii at points from -1 to 1 of the range of some radii."""
    low, high = np.log(radii.min()), np.log(radii.max())
    return np.asarray(np.exp(low + (high - low) * (1 + points) / 2))


def _interpolate(values: np.ndarray, axes: list[np.ndarray]) -> np.ndarray:
    """The values of every pair, (pairs, columns), from those at the nodes of a grid, with the columns last."""
    for k, radii in enumerate(axes):
        nodes = _from_unit(_POINTS[:: (_FINEST - 1) // (values.shape[k] - 1)], radii)
        values = barycentric_interpolate(np.log(nodes), values, np.log(radii), axis=k)
    return values.reshape(-1, values.shape[-1])


def _blank(size: int, parameters: int) -> Columns:
    columns: Columns = {name: np.full((size, COLUMNS), np.nan) for name in ("mean", "error")}
    columns |= {name: np.full((size, SLOPES, parameters), np.nan) for name in ("gradient", "gradient_error")}
    columns["rate"] = np.full(size, np.nan)
    return columns | {"reason": np.full(size, "", dtype=object)}


def _block(request: Request, sizes: np.ndarray, finer: float) -> Columns:
    """The columns of some pairs; `finer` divides the tolerance."""
    columns = _blank(len(sizes), len(request.wrt))
    scenes: dict[int, Scene] = {}
    for k, of_pair in enumerate(sizes):
        try:
            scenes[k] = request.scene_of(of_pair)
        except InputError as error:
            columns["reason"][k] = str(error)
        else:
            columns["rate"][k] = request.speeds.mean * target(scenes[k])
    rows = np.array(list(scenes), dtype=int)
    if not rows.size:
        return columns
    experiment = experiment_of(list(scenes.values()), request.wrt, request.rtol)
    tolerance, speeds = request.tolerance / finer, request.speeds
    along = partial(over_angles, experiment, speeds.moment(2))
    columns["mean"][rows], columns["error"][rows] = means(along, experiment, rows.size, speeds, tolerance, _CUT)
    failed = rows[np.isnan(columns["mean"][rows]).any(axis=1)]
    columns["reason"][failed] = "collisions that no engine completes"
    if request.wrt:
        of_gradients = _OF_GRADIENTS * tolerance
        slopes = means(partial(gradients, experiment), experiment, rows.size, speeds, of_gradients, _SHARP_CUT)
        unit = scales(experiment, np.arange(rows.size))[:, None]
        for name, slope in zip(("gradient", "gradient_error"), slopes, strict=True):
            columns[name][rows] = slope.reshape(rows.size, SLOPES, -1) / unit
    return columns
