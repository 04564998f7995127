"""`collision_averages()`: outcomes and restitution averaged over impact geometry and speeds, for pairs of sizes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..changes.experiment import free_names
from ..engines.settings import RTOL, check_rtol
from ..errors import InputError
from ..host.arguments import check_function, check_name, check_names
from ..host.cores import usable_cores
from ..host.outputs import check_file
from ..host.progress import Progress
from ..host.workers import in_workers
from ..many.arguments import checked_numbers, first_accepted
from ..many.blocks import kept
from ..many.impacts import fill, software
from ..model.validity import warn
from ..scene.scene import Scene
from ..scene.schema import MEETING, Field, Range
from .dataset import Columns, dataset
from .geometry import COLUMNS, SLOPES
from .gradients import gradients
from .over_speeds import SHARP_CUT, means
from .sizes import FILMS, FIXED, experiment_of, scene_of_sizes, target
from .speeds import Speeds

if TYPE_CHECKING:
    import xarray

MOST = 400  # radii
FINEST = 25
"""Nodes along an axis of the finest grid, whose points include those of the coarser ones."""
STEPS = (4, 2, 1)
"""Steps between the nodes of the grids, in those of the finest."""
CHECKS = 32
"""Pairs that are computed beside the nodes, and compared with the interpolation."""
_POINTS = -np.cos(np.pi * np.arange(FINEST) / (FINEST - 1))
_BLOCK = 32  # pairs that are computed together
_OF_GRADIENTS = 100.0  # tolerance of the lines of derivatives, over that of the means
_TOLERANCE = Field(
    "tolerance", "an error", "1e-6", Range("from 1e-9 to 1e-2", 1e-9, 1e-2, low_open=False, high_open=False)
)
_OF_ONE = ("particles.radius", "particles.density")  # entries of one sphere of a pair, as those of its partner


def collision_averages(
    scene: Scene | str | Path,
    *,
    speeds: Any = None,
    radii: Any = None,
    films: str = FIXED,
    tolerance: float = 1e-6,
    rtol: float = RTOL,
    wrt: Sequence[str] | str = (),
    progress: Progress | None = None,
    resume: str | Path | None = None,
) -> xarray.Dataset:
    """Sticking probability and mean restitution over all collisions of a gas, for each pair of sizes.

    The direction of the relative velocity is isotropic, so that impact angles have the density sin(2 theta); its
    magnitude has the distribution `speeds`. The normal speed of a collision is V cos(theta). Spins are the scene's.

    Of many radii, without `wrt`, most pairs are interpolated between others if that is as accurate: held against pairs
    drawn at random, and by how the interpolating series ends.

    Arguments:
        scene: a Scene, a path or a preset's name; its [impact] has no influence but for its spins.
        speeds: relative speeds V of the collisions: one, in m/s or as text; `"maxwell:0.3 m/s"`, those of a gas whose
            velocities have components of this standard deviation, weighted by their flux; a CSV file with the header
            `relative_speed,density`, or two arrays. Default the scene's relative speed.
        radii: radii (m) of the spheres; every pair of them is computed, beside a wall each radius. Default the scene's
            own pair. Densities are those of the scene.
        films: "fixed": the film and the roughness are the scene's for every pair; "proportional": both grow with the
            sum of the radii, a coating with its sphere, a volume in m^3 with the cube of the sum.
        tolerance: absolute error of the quadrature, of the shares and of the means over all collisions. From 1e-9 to
            1e-2. Means over those that separate have it divided by their share.
        rtol: relative tolerance of the collisions, 1e-13..1e-3.
        wrt: numeric entries of a pair's scene, such as liquid.viscosity, by which the means are differentiated, each
            alone, at fixed relative speeds.
        progress: called with (pairs done, pairs in all) at the start and after every block; the second may grow where
            most of many pairs are interpolated.
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
        With `wrt` also gradient and gradient_error over (quantity, parameter), SI.

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
    request = _checked(loaded, speeds, radii, films, tolerance, rtol, wrt)
    beside = None if resume is None else check_file(resume, "resume", replaced=True)
    warn(loaded)
    size = int(np.prod(request.shape)) + int(np.prod(request.grid))
    columns, done = _blank(size, len(request.wrt)), np.zeros(size, bool)
    with kept(beside, request.identity, columns, done, "pairs"):
        columns = _computed(request, columns, done, progress)
    return dataset(loaded, request.axes, columns, request.attributes(), request.wrt)


def nodes(radii: np.ndarray) -> np.ndarray:
    """The radii of the finest grid of nodes."""
    low, high = np.log(radii.min()), np.log(radii.max())
    return np.asarray(np.exp(low + (high - low) * (1 + _POINTS) / 2))


