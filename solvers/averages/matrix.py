"""Averages of all pairs of sizes, in blocks on all cores."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import chain, product
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..host.cores import usable_cores
from ..host.progress import Progress
from ..host.workers import in_workers
from ..many.blocks import checkpoint
from ..many.impacts import fill, software
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .geometry import COLUMNS, over_angles
from .over_speeds import means
from .sizes import experiment_of, scene_of_sizes, target
from .speeds import Speeds

_BLOCK = 32  # pairs that are computed together

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

    @property
    def sizes(self) -> np.ndarray:
        """Radii of the pairs, (pairs, axes)."""
        return np.array(list(product(*self.axes.values())))

    @property
    def symmetric(self) -> bool:
        """True if an exchange of the two spheres changes no result."""
        spins = self.scene.impact.spin, self.scene.impact.partner_spin
        return len(self.axes) == 2 and self.scene.partner is None and spins[1] in (None, spins[0])

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
            **software(self.scene),
        }


def averages(request: Request, resume: Path | None, progress: Progress | None) -> Columns:
    """The columns of all pairs; arguments as of `collision_averages`."""
    pairs, tell = request.sizes, progress or (lambda _done, _total: None)
    if request.symmetric:
        pairs.sort(axis=1)
    sizes, place = np.unique(pairs, axis=0, return_inverse=True)
    columns, done = _blank(len(sizes)), np.zeros(len(sizes), bool)
    run = partial(_block, request)
    with checkpoint(resume, request.identity, columns, done, "pairs"):
        rest = np.flatnonzero(~done)
        tell(len(sizes) - rest.size, len(sizes))
        parts = [(where, (sizes[where],)) for where in (rest[k : k + _BLOCK] for k in range(0, rest.size, _BLOCK))]
        cores = min(usable_cores(), len(parts) - 1)
        here = parts[:1] if cores > 1 else parts  # the first in this process, which compiles the kernel
        computed = ((where, run(*arguments)) for where, arguments in here)
        for where, block in chain(computed, in_workers(cores, run, parts[1:]) if cores > 1 else ()):
            fill(columns, where, block)
            done[where] = True
            tell(int(np.count_nonzero(done)), len(sizes))
    return {name: values[place.ravel()] for name, values in columns.items()}


def _blank(size: int) -> Columns:
    columns: Columns = {name: np.full((size, COLUMNS), np.nan) for name in ("mean", "error")}
    return columns | {"rate": np.full(size, np.nan), "reason": np.full(size, "", dtype=object)}


def _block(request: Request, sizes: np.ndarray) -> Columns:
    """The columns of some pairs."""
    columns = _blank(len(sizes))
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
    experiment, speeds = experiment_of(list(scenes.values()), request.rtol), request.speeds
    along = partial(over_angles, experiment, speeds.moment(2))
    columns["mean"][rows], columns["error"][rows] = means(along, experiment, rows.size, speeds, request.tolerance)
    failed = rows[np.isnan(columns["mean"][rows]).any(axis=1)]
    columns["reason"][failed] = "collisions that no engine completes"
    return columns
