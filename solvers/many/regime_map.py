"""A regime map: outcome and other quantities over a grid of impacts and of entries that vary."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated import scaling
from ..engines.choice import collision_engine
from ..errors import InputError
from ..host import files
from ..host.arguments import check_function
from ..host.pictures import register
from ..model.validity import flag_attributes, warn
from ..scene.groups import si_values
from ..scene.held import held_text
from ..scene.quantities import normal_speed
from ..scene.ranges import MOST, MOST_STORED, most_collisions
from ..scene.scene import Scene
from ..scene.schema import MEETING, SPEEDS
from ..scene.user_model import Package
from ..settings import RTOL, check_engine, check_rtol
from .batch import Batch, check_outputs, check_some_scene, checked_impact, checked_vary, held_by_default
from .chunks import chunks
from .compute import Slow, compute, computed_chunk
from .dataset import as_text, blank, empty, fill, validity
from .journal import Journal
from .journal import journal as checked_journal
from .results import QUANTITIES, VALIDITY, Block, attributes, outcome_attributes
from .stream import Progress, Scan, check_places, into_memory, into_store, software

if TYPE_CHECKING:
    import xarray

IMPACTS = tuple(name.partition(".")[2] for name in SPEEDS)
_UNKNOWN = -2  # outcome of a collision not computed yet


@dataclass(frozen=True)
class Grid:
    """Axes of a map, SI: impact angles, Stokes numbers or speeds, and entries that vary."""

    scene: Scene
    angle: np.ndarray
    impact: str  # "stokes", "speed" or "relative_speed"
    values: np.ndarray
    vary: dict[str, np.ndarray]
    held: str = ""  # what stays of the scene's impact where entries vary, in words

    @property
    def dims(self) -> tuple[str, ...]:
        return ("angle", self.impact, *self.vary)

    @property
    def shape(self) -> tuple[int, ...]:
        return (self.angle.size, self.values.size, *(values.size for values in self.vary.values()))

    @property
    def axes(self) -> dict[str, np.ndarray]:
        return {"angle": self.angle, self.impact: self.values, **self.vary}

    def one_impact(self) -> Grid:
        """The same scenes, each with the first impact alone."""
        return replace(self, angle=self.angle[:1], values=self.values[:1])

    @cached_property
    def order(self) -> np.ndarray:
        """Flat indices in the order of computation: the collisions of one scene follow one another."""
        indices = np.arange(np.prod(self.shape, dtype=int)).reshape(self.shape)
        return np.moveaxis(indices, [0, 1], [-2, -1]).ravel()

    def part(self, at: Sequence[slice]) -> Grid:
        """A block of the grid."""
        angle, values, *varied = at
        vary = {name: axis[own] for (name, axis), own in zip(self.vary.items(), varied, strict=True)}
        return replace(self, angle=self.angle[angle], values=self.values[values], vary=vary)

    def speeds(self, values: np.ndarray, angle: np.ndarray, stokes_per_speed: float) -> np.ndarray:
        """Normal speeds, m/s, of what is on the impact's axis."""
        if self.impact == "stokes":
            return values / stokes_per_speed
        return values if self.impact == "speed" else np.asarray(normal_speed(values, angle))

    def request(self, rtol: float, asked: str | None, of: Sequence[str]) -> Batch:
        """All collisions of the grid as one batch, its engine not chosen yet."""
        full = np.meshgrid(self.angle, self.values, *self.vary.values(), indexing="ij")
        angle, values, *varied = (axis.ravel() for axis in full)
        return Batch(
            scene=self.scene,
            stokes=values if self.impact == "stokes" else None,
            speed=None if self.impact == "stokes" else self.speeds(values, angle, 1.0),
            angle=angle,
            vary=dict(zip(self.vary, varied, strict=True)),
            rtol=rtol,
            engine=asked or "rosenbrock",
            of=tuple(of),
            asked=asked,
        )