@dataclass(frozen=True)
class Interpolation:
    """Interpolation from the nodes of a grid.

    Attributes:
        step: between its nodes, in those of the finest grid.
        axes: radii of the pairs that are asked for.
    """

    step: int
    axes: tuple[np.ndarray, ...]

    @property
    def which(self) -> np.ndarray:
        """Flat indices of the nodes in the finest grid."""
        along = np.arange(0, FINEST, self.step)
        return np.ravel_multi_index(np.meshgrid(*[along] * len(self.axes), indexing="ij"), [FINEST] * len(self.axes))

    def __call__(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The values of every pair, (pairs, columns), and the sum of the coefficients of the two highest degrees.

        Arguments:
            values: at the nodes, shaped as `which`, with the columns last.
        """
        points = _POINTS[:: self.step]
        degree = points.size - 1
        to_series = np.linalg.inv(np.polynomial.chebyshev.chebvander(points, degree))
        series = values
        for axis in range(len(self.axes)):
            series = np.moveaxis(np.tensordot(to_series, series, (1, axis)), 0, axis)
        highest = np.indices(series.shape[:-1]).max(axis=0) > degree - 2
        found = series
        for axis, radii in enumerate(self.axes):
            low, high = np.log(radii.min()), np.log(radii.max())
            at = np.polynomial.chebyshev.chebvander(2 * (np.log(radii) - low) / (high - low) - 1, degree)
            found = np.moveaxis(np.tensordot(at, found, (1, axis)), 0, axis)
        return found.reshape(-1, values.shape[-1]), np.abs(series[highest]).sum(axis=0)


@dataclass(frozen=True)
class _Request:
    """Averages as requested."""

    scene: Scene
    speeds: Speeds
    axes: dict[str, np.ndarray]
    films: str
    tolerance: float
    rtol: float
    wrt: tuple[str, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(axis.size for axis in self.axes.values())

    @property
    def symmetric(self) -> bool:
        """True if an exchange of the two spheres changes no result."""
        spins = self.scene.impact.spin, self.scene.impact.partner_spin
        equal_spins = spins[1] is None or spins[0] == spins[1]
        of_one_sphere = any(name in _OF_ONE or name.startswith("partner.") for name in self.wrt)
        return len(self.shape) == 2 and self.scene.partner is None and equal_spins and not of_one_sphere

    @property
    def grid(self) -> tuple[int, ...]:
        """Shape of the finest grid of nodes of an interpolation; without nodes where there is none."""
        return (FINEST,) * len(self.shape) if self.shape and not self.wrt and self.shape[0] > FINEST else (0,)

    def scene_at(self, flat: int) -> Scene:
        """The scene of a pair, or from the number of pairs on, of a node of the interpolation."""
        size = int(np.prod(self.shape))
        if flat < size:
            return self.scene_of(tuple(map(int, np.unravel_index(flat, self.shape))))
        at = replace(self, axes={name: nodes(axis) for name, axis in self.axes.items()})
        return at.scene_of(tuple(map(int, np.unravel_index(flat - size, self.grid))))

    def scene_of(self, index: tuple[int, ...]) -> Scene:
        """The scene of a pair; InputError if it is impossible."""
        if not index:
            entries = tuple((name, value) for name, value in self.scene.given if name not in MEETING)
            return Scene(self.scene.name, entries, package=self.scene.package)
        radius, *other = (float(axis[k]) for axis, k in zip(self.axes.values(), index, strict=True))
        return scene_of_sizes(self.scene, radius, other[0] if other else None, self.films)

    def attributes(self) -> dict[str, Any]:
        return {"speeds": self.speeds.text, "films": self.films, "tolerance": self.tolerance, "rtol": self.rtol}

    def identity(self) -> dict[str, Any]:
        """Everything that the results depend on, as JSON values."""
        distribution = None if self.speeds.density is None else self.speeds.density(self.speeds.knots).tolist()
        return {
            **self.attributes(),
            "averages": [entry for entry in self.scene.si if entry[0] not in MEETING],
            "speeds": [self.speeds.text, self.speeds.knots.tolist(), distribution],
            "axes": {name: axis.tolist() for name, axis in self.axes.items()},
            "wrt": list(self.wrt),
            **software(self.scene),
        }


def _checked(
    scene: Scene, speeds: Any, radii: Any, films: str, tolerance: float, rtol: float, wrt: Sequence[str] | str
) -> _Request:
    if scene.pendulum is not None:
        raise InputError("scene", scene.name, "a scene without [pendulum]", "has strings, so that nothing is isotropic")
    distribution = Speeds.of(scene.impact.relative_speed if speeds is None else speeds)
    axes: dict[str, np.ndarray] = {}
    if radii is not None:
        axis = checked_numbers("particles.radius", radii).reshape(-1)
        if not 1 <= np.unique(axis).size == axis.size <= MOST:
            raise InputError("radii", axis, f"1 to {MOST} different radii", f"has {axis.size}")
        axes = {"radius": axis} if scene.wall else {"radius": axis, "partner_radius": axis.copy()}
    request = _Request(
        scene, distribution, axes, check_name(films, FILMS, "films"), _TOLERANCE.number(tolerance), check_rtol(rtol), ()
    )
    possible = first_accepted(partial(request.scene_of, index) for index in np.ndindex(request.shape))
    return replace(request, wrt=check_names(wrt, free_names(possible), "wrt"))


def _computed(request: _Request, columns: Columns, done: np.ndarray, progress: Progress | None) -> Columns:
    """The columns of all pairs: those that are done, and the others as they are computed or interpolated."""
    size, points = int(np.prod(request.shape)), int(np.prod(request.grid))
    mirror = np.arange(size + points)
    if request.symmetric:
        mirror = np.concatenate([mirror[:size].reshape(request.shape).T.ravel(), mirror[size:]])
        if points:
            mirror[size:] = mirror[size:].reshape(request.grid).T.ravel()
        mirror = np.minimum(mirror, np.arange(size + points))
    tell = progress or (lambda _done, _total: None)

    def compute(which: np.ndarray) -> None:
        which = np.unique(mirror[which])
        left = which[~done[which]]
        total = int(np.count_nonzero(done)) + left.size
        tell(total - left.size, total)
        for where, block in _blocks(request, [left[k : k + _BLOCK] for k in range(0, left.size, _BLOCK)]):
            fill(columns, where, block)
            done[where] = True
            tell(int(np.count_nonzero(done)), total)

    wanted = np.unique(mirror[:size])
    checks = np.random.default_rng(0).choice(wanted, min(CHECKS, wanted.size), replace=False)
    for step in STEPS if points and np.count_nonzero(done[wanted]) < wanted.size else ():
        interpolation = Interpolation(step, tuple(request.axes.values()))
        which = size + interpolation.which
        if 2 * (np.unique(mirror[which]).size + checks.size) > wanted.size:
            continue
        compute(which)
        compute(checks)
        if _is_interpolated(request, interpolation, columns, mirror[which], checks, wanted[~done[wanted]]):
            tell(int(np.count_nonzero(done)), int(np.count_nonzero(done)))
            break
    else:
        compute(wanted)
    return {name: values[mirror[:size]] for name, values in columns.items()}


def _is_interpolated(
    request: _Request, interpolation: Interpolation, columns: Columns, which: np.ndarray, checks: np.ndarray,
    left: np.ndarray,
) -> bool:  # fmt: skip
    """Whether the pairs that are left are interpolated, into the columns, from nodes; checks are known pairs."""
    value, error = interpolation(columns["mean"][which])
    apart = 2 * np.abs(value[checks] - columns["mean"][checks]).max(axis=0)
    of_nodes = columns["error"][which].reshape(-1, COLUMNS).max(axis=0)
    if not (np.maximum(apart, error) <= np.maximum(request.tolerance / 2, of_nodes)).all():  # nor where any is NaN
        return False
    try:
        rates = [request.speeds.mean * target(request.scene_at(flat)) for flat in left.tolist()]
    except InputError:
        return False
    columns["mean"][left], columns["error"][left], columns["rate"][left] = value[left], of_nodes + apart, rates
    return True


def _blocks(request: _Request, blocks: list[np.ndarray]) -> Iterator[tuple[np.ndarray, Columns]]:
    """Pairs and their columns: the first in this process, which compiles the kernel, many others on all cores."""
    cores = min(usable_cores(), len(blocks) - 1)
    for where in blocks[:1] if cores > 1 else blocks:
        yield where, _block(request, where)
    if cores > 1:
        yield from in_workers(cores, _block, ((where, (request, where)) for where in blocks[1:]))


def _blank(size: int, parameters: int) -> Columns:
    columns: Columns = {name: np.full((size, COLUMNS), np.nan) for name in ("mean", "error")}
    columns |= {name: np.full((size, SLOPES * parameters), np.nan) for name in ("gradient", "gradient_error")}
    columns["rate"] = np.full(size, np.nan)
    return columns | {"reason": np.full(size, "", dtype=object)}


def _block(request: _Request, where: np.ndarray) -> Columns:
    """The columns of some pairs."""
    columns = _blank(where.size, len(request.wrt))
    scenes: dict[int, Scene] = {}
    for k, flat in enumerate(where.tolist()):
        try:
            scenes[k] = request.scene_at(flat)
        except InputError as error:
            columns["reason"][k] = str(error)
        else:
            columns["rate"][k] = request.speeds.mean * target(scenes[k])
    rows = np.array(list(scenes), dtype=int)
    if not rows.size:
        return columns
    experiment = experiment_of(list(scenes.values()), request.wrt, request.rtol)
    of_nodes = where.min() >= np.prod(request.shape)  # their errors leave room for that of the interpolation
    mean, uncertain, _ = means(experiment, rows.size, request.speeds, request.tolerance / (2 if of_nodes else 1))
    columns["mean"][rows], columns["error"][rows] = mean, uncertain
    columns["reason"][rows[np.isnan(mean).any(axis=1)]] = "collisions that no engine completes"
    if request.wrt:
        batches = means(experiment, rows.size, request.speeds, _OF_GRADIENTS * request.tolerance, SHARP_CUT)[2]
        slopes, errors = gradients(experiment, rows.size, batches)
        columns["gradient"][rows] = slopes.reshape(rows.size, -1)
        columns["gradient_error"][rows] = errors.reshape(rows.size, -1)
    return columns
