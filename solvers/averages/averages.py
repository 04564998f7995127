"""`collision_averages()`: outcomes and restitution averaged over impact geometry and speeds, for pairs of sizes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import chain, product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.settings import RTOL, check_rtol
from ..errors import InputError
from ..host.arguments import check_function, check_name
from ..host.files import check_file
from ..host.progress import Progress
from ..host.workers import in_workers, usable_cores
from ..many.arguments import checked_numbers, first_accepted
from ..many.blocks import checkpoint
from ..many.impacts import Block, fill, software
from ..model.validity import warn
from ..scene.fields import Field, Range
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .dataset import dataset
from .geometry import COLUMNS
from .over_speeds import means
from .sizes import FILMS, FIXED, experiment_of, scene_of_sizes, target
from .speeds import Speeds

if TYPE_CHECKING:
    import xarray

MOST = 400  # radii
_TOLERANCE = Field("tolerance", "an error", "1e-6", Range("from 1e-9 to 1e-2", 1e-9, 1e-2, False, False))
_BLOCK = 32  # pairs that are computed together


def collision_averages(
    scene: Scene | str | Path,
    *,
    speeds: Any = None,
    radii: Any = None,
    films: str = FIXED,
    tolerance: float = 1e-6,
    rtol: float = RTOL,
    progress: Progress | None = None,
    resume: str | Path | None = None,
) -> xarray.Dataset:
    """Sticking probability and mean restitution over all collisions of a gas, for each pair of sizes.

    The direction of the relative velocity is isotropic, so that impact angles have the density sin(2 theta); its
    magnitude has the distribution `speeds`. The normal speed of a collision is V cos(theta). Spins are the scene's.

    Arguments:
        scene: a Scene, a path or a preset's name; its [impact] has no influence but for its spins.
        speeds: relative speeds V of the collisions: one, in m/s or as text; `"maxwell:0.3 m/s"`, those of a gas whose
            velocities have components of this standard deviation, weighted by their flux; a CSV file with the header
            `relative_speed,density`, or two arrays. Default the scene's relative speed.
        radii: radii (m) of the spheres; every pair of them is computed, beside a wall each radius. Default the scene's
            own pair. Densities are those of the scene.
        films: "fixed", the default: the film and the roughness are the scene's for every pair; "proportional": both
            grow with the sum of the radii, a coating with its sphere, a volume in m^3 with the cube of the sum.
        tolerance: absolute error of the quadrature, of the shares and of the means over all collisions. From 1e-9 to
            1e-2. Means over those that separate have it divided by their share.
        rtol: relative tolerance of the collisions, 1e-13..1e-3.
        progress: called with (pairs done, pairs in all) at the start and after every block.
        resume: where an interrupt leaves the finished pairs: in RESUME.KEY.partial, which the same call reads, and
            removes when it has computed the rest.

    Returns:
        Dataset over (radius, partner_radius), over (radius) beside a wall, or without dimensions:
        stick_probability, rotate_probability, bounce_probability (sum 1); restitution_all and
        tangential_restitution_all, means over all collisions in which a stick counts as 0; restitution_separated and
        tangential_restitution_separated, means over the collisions that separate, NaN where none does;
        kinetic_energy_loss, what all kinetic energy loses, rotation included, over that of the relative motion;
        normal_dissipation, the same of the normal motion alone, no cooling rate and negative where rotation feeds it;
        energy_into_rotation, the gain of the energy of rotation over the kinetic energy; of each its error as
        NAME_error; collision_rate, m^3/s, over both number densities (beside a wall m/s); reason of a failure, else "".

    Raises:
        InputError: an invalid name or value, or a scene with strings. A pair that fails raises nothing; it is marked.
        ComputationError: there is no compiled kernel of this scene here.

    Example:
        >>> from wetdoublet.solvers import collision_averages
        >>> found = collision_averages("granulation", speeds="1.5 m/s", tolerance=1e-4)
        >>> round(float(found.stick_probability), 3)
        0.355
    """
    loaded = Scene.load(scene)
    check_function(progress, "progress")
    if loaded.pendulum is not None:
        problem = "has strings, so that nothing is isotropic"
        raise InputError("scene", loaded.name, "a scene without [pendulum]", problem)
    distribution = Speeds.of(loaded.impact.relative_speed if speeds is None else speeds)
    axes: dict[str, np.ndarray] = {}
    if radii is not None:
        axis = checked_numbers("particles.radius", radii).reshape(-1)
        if not 1 <= np.unique(axis).size == axis.size <= MOST:
            raise InputError("radii", axis, f"1 to {MOST} different radii", f"has {axis.size}")
        axes = {"radius": axis} if loaded.wall else {"radius": axis, "partner_radius": axis.copy()}
    request = _Request(
        loaded, distribution, axes, check_name(films, FILMS, "films"), _TOLERANCE.number(tolerance), check_rtol(rtol)
    )
    first_accepted(partial(request.scene_of, sizes) for sizes in request.sizes)
    beside = None if resume is None else check_file(resume, "resume", replaced=True)
    warn(loaded)
    return dataset(loaded, axes, _averages(request, beside, progress), request.attributes())


@dataclass(frozen=True)
class _Request:
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


def _averages(request: _Request, resume: Path | None, progress: Progress | None) -> Block:
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


def _blank(size: int) -> Block:
    columns: Block = {name: np.full((size, COLUMNS), np.nan) for name in ("mean", "error")}
    return columns | {"rate": np.full(size, np.nan), "reason": np.full(size, "", dtype=object)}


def _block(request: _Request, sizes: np.ndarray) -> Block:
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
    experiment = experiment_of(list(scenes.values()), request.rtol)
    columns["mean"][rows], columns["error"][rows] = means(experiment, rows.size, request.speeds, request.tolerance)
    failed = rows[np.isnan(columns["mean"][rows]).any(axis=1)]
    columns["mean"][failed] = columns["error"][failed] = np.nan  # shares of the others are not those of all
    columns["reason"][failed] = "collisions that no engine completes"
    return columns