def regime_map(
    scene: Scene | str | Path,
    *,
    stokes: Any = None,
    speed: Any = None,
    angle: Any = None,
    relative_speed: Any = None,
    vary: Mapping[str, Any] | None = None,
    hold: str | None = None,
    rtol: float = RTOL,
    engine: str | None = None,
    of: Sequence[str] = (*QUANTITIES, VALIDITY),
    progress: Progress | None = None,
    journal: str | Path | Journal | None = None,
    slow: Slow = lambda _count: None,
    client: Any = None,
    store: str | Path | None = None,
) -> xarray.Dataset:
    """Outcomes over a grid.

    Arguments:
        scene: a Scene, a path or a preset's name.
        stokes, speed, relative_speed: Stokes numbers, normal speeds in m/s, or magnitudes of the relative velocity in
            m/s: an axis, or a single number; default the scene's.
        angle: impact angles in rad, an axis or a single number; default the scene's.
        vary: other entries by dotted name (SI), each an axis of its own.
        hold: what the scene's impact keeps where it is no argument, as for `collide_many`.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "taylor" (default; compiled on first use), "rosenbrock" (also where there is no C compiler) or "cvodes".
        of: results as for `collide_many`; by default restitution, tangential_restitution, rotation, contact_time,
            smallest_gap and validity (flags of where the model leaves its range).
        progress: called with (collisions done, collisions in all) after every block.
        journal: file that keeps finished collisions, so that the same call continues after an interrupt; the caller
            removes it.
        slow: called with the number of collisions left to slower engines, once the kernel has done all others.
        client: a `dask.distributed.Client` whose workers compute the map, or as text a scheduler's address, its file,
            "local" or "local:N" (N processes here, started and ended by this call). The result is the same.
        store: a Zarr store to write chunk by chunk (`map.zarr`); memory does not grow with the map. The same call
            continues after an interrupt. The Dataset that is returned reads from it.

    Returns:
        Dataset over (angle, the one of these three, what varies): outcome (int8: 0 stick, 1 stick-rotate-separate,
        2 bounce, -1 failed), certified, reason (of a failure, else "") and what `of` names; NaN where a stick leaves
        a quantity undefined. The Stokes number and speed that are no axis and, with a bridge, the centrifugal number
        are coordinates as well. The scene is among the attributes.

    Raises:
        InputError: an invalid name or value. A collision that fails raises nothing; it is marked.

    Example:
        >>> from wetdoublet.solvers import regime_map
        >>> regime_map("granulation", stokes=[0.01, 0.02, 0.2], angle=["30 deg", "75 deg"]).outcome.values
        array([[0, 0, 2],
               [0, 1, 2]], dtype=int8)
    """
    told = check_function(progress, "progress"), check_function(slow, "slow")
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    file = check_places(client, store)
    grid = _grid(Scene.load(scene), impact, {} if vary is None else vary, MOST if file is None else MOST_STORED, hold)
    wanted, rtol, results, kept = check_engine(engine), check_rtol(rtol), check_outputs(of), checked_journal(journal)
    check_some_scene(grid.one_impact().request(rtol, wanted, ()))
    asked = _Asked(grid, rtol, collision_engine(grid.scene, wanted), results)
    warn(grid.scene)
    if file is not None:
        return into_store(_scan(asked), file, client, told[0] or (lambda _done, _total: None), kept)
    if kept is None:
        return _computed(asked, None, *told, client)
    kept.under(_identity(asked))
    with kept.held():
        return _computed(asked, kept, *told, client)


@dataclass(frozen=True)
class _Asked:
    """A map as requested."""

    grid: Grid
    rtol: float
    engine: str
    of: tuple[str, ...]

    def request(self) -> Batch:
        return self.grid.request(self.rtol, self.engine, self.of)

    def part(self, at: Sequence[slice]) -> _Asked:
        return replace(self, grid=self.grid.part(at))


def _computed(
    asked: _Asked, kept: Journal | None, progress: Progress | None, slow: Slow | None, client: Any
) -> xarray.Dataset:
    request = asked.request()
    results = empty(request.size, request.of)
    for where, block in kept.read() if kept else ():
        fill(results, where, block)
    total = request.size

    def tell() -> None:
        if progress is not None:
            progress(int(np.count_nonzero(results["outcome"] != _UNKNOWN)), total)

    def finished(where: np.ndarray, block: Block) -> None:
        if kept is not None:
            kept.add(where, block)
        fill(results, where, block)
        tell()

    tell()
    done = results["outcome"] != _UNKNOWN
    if client is None:
        missing = asked.grid.order[~done[asked.grid.order]]
        compute(request, missing, finished, slow or (lambda _count: None))
    else:
        # flags are computed at the end, also for what an earlier run has finished
        into_memory(
            _scan(asked), client, done, lambda where, block: finished(where, {name: block[name] for name in results})
        )
    return _dataset(asked, request, results)


def _scan(asked: _Asked) -> Scan:
    """The map as chunks that are computed by themselves."""
    cut, size = chunks(asked.grid.shape, asked.engine), math.prod(asked.grid.shape)

    def dataset(k: int, block: Block) -> xarray.Dataset:
        part = asked.part(cut.slices(k))
        return _dataset(part, part.request(), block)

    def axes() -> xarray.Dataset:
        import xarray as xr

        found = _coordinates(asked.grid.one_impact())
        return xr.Dataset(coords={name: (name, axis, found[name][2]) for name, axis in asked.grid.axes.items()})

    return Scan(
        cut,
        asked.engine,
        task=lambda k: partial(_chunk, asked.part(cut.slices(k)), size),
        dataset=dataset,
        blank=lambda k: blank(math.prod(cut.extent(k)), asked.of),
        fixed=axes,
        identity=_identity(asked),
    )


def _chunk(asked: _Asked, whole: int, cores: int) -> Block:
    """Results of a part of a map of `whole` collisions; a worker receives its axes and makes the collisions itself."""
    return computed_chunk(replace(asked.request(), whole=whole), cores)


def _grid(scene: Scene, impact: Mapping[str, Any], vary: Mapping[str, Any], most: int, hold: str | None) -> Grid:
    scene, varied = checked_vary(scene, vary)
    kept = held_by_default(scene, impact, varied, hold)
    axes = {name: array.reshape(-1) for name, array in (checked_impact(scene, impact, 1, kept) | varied).items()}
    if math.prod(axis.size for axis in axes.values()) > most:
        longest = max(axes, key=lambda name: axes[name].size)
        sizes = " x ".join(str(axis.size) for axis in axes.values())
        raise InputError(longest, None, most_collisions(most), f"makes {sizes} collisions")
    for name, axis in axes.items():
        if np.unique(axis).size != axis.size:
            raise InputError(name, axis, "an axis without repetitions", "has a value twice")
    angles = axes.pop("impact.angle")
    entry = next(name for name in SPEEDS if name in axes)
    values = axes.pop(entry)
    return Grid(scene, angles, entry.partition(".")[2], values, axes, held_text(scene, kept) if kept else "")


def _identity(asked: _Asked) -> dict[str, Any]:
    """Everything that the results depend on, as the journal's request."""
    grid = asked.grid
    axes = {"angle": grid.angle, grid.impact: grid.values} | {f"vary {name}": axis for name, axis in grid.vary.items()}
    return {
        "scene": [entry for entry in grid.scene.si if entry[0] not in MEETING],
        "volume": grid.scene.ways.volume,
        "axes": {name: axis.tolist() for name, axis in axes.items()},
        "rtol": asked.rtol,
        "engine": asked.engine,
        "of": sorted(set(asked.of)),
        **software(),
        "model": grid.scene.package and grid.scene.package.digest,
    }


def _version() -> str:
    from importlib.metadata import version

    return version("wetdoublet")


def _dataset(asked: _Asked, request: Batch, results: Block) -> xarray.Dataset:
    import xarray as xr

    register()
    grid = asked.grid

    def shaped(values: np.ndarray) -> np.ndarray:
        return values.reshape(grid.shape)

    variables: dict[str, Any] = {
        "outcome": (grid.dims, shaped(results["outcome"]), outcome_attributes()),
        "certified": (grid.dims, shaped(results["certified"]), {"long_name": "the stick is proved"}),
        "reason": (grid.dims, shaped(as_text(results)), {"long_name": "why it failed"}),
    }
    for name, values in results.items():
        if name not in variables and name != VALIDITY:
            variables[name] = (grid.dims, shaped(values), attributes(name))
    if VALIDITY in request.of:
        mask = results[VALIDITY] if VALIDITY in results else validity(request, results)
        variables[VALIDITY] = grid.dims, shaped(mask), flag_attributes()
    said = {
        "Conventions": "CF-1.11",
        "title": f"Outcomes of oblique wet collisions: {grid.scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {_version()}",
        "scene": grid.scene.to_toml(),
        "rtol": request.rtol,
        "engine": request.engine,
        "version": _version(),
    }
    if grid.held:
        said["held"] = grid.held
    if grid.scene.package is not None:
        said["model"] = grid.scene.package.text
    return xr.Dataset(variables, _coordinates(grid), said)


def _coordinates(grid: Grid) -> dict[str, Any]:
    labels = {
        "stokes": {"units": "1", "long_name": "Stokes number"},
        "speed": {"units": "m/s", "long_name": "normal approach speed"},
        "relative_speed": {"units": "m/s", "long_name": "magnitude of the relative velocity"},
        "angle": {"units": "rad", "long_name": "impact angle"},
    }
    coordinates: dict[str, Any] = {
        "angle": ("angle", grid.angle, labels["angle"]),
        grid.impact: (grid.impact, grid.values, labels[grid.impact]),
    }
    for name, values in grid.vary.items():
        field = grid.scene.fields[name]
        coordinates[name] = (name, values, {"units": field.unit or "1", "long_name": name.replace(".", ", ", 1)})
    shape = grid.shape[2:]
    speeds, stokes, centrifugal = (np.full(grid.shape, np.nan) for _ in range(3))
    for index in np.ndindex(*shape):
        entries = {name: float(axis[k]) for (name, axis), k in zip(grid.vary.items(), index, strict=True)}
        try:
            scene = grid.scene.with_si(entries) if entries else grid.scene
        except InputError:  # the collisions of an impossible scene are marked as failed
            continue
        here = (slice(None), slice(None), *index)
        with np.errstate(all="ignore"):  # an impact out of range is marked as failed
            speeds[here] = grid.speeds(grid.values[None, :], grid.angle[:, None], scene.stokes_per_speed)
            stokes[here] = speeds[here] * scene.stokes_per_speed
        if scene.bridge is not None:
            centrifugal[here] = _centrifugal(scene, speeds[here], grid.angle)
    for name, values in (("speed", speeds), ("stokes", stokes)):
        if grid.impact == "relative_speed":
            coordinates[name] = (grid.dims, values, labels[name])
        elif name != grid.impact:  # the same at every angle
            coordinates[name] = (grid.dims[1:], values[0], labels[name])
    if grid.scene.bridge is not None:
        coordinates["centrifugal"] = (
            grid.dims,
            centrifugal,
            {"units": "1", "long_name": "centrifugal number m omega0^2/sigma"},
        )
    return coordinates


def _centrifugal(scene: Scene, speeds: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """The centrifugal number at an array of speeds, a line for each angle."""
    known = si_values(scene, None, None)
    fixed = {name: known[name] for name in scaling.ARGUMENTS["centrifugal"] if name in known}
    found = np.full(speeds.shape, np.inf)
    for line, speed, angle in zip(found, speeds, angles.tolist(), strict=True):
        with suppress(OverflowError, ZeroDivisionError), np.errstate(all="ignore"):
            line[:] = scaling.centrifugal(**fixed, speed=speed, angle=angle)
    return found


def impact_axis(data: xarray.Dataset) -> str:
    """The dimension of a map that is the impact's, beside the angle."""
    return next(name for name in IMPACTS if name in data["outcome"].dims)


def scene_of(data: xarray.Dataset) -> Scene:
    """The scene of a map, read from its attributes."""
    model = data.attrs.get("model")
    return Scene.from_toml(data.attrs["scene"], package=None if model is None else Package(str(model)))


def write(data: xarray.Dataset, path: str | Path) -> None:
    """Write a map as NetCDF4, atomically. OSError if it cannot be written."""
    from h5netcdf import File
    from xarray.backends import H5NetCDFStore

    made = io.BytesIO()  # on a full disk HDF5 aborts the process, so write the file from memory
    with File(made, "w") as file:
        encoding = {name: {"zlib": True} for name in data.data_vars if data[name].dtype.kind == "f"}
        data.dump_to_store(H5NetCDFStore(file), encoding=encoding)
    files.write(path, made.getbuffer())
